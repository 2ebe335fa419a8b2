// diagnose.h - which physics the model lacks: screening, refits, forward selection, backward elimination, confounded classes, unknown
// shapes, effects that were not excited.
#pragma once

#include "candidate.h"
#include "doubt.h"
#include "host_tools/lab/fit/identify.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/inputs/dataset.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace traction::lab {

// Decision thresholds (docs/lab_method.md says where each comes from).
struct DiagnoseOptions {
    double p_limit = 0.003;       // of the corrected p (Bonferroni): uneven ground mimics soil effects at 0.01, docs/evidence.md section 5
    double least_gain = 0.01;     // fall of the held-out error, all balances
    double least_gain_one = 0.03; // the same in one balance
    double least_prior_reduction = 9.0; // fall of the priors' penalty, squared standard deviations
    int refits = 5;                     // candidates of least p that are fitted in full; a few more by other rules
    int most_effects = 4;
    double same_cosine = 0.9;       // above it two candidates are one class
    double shape_p_limit = 0.02;    // of the corrected p of a structure-free shape, whose gain must also repeat over blocks
    double least_shape_gain = 0.02; // a structure-free shape has many freedoms
    double shape_margin = 1.10;     // a shape must beat the winner by this factor
    bool shapes = true;
    std::function<void(int, int)> progress; // candidates done; 500, a guess of how many there will be
};

// A shape parameter of a law that was named, refined from the variant that was tried: a Stribeck speed, a time constant, a patch's place.
struct ShapeEstimate {
    std::string key, unit;
    double value = 0, low = 0, high = 0; // 95 %
};

struct CandidateResult {
    Candidate candidate;
    std::vector<ShapeEstimate> shapes;                    // empty: none could be refined
    std::vector<double> value, low, high;                 // strengths, 95 %
    double heldout_gain = 0, gain_low = 0, gain_high = 0; // fraction of the held-out error
    double gain_squares = 0;
    double p_value = 1;       // corrected for the number tried
    double detectability = 0; // d' of the estimate
    std::string verdict;      // named class nearest not_needed not_held_out strains_sheet not_significant too_small beyond_range conflict
                              // wrong_sign not_excited
    bool matters = false;     // it takes most of what is not noise
    std::optional<double> sheet_alone; // of a name for which the rows alone do not speak: squared stated deviations that it spares
    std::optional<int> class_index;
    std::vector<std::pair<std::pair<double, double>, double>> evidence; // window, share of the gain
    std::string explains;
};

struct ConfoundedClass {
    std::vector<std::string> members;
    std::string separate_by;
};

struct ShapeScore;

struct UnknownShape {
    std::string variable, balance, unit_x, unit_y, expression, target;
    std::string instead_of; // the name that explains no more than it: this log cannot tell them apart. Empty: what no name explains
    double gain = 0;
    bool at_a_guess = false; // that something acts on its wheel is sure (odd_wheel.h), the curve is the best of what was tried
    bool of_body = false;    // that something moves the body is sure (moves_together.h); no curve
    std::vector<double> x, y, low, high;
    std::shared_ptr<const ShapeScore> score; // as it was found, for its fit in full (shape_refit.h)
};

struct BalanceScore {
    double rms = 0, noise_rms = 0, heldout_noise = 0; // noise_rms: in units of noise
};

struct Diagnosis {
    std::vector<CandidateResult> ranking;  // first round, best first
    std::vector<CandidateResult> accepted; // in order of acceptance, final values
    std::vector<ConfoundedClass> classes;
    std::vector<std::pair<std::string, std::string>> not_excited; // effect, why
    std::optional<UnknownShape> unknown;
    std::string kind; // named class partial unknown nothing wrong_model
    std::vector<std::string> effects;
    std::vector<std::string> nearest; // of the catalogue to the unknown shape, whose proxies they were: not the cause; of a wrong model
                                      // what describes the log as well as its number does
    std::string text;
    std::vector<LadderStep> ladder;
    Model model;                    // with the accepted effects, refitted
    std::vector<Limit> limits;      // at which parameters of the final model stand
    std::vector<std::string> moved; // of its numbers, far from what is stated (moved_far): the messages say how far
    std::vector<std::string> messages;
    // fitted_problem() of the stated model and of `model`, on the data that were diagnosed and while these live: for who asks the same
    // again. Null where the search did not come by.
    std::shared_ptr<const Problem> stated_fit, model_fit;
};

Diagnosis diagnose(const Model &model, const Dataset &data, const DiagnoseOptions &options);

// The verdict wrong_model: takes back every name, class and shape; the model stays as stated.
void name_nothing(Diagnosis &diagnosis, const Model &stated, const Doubt &doubt);

// The sentence that ends a diagnosis; conclude() of record.h puts it into `text`.
std::string verdict_text(const Diagnosis &diagnosis);

} // namespace traction::lab
