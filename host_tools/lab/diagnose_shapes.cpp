// What no effect of the catalogue explains: structure-free shapes f(X), tested like any candidate.
#include "diagnose.h"
#include "screen.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace {

constexpr double shapes_tried = 30;

struct ShapeScore {
    Candidate candidate;
    Assessment assessment;
    double p_value = 1;
};

ShapeScore assess_shape(const Candidate &c, Problem &problem, const Screen &screen, const Physics &physics) {
    ShapeScore s;
    s.candidate = c;
    Physics at = physics;
    c.prepare(at);
    Eigen::MatrixXd columns(problem.row_scale.size(), static_cast<Eigen::Index>(c.strengths.size()));
    for (std::size_t j = 0; j < c.strengths.size(); ++j) columns.col(static_cast<Eigen::Index>(j)) = problem.column(at, c.strengths[j], c.step[j]);
    // knots that no sample is near carry nothing: they follow their neighbour
    s.assessment = screen.assess(columns, Eigen::VectorXd::Zero(columns.cols()), false);
    s.p_value = std::min(1.0, s.assessment.p_value * shapes_tried);
    return s;
}

std::vector<ShapeScore> all_shapes(Problem &problem, const Screen &screen) {
    std::vector<ShapeScore> list;
    const Physics physics = problem.physics();
    for (const Candidate &c : shape_candidates(problem.data(), problem.forward().motion(), problem.forward().winding_current_A()))
        list.push_back(assess_shape(c, problem, screen, physics));
    std::stable_sort(list.begin(), list.end(), [](const ShapeScore &a, const ShapeScore &b) { return a.assessment.gain > b.assessment.gain; });
    return list;
}

UnknownShape describe(const ShapeScore &s, double base_error) {
    UnknownShape u;
    static const char *units[] = {"N m", "N", "N", "N", "V", "1", "1", "1", "1", "m/s^2", "1", "1", "1"};
    u.variable = std::string(axis_name(s.candidate.axis));
    u.target = std::string(target_name(s.candidate.target));
    u.balance = s.candidate.effect;
    u.unit_x = std::string(axis_unit(s.candidate.axis));
    u.unit_y = units[static_cast<int>(s.candidate.target)];
    u.gain = base_error > 0 ? s.assessment.gain / base_error : 0;
    std::vector<double> y;
    for (Eigen::Index j = 0; j < s.assessment.strength.size(); ++j) y.push_back(s.assessment.strength[j]);
    u.expression = shape_expression(s.candidate, y);
    if (s.candidate.order > 0) {
        for (int i = 0; i <= 36; ++i) {
            const double theta = 2 * 3.14159265358979 * i / 36, f = y[0] * std::cos(s.candidate.order * theta) + y[1] * std::sin(s.candidate.order * theta);
            const double band = 1.96 * s.assessment.standard_error.maxCoeff();
            u.x.push_back(theta), u.y.push_back(f), u.low.push_back(f - band), u.high.push_back(f + band);
        }
        return u;
    }
    for (std::size_t j = 0; j < s.candidate.knots.size(); ++j) {
        const double error = s.assessment.standard_error[static_cast<Eigen::Index>(j)];
        u.x.push_back(s.candidate.knots[j]);
        u.y.push_back(y[j]);
        u.low.push_back(y[j] - 1.96 * error);
        u.high.push_back(y[j] + 1.96 * error);
    }
    return u;
}

} // namespace

std::optional<UnknownShape> find_unknown(Problem &first, Problem &last, std::size_t named_count, const DiagnoseOptions &options) {
    const bool something_named = named_count > 0;
    const Screen last_screen(last);
    const Screen first_screen(first);
    const auto material = [&](const ShapeScore &s, double base) {
        const double least = something_named ? 0.05 : options.least_shape_gain;
        return s.p_value < options.p_limit && s.assessment.gain > least * base && s.assessment.gain > 2.5 * s.assessment.gain_error;
    };
    for (const ShapeScore &s : all_shapes(last, last_screen))
        if (material(s, last_screen.heldout_error())) return describe(s, last_screen.heldout_error());
    if (!something_named) return std::nullopt;
    // does one shape alone do better than all that was named?
    Problem named = last; // all that was named, on the first problem's scales
    named.keep_scales(first);
    named.linearise();
    const Screen named_screen(named);
    const double margin = named_count > 1 ? 0.95 : options.shape_margin; // one shape in the stead of several effects is the simpler story
    const double named_gain = first_screen.heldout_error() - named_screen.heldout_error();
    for (const ShapeScore &s : all_shapes(first, first_screen)) {
        if (!(s.p_value < options.p_limit) || !(s.assessment.gain > margin * named_gain)) continue;
        const Eigen::VectorXd difference = s.assessment.block_gain - (first_screen.block_error() - named_screen.block_error());
        const double n = static_cast<double>(difference.size());
        const double error = std::sqrt((difference.array() - difference.mean()).square().sum() * n / std::max(1.0, n - 1));
        if (named_count > 1 || s.assessment.gain - named_gain > 2 * error) return describe(s, first_screen.heldout_error());
    }
    return std::nullopt;
}

} // namespace traction::lab
