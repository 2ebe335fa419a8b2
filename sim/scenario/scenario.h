// scenario.h - one experiment as a file states it: ground, rover, sensors, drive plan, faults, effects, seed, duration.
//
// The format is docs/scenario_format.md. Everything is checked when read: an unknown key, a wrong type or a value out of range is
// a ScenarioError that names file, line and key.
#pragma once

#include "drive_plan.h"
#include "hidden.h"
#include "rover.h"
#include "scenario_error.h"

#include "sim/plant/plant.h"
#include "sim/sensors/can_fault.h"
#include "sim/sensors/fault.h"
#include "sim/sensors/sensors.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace traction::sim {

struct WheelBlockSpan {
    int wheel = 0;
    double from_s = 0, to_s = 0;
};

// The battery gives so much less.
struct SupplySag {
    double sag_V = 0, from_s = 0, to_s = 0;
};

// The loop sleeps through so many ticks at from_s, and again every so often until to_s; every_s 0: once.
struct MissedTicks {
    std::uint32_t ticks = 1;
    double every_s = 0, from_s = 0, to_s = 0;
};

struct FirmwareChoice {
    std::string config = "default";           // or "paper"
    double doppler_scale = 0;                 // calibration of the radar; 0: as the configuration has it
    std::optional<RoverDescription> believes; // the rover that the firmware takes itself for; none: the one it is
};

struct Scenario {
    std::string name; // file name without folder and ending
    std::string file;
    std::string title;
    std::string text; // the file, for its hash
    double duration_s = 0;
    std::uint64_t seed = 1;
    RoverDescription rover;                   // what it is: plant and sensors below are made of it, and the firmware
    PlantConfig plant;                        // its effects are filled at run time
    std::optional<std::uint64_t> ground_seed; // of the grip's field; none: each run seed has its own field
    SensorConfig sensors = default_sensors();
    FirmwareChoice firmware;
    std::vector<DriveSegment> drive;
    std::vector<SensorFault> sensor_faults;
    bool can_bus = false;             // wheels and sensors are nodes on a CAN bus (hal/sim/bus.h)
    std::vector<CanFault> can_faults; // of that bus
    std::vector<WheelBlockSpan> wheel_blocks, open_motors;
    std::vector<SupplySag> supply_sags;
    std::vector<MissedTicks> missed_ticks;
    std::vector<std::pair<double, double>> emergency_stops, command_losses; // [from, to) s
    std::vector<ActiveEffect> effects;
    std::optional<HiddenDraw> hidden;
};

// Another rover drives: plant and sensors are made of it again. What [rover], [sensors] and [radar] say of the old one is gone; where it
// starts stays.
void set_rover(Scenario &scenario, RoverDescription rover);

// What the scenario and these effects ask of wheels must be of wheels that the rover has; throws ScenarioError.
void check_wheels(const Scenario &scenario, std::span<const ActiveEffect> effects = {});

// Throws ScenarioError; std::filesystem::filesystem_error when the file cannot be read.
Scenario read_scenario(const std::string &path);

// The same from text; `file` is for messages.
Scenario parse_scenario(const std::string &text, const std::string &file);

// "slip_sinkage:coefficient=0.15,wheel=2" as an effect; what is not given takes its typical value. Throws ScenarioError.
ActiveEffect parse_effect(const std::string &text);

} // namespace traction::sim
