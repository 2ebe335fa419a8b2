#include "motor.h"

#include "fixed.h"

// Below this a supply is not a supply but a broken wire. [V], assumed
static const float supply_min_V = 1.0f;

// most times w*per, within -most..most. Where a wheel drives, that is most itself: a multiplication less.
static float dry(float most, float w, float per)
{
    const float share = w * per;
    return fixed_greater(share, 1.0f) ? most : fixed_greater(-1.0f, share) ? -most : most * share;
}

float motor_loss_Nm(const motor_config_t *config, float speed_rad_s)
{
    const float w = fixed_finite(speed_rad_s);
    return config->viscous_Nms * w + dry(config->dry_Nm, w, config->per_dry_speed_s); // (18)
}

motor_output_t motor_measure(const motor_config_t *config, float current_A, float speed_rad_s, float accel_rad_s2)
{
    motor_output_t out;
    out.torque_Nm = config->torque_constant_Nm_A * fixed_finite(current_A); // (17)
    out.traction_N = (out.torque_Nm - motor_loss_Nm(config, speed_rad_s) - config->inertia_kg_m2 * fixed_finite(accel_rad_s2)) *
                     config->per_radius_1_m; // (19)
    return out;
}

float motor_per_supply(float supply_V) { return supply_V > supply_min_V && fixed_is_finite(supply_V) ? 1.0f / supply_V : 0.0f; }

float motor_duty_for_speed(const motor_config_t *config, float speed_rad_s, float per_supply_1_V)
{
    const float w = fixed_finite(speed_rad_s);
    const float voltage_V = config->volt_per_speed_Vs * w + dry(config->volt_dry_V, w, config->per_dry_speed_s); // (a), (18)
    return fixed_clamp(fixed_finite(voltage_V * fixed_finite(per_supply_1_V)), -1.0f, 1.0f);
}

float motor_duty_limited(const motor_config_t *config, float duty, float speed_rad_s, float per_supply_1_V, float limit_A)
{
    const float per_supply = fixed_finite(per_supply_1_V);
    const float emf = config->back_emf_Vs * fixed_finite(speed_rad_s) * per_supply;
    const float swing = config->resistance_ohm * limit_A * per_supply;
    const float low = fixed_clamp(emf - swing, -1.0f, 1.0f);
    const float high = fixed_clamp(emf + swing, -1.0f, 1.0f);
    return fixed_clamp(fixed_finite(duty), low, high);
}
