// signals.h - every quantity that crosses a seam of the firmware: what the HAL reads, what it writes, what a user commands,
// and what one tick computed.
//
// One tick is 10 ms. The HAL carries raw counts; scaling is firmware. Wheels: 0 rear left, 1 rear right, 2 front left,
// 3 front right. x forward, y left, z up; wheel speed is positive when it drives the rover forward.
#ifndef TRACTION_FIRMWARE_CORE_SIGNALS_H
#define TRACTION_FIRMWARE_CORE_SIGNALS_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { WHEEL_COUNT = 4, RADAR_SAMPLES_PER_TICK_MAX = 64, TICK_US = 10000 };
enum { WHEEL_REAR_LEFT = 0, WHEEL_REAR_RIGHT = 1, WHEEL_FRONT_LEFT = 2, WHEEL_FRONT_RIGHT = 3 };

// Which parts of a frame are fresh in this tick (bits of sensor_frame_t.present). A rover without a device never sets its bit.
enum {
    FRAME_ENCODER_0 = 1u << 0, // << wheel index, bits 0..3
    FRAME_CURRENT_0 = 1u << 4, // << wheel index, bits 4..7
    FRAME_BATTERY = 1u << 8,
    FRAME_ACCEL = 1u << 9,           // accel_x_count
    FRAME_GYRO = 1u << 10,           // gyro_z_count
    FRAME_RADAR = 1u << 11,          // the radar's samples and radar_sequence
    FRAME_EMERGENCY_STOP = 1u << 12, // the line was read; unread for longer than the patience of safety.h, it counts as pressed
    FRAME_ACCEL_YZ = 1u << 13,       // accel_y_count, accel_z_count
    FRAME_GYRO_XY = 1u << 14,        // gyro_x_count, gyro_y_count
    FRAME_TIME = 1u << 15,           // time_us
    FRAME_BRIDGE_0 = 1u << 16,       // << wheel index, bits 16..19: the wheel's bridge answered in this tick
    FRAME_ALL = 0xfffffu,
};

// What a wheel's bridge says of itself (bits of sensor_frame_t.bridge_status). 0: it works as it was told.
enum {
    BRIDGE_UNDER_VOLTAGE = 1u << 0,
    BRIDGE_OVER_TEMPERATURE = 1u << 1,
    BRIDGE_OVER_CURRENT = 1u << 2,
    BRIDGE_OPEN_LOAD = 1u << 3,
    BRIDGE_RELEASED = 1u << 4, // it heard nothing for BRIDGE_RELEASE_MS and let the motor go
};

// What the HAL reads in one tick: raw counts, exactly as the devices give them. A field whose bit in `present` is clear keeps
// no meaning and must not be used.
typedef struct {
    uint32_t tick;                                    // number of this tick, from 0; a jump of more than 1 means missed ticks
    uint32_t elapsed_ticks;                           // ticks since the frame before, 1 if none was missed; 0: see the jump of `tick`
    uint32_t time_us;                                 // monotonic clock when the encoders were latched; wraps at 2^32 (71 min)
    uint32_t present;                                 // FRAME_* bits
    int32_t encoder_count[WHEEL_COUNT];               // cumulative encoder pulses, wraps at 2^32
    uint16_t current_count[WHEEL_COUNT];              // bridge current, offset binary, 12 bit: 0..4095
    uint16_t battery_count;                           // battery divider, 12 bit: 0..4095
    int16_t accel_x_count;                            // specific force forward, two's complement
    int16_t accel_y_count;                            // to the left
    int16_t accel_z_count;                            // up
    int16_t gyro_x_count;                             // rate about x (roll), two's complement
    int16_t gyro_y_count;                             // about y (pitch)
    int16_t gyro_z_count;                             // about z (yaw)
    uint32_t radar_sequence;                          // number of radar_count[0] among all conversions, wraps; a gap: samples were lost
    uint16_t radar_count[RADAR_SAMPLES_PER_TICK_MAX]; // radar ADC, offset binary, 10 bit: 0..1023, oldest first; a FIFO
    uint8_t radar_samples;                            // how many of radar_count are filled, 0..64 (512 Hz gives 5 or 6)
    uint8_t bridge_status[WHEEL_COUNT];               // BRIDGE_* bits
    bool emergency_stop;                              // true while the emergency-stop line is active
} sensor_frame_t;

// What the bridges of all wheels do.
typedef enum {
    DRIVE_OFF = 0, // supply of the bridges off: before the self-test
    DRIVE_COAST,   // every switch open: no current, the wheels turn freely
    DRIVE_BRAKE,   // both low switches closed: the winding is shorted and brakes with ke w/Ra
    DRIVE_ON,      // duty_q15 by PWM
} drive_state_t;

// A bridge that hears no new sequence number for so long releases itself (coasts), whatever the computer does meanwhile. [ms]
// Written every 10 ms: four writes may be lost before it does.
enum { BRIDGE_RELEASE_MS = 50 };

// What the HAL writes in one tick.
typedef struct {
    uint32_t sequence;             // goes up by 1 with every frame that control_step makes; wraps
    drive_state_t drive;           // of all bridges
    int16_t duty_q15[WHEEL_COUNT]; // PWM rate with DRIVE_ON, Q15: -32767..32767 is -1..1; 0 otherwise
    bool status_led;
    float curvature_1_m; // of the path of the rover's middle, to the left positive: the order of the steering servo; 0 without one
} actuator_frame_t;

typedef enum {
    MODE_STOP = 0,       // motors off
    MODE_OPEN_LOOP,      // duty[] as given
    MODE_WHEEL_SPEED,    // wheel_speed_rad_s[] by PID
    MODE_PLATFORM_SPEED, // platform_speed_m_s and yaw_rate_rad_s by (22)
    MODE_SLIP,           // slip_ref on the wheels of slip_wheels by (23), the others under (22)
    MODE_SOIL_SWEEP,     // front wheels by (15), rear wheels by (16), at platform_speed_m_s
    MODE_COUNT
} control_mode_t;

// What a user or a drive plan asks for. Any value is accepted: out-of-range references are clamped, NaN counts as 0.
typedef struct {
    control_mode_t mode;
    float platform_speed_m_s;
    float yaw_rate_rad_s;
    float wheel_speed_rad_s[WHEEL_COUNT];
    float duty[WHEEL_COUNT]; // [1], -1..1
    float slip_ref;          // [1], -1..1
    uint8_t slip_wheels;     // bit i: wheel i is slip-servoed in MODE_SLIP
    uint32_t age_ticks;      // ticks since the command was received
} command_t;

typedef enum {
    FAULT_NONE = 0,
    FAULT_EMERGENCY_STOP = 1u << 0,
    FAULT_COMMAND_TIMEOUT = 1u << 1,
    FAULT_ENCODER_LOST = 1u << 2,
    FAULT_CURRENT_LOST = 1u << 3,
    FAULT_ACCEL_LOST = 1u << 4,
    FAULT_RADAR_LOST = 1u << 5,
    FAULT_BATTERY_LOST = 1u << 6,
    FAULT_LOW_BATTERY = 1u << 7,
    FAULT_OVER_CURRENT = 1u << 8,
    FAULT_STALL = 1u << 9,
    FAULT_MISSED_TICKS = 1u << 10,
    FAULT_SPEED_DISAGREE = 1u << 11,
    FAULT_OVER_TEMPERATURE = 1u << 12,
    FAULT_GYRO_LOST = 1u << 13,
    FAULT_ABSURD_SENSOR = 1u << 14,
    FAULT_BRIDGE = 1u << 15,          // a bridge fell silent, or says that it does not work
    FAULT_MOTOR_OPEN = 1u << 16,      // duty, but no current: a wire or a brush
    FAULT_ENCODER_CIRCUIT = 1u << 17, // an encoder contradicts its motor's circuit: frozen or slipping
    FAULT_BROWN_OUT = 1u << 18,       // the supply broke down
    FAULT_SPEED_BEYOND = 1u << 19,    // faster than the radar's band holds: the estimate is not to be used
} fault_t;

enum { FAULT_COUNT = 20 }; // bits of fault_t

typedef struct {
    float speed_rad_s;     // encoder speed
    float accel_rad_s2;    // causal derivative of the encoder speed
    float set_speed_rad_s; // reference of the speed loop; 0 when the loop is off
    float current_A;       // scaled measurement
    float torque_Nm;       // KG*I
    float traction_N;      // (19)
    float slip;            // (1), extended
    float slip_std;        // its standard deviation; made anew within 80 ms
    float duty;            // after safety, what was written
    bool slip_valid;       // fast enough, and known well enough, for slip to mean something
    bool saturated;        // the controller wanted more duty than it got: full duty, or what a limiter left
    bool encoder_refused;  // the speed is the motor circuit's: the encoder's was impossible
} wheel_trace_t;

// Every signal of one tick. This is what the log records.
typedef struct {
    uint32_t tick;
    control_mode_t mode;   // mode in force after safety
    uint32_t faults;       // fault_t bits, latched
    uint32_t fault_wheels; // bit i: a latched fault is wheel i's
    uint32_t present;      // FRAME_* bits of the frame
    wheel_trace_t wheel[WHEEL_COUNT];
    float battery_voltage_V;
    float accel_x_m_s2;    // scaled measurement
    float gyro_z_rad_s;    // scaled measurement
    float radar_speed_m_s; // last Doppler value
    bool radar_fresh;      // a new Doppler value with an echo behind it was made in this tick
    float speed_m_s;       // fused ground speed estimate
    float speed_std_m_s;   // its standard deviation as the filter believes it
    float accel_bias_m_s2; // estimated accelerometer bias (0 in the paper's filter)
    bool standstill;
    actuator_frame_t actuator; // what is written in this tick
} trace_t;

#ifdef __cplusplus
}
#endif

#endif
