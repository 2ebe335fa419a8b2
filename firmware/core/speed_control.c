#include "speed_control.h"

#include "fixed.h"

speed_control_output_t speed_control_step(const speed_control_config_t *config, speed_control_state_t *state,
                                          const speed_control_input_t *input)
{
    const float v_ref = fixed_clamp(fixed_finite(input->speed_ref_m_s), -config->speed_max_m_s, config->speed_max_m_s);
    const float yaw = fixed_clamp(fixed_finite(input->yaw_rate_ref_rad_s), -config->yaw_rate_max_rad_s, config->yaw_rate_max_rad_s);
    const float error = fixed_finite(v_ref - input->speed_m_s);
    const float before = fixed_finite(state->integral_rad_s);
    const bool grows = (before > 0.0f && error > 0.0f) || (before < 0.0f && error < 0.0f);
    if (!(input->saturated && grows)) {
        state->integral_rad_s =
            fixed_clamp(before + config->ki_T_rad_m * error, -config->integral_max_rad_s, config->integral_max_rad_s); // (1)
    }
    const float common = v_ref * config->per_radius_1_m + config->kv_rad_m * error + state->integral_rad_s;
    const float turn = config->half_track_per_radius * yaw;
    speed_control_output_t out;
    out.left_rad_s = fixed_clamp(common - turn, -config->wheel_max_rad_s, config->wheel_max_rad_s); // (22)
    out.right_rad_s = fixed_clamp(common + turn, -config->wheel_max_rad_s, config->wheel_max_rad_s);
    return out;
}
