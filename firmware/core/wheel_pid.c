#include "wheel_pid.h"

#include "fixed.h"

#include <math.h>

float wheel_pid_slew(const wheel_pid_config_t *config, wheel_pid_state_t *state, float reference_rad_s)
{
    const float now = fixed_finite(state->reference_rad_s);
    const float step = fixed_finite(fixed_finite(reference_rad_s) - now);
    state->reference_rad_s = now + fixed_clamp(step, -config->slew_T_rad_s, config->slew_T_rad_s); // (1)
    return state->reference_rad_s;
}

wheel_pid_output_t wheel_pid_step(const wheel_pid_config_t *config, wheel_pid_state_t *state, const wheel_pid_input_t *input)
{
    wheel_pid_output_t out = {0.0f, false};
    const float error = state->reference_rad_s - input->speed_rad_s;
    if (!fixed_is_finite(error)) {
        return out;
    }
    float direct = config->kp_s * error + fixed_finite(input->feed_forward);
    if (fixed_bits(config->kd_s2) != 0u) {
        direct -= config->kd_s2 * fixed_finite(input->accel_rad_s2);
    }
    direct = fixed_finite(direct); // (2)
    const float before = fixed_finite(state->integral);
    const float wanted = direct + before;
    const float change = config->ki_T_s * error;
    const bool winds_up = (fixed_greater(wanted, config->duty_max) && fixed_greater(change, 0.0f)) ||
                          (fixed_greater(-config->duty_max, wanted) && fixed_greater(0.0f, change));
    state->integral = winds_up ? before : fixed_clamp(before + change, -config->integral_max, config->integral_max); // (3)
    const float total = direct + state->integral;
    out.duty = fixed_clamp(total, -config->duty_max, config->duty_max); // (4)
    out.saturated = fixed_greater(fabsf(total), config->duty_max);
    return out;
}

void wheel_pid_preset(const wheel_pid_config_t *config, wheel_pid_state_t *state, float duty, float speed_rad_s, float feed_forward)
{
    state->reference_rad_s = fixed_finite(speed_rad_s);
    const float rest = fixed_finite(fixed_finite(duty) - fixed_finite(feed_forward)); // error is 0 at the start
    state->integral = fixed_clamp(rest, -config->integral_max, config->integral_max);
}
