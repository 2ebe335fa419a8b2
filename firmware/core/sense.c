#include "sense.h"

#include "fixed.h"

static const uint32_t elapsed_most = 1000; // [ticks] of a gap that is measured across; after a longer one an encoder begins anew

// How much later than the frame before this one was taken. Without a clock, or with one that jumps, a tick is TICK_US.
static uint32_t elapsed_us(sense_state_t *state, const sensor_frame_t *frame, uint32_t ticks)
{
    const uint32_t nominal = ticks * (uint32_t)TICK_US;
    const bool timed = (frame->present & FRAME_TIME) != 0u;
    const uint32_t measured = frame->time_us - state->last_time_us; // wraps with the clock
    const bool known = timed && state->timed && measured > nominal / 2u && measured < nominal + nominal / 2u;
    state->last_time_us = timed ? frame->time_us : state->last_time_us;
    state->timed = timed;
    return known ? measured : nominal;
}

// The count of so many ticks ago; 0: of this one.
static int32_t *slot(sense_state_t *state, int wheel, int32_t back)
{
    return &state->count[wheel][(uint32_t)(state->head - back) % SENSE_RING];
}

// (2)
static float bend_rad_s2(const sense_config_t *config, sense_state_t *state, int wheel)
{
    const int32_t middle = *slot(state, wheel, 4);
    const int32_t bend =
        fixed_wrap_difference(fixed_wrap_difference(*slot(state, wheel, 0), middle), fixed_wrap_difference(middle, *slot(state, wheel, 8)));
    const int32_t limit = 4 * config->encoder_step_max;
    const int32_t limited = bend < -limit ? -limit : bend > limit ? limit : bend;
    return (float)(limited * config->encoder_sign[wheel]) * config->accel_rad_s2_per_count;
}

// The counts of `ticks` - 1 ticks before this one, on the line that ends at `now` and rises by `step` in all.
static void fill_line(sense_state_t *state, int wheel, int32_t now, int32_t step, int32_t ticks)
{
    for (int32_t back = 1; back < ticks && back <= 8; back++) {
        *slot(state, wheel, back) = (int32_t)((uint32_t)now - (uint32_t)(step * back / ticks));
    }
}

static float speed_of(const sense_config_t *config, int32_t step, uint32_t interval_us)
{
    const int32_t late_us = (int32_t)(interval_us - (uint32_t)TICK_US);
    const bool punctual = late_us > -50 && late_us < 50; // [us] half a percent of a tick: not worth a division
    return punctual ? (float)step * config->speed_rad_s_per_count : (float)step * config->encoder_rad_per_count * 1e6f / (float)interval_us;
}

static void first_count(sense_state_t *state, const sensor_frame_t *frame, int wheel)
{
    const int32_t now = frame->encoder_count[wheel];
    for (int i = 0; i < SENSE_RING; i++) {
        state->count[wheel][i] = now;
    }
    state->raw[wheel] = now;
    state->place[wheel] = now;
    state->silent_ticks[wheel] = 0;
    state->silent_us[wheel] = 0;
    state->speed_rad_s[wheel] = 0.0f;
    state->step[wheel] = 0;
}

// (1) and (2) for one wheel; interval_us: since the frame before.
static void measure_wheel(const sense_config_t *config, sense_state_t *state, const sensor_frame_t *frame, int wheel, uint32_t interval_us,
                          sense_output_t *out)
{
    const uint32_t bit = (uint32_t)FRAME_ENCODER_0 << (uint32_t)wheel;
    const uint32_t ticks = state->silent_ticks[wheel] + out->elapsed_ticks;
    const bool here = (frame->present & bit) != 0u;
    if (here && ((state->encoder_seen & bit) == 0u || ticks > elapsed_most)) {
        first_count(state, frame, wheel);
        state->encoder_seen |= bit;
        state->stepped &= ~bit;
        out->usable |= bit;
        return;
    }
    const int32_t n = (int32_t)(ticks > elapsed_most ? elapsed_most : ticks);
    const int32_t held = state->step[wheel] * n; // what a silent encoder would have said
    int32_t step = held;
    if (here) {
        const int32_t limit = config->encoder_step_max * n;
        const int32_t said = fixed_wrap_difference(frame->encoder_count[wheel], state->raw[wheel]);
        if (said > limit || said < -limit) {
            out->absurd |= bit; // the new count is the base of the next difference; the speed is held
        } else {
            step = said;
            const int32_t per_tick = n == 1 ? step : step / n;
            const int32_t change = per_tick - state->step[wheel];
            const int32_t most = config->encoder_jump_max * n;
            out->jumped |= (state->stepped & bit) != 0u && (change > most || change < -most) ? bit : 0u;
            state->stepped |= bit;
            state->step[wheel] = per_tick;
            state->speed_rad_s[wheel] = speed_of(config, step * config->encoder_sign[wheel], state->silent_us[wheel] + interval_us); // (1)
            out->usable |= bit;
        }
    }
    const int32_t now = (int32_t)((uint32_t)state->place[wheel] + (uint32_t)step);
    if (n > 1) {
        fill_line(state, wheel, now, step, n);
    }
    if (here) {
        state->raw[wheel] = frame->encoder_count[wheel];
        state->place[wheel] = now;
    }
    state->silent_ticks[wheel] = here ? 0u : ticks > elapsed_most ? elapsed_most : ticks;
    state->silent_us[wheel] = here || ticks > elapsed_most ? 0u : state->silent_us[wheel] + interval_us;
    *slot(state, wheel, 0) = now;
    out->speed_rad_s[wheel] = state->speed_rad_s[wheel];
    out->accel_rad_s2[wheel] = bend_rad_s2(config, state, wheel);
}

void sense_replace(const sense_config_t *config, sense_state_t *state, sense_output_t *out, int wheel, float speed_rad_s)
{
    const float most = (float)config->encoder_step_max;
    const float counts = fixed_clamp(fixed_finite(speed_rad_s / config->speed_rad_s_per_count), -most, most);
    const int32_t step = (int32_t)(counts < 0.0f ? counts - 0.5f : counts + 0.5f) * config->encoder_sign[wheel];
    const int32_t now = (int32_t)((uint32_t)*slot(state, wheel, 1) + (uint32_t)step);
    *slot(state, wheel, 0) = now;
    state->place[wheel] = now;
    state->step[wheel] = step;
    state->speed_rad_s[wheel] = counts * config->speed_rad_s_per_count;
    out->speed_rad_s[wheel] = state->speed_rad_s[wheel];
    out->accel_rad_s2[wheel] = bend_rad_s2(config, state, wheel);
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

static bool railed(int16_t count) { return count == INT16_MAX || count == INT16_MIN; }

static void measure_lean(const sense_config_t *config, sense_state_t *state, const sensor_frame_t *frame, uint32_t elapsed_ticks)
{
    const uint32_t rates = FRAME_GYRO | FRAME_GYRO_XY;
    const uint32_t forces = FRAME_ACCEL | FRAME_ACCEL_YZ;
    if (config->lean.gravity_q8 == 0 || (frame->present & rates) != rates || railed(frame->gyro_x_count) || railed(frame->gyro_y_count) ||
        railed(frame->gyro_z_count)) {
        return;
    }
    const lean_input_t input = {
        .gyro_count = {frame->gyro_x_count, frame->gyro_y_count, frame->gyro_z_count},
        .accel_count = {frame->accel_x_count - config->accel_offset_count, frame->accel_y_count},
        .accel = (frame->present & forces) == forces,
        .standing = state->standing,
        .moved_q8 = state->gyro_q8,
        .elapsed_ticks = elapsed_ticks,
    };
    lean_step(&config->lean, &state->lean, &input);
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
    measure_lean(config, state, frame, out->elapsed_ticks);
    if ((frame->present & FRAME_ACCEL) != 0u) {
        if (frame->accel_x_count == INT16_MAX || frame->accel_x_count == INT16_MIN) {
            out->absurd |= FRAME_ACCEL;
        } else {
            const int32_t count = frame->accel_x_count - config->accel_offset_count;
            state->accel_x_m_s2 = (float)count * config->accel_m_s2_per_count;
            state->level_m_s2 = (float)(count * 256 - state->lean.lean_q8) * config->level_m_s2_per_q8;
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
    out->level_m_s2 = state->level_m_s2;
    out->lean_q8 = state->lean.lean_q8;
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
    const uint32_t said = frame->elapsed_ticks != 0u ? frame->elapsed_ticks : frame->tick - state->last_tick;
    const bool sensible = said != 0u && said <= elapsed_most; // time that stands or runs back is safety's to judge
    out.elapsed_ticks = sensible ? said : 1u;
    state->last_tick = frame->tick;
    state->head = (int32_t)(((uint32_t)state->head + out.elapsed_ticks) % SENSE_RING);
    const uint32_t interval_us = elapsed_us(state, frame, out.elapsed_ticks);
    for (int wheel = 0; wheel < WHEEL_COUNT; wheel++) {
        measure_wheel(config, state, frame, wheel, interval_us, &out);
        measure_current(config, state, frame, wheel, &out);
    }
    measure_body(config, state, frame, &out);
    check_radar(config, frame, &out);
    return out;
}
