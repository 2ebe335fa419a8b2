// prove.c - what EVA is asked: from reset, any three frames and commands, with the rover's own configuration.
#include "firmware/core/rover_config.h"

#include <__fc_builtin.h>

int prove(void);

int prove(void)
{
    const control_config_t config = rover_config_default();
    control_state_t state;
    control_reset(&config, &state);
    int sum = 0;
    for (int tick = 0; tick < 3; tick++) {
        sensor_frame_t frame;
        command_t command;
        Frama_C_make_unknown((char *)&frame, sizeof frame);
        Frama_C_make_unknown((char *)&command, sizeof command);
        frame.emergency_stop = Frama_C_interval(0, 1) != 0;
        const trace_t trace = control_step(&config, &state, &command, &frame);
        sum += trace.actuator.duty_q15[0] != 0;
    }
    return sum;
}
