#include "daemon.h"

static bool lost(hal_result_t result) { return result < 0 && result != HAL_ERR_TIMEOUT; }

// A bridge that took no order releases itself after BRIDGE_RELEASE_MS (signals.h); until then the next order may still reach it.
enum { LOST_WRITES_MAX = BRIDGE_RELEASE_MS * 1000 / TICK_US - 1 };

static void drive(const hal_t *hal, const control_config_t *config, const daemon_link_t *link, daemon_result_t *out)
{
    control_state_t state;
    control_reset(config, &state);
    uint32_t lost_writes = 0; // in a row
    while (out->ended_by == HAL_OK) {
        const hal_result_t tick = hal->wait_tick(hal->context);
        if (tick != HAL_OK && tick != HAL_ERR_TIMEOUT) {
            out->ended_by = tick;
            break;
        }
        sensor_frame_t frame = {0};
        const hal_result_t read = hal->read(hal->context, &frame);
        if (lost(read)) {
            out->ended_by = read;
            break;
        }
        command_t command = {.mode = MODE_STOP};
        link->command(link->context, &frame, &command);
        const trace_t trace = control_step(config, &state, &command, &frame);
        const hal_result_t written = hal->write(hal->context, &trace.actuator);
        lost_writes = written == HAL_ERR_TIMEOUT ? lost_writes + 1u : 0u;
        if (lost(written) || lost_writes > LOST_WRITES_MAX) {
            out->ended_by = written;
        } else {
            hal_kick_watchdog(hal);
        }
        out->ticks++;
        out->faults |= trace.faults;
        if (link->log != 0) {
            link->log(link->context, &frame, &command, &trace);
        }
    }
}

daemon_result_t daemon_run(const hal_t *hal, const control_config_t *config, const daemon_link_t *link)
{
    daemon_result_t out = {.ended_by = hal_open_devices(hal)};
    if (out.ended_by == HAL_OK) {
        drive(hal, config, link, &out);
    }
    hal->safe_stop(hal->context);
    hal_close_devices(hal);
    return out;
}
