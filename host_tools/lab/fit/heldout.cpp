#include "heldout.h"

#include "screen.h"
#include "sparse_jacobian.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace traction::lab {

namespace {

constexpr double block_s = 5.0, fewest_refit_blocks = 10;
constexpr std::size_t most_parts = 10;
constexpr int steps = 3, halvings = 3;
constexpr double worth = 0.1; // fall of the squares below which a step is the last

void cut(const Dataset &data, HeldOut &out) {
    const double length = data.independent_rows ? data.step_s : std::min(block_s, data.duration_s / fewest_refit_blocks);
    std::map<double, std::size_t> known;
    std::vector<double> place;
    for (const Balance &b : data.balance)
        for (std::size_t r = 0; r < b.measured.size(); ++r) {
            place.push_back(std::floor((0.5 * (b.t0_s[r] + b.t1_s[r]) - data.start_s) / length + 1e-9));
            known[place.back()] = 0;
        }
    for (auto &[at, index] : known) index = out.blocks++;
    for (const double at : place) out.block.push_back(known.at(at));
}

// Squares of the rows outside the part, and of the priors.
double squares(const Problem &problem, const Eigen::VectorXd &inside) {
    return problem.residual.cwiseProduct(problem.row_scale).cwiseAbs2().dot(inside) +
           problem.theta.cwiseAbs2().dot(problem.prior_precision());
}

void refit(Problem &problem, const SparseJacobian &sparse, const Eigen::MatrixXd &normal, const Eigen::VectorXd &inside) {
    double least = squares(problem, inside);
    const Eigen::VectorXd precision = problem.prior_precision();
    for (int i = 0; i < steps; ++i) {
        const Eigen::VectorXd before = problem.theta, residual = problem.residual;
        const Eigen::VectorXd moment = sparse.moment(problem.residual.cwiseProduct(problem.row_scale).cwiseProduct(inside));
        const Eigen::VectorXd step = problem.step_within_bounds(normal, moment - precision.cwiseProduct(problem.theta));
        double now = least, share = 1;
        for (int h = 0; h <= halvings; ++h, share *= 0.5) {
            problem.theta = before + share * step;
            problem.cost();
            now = squares(problem, inside);
            if (now < least) break;
        }
        if (!(now < least)) {
            problem.theta = before, problem.residual = residual;
            return;
        }
        const double fall = least - now;
        least = now;
        if (fall < worth) return;
    }
}

} // namespace

Eigen::VectorXd noise_weight(const Problem &problem) {
    Eigen::VectorXd weight = problem.noise_rows().cwiseAbs2().cwiseInverse();
    const auto balances = static_cast<double>(problem.data().balance.size());
    Eigen::Index first = 0;
    for (const Balance &b : problem.data().balance) {
        const auto n = static_cast<Eigen::Index>(b.measured.size());
        weight.segment(first, n) /= balances * static_cast<double>(n);
        first += n;
    }
    return weight;
}

HeldOut as_fitted(const Problem &fitted) {
    HeldOut out;
    cut(fitted.data(), out);
    out.residual = fitted.residual;
    out.error = std::sqrt(out.residual.cwiseAbs2().dot(noise_weight(fitted)));
    return out;
}

HeldOut held_out(const Problem &fitted) {
    HeldOut out = as_fitted(fitted);
    if (out.blocks < 2 || fitted.parameters.empty()) return out;
    Problem problem = fitted; // its forward model is moved about
    const SparseJacobian sparse(fitted.data(), fitted.jacobian);
    Eigen::MatrixXd whole = sparse.gram();
    const std::size_t parts = std::min(out.blocks, most_parts);
    for (std::size_t part = 0; part < parts; ++part) {
        Eigen::VectorXd inside = Eigen::VectorXd::Ones(fitted.residual.size()); // of what the refit sees
        for (Eigen::Index r = 0; r < inside.size(); ++r)
            if (out.block[static_cast<std::size_t>(r)] % parts == part) inside[r] = 0;
        const Eigen::VectorXd outside = Eigen::VectorXd::Ones(inside.size()) - inside;
        Eigen::MatrixXd normal = whole - sparse.gram(outside);
        normal.diagonal() += fitted.prior_precision() + 1e-9 * whole.diagonal() + Eigen::VectorXd::Constant(whole.rows(), 1e-12);
        problem.theta = fitted.theta, problem.residual = fitted.residual;
        refit(problem, sparse, normal, inside);
        out.residual = (inside.array() == 0).select(problem.residual, out.residual);
    }
    out.error = std::sqrt(out.residual.cwiseAbs2().dot(noise_weight(fitted)));
    return out;
}

namespace {

Fall over_blocks(const HeldOut &of, const Eigen::VectorXd &fall_of_row) {
    Fall fall;
    fall.of_block = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(of.blocks));
    for (Eigen::Index r = 0; r < fall_of_row.size(); ++r)
        fall.of_block[static_cast<Eigen::Index>(of.block[static_cast<std::size_t>(r)])] += fall_of_row[r];
    fall.sum = fall.of_block.sum();
    fall.error = sum_error(fall.of_block);
    return fall;
}

} // namespace

Fall fall_between(const HeldOut &before, const HeldOut &after, const Eigen::VectorXd &weight) {
    return over_blocks(before, (before.residual.cwiseAbs2() - after.residual.cwiseAbs2()).cwiseProduct(weight));
}

Eigen::VectorXd unlikelihood(const Problem &problem) {
    return problem.residual.cwiseProduct(problem.row_scale).cwiseAbs2() - 2 * problem.row_scale.array().log().matrix();
}

Fall fall_of_unlikelihood(const Problem &before, const Problem &after) {
    return over_blocks(as_fitted(before), unlikelihood(before) - unlikelihood(after));
}

} // namespace traction::lab
