// catalogue.h - every optional physical effect by name: what it is, its law, its parameters, its source, and what reveals it.
//
// One definition for all readers: the plant applies the laws, the lab offers them as candidates, `traction effects` prints them.
// An effect is absent when its strength parameters are zero. The laws themselves are pure functions in laws.h.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace traction::sim {

// Where an effect acts, hence which balance it disturbs.
enum class ActsOn { wheel_torque, wheel_force, body_force, motor_voltage, kinematics, load, sensor };

// One parameter of an effect. `strength` parameters are the ones fitted (zero means absent); the others shape the law and are
// tried over a few `variants`.
struct EffectParameter {
    std::string_view name;
    std::string_view unit; // SI, "1" where dimensionless
    std::string_view meaning;
    bool strength = true;
    double minimum = 0; // plausible range
    double maximum = 0;
    double typical = 0;           // what the simulator uses when a scenario names the effect and not the value
    double of_interest = 0;       // smallest size worth knowing (strength parameters only)
    std::vector<double> variants; // values to try (shape parameters only)
};

struct Effect {
    std::string_view name;
    std::string_view title;
    ActsOn acts_on = ActsOn::wheel_torque;
    bool per_wheel = false; // may be confined to one wheel: key `wheel` = index, or absent for all
    std::string_view equation;
    std::string_view source;    // citation, or "derived here: ..."
    std::string_view signature; // what its residual looks like
    std::string_view reveals;   // the manoeuvre that shows it, and what it can be confused with
    std::vector<EffectParameter> parameters;
};

// All effects, in a fixed order.
std::span<const Effect> catalogue();

// The effect of that name, or nullptr.
const Effect *find_effect(std::string_view name);

// An effect switched on: which, on which wheel (-1: all), with one value per parameter of the catalogue entry, in its order.
struct ActiveEffect {
    const Effect *effect = nullptr;
    int wheel = -1;
    std::vector<double> values;
    double value(std::string_view parameter) const; // throws std::out_of_range for an unknown name
};

} // namespace traction::sim
