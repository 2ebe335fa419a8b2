#include "ladder.h"

#include "screen.h"

#include <cmath>

namespace traction::lab {

double overall_error(const Problem &problem) {
    double sum = 0;
    const std::size_t n = problem.data().balance.size();
    for (std::size_t b = 0; b < n; ++b) sum += std::pow(problem.balance_rms(b, true), 2);
    return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : 0;
}

double overall_heldout(const Problem &problem) {
    const Screen screen(problem);
    const std::vector<double> squares = screen.heldout_by_balance(true);
    double sum = 0;
    const std::size_t n = problem.data().balance.size();
    for (std::size_t b = 0; b < n; ++b) sum += squares[b] / static_cast<double>(problem.data().balance[b].measured.size());
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

} // namespace

LadderStep fit_model(Model &model, const Dataset &data, const std::string &label) {
    const Physics physics = make_physics(model);
    Problem problem(data, physics, free_parameters(model, physics));
    problem.fit({.iterations = 10, .thorough = true});
    LadderStep step{label, overall_error(problem), overall_heldout(problem), 1};
    const Screen screen(problem);
    const std::vector<ParameterError> errors = screen.errors_of(stored_sums(problem));
    for (std::size_t i = 0; i < problem.parameters.size(); ++i)
        store(model, problem.parameters[i], problem.theta[static_cast<Eigen::Index>(i)], errors[i].half_width);
    return step;
}

} // namespace traction::lab
