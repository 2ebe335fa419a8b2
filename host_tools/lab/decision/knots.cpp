#include "knots.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace traction::lab {

namespace {

double quantile(std::vector<double> values, double q) {
    if (values.empty()) return 0;
    const auto i = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + i, values.end());
    return values[static_cast<std::size_t>(i)];
}

const std::vector<double> *axis_series(Axis axis, const Dataset &data, const Motion &motion,
                                       const std::vector<std::vector<double>> &current, std::size_t wheel) {
    switch (axis) {
    case Axis::wheel_speed:
    case Axis::abs_wheel_speed:
        return &data.wheel[wheel].speed_rad_s;
    case Axis::voltage:
        return &data.wheel[wheel].voltage_V;
    case Axis::slip:
        return &motion.wheel[wheel].slip;
    case Axis::load:
        return &motion.wheel[wheel].load_N;
    case Axis::accel:
        return &motion.accel_m_s2;
    case Axis::path:
        return &motion.path_m;
    case Axis::speed:
    case Axis::abs_speed:
        return &motion.v_m_s;
    case Axis::direction:
        return &motion.wheel[wheel].ground_speed_m_s;
    case Axis::current:
        return &current[wheel];
    case Axis::yaw_rate:
        return &motion.yaw_rate_rad_s;
    case Axis::reversal:
        return &data.wheel[wheel].travel_rad;
    case Axis::place:
        return &motion.path_m;
    case Axis::turn:
        return &data.wheel[wheel].angle_rad;
    case Axis::time:
    case Axis::angle:
    case Axis::other_current:
    case Axis::axle_current:
    case Axis::side_current:
    case Axis::count:
        break;
    }
    return nullptr;
}

bool of_others(Axis axis) { return axis == Axis::other_current || axis == Axis::axle_current || axis == Axis::side_current; }

// Current of the motors that share a lead with this wheel's, as the axis has it.
std::vector<double> current_of_others(Axis axis, const Physics &physics, const std::vector<std::vector<double>> &current,
                                      std::size_t wheel) {
    std::vector<double> sum(current[wheel].size(), 0);
    for (std::size_t j = 0; j < current.size(); ++j) {
        if (j == wheel || current[j].size() != sum.size()) continue;
        if (axis == Axis::axle_current && !same_axle(physics.wheel[wheel], physics.wheel[j])) continue;
        if (axis == Axis::side_current && !same_side(physics.wheel[wheel], physics.wheel[j])) continue;
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += current[j][k];
    }
    return sum;
}

// Of the wheels that one motor turns, as its own terms have it (Forward::signals_of): loads add up, the rest are means.
std::vector<double> of_turned(Axis axis, const Motion &motion, const Physics &physics, std::size_t motor) {
    std::vector<double> sum;
    double wheels = 0;
    each_wheel_of(physics, motor, [&](std::size_t i) {
        const Motion::Wheel &m = motion.wheel[i];
        const std::vector<double> &one = axis == Axis::slip ? m.slip : axis == Axis::load ? m.load_N : m.ground_speed_m_s;
        sum.resize(one.size(), 0);
        for (std::size_t k = 0; k < one.size(); ++k) sum[k] += one[k];
        ++wheels;
    });
    for (double &x : sum) x /= axis == Axis::load ? 1 : wheels;
    return sum;
}

// Squares of X about its mean on each wheel, and of those means about theirs.
struct Spread {
    double within = 0, between = 0, count = 0, mean = 0;
    std::size_t seen = 0;
    void add(const std::vector<double> &values) { // a further wheel's, at the end
        const double n = static_cast<double>(values.size() - seen);
        if (!(n > 0)) return;
        const double own = std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(seen), values.end(), 0.0) / n;
        for (; seen < values.size(); ++seen) within += (values[seen] - own) * (values[seen] - own);
        between += (own - mean) * (own - mean) * count * n / (count + n);
        mean += (own - mean) * n / (count + n);
        count += n;
    }
};

} // namespace

AxisValues values_on(Axis axis, const Dataset &data, const Motion &motion, const Physics &physics,
                     const std::vector<std::vector<double>> &current_A, bool of_motors) {
    AxisValues out;
    Spread spread;
    const bool absolute = axis == Axis::abs_speed || axis == Axis::abs_wheel_speed;
    for (std::size_t i = 0; i < data.wheel.size(); ++i) {
        if (of_motors && !is_motor(physics, i)) continue;
        const bool turned = of_motors && !physics.motor.empty() && (axis == Axis::slip || axis == Axis::load || axis == Axis::direction);
        const std::vector<double> made = of_others(axis) ? current_of_others(axis, physics, current_A, i)
                                         : turned        ? of_turned(axis, motion, physics, i)
                                                         : std::vector<double>();
        const std::vector<double> *series = of_others(axis) || turned ? &made : axis_series(axis, data, motion, current_A, i);
        if (axis == Axis::time)
            for (std::size_t k = 0; k < data.count; k += data.independent_rows ? 1 : 20) out.values.push_back(data.time(k));
        else if (series != nullptr)
            for (std::size_t k = 0; k < series->size(); k += data.independent_rows ? 1 : 10)
                out.values.push_back(absolute ? std::fabs((*series)[k]) : (*series)[k]);
        spread.add(out.values);
    }
    out.varies_between_wheels = spread.within < spread.between;
    return out;
}

std::vector<double> knots_on(Axis axis, const std::vector<double> &values, bool of_torque) {
    const double low = axis == Axis::abs_wheel_speed ? 0 : quantile(values, 0.02),
                 high = quantile(values, axis == Axis::abs_wheel_speed ? 1 : 0.98);
    std::vector<double> knots;
    if (axis == Axis::reversal) {
        for (const double x : {-1.0, -0.4, -0.1, -0.005, 0.005, 0.1, 0.4, 1.0}) // [rad] assumed
            if (x > low && x < high) knots.push_back(x);
        return knots;
    }
    if (axis == Axis::direction) return {-0.9, 0, 0.9};
    if (axis == Axis::turn) { // a tooth is some 40 degrees of a turn
        for (int i = -6; i <= 6; ++i) knots.push_back(std::numbers::pi / 6 * i);
        return knots;
    }
    if (of_others(axis) && !(high - low > 1e-6)) return {};
    if (of_others(axis))
        return low < 0 && high > 0 ? std::vector<double>{low, 0, high} : std::vector<double>{low, 0.5 * (low + high), high};
    if (axis == Axis::current && of_torque) { // what saturates shows at the ends
        const double end = std::max(-quantile(values, 0.005), quantile(values, 0.995));
        return {-end, -0.5 * end, 0, 0.5 * end, end};
    }
    if (axis == Axis::voltage) { // where a bridge or a driver is not linear: near zero
        for (const double share : {-1.0, -0.25, -0.12, -0.04, 0.04, 0.12, 0.25, 1.0})
            knots.push_back(share * std::max(-low, high)); // assumed
        return high - low > 0.1 ? knots : std::vector<double>{};
    }
    const bool even = axis == Axis::yaw_rate || axis == Axis::abs_wheel_speed;
    const std::vector<double> quantiles = axis == Axis::abs_wheel_speed
                                              ? std::vector<double>{0.02, 0.14, 0.26, 0.38, 0.5, 0.62, 0.74, 0.86, 0.98}
                                              : std::vector<double>{0.02, 0.2, 0.4, 0.6, 0.8, 0.98};
    for (const double q : quantiles) {
        const double knot = even ? low + (q - 0.02) / 0.96 * (high - low) : quantile(values, q);
        if (knots.empty() || knot > knots.back() + 1e-6 + 0.02 * (high - low)) knots.push_back(knot);
    }
    if (axis == Axis::abs_wheel_speed && knots.size() > 2) { // speeds that the log does not visit
        const double half = 0.5 * (knots[1] - knots[0]);
        const auto least = static_cast<std::ptrdiff_t>(values.size() / 100);
        const auto unseen = [&](double knot) {
            return std::count_if(values.begin(), values.end(), [&](double x) { return std::fabs(x - knot) <= half; }) < least;
        };
        knots.erase(std::remove_if(knots.begin() + 1, knots.end() - 1, unseen),
                    knots.end() - 1); // the ends stay: a straight line is one of these shapes
    }
    return knots;
}

} // namespace traction::lab
