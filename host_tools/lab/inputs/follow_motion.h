// follow_motion.h - a wheel's motion from its angles, smoothed widely where it runs evenly and narrowly where it starts and stops.
//
// One width for a whole log either keeps the encoder's scatter, which stiff ground turns into pull, or blurs every start. At each time the
// widest half width is taken whose speed agrees with that of every narrower one within their noise (intersection of confidence intervals;
// Goldenshluger and Nemirovski 1997, Katkovnik 1999):
//   |w(h) - w(g)| <= 3 (s(h) + s(g))   for all g < h,   s(h) = scatter / h * max(1, 1.85 sqrt(period / h))                           (1)
// of white scatter (smooth.h), but not below scatter / h: a wheel that turns nearly a whole number of counts a sample is read a count wrong
// every so many seconds, and evenly between.
#pragma once

#include "dataset.h"

#include <functional>

namespace traction::lab {

struct MotionAtWidth {
    WheelInput parabolas, cubics; // angle, speed and acceleration on the grid; of the cubics no angle
};

// s(h) of (1) [rad/s].
double speed_scatter_rad_s(const WheelInput &input, double half_s);

// Whether the speeds of two widths differ by what goes with the wheel's own angle, 1 to 16 times a turn (a ripple of the torque, teeth):
// their difference has a line there of 25 times the power that its scatter leaves, of so many `independent` values. All [rad/s] and [rad],
// of one length.
bool swings_as_it_turns(const std::vector<double> &narrow, const std::vector<double> &wide, const std::vector<double> &angle_rad,
                        double independent);

// Fills the input's angle, speed, acceleration, width_s and swings, from its scatter_rad, sample_s and half_s, the widest [s], and returns
// the cubics of the same widths. `smoothed` gives the motion on a grid of step_s [s] by a half width [s]: it is asked for those from
// `narrowest_s` to half_s, a factor of 1.5 apart; where the two are alike, or no scatter is known, for half_s alone (and width_s is empty).
MotionAtWidth follow_motion(WheelInput &input, double narrowest_s, double step_s, const std::function<MotionAtWidth(double)> &smoothed);

} // namespace traction::lab
