// manner.h - what may be named from a drive of one manner: one velocity from its start to its end.
//
// Blocks that are left out of such a drive are driven as those that are fitted, so their error says nothing of other drives: a name is as
// good there as a number of the data sheet that leans on its limit, or as one wheel's own. Two rules stand in for the missing
// evidence (prior-data conflict: Evans and Moshonov 2006, Bayesian Analysis 1, 893-914; parsimony):
// - a name must leave what the model states, and its own size, within their limits; what moves the rover must act on all wheels, for of one
//   velocity each wheel's share of it is a number that nothing else checks;
// - of a class, a law that changes a number which the model states is told before one that adds something to it.
#pragma once

#include "diagnose.h"
#include "host_tools/lab/fit/problem.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace traction::lab {

// More than three quarters of the moving rows within a fifth of their median velocity, every wheel counted; a table of steady states, or a
// speed that is imposed, is no such drive.
bool is_of_one_manner(const Dataset &data);

// `fitted`: the joint fit with the candidate, at its optimum. Limits that count: of the machine's data and of the candidate's size; of one
// velocity the ground leans on its limits for want of slip, and a sensor's numbers are its own matter. Why it cannot be believed of a drive
// of one manner, in words that go on from "only with"; nothing where it can.
std::optional<std::string> conflict(const Problem &fitted, const Candidate &candidate);

// Says so, once.
void note_conflict(Diagnosis &diagnosis, const std::string &label, const std::string &only_with);

// A better place of the joint fit may lean on limits that the place where a name was accepted did not need: what was accepted is asked
// again, the last first, each beside what is left by then. `take_back(i)` removes the i-th name and hands back the model without it,
// fitted.
void reject_conflicts(Diagnosis &diagnosis, Problem &last, const std::function<Problem(std::size_t)> &take_back);

// More rolling resistance, of all wheels: every model states one, and it asks nothing of the ground's grip, as a drag or a slope does.
bool changes_stated_number(const Candidate &candidate);

} // namespace traction::lab
