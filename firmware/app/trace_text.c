#include "trace_text.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static uint32_t bits_of(float value)
{
    uint32_t bits = 0;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static char *floats(char *at, const float *value, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        at += sprintf(at, " %08" PRIx32, bits_of(value[i]));
    }
    return at;
}

void trace_text(const trace_t *trace, char line[TRACE_TEXT])
{
    char *at = line;
    at += sprintf(at, "%" PRIu32 " %d %08" PRIx32 " %" PRIx32 " %08" PRIx32, trace->tick, (int)trace->mode, trace->faults,
                  trace->fault_wheels, trace->present);
    for (int i = 0; i < WHEEL_COUNT; i++) {
        const wheel_trace_t *w = &trace->wheel[i];
        const float values[] = {w->speed_rad_s, w->accel_rad_s2, w->set_speed_rad_s, w->current_A, w->torque_Nm,
                                w->traction_N,  w->slip,         w->slip_std,        w->duty};
        at = floats(at, values, sizeof values / sizeof *values);
        at += sprintf(at, " %d%d%d %d", w->slip_valid, w->saturated, w->encoder_refused, trace->actuator.duty_q15[i]);
    }
    const float values[] = {trace->battery_voltage_V, trace->accel_x_m_s2,  trace->gyro_z_rad_s,   trace->radar_speed_m_s,
                            trace->speed_m_s,         trace->speed_std_m_s, trace->accel_bias_m_s2};
    at = floats(at, values, sizeof values / sizeof *values);
    (void)sprintf(at, " %d%d%d%d\n", trace->radar_fresh, trace->standstill, (int)trace->actuator.drive, trace->actuator.status_led);
}

uint64_t trace_text_hash(uint64_t hash, const char *line)
{
    for (; *line != '\0'; line++) {
        hash = (hash ^ (uint8_t)*line) * 1099511628211u;
    }
    return hash;
}
