// circuit.h - what a motor's own circuit says of its wheel: which encoder speed is impossible, and which winding is open.
//
//   duty V = Ra I + ke w                                                                                   (a) of motor.h
//   w_c = (duty V - Ra I)/ke                         speed by the circuit                                  (1)
//   r = duty V - Ra I - ke w,  |r| > r0 + a |Ra I| + b |ke w|      the encoder contradicts the circuit     (2)
//   |I| < I_open and |duty V - ke w| > V_dead + c |ke w|, or > V_open + c |ke w| where another motor draws current
//   on less                                                        no current where one must flow          (3)
//   |dw| > T KG V/(Ra J)                             more than stall torque does to a free wheel in a tick (4)
//
// A speed that jumps by more than (4) is believed if (1) jumps by at least half as much, in this tick or in this one and the last, or to
// within (4) and a |Ra dI|/ke. An encoder tells its tick's mean and a current the tick's end, so all that lies between the last speed and
// what (1) makes of it is as good. Otherwise the wheel's speed is its last one and what (1) has changed since, until the encoder agrees
// again; constant errors of ke and V cancel there, and Ra's as long as the current does not change. Where no motor drives there is no (1),
// and a jump is held for a few ticks. (2) and (3) look at one wheel a
// tick and name it when all looks of 0.3 s agree. r0, a, b cover a winding 95 K warm (37 % of Ra), a magnet as warm and a divider (10 %
// each), and a bridge that loses 1.6 V of 7.2 by drop and dead time; derived here. What they cost: an encoder that loses less than about a
// third of its pulses is not seen.
#ifndef TRACTION_FIRMWARE_CORE_CIRCUIT_H
#define TRACTION_FIRMWARE_CORE_CIRCUIT_H

#include "sense.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    float resistance_ohm;      // Ra
    float back_emf_Vs;         // ke at the wheel
    float per_back_emf_1_Vs;   // 1/ke
    float contradict_V;        // r0
    float contradict_current;  // a
    float contradict_speed;    // b
    float open_A;              // I_open
    float open_V;              // V_open
    float dead_V;              // V_dead: no bridge loses more
    float open_speed;          // c
    float jump_rad_s;          // (4)
    uint32_t hold_ticks;       // a jump is held so long where no motor drives
    uint32_t refused_ticks;    // a speed refused for longer is a contradiction
    uint32_t contradict_looks; // looks in a row, one every 4 ticks
    uint32_t open_looks;
} circuit_config_t; // constant while running

typedef struct {
    float speed_rad_s[WHEEL_COUNT]; // used in it
    float current_A[WHEEL_COUNT];   // at its end
    float duty[WHEEL_COUNT];        // that acted in it
    float supply_V;
    bool driven;  // the bridges drove or braked in it
} circuit_past_t; // a tick

typedef struct {
    uint32_t refused;                    // bit i: the speed of wheel i is the circuit's
    uint32_t refused_ticks[WHEEL_COUNT]; // for so long
    float circuit_V[WHEEL_COUNT];        // duty V - Ra I while refused
    float refused_A[WHEEL_COUNT];        // I when it was believed last
    circuit_past_t past[2];              // the last two ticks
    uint32_t newest;                     // its lowest bit: which of them is the last one
    uint32_t turn;
    uint8_t contradict_looks[WHEEL_COUNT], open_looks[WHEEL_COUNT];
} circuit_state_t; // zeroed = reset

typedef struct {
    const float *duty; // [WHEEL_COUNT] that acted since the last frame
    bool driven;       // the bridges drove or braked: (a) holds
    bool look;         // false: (2) and (3) wait, the processor is busy in this tick
} circuit_input_t;

typedef struct {
    uint32_t refused;    // bit i: sense_replace was given the circuit's speed for wheel i
    uint32_t contradict; // bit i: its encoder contradicts its circuit
    uint32_t broken;     // bit i: its winding is open
} circuit_output_t;

// Judges what sense_measure has just measured, and replaces what is impossible in *sense_state and *sense. Any value is accepted; NaN
// counts as 0.
circuit_output_t circuit_step(const circuit_config_t *config, circuit_state_t *state, const circuit_input_t *input,
                              const sense_config_t *sense_config, sense_state_t *sense_state, sense_output_t *sense);

#ifdef __cplusplus
}
#endif

#endif
