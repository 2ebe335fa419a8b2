#include "scatter.h"

#include <algorithm>

namespace traction::lab {

Scatter::Scatter(const Problem &problem, const Problem *better)
    : squares(rounding_squares(problem.data(), problem.physics())), part(Eigen::VectorXd::Zero(problem.residual.size())) {
    const Eigen::VectorXd noise = problem.noise_rows().cwiseAbs2(), weight = problem.row_scale.cwiseAbs2(),
                          left = problem.residual.cwiseAbs2(), left_better = (better != nullptr ? *better : problem).residual.cwiseAbs2();
    Eigen::Index first = 0;
    for (const Balance &b : problem.data().balance) {
        const auto n = static_cast<Eigen::Index>(b.measured.size());
        const auto sum = [&](const Eigen::VectorXd &of_rows) { return of_rows.segment(first, n).dot(weight.segment(first, n)); };
        if (const double most = sum(squares); most > 0)
            part.segment(first, n).setConstant(
                std::clamp((sum(left) - std::min(sum(noise), better != nullptr ? sum(left_better) : sum(noise))) / most, 0.0, 1.0));
        first += n;
    }
    const double whole = left.dot(weight);
    share = whole > 0 ? part.cwiseProduct(squares).dot(weight) / whole : 0;
}

Eigen::VectorXd Scatter::smoothed_by(const Dataset &data, const Physics &other) const {
    return (squares - rounding_squares(data, other)).cwiseProduct(part);
}

} // namespace traction::lab
