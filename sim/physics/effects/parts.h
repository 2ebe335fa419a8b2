// parts.h - the catalogue in four parts, by where the effects act; catalogue() is their sum in this order.
#pragma once

#include "acting.h"
#include "catalogue.h"

#include <vector>

namespace traction::sim {

std::vector<Effect> drive_effects();  // motor, bridge, gear
std::vector<Effect> ground_effects(); // wheel and soil
std::vector<Effect> body_effects();   // loads, geometry, forces on the body
std::vector<Effect> sensor_effects(); // what only the measurement sees, and the delay of the command

using W = WheelEffects;
using B = BodyEffects;

inline EffectParameter at(double W::*field) {
    EffectParameter p;
    p.in_wheel = field;
    return p;
}
inline EffectParameter at(double B::*field) {
    EffectParameter p;
    p.in_body = field;
    return p;
}

// One strength parameter: zero means absent.
template <typename Field>
EffectParameter strength(Field field, std::string_view name, std::string_view unit, std::string_view meaning, double minimum,
                         double maximum, double typical, double of_interest) {
    EffectParameter p = at(field);
    p.name = name, p.unit = unit, p.meaning = meaning;
    p.minimum = minimum, p.maximum = maximum, p.typical = typical, p.of_interest = of_interest;
    return p;
}

// One shape parameter, tried over its variants (none: the variants come from the log).
template <typename Field>
EffectParameter shape(Field field, std::string_view name, std::string_view unit, std::string_view meaning, double minimum, double maximum,
                      double typical, std::vector<double> variants) {
    EffectParameter p = at(field);
    p.name = name, p.unit = unit, p.meaning = meaning, p.strength = false;
    p.minimum = minimum, p.maximum = maximum, p.typical = typical, p.variants = std::move(variants);
    return p;
}
inline EffectParameter both_signs(EffectParameter p) {
    p.both_signs = true;
    return p;
}

} // namespace traction::sim
