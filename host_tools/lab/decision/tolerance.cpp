#include "tolerance.h"

#include "host_tools/lab/fit/normal_equations.h"
#include "host_tools/lab/fit/sparse_jacobian.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace traction::lab {

namespace {

constexpr double most_rise = 2;           // standard errors of the held-out error by which a name that the tolerances decide may raise it
constexpr double farthest = 3;            // opened deviations: a data sheet that is wrong by more is no tolerance
constexpr double contradicted = 5.99;     // stated deviations: six are a fit's limit; a natural end that is nearer contradicts no sheet
constexpr double a_good_deal = 0.1;       // of the squares: what explains as much may strain the sheet
constexpr double most_beyond_noise = 0.4; // and what explains as much of those that are not noise
constexpr double a_part = 0.25;           // of the effect's reduction, at least, that a rival must reach by the linear step

struct Group {
    std::string name;
    std::vector<std::size_t> member;
    double alone = 0, left = 0; // reduction by it, and what the effect adds beside it; by linear steps
};

std::vector<Group> groups_of(const Problem &problem) {
    std::vector<Group> list;
    Group soil{"tolerance of the soil", {}, 0, 0};
    for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
        if (!(problem.parameters[i].prior > 0)) continue;
        const FreeParameter &p = problem.parameters[i];
        list.push_back({"tolerance of " + name_of(p), {i}, 0, 0});
        if (p.own) { // all wheels' own together, and apart
            Group every{"tolerance of " + p.owner + "." + p.key + " on every wheel", {}, 0, 0};
            for (std::size_t j = 0; j < problem.parameters.size(); ++j)
                if (problem.parameters[j].own && problem.parameters[j].owner == p.owner && problem.parameters[j].key == p.key)
                    every.member.push_back(j);
            if (every.member.front() == i) list.push_back(every);
        }
        if (p.owner == "soil") soil.member.push_back(i);
    }
    if (soil.member.size() > 1) list.push_back(soil);
    return list;
}

// The stated deviations made wider, and a bound to how far they go.
void open(Problem &problem, const Group &group) {
    for (const std::size_t i : group.member) {
        FreeParameter &p = problem.parameters[i];
        p.prior *= opened;
        p.minimum = std::max(p.minimum, p.base - farthest * p.prior), p.maximum = std::min(p.maximum, p.base + farthest * p.prior);
    }
}

double penalty(const Problem &problem) { return problem.theta.cwiseAbs2().dot(problem.prior_precision()); }

// Least squares of rows and priors over the kept parameters, but for a constant: of a quadratic about the present place.
double least(const Eigen::MatrixXd &normal, const Eigen::VectorXd &moment, const std::vector<Eigen::Index> &kept) {
    const Eigen::VectorXd part = moment(kept);
    return -part.dot(solve_normal(normal(kept, kept), part));
}

// What each group does in place of the effect, whose strengths are the last parameters of `with`, by linear steps from there.
void predict(const Problem &with, Eigen::Index strengths, std::vector<Group> &groups) {
    const SparseJacobian sparse(with.data(), with.jacobian);
    const Eigen::MatrixXd gram = sparse.gram();
    const Eigen::Index n = with.theta.size();
    Eigen::VectorXd absolute = with.theta; // of the effect: whole sizes
    for (Eigen::Index i = n - strengths; i < n; ++i) absolute[i] += with.parameters[static_cast<std::size_t>(i)].base;
    // about the place where everything is zero
    const Eigen::VectorXd moment = sparse.moment(with.residual.cwiseProduct(with.row_scale)) + gram * absolute;
    std::vector<Eigen::Index> all, rest;
    for (Eigen::Index i = 0; i < n; ++i) {
        all.push_back(i);
        if (i < n - strengths) rest.push_back(i);
    }
    const auto squares_of = [&](const Group *opened_group, const std::vector<Eigen::Index> &kept) {
        Eigen::VectorXd precision = with.prior_precision();
        if (opened_group != nullptr)
            for (const std::size_t i : opened_group->member) precision[static_cast<Eigen::Index>(i)] /= opened * opened;
        Eigen::MatrixXd normal = gram;
        normal.diagonal() += precision + 1e-9 * gram.diagonal() + Eigen::VectorXd::Constant(n, 1e-12);
        return least(normal, moment, kept);
    };
    const double without = squares_of(nullptr, rest);
    for (Group &g : groups) {
        const double by_group = squares_of(&g, rest);
        g.alone = without - by_group;
        g.left = by_group - squares_of(&g, all);
    }
    const double by_effect = without - squares_of(nullptr, all);
    std::erase_if(groups, [&](const Group &g) { return g.alone < a_part * by_effect; });
}

double largest_deviation(const Problem &problem, const Group &group) {
    double most = 0;
    for (const std::size_t i : group.member)
        most = std::max(most, std::fabs(problem.theta[static_cast<Eigen::Index>(i)]) * opened / problem.parameters[i].prior);
    return most;
}

} // namespace

bool ToleranceRival::explains_as_much() const { return lead < std::max(2 * error, two_deviations_squared); }

bool tolerances_decide(const Fall &scaled, const Fall &noise, double spared, double least) {
    return scaled.sum + spared > least + scaled.error && noise.sum > -most_rise * noise.error;
}

bool is_at_a_limit(const Problem &fit) {
    for (std::size_t i = 0; i < fit.parameters.size(); ++i)
        if (fit.parameters[i].prior > 0 && fit.at_bound(i)) return true;
    return false;
}

std::size_t newly_at_limits(const Problem &before, const Problem &with) {
    if (with.parameters.empty()) throw std::logic_error("newly_at_limits: asked of a fit that holds nothing, or that was moved away");
    std::size_t count = 0;
    for (std::size_t i = 0; i < with.parameters.size(); ++i) {
        const FreeParameter &p = with.parameters[i];
        if (!(p.prior > 0) || !with.at_bound(i) || std::fabs(with.theta[static_cast<Eigen::Index>(i)]) < contradicted * p.prior) continue;
        for (std::size_t j = 0; j < before.parameters.size(); ++j) {
            const FreeParameter &q = before.parameters[j];
            if (is_same(p, q)) count += before.at_bound(j) ? 0 : 1;
        }
    }
    return count;
}

namespace {

// Squared stated deviations that the misses of a model draw its numbers by.
double drawn_by_misses(double error_in_noise, double least) {
    const double birge = std::max(1.0, error_in_noise);
    return std::max(least, two_deviations_squared * birge * birge);
}

} // namespace

bool tolerances_pay(double spared, double error_in_noise, std::size_t broken, double least) {
    return broken == 0 && spared > drawn_by_misses(error_in_noise, least);
}

bool strains_sheet(double spared, double error_before, double error_with, double least) {
    const double before = error_before * error_before, fall = before - error_with * error_with;
    return -spared > drawn_by_misses(error_with, least) && fall < a_good_deal * before &&
           !(before > 1 && fall > most_beyond_noise * (before - 1));
}

std::optional<ToleranceRival> tolerance_rival(const Problem &before, const Problem &with, std::size_t strengths) {
    std::vector<Group> groups = groups_of(before);
    if (!groups.empty()) predict(with, static_cast<Eigen::Index>(strengths), groups);
    const auto nearest = std::min_element(groups.begin(), groups.end(), [](const Group &a, const Group &b) { return a.left < b.left; });
    if (nearest == groups.end()) return std::nullopt;
    Problem alone = before, both = with;
    for (Problem *problem : {&alone, &both}) {
        open(*problem, *nearest);
        problem->within_bounds();
        problem->jacobian.resize(0, 0);
        problem->gauss_newton(2);
    }
    const Fall lead = fall_between(held_out(alone), held_out(both), before.row_scale.cwiseAbs2());
    return ToleranceRival{nearest->name, largest_deviation(alone, *nearest), lead.sum + penalty(alone) - penalty(both), lead.error};
}

} // namespace traction::lab
