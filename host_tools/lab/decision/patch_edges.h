// patch_edges.h - where a patch of the ground begins and ends along the way. An edge moves whole rows from one side of it to the other, so
// that the error falls in steps and a derivative at an edge sees one row of each wheel: the edges are searched at the true prediction.
#pragma once

#include "host_tools/lab/fit/problem.h"
#include "host_tools/lab/model/model.h"

#include <string>

namespace traction::lab {

struct PatchEdges {
    double start_m = 0, length_m = 0;
};

// From where a fitted problem has the patch of this effect ("soil_patch", "resistance_patch"), all other parameters following by a linear
// step: both edges and the patch as a whole go to where the error is least, in steps of `step_m` and of its doubles.
PatchEdges search_edges(const Problem &fit, const std::string &effect, double step_m);

// Half of their 95 % intervals. They end where the error has risen by 3.84 phi, (1) to (3) of profile.h with the phi of the patch's size,
// and a row (two steps) later; the way that a place is told by is the model's own, and where a camera or a radar has it go another way up
// to there, they are wider by that.
struct EdgeErrors {
    double start_half_m = 0, length_half_m = 0;
};
EdgeErrors edge_errors(const Problem &fit, const std::string &effect, double step_m);

// A patch of a model that is fitted: its edges by such searches, each followed by a fit, as long as the error falls. Their intervals are
// written into the model. Whether they moved; `problem` is then the fit of the model as it stands.
bool place_patch(Model &model, const Dataset &data, const std::string &effect, Problem &problem);

// How far the rover goes in half a row: an edge within it is not seen.
double half_row_m(const Model &model, const Dataset &data);

} // namespace traction::lab
