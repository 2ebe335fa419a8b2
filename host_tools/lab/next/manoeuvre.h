// manoeuvre.h - what a rover can be asked to drive so that a question is answered, and a model as a scenario that drives it.
//
// Segments are sim/scenario's text (docs/scenario_format.md); the lab only writes them. What drives is lent by the caller (next.h).
#pragma once

#include "host_tools/lab/model/model.h"

#include <string>
#include <vector>

namespace traction::lab {

struct Manoeuvre {
    std::string title;
    std::string segments; // [[drive]] tables
    double duration_s = 0;
    bool each_wheel = false;           // asks wheels of one side for different speeds
    std::vector<std::string> good_for; // effects it is known to show or separate: said where nothing can be simulated
};

const std::vector<Manoeuvre> &manoeuvres();
// Those that this machine can drive: where a motor turns several wheels, none that asks each wheel for a speed of its own.
const std::vector<Manoeuvre> &manoeuvres_of(const Model &model);

// Why the plant cannot drive this machine ("it has 3 wheels"); empty when it can: four driven wheels, straight, at (+-x, +-y), rear
// left, rear right, front left, front right, free to move on the ground, with a motor each or one a side.
std::string cannot_drive(const Model &model);

// A scenario with the model's own numbers for rover, ground and catalogue effects, and these manoeuvres in their order, a rest before
// and after. `notes` receives what a scenario cannot say of the model. Meaningless unless cannot_drive() is empty.
std::string scenario_of(const Model &model, const std::vector<const Manoeuvre *> &list, std::vector<std::string> &notes);

// The same with drive tables of the caller's own: `segments`, lasting duration_s.
std::string scenario_of(const Model &model, const std::string &title, const std::string &segments, double duration_s,
                        std::vector<std::string> &notes);

// What to measure without driving when no manoeuvre tells this effect: "weigh the wheels one by one".
std::string measure_instead(const std::string &effect);

} // namespace traction::lab
