#include "screen.h"

#include "distribution.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace traction::lab {

namespace {
constexpr double heldout_block_s = 5.0; // LAB.md section 2
constexpr double test_block_s = 2.5;
constexpr double fewest_blocks = 10;    // shorter logs are cut finer
constexpr double most_heldout = 4;      // a block's held-out error counts up to so many times its error in the fit: beyond, the linear
                                        // step that leaves it out is not to be believed
} // namespace

Screen::Screen(const Problem &problem, Eigen::Index leading) : problem_(problem) {
    const Dataset &data = problem.data();
    std::vector<double> time;
    for (const Balance &b : data.balance)
        for (std::size_t r = 0; r < b.measured.size(); ++r) time.push_back(0.5 * (b.t0_s[r] + b.t1_s[r]));
    order_.resize(time.size());
    std::iota(order_.begin(), order_.end(), Eigen::Index{0});
    std::stable_sort(order_.begin(), order_.end(), [&](Eigen::Index a, Eigen::Index b) { return time[static_cast<std::size_t>(a)] < time[static_cast<std::size_t>(b)]; });
    const auto rows = static_cast<Eigen::Index>(order_.size()), n = leading < 0 ? problem.theta.size() : leading;
    const Eigen::VectorXd theta = problem.theta.head(n);
    nuisance_.resize(rows, n);
    residual_.resize(rows);
    row_time_.resize(order_.size());
    for (Eigen::Index i = 0; i < rows; ++i) {
        const Eigen::Index row = order_[static_cast<std::size_t>(i)];
        nuisance_.row(i) = problem.jacobian.row(row).head(n);
        residual_[i] = problem.residual[row] * problem.row_scale[row];
        row_time_[static_cast<std::size_t>(i)] = time[static_cast<std::size_t>(row)];
    }
    precision_ = problem.prior_precision().head(n);
    // a parameter that the data do not see and no prior holds would make the system singular: a whisper holds it
    for (Eigen::Index j = 0; j < n; ++j) precision_[j] = std::max(precision_[j], 1e-9 * (1 + nuisance_.col(j).squaredNorm()));
    pull_ = -precision_.cwiseProduct(theta);
    total_ = nuisance_.transpose() * nuisance_;
    total_.diagonal() += precision_;
    total_factor_.compute(total_);
    cut(data.independent_rows ? data.step_s : std::min(test_block_s, data.duration_s / (2 * fewest_blocks)), fine_, nullptr);
    cut(data.independent_rows ? data.step_s : std::min(heldout_block_s, data.duration_s / fewest_blocks), coarse_, &block_times_);

    block_error_.resize(coarse_.count());
    const Eigen::VectorXd moment = nuisance_.transpose() * residual_ + pull_;
    for (Eigen::Index b = 0; b < coarse_.count(); ++b) {
        const auto i = static_cast<std::size_t>(b);
        const Eigen::VectorXd step = coarse_.without[i].solve(moment - coarse_.moment[i]);
        const double rr = residual_.segment(coarse_.first[i], coarse_.first[i + 1] - coarse_.first[i]).squaredNorm();
        block_error_[b] = std::min(most_heldout * rr, rr - 2 * step.dot(coarse_.moment[i]) + step.dot(coarse_.gram[i] * step));
    }
    const Eigen::VectorXd final_theta = theta + total_factor_.solve(moment);
    base_penalty_ = final_theta.cwiseProduct(final_theta).dot(precision_);
    base_error_ = block_error_.sum() + base_penalty_;
    error_ = residual_.squaredNorm() + theta.cwiseAbs2().dot(precision_) - moment.dot(total_factor_.solve(moment));
}

void Screen::cut(double length_s, Blocks &blocks, std::vector<std::pair<double, double>> *times) const {
    const auto rows = static_cast<Eigen::Index>(row_time_.size());
    const double start = problem_.data().start_s;
    for (Eigen::Index i = 0; i < rows;) {
        const double block = std::floor((row_time_[static_cast<std::size_t>(i)] - start) / length_s + 1e-9);
        Eigen::Index j = i;
        while (j < rows && std::floor((row_time_[static_cast<std::size_t>(j)] - start) / length_s + 1e-9) == block) ++j;
        blocks.first.push_back(i);
        const auto N = nuisance_.middleRows(i, j - i);
        blocks.gram.push_back(N.transpose() * N);
        blocks.moment.push_back(N.transpose() * residual_.segment(i, j - i));
        if (times != nullptr) times->emplace_back(start + block * length_s, start + (block + 1) * length_s);
        i = j;
    }
    blocks.first.push_back(rows);
    for (const Eigen::MatrixXd &gram : blocks.gram) blocks.without.emplace_back(total_ - gram);
}

Assessment Screen::assess(const Eigen::MatrixXd &columns, const Eigen::VectorXd &present, bool full) const {
    Assessment out;
    const Eigen::Index k = columns.cols(), rows = columns.rows(), n = nuisance_.cols();
    Eigen::MatrixXd C(rows, k);
    for (Eigen::Index i = 0; i < rows; ++i) C.row(i) = columns.row(order_[static_cast<std::size_t>(i)]);
    const Eigen::VectorXd moment_n = nuisance_.transpose() * residual_ + pull_;

    struct Part {
        std::vector<Eigen::MatrixXd> nc, cc;
        std::vector<Eigen::VectorXd> mc;
    };
    const auto parts = [&](const Blocks &blocks) {
        Part part;
        for (std::size_t b = 0; b + 1 < blocks.first.size(); ++b) {
            const Eigen::Index first = blocks.first[b], size = blocks.first[b + 1] - first;
            const auto c = C.middleRows(first, size);
            part.nc.push_back(nuisance_.middleRows(first, size).transpose() * c);
            part.cc.push_back(c.transpose() * c);
            part.mc.push_back(c.transpose() * residual_.segment(first, size));
        }
        return part;
    };
    const Part fine = parts(fine_), coarse = parts(coarse_);
    Eigen::MatrixXd nc = Eigen::MatrixXd::Zero(n, k), cc = Eigen::MatrixXd::Zero(k, k);
    Eigen::VectorXd mc = Eigen::VectorXd::Zero(k);
    for (std::size_t b = 0; b < fine.nc.size(); ++b) nc += fine.nc[b], cc += fine.cc[b], mc += fine.mc[b];

    const Eigen::MatrixXd absorb = total_factor_.solve(nc); // what the baseline does in the candidate's stead
    Eigen::MatrixXd schur = cc - nc.transpose() * absorb;
    out.strength = Eigen::VectorXd::Zero(k);
    out.standard_error = Eigen::VectorXd::Constant(k, std::numeric_limits<double>::infinity());
    out.change = Eigen::VectorXd::Zero(n);
    out.block_gain = Eigen::VectorXd::Zero(coarse_.count());
    const double own = cc.trace();
    out.column_norm = std::sqrt(cc(0, 0));
    if (!(own > 0) || !(schur.diagonal().minCoeff() > 1e-9 * cc.diagonal().maxCoeff())) return out; // absorbed, or not seen at all
    out.information = schur.trace() / own;
    // a coefficient that the data barely see (a knot without samples) must not blow up
    for (Eigen::Index j = 0; j < k; ++j) schur(j, j) += 1e-9 * schur.diagonal().maxCoeff();
    const Eigen::LLT<Eigen::MatrixXd> schur_factor(schur);
    out.strength = schur_factor.solve(mc - absorb.transpose() * moment_n);
    out.fall = out.strength.dot(schur * out.strength);
    out.change = total_factor_.solve(moment_n - nc * out.strength);
    if (!out.strength.allFinite()) {
        out.strength.setZero();
        return out;
    }

    const auto leave_out = [&](const Blocks &blocks, const Part &part, std::size_t b, Eigen::VectorXd &gamma, Eigen::VectorXd &delta) {
        const Eigen::MatrixXd nc_b = nc - part.nc[b];
        const Eigen::VectorXd mn_b = moment_n - blocks.moment[b];
        const Eigen::MatrixXd a = blocks.without[b].solve(nc_b);
        Eigen::MatrixXd s = cc - part.cc[b] - nc_b.transpose() * a;
        for (Eigen::Index j = 0; j < k; ++j) s(j, j) += 1e-6 * schur(j, j);
        gamma = s.ldlt().solve(mc - part.mc[b] - a.transpose() * mn_b);
        delta = blocks.without[b].solve(mn_b - nc_b * gamma);
    };

    // jackknife over the fine blocks
    const Eigen::Index count = fine_.count();
    Eigen::MatrixXd deviation(k, count);
    Eigen::VectorXd gamma, delta, weight(count);
    for (Eigen::Index b = 0; b < count; ++b) {
        leave_out(fine_, fine, static_cast<std::size_t>(b), gamma, delta);
        deviation.col(b) = gamma - out.strength;
        const auto i = static_cast<std::size_t>(b);
        const Eigen::VectorXd a0 = absorb.col(0);
        weight[b] = std::max(0.0, fine.cc[i](0, 0) - 2 * a0.dot(fine.nc[i].col(0)) + a0.dot(fine_.gram[i] * a0));
    }
    const double scale = static_cast<double>(count - 1) / static_cast<double>(count);
    Eigen::MatrixXd covariance = scale * deviation * deviation.transpose();
    const Eigen::MatrixXd by_prior = schur_factor.solve(absorb.transpose()); // d strength / d (precision * prior mean)
    const Eigen::MatrixXd prior_part = by_prior * precision_.asDiagonal() * by_prior.transpose();
    const double blocks_that_inform = weight.squaredNorm() > 0 ? weight.sum() * weight.sum() / weight.squaredNorm() : 1;
    const double data_part = covariance.trace();
    covariance += prior_part;
    // never below what white residuals of unit scale would give
    const Eigen::MatrixXd least = schur_factor.solve(Eigen::MatrixXd::Identity(k, k));
    for (Eigen::Index j = 0; j < k; ++j)
        if (covariance(j, j) < 0.25 * least(j, j)) covariance(j, j) = 0.25 * least(j, j);
    const double share = covariance.trace() > 0 && data_part > 0 ? covariance.trace() / data_part : 1;
    // at least 5 after the strengths are counted: the jackknife is conservative already where one block carries the evidence (assumed; clean logs stay silent with it)
    const double freedom = std::clamp((blocks_that_inform - 1) * share * share, std::min(4.0 + static_cast<double>(k), static_cast<double>(count)), std::max(4.0 + static_cast<double>(k), static_cast<double>(count - 1)));
    out.standard_error = covariance.diagonal().cwiseSqrt();
    const Eigen::VectorXd whole = out.strength + present;
    const double wald = whole.dot(covariance.ldlt().solve(whole)) / static_cast<double>(k);
    const double left = std::max(1.0, freedom - static_cast<double>(k) + 1);
    out.p_value = f_tail(wald * left / std::max(freedom, left), static_cast<double>(k), left);
    out.freedom = freedom;

    // held-out error by the coarse blocks
    for (Eigen::Index b = 0; b < coarse_.count(); ++b) {
        const auto i = static_cast<std::size_t>(b);
        leave_out(coarse_, coarse, i, gamma, delta);
        const double rr = residual_.segment(coarse_.first[i], coarse_.first[i + 1] - coarse_.first[i]).squaredNorm();
        const double error = rr - 2 * delta.dot(coarse_.moment[i]) - 2 * gamma.dot(coarse.mc[i]) + delta.dot(coarse_.gram[i] * delta) +
                             2 * delta.dot(coarse.nc[i] * gamma) + gamma.dot(coarse.cc[i] * gamma);
        out.block_gain[b] = block_error_[b] - std::min(most_heldout * rr, error);
    }
    const Eigen::VectorXd final_theta = problem_.theta.head(n) + out.change;
    out.relief = base_penalty_ - final_theta.cwiseProduct(final_theta).dot(precision_);
    out.gain = out.block_gain.sum() + out.relief;
    const double mean = out.block_gain.mean();
    out.gain_error = std::sqrt((out.block_gain.array() - mean).square().sum() * static_cast<double>(coarse_.count()) / std::max<double>(1, static_cast<double>(coarse_.count() - 1)));
    out.strength = whole;
    if (full) {
        out.projected.resize(rows + n);
        out.projected.head(rows) = C.col(0) - nuisance_ * absorb.col(0);
        out.projected.tail(n) = -precision_.cwiseSqrt().cwiseProduct(absorb.col(0));
    }
    return out;
}

double Screen::error_absorbed(const Eigen::VectorXd &scaled_residual, Eigen::VectorXd &change) const {
    const Eigen::Index n = nuisance_.cols();
    const Eigen::VectorXd theta = problem_.theta.head(n), moment = problem_.jacobian.leftCols(n).transpose() * scaled_residual + pull_;
    change = total_factor_.solve(moment);
    return scaled_residual.squaredNorm() + theta.cwiseAbs2().dot(precision_) - moment.dot(change);
}

double Screen::best_balance_fall(const Eigen::MatrixXd &columns, const Assessment &step) const {
    const Dataset &data = problem_.data();
    const Eigen::VectorXd before = problem_.residual.cwiseProduct(problem_.row_scale);
    const Eigen::VectorXd after = before - columns * step.strength - problem_.jacobian.leftCols(nuisance_.cols()) * step.change;
    double best = 0;
    Eigen::Index first = 0;
    for (const Balance &balance : data.balance) {
        const auto n = static_cast<Eigen::Index>(balance.measured.size());
        const double squares = before.segment(first, n).squaredNorm();
        if (squares > 0) best = std::max(best, 1 - after.segment(first, n).squaredNorm() / squares);
        first += n;
    }
    return best;
}

std::vector<double> Screen::heldout_by_balance(bool in_noise) const {
    const Eigen::VectorXd noise = problem_.noise_rows();
    const Dataset &data = problem_.data();
    std::vector<double> sum(data.balance.size(), 0);
    std::vector<std::size_t> balance_of_row;
    for (std::size_t b = 0; b < data.balance.size(); ++b) balance_of_row.insert(balance_of_row.end(), data.balance[b].measured.size(), b);
    const std::vector<Eigen::VectorXd> changes = heldout_changes();
    for (Eigen::Index b = 0; b < coarse_.count(); ++b) {
        const auto i = static_cast<std::size_t>(b);
        const Eigen::Index first = coarse_.first[i], size = coarse_.first[i + 1] - first;
        const auto fitted = residual_.segment(first, size);
        const Eigen::VectorXd heldout = fitted - nuisance_.middleRows(first, size) * changes[i];
        const double shrink = std::min(1.0, std::sqrt(most_heldout * fitted.squaredNorm() / std::max(1e-300, heldout.squaredNorm())));
        for (Eigen::Index row = first; row < first + size; ++row) {
            double e = heldout[row - first] * shrink;
            const Eigen::Index original = order_[static_cast<std::size_t>(row)];
            if (in_noise) e /= problem_.row_scale[original] * noise[original];
            sum[balance_of_row[static_cast<std::size_t>(original)]] += e * e;
        }
    }
    return sum;
}

std::vector<Eigen::VectorXd> Screen::heldout_changes() const {
    const Eigen::VectorXd moment = nuisance_.transpose() * residual_ + pull_;
    std::vector<Eigen::VectorXd> changes;
    for (std::size_t b = 0; b < coarse_.gram.size(); ++b) changes.push_back(coarse_.without[b].solve(moment - coarse_.moment[b]));
    return changes;
}

std::vector<ParameterError> Screen::parameter_errors() const {
    // what is correlated over more than a short block widens the error by long ones, whose fewer degrees of freedom widen the quantile
    std::vector<ParameterError> errors = parameter_errors_by(fine_);
    const std::vector<ParameterError> by_long = parameter_errors_by(coarse_);
    for (std::size_t j = 0; j < errors.size(); ++j)
        if (by_long[j].reach > errors[j].reach) errors[j] = by_long[j];
    return errors;
}

std::vector<ParameterError> Screen::parameter_errors_by(const Blocks &blocks_of) const {
    const Eigen::Index n = nuisance_.cols(), count = blocks_of.count();
    const Eigen::VectorXd moment = nuisance_.transpose() * residual_ + pull_;
    const Eigen::VectorXd whole = total_factor_.solve(moment);
    const Eigen::MatrixXd inverse = total_factor_.solve(Eigen::MatrixXd::Identity(n, n));
    Eigen::MatrixXd deviation(n, count), information(n, count); // information: of a parameter beside the others, per block
    for (Eigen::Index b = 0; b < count; ++b) {
        const auto i = static_cast<std::size_t>(b);
        deviation.col(b) = blocks_of.without[i].solve(moment - blocks_of.moment[i]) - whole;
        information.col(b) = (inverse * blocks_of.gram[i]).cwiseProduct(inverse).rowwise().sum();
    }
    std::vector<ParameterError> errors;
    for (Eigen::Index j = 0; j < n; ++j) {
        const double by_data = deviation.row(j).squaredNorm() * static_cast<double>(count - 1) / static_cast<double>(count);
        const double by_prior = inverse.row(j).cwiseAbs2().dot(precision_); // d theta / d prior mean = inverse * precision
        const double all = std::max(by_data + by_prior, 0.25 * inverse(j, j));
        const double blocks = information.row(j).squaredNorm() > 0 ? std::pow(information.row(j).sum(), 2) / information.row(j).squaredNorm() : 1;
        const double share = by_data > 0 ? (by_data + by_prior) / by_data : 1e3;
        const double freedom = std::clamp((blocks - 1) * share * share, 4.0, 1e3);
        errors.push_back({std::sqrt(all), t_quantile(0.05, freedom) * std::sqrt(all)});
    }
    return errors;
}

} // namespace traction::lab
