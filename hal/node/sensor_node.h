// sensor_node.h - the node of a rover whose radar, IMU and battery are no devices of its computer: their counts over CAN (docs/can.md).
//
// Answers each SYNC with ACCEL, RATES, SUPPLY and as many RADAR frames of four samples as its FIFO fills. The caller owns controller and
// converters, as with wheel_node.h.
#ifndef TRACTION_HAL_NODE_SENSOR_NODE_H
#define TRACTION_HAL_NODE_SENSOR_NODE_H

#include "firmware/core/signals.h"
#include "hal/can/can_frame.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { SENSOR_NODE_ANSWERS = 3 + RADAR_SAMPLES_PER_TICK_MAX / 4 };

// `input`: of a sensor frame, `present` says what was read: battery, accel, gyro, radar, emergency stop; counts as signals.h has them,
// radar samples held to 10 bits. Any frame is accepted. Returns how many answers are to be sent: 0, or 3 and the radar's.
size_t sensor_node_receive(const sensor_frame_t *input, const can_frame_t *frame, can_frame_t answer[SENSOR_NODE_ANSWERS]);

#ifdef __cplusplus
}
#endif

#endif
