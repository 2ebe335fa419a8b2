#include "information.h"

#include "host_tools/lab/fit/normal_equations.h"
#include "host_tools/lab/inputs/smooth.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace {

constexpr double longest_lag_s = 2.5; // the length of the screening's test blocks

// 1 + 2 sum rho_k up to the first that is not positive (initial positive sequence).
double design_effect(const Eigen::VectorXd &e, double spacing_s) {
    const Eigen::Index n = e.size();
    const double variance = e.squaredNorm();
    if (n < 20 || !(variance > 0) || !(spacing_s > 0)) return 1;
    const auto lags = std::min<Eigen::Index>(n / 4, static_cast<Eigen::Index>(longest_lag_s / spacing_s));
    double sum = 1;
    for (Eigen::Index k = 1; k <= lags; ++k) {
        const double rho = e.head(n - k).dot(e.tail(n - k)) / variance;
        if (rho <= 0) break;
        sum += 2 * rho * (1 - static_cast<double>(k) / static_cast<double>(n));
    }
    return sum;
}

double spacing_of(const Balance &balance) {
    std::vector<double> steps;
    for (std::size_t r = 1; r < balance.t0_s.size(); ++r) steps.push_back(balance.t0_s[r] - balance.t0_s[r - 1]);
    return median(steps);
}

Eigen::Index first_column(const std::vector<SizedCandidate> &candidates, Eigen::Index parameters, int which) {
    Eigen::Index at = parameters;
    for (int i = 0; i < which; ++i) at += static_cast<Eigen::Index>(candidates[static_cast<std::size_t>(i)].size.size());
    return at;
}

} // namespace

std::map<std::string, double> scale_over_noise(const Problem &problem) {
    std::map<std::string, double> scale;
    const Eigen::VectorXd noise = problem.noise_rows();
    const Eigen::VectorXd in_noise = problem.row_scale.cwiseProduct(noise).cwiseInverse(); // J as rows in units of noise
    const Eigen::MatrixXd J = in_noise.asDiagonal() * problem.jacobian;
    Eigen::MatrixXd normal = J.transpose() * J;
    normal.diagonal() += problem.prior_precision();
    normal.diagonal() *= 1 + 1e-9;
    const Eigen::VectorXd raw = problem.residual.cwiseQuotient(noise);
    const Eigen::VectorXd left =
        raw - J * solve_normal(normal, J.transpose() * raw - problem.prior_precision().cwiseProduct(problem.theta));
    Eigen::Index first = 0;
    for (const Balance &balance : problem.data().balance) {
        const auto n = static_cast<Eigen::Index>(balance.measured.size());
        Eigen::VectorXd e = left.segment(first, n);
        std::vector<double> size(e.data(), e.data() + n);
        for (double &x : size) x = std::fabs(x);
        const double cut = 4 * std::max(1.0, 1.4826 * median(size)); // the largest count as four robust deviations
        e = e.cwiseMax(-cut).cwiseMin(cut);
        const double mean_square = n > 0 ? e.squaredNorm() / static_cast<double>(n) : 1;
        scale[balance.name] = std::sqrt(std::max(1.0, mean_square) * design_effect(e, spacing_of(balance)));
        first += n;
    }
    return scale;
}

Eigen::MatrixXd fisher_information(Problem &problem, const std::map<std::string, double> &scale,
                                   const std::vector<SizedCandidate> &candidates) {
    const Eigen::VectorXd before = problem.row_scale;
    problem.row_scale = problem.noise_rows().cwiseInverse();
    Eigen::Index first = 0;
    for (const Balance &balance : problem.data().balance) {
        const auto n = static_cast<Eigen::Index>(balance.measured.size());
        if (const auto found = scale.find(balance.name); found != scale.end()) problem.row_scale.segment(first, n) /= found->second;
        first += n;
    }
    problem.jacobian = problem.row_scale.cwiseQuotient(before).asDiagonal() * problem.jacobian;
    const Eigen::Index parameters = problem.theta.size(), all = first_column(candidates, parameters, static_cast<int>(candidates.size()));
    Eigen::MatrixXd X(problem.row_scale.size(), all + 1);
    X.col(all) = problem.residual.cwiseProduct(problem.row_scale);
    X.leftCols(parameters) = problem.jacobian;
    Eigen::Index column = parameters;
    for (const SizedCandidate &s : candidates)
        for (std::size_t j = 0; j < s.size.size(); ++j) {
            Physics at = problem.physics();
            s.candidate.prepare(at);
            X.col(column++) = problem.column(at, s.candidate.strengths[j], s.size[j]);
        }
    return X.transpose() * X;
}

namespace {

// A at its size, and any column, orthogonal to the parameters and the rival: the Schur complement of their block.
struct SchurComplement {
    double own = 0;  // square of A
    double with = 0; // A times the column
};

SchurComplement schur_complement(const Eigen::MatrixXd &gram, const Eigen::VectorXd &precision,
                                 const std::vector<SizedCandidate> &candidates, int truth, int rival, Eigen::Index column) {
    const Eigen::Index parameters = precision.size();
    std::vector<Eigen::Index> rest;
    for (Eigen::Index i = 0; i < parameters; ++i) rest.push_back(i);
    if (rival >= 0)
        for (std::size_t j = 0; j < candidates[static_cast<std::size_t>(rival)].size.size(); ++j)
            rest.push_back(first_column(candidates, parameters, rival) + static_cast<Eigen::Index>(j));
    const SizedCandidate &true_one = candidates[static_cast<std::size_t>(truth)];
    const Eigen::Index at = first_column(candidates, parameters, truth), k = static_cast<Eigen::Index>(true_one.size.size());
    const Eigen::VectorXd g = Eigen::Map<const Eigen::VectorXd>(true_one.size.data(), k);
    Eigen::MatrixXd R = gram(rest, rest);
    R.diagonal().head(parameters) += precision;
    const Eigen::VectorXd unit = R.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse(); // parameters' units differ by decades
    R = unit.asDiagonal() * R * unit.asDiagonal();
    R.diagonal().array() += 1e-9; // a parameter that nothing sees stays where it is
    const Eigen::LDLT<Eigen::MatrixXd> factor(R);
    Eigen::VectorXd cross = Eigen::VectorXd::Zero(R.rows()); // gram(rest, seqN(at, k)) * g, in which gcc 14 sees a bound that is not there
    for (Eigen::Index j = 0; j < k; ++j) cross += g[j] * gram.col(at + j)(rest);
    cross = unit.cwiseProduct(cross).eval();
    const Eigen::VectorXd projection = factor.solve(cross);
    SchurComplement out{std::max(0.0, g.dot(gram.block(at, at, k, k) * g) - cross.dot(projection)), 0};
    if (column >= 0) out.with = g.dot(gram.block(at, column, k, 1).col(0)) - projection.dot(unit.cwiseProduct(gram.col(column)(rest)));
    return out;
}

} // namespace

double detectability(const Eigen::MatrixXd &gram, const Eigen::VectorXd &precision, const std::vector<SizedCandidate> &candidates,
                     int truth, int rival) {
    return std::sqrt(schur_complement(gram, precision, candidates, truth, rival, -1).own);
}

double score_statistic(const Eigen::MatrixXd &gram, const Eigen::VectorXd &precision, const std::vector<SizedCandidate> &candidates,
                       int truth, int rival) {
    const SchurComplement u = schur_complement(gram, precision, candidates, truth, rival, gram.cols() - 1);
    return u.own > 0 ? std::fabs(u.with) / std::sqrt(u.own) : 0;
}

} // namespace traction::lab
