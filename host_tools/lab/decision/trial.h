// trial.h - one candidate tried against one baseline: screened by a linear step, scanned at a few sizes, refitted, judged.
#pragma once

#include "columns.h"
#include "diagnose.h"
#include "host_tools/lab/fit/screen.h"

#include <optional>
#include <string>
#include <vector>

namespace traction::lab {

struct Trial {
    Candidate candidate;
    Assessment assessment;
    double error_reduction = 0;     // fall of the error on all rows, by the linear step or by a scan of sizes, whichever is more
    double nonlinear_reduction = 0; // the part of it that the linear step does not see
    bool leaves_active_set =
        false;       // its step takes parameters off the bounds at which they lie without it: far from where the step is linear
    double gain = 0; // fall of the held-out error, squares
    double gain_error = 0;
    double p_value = 1;           // corrected for the number tried
    double own_p_value = 1;       // of the coefficient alone
    double best_balance_gain = 0; // largest relative fall in one balance
    Eigen::VectorXd block_gain;
    std::vector<double> value, error, half_width; // standard error; half of the 95 % interval
    std::vector<double> start;                    // of a refit: the best size of the scan; empty: the linear step's
    Eigen::VectorXd start_change;                 // of the baseline's parameters there
    std::string verdict;
    bool refitted = false;
    bool matters = false;              // it takes most of what is not noise: of interest, whatever its size
    bool by_rows = false;              // the rows alone speak for it, whatever the stated tolerances gain (judge)
    std::optional<double> sheet_alone; // of a name for which the rows alone do not speak: squared stated deviations that it spares
    bool smooths = false;     // most of what it gains is by not following the encoders' scatter: no evidence, of itself or beside another
    bool at_least = false;    // its size lies where the fit may go no further, yet nothing else explains as much
    Eigen::VectorXd baseline; // increments of the baseline's parameters, where refitted
};

// The linear step.
Trial screen_candidate(const Candidate &candidate, const Screen &screen, Columns &columns);

// The true error at a few sizes of a candidate that moves the body, or of a delay, the baseline's parameters following linearly: what the
// linear step misses where the soil's curve bends, or where a missing effect has pushed the baseline far away.
void scan(Trial &trial, Problem &base, const Screen &screen);

// The baseline with the candidate in it, at nothing: its strengths are the last parameters, on the baseline's scales.
Problem beside(const Problem &base, const Candidate &candidate);

// Fits baseline plus candidate in full.
void refit(Trial &trial, const Problem &base, const Screen &base_screen);

// Of a fit that has the candidate last: its strengths.
std::vector<double> sizes_of(const Trial &trial, const Problem &fit);

// Numbers that a missing law has driven to their limits hold its size down, and it them there: `problem`, a fit of `model` with the
// candidate, is replaced where one from the stated numbers, with its size or twice that, leaves less. Kept is what a fit from there finds
// again, for so the model will be fitted by whoever has it.
void fit_from_the_sheet(const Trial &trial, const Model &model, const Dataset &data, Problem &problem);

// The fit of a model with a candidate, the soil's numbers where they stand in the fit without it, whose parameters are the first.
Problem held_ground(const Problem &with, const Problem &before);

// explainable: the part of the baseline's held-out error that is not noise (Screen).
void judge(Trial &trial, double explainable, const DiagnoseOptions &options);
// Of a strength whose sign is physical.
bool plausible_sign(const Candidate &candidate, const std::vector<double> &value);
bool large_enough(const Candidate &candidate, const std::vector<double> &value);
bool beyond_range(const Candidate &candidate, const std::vector<double> &value); // the fit took a size to where it may go no further
// Of an effect that was named: larger than its own uncertainty, and of interest.
bool is_solid(const CandidateResult &result);
// A signal that comes late: as long as its edges are, a step of its delay says nothing of the whole.
bool is_delay(const Candidate &candidate);

bool strongly_nonlinear(const std::string &effect); // its slope at zero says little of its size

CandidateResult result_of(const Trial &trial, double base_error, const Screen &screen);

} // namespace traction::lab
