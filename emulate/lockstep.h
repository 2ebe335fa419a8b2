// lockstep.h - what the emulated board and its world say to each other: one record each way, over two FIFOs, the board waiting.
//
// The board writes lockstep_board_t and its frames, then reads lockstep_world_t, its frames and radar samples. While it reads the whole
// virtual machine stands still, so however slow the world is, no time passes on the board. Little-endian on both sides, no padding.
#ifndef TRACTION_EMULATE_LOCKSTEP_H
#define TRACTION_EMULATE_LOCKSTEP_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    LOCKSTEP_VERSION = 1,
    LOCKSTEP_FRAMES = 64,  // of one record, at most
    LOCKSTEP_SAMPLES = 64, // likewise
    LOCKSTEP_RAW = 7,      // battery, accelerometer x, y, z, gyro x, y, z
};

// Lines of the board's GPIO chip, as its rover's description names them.
enum {
    LOCKSTEP_LINE_STOP = 4,
    LOCKSTEP_LINE_STOP_PRESENT = 5,
    LOCKSTEP_LINE_MOTOR_ENABLE = 6,
    LOCKSTEP_LINE_LED = 7,
    LOCKSTEP_LINE_BRAKE = 8,
};

typedef struct {
    uint32_t id; // 11 bits
    uint8_t length;
    uint8_t zero[3];
    uint8_t data[8];
} lockstep_frame_t; // struct can_frame of Linux

typedef struct {
    uint32_t version;
    uint32_t over;      // 0: tractiond runs; 1: it has ended with `status`, and this is the last record
    int64_t time_ns;    // the board's CLOCK_MONOTONIC
    int64_t cpu_ns;     // processor time that tractiond has had, all its threads
    uint32_t lines;     // bit n: output line n is active
    uint32_t frames;    // how many follow; what tractiond has sent since the last record
    int32_t status;     // exit code; 128 and the signal's number
    uint32_t memory_kB; // largest resident set so far; in the last record alone
} lockstep_board_t;

typedef struct {
    uint32_t lines;        // bit n: input line n is pulled high
    uint32_t frames;       // how many follow; what the nodes say
    uint32_t samples;      // how many radar samples follow those, as int32_t; 0 where the radar is a node's
    uint32_t first_sample; // number of the first
    uint32_t raw_given;    // bit n: raw[n] is a new count
    uint32_t stop;         // 1: SIGTERM for tractiond
    int32_t raw[LOCKSTEP_RAW];
    uint32_t radar_rate_Hz; // of the samples
} lockstep_world_t;

#ifdef __cplusplus
}
static_assert(sizeof(lockstep_frame_t) == 16 && sizeof(lockstep_board_t) == 40 && sizeof(lockstep_world_t) == 56);
#else
_Static_assert(sizeof(lockstep_frame_t) == 16 && sizeof(lockstep_board_t) == 40 && sizeof(lockstep_world_t) == 56, "no padding");
#endif

#endif
