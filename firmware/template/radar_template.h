// radar_template.h - the spectra that a radar's echo has, over a grid of speeds, computed from the radar's own numbers.
//
// Runs where there is time and floating point: on the build machine for the radars of table II (doppler_template_gen), on the host for any
// other radar of a rover's description or of a recording. The rover gets the result as data (firmware/app/template_text.h). Nothing here is
// fitted to data.
//
//   ground: a flat rough ground seen by a Gaussian beam
//   patch at depression th, azimuth ph:  dP = G^2(th, ph) sin^n(th) sin(th) cos(th) dth dph            (1)
//   its Doppler shift:                   f  = 2 v (f0/c) cos(th) cos(ph)                                (2)
//   S_v[k] = (1 - e) sum dP |H(f)|^2 (|W(k - f/df)|^2 + |W(k + f/df)|^2) / sum + e / bins              (3)
//   X[k] = sum_m sqrt(dP_m) |H| (z_m W(k - f_m/df) + z_m* W(k + f_m/df)) + noise,  z_m complex normal     (4)
//   grid speed = v / mean(v_found / v) over draws of (4)                                                 (5)
//   w_j: square of the Hann window over its age in ticks, Q15, sum 32768                                 (6)
//   point: one reflector that moves along a line theta_d away from the axis, f = 2 v (f0/c) cos(theta_d)  (7)
//
// (1): range r = h/sin(th), ground area dA = h^2 cos(th)/sin^3(th) dth dph, power ~ G^2 sigma0 dA / r^4, sigma0 ~ sin^n(th):
// the height h drops out (derived here). (2): (11) Lhomme-Desages for one direction. (3): band-pass H, Hann window W, a real
// signal's mirror image, and a share e of white noise. (4), (5): where the firmware's search finds its minimum for echoes of this very
// model, speckle included; it lies 1 to 2 % low where few bins carry the echo, because the power that scales J is that of the same
// few bins. A closed form of second order does not converge there (tried), so windows are drawn. (6): a sample's weight is
// shared between the two ticks around its age, so that the mean age is the window's own; the newest sample is half a sample old.
// (7): the same law for one direction: a target that is small against its distance has one angle, so its echo is a line, and a module
// beside a road reads v cos(theta_d), the cosine error of police radars. The line is smeared by 0.2 % (assumed).
#ifndef TRACTION_FIRMWARE_TEMPLATE_RADAR_TEMPLATE_H
#define TRACTION_FIRMWARE_TEMPLATE_RADAR_TEMPLATE_H

#include "firmware/core/doppler.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum { RADAR_TARGET_GROUND = 0, RADAR_TARGET_POINT } radar_target_t;

typedef struct {
    double carrier_Hz;                   // f0, 1e9..200e9
    double vertical_deg, horizontal_deg; // one-way 3 dB beamwidths, 1..120; a point target needs none
    double depression_deg;               // theta_d: axis below horizontal, 0..80; of a point: between its path and the line of sight
    double rate_Hz;                      // of the converter, 202..20000 (on a rover 6400: 64 samples a tick)
    double band_low_Hz, band_high_Hz;    // second-order band-pass, 0 <= low < high; 0 is none below
    double speed_high_m_s;               // the grid's end, held below 0.46 of the rate
    double ground_exponent;              // n of (1), 0..2
    radar_target_t target;
} radar_geometry_t;

// The reference: the MDU1130 of table II as section 4 mounts and samples it.
radar_geometry_t radar_geometry_reference(void);

// A radar of this carrier and beam, all else as the reference has it: the band moves in proportion to the carrier (assumed; its upper edge
// is held below 0.469 of the rate).
radar_geometry_t radar_geometry_like_reference(double carrier_Hz, double vertical_deg, double horizontal_deg, double rate_Hz);

typedef struct {
    const char *field; // "carrier_Hz", ...; 0: nothing to refuse
    double value, low, high;
    const char *mend; // one line
} radar_geometry_refusal_t;
radar_geometry_refusal_t radar_geometry_check(const radar_geometry_t *radar);

// Requires that the check refuses nothing. A second or so. Not reentrant.
void radar_template_make(const radar_geometry_t *radar, doppler_template_t *out);

// Mean and mode of the echo's shift over that of the axis, and its standard deviation over its mean, for people.
void radar_template_describe(const radar_geometry_t *radar, double *mean, double *mode, double *relative_width);

#ifdef __cplusplus
}
#endif

#endif
