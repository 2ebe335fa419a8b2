// linux_hal.h - the rover's own devices behind hal_t: wheel nodes over CAN or the board's PWM and counters, sensors over CAN or IIO, lines,
// clock, watchdog, as [hardware] of its description names them (hardware.h).
//
//   wait_tick    sleeps to the absolute deadline t0 + 10 ms k on CLOCK_MONOTONIC, sends SYNC, takes answers until all are there, at most 3
//   ms read         never waits: answers, the radar's FIFO, raw channels, lines write        orders or PWM; motor enable is active unless
//   DRIVE_OFF; brake line with DRIVE_BRAKE; LED safe_stop    motor enable inactive first, then DRIVE_OFF to every bridge
//
// A deadline that is more than a tick past is missed: `tick` and `elapsed_ticks` tell, and the next is on the old grid.
#ifndef TRACTION_HAL_LINUX_LINUX_HAL_H
#define TRACTION_HAL_LINUX_LINUX_HAL_H

#include "can_socket.h"
#include "gpio.h"
#include "hardware.h"
#include "iio.h"
#include "pwm_wheels.h"

#include "hal/can/can_master.h"
#include "hal/hal.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { LINUX_RAW_CHANNELS = HARDWARE_gyro_z - HARDWARE_battery + 1 };

typedef struct {
    hardware_t hardware;
    const char *root; // before /sys and /dev: "" but in tests
    can_socket_t bus; // taken as it is where its fd is 0 or more (tests)
    can_master_config_t nodes;
    can_master_state_t master;
    gpio_chip_t chip; // its ioctl is kept
    gpio_line_t stop, stop_present, enable, brake, led;
    int raw[LINUX_RAW_CHANNELS]; // battery, accel, gyro by IIO, in the order of the keys
    iio_capture_t radar;
    pwm_wheels_t wheels;
    int watchdog;
    int64_t due_ns, latched_ns; // of the next tick; when this one's inputs were latched
    uint32_t tick, read_tick;   // ticks given; the number of the last that was read, plus 1
    uint32_t overruns, lost_writes;
    uint32_t expected, present; // FRAME_* bits: of this rover; of the last frame
    uint32_t sequence;          // of the last order
    bool enabled, open;
    char trouble[HARDWARE_MESSAGE]; // why it did not open, or what was lost; one line
    char note[HARDWARE_MESSAGE];    // what is not permitted here but not needed
} linux_hal_t;

// Fills *linux_hal from *hardware; touches no device. `root` is the caller's.
void linux_hal_begin(linux_hal_t *linux_hal, const hardware_t *hardware, const char *root);

// Its HAL; open takes the devices (HAL_ERR_CONFIG with `trouble`: file, line, key, what and mend).
hal_t linux_hal(linux_hal_t *linux_hal);

#ifdef __cplusplus
}
#endif

#endif
