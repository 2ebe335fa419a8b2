// pwm_wheels.h - wheels without nodes: the board's own PWM (sysfs), quadrature counters (counter subsystem), currents (IIO), direction
// lines.
//
//   duty_cycle = |duty_q15| period / 32767, rounded down; the direction line is active for a negative duty                       (1)
//
// A change of direction goes through duty 0. Coast: PWM disabled. Brake: duty 0, PWM enabled, and the brake line where there is one.
// Nothing here lets a bridge go when the computer stops: the hardware watchdog does after its seconds, or a monostable on the enable line.
#ifndef TRACTION_HAL_LINUX_PWM_WHEELS_H
#define TRACTION_HAL_LINUX_PWM_WHEELS_H

#include "gpio.h"
#include "hardware.h"

#include "firmware/core/signals.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    int duty, enable, count, current; // descriptors, -1: closed
    gpio_line_t direction;
    bool enabled, backward;
} pwm_wheel_t;

typedef struct {
    pwm_wheel_t wheel[WHEEL_COUNT];
    int32_t period_ns;
} pwm_wheels_t;

// Takes PWM, counters, currents and lines as [hardware] names them; every bridge coasts. false: message says file, line, key, what and
// mend.
bool pwm_wheels_open(pwm_wheels_t *wheels, const hardware_t *hardware, const char *root, const gpio_chip_t *chip,
                     char message[HARDWARE_MESSAGE]);

// Encoders and currents; what could be read gains its bits in `present`, and with both the bridge's.
void pwm_wheels_read(pwm_wheels_t *wheels, sensor_frame_t *frame);

// false: an order was not taken.
bool pwm_wheels_write(pwm_wheels_t *wheels, const gpio_chip_t *chip, const actuator_frame_t *actuator);

void pwm_wheels_close(pwm_wheels_t *wheels);

#ifdef __cplusplus
}
#endif

#endif
