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
constexpr double pushed_alike = 0.75, all_wheels = 1.2, accelerometer_alone = 0.8, turning = 5; // (1) to (3)
constexpr double largest = 30; // noises, beyond which a row counts as so many
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

std::vector<double> over_wheels(const std::vector<std::vector<double>> &x) {
    std::vector<double> out(x.front().size(), 0);
    for (const std::vector<double> &one : x)
        for (std::size_t k = 0; k < out.size(); ++k) out[k] += one[k] / static_cast<double>(x.size());
    return out;
}

std::vector<std::size_t> balances_of(const Dataset &data, BalanceKind kind) {
    std::vector<std::size_t> list;
    for (std::size_t b = 0; b < data.balance.size(); ++b)
        if (data.balance[b].kind == kind && !data.balance[b].measured.empty()) list.push_back(b);
    return list;
}

// rms of a signal's means over slow blocks; 0 where there are too few.
double slow_error(const Problem &fitted, const Eigen::VectorXd &noise, BalanceKind kind, double *size) {
    const std::vector<std::size_t> list = balances_of(fitted.data(), kind);
    if (list.empty()) return 0;
    const std::vector<Series> one{series_of(fitted, noise, list.front())};
    if (blocks_of(one, push_block_s).at_s.size() < few_blocks) return 0;
    const Blocks blocks = blocks_of(one, slow_s);
    if (blocks.at_s.size() < 2) return 0;
    *size = rms(blocks.mean.front()) * one.front().noise;
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

} // namespace

std::optional<Together> moves_together(Problem &fitted) {
    const Dataset &data = fitted.data();
    if (data.independent_rows) return std::nullopt;
    const Eigen::VectorXd noise = fitted.noise_rows();
    double felt_m_s2 = 0, turned_rad_s = 0;
    const double felt = slow_error(fitted, noise, BalanceKind::accel, &felt_m_s2),
                 turned = slow_error(fitted, noise, BalanceKind::yaw_rate, &turned_rad_s);
    std::vector<Series> wheels;
    std::vector<double> newton; // that a noise of each wheel's current is at its rim
    const Physics physics = fitted.physics();
    for (const std::size_t b : balances_of(data, BalanceKind::current_torque)) {
        wheels.push_back(series_of(fitted, noise, b));
        const WheelPhysics &w = physics.wheel[static_cast<std::size_t>(data.balance[b].wheel)];
        newton.push_back(wheels.back().noise * w.KG / rolling_radius(w));
    }
    const Blocks blocks = wheels.size() < 2 ? Blocks{} : blocks_of(wheels, push_block_s);
    Together out;
    if (blocks.at_s.size() >= few_blocks) {
        out.error = rms(over_wheels(blocks.mean)), out.correlation = mean_correlation(blocks.mean);
        if (out.error > all_wheels && out.correlation > pushed_alike) {
            const Blocks quick = blocks_of(wheels, quick_s);
            std::vector<double> pushed(quick.at_s.size(), 0), path_m;
            for (std::size_t i = 0; i < wheels.size(); ++i)
                for (std::size_t k = 0; k < pushed.size(); ++k) pushed[k] -= newton[i] * quick.mean[i][k];
            std::vector<double> coarse(blocks.at_s.size(), 0);
            for (std::size_t i = 0; i < wheels.size(); ++i)
                for (std::size_t k = 0; k < coarse.size(); ++k) coarse[k] -= newton[i] * blocks.mean[i][k];
            const Motion &motion = fitted.forward().motion();
            for (const double t : quick.at_s)
                path_m.push_back(motion.path_m[static_cast<std::size_t>(
                    std::clamp((t - data.start_s) / data.step_s, 0.0, static_cast<double>(motion.path_m.size() - 1)))]);
            out.what = felt > slope_too * accelerometer_alone ? Together::What::slope : Together::What::push;
            out.size = out.what == Together::What::slope ? felt_m_s2 : rms(coarse);
            const Wave time = best_wave(quick.at_s, pushed), path = best_wave(path_m, pushed);
            const Wave &wave = time.share > path.share ? time : path;
            if (wave.share > least_wave_share) {
                (time.share > path.share ? out.per_s : out.per_m) = wave.rate;
                out.amplitude_N = wave.amplitude, out.phase_rad = wave.phase_rad;
            }
            return out;
        }
    }
    out = {};
    if (felt > accelerometer_alone) {
        out.what = Together::What::accelerometer, out.error = felt, out.size = felt_m_s2;
        return out;
    }
    if (turned > turning) {
        out.what = Together::What::turn, out.error = turned, out.size = turned_rad_s;
        return out;
    }
    return std::nullopt;
}

UnknownShape shape_of(const Together &what) {
    UnknownShape told;
    char text[160];
    told.of_body = true;
    told.at_a_guess = what.per_s == 0 && what.per_m == 0;
    told.target = std::string(target_name(what.what == Together::What::accelerometer ? TermTarget::accel : TermTarget::body_force));
    const auto of = [&](const char *push, const char *slope, const char *felt, const char *turn) {
        switch (what.what) {
        case Together::What::push:
            return std::string(push);
        case Together::What::slope:
            return std::string(slope);
        case Together::What::accelerometer:
            return std::string(felt);
        case Together::What::turn:
            break;
        }
        return std::string(turn);
    };
    told.balance = of("force on the body", "force on the body by a slope", "acceleration felt", "moment on the body");
    told.unit_y = of("N", "N", "m/s^2", "N m");
    told.variable = std::string("nothing that was tried"), told.expression = std::string("0");
    if (what.per_s > 0) {
        std::snprintf(text, sizeof text, "time (it swings at %.3g Hz)", what.per_s);
        told.variable = std::string(text), told.unit_x = std::string("s");
        std::snprintf(text, sizeof text, "%.4g*sin(%.5g*t %+.3g)", what.amplitude_N, 2 * std::numbers::pi * what.per_s, what.phase_rad);
        told.expression = std::string(text);
    } else if (what.per_m > 0) {
        std::snprintf(text, sizeof text, "path travelled (a wave of %.3g m)", 1 / what.per_m);
        told.variable = std::string(text), told.unit_x = std::string("m");
        std::snprintf(text, sizeof text, "%.4g*sin(%.5g*X %+.3g)", what.amplitude_N, 2 * std::numbers::pi * what.per_m, what.phase_rad);
        told.expression = std::string(text);
    }
    return told;
}

std::string together_words(const Together &what) {
    char text[400];
    switch (what.what) {
    case Together::What::push:
        std::snprintf(text, sizeof text,
                      "what is left moves all wheels together (correlation %.2f, %.1f times a row's noise): a force on the body of %.3g N "
                      "that no law of the model has",
                      what.correlation, what.error, what.size);
        break;
    case Together::What::slope:
        std::snprintf(text, sizeof text,
                      "what is left moves all wheels and the accelerometer together (correlation %.2f, %.1f times a row's noise): gravity "
                      "along the body of %.3g m/s^2, a slope that the model does not have",
                      what.correlation, what.error, what.size);
        break;
    case Together::What::accelerometer:
        std::snprintf(text, sizeof text,
                      "the accelerometer alone is missed slowly, by %.1f times its noise (%.3g m/s^2): its mounting, its temperature, or "
                      "gravity along a body that tips",
                      what.error, what.size);
        break;
    case Together::What::turn:
        std::snprintf(text, sizeof text,
                      "the yaw rate is missed slowly, by %.1f times its noise (%.3g rad/s): a moment on the body that no law of the model "
                      "has, or a side's wheels that are not what they were",
                      what.error, what.size);
        break;
    }
    return text;
}

} // namespace traction::lab
