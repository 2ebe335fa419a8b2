// kinds.h - what the generator can hide in a machine: the catalogue's effects by name, and kinds that no catalogue holds.
//
// Written from the common table of names and laws alone. Shares no code with sim/ or host_tools/lab: it is the judge's stand-in.
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace traction::generator {

inline constexpr int wheels = 4;
using PerWheel = std::array<double, wheels>;

// Everything that may be hidden; zero is absent.
struct Hidden {
    // drive train, per wheel
    PerWheel coulomb{}, viscous{}, stribeck{}, stribeck_speed{1, 1, 1, 1}, play{}, ripple_cos{}, ripple_sin{};
    PerWheel ripple_order{1, 1, 1, 1}, wiring{}, dead_voltage{}, constant_change{}, rolling{}, radius_change{};
    PerWheel current_gain{}, current_offset{}, missed{};
    // machine and ground
    double mesh = 0, heating = 0, heating_time = 60, sinkage = 0, speed_resistance = 0, multi_pass = 0, height = 0;
    double offset_x = 0, offset_y = 0, patch = 0, patch_start = 0, patch_length = 1, gradient = 0, relaxation = 0;
    double sliding_loss = 0, shear = 0, scrub = 0, slope = 0, slope_direction = 0, tether = 0, drag = 0;
    // sensors and actuation
    double accel_bias = 0, accel_drift = 0, accel_scale = 0, accel_tilt = 0, radar_scale = 0, radar_pitch = 0;
    double voltage_gain = 0, camera_delay = 0, camera_scale = 0, actuation_delay = 0;
    double accel_delay = 0, accel_lag = 0, gyro_delay = 0, radar_delay = 0, current_delay = 0;
    double accel_ahead = 0, accel_left = 0, gyro_scale = 0;
    // outside the catalogue, on wheels
    PerWheel friction_squared{}, dead_band{}, hysteresis{}, torque_limit{}, friction_drift{}, reverse_friction{}, resonance{};
    PerWheel resonance_speed{5, 5, 5, 5}, friction_step{}, friction_step_time{60, 60, 60, 60}, wear_in{}, wear_in_time{30, 30, 30, 30};
    PerWheel tooth{}, speed_loss{}, gain_drift{}, tyre_loss{};
    // outside the catalogue, of the machine and its ground
    double hysteresis_angle = 0.3, place_wave = 0, place_length = 0.6, turn_resistance = 0, coupling = 0, grip_speed = 0, grip_drift = 0;
    double water = 0, rolling_squared = 0, shear_peak = 0, mud = 0, mud_start = 0, mud_length = 1;
    double swing = 0, swing_Hz = 1, gusts = 0, waves = 0, wave_length = 2, dropped = 0, dropped_time = 60;
};

struct KindParameter {
    std::string_view name;
    double low = 0, high = 0; // sizes drawn in a blind campaign, absolute value
    bool either_sign = false;
    bool strength = true;
    PerWheel Hidden::*per_wheel = nullptr;
    double Hidden::*whole = nullptr;
    std::vector<double> choices = {}; // shape parameters drawn from a list
};

// The sets in which a kind is drawn: a set that was drawn once keeps its draws.
enum class Sets { all, fleet, bent };

struct Kind {
    std::string_view name;
    bool outside = false;
    std::string_view variable; // outside the catalogue: what the residual really depends on; several accepted, by '|'
    std::vector<KindParameter> parameters;
    Sets drawn = Sets::all;
    std::string_view law = {}; // outside: the catalogue's name for this law where it has learnt it since; several, by '|'
    bool per_wheel() const { return parameters.front().per_wheel != nullptr; }
};

const std::vector<Kind> &kinds();
const Kind *find_kind(std::string_view name);

// One thing hidden: name, wheel (-1: all), value per parameter.
struct Setting {
    std::string name;
    int wheel = -1;
    std::vector<std::pair<std::string, double>> values;
};

// "slip_sinkage:coefficient=0.2", "wiring_resistance:wheel=2,resistance_ohm=0.5". Throws std::invalid_argument.
Setting parse_setting(std::string_view text);
void apply(const Setting &setting, Hidden &hidden); // throws std::invalid_argument for an unknown name

} // namespace traction::generator
