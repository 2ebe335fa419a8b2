// radar_model.h - what the firmware's likelihood reads of a radar at another angle, on another ground, drawn window by window.
//
//   X[k] = sum_m sqrt(dP_m) |H| (z_m W(k - f_m/df) + z_m* W(k + f_m/df)),  z_m complex normal               (1)
//   modelled scale = sum_i v_i / sum_i heard_i  over windows i of (1) at the speeds v_i                     (2)
//
// (1): the spectrum of firmware/template for the MDU1130, with its speckle. The expected spectrum in place of drawn windows gives another
// answer: the likelihood's minimum is not linear in the powers, and where the expected echo equals a template it hardly moves with the
// angle.
#pragma once

#include "firmware/core/doppler.h"

#include <vector>

namespace traction {

struct RadarGuess {
    double angle_deg = 20;      // below horizontal
    double ground_exponent = 1; // sigma0 ~ sin^n
};

// (2) of each guess for windows at these speeds, each drawn `repeats` times; the same random numbers for every guess, so differences are
// smooth.
std::vector<double> modelled_scales(const doppler_template_t &beam, const std::vector<RadarGuess> &guesses,
                                    const std::vector<double> &speed_m_s, int repeats);

} // namespace traction
