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

LadderStep fit_model(Model &model, const Dataset &data, const std::string &label) {
    const Physics physics = make_physics(model);
    Problem problem(data, physics, free_parameters(model, physics));
    problem.fit({.iterations = 10, .thorough = true});
    LadderStep step{label, overall_error(problem), overall_heldout(problem), 1};
    const Screen screen(problem);
    const std::vector<ParameterError> errors = screen.parameter_errors();
    for (std::size_t i = 0; i < problem.parameters.size(); ++i)
        store(model, problem.parameters[i], problem.theta[static_cast<Eigen::Index>(i)], errors[i].half_width);
    return step;
}

} // namespace traction::lab
