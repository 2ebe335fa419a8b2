// rover.h - one rover as its file states it (rovers/*.toml, docs/rover_format.md): geometry, wheels, motors, gear, encoders, converters,
// radar, IMU, limits, gains, and which wheels there are; each number with its unit and its source.
//
// From it come the plant (put_in_plant), the sensors (sensors_of), the converters of hal/sim, the firmware's parameters and the lab's model
// (host_tools/rover). A world and a firmware may be given two of them: a firmware that is wrong about its rover.
#pragma once

#include "sim/plant/plant.h"
#include "sim/sensors/sensors.h"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace traction::sim {

// A row of the format: [section] name = reference, in low..high.
struct RoverKey {
    std::string_view section, name, unit;
    double reference, low, high; // reference: lhomme_desages.toml; of a choice that is left out it means nothing
    bool choice;                 // may be left out: a gain or limit, which the firmware makes from the rover's own numbers, or [layout]
    std::string_view firmware;   // the firmware's parameter of this value; empty: the world's alone
};
std::span<const RoverKey> rover_keys();

struct RoverValue {
    double value = 0;
    bool given = false; // by a file; else the reference's
    std::string source; // as the file has it
    std::size_t line = 0;
};

// What differs from wheel to wheel (0 rear left, 1 rear right, 2 front left, 3 front right).
struct RoverWheel {
    std::optional<double> radius_m;             // the firmware, which has one radius, is told the mean
    double encoder_sign = 1;                    // -1: the count falls as the wheel drives forward
    std::optional<double> current_offset_count; // instead of current.offset_count
};

struct RoverDescription {
    std::string name = "Lhomme-Desages", file = "built in";
    std::string radar = "MDU1130"; // of radar_models()
    std::size_t radar_line = 0;
    std::size_t hardware_line = 0;  // of [hardware], which hal/linux/hardware.h reads; 0: none
    std::vector<RoverValue> values; // by index of rover_keys()
    std::array<RoverWheel, wheel_count> wheel;
    std::array<int, 2> drives{-1, -1}; // layout.drives, left and right; -1: every wheel has a motor of its own
    std::size_t drives_line = 0;

    RoverDescription();                                               // the reference rover
    double at(std::string_view section, std::string_view name) const; // throws std::logic_error for a name that is no key
    RoverValue &value(std::string_view section, std::string_view name);
    const RoverValue &value(std::string_view section, std::string_view name) const;
    double radius_m(std::size_t wheel) const;
    double mean_radius_m() const;
    double encoder_counts_per_turn() const; // of a wheel
    LayoutParameters layout() const;        // [layout]: sim/plant/layout.h
    double heaviest_kg() const;             // on one driven wheel, standing on level ground
    double current_offset_count(std::size_t wheel) const;
};

// Throws ScenarioError with file, line, key, value and mend; std::filesystem::filesystem_error when the file cannot be read. Every key but
// a choice must be there.
RoverDescription read_rover_file(const std::string &path);
RoverDescription parse_rover(const std::string &text, const std::string &file); // `file` for messages

// `path` as it is, or else beside the folder of `from` ("rovers/x.toml" of a scenario), or else in it.
std::string find_rover_file(const std::string &path, const std::string &from);

void put_in_plant(const RoverDescription &rover, RoverParameters &plant);
SensorConfig sensors_of(const RoverDescription &rover);

// Throws ScenarioError for a [layout] that cannot stand or drive, with the key and the mend.
void check_layout(const RoverDescription &rover);

// Wheels whose radius is not wheels.radius_m, as the effect wheel_radius on each.
std::vector<ActiveEffect> wheel_differences(const RoverDescription &rover);

} // namespace traction::sim
