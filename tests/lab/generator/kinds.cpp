#include "kinds.h"

#include <charconv>
#include <stdexcept>

namespace traction::generator {

namespace {

using H = Hidden;

KindParameter on_wheels(std::string_view name, PerWheel H::*place, double low, double high, bool either_sign = false) {
    return {.name = name, .low = low, .high = high, .either_sign = either_sign, .per_wheel = place};
}
KindParameter whole(std::string_view name, double H::*place, double low, double high, bool either_sign = false) {
    return {.name = name, .low = low, .high = high, .either_sign = either_sign, .whole = place};
}
KindParameter shape(std::string_view name, double H::*place, std::vector<double> choices) {
    return {.name = name, .strength = false, .whole = place, .choices = std::move(choices)};
}
KindParameter wheel_shape(std::string_view name, PerWheel H::*place, std::vector<double> choices) {
    return {.name = name, .strength = false, .per_wheel = place, .choices = std::move(choices)};
}

// Sizes: from about three times the smallest size of interest to well inside the plausible range (assumed).
std::vector<Kind> inside() {
    return {
        {"coulomb_friction", false, "", {on_wheels("torque_Nm", &H::coulomb, 0.012, 0.06)}},
        {"viscous_friction", false, "", {on_wheels("coefficient_Nms", &H::viscous, 1.2e-3, 8e-3)}},
        {"stribeck_friction",
         false,
         "",
         {on_wheels("torque_Nm", &H::stribeck, 0.015, 0.06), wheel_shape("speed_rad_s", &H::stribeck_speed, {0.5, 1, 2, 4})}},
        {"mesh_loss", false, "", {whole("fraction", &H::mesh, 0.06, 0.35)}},
        {"backlash", false, "", {on_wheels("play_rad", &H::play, 0.03, 0.15)}},
        {"torque_ripple",
         false,
         "",
         {on_wheels("cos_Nm", &H::ripple_cos, 0.008, 0.03, true), on_wheels("sin_Nm", &H::ripple_sin, 0.004, 0.03, true),
          wheel_shape("order", &H::ripple_order, {1, 2, 3, 4, 6, 8})}},
        {"winding_heating",
         false,
         "",
         {whole("resistance_K_W", &H::heating, 10, 55), shape("time_constant_s", &H::heating_time, {20, 60, 180})}},
        {"wiring_resistance", false, "", {on_wheels("resistance_ohm", &H::wiring, 0.2, 1.2)}},
        {"bridge_dead_time", false, "", {on_wheels("voltage_V", &H::dead_voltage, 0.15, 0.9)}},
        {"torque_constant", false, "", {on_wheels("change", &H::constant_change, 0.08, 0.25, true)}},
        {"rolling_resistance", false, "", {on_wheels("coefficient", &H::rolling, 0.03, 0.15)}},
        {"slip_sinkage", false, "", {whole("coefficient", &H::sinkage, 0.08, 0.4)}},
        {"speed_resistance", false, "", {whole("coefficient_s_m", &H::speed_resistance, 0.06, 0.25)}},
        {"multi_pass", false, "", {whole("gain", &H::multi_pass, 0.12, 0.4, true)}},
        {"load_transfer", false, "", {whole("height_m", &H::height, 0.05, 0.19)}},
        {"mass_offset_x", false, "", {whole("offset_m", &H::offset_x, 0.012, 0.04, true)}},
        {"mass_offset_y", false, "", {whole("offset_m", &H::offset_y, 0.012, 0.05, true)}},
        {"soil_patch",
         false,
         "",
         {whole("change", &H::patch, 0.2, 0.6, true), shape("start_m", &H::patch_start, {0.5, 1, 1.5, 2, 3}),
          shape("length_m", &H::patch_length, {0.5, 1, 1.5})}},
        {"soil_gradient", false, "", {whole("change_per_m", &H::gradient, 0.04, 0.12, true)}},
        {"relaxation_length", false, "", {whole("length_m", &H::relaxation, 0.05, 0.25)}},
        {"sliding_speed_loss", false, "", {whole("coefficient_s_m", &H::sliding_loss, 0.3, 1.8)}},
        {"shear_stiffness", false, "", {whole("change", &H::shear, 0.4, 1.5)}},
        {"wheel_radius", false, "", {on_wheels("change", &H::radius_change, 0.02, 0.1, true)}},
        {"lateral_scrub", false, "", {whole("coefficient", &H::scrub, 0.2, 0.9)}},
        {"grade",
         false,
         "",
         {whole("slope_rad", &H::slope, 0.02, 0.12, true), shape("direction_rad", &H::slope_direction, {0, 1.5707963267948966})}},
        {"tether_drag", false, "", {whole("stiffness_N_m", &H::tether, 0.15, 1.2)}},
        {"body_drag", false, "", {whole("force_N", &H::drag, 0.5, 3)}},
        {"accel_bias", false, "", {whole("bias_m_s2", &H::accel_bias, 0.2, 0.45, true)}},
        {"accel_drift", false, "", {whole("rate_m_s3", &H::accel_drift, 1.2e-3, 8e-3, true)}},
        {"accel_scale", false, "", {whole("change", &H::accel_scale, 0.08, 0.28, true)}},
        {"accel_tilt", false, "", {whole("compliance_rad_s2_m", &H::accel_tilt, 0.01, 0.045)}},
        {"radar_scale", false, "", {whole("change", &H::radar_scale, 0.04, 0.2, true)}},
        {"radar_pitch", false, "", {whole("coefficient_s2_m", &H::radar_pitch, 0.1, 0.28, true)}},
        {"current_gain", false, "", {on_wheels("change", &H::current_gain, 0.08, 0.3, true)}},
        {"current_offset", false, "", {on_wheels("offset_A", &H::current_offset, 0.04, 0.2, true)}},
        {"voltage_gain", false, "", {whole("change", &H::voltage_gain, 0.05, 0.25, true)}},
        {"encoder_missed", false, "", {on_wheels("fraction", &H::missed, 0.02, 0.15)}},
        {"camera_delay", false, "", {whole("delay_s", &H::camera_delay, 0.04, 0.3)}},
        {"camera_scale", false, "", {whole("change", &H::camera_scale, 0.02, 0.12, true)}},
        {"actuation_delay", false, "", {whole("delay_s", &H::actuation_delay, 0.02, 0.1)}},
        // of the fleet alone, from here on; the sensors' own delays are within 30 ms (accelerometer), none (the others)
        {"accel_delay", false, "", {whole("delay_s", &H::accel_delay, 0.08, 0.25)}, Sets::fleet},
        {"accel_lag", false, "", {whole("lag_s", &H::accel_lag, 0.08, 0.25)}, Sets::fleet},
        {"gyro_delay", false, "", {whole("delay_s", &H::gyro_delay, 0.06, 0.25)}, Sets::fleet},
        {"radar_delay", false, "", {whole("delay_s", &H::radar_delay, 0.15, 0.7)}, Sets::fleet},
        {"current_delay", false, "", {whole("delay_s", &H::current_delay, 0.03, 0.12)}, Sets::fleet},
        // of the bent sets alone, from here on
        {"accel_place",
         false,
         "",
         {whole("ahead_m", &H::accel_ahead, 0.06, 0.2, true), whole("left_m", &H::accel_left, 0.02, 0.1, true)},
         Sets::bent},
        {"gyro_scale", false, "", {whole("change", &H::gyro_scale, 0.03, 0.12, true)}, Sets::bent},
    };
}

std::vector<Kind> outside() {
    return {
        {"friction_squared",
         true,
         "speed",
         {on_wheels("coefficient_Nms2", &H::friction_squared, 3e-4, 1.2e-3)},
         Sets::all,
         "churning_friction"},
        {"duty_dead_band", true, "duty|speed", {on_wheels("duty", &H::dead_band, 0.04, 0.1)}},
        {"friction_hysteresis", true, "angle|direction|speed|acceleration", {on_wheels("torque_Nm", &H::hysteresis, 0.02, 0.06)}},
        {"grip_wave_in_place",
         true,
         "path|place",
         {whole("change", &H::place_wave, 0.2, 0.5), shape("length_m", &H::place_length, {0.4, 0.6, 1.0})}},
        {"turn_resistance", true, "yaw|turn|direction", {whole("coefficient_s", &H::turn_resistance, 0.1, 0.4)}},
        {"wheel_coupling",
         true,
         "other wheel|time|speed|load|slip|current",
         {whole("ohm", &H::coupling, 0.4, 1.5)},
         Sets::all,
         "shared_lead"},
        {"torque_limit", true, "torque|current|slip|acceleration|load", {on_wheels("torque_Nm", &H::torque_limit, 0.2, 0.4)}},
        {"friction_drift", true, "time", {on_wheels("torque_Nm", &H::friction_drift, 0.015, 0.06)}},
        {"reverse_friction",
         true,
         "direction|speed",
         {on_wheels("torque_Nm", &H::reverse_friction, 0.015, 0.05)},
         Sets::all,
         "reverse_friction"},
        {"friction_resonance",
         true,
         "speed",
         {on_wheels("torque_Nm", &H::resonance, 0.02, 0.06), wheel_shape("speed_rad_s", &H::resonance_speed, {4, 6})}},
        {"grip_falls_with_speed", true, "speed", {whole("coefficient_s_m", &H::grip_speed, 0.4, 1.2)}},
        {"grip_drift", true, "time", {whole("change", &H::grip_drift, 0.2, 0.45, true)}},
        {"friction_step",
         true,
         "time",
         {on_wheels("torque_Nm", &H::friction_step, 0.015, 0.05), wheel_shape("time_s", &H::friction_step_time, {40, 60, 80})}},
        {"water_drag", true, "speed", {whole("coefficient_Ns2_m2", &H::water, 4, 16)}, Sets::all, "fluid_drag"},
        // of the fleet alone, from here on
        {"wear_in",
         true,
         "time",
         {on_wheels("torque_Nm", &H::wear_in, 0.025, 0.08), wheel_shape("time_s", &H::wear_in_time, {15, 30})},
         Sets::fleet,
         "wear_in"},
        {"bad_tooth", true, "angle", {on_wheels("torque_Nm", &H::tooth, 0.03, 0.1)}, Sets::fleet},
        {"gear_loss_with_speed",
         true,
         "speed|load|torque|slip",
         {on_wheels("loss_per_rad_s", &H::speed_loss, 0.02, 0.05)},
         Sets::fleet,
         "gear_speed_loss"},
        {"current_gain_drift", true, "time|current|load|torque", {on_wheels("change", &H::gain_drift, 0.15, 0.4, true)}, Sets::fleet},
        {"rolling_grows_with_speed_squared",
         true,
         "speed",
         {whole("coefficient_s2_m2", &H::rolling_squared, 0.15, 0.6)},
         Sets::fleet,
         "squared_resistance"},
        {"grip_falls_beyond_peak", true, "slip", {whole("share", &H::shear_peak, 0.3, 0.7)}, Sets::fleet, "shear_peak"},
        {"soft_place",
         true,
         "path|place",
         {whole("coefficient", &H::mud, 0.06, 0.2), shape("start_m", &H::mud_start, {0.5, 1, 2}),
          shape("length_m", &H::mud_length, {0.5, 1, 1.5})},
         Sets::fleet,
         "resistance_patch"},
        // of the bent sets alone, from here on
        {"swinging_force", // something that swings on the rover: a water tank, an arm
         true,
         "force|time",
         {whole("force_N", &H::swing, 0.4, 2), shape("frequency_Hz", &H::swing_Hz, {0.2, 0.4, 0.8})},
         Sets::bent},
        {"gusts", true, "force|time", {whole("force_N", &H::gusts, 0.4, 2)}, Sets::bent},
        {"wavy_floor",
         true,
         "force|path|place|slope",
         {whole("slope_rad", &H::waves, 0.01, 0.05), shape("wavelength_m", &H::wave_length, {1, 2, 4})},
         Sets::bent},
        {"payload_dropped",
         true,
         "time|load|mass|acceleration",
         {whole("share", &H::dropped, 0.1, 0.3), shape("time_s", &H::dropped_time, {30, 60})},
         Sets::bent},
        {"tyre_loss", true, "time|radius|yaw|moment", {on_wheels("change", &H::tyre_loss, 0.02, 0.06)}, Sets::bent},
    };
}

} // namespace

const std::vector<Kind> &kinds() {
    static const std::vector<Kind> all = [] {
        std::vector<Kind> list = inside();
        for (Kind &kind : outside()) list.push_back(std::move(kind));
        return list;
    }();
    return all;
}

const Kind *find_kind(std::string_view name) {
    for (const Kind &kind : kinds())
        if (kind.name == name) return &kind;
    return nullptr;
}

Setting parse_setting(std::string_view text) {
    Setting setting;
    const std::size_t colon = text.find(':');
    setting.name = text.substr(0, colon);
    std::string_view rest = colon == std::string_view::npos ? std::string_view{} : text.substr(colon + 1);
    while (!rest.empty()) {
        const std::size_t comma = rest.find(',');
        const std::string_view item = rest.substr(0, comma);
        rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
        const std::size_t equal = item.find('=');
        double value = 0;
        if (equal == std::string_view::npos ||
            std::from_chars(item.data() + equal + 1, item.data() + item.size(), value).ptr != item.data() + item.size())
            throw std::invalid_argument("effect \"" + std::string(text) + "\": write NAME:param=value,param=value");
        if (item.substr(0, equal) == "wheel")
            setting.wheel = static_cast<int>(value);
        else
            setting.values.emplace_back(item.substr(0, equal), value);
    }
    return setting;
}

void apply(const Setting &setting, Hidden &hidden) {
    const Kind *kind = find_kind(setting.name);
    if (kind == nullptr) throw std::invalid_argument("unknown effect \"" + setting.name + "\"; lab_generate --list names them");
    if (setting.wheel >= wheels) throw std::invalid_argument("wheel is 0 to 3");
    for (const auto &[name, value] : setting.values) {
        const KindParameter *found = nullptr;
        for (const KindParameter &parameter : kind->parameters)
            if (parameter.name == name) found = &parameter;
        if (found == nullptr) throw std::invalid_argument(setting.name + " has no parameter \"" + name + "\"");
        if (found->whole != nullptr) {
            hidden.*found->whole = value;
            continue;
        }
        for (int i = 0; i < wheels; ++i)
            if (setting.wheel < 0 || setting.wheel == i) (hidden.*found->per_wheel)[static_cast<std::size_t>(i)] = value;
    }
}

} // namespace traction::generator
