// smooth.h - zero-phase local polynomials: value and slope of unevenly sampled data at chosen times.
#pragma once

#include <cstddef>
#include <vector>

namespace traction::lab {

struct Smooth {
    std::vector<double> value, slope;
    std::vector<double> distance_s; // from each time to the nearest sample: large in a gap
};

// At each time, a polynomial of degree 1 to 3 fitted with tricube weights to the samples within half_width_s, widened to
// the nearest degree + 3 samples where there are fewer. t_s increasing. Linear in the data, so that measured and predicted quantities
// filtered alike stay comparable.
Smooth smooth_at(const std::vector<double> &t_s, const std::vector<double> &value, double start_s, double step_s, std::size_t count,
                 double half_width_s, int degree);

struct ParabolaAndCubic {
    Smooth parabola, cubic;
};

// smooth_at of degree 2 and of degree 3, in little more than the time of one.
ParabolaAndCubic smooth_twice(const std::vector<double> &t_s, const std::vector<double> &value, double start_s, double step_s,
                              std::size_t count, double half_width_s);

// Slopes of such parabolas, each of its own half width.
std::vector<double> slopes_at(const std::vector<double> &t_s, const std::vector<double> &value, double start_s, double step_s,
                              const std::vector<double> &half_width_s);

// Linear interpolation, constant outside.
double interpolate(const std::vector<double> &t_s, const std::vector<double> &value, double at_s);

// Last value at or before the time.
double hold(const std::vector<double> &t_s, const std::vector<double> &value, double at_s);

// Share of a sinusoid of omega [rad/s] that the slope of such a parabola keeps, for dense samples.
double slope_response(double half_width_s, double omega_rad_s);

double median(std::vector<double> values); // 0 when empty

inline constexpr double widest_half_s = 1; // where it runs evenly (follow_motion.h)

// White scatter sigma of samples, a period apart, leaves scatter_in_slope sigma sqrt(period) / half width^1.5 in a parabola's slope.
inline constexpr double scatter_in_slope = 1.85;

// Half width of local parabolas over the angles of a turning wheel whose samples scatter (a slow counter, a clock that jitters): at
// least `half`, and so wide, up to widest_half_s, that the slope's noise is `slope_noise` of the speed. `still_rad_s`: speed below which a
// wheel stands.
double half_width_for(const std::vector<double> &t_s, const std::vector<double> &angle_rad, double period_s, double half_s,
                      double still_rad_s, double slope_noise);

// Standard deviation of white noise in a series from its second differences, robust: 1.4826 * MAD / sqrt(6).
double noise_from_differences(const std::vector<double> &value);

} // namespace traction::lab
