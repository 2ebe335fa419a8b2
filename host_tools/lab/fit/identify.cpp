#include "identify.h"

#include "host_tools/lab/inputs/smooth.h"
#include "sparse_jacobian.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>

namespace traction::lab {

namespace {

constexpr double least_effect = 0.1, of_prior = 0.9, alike = 0.95;
constexpr double chance = 1e-4, least_Hz = 0.5;
constexpr std::size_t longest_window = 512, around = 20;

// Power at each frequency 1..n/2-1 of the mean over half-overlapping Hann windows; `windows`: how many.
std::vector<double> spectrum(const std::vector<double> &e, std::size_t n, double &windows) {
    std::vector<double> power(n / 2, 0);
    windows = 0;
    for (std::size_t first = 0; first + n <= e.size(); first += n / 2, ++windows) {
        for (std::size_t f = 1; f < n / 2; ++f) {
            const double turn = 2 * std::numbers::pi / static_cast<double>(n), step = turn * static_cast<double>(f);
            const double c = std::cos(step), s = std::sin(step);
            double re = 0, im = 0, x = 1, y = 0;
            for (std::size_t i = 0; i < n; ++i) {
                const double value = e[first + i] * (0.5 - 0.5 * std::cos(turn * static_cast<double>(i)));
                re += value * x, im += value * y;
                const double next = x * c - y * s;
                y = x * s + y * c, x = next;
            }
            power[f] += re * re + im * im;
        }
    }
    return power;
}

// A chi-squared of `freedom` over its median that is passed with probability p (Wilson and Hilferty 1931).
double times_median(double freedom, double p) {
    double low = 0, high = 40; // normal quantile by bisection
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (0.5 * std::erfc(middle / std::numbers::sqrt2) > p ? low : high) = middle;
    }
    const double a = 2 / (9 * freedom);
    return std::pow((1 - a + low * std::sqrt(a)) / (1 - a), 3);
}

// A parameter; of one that wheels share and differ in, the mean over the wheels: the shared part and theirs only add up.
struct Mean {
    std::string name, unit;
    Eigen::VectorXd weight; // of the living parameters
    double value = 0, prior_variance = 0, stated = 0;
};

std::vector<Mean> means_of(const Problem &problem, const std::vector<Eigen::Index> &alive) {
    std::vector<Mean> list;
    const FreeParameter *shared = nullptr;
    for (std::size_t i = 0; i < alive.size(); ++i) {
        const FreeParameter &p = problem.parameters[static_cast<std::size_t>(alive[i])];
        const double theta = problem.theta[alive[i]];
        if (p.own && shared != nullptr && shared->owner == p.owner && shared->key == p.key) { // they follow what they share
            const double wheels = static_cast<double>(std::count_if(alive.begin(), alive.end(), [&](Eigen::Index j) {
                const FreeParameter &q = problem.parameters[static_cast<std::size_t>(j)];
                return q.own && q.owner == p.owner && q.key == p.key;
            }));
            list.back().weight[static_cast<Eigen::Index>(i)] = 1 / wheels;
            list.back().value += theta / wheels, list.back().prior_variance += p.prior * p.prior / (wheels * wheels);
            continue;
        }
        if (p.own) continue;
        shared = &p;
        Mean mean{name_of(p),        p.unit, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(alive.size())), p.base + theta,
                  p.prior * p.prior, p.base};
        mean.weight[static_cast<Eigen::Index>(i)] = 1;
        list.push_back(std::move(mean));
    }
    return list;
}

} // namespace

std::vector<Limit> limits_of(const Problem &problem) {
    std::vector<Limit> list;
    for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
        const FreeParameter &p = problem.parameters[i];
        if (!problem.at_bound(i)) continue;
        const double increment = problem.theta[static_cast<Eigen::Index>(i)], value = p.base + increment;
        const double slack = 1e-6 * (p.maximum - p.minimum);
        const bool own_bound = value < p.minimum + slack || value > p.maximum - slack;
        const bool may_be_absent = p.prior == 0 || p.prior > 0.5 * std::fabs(p.base);
        if (own_bound && p.minimum == 0 && value < slack && may_be_absent) continue; // what is not there
        list.push_back({name_of(p), p.unit, p.own ? increment : value, p.own, !own_bound});
    }
    return list;
}

std::string limit_text(const Limit &limit) {
    char text[300];
    std::snprintf(text, sizeof text, "%s stands at its limit, %s%.4g%s%s%s: widen it or doubt the model", limit.parameter.c_str(),
                  limit.own ? "off from the other wheels' by " : "", limit.value, limit.unit == "1" || limit.unit.empty() ? "" : " ",
                  limit.unit == "1" ? "" : limit.unit.c_str(), limit.of_prior ? " (six of its prior's deviations)" : "");
    return text;
}

namespace {

// Of what wheels share and differ in; an offset of a sensor is a run's, not a sheet's.
std::vector<Mean> means_of_sheet(const Problem &problem) {
    std::vector<Eigen::Index> all(problem.parameters.size());
    std::iota(all.begin(), all.end(), 0);
    std::vector<Mean> list = means_of(problem, all);
    std::erase_if(list, [](const Mean &mean) { return mean.name.starts_with("sensors.") || !(mean.prior_variance > 0); });
    return list;
}

double deviations_of(const Mean &mean) { return std::fabs(mean.value - mean.stated) / std::sqrt(mean.prior_variance); }

} // namespace

double furthest_of_sheet(const Problem &problem) {
    double most = 0;
    for (const Mean &mean : means_of_sheet(problem)) most = std::max(most, deviations_of(mean));
    return most;
}

std::vector<Moved> moved_far(const Problem &problem) {
    constexpr double far = 3; // stated deviations
    const std::vector<Limit> limits = limits_of(problem);
    std::vector<Moved> list;
    for (const Mean &mean : means_of_sheet(problem)) {
        const double away = deviations_of(mean);
        const bool told = std::any_of(limits.begin(), limits.end(), [&](const Limit &l) { return l.parameter == mean.name; });
        if (!(away > far) || told) continue;
        char text[400];
        std::snprintf(text, sizeof text,
                      "the fit takes %s from %.4g to %.4g%s%s, %.1f of its stated deviations: the model file is wrong there, or something "
                      "that acts alike is missing",
                      mean.name.c_str(), mean.stated, mean.value, mean.unit == "1" ? "" : " ", mean.unit == "1" ? "" : mean.unit.c_str(),
                      away);
        list.push_back({mean.name, text});
    }
    return list;
}

bool is_dead(const Problem &problem, std::size_t i) {
    const FreeParameter &p = problem.parameters[i];
    const double size = p.prior > 0 ? p.prior : std::max(std::fabs(p.base + problem.theta[static_cast<Eigen::Index>(i)]), 1.0);
    return !(problem.jacobian.col(static_cast<Eigen::Index>(i)).norm() * size > least_effect);
}

Identifiability identifiability(const Problem &problem) {
    Identifiability out;
    std::vector<Eigen::Index> alive;
    for (std::size_t i = 0; i < problem.parameters.size(); ++i)
        if (is_dead(problem, i))
            out.dead.push_back(name_of(problem.parameters[i]));
        else
            alive.push_back(static_cast<Eigen::Index>(i));
    if (alive.empty()) return out;
    Eigen::MatrixXd normal = SparseJacobian(problem.data(), problem.jacobian).gram();
    normal.diagonal() += problem.prior_precision();
    Eigen::MatrixXd A = normal(alive, alive);
    const Eigen::VectorXd unit = A.diagonal().cwiseSqrt().cwiseInverse();
    A = unit.asDiagonal() * A * unit.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
    const Eigen::VectorXd values = eigen.eigenvalues().cwiseMax(1e-15);
    out.condition = values.maxCoeff() / values.minCoeff();
    const Eigen::MatrixXd C = unit.asDiagonal() *
                              (eigen.eigenvectors() * values.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose()) *
                              unit.asDiagonal();
    const std::vector<Mean> means = means_of(problem, alive);
    for (std::size_t i = 0; i < means.size(); ++i) {
        const double variance = means[i].weight.dot(C * means[i].weight);
        if (means[i].prior_variance > 0 && variance > of_prior * means[i].prior_variance) out.prior_alone.push_back(means[i].name);
        if (!(means[i].prior_variance > 0) && variance > means[i].value * means[i].value) out.flat.push_back(means[i].name);
        for (std::size_t j = 0; j < i; ++j) {
            const double other = means[j].weight.dot(C * means[j].weight),
                         r = means[i].weight.dot(C * means[j].weight) / std::sqrt(variance * other);
            if (std::fabs(r) > alike) out.correlated.push_back({means[j].name, means[i].name, r});
        }
    }
    return out;
}

std::vector<Resonance> resonances(const Problem &problem) {
    std::vector<Resonance> list;
    Eigen::Index first = 0;
    const Eigen::VectorXd scaled = problem.residual.cwiseProduct(problem.row_scale);
    for (const Balance &b : problem.data().balance) {
        const std::size_t rows = b.measured.size();
        const std::vector<double> e(scaled.begin() + first, scaled.begin() + first + static_cast<Eigen::Index>(rows));
        first += static_cast<Eigen::Index>(rows);
        const std::size_t n = std::min(longest_window, rows / 4 * 2);
        if (n < 4 * around || problem.data().independent_rows) continue;
        double windows = 0;
        const std::vector<double> power = spectrum(e, n, windows);
        const double period = (b.t0_s.back() - b.t0_s.front()) / static_cast<double>(rows - 1);
        // half-overlapping Hann windows count as 0.8 of as many (Welch 1967); neighbours of a peak share it, hence half of the frequencies
        const double limit = times_median(std::max(2.0, 1.6 * windows), chance / static_cast<double>(n / 4));
        Resonance best{b.name, 0, 0};
        for (std::size_t f = 3; f + 3 < power.size(); ++f) {
            const double frequency = static_cast<double>(f) / (static_cast<double>(n) * period);
            if (frequency < least_Hz) continue;
            std::vector<double> beside;
            for (std::size_t j = f > around ? f - around : 1; j < std::min(power.size(), f + around + 1); ++j)
                if (j + 2 < f || j > f + 2) beside.push_back(power[j]);
            const double times = power[f] / std::max(1e-300, median(beside));
            if (times > limit && times > best.times) best.frequency_Hz = frequency, best.times = times;
        }
        if (best.times > 0) list.push_back(best);
    }
    return list;
}

} // namespace traction::lab
