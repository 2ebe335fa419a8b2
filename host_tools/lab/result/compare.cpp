#include "compare.h"

#include "append.h"
#include "words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace traction::lab {

namespace {

constexpr double window_s = 5;
constexpr std::size_t strip_parts = 24;
constexpr double least_rows = 20; // of a heat map's cell that is named: assumed

std::vector<Worst> worst_windows(const std::vector<double> &t, const std::vector<double> &e, double end_s) {
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
            list.push_back({t.front() + static_cast<double>(w) * window_s,
                            std::min(end_s, t.front() + static_cast<double>(w + 1) * window_s), std::sqrt(sums[w].first / sums[w].second)});
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

// RMS of the residual in units of noise over equal parts of the log.
std::vector<double> strip_of(const std::vector<double> &t, const std::vector<double> &e, const std::vector<double> &noise, double start_s,
                             double end_s) {
    std::vector<double> sum(strip_parts, 0), count(strip_parts, 0);
    for (std::size_t i = 0; i < t.size() && end_s > start_s; ++i) {
        const double at = std::clamp((t[i] - start_s) / (end_s - start_s), 0.0, 1.0) * strip_parts;
        const std::size_t k = std::min(strip_parts - 1, static_cast<std::size_t>(at));
        sum[k] += e[i] * e[i] / (noise[i] * noise[i]), count[k] += 1;
    }
    for (std::size_t k = 0; k < strip_parts; ++k) sum[k] = count[k] > 0 ? std::sqrt(sum[k] / count[k]) : std::nan("");
    return sum;
}

double end_of(const Dataset &data) { return data.count > 0 ? data.time(data.count - 1) : data.start_s; }

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
    if (!data.independent_rows) out.gaps = gaps_of(balance, data.start_s, end_of(data));
    const Eigen::VectorXd noise = problem.noise_rows();
    for (std::size_t r = 0; r < n; ++r) out.in_noise.push_back(noise[static_cast<Eigen::Index>(problem.forward().first_row(b) + r)]);
    out.worst = worst_windows(out.t_s, e, std::max(end_of(data), n > 0 ? out.t_s.back() : 0.0));
    out.strip = strip_of(out.t_s, e, out.in_noise, data.start_s, end_of(data));
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
    const std::size_t bracket = x_label.find(" [");
    Regime map{x_label.substr(0, std::min(bracket, x_label.find(" ("))),
               bracket == std::string::npos ? "" : x_label.substr(bracket + 2, x_label.find(']') - bracket - 2),
               title,
               x_label,
               {},
               {},
               {},
               {}};
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

// compare() tests nothing: whether what is left means something is for `diagnose` to say.
std::string verdict_of(const Comparison &c) {
    const double ratio = c.adjusted / c.floor;
    if (ratio < 1.15) return misses_words(c) + ". That is the noise of the sensors: for this log the model is good enough.";
    if (ratio < 1.6) return misses_words(c) + ". That is close to the noise of the sensors: little can be left to find.";
    return misses_words(c) + ". Whether an effect is missing, traction diagnose tells.";
}

} // namespace

std::string misses_words(const Comparison &c) {
    return "The model misses by " + times(c.error / c.floor) + " times the sensor noise; retuning it within its tolerances leaves " +
           times(c.adjusted / c.floor);
}

std::vector<Gap> gaps_of(const Balance &balance, double start_s, double end_s) {
    std::vector<Gap> gaps;
    const std::size_t n = balance.measured.size();
    if (n < 3) return gaps;
    const auto middle = [&](std::size_t r) { return 0.5 * (balance.t0_s[r] + balance.t1_s[r]); };
    std::vector<double> apart;
    for (std::size_t r = 1; r < n; ++r) apart.push_back(middle(r) - middle(r - 1));
    std::nth_element(apart.begin(), apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2), apart.end());
    const double usual = apart[apart.size() / 2];
    if (!(usual > 0)) return gaps;
    const auto note = [&](double from, double to, double centres) {
        if (centres > 1.5 * usual && to > from) gaps.push_back({from, to, std::max(1, static_cast<int>(std::lround(centres / usual)) - 1)});
    };
    note(start_s, balance.t0_s[0], balance.t0_s[0] - start_s + usual);
    for (std::size_t r = 1; r < n; ++r) note(balance.t1_s[r - 1], balance.t0_s[r], middle(r) - middle(r - 1));
    note(balance.t1_s[n - 1], end_s, end_s - balance.t1_s[n - 1] + usual);
    return gaps;
}

std::string farthest_words(const Comparison &comparison) {
    const auto worst = std::max_element(comparison.balances.begin(), comparison.balances.end(),
                                        [](const BalanceComparison &a, const BalanceComparison &b) { return a.nrmse < b.nrmse; });
    if (worst == comparison.balances.end()) return "";
    std::string text;
    append(text, "Farthest off is the %s: typically by %.2g %s, %s times its noise.",
           worst->title.empty() ? worst->name.c_str() : worst->title.c_str(), worst->rmse, worst->unit.c_str(),
           times(worst->nrmse).c_str());
    return text;
}

std::string worst_regime_words(const Comparison &comparison) {
    const Regime *map = nullptr;
    std::size_t row = 0, column = 0;
    double most = 1.5 * comparison.adjusted;
    for (const Regime &r : comparison.regimes)
        for (std::size_t y = 0; y < r.value.size(); ++y)
            for (std::size_t x = 0; x < r.value[y].size(); ++x)
                if (r.count[y][x] >= least_rows && r.value[y][x] > most) most = r.value[y][x], map = &r, row = y, column = x;
    if (map == nullptr) return "";
    std::string text;
    append(text, "The model fails most at %s %.3g to %.3g%s%s, in %s: %s times the noise.", map->quantity.c_str(), map->x_edges[column],
           map->x_edges[column + 1], map->unit.empty() ? "" : " ", map->unit.c_str(), map->y_labels[row].c_str(), times(most).c_str());
    return text;
}

void show_after(Comparison &comparison, const Model &better, const Dataset &data, const Problem *known) {
    if (comparison.balances.empty()) return;
    Problem problem = known != nullptr ? *known : fitted_problem(better, data);
    for (std::size_t b = 0; b < comparison.balances.size(); ++b) {
        BalanceComparison &out = comparison.balances[b];
        double squares = 0;
        out.after.clear();
        for (std::size_t r = 0; r < out.measured.size(); ++r) {
            const double e = problem.residual[static_cast<Eigen::Index>(problem.forward().first_row(b) + r)];
            out.after.push_back(out.measured[r] - e);
            squares += e * e;
        }
        out.rmse_after = out.measured.empty() ? 0 : std::sqrt(squares / static_cast<double>(out.measured.size()));
        out.nrmse_after = problem.balance_rms(b, true);
    }
    comparison.left_after = remainder_of(problem);
}

Comparison compare(const Model &model, const Dataset &data, bool as_is, const Problem *known) {
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
    Problem adjusted = known != nullptr ? *known : fitted_problem(model, data);
    for (const Limit &limit : limits_of(adjusted)) out.limits.push_back(limit);
    out.adjusted = overall_error(adjusted);
    Problem &shown = as_is ? problem : adjusted;
    for (std::size_t b = 0; b < data.balance.size(); ++b) out.balances.push_back(compare_balance(shown, b));
    out.regimes = regimes(shown);
    out.left = remainder_of(adjusted);
    out.verdict = verdict_of(out);
    return out;
}

} // namespace traction::lab
