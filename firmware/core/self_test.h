// self_test.h - is the rover whole? Asked before it drives: what its sensors say at rest, and what a small pulse of each motor does.
//
// An operator of control_step, so safety and the emergency stop stay in force: it gives commands, and is shown frame and trace of each
// tick.
//   rest    1 s, wheels braked or free: offset and noise of the radar, gravity, yaw rate, currents without a motor, battery    (1)
//   pulse   each wheel in turn, the others shorted: duty rises to duty_max in 0.2 s, ends when the wheel has turned `enough`   (2)
// Wheels may stand on the ground: the torque is at most duty_max KG V/Ra (0.29 N m of the reference's 0.59), the way a few millimetres.
// A slope of more than about 5 deg turns even shorted wheels: then the rover is told not to be at rest. What rest cannot show: a bias of
// the accelerometer along x looks like a slope (up to accel_slope it passes); a swap of two wheels that roll on hard ground alike. Limits
// are assumed; each stands in rover_config.c beside its reason.
#ifndef TRACTION_FIRMWARE_CORE_SELF_TEST_H
#define TRACTION_FIRMWARE_CORE_SELF_TEST_H

#include "sense.h"
#include "signals.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    SELF_TEST_SILENT = 1u << 0,        // a device that the rover must have did not answer in most ticks
    SELF_TEST_MOVING = 1u << 1,        // wheels turn while nothing drives them
    SELF_TEST_RADAR_DEAD = 1u << 2,    // less noise than a front end makes
    SELF_TEST_RADAR_NOISY = 1u << 3,   // far more
    SELF_TEST_RADAR_OFFSET = 1u << 4,  // its converter rests elsewhere than the description says
    SELF_TEST_ACCEL = 1u << 5,         // what it feels at rest is not gravity
    SELF_TEST_GYRO = 1u << 6,          // it turns at rest
    SELF_TEST_BATTERY = 1u << 7,       // too low to drive
    SELF_TEST_CURRENT_ZERO = 1u << 8,  // a current without a motor driven
    SELF_TEST_CURRENT_SIGN = 1u << 9,  // against the duty
    SELF_TEST_MOTOR_OPEN = 1u << 10,   // none, or far less than the winding lets through
    SELF_TEST_ENCODER_SIGN = 1u << 11, // the wheel turns against the duty: encoder or motor leads swapped
    SELF_TEST_ENCODER_DEAD = 1u << 12, // the motor draws its current and the encoder does not move: dead, or the wheel is held
    SELF_TEST_WHEEL_ORDER = 1u << 13,  // another wheel's encoder or current answers
    SELF_TEST_STOPPED = 1u << 14,      // safety stopped the rover meanwhile
    SELF_TEST_FAILURES = 15,           // how many there are
} self_test_failure_t;

typedef struct {
    uint32_t required;                                               // FRAME_* bits that must answer
    uint32_t wheels;                                                 // bit i: the rover has wheel i
    int32_t rest_ticks;                                              // of (1)
    int32_t pulse_ticks;                                             // of (2), at most, each wheel
    int32_t settle_ticks;                                            // between pulses
    float duty_max;                                                  // of (2)
    int32_t enough_count;                                            // pulses of the encoder that end (2)
    int32_t least_count;                                             // fewer are no motion
    int32_t still_count;                                             // more than so many at rest are motion
    float radar_offset_count, radar_dead_count2, radar_noisy_count2; // against the description; variances
    int32_t radar_rest_count;                                        // the description's
    float gravity_m_s2, gravity_slack_m_s2, accel_slope_m_s2, accel_m_s2_per_count;
    float gyro_rad_s;
    float battery_V;
    float zero_A;
    float winding_1_ohm; // 1/Ra
    float current_least; // share of duty V/Ra that must flow
} self_test_config_t;

typedef struct {
    int32_t tick, wheel; // of the phase; wheel -1: rest
    uint32_t silent;     // FRAME_* bits that were missing in half of the ticks at rest
    uint8_t missing[32];
    int32_t begin_count[WHEEL_COUNT];
    float duty;
    uint32_t frames;
    int32_t radar_n, radar_sum;
    uint32_t radar_square;
    float accel_m_s2[3], gyro_rad_s, battery_V, current_A[WHEEL_COUNT]; // sums at rest
    float pulse_A[WHEEL_COUNT], pulse_V;                                // sums of a pulse
    int32_t pulse_n;
    uint32_t turned;               // bit i: encoder i has moved in somebody's pulse
    uint32_t instead[WHEEL_COUNT]; // who turned where wheel i should have
    bool seen;
} self_test_state_t; // begin with self_test_begin

typedef struct {
    uint32_t failures; // self_test_failure_t bits
    uint32_t wheels;   // bit i: a failure of wheel i
    bool done;
    float radar_offset_count, radar_noise_count, accel_m_s2[3], battery_V; // as measured at rest
} self_test_result_t;

void self_test_begin(self_test_state_t *state, self_test_result_t *result);

// One tick: `frame` as it was read, `trace` of the tick before (null in the first). Gives the command of this tick. Once result->done,
// MODE_STOP.
command_t self_test_step(const self_test_config_t *config, const sense_config_t *sense, self_test_state_t *state,
                         const sensor_frame_t *frame, const trace_t *trace, self_test_result_t *result);

// A failure in words, index 0..SELF_TEST_FAILURES-1, its bit being 1 << index; "" beyond.
const char *self_test_name(int32_t index);

#ifdef __cplusplus
}
#endif

#endif
