// sideways.h - whether a rover is followed sideways through its bends (motion = "planar") although its model says "longitudinal".
//
// In a bend a skid steer's middle drifts outwards until the side forces are M v r, and front and rear wheels meet the ground at different
// angles: pull and currents differ by that. So does the middle of a machine with one axle before or behind it. No number is added, so the
// log alone decides: both motions are fitted, and the sideways one is taken where the log is likelier by it, each by its own scales, by
// more than the standard error of that over blocks of 5 s. Where a camera sees the track its displacement to the left is a row of both, and
// has the last word: a motion that it predicts better than none is followed, one that it predicts worse is not. Where it says nothing, or
// is not there, what a sideways grip (`lateral_scrub`) explains as well is none: it bends a straight machine's yaw rate and currents, and a
// drift that is not there made them half as wrong.
#pragma once

#include "host_tools/lab/inputs/dataset.h"
#include "host_tools/lab/model/model.h"

#include <string>

namespace traction::lab {

// `data`: of `model`. Asked of logs that turn while they move, with a yaw rate, and where a wheel before or behind the middle
// grips sideways.
bool drifts_sideways(const Model &model, const Dataset &data);

// What is told of a model whose motion was changed so.
inline const std::string followed_sideways =
    "the rover drifts in its bends: it is followed sideways (motion = \"planar\"), which predicts this log better than motion = "
    "\"longitudinal\"";

} // namespace traction::lab
