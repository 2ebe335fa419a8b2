// diagnose.h - which physics the model lacks: screening, refits, forward selection, backward drop, confounded, unknown, not excited.
#pragma once

#include "candidate.h"
#include "host_tools/lab/fit/problem.h"
#include "host_tools/lab/inputs/dataset.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace traction::lab {

// Decision thresholds (docs/lab_method.md says where each comes from).
struct DiagnoseOptions {
    double p_limit = 0.003;       // of the corrected p: stricter than LAB.md's 0.01, uneven ground mimics soil effects
    double least_gain = 0.01;     // fall of the held-out error, all balances
    double least_gain_one = 0.03; // the same in one balance
    double least_relief = 9.0;    // relief of priors, squared standard deviations
    int refits = 5;               // classes that are fitted in full
    int most_effects = 4;
    double same_cosine = 0.9;       // above it two candidates are one class
    double shape_p_limit = 0.02;    // of the corrected p of a structure-free shape, which must also gain 2.5 standard errors
    double least_shape_gain = 0.02; // a structure-free shape has many freedoms
    double shape_margin = 1.10;     // a shape must beat the winner by this factor
    bool shapes = true;
    std::function<void(int, int)> progress; // done, total
};

struct CandidateResult {
    Candidate candidate;
    std::vector<double> value, low, high;                 // strengths, 95 %
    double heldout_gain = 0, gain_low = 0, gain_high = 0; // fraction of the held-out error
    double gain_squares = 0;
    double p_value = 1;       // corrected for the number tried
    double detectability = 0; // d' of the estimate
    std::string verdict;      // named class nearest not_significant too_small beyond_range wrong_sign not_excited
    std::optional<int> class_index;
    std::vector<std::pair<std::pair<double, double>, double>> evidence; // window, share of the gain
    std::string explains;
};

struct ConfoundedClass {
    std::vector<std::string> members;
    std::string separate_by;
};

struct UnknownShape {
    std::string variable, balance, unit_x, unit_y, expression, target;
    double gain = 0;
    std::vector<double> x, y, low, high;
};

struct BalanceScore {
    double rms = 0, noise_rms = 0, heldout_noise = 0; // noise_rms: in units of noise
};

struct Rung { // of the ladder
    std::string label;
    double train = 0, heldout = 0, floor = 1;
};

struct Diagnosis {
    std::vector<CandidateResult> ranking;  // first round, best first
    std::vector<CandidateResult> accepted; // in order of acceptance, final values
    std::vector<ConfoundedClass> classes;
    std::vector<std::pair<std::string, std::string>> not_excited; // effect, why
    std::optional<UnknownShape> unknown;
    std::string kind; // named class partial unknown nothing
    std::vector<std::string> effects;
    std::vector<std::string> nearest; // of the catalogue to the unknown shape, in whose stead they were found first: not the cause
    std::string text;
    std::vector<Rung> ladder;
    Model model; // with the accepted effects, refitted
    std::vector<std::string> messages;
};

Diagnosis diagnose(const Model &model, const Dataset &data, const DiagnoseOptions &options);

// Error of a fitted problem, in units of noise over all balances: root of the mean over balances of the mean square.
double overall_error(const Problem &problem);
double overall_heldout(const Problem &problem);

// Fits a model to the data and writes the values with intervals into it. Returns the rung of the ladder.
Rung fit_model(Model &model, const Dataset &data, const std::string &label);

} // namespace traction::lab
