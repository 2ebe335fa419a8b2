#include "shape_rules.h"

#include "host_tools/lab/fit/distribution.h"
#include "host_tools/lab/fit/scatter.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace traction::lab {

namespace {

constexpr double least_uneven = 0.06; // share of the error: a grip that varies by 6 % over 0.2 m gave up to 0.047 (plant on gravel, clean)
constexpr double left_to_explain = 0.01;               // of the error: assumed
constexpr double place_beside_a_shape = 2.0;           // of what was named: assumed
constexpr double some_wheels_share = 0.2;              // of the chance of a false alarm, spent on shapes of one wheel or axle
constexpr double some_wheels_tried = 137;              // electric shapes, and straight lines of the ground, x wheels and axles
constexpr double steps_share = 0.1, steps_tried = 310; // beside that chance; ten a target are no near copies, x targets, wheels and axles
constexpr int steps_of_one = 16;
constexpr double step_length = 0.25; // of what they are apart
constexpr double shapes_tried = 80;  // axes x targets, straight lines, bumps, waves and periods, less those that are near copies

} // namespace

double corrected(const Candidate &c, const Assessment &a) {
    double falls = 1;
    if (c.order == 0) {
        falls = signed_rank_tail({a.block_gain.begin(), a.block_gain.end()});
    } else {
        const double blocks = static_cast<double>(a.block_gain.size()), t = a.gain_error > 0 ? a.gain / a.gain_error : 0;
        if (t > 0 && blocks > 1) falls = 0.5 * f_tail(t * t, 1, blocks - 1);
    }
    const double tried = is_step(c)      ? steps_tried / steps_share
                         : c.some_wheels ? some_wheels_tried / some_wheels_share
                                         : shapes_tried / (1 - some_wheels_share);
    return std::min(1.0, 2 * tried * std::min(a.p_value, falls));
}

bool is_straight(const Candidate &c) { return c.knots.size() == 2 && c.strengths.size() == 2; }

bool is_bump(const Candidate &c) { return c.knots.size() == 3 && c.strengths.size() == 1; }

bool is_step(const Candidate &c) { return c.knots.size() == 2 && c.strengths.size() == 1; }

std::vector<Candidate> steps_of(const Candidate &over_time) {
    const double first = over_time.knots.front(), apart = (over_time.knots.back() - first) / (steps_of_one + 1);
    std::vector<Candidate> list;
    for (int i = 1; i <= steps_of_one; ++i) {
        Candidate c = over_time;
        const double at = first + i * apart;
        c.effect += ", a step at " + std::to_string(std::lround(at)) + " s";
        c.knots = {at - 0.5 * step_length * apart, at + 0.5 * step_length * apart};
        c.strengths = {over_time.strengths[1]}; // of its two knots the later
        list.push_back(std::move(c));
    }
    return list;
}

std::vector<std::vector<int>> wheel_groups(const Physics &physics, bool motors) {
    std::vector<std::vector<int>> groups;
    std::vector<int> wheels;
    for (std::size_t i = 0; i < physics.wheel.size(); ++i)
        if (!motors || is_motor(physics, i)) wheels.push_back(static_cast<int>(i));
    if (wheels.size() < 2 || wheels.size() > 8) return groups;
    const auto wheel = [&](int i) -> const WheelPhysics & { return physics.wheel[static_cast<std::size_t>(i)]; };
    for (const int i : wheels) {
        groups.push_back({i});
        std::vector<int> axle;
        for (const int j : wheels)
            if (same_axle(wheel(i), wheel(j))) axle.push_back(j);
        if (axle.size() > 1 && axle.size() < wheels.size() && axle.front() == i) groups.push_back(axle);
    }
    return groups;
}

Candidate on_wheels(const Candidate &shape, const std::vector<int> &group) {
    Candidate c = shape;
    c.some_wheels = true;
    c.on = group;
    for (FreeParameter &p : c.strengths) {
        std::vector<Slot> of_each;
        for (std::size_t i = 0; i < group.size(); ++i)
            for (Slot slot : p.slots) {
                slot.term = Slot::last_term - static_cast<int>(i);
                of_each.push_back(slot);
            }
        p.slots = of_each;
    }
    c.effect += group.size() == 1 ? " on wheel " : " on wheels ";
    for (std::size_t i = 0; i < group.size(); ++i) c.effect += (i == 0 ? "" : " and ") + std::to_string(group[i]);
    return c;
}

bool uneven(const Candidate &c) {
    return c.target == TermTarget::soil_strength && c.order == 0 &&
           (c.axis == Axis::time || c.axis == Axis::place || c.axis == Axis::path || c.axis == Axis::slip);
}

UnknownShape describe(const ShapeScore &s, double base_error) {
    UnknownShape u;
    u.score = std::make_shared<const ShapeScore>(s);
    static const char *units[] = {"N m", "N m", "N", "N", "N", "V", "1", "1", "1", "1", "m/s^2", "1", "1", "1"};
    u.variable = std::string(axis_name(s.candidate.axis));
    u.target = std::string(target_name(s.candidate.target));
    u.balance = s.candidate.effect;
    u.unit_x = std::string(axis_unit(s.candidate.axis));
    u.unit_y = units[static_cast<int>(s.candidate.target)];
    u.gain = base_error > 0 ? s.assessment.gain / base_error : 0;
    std::vector<double> y;
    std::vector<double> error(s.assessment.standard_error.begin(), s.assessment.standard_error.end());
    for (Eigen::Index j = 0; j < s.assessment.strength.size(); ++j) y.push_back(s.assessment.strength[j]);
    if (is_bump(s.candidate)) y = {0, y[0], 0}, error = {0, error[0], 0};
    if (is_step(s.candidate)) y = {0, y[0]}, error = {0, error[0]};
    u.expression = shape_expression(s.candidate, y);
    if (s.candidate.order > 0) {
        for (int i = 0; i <= 36; ++i) { // a turn of the wheel, or one wave
            const double theta = 2 * std::numbers::pi * i / 36 / (s.candidate.axis == Axis::angle ? 1 : s.candidate.order),
                         f = y[0] * std::cos(s.candidate.order * theta) + y[1] * std::sin(s.candidate.order * theta);
            const double band = 1.96 * s.assessment.standard_error.maxCoeff();
            u.x.push_back(theta), u.y.push_back(f), u.low.push_back(f - band), u.high.push_back(f + band);
        }
        return u;
    }
    std::vector<double> x = s.candidate.knots;
    if (is_step(s.candidate)) { // with some of what it is before and behind
        const double apart = (x[1] - x[0]) / step_length;
        x = {x[0] - apart, x[0], x[1], x[1] + apart};
        y = {0, 0, y[1], y[1]}, error = {0, 0, error[1], error[1]};
    }
    for (std::size_t j = 0; j < x.size(); ++j) {
        u.x.push_back(x[j]);
        u.y.push_back(y[j]);
        u.low.push_back(y[j] - 1.96 * error[j]);
        u.high.push_back(y[j] + 1.96 * error[j]);
    }
    return u;
}

Problem without_effect(const Problem &last, const Candidate &effect, Eigen::MatrixXd &columns) {
    Problem less = last;
    std::vector<Eigen::Index> kept;
    less.parameters.clear();
    columns.resize(last.jacobian.rows(), 0);
    for (std::size_t i = 0; i < last.parameters.size(); ++i) {
        const FreeParameter &p = last.parameters[i];
        const auto at = static_cast<Eigen::Index>(i);
        if (p.owner != effect.effect || p.wheel != effect.wheel) {
            kept.push_back(at);
            less.parameters.push_back(p);
            continue;
        }
        columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
        columns.rightCols(1) = last.jacobian.col(at);
        less.residual += (last.jacobian.col(at) * (p.base + last.theta[at])).cwiseQuotient(last.row_scale);
    }
    less.jacobian = last.jacobian(Eigen::all, kept);
    less.theta = last.theta(kept);
    return less;
}

Assessment effect_given_shape(const Problem &less, const Eigen::MatrixXd &effect, const ShapeScore &shape) {
    Problem with = less;
    const Eigen::Index n = less.theta.size(), k = shape.columns.cols();
    with.jacobian.conservativeResize(Eigen::NoChange, n + k);
    with.jacobian.rightCols(k) = shape.columns.whole();
    with.theta.conservativeResize(n + k);
    with.theta.tail(k).setZero();
    with.parameters.insert(with.parameters.end(), shape.candidate.strengths.begin(), shape.candidate.strengths.end());
    return Screen(with).assess(effect, Eigen::VectorXd::Zero(effect.cols()), false);
}

bool is_curve(const Candidate &shape) {
    return shape.order == 0 && !shape.varies_between_wheels &&
           (shape.knots.size() > 3 || is_straight(shape) || is_bump(shape) || is_step(shape) || shape.axis == Axis::direction ||
            shape.axis == Axis::other_current || shape.axis == Axis::axle_current || shape.axis == Axis::side_current);
}

std::optional<UnknownShape> confounding_shape(const Problem &last, const Candidate &effect, const std::vector<ShapeScore> &shapes,
                                              const ShapeScore *flagged, const DiagnoseOptions &options) {
    Eigen::MatrixXd columns;
    const Problem less = without_effect(last, effect, columns);
    const Screen screen(less);
    const Assessment own = screen.assess(columns, Eigen::VectorXd::Zero(columns.cols()), false);
    std::optional<ShapeScore> best;
    for (const ShapeScore &shape : shapes) {
        if (shape.columns.cols() == 0 || !is_curve(shape.candidate) || !(shape.p_value < options.shape_p_limit)) continue;
        ShapeScore s = shape;
        s.assessment = screen.assess(shape.columns.whole(), Eigen::VectorXd::Zero(shape.columns.cols()), false);
        s.p_value = corrected(s.candidate, s.assessment);
        if (!(s.p_value < options.shape_p_limit) || (best && !(s.assessment.gain > best->assessment.gain))) continue;
        const bool better = s.assessment.gain - own.gain > 2 * sum_error(s.assessment.block_gain - own.block_gain);
        if (!better && (is_straight(shape.candidate) || &shape != flagged)) continue;
        const Assessment left = effect_given_shape(less, columns, shape);
        if (left.gain > 0 && left.p_value * shapes_tried < options.p_limit) continue; // needed beside the shape too
        best = std::move(s);
    }
    if (!best) return std::nullopt;
    return describe(*best, screen.heldout_error());
}

std::vector<std::size_t> explained_by_shape(const Problem &last, const std::vector<Candidate> &named, const std::string &shape,
                                            const std::vector<ShapeScore> &scores) {
    const auto found = std::find_if(scores.begin(), scores.end(),
                                    [&](const ShapeScore &s) { return s.candidate.effect == shape && s.columns.cols() > 0; });
    std::vector<std::size_t> list;
    for (std::size_t i = 0; i < named.size(); ++i) {
        Eigen::MatrixXd columns;
        if (found != scores.end()) {
            const Problem less = without_effect(last, named[i], columns);
            const double own = Screen(less).assess(columns, Eigen::VectorXd::Zero(columns.cols()), false).gain;
            if (effect_given_shape(less, columns, *found).gain > 0.5 * own) continue;
        }
        list.push_back(i);
    }
    return list;
}

bool anything_left(const std::vector<ShapeScore> &scores, double heldout_error) {
    return std::any_of(scores.begin(), scores.end(),
                       [&](const ShapeScore &s) { return s.assessment.gain >= left_to_explain * heldout_error; });
}

bool takes_their_place(std::size_t names, double gain, double named_gain, double error, bool leaves_a_shape,
                       const DiagnoseOptions &options) {
    if (names > 1) return gain > place_of_several * named_gain;
    return gain > (leaves_a_shape ? place_beside_a_shape : options.shape_margin) * named_gain && gain - named_gain >= 2 * error;
}

bool may_replace(const ShapeScore &shape, double named_gain, const DiagnoseOptions &options) {
    return shape.p_value < options.shape_p_limit && !is_straight(shape.candidate) && !is_step(shape.candidate) &&
           shape.assessment.gain > place_of_several * named_gain;
}

bool gives_way(const std::vector<std::size_t> &replaced, const std::vector<CandidateResult> &accepted, double shape_gain) {
    return replaced.size() > 1 || (!replaced.empty() && accepted[replaced[0]].gain_squares < 0.5 * shape_gain);
}

bool repeats(const ShapeScore &s) {
    if (s.assessment.gain > 2.5 * s.assessment.gain_error) return true;
    Eigen::VectorXd gain = s.assessment.block_gain;
    std::sort(gain.begin(), gain.end());
    return s.p_value < 2e-3 && gain.size() > 2 && gain.head(gain.size() - 2).sum() > 0;
}

const ShapeScore *worth_a_word(const std::vector<ShapeScore> &scores, const std::function<double(const ShapeScore &)> &smoothed_by,
                               bool beside_names, double heldout_error, double scatter_share, const DiagnoseOptions &options) {
    const double least = beside_names ? 0.05 : options.least_shape_gain;
    // a precise balance weighs little among all: there a shape may stand on that balance alone, if it is very sure
    const auto material = [&](const ShapeScore &s) {
        const double part = s.candidate.some_wheels ? 0.5 : 1; // one wheel's rows are few among all
        return s.assessment.gain >
                   std::max({part * least, uneven(s.candidate) ? least_uneven : 0.0, of_scatter * scatter_share}) * heldout_error ||
               (s.balance_fall > 0.15 + scatter_share && s.p_value < 1e-4);
    };
    const ShapeScore *best = nullptr;
    double best_gain = 0;
    for (const ShapeScore &s : scores) {
        if (!(s.p_value < options.shape_p_limit) || !material(s) || !repeats(s)) continue;
        ShapeScore sharp = s;
        const double smoothed = smoothed_by(s);
        sharp.assessment.gain -= smoothed;
        sharp.assessment.block_gain.array() -=
            smoothed / static_cast<double>(std::max<Eigen::Index>(1, sharp.assessment.block_gain.size()));
        if (sharp.assessment.gain < s.assessment.gain && (!material(sharp) || !repeats(sharp))) continue;
        // of shapes that do nearly as well, the one with the fewest coefficients; but a step is much of any curve over time
        const double nearly = is_step(s.candidate) ? 0.95 : 0.85;
        if (best != nullptr && !(s.assessment.gain > nearly * best_gain && s.candidate.strengths.size() < best->candidate.strengths.size()))
            continue;
        if (best == nullptr) best_gain = s.assessment.gain;
        best = &s;
    }
    return best;
}

} // namespace traction::lab
