#include "motor.h"

#include "fixed.h"

// Below this a supply is not a supply but a broken wire. [V], assumed
static const float supply_min_V = 1.0f;

float motor_loss_Nm(const motor_config_t *config, float speed_rad_s)
{
    const float w = fixed_finite(speed_rad_s);
    return config->viscous_Nms * w + config->dry_Nm * fixed_clamp(w / config->dry_speed_rad_s, -1.0f, 1.0f); // (18)
}

motor_output_t motor_measure(const motor_config_t *config, float current_A, float speed_rad_s, float accel_rad_s2)
{
    motor_output_t out;
    out.torque_Nm = config->torque_constant_Nm_A * fixed_finite(current_A); // (17)
    out.traction_N = (out.torque_Nm - motor_loss_Nm(config, speed_rad_s) - config->inertia_kg_m2 * fixed_finite(accel_rad_s2)) /
                     config->wheel_radius_m; // (19)
    return out;
}

float motor_duty_for_speed(const motor_config_t *config, float speed_rad_s, float supply_V)
{
    const float w = fixed_finite(speed_rad_s);
    if (!(supply_V > supply_min_V)) {
        return 0.0f;
    }
    const float current_A = motor_loss_Nm(config, w) / config->torque_constant_Nm_A;
    return fixed_clamp((config->resistance_ohm * current_A + config->back_emf_Vs * w) / supply_V, -1.0f, 1.0f); // (a)
}

float motor_duty_limited(const motor_config_t *config, float duty, float speed_rad_s, float supply_V, float limit_A)
{
    if (!(supply_V > supply_min_V)) {
        return 0.0f;
    }
    const float emf_V = config->back_emf_Vs * fixed_finite(speed_rad_s);
    const float swing_V = config->resistance_ohm * limit_A;
    const float low = fixed_clamp((emf_V - swing_V) / supply_V, -1.0f, 1.0f);
    const float high = fixed_clamp((emf_V + swing_V) / supply_V, -1.0f, 1.0f);
    return fixed_clamp(fixed_finite(duty), low, high);
}
