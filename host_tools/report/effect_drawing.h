// effect_drawing.h - a small drawing of an effect from its row of the catalogue: the part of the rover on which it acts, with a force,
// a circuit or a sensor there, and the curve that it adds at its usual size.
//
// No effect is known here by its name: where it acts is the row's acts_on (a sensor by the first word of its name), and the curve is what
// the place functions of acting.h make of the row's usual values. So an effect that is added to the catalogue has its drawing. Same row,
// same bytes.
#pragma once

#include "sim/physics/effects/catalogue.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace traction::report {

// What the effect adds, over what it follows most.
struct EffectCurve {
    std::string what, over;   // "friction [N m]", "wheel speed [rad/s]"
    std::vector<double> x, y; // of equal length, x rising; y is 0 where the effect adds nothing
};

// Nothing where no place function has the effect: its law acts inside a sensor, a circuit or the balance of the body.
std::optional<EffectCurve> curve_of(const sim::Effect &effect);

// What the drawing shows, in words: its accessible name.
std::string drawing_words(const sim::Effect &effect);

// SVG, 220 by 84 units. alone: a file of its own, with its colours, light and dark; else the page's style sheet colours it by class.
std::string effect_svg(const sim::Effect &effect, bool alone);

// { name: SVG } of every effect of the catalogue that `result` names under "effect" or "name".
nlohmann::json drawings_of(const nlohmann::json &result);

} // namespace traction::report
