#include "soil_sweep.h"

#include "fixed.h"

soil_sweep_output_t soil_sweep_step(const soil_sweep_config_t *config, soil_sweep_state_t *state, float speed_ref_m_s)
{
    const float ramp_rad_s2 = fixed_finite(speed_ref_m_s) / config->wheel_radius_m / config->zero_slip_s;
    const float elapsed_s = (float)state->elapsed_ticks * config->tick_s;
    soil_sweep_output_t out;
    out.front_rad_s = fixed_clamp(fixed_finite(ramp_rad_s2 * elapsed_s), -config->wheel_max_rad_s, config->wheel_max_rad_s); // (15)
    out.done = state->elapsed_ticks >= config->duration_ticks;
    if (!out.done) {
        state->elapsed_ticks++;
    }
    return out;
}
