#include "daemon.h"

static bool lost(hal_result_t result) { return result < 0 && result != HAL_ERR_TIMEOUT; }

// A bridge that took no order releases itself after BRIDGE_RELEASE_MS (signals.h); until then the next order may still reach it.
enum { LOST_WRITES_MAX = BRIDGE_RELEASE_MS * 1000 / TICK_US - 1 };

typedef struct {
    control_state_t control;
    self_test_state_t self_test;
    trace_t trace; // of the tick before
    bool traced;
    uint32_t lost_writes; // in a row
} drive_state;

// Who asks in this tick: the self-test until it is over, then the operator.
static command_t command_of(const control_config_t *config, const daemon_link_t *link, const daemon_start_t *start, drive_state *state,
                            const sensor_frame_t *frame, daemon_result_t *out)
{
    command_t command = {.mode = MODE_STOP};
    if (start->self_test && !out->self_test.done) {
        return self_test_step(&config->self_test, &config->sense, &state->self_test, frame, state->traced ? &state->trace : 0,
                              &out->self_test);
    }
    link->command(link->context, frame, &command);
    return command;
}

// One tick; sets ended_by when it is the last.
static void tick(const hal_t *hal, const control_config_t *config, const daemon_link_t *link, const daemon_start_t *start,
                 drive_state *state, daemon_result_t *out)
{
    const hal_result_t due = hal->wait_tick(hal->context);
    if (due != HAL_OK && due != HAL_ERR_TIMEOUT) {
        out->ended_by = due;
        return;
    }
    sensor_frame_t frame = {0};
    const hal_result_t read = hal->read(hal->context, &frame);
    if (lost(read)) {
        out->ended_by = read;
        return;
    }
    const command_t command = command_of(config, link, start, state, &frame, out);
    state->trace = control_step(config, &state->control, &command, &frame);
    state->traced = true;
    const hal_result_t written = hal->write(hal->context, &state->trace.actuator);
    state->lost_writes = written == HAL_ERR_TIMEOUT ? state->lost_writes + 1u : 0u;
    if (lost(written) || state->lost_writes > LOST_WRITES_MAX) {
        out->ended_by = written;
    } else {
        hal_kick_watchdog(hal);
    }
    out->ticks++;
    out->faults |= state->trace.faults;
    for (int i = 0; start->rise_out_K != 0 && i < WHEEL_COUNT; i++) {
        start->rise_out_K[i] = state->control.safety.rise_K[i];
    }
    if (link->log != 0) {
        link->log(link->context, &frame, &command, &state->trace);
    }
    if (out->ended_by == HAL_OK && out->self_test.failures != 0u && out->self_test.done) {
        out->ended_by = HAL_END;
    }
}

daemon_result_t daemon_run_from(const hal_t *hal, const control_config_t *config, const daemon_link_t *link, const daemon_start_t *start)
{
    daemon_result_t out = {.ended_by = hal_open_devices(hal)};
    hal_status_t status;
    if (out.ended_by == HAL_OK && start->self_test) {
        out.ended_by = hal_self_test(hal, &status);
    }
    drive_state state = {.traced = false};
    control_reset(config, &state.control);
    self_test_begin(&state.self_test, &out.self_test);
    if (start->self_test) {
        state.control.braking = true; // shorted windings hold it on a slope until something drives
    }
    if (start->warm) {
        safety_warm(&config->safety, &state.control.safety, start->rise_K);
    }
    while (out.ended_by == HAL_OK) {
        tick(hal, config, link, start, &state, &out);
    }
    hal->safe_stop(hal->context);
    hal_close_devices(hal);
    return out;
}

daemon_result_t daemon_run(const hal_t *hal, const control_config_t *config, const daemon_link_t *link)
{
    const daemon_start_t start = {.self_test = false};
    return daemon_run_from(hal, config, link, &start);
}
