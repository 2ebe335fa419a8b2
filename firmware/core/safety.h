// safety.h - the last word of every tick: which faults are latched, whether the bridges may be on, how much current a wheel gets.
//
//   x_i[k] = max(0, x_i[k-1] + (I_i^2 - I_cont^2) T);  over-current when x_i > x_max        (1)  i^2 t
//   h_i[k] = h_i[k-4] + 4T (I_i^2 Ra - h_i[k-4]/R_th)/C_th                                 (2)  winding above ambient; one wheel a tick
//   n sum x^2 - (sum x)^2 < n^2 0.8 count^2 in n = 32 samples: less than a front end's noise, which echoes have more of  (3)  dead
//   A sensor is lost when it was silent or absurd for more than its patience; a count of bad ticks goes up by 1 in a bad tick
//   and is cleared by a good one.
//   The emergency stop counts as pressed when it was unread for more than that; a bridge that has answered once must go on answering.
//
// Table of faults, causes and reactions: docs/firmware.md. A latch clears in a tick that commands MODE_STOP while its cause is gone.
#ifndef TRACTION_FIRMWARE_CORE_SAFETY_H
#define TRACTION_FIRMWARE_CORE_SAFETY_H

#include "signals.h"

#ifdef __cplusplus
extern "C" {
#endif

// Faults that release the bridges of all wheels; the others limit one wheel's current.
enum {
    SAFETY_LIMITING = FAULT_OVER_CURRENT | FAULT_STALL | FAULT_MOTOR_OPEN,
};

typedef struct {
    float tick_s;
    uint32_t required;               // FRAME_* bits that the rover must have
    uint32_t patience_ticks;         // silent or absurd ticks in a row that are forgiven
    uint32_t command_patience_ticks; // age of a command that is forgiven
    uint32_t missed_ticks_max;       // missed ticks that are forgiven
    uint32_t missed_forget_ticks;    // one missed tick is forgotten per this many good ones
    float current_continuous_A;      // I_cont
    float current_continuous_A2;     // I_cont^2
    float i2t_max_A2_ticks;          // x_max/T
    float stall_current_A;
    float stall_speed_rad_s;
    float stall_s;
    float heating_K_A2; // 4T Ra/C_th of (2)
    float keeping;      // 1 - 4T/(R_th C_th) of (2)
    float temperature_rise_max_K;
    float battery_min_V;
    float battery_s;            // how long the battery must be low
    float brown_out_V;          // below, the supply has broken down
    uint32_t brown_out_ticks;   // forgiven
    uint32_t radar_dead_count2; // a block of 32 samples is dead below this much n sum x^2 - (sum x)^2: 0.8 count^2 of power
    uint32_t radar_dead_blocks; // so many in a row while every wheel turns: the front end is dead
    float sigmas;               // of the ground speed that are its own uncertainty, no disagreement
    float disagree_m_s;         // ground speed beyond what the fastest wheel explains, absolute part
    float disagree_ratio_m;     // and relative part, times the wheel radius
    float turning_rad_s;        // a wheel faster than that is heard by a radar that works
    float disagree_s;
} safety_config_t;

enum { SAFETY_SENSORS = 12 }; // one per FRAME_* bit up to the radar

typedef struct {
    uint32_t faults;                    // latched
    uint32_t limited;                   // bit i: wheel i is limited to the continuous current
    uint32_t wheels;                    // bit i: a latched fault is wheel i's
    uint32_t line_ticks;                // ticks in a row in which nobody read the emergency stop
    bool counting;                      // a count of bad_ticks or absurd_ticks is not 0
    bool bridges_counting;              // nor one of bridge_ticks
    uint32_t bridges;                   // bit i: the bridge of wheel i has answered once
    uint32_t bridge_ticks[WHEEL_COUNT]; // ticks in a row in which it did not answer, or not well
    uint32_t bad_ticks[SAFETY_SENSORS];
    uint32_t absurd_ticks[SAFETY_SENSORS];
    uint32_t last_tick;
    uint32_t missed;
    uint32_t good_ticks;
    float i2t_A2_ticks[WHEEL_COUNT]; // x/T of (1)
    uint32_t turn;                   // wheel whose temperature is due
    float rise_K[WHEEL_COUNT];
    float stall_s[WHEEL_COUNT];
    float low_battery_s;
    uint32_t brown_out_ticks;
    float disagree_s;
    uint16_t radar_first; // of the block of samples under way: (3)
    uint32_t radar_samples;
    int32_t radar_sum;
    uint32_t radar_square;
    uint32_t radar_dead_blocks;
    bool started;
} safety_state_t; // zeroed = reset

typedef struct {
    const sensor_frame_t *frame;
    uint32_t command_age_ticks;
    bool command_stop; // the user commands MODE_STOP
    uint32_t usable;   // FRAME_* bits of sense_output_t
    uint32_t absurd;
    uint32_t contradict; // bits of circuit_output_t
    uint32_t broken;
    float speed_rad_s[WHEEL_COUNT];
    float current_A[WHEEL_COUNT];
    float battery_V;
    float ground_speed_m_s;
    float ground_speed_std_m_s;
    uint32_t estimator; // FAULT_* bits that the estimator raises
    float high_rad_s;   // largest speed of a wheel, at least 0
    float low_rad_s;    // smallest, at most 0
    float least_rad_s;  // smallest size of one
} safety_input_t;

typedef struct {
    uint32_t faults;
    bool motors_off;
    uint32_t limited; // bit i: wheel i only gets the continuous current
    uint32_t wheels;  // bit i: a latched fault is wheel i's
} safety_output_t;

// Windings as warm as `rise_K` above ambient, or, where it is null, as warm as a rover may be of which nothing is known: 0.8 of what they
// bear, assumed (2.25 A^2 Ra R_th of the reference's continuous current for minutes). NaN counts as that, too.
void safety_warm(const safety_config_t *config, safety_state_t *state, const float rise_K[WHEEL_COUNT]);

// Any value is accepted; a NaN counts as a cause where it is compared.
safety_output_t safety_step(const safety_config_t *config, safety_state_t *state, const safety_input_t *input);

#ifdef __cplusplus
}
#endif

#endif
