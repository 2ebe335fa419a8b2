#include "make_dataset.h"

#include "motion.h"
#include "rounding.h"
#include "smoothing_bias.h"
#include "wheel_laws.h"

#include "host_tools/lab/inputs/inputs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace traction::lab {

namespace {

constexpr double most_error = 0.5;            // of a row's noise, that scatter and smoothing together may be: it then weighs an eighth
constexpr double least_slope_noise = 5e-4;    // of the speed: the smoothing's half width is at its limit by then
constexpr double wider_by = 1.6, widest = 20; // times the half width, a step and in all: 1 s, its limit, from 0.05 s
constexpr double of_a_row_left_out = 8;       // its error, in noises (smoothing_bias.h)

static_assert(stands_m_s == rest_speed_m_s);

struct Smoothed {
    Dataset data;
    double error = 0; // of the torque balances' predictions by the smoothed wheels: scatter and bias, root mean square, in noises
};

std::size_t torque_rows(const Dataset &data) {
    std::size_t rows = 0;
    for (const Balance &b : data.balance)
        if (b.kind == BalanceKind::current_torque) rows += b.measured.size();
    return rows;
}

Smoothed smoothed(const Model &model, const log::Log &log, double slope_noise, double widen = 1) {
    Smoothed out{measured_data(model, log, slope_noise, widen)};
    const std::size_t rows = torque_rows(out.data);
    add_smoothing_bias(model, out.data);
    const Eigen::VectorXd squares = rounding_squares(out.data, make_physics(model), 1);
    const std::size_t left_out = rows - torque_rows(out.data);
    double sum = of_a_row_left_out * of_a_row_left_out * static_cast<double>(left_out);
    Eigen::Index row = 0;
    for (const Balance &b : out.data.balance)
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) {
            if (b.kind != BalanceKind::current_torque) continue;
            const double lost = b.smoothing_bias.empty() ? 0 : b.smoothing_bias[r],
                         error = (squares[row] + lost * lost) / (b.noise * b.noise);
            if (std::isfinite(error)) sum += error;
        }
    out.error = rows > 0 ? std::sqrt(sum / static_cast<double>(rows)) : 0;
    return out;
}

bool swings(const Dataset &data) {
    return std::any_of(data.wheel.begin(), data.wheel.end(), [](const WheelInput &w) { return w.swings; });
}

// A wheel's speed is smoothed as widely as the machine asks for, by the model's own numbers: where heavy wheels on stiff ground turn what
// the encoder leaves of 1 % into more than the current's noise, every fit follows that scatter, and softens the ground (errors in the
// regressors attenuate its slope; Fuller 1987, section 1.1); a wider window loses what is quick. The width with the least of both. A
// width by the samples' own covariance (half_width_for) sees no rounding where starts and stops hide it: there all widths are tried, up
// to the first that is worse than the one before, or hides how a wheel swings with its own angle (a ripple would be lost with it).
Dataset best_smoothed(const Model &model, const log::Log &log) {
    Smoothed best = smoothed(model, log, 0.01);
    for (double slope_noise = 0.005; best.error > most_error && slope_noise > least_slope_noise; slope_noise /= 2)
        if (Smoothed wider = smoothed(model, log, slope_noise); wider.error < best.error) best = std::move(wider);
    double last = std::numeric_limits<double>::infinity();
    for (double widen = wider_by; best.error > most_error && widen < widest; widen *= wider_by) {
        Smoothed wider = smoothed(model, log, 0.01, widen);
        if (!(wider.error < last) || swings(wider.data)) break;
        last = wider.error;
        if (wider.error < best.error) best = std::move(wider);
    }
    return best.data;
}

} // namespace

Dataset make_dataset(const Model &model, const log::Log &log, const log::Log *repeat) {
    Dataset data = best_smoothed(model, log);
    if (repeat != nullptr) noise_from_repeat(data, measured_data(model, *repeat));
    return data;
}

} // namespace traction::lab
