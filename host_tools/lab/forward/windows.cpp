#include "windows.h"

#include <algorithm>
#include <utility>

namespace traction::lab {

void Windows::add_row(double x0, double x1, Weights &to) const {
    const std::size_t most = data_->count - 2;
    const auto i0 = std::min(static_cast<std::size_t>(x0), most), i1 = std::min(static_cast<std::size_t>(x1), most), n = i1 - i0;
    const double f0 = x0 - static_cast<double>(i0), f1 = x1 - static_cast<double>(i1), width = x1 - x0;
    const bool narrow = width < 1e-6;
    to.row.push_back({i0, to.weight.size(), narrow ? 2 : n + 2});
    to.weight.resize(to.weight.size() + n + 2, 1);
    double *w = &to.weight[to.row.back().weight];
    if (narrow) {
        w[0] = 1 - f0, w[1] = f0;
        return;
    }
    w[0] = n > 0 ? 0.5 : 0, w[n] = w[0], w[n + 1] = 0;
    w[n] += f1 - 0.5 * f1 * f1, w[n + 1] += 0.5 * f1 * f1;
    w[0] -= f0 - 0.5 * f0 * f0, w[1] -= 0.5 * f0 * f0;
    for (std::size_t i = 0; i < n + 2; ++i) w[i] /= width;
}

std::shared_ptr<const Windows::Weights> Windows::build(double delay_s) const {
    const double last = static_cast<double>(data_->count - 1);
    const auto made = std::make_shared<Weights>();
    Weights &to = *made;
    const std::size_t known = before_ ? before_->weight.size() : 0;
    to.row.reserve(balance_->measured.size());
    to.weight.reserve(known > 0 ? known + known / 16 : 4 * balance_->measured.size());
    for (std::size_t r = 0; r < balance_->measured.size(); ++r)
        add_row(std::clamp((balance_->t0_s[r] - delay_s - data_->start_s) / data_->step_s, 0.0, last),
                std::clamp((balance_->t1_s[r] - delay_s - data_->start_s) / data_->step_s, 0.0, last), to);
    to.delay_s = delay_s;
    return made;
}

void Windows::mean(const std::vector<double> &series, double delay_s, bool adding, Eigen::Ref<Eigen::VectorXd> out) {
    if (!now_ || delay_s != now_->delay_s) {
        std::swap(now_, before_);
        if (!now_ || delay_s != now_->delay_s) now_ = build(delay_s);
    }
    for (std::size_t r = 0; r < now_->row.size(); ++r) {
        const Row &row = now_->row[r];
        const double *s = &series[row.first], *w = &now_->weight[row.weight];
        double sum = 0;
        for (std::size_t i = 0; i < row.count; ++i) sum += w[i] * s[i];
        double &to = out[static_cast<Eigen::Index>(r)];
        to = adding ? to + sum : sum;
    }
}

} // namespace traction::lab
