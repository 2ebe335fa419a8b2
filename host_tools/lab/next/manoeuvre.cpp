#include "manoeuvre.h"

#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace traction::lab {

namespace {

constexpr double rest_s = 2; // before and after: a noise sample, and the wheels at rest

double number_of(const Parameters &table, const std::string &key) {
    const auto found = table.find(key);
    return found == table.end() ? 0.0 : found->second.value;
}

std::string text_of(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.9g", value);
    return text.data();
}

// Builds a manoeuvre segment by segment.
class Drive {
  public:
    Drive(std::string title, std::vector<std::string> good_for) { made_.title = std::move(title), made_.good_for = std::move(good_for); }
    Drive &stop(double for_s) { return add(for_s, "stop", ""); }
    Drive &speed(double for_s, const std::string &speed_m_s, const std::string &yaw_rate_rad_s = "") {
        return add(for_s, "platform_speed",
                   "speed_m_s = " + speed_m_s + (yaw_rate_rad_s.empty() ? "" : "\nyaw_rate_rad_s = " + yaw_rate_rad_s));
    }
    Drive &wheels(double for_s, const std::string &wheel_speed_rad_s) {
        made_.each_wheel = made_.each_wheel || wheel_speed_rad_s.front() == '[';
        return add(for_s, "wheel_speed", "wheel_speed_rad_s = " + wheel_speed_rad_s);
    }
    Drive &sweep(double for_s, const std::string &speed_m_s) {
        made_.each_wheel = true;
        return add(for_s, "soil_sweep", "speed_m_s = " + speed_m_s);
    }
    Drive &duty(double for_s, const std::string &duty) { return add(for_s, "open_loop", "duty = " + duty); }
    Manoeuvre made() { return made_; }

  private:
    Drive &add(double for_s, const char *mode, const std::string &keys) {
        made_.segments += "[[drive]]\nfor_s = " + text_of(for_s) + "\nmode = \"" + mode + "\"\n" + keys + (keys.empty() ? "\n" : "\n\n");
        made_.duration_s += for_s;
        return *this;
    }
    Manoeuvre made_;
};

// Sizes are those of a rover of a few kilograms; docs/evidence.md section 5 says what separates the closest pairs.
std::vector<Manoeuvre> make_manoeuvres() {
    return {
        Drive("there and back over the same ground", {"grade", "multi_pass", "mass_offset_x", "soil_patch", "soil_gradient", "tether_drag",
                                                      "accel_bias", "rolling_resistance", "body_drag"})
            .speed(12, "0.3")
            .speed(2, "0.0")
            .speed(12, "-0.3")
            .speed(2, "0.0")
            .made(),
        Drive("cruise straight, slow and fast", {"wheel_radius", "encoder_missed", "radar_scale", "camera_scale", "speed_resistance"})
            .speed(10, "0.15")
            .speed(10, "0.6")
            .speed(2, "0.0")
            .made(),
        Drive("three wheels push, one drags", {"mesh_loss", "slip_sinkage", "torque_constant", "current_gain", "wheel_radius",
                                               "encoder_missed", "sliding_speed_loss", "shear_stiffness", "mass_offset_y"})
            .wheels(6, "[6.0, 6.0, 6.0, 1.0]")
            .wheels(6, "[1.0, 6.0, 6.0, 6.0]")
            .wheels(6, "[6.0, 1.0, 6.0, 6.0]")
            .wheels(6, "[6.0, 6.0, 1.0, 6.0]")
            .made(),
        Drive("slip sweep of the front wheels",
              {"slip_sinkage", "shear_stiffness", "sliding_speed_loss", "relaxation_length", "mesh_loss", "speed_resistance"})
            .sweep(20, "0.3")
            .sweep(20, "0.15")
            .made(),
        Drive("front against rear, forwards and in reverse",
              {"multi_pass", "mass_offset_x", "slip_sinkage", "mesh_loss", "bridge_dead_time", "wiring_resistance"})
            .wheels(6, "[2.0, 2.0, [2.0, 9.0], [2.0, 9.0]]")
            .wheels(6, "[[2.0, 9.0], [2.0, 9.0], 2.0, 2.0]")
            .wheels(6, "[-2.0, -2.0, [-2.0, -9.0], [-2.0, -9.0]]")
            .wheels(6, "[[-2.0, -9.0], [-2.0, -9.0], -2.0, -2.0]")
            .made(),
        Drive("hard starts and stops", {"load_transfer", "accel_scale", "accel_tilt", "radar_pitch", "camera_delay", "actuation_delay",
                                        "relaxation_length", "backlash", "radar_scale", "camera_scale"})
            .speed(4, "0.8")
            .speed(3, "-0.8")
            .speed(3, "0.8")
            .speed(3, "0.0")
            .duty(8, "{ amplitude = 0.9, period_s = 1.5 }")
            .made(),
        Drive("stairs of speed, both ways", {"viscous_friction", "coulomb_friction", "stribeck_friction", "torque_ripple",
                                             "speed_resistance", "bridge_dead_time", "voltage_gain", "wiring_resistance", "current_offset"})
            .speed(6, "0.05")
            .speed(6, "0.2")
            .speed(6, "0.6")
            .speed(6, "-0.1")
            .speed(6, "-0.5")
            .made(),
        Drive("creep back and forth",
              {"stribeck_friction", "coulomb_friction", "backlash", "current_offset", "torque_ripple", "bridge_dead_time"})
            .wheels(24, "{ amplitude = 1.5, period_s = 6.0 }")
            .made(),
        Drive("push and brake by duty", {"backlash", "bridge_dead_time", "actuation_delay", "accel_scale"})
            .duty(12, "{ amplitude = 0.6, period_s = 2.0 }")
            .made(),
        Drive("turns on the spot and on the move",
              {"lateral_scrub", "wheel_radius", "mass_offset_y", "gyro_scale", "gyro_delay", "accel_place"})
            .speed(6, "0.2", "0.8")
            .speed(6, "0.2", "-0.8")
            .speed(6, "0.0", "0.9")
            .made(),
        Drive("a square: along, across, back", {"grade", "soil_gradient", "accel_bias"})
            .speed(6, "0.3")
            .speed(2, "0.0", "0.8")
            .speed(6, "0.3")
            .speed(2, "0.0", "0.8")
            .speed(6, "0.3")
            .speed(2, "0.0", "0.8")
            .speed(6, "0.3")
            .made(),
        Drive("front against rear for a minute and a half, rest, the start again", {"winding_heating", "wiring_resistance", "accel_drift"})
            .speed(6, "0.3")
            .wheels(45, "[1.0, 1.0, 10.0, 10.0]")
            .wheels(45, "[10.0, 10.0, 1.0, 1.0]")
            .stop(20)
            .speed(6, "0.3")
            .made(),
    };
}

std::string effect_table(const EffectUse &use, std::vector<std::string> &notes) {
    const sim::Effect *known = sim::find_effect(use.name);
    if (known == nullptr) {
        notes.push_back(use.name + " is an effect of your own: the plant drives without it");
        return "";
    }
    std::string text = "[[effect]]\nname = \"" + use.name + "\"\n" + (use.wheel >= 0 ? "wheel = " + std::to_string(use.wheel) + "\n" : "");
    for (const sim::EffectParameter &p : known->parameters) {
        const auto found = use.parameters.find(std::string(p.name));
        if (found == use.parameters.end()) continue;
        const double given = found->second.value, size = p.both_signs ? std::fabs(given) : given;
        const double value =
            p.both_signs ? std::copysign(std::clamp(size, p.minimum, p.maximum), given) : std::clamp(size, p.minimum, p.maximum);
        if (value != found->second.value)
            notes.push_back(use.name + "." + std::string(p.name) + " is beyond what the plant takes: driven with " + text_of(value));
        text += std::string(p.name) + " = " + text_of(value) + "\n";
    }
    return text + "\n";
}

double mean_of(const Model &model, const Parameters WheelSpec::*table, const char *key, std::vector<std::string> &notes) {
    double sum = 0, low = 1e300, high = -1e300;
    for (const WheelSpec &w : model.wheel) {
        const double value = number_of(w.*table, key);
        sum += value, low = std::min(low, value), high = std::max(high, value);
    }
    if (high - low > 1e-9 * std::fabs(high))
        notes.push_back(std::string(key) + " differs between the wheels: the plant drives with the mean");
    return sum / static_cast<double>(model.wheel.size());
}

} // namespace

const std::vector<Manoeuvre> &manoeuvres() {
    static const std::vector<Manoeuvre> list = make_manoeuvres();
    return list;
}

const std::vector<Manoeuvre> &manoeuvres_of(const Model &model) {
    static const std::vector<Manoeuvre> of_sides = [] {
        std::vector<Manoeuvre> list = manoeuvres();
        std::erase_if(list, [](const Manoeuvre &m) { return m.each_wheel; });
        return list;
    }();
    const bool four =
        model.wheel.size() == 4 && std::all_of(model.wheel.begin(), model.wheel.end(), [](const WheelSpec &w) { return w.driven; });
    return model.couples() || !four ? of_sides : manoeuvres();
}

namespace {

// One motor a side: the wheels that have them. Nothing where the motors turn other wheels than that.
std::vector<std::size_t> motors_of_sides(const Model &model) {
    std::vector<std::size_t> motors;
    for (std::size_t i = 0; i < 2; ++i)
        if (model.motor_of(i) % 2 == i && model.motor_of(i + 2) == model.motor_of(i)) motors.push_back(model.motor_of(i));
    return motors.size() == 2 ? motors : std::vector<std::size_t>();
}

} // namespace

std::string cannot_drive(const Model &model) {
    if (model.motion == BodyMotion::imposed) return "a carriage imposes its motion";
    if (model.motion == BodyMotion::none) return "its wheels turn in the air";
    if (model.wheel.size() != 4)
        return "it has " + std::to_string(model.wheel.size()) + (model.wheel.size() == 1 ? " wheel" : " wheels") +
               ", the simulated rover has 4";
    for (std::size_t i = 0; i < 4; ++i) {
        const WheelSpec &w = model.wheel[i];
        const double x = number_of(w.geometry, "x_m"), y = number_of(w.geometry, "y_m");
        const bool place = (i < 2 ? x < 0 : x > 0) && (i % 2 == 0 ? y > 0 : y < 0);
        if (!place || !w.driven || !w.grips_sideways || number_of(w.geometry, "heading_rad") != 0)
            return "its wheel " + std::to_string(i) +
                   " is not a driven wheel where the simulated rover has its own (0 rear left, 1 rear right, 2 front left, 3 front right)";
    }
    if (model.couples() && motors_of_sides(model).empty())
        return "its motors turn other wheels than those of one side each, which is all that the simulated rover's do";
    if (!(number_of(model.rover, "mass_kg") > 0) || !(number_of(model.wheel[0].motor, "resistance_ohm") > 0) ||
        !(number_of(model.wheel[0].motor, "torque_constant_Nm_A") > 0))
        return "its mass, motor constant or winding resistance is not given";
    return "";
}

std::string scenario_of(const Model &model, const std::string &title, const std::string &segments, double duration_s,
                        std::vector<std::string> &notes) {
    std::string quoted;
    for (const char c : title)
        if (c != '"' && c != '\\' && c >= ' ') quoted += c;
    std::string text = "title = \"" + quoted + "\"\nduration_s = " + text_of(duration_s) + "\nseed = 1\n\n[ground]\nsoil = \"" +
                       (model.soil_law == SoilLaw::burckhardt ? "concrete" : "sand") + "\"\n";
    const auto mean = [&](const Parameters WheelSpec::*table, const char *key) { return mean_of(model, table, key, notes); };
    const auto put = [&](const char *key, double value, bool when) {
        if (when) text += std::string(key) + " = " + text_of(value) + "\n";
    };
    put("adhesion_N", mean(&WheelSpec::soil, "adhesion_N"), true);
    put("fm_per_fn", std::max(0.01, mean(&WheelSpec::soil, "mu")), true);
    put("shear_slip", mean(&WheelSpec::soil, "shear_slip"), true);
    put("rolling_coefficient", std::max(0.0, mean(&WheelSpec::soil, "rolling_coefficient")), true);
    text += "\n[rover]\n";
    put("mass_kg", number_of(model.rover, "mass_kg"), true);
    double x = 0, y = 0;
    for (const WheelSpec &w : model.wheel)
        x += std::fabs(number_of(w.geometry, "x_m")) / 4, y += std::fabs(number_of(w.geometry, "y_m")) / 4;
    put("half_wheelbase_m", x, true), put("half_track_m", y, true);
    put("wheel_radius_m", mean(&WheelSpec::geometry, "radius_m"), true);
    put("centre_height_m", number_of(model.rover, "centre_height_m"), true);
    const double relaxation = mean(&WheelSpec::soil, "relaxation_length_m");
    put("relaxation_length_m", relaxation, relaxation >= 0.0005);
    for (const char *key : {"torque_constant_Nm_A", "resistance_ohm", "inertia_kg_m2", "viscous_Nms", "coulomb_Nm"})
        put(key, std::max(0.0, mean(&WheelSpec::motor, key)), true); // a fit may leave a wheel's friction a little below nothing
    if (model.couples()) {
        const std::vector<std::size_t> motors = motors_of_sides(model);
        text += "layout = { drives = [" + std::to_string(motors[0]) + ", " + std::to_string(motors[1]) + "] }\n";
    }
    const double battery_V = number_of(model.rover, "battery_voltage_V");
    put("battery_voltage_V", battery_V, battery_V > 0);
    text += "\n";
    for (const EffectUse &use : model.effects) text += effect_table(use, notes);
    return text + segments;
}

std::string scenario_of(const Model &model, const std::vector<const Manoeuvre *> &list, std::vector<std::string> &notes) {
    std::string title, segments = "[[drive]]\nfor_s = " + text_of(rest_s) + "\nmode = \"stop\"\n\n";
    double duration_s = 2 * rest_s;
    for (const Manoeuvre *m : list) {
        title += (title.empty() ? "Next: " : ", then ") + m->title;
        segments += m->segments;
        duration_s += m->duration_s;
    }
    return scenario_of(model, title, segments + "[[drive]]\nfor_s = " + text_of(rest_s) + "\nmode = \"stop\"\n", duration_s, notes);
}

std::string measure_instead(const std::string &effect) {
    const sim::Effect *known = sim::find_effect(effect);
    return known != nullptr ? std::string(known->measure)
                            : "measure the ground itself: pull one wheel, held fast, with a spring balance in and beside the track";
}

} // namespace traction::lab
