#include "plant_effects.h"

#include <string_view>

namespace traction::sim {

namespace {

struct WheelField {
    std::string_view effect, parameter;
    double DriveEffects::*field;
    bool replaces = false; // a shape parameter: set, not added
};

constexpr WheelField drive_fields[] = {
    {"coulomb_friction", "torque_Nm", &DriveEffects::coulomb_Nm},
    {"viscous_friction", "coefficient_Nms", &DriveEffects::viscous_Nms},
    {"stribeck_friction", "torque_Nm", &DriveEffects::stribeck_Nm},
    {"stribeck_friction", "speed_rad_s", &DriveEffects::stribeck_speed_rad_s, true},
    {"mesh_loss", "fraction", &DriveEffects::mesh_fraction},
    {"backlash", "play_rad", &DriveEffects::play_rad},
    {"torque_ripple", "cos_Nm", &DriveEffects::ripple_cos_Nm},
    {"torque_ripple", "sin_Nm", &DriveEffects::ripple_sin_Nm},
    {"torque_ripple", "order", &DriveEffects::ripple_order, true},
    {"winding_heating", "resistance_K_W", &DriveEffects::heating_K_W},
    {"winding_heating", "time_constant_s", &DriveEffects::heating_time_s, true},
    {"wiring_resistance", "resistance_ohm", &DriveEffects::wiring_ohm},
    {"bridge_dead_time", "voltage_V", &DriveEffects::dead_voltage_V},
    {"torque_constant", "change", &DriveEffects::constant_change},
};

struct BodyField {
    std::string_view effect, parameter;
    double BodyEffects::*field;
    bool replaces = false;
};

constexpr BodyField body_fields[] = {
    {"slip_sinkage", "coefficient", &BodyEffects::slip_sinkage},
    {"speed_resistance", "coefficient_s_m", &BodyEffects::speed_resistance_s_m},
    {"multi_pass", "gain", &BodyEffects::multi_pass},
    {"load_transfer", "height_m", &BodyEffects::centre_height_m},
    {"mass_offset_x", "offset_m", &BodyEffects::offset_x_m},
    {"mass_offset_y", "offset_m", &BodyEffects::offset_y_m},
    {"soil_patch", "change", &BodyEffects::patch_change},
    {"soil_patch", "start_m", &BodyEffects::patch_start_m, true},
    {"soil_patch", "length_m", &BodyEffects::patch_length_m, true},
    {"soil_gradient", "change_per_m", &BodyEffects::gradient_1_m},
    {"relaxation_length", "length_m", &BodyEffects::relaxation_m},
    {"sliding_speed_loss", "coefficient_s_m", &BodyEffects::sliding_loss_s_m},
    {"shear_stiffness", "change", &BodyEffects::shear_change},
    {"lateral_scrub", "coefficient", &BodyEffects::scrub},
    {"grade", "slope_rad", &BodyEffects::slope_rad},
    {"grade", "direction_rad", &BodyEffects::slope_direction_rad, true},
    {"tether_drag", "stiffness_N_m", &BodyEffects::tether_N_m},
    {"body_drag", "force_N", &BodyEffects::drag_N},
};

void set(double &field, double value, bool replaces) { field = replaces ? value : field + value; }

} // namespace

PlantEffects collect_effects(const std::vector<ActiveEffect> &effects) {
    PlantEffects out;
    for (const ActiveEffect &active : effects) {
        const std::string_view name = active.effect->name;
        for (int i = 0; i < 4; ++i) {
            if (active.wheel >= 0 && active.wheel != i) continue;
            WheelEffects &wheel = out.wheel[static_cast<std::size_t>(i)];
            for (const WheelField &f : drive_fields)
                if (f.effect == name) set(wheel.drive.*f.field, active.value(f.parameter), f.replaces);
            if (name == "rolling_resistance") wheel.rolling += active.value("coefficient");
            if (name == "wheel_radius") wheel.radius_change += active.value("change");
        }
        for (const BodyField &f : body_fields)
            if (f.effect == name) set(out.body.*f.field, active.value(f.parameter), f.replaces);
    }
    return out;
}

} // namespace traction::sim
