#include "moves_together.h"

#include "host_tools/lab/inputs/smooth.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <vector>

namespace traction::lab {

namespace {

constexpr double push_block_s = 0.5, slow_s = 5, quick_s = 0.1;
constexpr double pushed_alike[] = {0.75, 0.6}, all_wheels[] = {1.2, 3}; // (1): from the first to the second in a straight line
constexpr double accelerometer_alone = 0.8, turning = 5;                // (2), (3)
constexpr double largest = 30;                                          // noises, beyond which a row counts as so many
constexpr std::size_t few_blocks = 40;
constexpr double slope_too = 0.5;          // share of (2) from which a push is a slope: none of a clean log's
constexpr double least_wave_share = 0.5;   // of the squares that a sinusoid takes
constexpr double slowest = 0.05, most = 2; // [Hz, 1/m] of one

struct Blocks {
    std::vector<double> at_s;
    std::vector<std::vector<double>> mean; // of each wheel
};

struct Series {
    std::vector<double> t_s, e; // middle of a row, residual in noises
    double noise = 0;
};

Series series_of(const Problem &fitted, const Eigen::VectorXd &noise, std::size_t balance) {
    const Dataset &data = fitted.data();
    Eigen::Index row = 0;
    for (std::size_t b = 0; b < balance; ++b) row += static_cast<Eigen::Index>(data.balance[b].measured.size());
    Series out;
    out.noise = data.balance[balance].noise;
    double sum = 0;
    for (std::size_t r = 0; r < data.balance[balance].measured.size(); ++r, ++row) {
        out.t_s.push_back(0.5 * (data.balance[balance].t0_s[r] + data.balance[balance].t1_s[r]));
        out.e.push_back(std::clamp(fitted.residual[row] / noise[row], -largest, largest));
        sum += out.e.back();
    }
    for (double &e : out.e) e -= sum / static_cast<double>(out.e.size());
    return out;
}

// Means over blocks in which every series has half as many rows as it has in most.
Blocks blocks_of(const std::vector<Series> &series, double length_s) {
    struct Sum {
        double e = 0;
        std::size_t rows = 0;
    };
    std::map<long, std::vector<Sum>> sums;
    for (std::size_t i = 0; i < series.size(); ++i)
        for (std::size_t r = 0; r < series[i].e.size(); ++r) {
            std::vector<Sum> &block = sums[std::lround(std::floor(series[i].t_s[r] / length_s))];
            block.resize(series.size());
            block[i].e += series[i].e[r], ++block[i].rows;
        }
    std::vector<double> rows;
    for (const auto &[k, block] : sums) rows.push_back(static_cast<double>(block.front().rows));
    const double usual = median(rows);
    Blocks out;
    out.mean.resize(series.size());
    for (const auto &[k, block] : sums) {
        if (!std::all_of(block.begin(), block.end(),
                         [&](const Sum &s) { return static_cast<double>(s.rows) >= 0.5 * usual && s.rows > 0; }))
            continue;
        out.at_s.push_back((static_cast<double>(k) + 0.5) * length_s);
        for (std::size_t i = 0; i < series.size(); ++i) out.mean[i].push_back(block[i].e / static_cast<double>(block[i].rows));
    }
    return out;
}

double covariance(const std::vector<double> &a, const std::vector<double> &b) {
    double ma = 0, mb = 0, ab = 0;
    for (const double x : a) ma += x / static_cast<double>(a.size());
    for (const double x : b) mb += x / static_cast<double>(b.size());
    for (std::size_t k = 0; k < a.size(); ++k) ab += (a[k] - ma) * (b[k] - mb) / static_cast<double>(a.size());
    return ab;
}

double rms(const std::vector<double> &x) { return std::sqrt(covariance(x, x)); }

double mean_correlation(const std::vector<std::vector<double>> &x) {
    double sum = 0, pairs = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = 0; j < i; ++j, ++pairs) {
            const double size = std::sqrt(covariance(x[i], x[i]) * covariance(x[j], x[j]));
            sum += size > 0 ? covariance(x[i], x[j]) / size : 0;
        }
    return pairs > 0 ? sum / pairs : 0;
}

// Sum over the wheels, each times its weight.
std::vector<double> over_wheels(const std::vector<std::vector<double>> &x, const std::vector<double> &weight) {
    std::vector<double> out(x.front().size(), 0);
    for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t k = 0; k < out.size(); ++k) out[k] += weight[i] * x[i][k];
    return out;
}

std::vector<std::size_t> balances_of(const Dataset &data, BalanceKind kind) {
    std::vector<std::size_t> list;
    for (std::size_t b = 0; b < data.balance.size(); ++b)
        if (data.balance[b].kind == kind && !data.balance[b].measured.empty()) list.push_back(b);
    return list;
}

// rms of a signal's means over slow blocks; 0 where there are too few.
double slow_error(const Problem &fitted, const Eigen::VectorXd &noise, BalanceKind kind, double &size) {
    const std::vector<std::size_t> list = balances_of(fitted.data(), kind);
    if (list.empty()) return 0;
    const std::vector<Series> one{series_of(fitted, noise, list.front())};
    if (blocks_of(one, push_block_s).at_s.size() < few_blocks) return 0;
    const Blocks blocks = blocks_of(one, slow_s);
    if (blocks.at_s.size() < 2) return 0;
    size = rms(blocks.mean.front()) * one.front().noise;
    return rms(blocks.mean.front());
}

struct Wave {
    double rate = 0, share = 0, amplitude = 0, phase_rad = 0;
};

// The sinusoid over x that takes most of y.
Wave best_wave(const std::vector<double> &x, const std::vector<double> &y) {
    Wave best;
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    const double span = *high - *low, power = covariance(y, y) * static_cast<double>(y.size());
    if (!(span * most > 4) || !(power > 0)) return best;
    double apart = 0; // of one value from the next, in the mean: what is quicker than two of them is seen as something slower
    for (std::size_t k = 1; k < x.size(); ++k) apart += std::fabs(x[k] - x[k - 1]) / static_cast<double>(x.size() - 1);
    for (double rate = std::max(slowest, 3 / span); rate < std::min(most, 0.4 / apart); rate += 1 / (3 * span)) {
        double c = 0, s = 0;
        for (std::size_t k = 0; k < x.size(); ++k) {
            const double angle = 2 * std::numbers::pi * rate * x[k];
            c += y[k] * std::cos(angle), s += y[k] * std::sin(angle);
        }
        const double half = 0.5 * static_cast<double>(x.size()), share = (c * c + s * s) / half / power;
        if (share > best.share) best = {rate, share, std::hypot(c, s) / half, std::atan2(c, s)};
    }
    return best;
}

// What pushes the body along, by the currents of its wheels: less than the model expects where it is pushed ahead.
struct Wheels {
    std::vector<Series> series;
    std::vector<double> share, newton; // of the mean; what a noise of each current is at its rim, against the motion
};

Wheels wheels_of(const Problem &fitted, const Eigen::VectorXd &noise) {
    Wheels out;
    const Physics physics = fitted.physics();
    for (const std::size_t b : balances_of(fitted.data(), BalanceKind::current_torque)) {
        out.series.push_back(series_of(fitted, noise, b));
        const WheelPhysics &w = physics.wheel[static_cast<std::size_t>(fitted.data().balance[b].wheel)];
        out.newton.push_back(-out.series.back().noise * w.KG / rolling_radius(w));
    }
    out.share.assign(out.series.size(), 1 / static_cast<double>(out.series.size()));
    return out;
}

// (1); its size [N], and the wave that is most of it.
double least_correlation(double error) {
    const double strong = std::clamp((error - all_wheels[0]) / (all_wheels[1] - all_wheels[0]), 0.0, 1.0);
    return pushed_alike[0] + strong * (pushed_alike[1] - pushed_alike[0]);
}

std::optional<Together> push_on(Problem &fitted, const Wheels &wheels) {
    if (wheels.series.size() < 2) return std::nullopt;
    const Blocks blocks = blocks_of(wheels.series, push_block_s);
    if (blocks.at_s.size() < few_blocks) return std::nullopt;
    Together out;
    out.error = rms(over_wheels(blocks.mean, wheels.share)), out.correlation = mean_correlation(blocks.mean);
    if (!(out.error > all_wheels[0] && out.correlation > least_correlation(out.error))) return std::nullopt;
    out.size = rms(over_wheels(blocks.mean, wheels.newton));
    const Blocks quick = blocks_of(wheels.series, quick_s);
    const std::vector<double> pushed = over_wheels(quick.mean, wheels.newton), &path = fitted.forward().motion().path_m;
    const Dataset &data = fitted.data();
    std::vector<double> path_m;
    for (const double t : quick.at_s)
        path_m.push_back(
            path[static_cast<std::size_t>(std::clamp((t - data.start_s) / data.step_s, 0.0, static_cast<double>(path.size() - 1)))]);
    const Wave in_time = best_wave(quick.at_s, pushed), along = best_wave(path_m, pushed);
    const bool of_time = in_time.share > along.share;
    const Wave &wave = of_time ? in_time : along;
    if (!(wave.share > least_wave_share)) return out;
    (of_time ? out.per_s : out.per_m) = wave.rate;
    out.amplitude_N = wave.amplitude, out.phase_rad = wave.phase_rad;
    return out;
}

} // namespace

std::optional<Together> moves_together(Problem &fitted) {
    if (fitted.data().independent_rows) return std::nullopt;
    const Eigen::VectorXd noise = fitted.noise_rows();
    double felt_m_s2 = 0, turned_rad_s = 0;
    const double felt = slow_error(fitted, noise, BalanceKind::accel, felt_m_s2),
                 turned = slow_error(fitted, noise, BalanceKind::yaw_rate, turned_rad_s);
    if (std::optional<Together> push = push_on(fitted, wheels_of(fitted, noise))) {
        if (felt > slope_too * accelerometer_alone) push->what = Together::What::slope, push->size = felt_m_s2;
        return push;
    }
    Together out;
    if (felt > accelerometer_alone)
        out.what = Together::What::accelerometer, out.error = felt, out.size = felt_m_s2;
    else if (turned > turning)
        out.what = Together::What::turn, out.error = turned, out.size = turned_rad_s;
    else
        return std::nullopt;
    return out;
}

namespace {

struct Told {
    const char *balance, *target, *unit; // of UnknownShape
    const char *signal, *before, *after; // of the words, the latter about the size
};

const Told &told_as(Together::What what) {
    static constexpr Told told[] = {
        {"force on the body", "body_force", "N", "", "a force on the body of", "N that no law of the model has"},
        {"force on the body by a slope", "body_force", "N", " and the accelerometer", "gravity along the body of",
         "m/s^2, a slope that the model does not have"},
        {"acceleration felt", "sensor.accel", "m/s^2", "accelerometer alone", "",
         "m/s^2): its mounting, its temperature, or gravity along a body that tips"},
        {"moment on the body", "body_moment", "N m", "yaw rate", "",
         "rad/s): a moment on the body that no law of the model has, or a side's wheels that are not what they were"}};
    return told[static_cast<std::size_t>(what)];
}

// amplitude sin(2 pi rate x + phase), as an effect of the user's own has it.
std::string wave_of(const Together &what, double rate, const char *over) {
    char text[160];
    std::snprintf(text, sizeof text, "%.4g*sin(%.5g*%s %+.3g)", what.amplitude_N, 2 * std::numbers::pi * rate, over, what.phase_rad);
    return text;
}

} // namespace

UnknownShape shape_of(const Together &what) {
    const Told &as = told_as(what.what);
    UnknownShape told;
    char text[80] = "nothing that was tried";
    told.of_body = true, told.at_a_guess = what.per_s == 0 && what.per_m == 0;
    told.balance = std::string(as.balance), told.target = std::string(as.target), told.unit_y = std::string(as.unit);
    told.expression = std::string("0");
    if (what.per_s > 0) {
        std::snprintf(text, sizeof text, "time (it swings at %.3g Hz)", what.per_s);
        told.unit_x = std::string("s"), told.expression = wave_of(what, what.per_s, "t");
    } else if (what.per_m > 0) {
        std::snprintf(text, sizeof text, "path travelled (a wave of %.3g m)", 1 / what.per_m);
        told.unit_x = std::string("m"), told.expression = wave_of(what, what.per_m, "X");
    }
    told.variable = std::string(text);
    return told;
}

std::string together_words(const Together &what) {
    const Told &as = told_as(what.what);
    char text[400];
    if (what.correlation > 0)
        std::snprintf(text, sizeof text,
                      "what is left moves all wheels%s together (correlation %.2f, %.1f times a row's noise): %s %.3g %s", as.signal,
                      what.correlation, what.error, as.before, what.size, as.after);
    else
        std::snprintf(text, sizeof text, "the %s is missed slowly, by %.1f times its noise (%.3g %s", as.signal, what.error, what.size,
                      as.after);
    return text;
}

} // namespace traction::lab
