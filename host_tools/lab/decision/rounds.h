// rounds.h - one round of the forward selection: which candidates are fitted in full and in which order, what is believed of a size beyond
// its range, and where a round begins anew.
//
// A refit costs a hundred linear steps, so that only those are fitted which may win, or be of the winner's class. Whoever asks hands in how
// a trial is refitted and judged (`Refit`: whether it passes).
#pragma once

#include "host_tools/lab/fit/heldout.h"
#include "trial.h"

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace traction::lab {

inline constexpr double least_reduction = 9; // squares: three standard deviations of white noise; below it no rule can pass

using Refit = std::function<bool(Trial &)>;

// Of the variants of each effect and wheel the one of the largest predicted fall, in the order in which their labels came.
class BestVariants {
  public:
    void add(Trial trial);
    std::vector<Trial> take();

  private:
    std::map<std::string, Trial> best_;
    std::vector<std::string> order_;
};

// Those most sure by their linear step, `refits` of them; then three of larger predicted reduction than what passed; then three whose scan
// saw more than the step did. What explains less than half of what passed can be neither the winner nor of its class.
void refit_likely(std::vector<Trial> &trials, int refits, const Refit &refit_and_judge);

// Those that pass by their linear step and were not fitted, the most sure first, at most `refits`; whether one passes still.
bool refit_passing(std::vector<Trial> &trials, int refits, const Refit &refit_and_judge);

// A missing law may have taken the baseline to where every small step is blind. Each law of one strength that moves the body is fitted
// from a part of its range, whatever its step and its scan said; whether one passes.
bool refit_from_afar(std::vector<Trial> &trials, const Refit &refit_and_judge);

// A size where the fit may go no further is believed only where it explains much, and more than all that keeps within its range: told in
// `messages`, once.
void judge_beyond_range(std::vector<Trial> &trials, double base_error, std::vector<std::string> &messages);

// A refit may find the baseline a better place while its own effect says nothing: the one that fell the most; nullptr: none did.
const Trial *better_place(const std::vector<Trial> &trials);

// Of those that were refitted and pass, the one that gains the most, and more than `gain`; trials.size(): none does.
std::size_t most_beyond(const std::vector<Trial> &trials, double gain);

// The increments of another problem's parameters of the same name and stated value.
void take_increments(Problem &problem, const Problem &from);

// Does `after` predict blocks left out better, surely, in noises and by the scales of `before`?
bool predicts_better(const Problem &before, const Problem &after);

// Asked again beside the others, does a name stay? It must be solid (is_solid), and pass by its refit, or as one that was accepted as a
// least size, or the model must predict blocks left out better with it (`predicts`). What is not solid by its own coefficient stays where
// it takes most of what is left out wrongly without it (`most`, asked last): a coefficient that a few blocks tell is as unsure as they
// are few.
bool stays(const std::string &verdict, bool solid, const std::function<bool()> &predicts, const std::function<bool()> &most);

// What passed in a round before, as it was found there.
struct Earlier {
    std::vector<std::pair<std::string, double>> variant;
    std::vector<double> value;
};

// Of a law that moves the body: this round's step has led to another size than the one that an earlier round was sure of.
bool lost(const Trial &now, const Earlier &earlier);

// The largest held-out error of a balance, in units of its noise.
double worst_error(const HeldOut &held, const Dataset &data, const Eigen::VectorXd &noise_rows);

// Of a model that misses by far (twice the noise): whether a law takes half of the squares that noise does not explain. No scatter of an
// encoder does, and chance has no part in so much.
bool takes_most(const HeldOut &before, const HeldOut &after);

// The same of a balance that is missed by far.
bool takes_most_of_one(const HeldOut &before, const HeldOut &after, const Dataset &data, const Eigen::VectorXd &noise_rows);

// From which p a refit on the baseline's scales is unlikely: 150 times the limit (assumed). Where a large missing law has blown the scales
// up, its own rows hardly count on them, and only a fit with scales of its own tells.
double unlikely_from(double p_limit);

// A place of the ground that is driven over in few blocks: no rank of them tells it, however much it explains.
bool is_of_few_blocks(const Trial &trial, double p_limit);

// Those whose refit on the baseline's scales is not unlikely and large, the largest fall of the error first, at most three; and places in
// few blocks, where the model misses by more than five times the noise: uneven ground takes less.
std::vector<std::size_t> worth_scales_of_its_own(const std::vector<Trial> &trials, double p_limit, double heldout_error);

// A law of a place, or of the way behind a wheel: whatever ground wanders, and whatever an encoder scatters, has a bit of it somewhere.
bool wanders(const Candidate &candidate);

// A law of the radar, the camera or the gyro alone. Of the sheet no number acts as such a one does, so that one which stays far from its
// own speaks of something else.
bool of_another_sensor(const Candidate &candidate);

// Whether a name may stand for which the data sheet alone speaks, though another of the sheet's numbers stays far off beside it: its rows
// are very sure of their little (p_value, corrected), or it is another sensor's and no more than `strange` times the noise is left. Where
// more is, what the model lacks moves every sensor's rows against the rest.
bool stands_beside_bent_sheet(const Candidate &candidate, double p_value, double error_left);

// Times the noise that is left: the model misses by far.
constexpr double strange = 2;

// Whether a name lowers the held-out error by as much as a name must, of all or of one balance; what wanders, of all.
bool falls_notably(const HeldOut &before, const HeldOut &after, const Dataset &data, bool wanders = false);

// Whether the rows speak for a name: by 1 % of all or 3 % of one balance. Else it stands for the data sheet's sake.
bool falls_without_the_sheet(const HeldOut &before, const HeldOut &after, const Dataset &data);

} // namespace traction::lab
