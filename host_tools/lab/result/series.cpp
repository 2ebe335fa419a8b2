#include "series.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace {

double rounded(double value, int digits) {
    if (value == 0 || !std::isfinite(value)) return value;
    const double unit = std::pow(10.0, digits - 1 - std::floor(std::log10(std::fabs(value))));
    return std::isfinite(unit) && unit > 0 ? std::round(value * unit) / unit : value;
}

} // namespace

std::vector<std::size_t> extremes_of(const std::vector<const std::vector<double> *> &columns, std::size_t most) {
    std::vector<std::size_t> kept;
    const std::size_t n = columns.empty() ? 0 : columns.front()->size();
    const std::size_t stretches = std::max<std::size_t>(1, most / (2 * std::max<std::size_t>(1, columns.size())));
    if (n <= most) {
        for (std::size_t i = 0; i < n; ++i) kept.push_back(i);
        return kept;
    }
    kept = {0, n - 1};
    for (std::size_t s = 0; s < stretches; ++s) {
        const std::size_t from = s * n / stretches, to = (s + 1) * n / stretches;
        for (const std::vector<double> *column : columns) {
            std::size_t low = n, high = n;
            for (std::size_t i = from; i < to; ++i) {
                const double v = (*column)[i];
                if (std::isnan(v)) continue;
                if (low == n || v < (*column)[low]) low = i;
                if (high == n || v > (*column)[high]) high = i;
            }
            if (low < n) kept.push_back(low), kept.push_back(high);
        }
    }
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    return kept;
}

SeriesRows rows_to_show(const BalanceComparison &b, std::size_t most) {
    std::vector<double> residual, residual_after;
    std::vector<const std::vector<double> *> columns = {&b.measured, &b.model, &residual};
    for (std::size_t i = 0; i < b.measured.size(); ++i) residual.push_back(b.measured[i] - b.model[i]);
    for (std::size_t i = 0; i < b.after.size(); ++i) residual_after.push_back(b.measured[i] - b.after[i]);
    if (!b.after.empty()) columns.push_back(&b.after), columns.push_back(&residual_after);
    SeriesRows rows;
    for (const std::size_t i : extremes_of(columns, most)) {
        rows.t_s.push_back(std::round(b.t_s[i] * 1e4) / 1e4);
        rows.measured.push_back(rounded(b.measured[i], 7)), rows.model.push_back(rounded(b.model[i], 7));
        if (!b.after.empty()) rows.after.push_back(rounded(b.after[i], 7));
    }
    return rows;
}

} // namespace traction::lab
