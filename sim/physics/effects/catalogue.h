// catalogue.h - every optional physical effect by name: what it is, its law, its parameters, its source, and what reveals it.
//
// One row per effect for all readers: the plant and the sensors apply it, the lab offers it as a candidate, `traction effects` prints it.
// An effect is absent when its strength parameters are zero. The laws are pure functions in laws.h; acting.h holds the numbers that the
// rows point to and adds the laws up where they act.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace traction::sim {

// Where an effect acts, hence which balance it disturbs.
enum class ActsOn { wheel_torque, wheel_force, body_force, motor_voltage, kinematics, load, sensor };

// What an effect asks of whoever computes with it. The first four: what must be computed again when one of its strengths moves.
enum Needs : unsigned {
    needs_motion = 1,  // the body's motion
    needs_torque = 2,  // the motors' torque balance
    needs_voltage = 4, // their voltage balance
    needs_sensors = 8, // the readings of accelerometer, radar, camera
    needs_stages = 15,
    needs_memory = 16, // the wheel's contact remembers: no linear step beside a known motion, a whole integration
    needs_path = 32,   // a force that depends on the path travelled
    needs_heat = 64,   // the winding remembers
    needs_bend = 128   // current is not linear in voltage
};

template <typename T> struct WheelEffectsOf; // acting.h
using WheelEffects = WheelEffectsOf<double>;
struct BodyEffects;

// One parameter of an effect. `strength` parameters are the ones fitted (zero means absent); the others shape the law and are
// tried over a few `variants`.
struct EffectParameter {
    std::string_view name;
    std::string_view unit; // SI, "1" where dimensionless
    std::string_view meaning;
    double WheelEffects::*in_wheel = nullptr; // its number where the effect is switched on: one of the two
    double BodyEffects::*in_body = nullptr;
    bool strength = true;
    double minimum = 0; // plausible range
    double maximum = 0;
    double typical = 0;             // what the simulator uses when a scenario names the effect and not the value
    double of_interest = 0;         // smallest size worth knowing (strength parameters only)
    std::vector<double> variants;   // values to try (shape parameters only; none: the log suggests them)
    bool both_signs = false;        // range and variants stand for the negative values as well
    bool takes(double value) const; // within its plausible range
    std::string range() const;      // in words: "a number from 1 to 8, or from -8 to -1"
};

struct Effect {
    std::string_view name;
    std::string_view title;
    ActsOn acts_on = ActsOn::wheel_torque;
    bool per_wheel = false; // may be confined to one wheel: key `wheel` = index, or absent for all
    unsigned needs = 0;     // of Needs
    std::string_view equation;
    std::string_view source;    // citation, or "derived here: ..."
    std::string_view signature; // what its residual looks like
    std::string_view reveals;   // the manoeuvre that shows it, and what it can be confused with
    std::string_view measure;   // what tells it without driving
    std::vector<EffectParameter> parameters;
};

// True of an effect on a motor, its gear or its sensors: there is one for all the wheels that a motor turns. False of one on a wheel.
bool of_motor(const Effect &effect);

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
