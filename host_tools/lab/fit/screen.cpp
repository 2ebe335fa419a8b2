#include "screen.h"

#include "distribution.h"
#include "normal_equations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace traction::lab {

namespace {
constexpr double heldout_block_s = 5.0; // docs/evidence.md section 4
constexpr double test_block_s = 2.5;
constexpr double fewest_blocks = 10; // shorter logs are cut finer
constexpr double most_heldout = 4;   // a block's held-out error counts up to so many times its error in the fit: beyond, the linear
                                     // step that leaves it out is not to be believed
} // namespace

double sum_error(const Eigen::VectorXd &of_blocks) {
    const double n = static_cast<double>(of_blocks.size());
    return std::sqrt((of_blocks.array() - of_blocks.mean()).square().sum() * n / std::max(1.0, n - 1));
}

Screen::Screen(const Problem &problem, Eigen::Index leading) : problem_(problem) {
    const Eigen::Index n = leading < 0 ? problem.theta.size() : leading;
    const Eigen::VectorXd theta = problem.theta.head(n);
    nuisance_ = problem.jacobian.leftCols(n);
    sparse_ = SparseJacobian(problem.data(), nuisance_);
    residual_ = problem.residual.cwiseProduct(problem.row_scale);
    precision_ = problem.prior_precision().head(n);
    alike_ = problem.alike().head(n);
    // a parameter that the data do not see and no prior holds would make the system singular: a ridge (Tikhonov) holds it
    for (Eigen::Index j = 0; j < n; ++j) precision_[j] = std::max(precision_[j], 1e-9 * (1 + nuisance_.col(j).squaredNorm()));
    pull_ = -precision_.cwiseProduct(theta);
    bias_ = problem.smoothing_bias_rows().cwiseProduct(problem.row_scale);
    bias_moment_ = sparse_.moment(bias_);
    cut();
    total_ = precision_.asDiagonal();
    moment_ = pull_;
    for (std::size_t b = 0; b < coarse_.gram.size(); ++b) total_ += coarse_.gram[b], moment_ += coarse_.moment[b];
    total_factor_.compute(total_);
    factor(fine_);
    factor(coarse_);

    block_error_.resize(coarse_.count());
    for (Eigen::Index b = 0; b < coarse_.count(); ++b) {
        const auto i = static_cast<std::size_t>(b);
        const Eigen::VectorXd step = coarse_.without[i].matrixU().solve(coarse_.half[i]);
        const double rr = coarse_.squares[i];
        block_error_[b] = std::min(most_heldout * rr, rr - 2 * step.dot(coarse_.moment[i]) + step.dot(coarse_.gram[i] * step));
    }
    const Eigen::VectorXd step = total_factor_.solve(moment_), final_theta = theta + step;
    base_penalty_ = final_theta.cwiseProduct(final_theta).dot(precision_);
    base_deviations_ = final_theta.cwiseProduct(final_theta).dot(precision_.cwiseQuotient(alike_));
    base_error_ = block_error_.sum() + base_penalty_;
    noise_squares_ = problem.noise_rows().cwiseProduct(problem.row_scale).squaredNorm();
    error_ = residual_.squaredNorm() + theta.cwiseAbs2().dot(precision_) - moment_.dot(step);
}

// Blocks of both lengths, and what of the baseline each holds.
void Screen::cut() {
    const Dataset &data = problem_.data();
    const double start = data.start_s;
    const double fine_s = data.independent_rows ? data.step_s : std::min(test_block_s, data.duration_s / (2 * fewest_blocks));
    const double coarse_s = data.independent_rows ? data.step_s : std::min(heldout_block_s, data.duration_s / fewest_blocks);
    std::map<double, std::size_t> fine, coarse;
    std::vector<std::pair<double, double>> place; // of each segment: its blocks
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < data.balance.size(); ++i) {
        const Balance &b = data.balance[i];
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) {
            const double time = 0.5 * (b.t0_s[r] + b.t1_s[r]) - start;
            const std::pair<double, double> here(std::floor(time / fine_s + 1e-9), std::floor(time / coarse_s + 1e-9));
            if (r == 0 || here != place.back()) {
                segments_.push_back({row, 0, i, 0, 0});
                place.push_back(here);
                fine[here.first] = coarse[here.second] = 0;
            }
            ++segments_.back().size;
        }
    }
    std::size_t count = 0;
    for (auto &[block, index] : fine) index = count++;
    count = 0;
    for (auto &[block, index] : coarse)
        index = count++, block_times_.emplace_back(start + block * coarse_s, start + (block + 1) * coarse_s);
    const Eigen::Index n = nuisance_.cols();
    for (Blocks *blocks : {&fine_, &coarse_}) {
        const std::size_t size = blocks == &fine_ ? fine.size() : coarse.size();
        blocks->gram.assign(size, Eigen::MatrixXd::Zero(n, n));
        blocks->moment.assign(size, Eigen::VectorXd::Zero(n));
        blocks->squares.assign(size, 0);
    }
    for (std::size_t i = 0; i < segments_.size(); ++i) {
        Segment &s = segments_[i];
        s.fine = fine.at(place[i].first), s.coarse = coarse.at(place[i].second);
        const SparseJacobian::Part &sparse = sparse_.parts()[s.balance];
        const auto N = sparse.value.middleRows(s.first - sparse.first, s.size);
        const auto r = residual_.segment(s.first, s.size);
        const Eigen::MatrixXd gram = N.transpose() * N;
        const Eigen::VectorXd moment = N.transpose() * r;
        fine_.gram[s.fine](sparse.column, sparse.column) += gram, coarse_.gram[s.coarse](sparse.column, sparse.column) += gram;
        fine_.moment[s.fine](sparse.column) += moment, coarse_.moment[s.coarse](sparse.column) += moment;
        fine_.squares[s.fine] += r.squaredNorm(), coarse_.squares[s.coarse] += r.squaredNorm();
    }
}

void Screen::factor(Blocks &blocks) const {
    for (std::size_t b = 0; b < blocks.gram.size(); ++b) {
        blocks.without.emplace_back(total_ - blocks.gram[b]);
        blocks.half.push_back(blocks.without[b].matrixL().solve(moment_ - blocks.moment[b]));
    }
}

void Screen::parts(const Eigen::MatrixXd &columns, Part &fine, Part &coarse) const {
    const Eigen::Index k = columns.cols();
    Eigen::VectorXd nc;
    for (const Segment &s : segments_) {
        const SparseJacobian::Part &sparse = sparse_.parts()[s.balance];
        const auto N = sparse.value.middleRows(s.first - sparse.first, s.size);
        const auto r = residual_.segment(s.first, s.size);
        for (Eigen::Index j = 0; j < k; ++j) {
            const auto c = columns.col(j).segment(s.first, s.size);
            if ((c.array() == 0).all()) continue; // most effects leave most balances alone
            nc.noalias() = N.transpose() * c;
            fine.nc[s.fine].col(j)(sparse.column) += nc, coarse.nc[s.coarse].col(j)(sparse.column) += nc;
            const double mc = c.dot(r);
            fine.mc[s.fine][j] += mc, coarse.mc[s.coarse][j] += mc;
            for (Eigen::Index i = 0; i <= j; ++i) {
                const double cc = c.dot(columns.col(i).segment(s.first, s.size));
                fine.cc[s.fine](i, j) += cc, coarse.cc[s.coarse](i, j) += cc;
                if (i != j) fine.cc[s.fine](j, i) += cc, coarse.cc[s.coarse](j, i) += cc;
            }
        }
    }
}

class Screen::LeaveOut {
  public:
    LeaveOut(const Blocks &blocks, const Part &part, const Eigen::MatrixXd &nc, const Eigen::MatrixXd &cc, const Eigen::VectorXd &mc,
             const Eigen::VectorXd &ridge)
        : blocks_(blocks), part_(part), nc_(nc), cc_(cc), mc_(mc), ridge_(ridge) {}

    const Eigen::VectorXd &strength(std::size_t b) {
        half_ = nc_ - part_.nc[b];
        blocks_.without[b].matrixL().solveInPlace(half_);
        schur_ = cc_ - part_.cc[b];
        schur_.noalias() -= half_.transpose() * half_;
        schur_.diagonal() += ridge_;
        gamma = mc_ - part_.mc[b];
        gamma.noalias() -= half_.transpose() * blocks_.half[b];
        if (gamma.size() == 1)
            gamma[0] /= schur_(0, 0);
        else
            gamma = factor_.compute(schur_).solve(gamma).eval();
        return gamma;
    }
    // Of the block left out, by the strength just found; the baseline's step without it included.
    double error(std::size_t b) {
        delta_ = blocks_.half[b];
        delta_.noalias() -= half_ * gamma;
        blocks_.without[b].matrixU().solveInPlace(delta_);
        return blocks_.squares[b] - 2 * delta_.dot(blocks_.moment[b]) - 2 * gamma.dot(part_.mc[b]) + delta_.dot(blocks_.gram[b] * delta_) +
               2 * delta_.dot(part_.nc[b] * gamma) + gamma.dot(part_.cc[b] * gamma);
    }
    Eigen::VectorXd gamma;

  private:
    const Blocks &blocks_;
    const Part &part_;
    const Eigen::MatrixXd &nc_, &cc_;
    const Eigen::VectorXd &mc_, &ridge_;
    Eigen::MatrixXd half_, schur_;
    Eigen::VectorXd delta_;
    Eigen::LDLT<Eigen::MatrixXd> factor_;
};

Assessment Screen::assess(const Eigen::MatrixXd &columns, const Eigen::VectorXd &present, bool full) const {
    Assessment out;
    const Eigen::Index k = columns.cols(), n = nuisance_.cols();
    Part fine(fine_.gram.size(), n, k), coarse(coarse_.gram.size(), n, k);
    parts(columns, fine, coarse);
    Eigen::MatrixXd nc = Eigen::MatrixXd::Zero(n, k), cc = Eigen::MatrixXd::Zero(k, k);
    Eigen::VectorXd mc = Eigen::VectorXd::Zero(k);
    for (std::size_t b = 0; b < fine.nc.size(); ++b) nc += fine.nc[b], cc += fine.cc[b], mc += fine.mc[b];

    const Eigen::MatrixXd projection = total_factor_.solve(nc); // coefficients of the candidate's projection onto the nuisance parameters
    Eigen::MatrixXd schur = cc - nc.transpose() * projection;
    out.strength = Eigen::VectorXd::Zero(k);
    out.standard_error = Eigen::VectorXd::Constant(k, std::numeric_limits<double>::infinity());
    out.change = Eigen::VectorXd::Zero(n);
    out.block_gain = Eigen::VectorXd::Zero(coarse_.count());
    const double own = cc.trace();
    out.column_norm = std::sqrt(cc(0, 0));
    if (!(own > 0) || !(schur.diagonal().minCoeff() > 1e-9 * cc.diagonal().maxCoeff()))
        return out; // collinear with the nuisance parameters, or without effect
    out.information = schur.trace() / own;
    // a coefficient that the data barely see (a knot without samples) must not blow up
    for (Eigen::Index j = 0; j < k; ++j) schur(j, j) += 1e-9 * schur.diagonal().maxCoeff();
    const Eigen::LLT<Eigen::MatrixXd> schur_factor(schur);
    out.strength = schur_factor.solve(mc - projection.transpose() * moment_);
    out.error_reduction = out.strength.dot(schur * out.strength);
    out.change = total_factor_.solve(moment_ - nc * out.strength);
    if (!out.strength.allFinite()) {
        out.strength.setZero();
        return out;
    }

    const Eigen::VectorXd ridge = 1e-6 * schur.diagonal();
    // jackknife over the fine blocks
    const Eigen::Index count = fine_.count();
    Eigen::MatrixXd deviation(k, count);
    Eigen::VectorXd weight(count);
    const Eigen::VectorXd a0 = projection.col(0);
    LeaveOut without_fine(fine_, fine, nc, cc, mc, ridge);
    for (Eigen::Index b = 0; b < count; ++b) {
        const auto i = static_cast<std::size_t>(b);
        deviation.col(b) = without_fine.strength(i) - out.strength;
        weight[b] = std::max(0.0, fine.cc[i](0, 0) - 2 * a0.dot(fine.nc[i].col(0)) + a0.dot(fine_.gram[i] * a0));
    }
    const double scale = static_cast<double>(count - 1) / static_cast<double>(count);
    Eigen::MatrixXd covariance = scale * deviation * deviation.transpose();
    const Eigen::MatrixXd by_prior = schur_factor.solve(projection.transpose()); // d strength / d (precision * prior mean)
    const Eigen::MatrixXd prior_part = by_prior * precision_.cwiseProduct(alike_).asDiagonal() * by_prior.transpose();
    const double effective_blocks = weight.squaredNorm() > 0 ? weight.sum() * weight.sum() / weight.squaredNorm() : 1;
    const double data_part = covariance.trace();
    covariance += prior_part;
    const Eigen::VectorXd by_bias = schur_factor.solve(
        columns.transpose() * bias_ - projection.transpose() * bias_moment_); // what the bias of the smoothing alone would pass for
    covariance += by_bias * by_bias.transpose();
    // never below what white residuals of unit scale would give
    const Eigen::MatrixXd least = schur_factor.solve(Eigen::MatrixXd::Identity(k, k));
    for (Eigen::Index j = 0; j < k; ++j)
        if (covariance(j, j) < 0.25 * least(j, j)) covariance(j, j) = 0.25 * least(j, j);
    const double share = covariance.trace() > 0 && data_part > 0 ? covariance.trace() / data_part : 1;
    // at least 5 after the strengths are counted: the jackknife is conservative already where one block carries the evidence (assumed;
    // clean logs stay silent with it)
    const double freedom =
        std::clamp((effective_blocks - 1) * share * share, std::min(4.0 + static_cast<double>(k), static_cast<double>(count)),
                   std::max(4.0 + static_cast<double>(k), static_cast<double>(count - 1)));
    out.standard_error = covariance.diagonal().cwiseSqrt();
    const Eigen::VectorXd whole = out.strength + present;
    const double wald = whole.dot(solve_normal(covariance, whole)) / static_cast<double>(k);
    const double left = std::max(1.0, freedom - static_cast<double>(k) + 1);
    out.p_value = f_tail(wald * left / std::max(freedom, left), static_cast<double>(k), left);
    out.freedom = freedom;

    // held-out error by the coarse blocks
    LeaveOut without_coarse(coarse_, coarse, nc, cc, mc, ridge);
    for (Eigen::Index b = 0; b < coarse_.count(); ++b) {
        const auto i = static_cast<std::size_t>(b);
        without_coarse.strength(i);
        const double rr = coarse_.squares[i], error = without_coarse.error(i);
        out.block_gain[b] = block_error_[b] - std::min(most_heldout * rr, error);
    }
    const Eigen::VectorXd final_theta = problem_.theta.head(n) + out.change;
    out.prior_reduction = base_penalty_ - final_theta.cwiseProduct(final_theta).dot(precision_);
    out.spared = base_deviations_ - final_theta.cwiseProduct(final_theta).dot(precision_.cwiseQuotient(alike_));
    out.gain = out.block_gain.sum() + out.prior_reduction;
    out.gain_error = sum_error(out.block_gain);
    out.strength = whole;
    if (full) out.projected = projected(columns.col(0), a0);
    return out;
}

Eigen::VectorXd Screen::projected(const Eigen::VectorXd &column) const {
    return projected(column, total_factor_.solve(sparse_.moment(column)));
}

Eigen::VectorXd Screen::projected(const Eigen::VectorXd &column, const Eigen::VectorXd &projection) const {
    Eigen::VectorXd out(column.size() + projection.size());
    out << column - nuisance_ * projection, -precision_.cwiseSqrt().cwiseProduct(projection);
    return out;
}

double Screen::profiled_error(const Eigen::VectorXd &scaled_residual, Eigen::VectorXd &change) const {
    const Eigen::Index n = nuisance_.cols();
    const Eigen::VectorXd theta = problem_.theta.head(n), moment = sparse_.moment(scaled_residual) + pull_;
    change = total_factor_.solve(moment);
    return scaled_residual.squaredNorm() + theta.cwiseAbs2().dot(precision_) - moment.dot(change);
}

bool Screen::leaves_active_set(const Eigen::VectorXd &change) const {
    for (Eigen::Index i = 0; i < nuisance_.cols(); ++i) {
        const double theta = problem_.theta[i], prior = problem_.parameters[static_cast<std::size_t>(i)].prior;
        if (prior > 0 && problem_.at_bound(static_cast<std::size_t>(i)) && theta * change[i] < 0 && std::fabs(change[i]) > prior)
            return true;
    }
    return false;
}

double Screen::best_balance_fall(const Eigen::MatrixXd &columns, const Assessment &step) const {
    const Dataset &data = problem_.data();
    const Eigen::VectorXd before = problem_.residual.cwiseProduct(problem_.row_scale);
    const Eigen::VectorXd after = before - columns * step.strength - nuisance_ * step.change;
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
    if (!in_noise && !heldout_of_balance_.empty()) return heldout_of_balance_;
    const Eigen::VectorXd noise = problem_.noise_rows();
    const Dataset &data = problem_.data();
    std::vector<double> sum(data.balance.size(), 0);
    std::vector<std::size_t> balance_of_row;
    for (std::size_t b = 0; b < data.balance.size(); ++b) balance_of_row.insert(balance_of_row.end(), data.balance[b].measured.size(), b);
    const std::vector<Eigen::VectorXd> changes = heldout_changes();
    Eigen::VectorXd heldout(residual_.size());
    std::vector<double> squares(coarse_.gram.size(), 0);
    for (const Segment &s : segments_) {
        heldout.segment(s.first, s.size) = residual_.segment(s.first, s.size) - nuisance_.middleRows(s.first, s.size) * changes[s.coarse];
        squares[s.coarse] += heldout.segment(s.first, s.size).squaredNorm();
    }
    for (const Segment &s : segments_) {
        const double shrink = std::min(1.0, std::sqrt(most_heldout * coarse_.squares[s.coarse] / std::max(1e-300, squares[s.coarse])));
        for (Eigen::Index row = s.first; row < s.first + s.size; ++row) {
            double e = heldout[row] * shrink;
            if (in_noise) e /= problem_.row_scale[row] * noise[row];
            sum[balance_of_row[static_cast<std::size_t>(row)]] += e * e;
        }
    }
    if (!in_noise) heldout_of_balance_ = sum;
    return sum;
}

std::vector<Eigen::VectorXd> Screen::heldout_changes() const {
    std::vector<Eigen::VectorXd> changes;
    for (std::size_t b = 0; b < coarse_.gram.size(); ++b) changes.push_back(coarse_.without[b].matrixU().solve(coarse_.half[b]));
    return changes;
}

std::vector<ParameterError> Screen::parameter_errors() const {
    return errors_of(Eigen::MatrixXd::Identity(nuisance_.cols(), nuisance_.cols()));
}

std::vector<ParameterError> Screen::errors_of(const Eigen::MatrixXd &weights) const {
    // what is correlated over more than a short block widens the error by long ones, whose fewer degrees of freedom widen the quantile
    std::vector<ParameterError> errors = errors_by(fine_, weights);
    const std::vector<ParameterError> by_long = errors_by(coarse_, weights);
    for (std::size_t j = 0; j < errors.size(); ++j)
        if (by_long[j].half_width > errors[j].half_width) errors[j] = by_long[j];
    return errors;
}

std::vector<ParameterError> Screen::errors_by(const Blocks &blocks_of, const Eigen::MatrixXd &weights) const {
    const Eigen::Index n = weights.rows(), count = blocks_of.count();
    const Eigen::VectorXd whole = total_factor_.solve(moment_);
    const Eigen::MatrixXd inverse = total_factor_.solve(weights.transpose()).transpose(); // of W A^-1, a row per sum
    const Eigen::VectorXd by_bias = inverse * bias_moment_;
    Eigen::MatrixXd deviation(n, count), information(n, count); // information: of a parameter beside the others, per block
    for (Eigen::Index b = 0; b < count; ++b) {
        const auto i = static_cast<std::size_t>(b);
        deviation.col(b) = weights * (blocks_of.without[i].matrixU().solve(blocks_of.half[i]) - whole);
        information.col(b) = (inverse * blocks_of.gram[i]).cwiseProduct(inverse).rowwise().sum();
    }
    std::vector<ParameterError> errors;
    for (Eigen::Index j = 0; j < n; ++j) {
        const double by_data = deviation.row(j).squaredNorm() * static_cast<double>(count - 1) / static_cast<double>(count);
        const double by_prior =
            inverse.row(j).cwiseAbs2().dot(precision_.cwiseProduct(alike_)); // d theta / d prior mean = inverse * precision
        const double all = std::max(by_data + by_prior, 0.25 * inverse.row(j).dot(weights.row(j))) + by_bias[j] * by_bias[j];
        const double blocks =
            information.row(j).squaredNorm() > 0 ? std::pow(information.row(j).sum(), 2) / information.row(j).squaredNorm() : 1;
        const double share = by_data > 0 ? (by_data + by_prior) / by_data : 1e3;
        const double freedom = std::clamp((blocks - 1) * share * share, 4.0, 1e3);
        errors.push_back({std::sqrt(all), t_quantile(0.05, freedom) * std::sqrt(all)});
    }
    return errors;
}

} // namespace traction::lab
