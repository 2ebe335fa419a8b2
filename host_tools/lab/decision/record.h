// record.h - what a diagnosis writes down: of each round who was named, who may be meant, who could not be seen; and its last word.
#pragma once

#include "diagnose.h"
#include "trial.h"

#include "sim/physics/effects/catalogue.h"

#include <string>
#include <vector>

namespace traction::lab {

// Three sizes of interest of what all wheels share: do they show at all (two standard deviations of the whole log), and do they show beside
// what the model may adjust (two standard errors)? What the log says something of can be seen in it.
void note_not_excited(Diagnosis &diagnosis, const std::vector<Trial> &trials);

// A round with this winner (trials.size(): none), whose class `members` are, and `rival`, a tolerance that explains as much (empty: none
// does). The first round is the ranking. The winner is accepted, and an effect of the model.
void record(Diagnosis &diagnosis, const std::vector<Trial> &trials, std::size_t winner, const std::vector<std::size_t> &members,
            const std::string &rival, double base_error, const Screen &screen, bool is_first);

// An accepted effect's sizes and 95 % intervals by the fit of the model that has it; `loss`: the share of a size that is not known beside
// (smoothing_loss).
void take_values(CandidateResult &accepted, const Problem &problem, const std::vector<ParameterError> &errors, double loss);

// An accepted effect is none any more: not in the ladder, the ranking, the classes.
void take_back(Diagnosis &diagnosis, std::size_t accepted);

// What was found, or may be meant, can be seen in this log.
bool was_seen(const Diagnosis &diagnosis, const std::string &effect);

// Kind, names and text of what was found.
void conclude(Diagnosis &diagnosis);

// `moved`, and a message for each, of the final fit.
void tell_moved(Diagnosis &diagnosis, const Problem &fitted);

Model model_without(const Model &model, const Candidate &candidate);

// A shape parameter that is a number on a scale (the others are kinds: an order, who shares a lead), and the range in which it is set free
// from the station at which it was found: a factor of four to either side, a quarter of a turn and a little of an angle.
bool is_on_a_scale(const sim::EffectParameter &spec);
void set_free(Parameter &parameter, const sim::EffectParameter &spec);

// An accepted effect's shape parameters that are numbers on a scale, set free in the model; whether it has any.
bool free_shapes(Model &model, const Candidate &candidate, const sim::Effect &effect);
// Their values by the fit of that model; and the model with them held there again.
void take_shape_values(CandidateResult &accepted, const Problem &problem, const std::vector<ParameterError> &errors);
void fix_shapes(Model &model, const CandidateResult &accepted);
// The edges of an accepted patch as the model has them (patch_edges.h).
void take_edges(CandidateResult &accepted, const Model &model);

// A fit whose shapes were free is kept where it leaves no more than the one at the station; both end where a search ends.
bool no_worse(double refined, double at_station);

// A ripple's torque and what it does to the wheel's acceleration must be told apart: what the smoothing of the acceleration loses at the
// ripple's frequency, at the mean speed of the turning wheels, is not known of its size. A share of it.
double smoothing_loss(const Candidate &candidate, const Dataset &data);

} // namespace traction::lab
