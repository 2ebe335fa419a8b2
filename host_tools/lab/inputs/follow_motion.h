// follow_motion.h - a wheel's motion from its angles, smoothed widely where it runs evenly and narrowly where it starts and stops.
//
// One width for a whole log either keeps the encoder's scatter, which stiff ground turns into pull, or blurs every start. At each time the
// widest half width is taken whose speed agrees with that of every narrower one within their noise (intersection of confidence intervals;
// Goldenshluger and Nemirovski 1997, Katkovnik 1999):
//   |w(h) - w(g)| <= 3 (s(h) + s(g))   for all g < h,   s(h) = scatter / h * max(1, 1.85 sqrt(period / h))                           (1)
// Wheels of one side take the narrowest of theirs: a width bends a speed by what goes with its square, and what one of two wheels that turn
// alike is bent by alone is a slip between them, hence on stiff ground a pull of 20 times a current's noise.
//
// Of (1), s is of white scatter (smooth.h), but not below scatter / h: a wheel that turns nearly a whole number of counts a sample is read
// a count wrong every so many seconds, and evenly between.
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

// Motion by each half width, narrowest first [s].
struct MotionAtWidths {
    std::vector<double> half_s;
    std::vector<MotionAtWidth> at;
};

// Fills the input's width_s (1) and swings, from its scatter_rad, sample_s and half_s, the widest [s]. `smoothed` gives the motion on a
// grid of step_s [s] by a half width [s]: it is asked for those from `narrowest_s` to half_s, a factor of 1.5 apart; where the two are
// alike, or no scatter is known, for half_s alone (and width_s is empty).
MotionAtWidths motion_at_widths(WheelInput &input, double narrowest_s, double step_s, const std::function<MotionAtWidth(double)> &smoothed);

// At each time the narrowest of theirs becomes width_s of all.
void agree_on_widths(const std::vector<WheelInput *> &alike);

// Fills angle, speed and acceleration by the widest of `motion` that is no wider than width_s, and returns the cubics of the same.
MotionAtWidth take_widths(WheelInput &input, MotionAtWidths &&motion);

// Of one wheel by itself.
MotionAtWidth follow_motion(WheelInput &input, double narrowest_s, double step_s, const std::function<MotionAtWidth(double)> &smoothed);

} // namespace traction::lab
