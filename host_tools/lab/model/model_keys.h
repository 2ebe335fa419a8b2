// model_keys.h - the keys a model file may hold: unit, default, bounds, and how far a machine usually is from its data sheet.
#pragma once

#include <span>
#include <string_view>

namespace traction::lab {

struct ModelKey {
    std::string_view key;
    std::string_view unit;
    double value; // when the file does not say
    double minimum, maximum;
    double relative_prior; // default prior as a fraction of the value: assumed, see docs/model_format.md
    double absolute_prior; // default prior in the unit
    double each_wheel = 0; // default of how far one wheel's value is from what the wheels share, as a share of the value
};

std::span<const ModelKey> rover_keys();
std::span<const ModelKey> wheel_keys();
std::span<const ModelKey> motor_keys();
std::span<const ModelKey> soil_keys();
double default_each_wheel(std::string_view key); // of [wheels] and [motor]; 0 for others
std::span<const ModelKey> sensor_keys();         // "current.noise_A" stands for noise_A in [sensors.current]

} // namespace traction::lab
