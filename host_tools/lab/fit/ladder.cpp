#include "ladder.h"

#include "heldout.h"
#include "screen.h"

#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace traction::lab {

double overall_error(const Problem &problem) {
    double sum = 0;
    const std::size_t n = problem.data().balance.size();
    for (std::size_t b = 0; b < n; ++b) sum += std::pow(problem.balance_rms(b, true), 2);
    return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : 0;
}

namespace {

// What store() writes for each parameter: itself, and for a wheel's own difference the sum with what the wheels share.
Eigen::MatrixXd stored_sums(const Problem &problem) {
    const auto n = static_cast<Eigen::Index>(problem.parameters.size());
    Eigen::MatrixXd sums = Eigen::MatrixXd::Identity(n, n);
    Eigen::Index shared = 0; // each wheel's own follow what they share
    for (Eigen::Index i = 0; i < n; ++i) {
        const FreeParameter &p = problem.parameters[static_cast<std::size_t>(i)], &q = problem.parameters[static_cast<std::size_t>(shared)];
        if (!p.own)
            shared = i;
        else if (p.owner == q.owner && p.key == q.key && !q.own)
            sums(i, shared) = 1;
    }
    return sums;
}

// A strength of an effect of the catalogue.
bool is_size(const FreeParameter &p) {
    const sim::Effect *effect = sim::find_effect(p.owner);
    return effect != nullptr && std::any_of(effect->parameters.begin(), effect->parameters.end(),
                                            [&](const auto &one) { return one.strength && one.name == p.key; });
}

// What a fit that leaves this much (times noise) with a parameter at its bound may be: the wrong valley, where one number ran away before
// the others had moved. Uneven ground leaves 3 to 6.
constexpr double strange = 8;

// The fit from another side: what had ended at its bound is held as stated until the rest has settled, and freed then.
Problem held_back(const Problem &fitted, Problem other) {
    const std::vector<FreeParameter> free = other.parameters;
    for (std::size_t i = 0; i < free.size(); ++i)
        if (fitted.at_bound(i)) other.parameters[i].minimum = other.parameters[i].maximum = free[i].base;
    other.settle();
    other.parameters = free;
    other.settle_from_here();
    return other;
}

// Scales follow the residual: a wheel that the first steps missed is weighed down and stays missed, though there are numbers by which all
// wheels follow.
constexpr double unlike = 1.5, missed = 1.2; // times each other; times noise

bool wheels_are_missed_unlike(const Problem &fitted) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (std::size_t b = 0; b < fitted.data().balance.size(); ++b) {
        if (fitted.data().balance[b].kind != BalanceKind::current_torque) continue;
        const double error = fitted.balance_rms(b, true);
        least = std::min(least, error), most = std::max(most, error);
    }
    return most > unlike * least && overall_error(fitted) > missed;
}

double unlikely(const Problem &fitted) { return unlikelihood(fitted).sum() + fitted.theta.cwiseAbs2().dot(fitted.prior_precision()); }

// The fit from where all rows are weighed by their sensors' noise, where that is likelier and misses less.
Problem weighed_alike(Problem fitted) {
    Problem other = fitted;
    other.row_scale = other.noise_rows().cwiseInverse();
    other.jacobian.resize(0, 0);
    other.gauss_newton(4);
    other.settle_from_here();
    return unlikely(other) < unlikely(fitted) && overall_error(other) < overall_error(fitted) ? other : fitted;
}

} // namespace

std::optional<Problem> from_afar(const Problem &problem, std::size_t parameter, double least) {
    const FreeParameter &p = problem.parameters[parameter];
    std::optional<Problem> best;
    for (const double part : {0.05, 0.15, 0.4}) {
        Problem other = problem;
        other.theta[static_cast<Eigen::Index>(parameter)] = p.minimum + part * (p.maximum - p.minimum) - p.base;
        other.jacobian.resize(0, 0);
        other.gauss_newton(4);
        if (const double cost = other.cost(); cost < least) least = cost, best = std::move(other);
    }
    return best;
}

Problem fitted_problem(const Model &model, const Dataset &data) {
    const Physics physics = make_physics(model);
    const Problem stated(data, physics, free_parameters(model, physics));
    Problem best = stated;
    best.settle();
    if (overall_error(best) > strange) {
        Problem other = held_back(best, stated);
        if (overall_error(other) < overall_error(best)) best = std::move(other);
    }
    if (wheels_are_missed_unlike(best)) best = weighed_alike(std::move(best));
    Problem first = best;
    double least = first.cost();
    for (std::size_t i = 0; i < best.parameters.size(); ++i) {
        const FreeParameter p = best.parameters[i];
        const EffectHandle *handle = find_handle(p.owner);
        if (handle == nullptr || !handle->remembers || !std::isfinite(p.maximum - p.minimum)) continue;
        if (std::optional<Problem> other = from_afar(first, i, least)) best = std::move(*other), least = best.cost();
    }
    if (least < first.cost()) best.settle_from_here();
    return best;
}

// Of a size. Of 467 of the independent generators (docs/lab_diary.md) the rows' own intervals held 0.95 where they were wider than a
// tenth of it, and 0.83 of the narrower ones.
constexpr double exact_to = 0.03;

double with_the_laws_own(double of_data, double value) { return std::hypot(of_data, exact_to * value); }

LadderStep store_fit(Model &model, const Problem &problem, const std::string &label) {
    LadderStep step{label, overall_error(problem), held_out(problem).error, 1};
    const Screen screen(problem);
    const std::vector<ParameterError> errors = screen.errors_of(stored_sums(problem));
    for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
        const FreeParameter &p = problem.parameters[i];
        const double theta = problem.theta[static_cast<Eigen::Index>(i)], half = errors[i].half_width;
        store(model, p, theta, is_size(p) ? with_the_laws_own(half, p.base + theta) : half);
    }
    return step;
}

LadderStep fit_model(Model &model, const Dataset &data, const std::string &label) {
    return store_fit(model, fitted_problem(model, data), label);
}

} // namespace traction::lab
