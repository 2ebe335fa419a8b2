#include "follow_motion.h"

#include "smooth.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <utility>

namespace traction::lab {

namespace {

constexpr double agree = 3;         // (1): assumed
constexpr double swing_width = 2.5; // of the narrowest: what a turning wheel's swing is sought beside
constexpr int highest_order = 16;
constexpr double surely_a_line = 25;   // of the power of a line that is none, whose mean is 1: one in 1e11
constexpr double next_width = 1.5;     // a width over the next narrower one
constexpr double one_width_does = 1.2; // widest over narrowest, below which one width does

void take_row(MotionAtWidth &to, const MotionAtWidth &from, std::size_t k) {
    to.parabolas.angle_rad[k] = from.parabolas.angle_rad[k];
    to.parabolas.speed_rad_s[k] = from.parabolas.speed_rad_s[k], to.parabolas.accel_rad_s2[k] = from.parabolas.accel_rad_s2[k];
    to.cubics.speed_rad_s[k] = from.cubics.speed_rad_s[k], to.cubics.accel_rad_s2[k] = from.cubics.accel_rad_s2[k];
}

} // namespace

double speed_scatter_rad_s(const WheelInput &input, double half_s) {
    return input.scatter_rad / half_s * std::max(1.0, scatter_in_slope * std::sqrt(input.sample_s / half_s));
}

bool swings_as_it_turns(const std::vector<double> &narrow, const std::vector<double> &wide, const std::vector<double> &angle_rad,
                        double independent) {
    std::vector<double> swing, size;
    for (std::size_t k = 0; k < narrow.size(); ++k) {
        swing.push_back(narrow[k] - wide[k]);
        if (swing[k] != 0) size.push_back(std::fabs(swing[k]));
    }
    const double clip = 3 * 1.4826 * median(std::move(size)); // starts, which the wide ones blur, count as three deviations
    double power = 0;
    for (double &d : swing) d = std::clamp(d, -clip, clip), power += d * d;
    if (!(power > 0)) return false;
    std::vector<std::complex<double>> turned(swing.size(), 1), once;
    for (const double angle : angle_rad) once.push_back(std::polar(1.0, -angle));
    for (int order = 1; order <= highest_order; ++order) {
        std::complex<double> line = 0;
        for (std::size_t k = 0; k < swing.size(); ++k) {
            turned[k] = {turned[k].real() * once[k].real() - turned[k].imag() * once[k].imag(),
                         turned[k].real() * once[k].imag() + turned[k].imag() * once[k].real()};
            line += swing[k] * turned[k];
        }
        if (std::norm(line) > surely_a_line * power * static_cast<double>(swing.size()) / independent) return true;
    }
    return false;
}

MotionAtWidths motion_at_widths(WheelInput &input, double narrowest_s, double step_s,
                                const std::function<MotionAtWidth(double)> &smoothed) {
    MotionAtWidths out;
    if (input.half_s > one_width_does * narrowest_s && input.scatter_rad > 0)
        for (double h = narrowest_s; h * std::sqrt(next_width) < input.half_s; h *= next_width) out.half_s.push_back(h);
    out.half_s.push_back(input.half_s);
    input.width_s.clear();
    out.at.push_back(smoothed(out.half_s.front()));
    if (out.half_s.size() == 1) return out;
    const WheelInput wide = smoothed(std::min(input.half_s, swing_width * narrowest_s)).parabolas;
    for (std::size_t i = 1; i < out.half_s.size(); ++i) out.at.push_back(smoothed(out.half_s[i]));
    const std::vector<double> &narrow = out.at.front().parabolas.speed_rad_s;
    input.swings = swings_as_it_turns(narrow, wide.speed_rad_s, wide.angle_rad, static_cast<double>(narrow.size()) * step_s / narrowest_s);
    std::vector<double> low(narrow.size(), -std::numeric_limits<double>::infinity()),
        high(narrow.size(), std::numeric_limits<double>::infinity());
    input.width_s.assign(narrow.size(), out.half_s.front());
    for (std::size_t i = 0; i < out.half_s.size(); ++i) {
        const std::vector<double> &speed = out.at[i].parabolas.speed_rad_s;
        const double within = agree * speed_scatter_rad_s(input, out.half_s[i]);
        for (std::size_t k = 0; k < low.size(); ++k) {
            low[k] = std::max(low[k], speed[k] - within), high[k] = std::min(high[k], speed[k] + within);
            if (low[k] <= high[k]) input.width_s[k] = out.half_s[i]; // else for good: neither comes back
        }
    }
    return out;
}

void agree_on_widths(const std::vector<WheelInput *> &alike) {
    std::vector<double> least;
    for (const WheelInput *input : alike) {
        if (input->width_s.empty()) continue;
        if (least.empty()) least = input->width_s;
        for (std::size_t k = 0; k < least.size(); ++k) least[k] = std::min(least[k], input->width_s[k]);
    }
    for (WheelInput *input : alike)
        if (!input->width_s.empty()) input->width_s = least;
}

MotionAtWidth take_widths(WheelInput &input, MotionAtWidths &&motion) {
    MotionAtWidth out = motion.at.front();
    for (std::size_t k = 0; k < input.width_s.size(); ++k) {
        std::size_t i = 0;
        while (i + 1 < motion.half_s.size() && motion.half_s[i + 1] <= input.width_s[k]) ++i;
        take_row(out, motion.at[i], k), input.width_s[k] = motion.half_s[i];
    }
    input.angle_rad = std::move(out.parabolas.angle_rad);
    input.speed_rad_s = std::move(out.parabolas.speed_rad_s), input.accel_rad_s2 = std::move(out.parabolas.accel_rad_s2);
    return out;
}

MotionAtWidth follow_motion(WheelInput &input, double narrowest_s, double step_s, const std::function<MotionAtWidth(double)> &smoothed) {
    MotionAtWidths motion = motion_at_widths(input, narrowest_s, step_s, smoothed);
    return take_widths(input, std::move(motion));
}

} // namespace traction::lab
