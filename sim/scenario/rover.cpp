#include "rover.h"

#include "scenario_error.h"

#include "sim/physics/effects/catalogue.h"
#include "sim/physics/math.h"
#include "sim/plant/rocker.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace traction::sim {

namespace {

constexpr bool own = false, choice = true;

// The reference is table I (Lhomme-Desages); sources in rovers/lhomme_desages.toml.
constexpr RoverKey keys[] = {
    {"body", "mass_kg", "kg", 2.88, 0.5, 200, own, "mass_kg"},
    {"body", "length_m", "m", 0.30, 0.05, 4, own, ""},
    {"body", "width_m", "m", 0.27, 0.05, 4, own, ""},
    {"body", "height_m", "m", 0.185, 0.02, 4, own, ""},
    {"body", "half_wheelbase_m", "m", 0.083, 0.02, 2, own, "half_wheelbase_m"},
    {"body", "half_track_m", "m", 0.12, 0.02, 2, own, "half_track_m"},
    {"body", "centre_height_m", "m", 0, 0, 1, own, ""},
    {"wheels", "radius_m", "m", 0.057, 0.02, 0.5, own, "wheel_radius_m"},
    {"wheels", "width_m", "m", 0.042, 0.005, 1, own, ""},
    {"wheels", "mass_kg", "kg", 0.15, 0.01, 20, own, ""},
    {"wheels", "contact_stiffness_N_m", "N/m", 6000, 100, 1e6, own, ""},
    {"wheels", "contact_damping_Ns_m", "N s/m", 60, 1, 1e5, own, ""},
    {"wheels", "relaxation_length_m", "m", 0.005, 0.0005, 0.3, own, ""},
    {"wheels", "tyre_hysteresis", "1", 0.005, 0, 1, own, ""},
    {"motor", "torque_constant_Nm_A", "N m/A", 0.265, 0.01, 20, own, "torque_constant_Nm_A"},
    {"motor", "resistance_ohm", "ohm", 3.24, 0.02, 100, own, "resistance_ohm"},
    {"motor", "inertia_kg_m2", "kg m^2", 5e-3, 1e-5, 1, own, "inertia_kg_m2"},
    {"motor", "viscous_Nms", "N m s", 1.6e-3, 0, 1, own, "viscous_Nms"},
    {"motor", "coulomb_Nm", "N m", 0.03, 0, 5, own, "coulomb_Nm"},
    {"motor", "winding_K_W", "K/W", 12, 1e-3, 1000, own, "winding_K_W"},
    {"motor", "winding_J_K", "J/K", 5, 0.01, 1e5, own, "winding_J_K"},
    {"motor", "winding_rise_max_K", "K", 95, 10, 200, own, "winding_rise_max_K"},
    {"gear", "ratio", "1", 50, 1, 10000, own, ""},
    {"gear", "wheel_inertia_kg_m2", "kg m^2", 5e-4, 1e-6, 1, own, ""},
    {"gear", "stiffness_Nm_rad", "N m/rad", 40, 0.1, 1e6, own, ""},
    {"gear", "damping_Nms_rad", "N m s/rad", 0.05, 0, 1e4, own, ""},
    {"encoder", "counts_per_motor_turn", "1", 120, 1, 1e6, own, ""},
    {"battery", "voltage_V", "V", 7.2, 1, 60, own, "battery_voltage_V"},
    {"battery", "resistance_ohm", "ohm", 0.06, 0, 5, own, ""},
    {"battery", "V_per_count", "V", 0.004, 1e-5, 1, own, "battery_V_per_count"},
    {"battery", "offset_count", "1", 0, -32768, 32767, own, "battery_offset_count"},
    {"battery", "max_count", "1", 4095, 255, 65535, own, "battery_max_count"},
    {"battery", "noise_V", "V", battery_noise_V, 0, 5, own, ""},
    {"current", "A_per_count", "A", 0.002, 1e-5, 1, own, "current_A_per_count"},
    {"current", "offset_count", "1", 2048, 0, 65535, own, ""}, // per wheel in the firmware
    {"current", "max_count", "1", 4095, 255, 65535, own, "current_max_count"},
    {"current", "noise_A", "A", current_noise_A, 0, 5, own, ""},
    {"accel", "m_s2_per_count", "m/s^2", 0.004, 1e-5, 1, own, "accel_m_s2_per_count"},
    {"accel", "offset_count", "1", 0, -32767, 32767, own, "accel_offset_count"},
    {"accel", "noise_m_s2", "m/s^2", accel_noise_m_s2, 0, 10, own, ""},
    {"accel", "vibration_1_s", "1/s", accel_vibration_1_s, 0, 10, own, ""},
    {"gyro", "rad_s_per_count", "rad/s", 0.0005, 1e-6, 1, own, "gyro_rad_s_per_count"},
    {"gyro", "offset_count", "1", 0, -32767, 32767, own, "gyro_offset_count"},
    {"gyro", "noise_rad_s", "rad/s", gyro_noise_rad_s, 0, 5, own, ""},
    {"radar", "depression_deg", "deg", 20, 5, 45, own, "radar_depression_deg"},
    {"radar", "height_m", "m", 0.3, 0.1, 1, own, ""},
    {"radar", "carrier_Hz", "Hz", 0, 1e9, 2e11, choice, ""}, // these six: of a radar that is not in table II
    {"radar", "vertical_deg", "deg", 0, 1, 120, choice, ""},
    {"radar", "horizontal_deg", "deg", 0, 1, 120, choice, ""},
    {"radar", "band_low_Hz", "Hz", 0, 0, 1000, choice, ""},
    {"radar", "band_high_Hz", "Hz", 0, 1, 1e6, choice, ""},
    {"radar", "speed_high_m_s", "m/s", 1.35, 0.05, 9, choice, ""},
    {"radar", "rate_Hz", "Hz", 512, 202, 6400, own, "radar_rate_Hz"},
    {"radar", "window_samples", "1", 256, 256, 256, own, ""}, // the firmware's transform
    {"radar", "offset_count", "1", 512, 0, 1023, own, "radar_offset_count"},
    {"radar", "max_count", "1", 1023, 255, 1023, own, "radar_max_count"},
    {"radar", "quiet_count2", "1", 2, 0, 1e5, own, "radar_quiet_count2"},
    {"radar", "echo_count", "1", 75, 0, 500, own, ""},
    {"radar", "noise_count", "1", 1, 0, 200, own, ""},
    {"radar", "flicker_count", "1", 0.5, 0, 200, own, ""},
    {"radar", "doppler_scale", "1", 1, 0.5, 2, choice, "doppler_scale"},
    {"limits", "current_continuous_A", "A", 1.5, 0.01, 100, choice, "current_continuous_A"},
    {"limits", "current_peak_A2s", "A^2 s", 8, 1e-3, 1e5, choice, "current_peak_A2s"},
    {"limits", "stall_current_A", "A", 1.4, 0.01, 100, choice, "stall_current_A"},
    {"limits", "stall_speed_rad_s", "rad/s", 0.3, 1e-3, 100, choice, "stall_speed_rad_s"},
    {"limits", "stall_s", "s", 1, 0.02, 60, choice, "stall_s"},
    {"limits", "battery_min_V", "V", 5.4, 0.5, 60, choice, "battery_min_V"},
    {"limits", "battery_low_s", "s", 0.5, 0.02, 60, choice, "battery_low_s"},
    {"limits", "encoder_absurd_rad_s", "rad/s", 60, 0.1, 1000, choice, "encoder_absurd_rad_s"},
    {"limits", "wheel_max_rad_s", "rad/s", 25, 0.1, 500, choice, "wheel_max_rad_s"},
    {"limits", "speed_max_m_s", "m/s", 1, 0.05, 9, choice, "speed_max_m_s"},
    {"limits", "yaw_rate_max_rad_s", "rad/s", 4, 0.05, 20, choice, "yaw_rate_max_rad_s"},
    {"limits", "disagree_m_s", "m/s", 0.15, 0.01, 5, choice, "disagree_m_s"},
    {"limits", "disagree_ratio", "1", 1.5, 1, 10, choice, "disagree_ratio"},
    {"limits", "disagree_s", "s", 1, 0.02, 60, choice, "disagree_s"},
    {"gains", "slip_valid_m_s", "m/s", 0.05, 0.001, 1, choice, "slip_valid_m_s"},
    {"gains", "still_m_s", "m/s", 0.006, 1e-5, 0.1, choice, "still_m_s"},
    {"gains", "dry_speed_rad_s", "rad/s", 0.2, 1e-3, 10, choice, "dry_speed_rad_s"},
    {"gains", "wheel_kp_s", "s", 0.2, 0, 10, choice, "wheel_kp_s"},
    {"gains", "wheel_ki_1", "1", 0.9, 0, 200, choice, "wheel_ki_1"},
    {"gains", "wheel_slew_rad_s2", "rad/s^2", 60, 0.1, 1e4, choice, "wheel_slew_rad_s2"},
    {"gains", "slip_kp_1", "1", 2, 0, 100, choice, "slip_kp_1"},
    {"gains", "slip_ki_1_s", "1/s", 9, 0, 1000, choice, "slip_ki_1_s"},
    {"gains", "slip_gain_speed_m_s", "m/s", 0.2, 0.01, 10, choice, "slip_gain_speed_m_s"},
    {"gains", "speed_kv_rad_m", "rad/m", 17.5, 0, 1000, choice, "speed_kv_rad_m"},
    {"gains", "speed_ki_rad_m_s", "rad/(m s)", 35, 0, 1e4, choice, "speed_ki_rad_m_s"},
    {"gains", "speed_integral_max_rad_s", "rad/s", 6, 0, 500, choice, "speed_integral_max_rad_s"},
    {"gains", "sweep_zero_s", "s", 10, 1, 600, choice, "sweep_zero_s"},
    {"gains", "sweep_duration_s", "s", 20, 1, 3600, choice, "sweep_duration_s"},
    {"layout", "wheels", "1", 4, 1, 6, choice, ""}, // these eight: which wheels there are
    {"layout", "rigid", "1", 0, 0, 1, choice, ""},
    {"layout", "middle_m", "m", 0, -2, 2, choice, ""},
    {"layout", "axle_m", "m", 0, -2, 2, choice, ""},
    {"layout", "caster_m", "m", 0, -2, 2, choice, ""},
    {"layout", "caster_radius_m", "m", 0.02, 0.005, 0.5, choice, ""},
    {"layout", "caster_rolling", "1", 0, 0, 1, choice, ""},
    {"layout", "drawbar_N", "N", 0, -1000, 1000, choice, ""},
    {"layout", "rocker", "1", 0, 0, 1, choice, ""}, // these eight: rocker.h
    {"layout", "rocker_m", "m", 0, -2, 2, choice, ""},
    {"layout", "rocker_height_m", "m", 0.1, 0.01, 2, choice, ""},
    {"layout", "rocker_kg", "kg", 0.3, 0.001, 100, choice, ""},
    {"layout", "bogie_front", "1", 0, 0, 1, choice, ""},
    {"layout", "bogie_m", "m", 0, -2, 2, choice, ""},
    {"layout", "bogie_height_m", "m", 0.1, 0.01, 2, choice, ""},
    {"layout", "bogie_kg", "kg", 0.3, 0.001, 100, choice, ""},
    {"steering", "front", "1", 0, 0, 1, choice, ""}, // these five: which axles steer
    {"steering", "rear", "1", 0, 0, 1, choice, ""},
    {"steering", "angle_max_deg", "deg", 35, 1, 80, choice, ""},
    {"steering", "rate_deg_s", "deg/s", 60, 1, 2000, choice, ""},
    {"steering", "ackermann", "1", 1, 0, 1, choice, ""},
};

std::size_t index_of(std::string_view section, std::string_view name) {
    for (std::size_t i = 0; i < std::size(keys); i++)
        if (keys[i].section == section && keys[i].name == name) return i;
    throw std::logic_error("a rover has no " + std::string(section) + '.' + std::string(name));
}

} // namespace

std::span<const RoverKey> rover_keys() { return keys; }

RoverDescription::RoverDescription() : values(std::size(keys)) {
    for (std::size_t i = 0; i < std::size(keys); i++) values[i].value = keys[i].reference;
}

RoverValue &RoverDescription::value(std::string_view section, std::string_view name_) { return values[index_of(section, name_)]; }
const RoverValue &RoverDescription::value(std::string_view section, std::string_view name_) const {
    return values[index_of(section, name_)];
}
double RoverDescription::at(std::string_view section, std::string_view name_) const { return value(section, name_).value; }

double RoverDescription::radius_m(std::size_t i) const { return wheel[i].radius_m.value_or(at("wheels", "radius_m")); }

double RoverDescription::mean_radius_m() const {
    const double shared = at("wheels", "radius_m");
    double more = 0, wheels = 0; // over the shared one, so that equal wheels keep its bits
    for (const int slot : wheels_of(layout().kind))
        if (slot < wheel_count) more += radius_m(static_cast<std::size_t>(slot)) - shared, wheels++;
    return shared + more / wheels;
}

double RoverDescription::current_offset_count(std::size_t i) const {
    return wheel[i].current_offset_count.value_or(at("current", "offset_count"));
}

double RoverDescription::encoder_counts_per_turn() const { return at("encoder", "counts_per_motor_turn") * at("gear", "ratio"); }

LayoutParameters RoverDescription::layout() const {
    const double wheels = at("layout", "wheels");
    LayoutParameters out;
    out.kind = wheels < 2 ? Layout::carriage : wheels < 4 ? Layout::caster : wheels < 6 ? Layout::four : Layout::six;
    out.rigid = out.kind == Layout::carriage || out.kind == Layout::caster || at("layout", "rigid") > 0.5;
    out.middle_m = at("layout", "middle_m");
    out.axle_m = at("layout", "axle_m"), out.caster_m = at("layout", "caster_m");
    out.caster_radius_m = at("layout", "caster_radius_m"), out.caster_rolling = at("layout", "caster_rolling");
    out.drawbar_N = at("layout", "drawbar_N");
    out.drives = drives;
    out.rocker = at("layout", "rocker") > 0.5;
    if (out.rocker) {
        out.bogie_front = at("layout", "bogie_front") > 0.5;
        out.rocker_m = at("layout", "rocker_m"), out.rocker_height_m = at("layout", "rocker_height_m");
        out.bogie_m = at("layout", "bogie_m"), out.bogie_height_m = at("layout", "bogie_height_m");
        out.rocker_kg = at("layout", "rocker_kg"), out.bogie_kg = at("layout", "bogie_kg");
    }
    out.steer_front = at("steering", "front") > 0.5, out.steer_rear = at("steering", "rear") > 0.5;
    if (out.steer_front || out.steer_rear) {
        constexpr double degree = math::pi / 180;
        out.steer_max_rad = at("steering", "angle_max_deg") * degree, out.steer_rate_rad_s = at("steering", "rate_deg_s") * degree;
        out.ackermann = at("steering", "ackermann");
    }
    return out;
}

double RoverDescription::heaviest_kg() const {
    const LayoutParameters l = layout();
    const double mass = at("body", "mass_kg"), stiffness = at("wheels", "contact_stiffness_N_m");
    if (l.rocker) {
        const auto shares = rocker_loads(l, mass, at("body", "half_wheelbase_m"), at("wheels", "radius_m"));
        double most = 0;
        for (std::size_t side = 0; side < 2; ++side) {
            double all = 0;
            for (std::size_t slot = side; slot < wheel_most; slot += 2) all += shares[slot], most = std::max(most, shares[slot]);
            if (l.drives[0] >= 0) most = std::max(most, all);
        }
        return mass * most;
    }
    if (l.drives[0] >= 0) return mass / 2; // all that one side's motor carries, at every track
    if (l.kind == Layout::four) return mass / 4;
    std::vector<double> ahead_m;
    for (const int slot : wheels_of(l.kind))
        ahead_m.push_back(wheel_place(l, at("body", "half_wheelbase_m"), at("body", "half_track_m"), slot).ahead_m);
    const auto load = [stiffness](std::size_t, double depth_m) { return std::max(0.0, stiffness * depth_m); };
    const Stance stance = stand_on(ahead_m, load, mass, mass / stiffness / static_cast<double>(ahead_m.size()));
    double most = 0;
    for (std::size_t k = 0; k < ahead_m.size(); k++)
        if (!is_caster(l.kind, wheels_of(l.kind)[k])) most = std::max(most, load(k, stance.depth_m + stance.pitch_rad * ahead_m[k]));
    return most;
}

namespace {

// [steering]: whole axles, of a rover that has them and turns no wheel by another axle's motor.
void check_steering(const RoverDescription &rover, const LayoutParameters &layout) {
    const auto fail = [&rover](const char *key, const std::string &what, const std::string &mend) {
        const RoverValue &value = rover.value("steering", key);
        std::string text = std::to_string(value.value);
        text.erase(text.find_last_not_of('0') + 1);
        throw ScenarioError(rover.file, value.line, std::string("steering.") + key, text + (text.back() == '.' ? "0" : ""), what, mend);
    };
    for (const char *key : {"front", "rear"})
        if (const double value = rover.at("steering", key); value != 0 && value != 1) fail(key, "neither 0 nor 1", "give one of them");
    const char *named = layout.steer_front ? "front" : "rear";
    if (!layout.steer_front && !layout.steer_rear) {
        for (const char *key : {"angle_max_deg", "rate_deg_s", "ackermann"})
            if (rover.value("steering", key).given) fail(key, "no axle steers", "leave it out, or write front = 1 or rear = 1");
        return;
    }
    if (layout.kind != Layout::four && layout.kind != Layout::six)
        fail(named, "only a rover of four or six wheels has an axle to steer", "leave [steering] out, or write layout.wheels = 4 or 6");
    if (layout.kind == Layout::six && layout.steer_front != layout.steer_rear)
        fail(named, "two fixed axles have no common centre of turning", "steer both outer axles: front = 1 and rear = 1");
    if (layout.drives[0] >= 0)
        fail(named, "a chain turns the wheels of both axles alike, but round a bend they roll different ways", "leave layout.drives out");
    if (rover.hardware_line != 0)
        throw ScenarioError(rover.file, rover.hardware_line, "hardware", "", "its devices have no steering servo",
                            "leave [hardware] or [steering] out");
}

using Fail = std::function<void(const char *, const std::string &, const std::string &)>;

// Rockers: what they need, and that the centre of mass lies where every wheel bears something.
void check_rocker(const RoverDescription &rover, const LayoutParameters &layout, const Fail &fail) {
    const bool six = layout.kind == Layout::six;
    for (const char *key : {"rocker_m", "rocker_height_m", "rocker_kg", "bogie_front", "bogie_m", "bogie_height_m", "bogie_kg"})
        if (rover.value("layout", key).given && (!layout.rocker || (!six && std::string_view(key).starts_with("bogie"))))
            fail(key, layout.rocker ? "four wheels have no bogie" : "means nothing without rockers", "leave it out, or write rocker = 1");
    if (!layout.rocker) return;
    if (layout.kind != Layout::four && !six) fail("rocker", "only four or six wheels hang on rockers", "leave it out, or write wheels = 6");
    if (layout.rigid) fail("rigid", "rockers turn on the body", "leave out rigid or rocker");
    for (const char *key : {"rocker_height_m", "rocker_kg", "bogie_m", "bogie_height_m", "bogie_kg"})
        if (!rover.value("layout", key).given && (six || !std::string_view(key).starts_with("bogie")))
            fail(key, "missing", "state where the pivots are, and what a rocker and a bogie weigh with their wheels");
    if (const double front = rover.at("layout", "bogie_front"); front != 0 && front != 1)
        fail("bogie_front", "neither 0 nor 1", "give one");
    const double mass = rover.at("body", "mass_kg"), base = rover.at("body", "half_wheelbase_m");
    if (2 * (layout.rocker_kg + (six ? layout.bogie_kg : 0)) > 0.9 * mass)
        fail("rocker_kg", "the links leave a body of less than a tenth of the rover", "lower it, or raise body.mass_kg");
    const RockerSide chain = rocker_side(layout, 0);
    const auto between = [&](double x, double a, double b) { return (x - a) * (x - b) < 0; };
    const auto ahead = [&](int slot) { return wheel_place(layout, base, 0, slot).ahead_m; };
    if (six && !between(layout.bogie_m, ahead(chain.others.front()), ahead(chain.others.back())))
        fail("bogie_m", "not between the bogie's wheels", "give a place between the middle axle and the outer one of the bogie");
    if (!between(layout.rocker_m, ahead(chain.rocker_wheel), six ? layout.bogie_m : ahead(chain.others.front())))
        fail("rocker_m", "not between the rocker's ends", "give a place between its wheel and its other end");
    const auto loads = rocker_loads(layout, mass, base, rover.at("wheels", "radius_m"));
    for (const int slot : wheels_of(layout.kind))
        if (loads[static_cast<std::size_t>(slot)] <= 0)
            fail(six ? "bogie_m" : "rocker_m", "wheel " + std::to_string(slot) + " bears nothing: the rover tips over",
                 "move the pivot, or the axles, until the centre of mass lies between them");
}

} // namespace

void check_layout(const RoverDescription &rover) {
    const auto fail = [&rover](const char *key, const std::string &what, const std::string &mend) {
        const RoverValue &value = rover.value("layout", key);
        std::string text = std::to_string(value.value);
        text.erase(text.find_last_not_of('0') + 1);
        throw ScenarioError(rover.file, value.line, std::string("layout.") + key, text + (text.back() == '.' ? "0" : ""), what, mend);
    };
    const double wheels = rover.at("layout", "wheels");
    if (wheels != 1 && wheels != 2 && wheels != 4 && wheels != 6)
        fail("wheels", "no such rover", "give 1 (a bench carriage), 2 (and a caster), 4, or 6");
    if (const double rigid = rover.at("layout", "rigid"); rigid != 0 && rigid != 1) fail("rigid", "neither 0 nor 1", "give one of them");
    struct Owned {
        const char *key;
        double wheels;
    };
    for (const Owned &owned :
         {Owned{"middle_m", 6}, {"axle_m", 2}, {"caster_m", 2}, {"caster_radius_m", 2}, {"caster_rolling", 2}, {"drawbar_N", 1}})
        if (rover.value("layout", owned.key).given && wheels != owned.wheels)
            fail(owned.key, "means nothing for a rover of " + std::to_string(static_cast<int>(wheels)) + " wheels",
                 "leave it out, or write wheels = " + std::to_string(static_cast<int>(owned.wheels)));
    const LayoutParameters l = rover.layout();
    if (l.drives[0] >= 0 && wheels < 4)
        throw ScenarioError(rover.file, rover.drives_line, "layout.drives", "",
                            "means nothing for a rover of " + std::to_string(static_cast<int>(wheels)) +
                                (wheels == 1 ? " wheel" : " wheels"),
                            "leave it out, or write wheels = 4 or 6");
    check_steering(rover, l);
    const double half = rover.at("body", "half_wheelbase_m");
    if (const double rocker = rover.at("layout", "rocker"); rocker != 0 && rocker != 1)
        fail("rocker", "neither 0 nor 1", "give one of them");
    check_rocker(rover, l, fail);
    if (l.kind == Layout::six && std::fabs(l.middle_m) >= half)
        fail("middle_m", "not between the outer axles", "give less than body.half_wheelbase_m, ahead or (negative) behind");
    if (l.kind != Layout::caster) return;
    for (const char *key : {"axle_m", "caster_m"})
        if (!rover.value("layout", key).given)
            fail(key, "missing", "a rover of two wheels states axle_m and caster_m, ahead of its centre of mass");
    if (l.axle_m * l.caster_m >= 0)
        fail("caster_m", "the centre of mass does not lie between driven axle and caster: the rover tips over",
             "give axle_m and caster_m different signs");
}

void put_in_plant(const RoverDescription &rover, RoverParameters &plant) {
    plant.mass_kg = rover.at("body", "mass_kg");
    plant.length_m = rover.at("body", "length_m");
    plant.width_m = rover.at("body", "width_m");
    plant.height_m = rover.at("body", "height_m");
    plant.half_wheelbase_m = rover.at("body", "half_wheelbase_m");
    plant.half_track_m = rover.at("body", "half_track_m");
    plant.centre_height_m = rover.at("body", "centre_height_m");
    plant.wheel_radius_m = rover.at("wheels", "radius_m");
    plant.wheel_width_m = rover.at("wheels", "width_m");
    plant.wheel_mass_kg = rover.at("wheels", "mass_kg");
    plant.contact_stiffness_N_m = rover.at("wheels", "contact_stiffness_N_m");
    plant.contact_damping_Ns_m = rover.at("wheels", "contact_damping_Ns_m");
    plant.relaxation_length_m = rover.at("wheels", "relaxation_length_m");
    plant.tyre_hysteresis = rover.at("wheels", "tyre_hysteresis");
    plant.drive.torque_constant_Nm_A = rover.at("motor", "torque_constant_Nm_A");
    plant.drive.resistance_ohm = rover.at("motor", "resistance_ohm");
    plant.drive.inertia_kg_m2 = rover.at("motor", "inertia_kg_m2");
    plant.drive.viscous_Nms = rover.at("motor", "viscous_Nms");
    plant.drive.coulomb_Nm = rover.at("motor", "coulomb_Nm");
    plant.drive.wheel_inertia_kg_m2 = rover.at("gear", "wheel_inertia_kg_m2");
    plant.drive.gear_stiffness_Nm_rad = rover.at("gear", "stiffness_Nm_rad");
    plant.drive.gear_damping_Nms_rad = rover.at("gear", "damping_Nms_rad");
    plant.layout = rover.layout();
    plant.battery_voltage_V = rover.at("battery", "voltage_V");
    plant.battery_resistance_ohm = rover.at("battery", "resistance_ohm");
}

SensorConfig sensors_of(const RoverDescription &rover) {
    SensorConfig sensors = default_sensors();
    for (AnalogConfig &current : sensors.current) current.noise = rover.at("current", "noise_A");
    sensors.battery.noise = rover.at("battery", "noise_V");
    sensors.accel.noise = rover.at("accel", "noise_m_s2");
    sensors.accel_vibration_1_s = rover.at("accel", "vibration_1_s");
    sensors.gyro.noise = rover.at("gyro", "noise_rad_s");
    sensors.encoder_counts_per_turn = rover.encoder_counts_per_turn();
    for (const RadarModel &model : radar_models())
        if (model.name == rover.radar) sensors.radar.model = model.name;
    sensors.radar.rate_Hz = rover.at("radar", "rate_Hz");
    if (rover.radar == "own") {
        sensors.radar.model = "own";
        sensors.radar.frequency_Hz = rover.at("radar", "carrier_Hz");
        sensors.radar.vertical_deg = rover.at("radar", "vertical_deg");
        sensors.radar.horizontal_deg = rover.at("radar", "horizontal_deg");
    }
    if (rover.value("radar", "band_low_Hz").given) sensors.radar.band_low_Hz = rover.at("radar", "band_low_Hz");
    if (rover.value("radar", "band_high_Hz").given) sensors.radar.band_high_Hz = rover.at("radar", "band_high_Hz");
    sensors.radar.depression_deg = rover.at("radar", "depression_deg");
    sensors.radar.height_m = rover.at("radar", "height_m");
    sensors.radar.offset_count = rover.at("radar", "offset_count");
    sensors.radar.max_count = static_cast<int>(rover.at("radar", "max_count"));
    sensors.radar.echo_count = rover.at("radar", "echo_count");
    sensors.radar.noise_count = rover.at("radar", "noise_count");
    sensors.radar.flicker_count = rover.at("radar", "flicker_count");
    return sensors;
}

std::vector<ActiveEffect> wheel_differences(const RoverDescription &rover) {
    std::vector<ActiveEffect> out;
    const Effect *effect = find_effect("wheel_radius");
    for (int i = 0; i < wheel_count; i++) {
        const double change = rover.radius_m(static_cast<std::size_t>(i)) / rover.at("wheels", "radius_m") - 1;
        if (change == 0 || !has_wheel(rover.layout().kind, i)) continue;
        ActiveEffect active{.effect = effect, .wheel = i, .values = {}};
        for (const EffectParameter &parameter : effect->parameters)
            active.values.push_back(parameter.name == "change" ? change : parameter.typical);
        out.push_back(active);
    }
    return out;
}

} // namespace traction::sim
