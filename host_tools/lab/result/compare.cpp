#include "compare.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace traction::lab {

namespace {

constexpr double window_s = 5;

std::vector<Worst> worst_windows(const std::vector<double> &t, const std::vector<double> &e) {
    std::vector<Worst> list;
    std::vector<std::pair<double, int>> sums;
    if (t.empty()) return list;
    const auto count = static_cast<std::size_t>((t.back() - t.front()) / window_s) + 1;
    sums.assign(count, {0, 0});
    for (std::size_t i = 0; i < t.size(); ++i) {
        auto &[sum, n] = sums[std::min(count - 1, static_cast<std::size_t>((t[i] - t.front()) / window_s))];
        sum += e[i] * e[i], ++n;
    }
    for (std::size_t w = 0; w < count; ++w)
        if (sums[w].second > 0)
            list.push_back({t.front() + static_cast<double>(w) * window_s, t.front() + static_cast<double>(w + 1) * window_s,
                            std::sqrt(sums[w].first / sums[w].second)});
    std::stable_sort(list.begin(), list.end(), [](const Worst &a, const Worst &b) { return a.rmse > b.rmse; });
    if (list.size() > 5) list.resize(5);
    return list;
}

// Normalised correlation of two series at lags 0..max; step: spacing of the rows.
Correlation correlation(const std::vector<double> &a, const std::vector<double> &b, double step_s, const std::string &with) {
    Correlation c;
    c.with = with;
    const std::size_t n = a.size();
    if (n < 20) return c;
    const auto mean = [&](const std::vector<double> &x) {
        double sum = 0;
        for (const double v : x) sum += v;
        return sum / static_cast<double>(n);
    };
    const double ma = mean(a), mb = mean(b);
    double va = 0, vb = 0;
    for (std::size_t i = 0; i < n; ++i) va += (a[i] - ma) * (a[i] - ma), vb += (b[i] - mb) * (b[i] - mb);
    if (!(va > 0) || !(vb > 0)) return c;
    const std::size_t lags = std::min<std::size_t>(60, n / 4);
    for (std::size_t lag = 0; lag <= lags; ++lag) {
        double sum = 0;
        for (std::size_t i = 0; i + lag < n; ++i) sum += (a[i + lag] - ma) * (b[i] - mb);
        c.lag_s.push_back(static_cast<double>(lag) * step_s);
        c.value.push_back(sum / std::sqrt(va * vb));
    }
    c.band = 2.576 / std::sqrt(static_cast<double>(n));
    return c;
}

std::vector<double> at_rows(const Dataset &data, const Balance &b, const std::vector<double> &series) {
    std::vector<double> out;
    for (std::size_t r = 0; r < b.measured.size(); ++r) {
        const double x = (0.5 * (b.t0_s[r] + b.t1_s[r]) - data.start_s) / data.step_s;
        out.push_back(series.empty() ? 0.0 : series[std::min(series.size() - 1, static_cast<std::size_t>(std::max(0.0, x + 0.5)))]);
    }
    return out;
}

BalanceComparison compare_balance(Problem &problem, std::size_t b) {
    const Dataset &data = problem.data();
    const Balance &balance = data.balance[b];
    BalanceComparison out;
    out.name = balance.name, out.title = balance.title, out.unit = balance.unit;
    out.noise = balance.noise, out.noise_source = balance.noise_source;
    const std::size_t n = balance.measured.size();
    std::vector<double> e(n);
    double sum = 0, squares = 0, mean = 0, spread = 0;
    for (std::size_t r = 0; r < n; ++r) {
        e[r] = problem.residual[static_cast<Eigen::Index>(problem.forward().first_row(b) + r)];
        out.t_s.push_back(0.5 * (balance.t0_s[r] + balance.t1_s[r]));
        out.measured.push_back(balance.measured[r]);
        out.model.push_back(balance.measured[r] - e[r]);
        sum += e[r], squares += e[r] * e[r], mean += balance.measured[r];
    }
    const double count = static_cast<double>(n);
    mean /= count;
    for (const double m : balance.measured) spread += (m - mean) * (m - mean);
    out.bias = sum / count;
    out.rmse = std::sqrt(squares / count);
    out.nrmse = problem.balance_rms(b, true);
    out.r2 = spread > 0 ? 1 - squares / spread : 0;
    out.worst = worst_windows(out.t_s, e);
    const double step = n > 1 ? (out.t_s.back() - out.t_s.front()) / (count - 1) : 1;
    out.acf = correlation(e, e, step, "itself");
    const Motion &m = problem.forward().motion();
    if (balance.wheel >= 0) {
        const auto w = static_cast<std::size_t>(balance.wheel);
        out.ccf.push_back(correlation(e, at_rows(data, balance, m.wheel[w].slip), step, "slip of the wheel"));
        out.ccf.push_back(correlation(e, at_rows(data, balance, data.wheel[w].speed_rad_s), step, "speed of the wheel"));
        out.ccf.push_back(correlation(e, at_rows(data, balance, data.wheel[w].accel_rad_s2), step, "acceleration of the wheel"));
    } else {
        out.ccf.push_back(correlation(e, at_rows(data, balance, m.v_m_s), step, "speed of the body"));
        out.ccf.push_back(correlation(e, at_rows(data, balance, m.accel_m_s2), step, "acceleration of the body"));
    }
    std::erase_if(out.ccf, [](const Correlation &c) { return c.value.empty(); });
    return out;
}

// Heat map: one row per balance, columns along a quantity.
template <typename Value>
Regime regime(Problem &problem, const std::string &title, const std::string &x_label, double low, double high, Value &&value_at) {
    Regime map{title, x_label, {}, {}, {}, {}};
    constexpr std::size_t columns = 12;
    if (!(high > low)) high = low + 1;
    for (std::size_t c = 0; c <= columns; ++c) map.x_edges.push_back(low + (high - low) * static_cast<double>(c) / columns);
    const Dataset &data = problem.data();
    const Eigen::VectorXd noise = problem.noise_rows();
    for (std::size_t b = 0; b < data.balance.size(); ++b) {
        std::vector<double> sum(columns, 0), count(columns, 0);
        const Balance &balance = data.balance[b];
        for (std::size_t r = 0; r < balance.measured.size(); ++r) {
            const double x = (0.5 * (balance.t0_s[r] + balance.t1_s[r]) - data.start_s) / data.step_s;
            const std::size_t k = std::min(data.count - 1, static_cast<std::size_t>(std::max(0.0, x + 0.5)));
            const double at = value_at(b, k);
            if (!(at >= low && at <= high)) continue;
            const auto c = std::min(columns - 1, static_cast<std::size_t>((at - low) / (high - low) * columns));
            const auto row = static_cast<Eigen::Index>(problem.forward().first_row(b) + r);
            const double e = problem.residual[row] / noise[row];
            sum[c] += e * e, count[c] += 1;
        }
        for (std::size_t c = 0; c < columns; ++c) sum[c] = count[c] > 0 ? std::sqrt(sum[c] / count[c]) : std::nan("");
        map.y_labels.push_back(balance.name);
        map.value.push_back(sum);
        map.count.push_back(count);
    }
    return map;
}

std::vector<Regime> regimes(Problem &problem) {
    const Dataset &data = problem.data();
    const Motion &m = problem.forward().motion();
    const auto range = [](const std::vector<double> &x) {
        const auto [low, high] = std::minmax_element(x.begin(), x.end());
        return std::pair(*low, *high);
    };
    std::vector<Regime> maps;
    const auto wheel_of = [&](std::size_t b) { return static_cast<std::size_t>(std::max(0, data.balance[b].wheel)); };
    maps.push_back(regime(problem, "Error by slip", "slip of the wheel (wheel 0 where the balance has none)", -1, 1,
                          [&](std::size_t b, std::size_t k) { return m.wheel[wheel_of(b)].slip[k]; }));
    const auto [v0, v1] = range(m.v_m_s);
    maps.push_back(
        regime(problem, "Error by speed", "speed of the body [m/s]", v0, v1, [&](std::size_t, std::size_t k) { return m.v_m_s[k]; }));
    const auto [a0, a1] = range(m.accel_m_s2);
    maps.push_back(regime(problem, "Error by acceleration", "acceleration of the body [m/s^2]", std::max(a0, -3.0), std::min(a1, 3.0),
                          [&](std::size_t, std::size_t k) { return m.accel_m_s2[k]; }));
    const auto [x0, x1] = range(m.path_m);
    maps.push_back(
        regime(problem, "Error by place", "path travelled [m]", x0, x1, [&](std::size_t, std::size_t k) { return m.path_m[k]; }));
    maps.push_back(regime(problem, "Error by time", "time [s]", data.start_s, data.time(data.count - 1),
                          [&](std::size_t, std::size_t k) { return data.time(k); }));
    return maps;
}

} // namespace

Comparison compare(const Model &model, const Dataset &data, bool as_is) {
    Comparison out;
    out.messages = data.messages;
    if (data.balance.empty() || data.count < 3) {
        out.verdict = "nothing can be compared";
        return out;
    }
    const Physics physics = make_physics(model);
    Problem problem(data, physics, free_parameters(model, physics));
    if (as_is)
        problem.linearise(); // its motion is shown
    else
        problem.cost();
    out.error = overall_error(problem);
    Problem adjusted = fitted_problem(model, data);
    for (const Limit &limit : limits_of(adjusted)) out.limits.push_back(limit);
    out.adjusted = overall_error(adjusted);
    Problem &shown = as_is ? problem : adjusted;
    for (std::size_t b = 0; b < data.balance.size(); ++b) out.balances.push_back(compare_balance(shown, b));
    out.regimes = regimes(shown);
    char text[256];
    const double ratio = out.adjusted / out.floor;
    const char *what = ratio < 1.15  ? "the model explains this log down to the noise"
                       : ratio < 1.6 ? "close to the noise: little is left to find"
                                     : "there is something to find";
    std::snprintf(text, sizeof text, "error %.2f x noise floor (%.2f x when the parameters move within their priors): %s",
                  out.error / out.floor, ratio, what);
    out.verdict = text;
    return out;
}

} // namespace traction::lab
