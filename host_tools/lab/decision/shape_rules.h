// shape_rules.h - how a structure-free shape is judged: its p, its evidence, what it is called, and which names it stands beside or
// replaces.
#pragma once

#include "candidate.h"
#include "diagnose.h"
#include "host_tools/lab/fit/screen.h"
#include "host_tools/lab/fit/sparse_jacobian.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace traction::lab {

struct ShapeScore {
    Candidate candidate;
    Assessment assessment;
    double p_value = 1, balance_fall = 0;
    SparseJacobian columns;
};

// Two tests, corrected for their number and that of the shapes: of the coefficients (robust, but each costs a degree of freedom), and of
// the held-out error's fall over blocks (Diebold and Mariano, J. Business & Economic Statistics 13 (1995) 253). A curve is judged by the
// ranks of its falls: it may matter in few blocks only, whose falls are large and unlike; a wave, which any uneven ground fits a little all
// along, by their mean.
double corrected(const Candidate &shape, const Assessment &assessment);

// Near to many laws of the catalogue: takes a name's place only where it does better beside all else.
bool is_straight(const Candidate &shape);

// One value between two that are nothing: a resonance. What a curve of many values says of it is less sure.
bool is_bump(const Candidate &shape);

// One value from a time on: something broke, came loose or was loaded. The steps of a shape over time are evenly apart in it.
bool is_step(const Candidate &shape);
std::vector<Candidate> steps_of(const Candidate &over_time);

// Every ground's strength wanders along the way: that alone is not worth a word. Nor is it over slip, which grows where the ground is weak:
// at a steady pull the one follows from the other.
bool uneven(const Candidate &shape);

// A curve through three values is no curve (a straight line or a bump is one), and one over wheels that each keep to a value of X is none
// either: f(X) may stand for anything that differed between them.
bool is_curve(const Candidate &shape);

// Single wheels, and those that stand abreast (axles): at most eight wheels, or the shapes become too many. motors: those with a motor
// alone.
std::vector<std::vector<int>> wheel_groups(const Physics &physics, bool motors);
Candidate on_wheels(const Candidate &shape, const std::vector<int> &group);

// Values and 95 % band of a shape at its knots; of a periodic one over a turn of the wheel, or over one wave.
UnknownShape describe(const ShapeScore &shape, double base_error);

// A problem less one of its effects, at the same linearisation: its columns are handed out and what it contributes goes back into the
// residual.
Problem without_effect(const Problem &last, const Candidate &effect, Eigen::MatrixXd &columns);

// What the effect still gains where the shape's coefficients are free beside it.
Assessment effect_given_shape(const Problem &less, const Eigen::MatrixXd &effect, const ShapeScore &shape);

// The confounding shape of which the effect is a proxy, if there is one: needed beside the effect, and explaining more than it by itself,
// while the effect is not needed beside the shape. A law that is right passes: no freer shape does better than it.
std::optional<UnknownShape> confounding_shape(const Problem &last, const Candidate &effect, const std::vector<ShapeScore> &shapes,
                                              const ShapeScore *flagged, const DiagnoseOptions &options);

// The named effects that say the same as the shape. One that keeps more than half of what it gains beside it is about something else, and
// neither stands nor falls with it.
std::vector<std::size_t> explained_by_shape(const Problem &last, const std::vector<Candidate> &named, const std::string &shape,
                                            const std::vector<ShapeScore> &scores);

// Where nothing is left that a shape would explain, a hundredth of the error, no shape does better than what was named.
bool anything_left(const std::vector<ShapeScore> &scores, double heldout_error);

// May one shape that gains `gain` stand for the `names` that say the same, where all that was named gains `named_gain`; `error`: the
// standard error of their difference over blocks? In the place of several it is the simpler model; of one name it must do more, surely, and
// twice as much where with the name a shape is left (`leaves_a_shape`): of one that leaves a shape behind only a proxy's name goes.
inline constexpr double place_of_several = 0.95;
bool takes_their_place(std::size_t names, double gain, double named_gain, double error, bool leaves_a_shape,
                       const DiagnoseOptions &options);

// May a shape be asked for the place of names that gain `named_gain` together? It is sure, no straight line, and gains nearly as much.
bool may_replace(const ShapeScore &shape, double named_gain, const DiagnoseOptions &options);

// Of the names that a shape stands for, in order, does the last one go? All but the first do; that one where it holds less than half of
// what the shape gains.
bool gives_way(const std::vector<std::size_t> &replaced, const std::vector<CandidateResult> &accepted, double shape_gain);

// Evidence that repeats: sure beside its scatter over blocks, or very sure by the test and not the work of two blocks alone.
bool repeats(const ShapeScore &shape);

// The shape that is worth a word: sure, large and repeated, also without what it gains by smoothing the encoders' scatter (`smoothed_by`);
// nullptr: none is. `scatter_share`: of the error that scatter may be.
const ShapeScore *worth_a_word(const std::vector<ShapeScore> &scores, const std::function<double(const ShapeScore &)> &smoothed_by,
                               bool beside_names, double heldout_error, double scatter_share, const DiagnoseOptions &options);

} // namespace traction::lab
