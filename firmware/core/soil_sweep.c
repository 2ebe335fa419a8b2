#include "soil_sweep.h"

#include "fixed.h"

soil_sweep_output_t soil_sweep_step(const soil_sweep_config_t *config, soil_sweep_state_t *state, float speed_ref_m_s)
{
    soil_sweep_output_t out;
    out.front_rad_s = fixed_clamp(fixed_finite(fixed_finite(speed_ref_m_s) * config->ramp_1_m * (float)state->elapsed_ticks),
                                  -config->wheel_max_rad_s, config->wheel_max_rad_s); // (15)
    out.done = state->elapsed_ticks >= config->duration_ticks;
    if (!out.done) {
        state->elapsed_ticks++;
    }
    return out;
}
