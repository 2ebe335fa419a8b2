#include "tolerance.h"

#include "host_tools/lab/fit/sparse_jacobian.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace traction::lab {

namespace {

constexpr double two_deviations_squared = 4;
constexpr std::size_t refitted = 2; // rivals, by what the linear step predicts

struct Group {
    std::string name;
    std::vector<std::size_t> member;
    double predicted = 0;
};

std::vector<Group> groups_of(const Problem &problem) {
    std::vector<Group> list;
    Group soil{"tolerance of the soil", {}, 0};
    for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
        if (!(problem.parameters[i].prior > 0)) continue;
        list.push_back({"tolerance of " + name_of(problem.parameters[i]), {i}, 0});
        if (problem.parameters[i].owner == "soil") soil.member.push_back(i);
    }
    if (soil.member.size() > 1) list.push_back(soil);
    return list;
}

void open(Problem &problem, const Group &group, double factor) {
    for (const std::size_t i : group.member) problem.parameters[i].prior *= factor;
}

double penalty(const Problem &problem) { return problem.theta.cwiseAbs2().dot(problem.prior_precision()); }

double squares(const Problem &problem) { return problem.residual.cwiseProduct(problem.row_scale).squaredNorm() + penalty(problem); }

// Fall of the squares by one linear step within the bounds.
void predict(Problem &problem, std::vector<Group> &groups) {
    const SparseJacobian sparse(problem.data(), problem.jacobian);
    const Eigen::MatrixXd gram = sparse.gram();
    const Eigen::VectorXd rows = sparse.moment(problem.residual.cwiseProduct(problem.row_scale));
    const double stated = penalty(problem);
    for (Group &g : groups) {
        open(problem, g, opened);
        const Eigen::VectorXd precision = problem.prior_precision(), moment = rows - precision.cwiseProduct(problem.theta);
        Eigen::MatrixXd normal = gram;
        normal.diagonal() += precision + 1e-9 * gram.diagonal() + Eigen::VectorXd::Constant(gram.rows(), 1e-12);
        const Eigen::VectorXd step = problem.step_within_bounds(normal, moment);
        g.predicted = stated - penalty(problem) + 2 * step.dot(moment) - step.dot(normal * step);
        open(problem, g, 1 / opened);
    }
}

double largest_deviation(const Problem &problem, const Group &group) {
    double most = 0;
    for (const std::size_t i : group.member)
        most = std::max(most, std::fabs(problem.theta[static_cast<Eigen::Index>(i)]) * opened / problem.parameters[i].prior);
    return most;
}

} // namespace

bool ToleranceRival::explains_as_much() const { return lead < std::max(2 * error, two_deviations_squared); }

std::optional<ToleranceRival> tolerance_rival(const Problem &before, const Problem &with, const HeldOut &with_heldout) {
    std::vector<Group> groups = groups_of(before);
    if (groups.empty()) return std::nullopt;
    Problem shared = before;
    predict(shared, groups);
    std::stable_sort(groups.begin(), groups.end(), [](const Group &a, const Group &b) { return a.predicted > b.predicted; });
    std::optional<Problem> best;
    const Group *which = nullptr;
    for (std::size_t i = 0; i < std::min(refitted, groups.size()); ++i) {
        Problem problem = before;
        open(problem, groups[i], opened);
        problem.gauss_newton(2);
        if (!best || squares(problem) < squares(*best)) best = std::move(problem), which = &groups[i];
    }
    const Fall lead = fall_between(held_out(*best), with_heldout, before.row_scale.cwiseAbs2());
    return ToleranceRival{which->name, largest_deviation(*best, *which), lead.sum + penalty(*best) - penalty(with), lead.error};
}

} // namespace traction::lab
