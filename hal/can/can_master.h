// can_master.h - the rover computer's side of the CAN bus (docs/can.md): SYNC and orders out, a sensor frame from what the nodes answer.
//
//   answer to SYNC c counts in that tick alone: its counter must be c mod 8; what is older or comes twice is refused          (1)
//   n[k] = n[k-1] + ((f - n[k-1]) mod 8192)    number of the first radar sample f of a frame, from its lower 13 bits           (2)
//
// Portable C without a clock, a socket or a heap: hal/linux puts it on SocketCAN, hal/sim on a simulated bus, tests on arrays. (2) holds
// for 4096 samples of silence (2 s at 2 kHz); after 1 s of it the number is made to jump by 8192 and more, so that no gap is taken for
// none, and a sensor node that began anew is heard.
#ifndef TRACTION_HAL_CAN_CAN_MASTER_H
#define TRACTION_HAL_CAN_CAN_MASTER_H

#include "can_frame.h"

#include "firmware/core/signals.h"

#ifdef __cplusplus
extern "C" {
#endif

// What this rover has on the bus.
typedef struct {
    bool wheels, sensors; // four wheel nodes; a sensor node
    bool emergency_stop;  // the sensor node has its line
} can_master_config_t;

typedef struct {
    uint32_t refused_crc;                 // frames of a known identifier whose length or checksum is wrong
    uint32_t refused_age;                 // answers to another SYNC than this tick's, or twice the same
    uint32_t unknown;                     // frames of an identifier that is nobody's here
    uint32_t radar_lost;                  // samples that never arrived
    uint8_t node_refused[WHEEL_COUNT][4]; // as the nodes tell: checksum, sequence, releases, bus-offs; modulo 256
    uint8_t protocol[WHEEL_COUNT];        // 0: not heard yet
} can_master_counts_t;

typedef struct {
    uint8_t counter;   // of the last SYNC
    bool synced;       // there was one
    uint32_t answered; // FRAME_* bits of this tick
    sensor_frame_t frame;
    uint32_t radar_next; // the number that the next sample should have
    uint32_t radar_silent_ticks;
    bool radar_seen;
    can_master_counts_t counts;
} can_master_state_t; // zeroed = reset

// FRAME_* bits that answers can bring.
uint32_t can_master_expects(const can_master_config_t *config);

// A new tick: what was answered before is forgotten. Send *sync at once.
void can_master_sync(const can_master_config_t *config, can_master_state_t *state, can_frame_t *sync);

// Any frame is accepted; what is not an answer to this tick's SYNC is refused and counted. Returns whether it was taken.
bool can_master_receive(const can_master_config_t *config, can_master_state_t *state, const can_frame_t *frame);

// Whether all nodes have answered; the radar, whose frames vary in number, is not waited for beyond its first.
bool can_master_complete(const can_master_config_t *config, const can_master_state_t *state);

// Puts what was answered in this tick into *frame: `present` gains its bits, times are the caller's. The radar's samples are taken out.
void can_master_take(can_master_state_t *state, sensor_frame_t *frame);

// The four wheels' orders; a duty beyond -32767..32767 is held there, an unknown drive is DRIVE_OFF.
void can_master_orders(const actuator_frame_t *actuator, can_frame_t orders[WHEEL_COUNT]);

#ifdef __cplusplus
}
#endif

#endif
