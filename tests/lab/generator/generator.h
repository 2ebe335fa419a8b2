// generator.h - independent sealed logs for the blind campaign: a rover nobody in host_tools or sim wrote, driven and measured.
#pragma once

#include "kinds.h"
#include "machine.h"

#include "host_tools/log/log.h"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace traction::generator {

// How the world reaches the log. All zero: the chain of the first blind sets (counts, means over the tick, an even clock).
struct SensorChain {
    double accel_cutoff_Hz = 0;  // first-order low pass in the accelerometer
    double accel_late_s = 0;     // its samples are this old
    bool current_at_end = false; // sampled once at the end of the PWM period, not averaged over the tick
    bool angle_only = false;     // wheel angles in steps, no counts
    double jitter_s = 0;         // standard deviation of a tick's length; the stamps are right to a fifth of it
    bool foreign = false;        // a CSV of its own: units, names, signs and order of wheels need a map
};

// What another workshop does otherwise. As they stand: the first blind sets, to the last digit.
struct Habits {
    double tick_s = 0.01; // of loop and log, whole milliseconds
    double noise = 1;     // of the sensors, over what the header states
    double begin_s = 0;   // the logger is switched on that late, the machine driving
    double sag = 0;       // share of its voltage that the battery loses over the log, evenly
    double soft = 1;      // of the battery's internal resistance
    bool gyro = true, accel = true;
    bool heading = true; // of the camera; without it an antenna's track, in a frame of its own
};

struct GeneratorConfig {
    Soil soil = Soil::sand;
    Size size = Size::small;
    SensorChain chain;
    Habits habits;
    Knee knee = Knee::stated;
    int run = 0;                // another drive of the same machine: other plan, place and noise
    std::string drive = "full"; // see make_plan
    double duration_s = 120;
    std::uint64_t seed = 1;       // machine, drive, ground and noise
    std::uint64_t noise_seed = 0; // another value: the same run with other sensor noise (a repeat run)
    std::vector<Setting> hidden;
    bool apart = false; // every wheel drawn for itself (WheelSpread); false: the logs of the first blind sets, to the last digit
    bool exact = false; // nominal machine, no ground noise (for checks)
    bool quiet = false; // no sensor noise (for checks)
    bool camera = true, radar = true, battery = true;
    bool truth = false; // add truth.* columns (for checks; sealed logs never have them)
};

// The measured log, header with the sensors' specifications ("noise.<signal>"), never with what is hidden.
log::Log generate(const GeneratorConfig &config);

// The machine that `config` draws (the seal keeps it, so that a judge can tell which nuisance was off).
Machine machine_of(const GeneratorConfig &config);

// The model that the operator would write: the data sheet's values, one for all wheels, and its tolerances.
std::string data_sheet(const GeneratorConfig &config);

Soil soil_of(const std::string &name); // throws std::invalid_argument
std::string name_of(Soil soil);

// Writes the log as the machine's own program would (chain.foreign): milliseconds, milliamperes, degrees, right motors mounted the other
// way round, wheels in an order of their own; and the map that reads it. Without `foreign`: our CSV, and no map.
void write_log(const log::Log &log, const GeneratorConfig &config, const std::string &csv, const std::string &map);

// What a blind campaign hides under this seed: clean, one, two (of the catalogue) or outside; soil drawn too. category: that one instead.
struct BlindCase {
    std::string category; // "clean", "one", "two", "outside"
    GeneratorConfig config;
};
BlindCase draw_case(std::uint64_t seed, double duration_s, const std::string &category = "");

// The fleet: wheels apart, three sizes, five soils, sensor chains, plans and lengths (60 to 300 s) of their own, laws on single wheels.
// category: one of the four, or empty to draw it.
BlindCase draw_fleet_case(std::uint64_t seed, const std::string &category = "");

// The fleet with habits of its own: other plans (turns alone, a long halt, to and fro), loops of 5 to 20 ms, noise of half to twice what is
// stated, a log that begins while driving, a battery that sags, sensors that are not there. No rule of the lab was made on these.
BlindCase draw_strange_case(std::uint64_t seed, const std::string &category = "");

// The fleet on grounds whose curve over slip is none of the laws that a sheet can name (Knee).
BlindCase draw_bent_case(std::uint64_t seed, const std::string &category = "");
std::string name_of(Size size);
Size size_of(const std::string &name); // throws std::invalid_argument

} // namespace traction::generator
