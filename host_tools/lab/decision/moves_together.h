// moves_together.h - what is left of a log moves the whole body: a push, a slope, a turn that no law of the model has.
//
// Of the means over blocks of the residuals, in units of a row's noise:
//
//   rho = mean_(i != j) corr(e_i, e_j) > 0.75,  rms(mean_i e_i) > 1.2      currents by torque of all wheels, 0.5 s            (1)
//   rho > 0.6 where that mean is above 3, between them in a straight line
//   rms(e) > 0.8                                                           accelerometer, 5 s                                 (2)
//   rms(e) > 5                                                             yaw rate, 5 s                                      (3)
//
// A wheel's own ground, gear and sensors leave wheels apart: of 126 clean logs of two hands rho was 0.68 at most and the mean 0.9,
// none with both; (2) was 0.24 at most, (3) 2.7. What acts along the body alone leaves (1), gravity along it (1) and (2), a moment (3).
#pragma once

#include "diagnose.h"

#include <optional>
#include <string>

namespace traction::lab {

struct Together {
    enum class What { push, slope, accelerometer, turn } what = What::push;
    double error = 0;       // of (1), (2) or (3), in noises
    double correlation = 0; // of (1)
    double size = 0;        // rms of what is missing: a push [N], a slope or the accelerometer [m/s^2], a turn [rad/s]
    // A sinusoid over time [Hz] or over the path [1/m] that is more than half of the push; 0: none. Its amplitude, and its phase where time
    // or path is 0 [rad].
    double per_s = 0, per_m = 0, amplitude_N = 0, phase_rad = 0;
};

// Of a linearised problem at its optimum; nothing where none of the three is reached.
std::optional<Together> moves_together(Problem &fitted);

UnknownShape shape_of(const Together &what);
std::string together_words(const Together &what);

} // namespace traction::lab
