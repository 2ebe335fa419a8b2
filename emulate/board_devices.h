// board_devices.h - the emulated board's devices as its kernel has them: can0 (vcan), a GPIO chip (gpio-sim), converters (traction_adc).
//
// The firmware opens them through SocketCAN, the GPIO character device and IIO, as on a rover. This is their other end.
#ifndef TRACTION_EMULATE_BOARD_DEVICES_H
#define TRACTION_EMULATE_BOARD_DEVICES_H

#include "lockstep.h"

typedef struct {
    int can;      // raw socket: hears what the firmware sends, and not itself
    int adc;      // /dev/traction-adc
    int pull[2];  // input lines: stop, its presence
    int value[3]; // output lines: motor enable, LED, brake
    uint32_t pulled;
    int64_t radar_begin_ns; // when sample 0 was taken
    int radar_seen;
} board_devices_t;

// Makes all of them. 0, or the name of what failed, errno set.
const char *board_devices_make(board_devices_t *devices);

// Frames that wait, at most LOCKSTEP_FRAMES; returns how many.
uint32_t board_devices_take(const board_devices_t *devices, lockstep_frame_t frame[LOCKSTEP_FRAMES]);

// Output lines, bit n: line n.
uint32_t board_devices_lines(const board_devices_t *devices);

// Lines first, then converters, then frames: who wakes up by a frame finds the rest in place. 0, or the name of what failed.
const char *board_devices_give(board_devices_t *devices, const lockstep_world_t *world, const lockstep_frame_t *frame,
                               const int32_t *sample, int64_t now_ns);

#endif
