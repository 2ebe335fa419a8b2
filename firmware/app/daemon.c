#include "daemon.h"

static bool lost(hal_result_t result) { return result < 0 && result != HAL_ERR_TIMEOUT; }

daemon_result_t daemon_run(const hal_t *hal, const control_config_t *config, const daemon_link_t *link)
{
    daemon_result_t out = {.ended_by = HAL_OK};
    control_state_t state;
    control_reset(config, &state);
    while (out.ended_by == HAL_OK) {
        const hal_result_t tick = hal->wait_tick(hal->context);
        if (tick != HAL_OK && tick != HAL_ERR_TIMEOUT) {
            out.ended_by = tick;
            break;
        }
        sensor_frame_t frame = {0};
        const hal_result_t read = hal->read(hal->context, &frame);
        if (lost(read)) {
            out.ended_by = read;
            break;
        }
        command_t command = {.mode = MODE_STOP};
        link->command(link->context, &frame, &command);
        const trace_t trace = control_step(config, &state, &command, &frame);
        const hal_result_t written = hal->write(hal->context, &trace.actuator);
        if (written < 0) { // the bridges may still do what the last tick asked for
            out.ended_by = written;
        }
        out.ticks++;
        out.faults |= trace.faults;
        if (link->log != 0) {
            link->log(link->context, &frame, &command, &trace);
        }
    }
    hal->safe_stop(hal->context);
    return out;
}
