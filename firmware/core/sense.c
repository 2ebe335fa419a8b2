#include "sense.h"

#include "fixed.h"

// (1) and (2) for one wheel.
static void measure_wheel(const sense_config_t *config, sense_state_t *state, const sensor_frame_t *frame, int wheel, sense_output_t *out)
{
    const uint32_t bit = (uint32_t)FRAME_ENCODER_0 << (uint32_t)wheel;
    int32_t *ring = state->count[wheel];
    const int32_t last = ring[(state->head + SENSE_HISTORY - 1) % SENSE_HISTORY];
    const int32_t middle = ring[(state->head + SENSE_HISTORY - 4) % SENSE_HISTORY];
    const int32_t oldest = ring[state->head];
    int32_t now = (int32_t)((uint32_t)last + (uint32_t)state->step[wheel]); // what a silent encoder would have said

    if ((frame->present & bit) != 0u) {
        const bool first = (state->encoder_seen & bit) == 0u;
        const int32_t step = first ? 0 : fixed_wrap_difference(frame->encoder_count[wheel], last);
        now = frame->encoder_count[wheel];
        if (first) {
            for (int i = 0; i < SENSE_HISTORY; i++) {
                ring[i] = now;
            }
            state->encoder_seen |= bit;
            state->speed_rad_s[wheel] = 0.0f;
            state->step[wheel] = 0;
            out->usable |= bit;
        } else if (step > config->encoder_step_max || step < -config->encoder_step_max) {
            out->absurd |= bit; // the new count is the base of the next difference; the speed is held
        } else {
            state->step[wheel] = step;
            state->speed_rad_s[wheel] = (float)(step * config->encoder_sign[wheel]) * config->speed_rad_s_per_count; // (1)
            out->usable |= bit;
        }
        if (first) {
            out->speed_rad_s[wheel] = 0.0f;
            out->accel_rad_s2[wheel] = 0.0f;
            ring[state->head] = now;
            return;
        }
    }
    const int32_t bend = fixed_wrap_difference(fixed_wrap_difference(now, middle), fixed_wrap_difference(middle, oldest));
    const int32_t limit = 4 * config->encoder_step_max;
    const int32_t limited = bend < -limit ? -limit : bend > limit ? limit : bend;
    out->speed_rad_s[wheel] = state->speed_rad_s[wheel];
    out->accel_rad_s2[wheel] = (float)(limited * config->encoder_sign[wheel]) * config->accel_rad_s2_per_count; // (2)
    ring[state->head] = now;
}

static void measure_current(const sense_config_t *config, sense_state_t *state, const sensor_frame_t *frame, int wheel, sense_output_t *out)
{
    const uint32_t bit = (uint32_t)FRAME_CURRENT_0 << (uint32_t)wheel;
    if ((frame->present & bit) != 0u) {
        const int32_t count = frame->current_count[wheel];
        if (count <= 0 || count >= config->current_max_count) {
            out->absurd |= bit;
        } else {
            state->current_A[wheel] = (float)(count - config->current_offset_count[wheel]) * config->current_A_per_count;
            out->usable |= bit;
        }
    }
    out->current_A[wheel] = state->current_A[wheel];
}

static void measure_body(const sense_config_t *config, sense_state_t *state, const sensor_frame_t *frame, sense_output_t *out)
{
    if ((frame->present & FRAME_BATTERY) != 0u) {
        if (frame->battery_count == 0u || frame->battery_count >= config->battery_max_count) {
            out->absurd |= FRAME_BATTERY;
        } else {
            state->battery_V = (float)(frame->battery_count - config->battery_offset_count) * config->battery_V_per_count;
            out->usable |= FRAME_BATTERY;
        }
    }
    if ((frame->present & FRAME_ACCEL) != 0u) {
        if (frame->accel_x_count == INT16_MAX || frame->accel_x_count == INT16_MIN) {
            out->absurd |= FRAME_ACCEL;
        } else {
            state->accel_x_m_s2 = (float)(frame->accel_x_count - config->accel_offset_count) * config->accel_m_s2_per_count;
            out->usable |= FRAME_ACCEL;
        }
    }
    if ((frame->present & FRAME_GYRO) != 0u) {
        if (frame->gyro_z_count == INT16_MAX || frame->gyro_z_count == INT16_MIN) {
            out->absurd |= FRAME_GYRO;
        } else {
            state->gyro_z_rad_s = (float)(frame->gyro_z_count - config->gyro_offset_count) * config->gyro_rad_s_per_count;
            out->usable |= FRAME_GYRO;
        }
    }
    out->battery_V = state->battery_V;
    out->accel_x_m_s2 = state->accel_x_m_s2;
    out->gyro_z_rad_s = state->gyro_z_rad_s;
}

static void check_radar(const sense_config_t *config, const sensor_frame_t *frame, sense_output_t *out)
{
    if ((frame->present & FRAME_RADAR) == 0u) {
        return;
    }
    bool sane = frame->radar_samples <= RADAR_SAMPLES_PER_TICK_MAX;
    for (uint32_t i = 0; sane && i < frame->radar_samples; i++) {
        sane = frame->radar_count[i] <= config->radar_max_count;
    }
    if (!sane) {
        out->absurd |= FRAME_RADAR;
    } else if (frame->radar_samples > 0u) {
        out->usable |= FRAME_RADAR;
    }
}

sense_output_t sense_measure(const sense_config_t *config, sense_state_t *state, const sensor_frame_t *frame)
{
    sense_output_t out = {0};
    out.elapsed_ticks = frame->elapsed_ticks != 0u ? frame->elapsed_ticks : frame->tick - state->last_tick;
    state->last_tick = frame->tick;
    for (int wheel = 0; wheel < WHEEL_COUNT; wheel++) {
        measure_wheel(config, state, frame, wheel, &out);
        measure_current(config, state, frame, wheel, &out);
    }
    state->head = (state->head + 1) % SENSE_HISTORY;
    measure_body(config, state, frame, &out);
    check_radar(config, frame, &out);
    return out;
}
