#include "windows.h"

#include <algorithm>

namespace traction::lab {

void Windows::add_row(double x0, double x1) {
    const std::size_t most = data_->count - 2;
    const auto i0 = std::min(static_cast<std::size_t>(x0), most), i1 = std::min(static_cast<std::size_t>(x1), most);
    const double f0 = x0 - static_cast<double>(i0), f1 = x1 - static_cast<double>(i1), width = x1 - x0;
    row_.push_back({i0, weight_.size(), i1 - i0 + 2});
    weight_.resize(weight_.size() + i1 - i0 + 2, 0);
    double *w = &weight_[row_.back().weight];
    if (width < 1e-6) {
        w[0] = 1 - f0, w[1] = f0;
        row_.back().count = 2;
        return;
    }
    for (std::size_t i = 0; i < i1 - i0; ++i) w[i] += 0.5, w[i + 1] += 0.5;
    w[i1 - i0] += f1 - 0.5 * f1 * f1, w[i1 - i0 + 1] += 0.5 * f1 * f1;
    w[0] -= f0 - 0.5 * f0 * f0, w[1] -= 0.5 * f0 * f0;
    for (std::size_t i = 0; i < i1 - i0 + 2; ++i) w[i] /= width;
}

void Windows::build(double delay_s) {
    const double last = static_cast<double>(data_->count - 1);
    row_.clear();
    weight_.clear();
    for (std::size_t r = 0; r < balance_->measured.size(); ++r)
        add_row(std::clamp((balance_->t0_s[r] - delay_s - data_->start_s) / data_->step_s, 0.0, last),
                std::clamp((balance_->t1_s[r] - delay_s - data_->start_s) / data_->step_s, 0.0, last));
    delay_s_ = delay_s;
    built_ = true;
}

void Windows::mean(const std::vector<double> &series, double delay_s, bool adding, Eigen::Ref<Eigen::VectorXd> out) {
    if (!built_ || delay_s != delay_s_) build(delay_s);
    for (std::size_t r = 0; r < row_.size(); ++r) {
        const Row &row = row_[r];
        const double *s = &series[row.first], *w = &weight_[row.weight];
        double sum = 0;
        for (std::size_t i = 0; i < row.count; ++i) sum += w[i] * s[i];
        double &to = out[static_cast<Eigen::Index>(r)];
        to = adding ? to + sum : sum;
    }
}

} // namespace traction::lab
