// wheel_node.h - one wheel's node: PWM and brake out, encoder and current in, over CAN (docs/can.md). The reference for a microcontroller.
//
//   an order counts if its checksum is right, its drive is known and 1 <= (sequence - last) mod 256 <= 127, or nothing is in force  (1)
//   now - heard > BRIDGE_RELEASE_MS: the bridge lets the motor go, and any next order counts                                        (2)
//
// The caller owns controller, clock and pins: it hands every received frame to wheel_node_receive with its inputs latched as the frame came
// in, sends what it gets back, calls wheel_node_output at least every millisecond and sets the bridge to what that says. No heap, no clock,
// no floating point; state of 32 bytes.
#ifndef TRACTION_HAL_NODE_WHEEL_NODE_H
#define TRACTION_HAL_NODE_WHEEL_NODE_H

#include "firmware/core/signals.h"
#include "hal/can/can_frame.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    uint8_t wheel;         // 0..3
    uint8_t bus_off_count; // as the controller tells; shown in DIAGNOSIS
} wheel_node_config_t;

typedef struct {
    int32_t encoder_count;  // cumulative, wraps; sampled as the frame came in
    uint16_t current_count; // offset binary
    uint8_t bridge_status;  // BRIDGE_* bits that the bridge's own electronics tell
} wheel_node_input_t;

typedef struct {
    drive_state_t drive; // DRIVE_OFF until the first order, DRIVE_COAST once it is released
    int16_t duty_q15;    // -32767..32767; means something with DRIVE_ON alone
} wheel_node_output_t;

typedef struct {
    drive_state_t drive;
    int16_t duty_q15;
    uint8_t sequence;
    bool in_force, released; // an order is; (2) has happened
    uint32_t heard_ms;
    uint8_t crc_errors, sequence_errors, releases; // modulo 256
} wheel_node_state_t;                              // zeroed = just switched on

enum { WHEEL_NODE_ANSWERS = 2 };

// Any frame is accepted. `now_ms` may wrap. Fills answers and returns how many there are to be sent.
size_t wheel_node_receive(const wheel_node_config_t *config, wheel_node_state_t *state, uint32_t now_ms, const wheel_node_input_t *input,
                          const can_frame_t *frame, can_frame_t answer[WHEEL_NODE_ANSWERS]);

// What the bridge is to do now; carries out (2).
wheel_node_output_t wheel_node_output(wheel_node_state_t *state, uint32_t now_ms);

#ifdef __cplusplus
}
#endif

#endif
