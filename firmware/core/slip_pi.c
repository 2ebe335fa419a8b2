#include "slip_pi.h"

#include "fixed.h"

#include <math.h>

static float scheduled_gain(const slip_pi_config_t *config, float speed_m_s)
{
    return fixed_clamp(fabsf(speed_m_s) * config->per_speed_s_m, config->gain_min, config->gain_max);
}

slip_pi_output_t slip_pi_step(const slip_pi_config_t *config, slip_pi_state_t *state, const slip_pi_input_t *input)
{
    slip_pi_output_t out = {0.0f, false};
    const float error = input->slip_ref - input->slip; // (1)
    if (!fixed_is_finite(error)) {
        return out;
    }
    const float gain = scheduled_gain(config, input->speed_m_s);
    const float direct = fixed_finite(config->kp * gain * error);
    const float before = fixed_finite(state->integral);
    const float wanted = direct + before;
    const float change = config->ki_T * gain * error;
    const bool winds_up = (fixed_greater(wanted, config->duty_max) && fixed_greater(change, 0.0f)) ||
                          (fixed_greater(-config->duty_max, wanted) && fixed_greater(0.0f, change));
    state->integral = winds_up ? before : fixed_clamp(before + change, -config->duty_max, config->duty_max); // (2)
    const float total = direct + state->integral;
    out.duty = fixed_clamp(total, -config->duty_max, config->duty_max); // (3)
    out.saturated = fixed_greater(fabsf(total), config->duty_max);
    return out;
}

void slip_pi_preset(const slip_pi_config_t *config, slip_pi_state_t *state, float duty, const slip_pi_input_t *input)
{
    const float error = fixed_finite(input->slip_ref - input->slip);
    const float direct = fixed_finite(config->kp * scheduled_gain(config, input->speed_m_s) * error);
    state->integral = fixed_clamp(fixed_finite(duty) - direct, -config->duty_max, config->duty_max);
}
