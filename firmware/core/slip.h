// slip.h - how much faster a wheel turns than the ground passes, for every sign of both.
//
//   s = (R w - v) / max(|R w|, |v|)  with its sign taken along the motion, limited to -1..1        (1)
//
// For v, w >= 0 this is (1) Lhomme-Desages: 1 - v/(R w) when R w >= v, R w/v - 1 otherwise. Reverse travel: the numerator is
// signed in the body frame, so s(-v, -w) = -s(v, w): positive slip always pushes the rover forward. Where v and w oppose each
// other the difference exceeds the larger of the two and s is limited to +-1: the contact slides fully. s is continuous
// everywhere but at v = w = 0, where it is 0 and not valid (derived here).
//
// Its standard deviation, from that of the ground speed and of the rim's, L the larger of |R w| and |v|, m the other:   (2)
//   var s = (var of the smaller)/L^2 + (var of the larger) (m/L^2)^2, at most 1                    derivative of (1), derived here
// It is of noise: a wrong radius is a scale of every slip, and is not in it.
#ifndef TRACTION_FIRMWARE_CORE_SLIP_H
#define TRACTION_FIRMWARE_CORE_SLIP_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    float wheel_radius_m; // R, under load, > 0
    float valid_m_s;      // below this both speeds are too small for their ratio to mean anything
    float valid_std;      // a slip that is known to no better than this is not valid
    float rim_std_m_s;    // of R w: what the encoder's rounding leaves
} slip_config_t;

typedef struct {
    float slip; // -1..1
    bool valid;
} slip_output_t;

// Any value is accepted; NaN or infinity gives slip 0, not valid.
slip_output_t slip_measure(const slip_config_t *config, float wheel_speed_rad_s, float ground_speed_m_s);

// (2), 0..1; 1 where nothing is known: both speeds 0, NaN, infinity.
float slip_std(const slip_config_t *config, float wheel_speed_rad_s, float ground_speed_m_s, float ground_std_m_s);

#ifdef __cplusplus
}
#endif

#endif
