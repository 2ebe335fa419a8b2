// control.h - one tick of the rover: sense, estimate, control, safety. The only function that composes the others.
//
// Data flow: frame (raw counts) -> sense -> circuit -> doppler -> ground_speed -> slip, motor -> mode -> duty -> safety -> trace.
// control_step is a pure function of its arguments: same frames, same command, same state, same bits, on x86 and on ARM.
#ifndef TRACTION_FIRMWARE_CORE_CONTROL_H
#define TRACTION_FIRMWARE_CORE_CONTROL_H

#include "circuit.h"
#include "doppler.h"
#include "ground_speed.h"
#include "motor.h"
#include "safety.h"
#include "self_test.h"
#include "sense.h"
#include "signals.h"
#include "slip.h"
#include "slip_pi.h"
#include "soil_sweep.h"
#include "speed_control.h"
#include "steering.h"
#include "wheel_pid.h"

#ifdef __cplusplus
extern "C" {
#endif

// What the rover is, for whoever needs it whole; the modules below hold the copies they use.
typedef struct {
    float wheel_radius_m;
    float half_wheelbase_m;
    float half_track_m;
    float mass_kg;
    uint32_t wheels;   // bit i: the rover has wheel i; of the others nothing is asked, measured or driven
    float wheel_share; // 1 over their number
} rover_geometry_t;

static inline bool rover_has_wheel(const rover_geometry_t *geometry, int wheel)
{
    return (geometry->wheels & (1u << (uint32_t)wheel)) != 0u;
}

typedef struct {
    rover_geometry_t geometry;
    sense_config_t sense;
    circuit_config_t circuit;
    doppler_config_t doppler;
    ground_speed_config_t ground_speed;
    slip_config_t slip;
    motor_config_t motor;
    wheel_pid_config_t wheel_pid;
    slip_pi_config_t slip_pi;
    speed_control_config_t speed_control;
    steering_config_t steering;
    soil_sweep_config_t soil_sweep;
    safety_config_t safety;
    self_test_config_t self_test; // of whoever runs it; control_step does not
    bool feed_forward;            // the wheel loops know the motor; false is a plain PID
} control_config_t;               // constant while running

typedef struct {
    sense_state_t sense;
    circuit_state_t circuit;
    doppler_state_t doppler;
    ground_speed_state_t ground_speed;
    wheel_pid_state_t wheel_pid[WHEEL_COUNT];
    slip_pi_state_t slip_pi[WHEEL_COUNT];
    speed_control_state_t speed_control;
    soil_sweep_state_t soil_sweep;
    safety_state_t safety;
    control_mode_t mode;         // in force in the last tick
    uint8_t slip_active;         // bit i: wheel i was driven by its slip loop in the last tick
    float duty[WHEEL_COUNT];     // written in the last tick
    bool driven;                 // and the bridges were told to drive or to brake
    bool saturated;              // a wheel had no duty left in the last tick
    bool braking;                // a fault stopped the rover, and nothing has driven it since
    uint32_t sequence;           // of the actuator frame written in the last tick
    float doppler_m_s;           // last Doppler value
    float slip_std[WHEEL_COUNT]; // one wheel's is made in a tick that has time
    int32_t slip_turn;           // the wheel whose turn it is
    float steer_std_m_s;         // standard deviation of the speed for which the next was made
    float steer_share;           // of an error of the platform's speed that counts [1]
    float curvature_1_m;         // the steering servo's order of the last tick; a rover that stops keeps it
    doppler_output_t heard;      // by the tick before: no tick pays for a search and a correction
    int32_t beyond;              // Doppler values in a row that told of more speed than the radar's band holds
} control_state_t;

void control_reset(const control_config_t *config, control_state_t *state);

// Any frame and any command are accepted. Ensures |duty| <= 1, and duty 0 with the wheels braked while a stopping
// fault is latched, and after it until a mode drives again: a rover on a slope does not roll away.
trace_t control_step(const control_config_t *config, control_state_t *state, const command_t *command, const sensor_frame_t *frame);

#ifdef __cplusplus
}
#endif

#endif
