// parts.h - the catalogue in four parts, by where the effects act; catalogue() is their sum in this order.
#pragma once

#include "catalogue.h"

#include <vector>

namespace traction::sim {

std::vector<Effect> drive_effects();  // motor, bridge, gear
std::vector<Effect> ground_effects(); // wheel and soil
std::vector<Effect> body_effects();   // loads, geometry, forces on the body
std::vector<Effect> sensor_effects(); // what only the measurement sees, and the delay of the command

// One strength parameter: zero means absent.
inline EffectParameter strength(std::string_view name, std::string_view unit, std::string_view meaning, double minimum, double maximum,
                                double typical, double of_interest) {
    EffectParameter p;
    p.name = name, p.unit = unit, p.meaning = meaning;
    p.minimum = minimum, p.maximum = maximum, p.typical = typical, p.of_interest = of_interest;
    return p;
}

// One shape parameter, tried over its variants (none: the variants come from the log).
inline EffectParameter shape(std::string_view name, std::string_view unit, std::string_view meaning, double minimum, double maximum,
                             double typical, std::vector<double> variants) {
    EffectParameter p;
    p.name = name, p.unit = unit, p.meaning = meaning, p.strength = false;
    p.minimum = minimum, p.maximum = maximum, p.typical = typical, p.variants = std::move(variants);
    return p;
}

} // namespace traction::sim
