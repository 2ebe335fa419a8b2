// model.h - the model of a machine as its file states it: geometry, drive, soil, sensors, effects, lineage (docs/model_format.md).
//
// Any number of wheels at any place and heading, so a single-wheel bench, an unloaded motor, an omni robot and a six-wheel rover
// are all expressible. Every number is a Parameter: value, unit, bounds, prior, source. The file is only read here; physics.h
// turns a Model into the numbers that the forward model computes with.
#pragma once

#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace traction::lab {

// A mistake in a model file, told once: file, line, key, value, mend.
struct ModelError : std::runtime_error {
    ModelError(const std::string &file, std::size_t line, const std::string &key, const std::string &what_is_wrong,
               const std::string &mend);
    std::string file;
    std::size_t line; // 1-based; 0 when the whole file is meant
    std::string key, mend;
};

struct Parameter {
    double value = 0;
    std::string unit; // SI; "1" where dimensionless
    double minimum = -std::numeric_limits<double>::infinity();
    double maximum = std::numeric_limits<double>::infinity();
    double prior = 0;      // standard deviation around value, in the same unit; 0: not adjusted while an effect is sought
    double each_wheel = 0; // standard deviation of one wheel's value around what the wheels share, as a share of the value
    bool fixed = false;    // never fitted
    std::string source;
    double low = std::numeric_limits<double>::quiet_NaN(); // 95 % interval of a fit, where there was one
    double high = std::numeric_limits<double>::quiet_NaN();
    bool given = false; // false: the default of this program
};

// Parameters by key, such as "resistance_ohm".
using Parameters = std::map<std::string, Parameter>;

enum class SoilLaw { janosi, burckhardt }; // (20) and (21) Lhomme-Desages; "bekker" is (20) with Fm and sc from (5)
enum class BodyMotion {
    longitudinal, // vx from the forces; the yaw rate is taken from the log
    planar,       // vx, vy and yaw rate from the forces (omni drives)
    imposed,      // the log gives the body's speed (a bench carriage)
    none,         // wheels off the ground
};

struct WheelSpec {
    std::string name;
    Parameters geometry; // x_m, y_m, heading_rad, radius_m, width_m, load_N (0: from the geometry)
    Parameters motor;    // complete: the [motor] table with this wheel's overrides
    Parameters soil;     // complete: the [soil] table with this wheel's overrides
    bool driven = true;
    int drive = -1;             // the wheel whose motor turns this one too, by a chain or a belt one to one; -1: its own motor, or none
    bool grips_sideways = true; // false: rollers (omni)
};

// An effect in the model: one of the catalogue, or the user's own (`expression` not empty).
struct EffectUse {
    std::string name;
    int wheel = -1; // -1: all
    Parameters parameters;
    std::string acts_on;    // wheel_torque, wheel_force, body_force, voltage, soil_strength, sensor.accel, sensor.radar, ...
    std::string expression; // muparser, in the named signals of terms.h and the parameters above
};

// What belongs to one run and not to the machine: the offsets of its sensors, and its ground where the file states one. A key that is not
// here is the machine's.
struct RunSpec {
    std::string log;                                           // file name without folder
    Parameters soil;                                           // "mu", for all wheels
    Parameters sensors;                                        // "accel.bias_m_s2", "gyro.bias_rad_s"
    double start_s = std::numeric_limits<double>::quiet_NaN(); // in the data set at hand (inputs/begin_runs.h); NaN: it is not in there
};

// One step of the model's history.
struct LineageEntry {
    std::string label;                                       // "baseline", "+ slip_sinkage"
    std::string log;                                         // file name without folder
    std::string date;                                        // the log's own date, if it has one
    double train = std::numeric_limits<double>::quiet_NaN(); // error in units of noise
    double heldout = std::numeric_limits<double>::quiet_NaN();
    double floor = std::numeric_limits<double>::quiet_NaN();
    std::string despite = {}; // errors of the check that were overridden, separated by blanks
};

struct Model {
    std::string name;
    std::string file;
    BodyMotion motion = BodyMotion::longitudinal;
    bool halves = false; // of the chassis, left and right, on a revolute joint across: each finds its own pitch
    SoilLaw soil_law = SoilLaw::janosi;
    Parameters rover; // mass_kg, yaw_inertia_kg_m2, centre_height_m, gravity_m_s2, battery_voltage_V
    std::vector<WheelSpec> wheel;
    Parameters sensors; // "current.noise_A", "radar.window_s", ...
    bool unsigned_current = false;
    std::vector<EffectUse> effects;
    std::vector<RunSpec> runs;
    std::vector<LineageEntry> lineage;

    const EffectUse *find_effect(const std::string &effect, int wheel_index) const; // nullptr when absent
    std::size_t motor_of(std::size_t index) const {                                 // the wheel at whose motor wheel `index` turns
        return wheel[index].drive < 0 ? index : static_cast<std::size_t>(wheel[index].drive);
    }
    bool couples() const; // some motor turns several wheels
};

// On a motor, its gear or its sensors: it cannot be on a wheel that turns with another wheel's.
bool acts_on_motor(const EffectUse &use);

// What one motor turns: its own wheel and those that turn with it. Empty for a wheel that turns with another.
std::vector<std::size_t> wheels_of_motor(const Model &model, std::size_t index);

// Reads a model file. Throws ModelError; log::FileError when the file cannot be read.
Model read_model(const std::string &path);

// The same from text; `file` is for messages.
Model parse_model(const std::string &text, const std::string &file);

// The model as a file's text, complete and readable. parse_model(model_text(m)) has the same numbers.
std::string model_text(const Model &model);

// Whole or not at all (host_tools/log/write_file.h). Throws log::FileError.
void write_model(const Model &model, const std::string &path);

} // namespace traction::lab
