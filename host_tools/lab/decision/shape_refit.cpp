#include "shape_refit.h"

#include "trial.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace traction::lab {

namespace {

constexpr double least_of_squares = 0.035; // clean logs of the fleet had up to 0.033 (strange ones whose noise is stated twice up to
                                           // 0.066), laws that the catalogue lacks 0.048 and more (docs/lab_diary.md)
constexpr double least_of_balance = 0.15;  // as the linear step is asked for (shape_rules.cpp)
constexpr double sure_errors = 2;

bool surely(const Fall &fall) {
    Eigen::VectorXd of = fall.of_block;
    std::sort(of.begin(), of.end());
    return fall.sum > sure_errors * fall.error && of.size() > 2 && of.head(of.size() - 2).sum() > 0;
}

} // namespace

Problem with_shape(const Problem &without, const ShapeScore &shape) {
    const Eigen::Index k = shape.assessment.strength.size();
    Problem with = beside(without, shape.candidate);
    double least = with.cost();
    Eigen::VectorXd best = with.theta;
    for (const double part : {1.0, 0.5, 0.2, 0.05}) {
        with.theta.tail(k) = part * shape.assessment.strength;
        if (const double cost = with.cost(); cost < least) least = cost, best = with.theta;
    }
    with.theta = best;
    with.gauss_newton(3);
    return with;
}

ShapeFall fall_by(const ShapeScore &shape, const Problem &with, const Problem &without, const HeldOut &left, const Scatter &scatter) {
    HeldOut after = held_out(with);
    const Eigen::VectorXd weight = without.row_scale.cwiseAbs2();
    Eigen::VectorXd smoothed = Eigen::VectorXd::Zero(weight.size());
    if ((shape.candidate.touched & stage_motion) != 0) smoothed = scatter.smoothed_by(without.data(), with.physics());
    // what is gained by smoothing is put back into the rows
    after.residual = (after.residual.cwiseAbs2() + smoothed).cwiseMax(0.0).cwiseSqrt();
    ShapeFall fall;
    fall.whole = fall_between(left, after, weight);
    fall.share = fall.whole.sum / left.residual.cwiseAbs2().dot(weight);
    Eigen::Index first = 0;
    for (const Balance &b : without.data().balance) {
        const auto rows = static_cast<Eigen::Index>(b.measured.size());
        Eigen::VectorXd own = Eigen::VectorXd::Zero(weight.size());
        own.segment(first, rows) = weight.segment(first, rows);
        first += rows;
        const Fall of = fall_between(left, after, own);
        const double share = of.sum / left.residual.cwiseAbs2().dot(own);
        if (share > fall.balance_share) fall.balance = of, fall.balance_share = share;
    }
    return fall;
}

bool is_worth_a_word(const ShapeFall &fall, double scatter_share) {
    return (fall.share > least_of_squares && surely(fall.whole)) ||
           (fall.balance_share > least_of_balance + scatter_share && fall.whole.sure() && surely(fall.balance));
}

ShapeScore as_fitted(const ShapeScore &shape, Problem with) {
    with.linearise();
    const std::vector<ParameterError> errors = Screen(with).parameter_errors();
    const Eigen::Index k = shape.assessment.strength.size(), n = with.theta.size() - k;
    ShapeScore fitted = shape;
    fitted.assessment.strength = with.theta.tail(k);
    for (Eigen::Index j = 0; j < k; ++j) fitted.assessment.standard_error[j] = errors[static_cast<std::size_t>(n + j)].standard;
    return fitted;
}

bool is_possible(const ShapeScore &shape) {
    const TermTarget t = shape.candidate.target;
    const bool multiplies = t == TermTarget::soil_strength || t == TermTarget::motor_constant || t == TermTarget::resistance;
    const Eigen::VectorXd &strength = shape.assessment.strength;
    return !multiplies || (shape.candidate.order > 0 ? strength.norm() : -strength.minCoeff()) < 1;
}

std::optional<ShapeScore> as_refitted(const ShapeScore &shape, const Problem &without) {
    const Scatter scatter(without);
    const Problem with = with_shape(without, shape);
    if (!is_worth_a_word(fall_by(shape, with, without, held_out(without), scatter), scatter.share)) return std::nullopt;
    ShapeScore fitted = as_fitted(shape, with);
    return is_possible(fitted) ? std::optional<ShapeScore>(std::move(fitted)) : std::nullopt;
}

} // namespace traction::lab
