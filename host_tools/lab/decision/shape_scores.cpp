#include "shape_scores.h"

#include "host_tools/lab/fit/sparse_jacobian.h"

#include <algorithm>
#include <memory>
#include <optional>

namespace traction::lab {

namespace {

// Several shapes of equally many coefficients side by side: one pass serves them all.
class StackedTerm : public Term {
  public:
    void add(std::shared_ptr<Term> term, std::size_t count) { part_.push_back(std::move(term)), count_ = count; }
    double value(const Signals &signals, const double *c) const override {
        double sum = 0;
        for (std::size_t i = 0; i < part_.size(); ++i) sum += part_[i]->value(signals, c + i * count_);
        return sum;
    }
    void weights(const Signals &signals, std::size_t, double *weight) const override {
        for (std::size_t i = 0; i < part_.size(); ++i) part_[i]->weights(signals, count_, weight + i * count_);
    }

  private:
    std::vector<std::shared_ptr<Term>> part_;
    std::size_t count_ = 0;
};

bool is_of_each_motor(const Candidate &shape) {
    const unsigned electric = stage_torque | stage_voltage;
    return (shape.touched & electric) != 0 && (shape.touched & ~electric) == 0;
}

// Steps over time, one beside the other.
class StepsTerm : public Term {
  public:
    StepsTerm(std::vector<double> begin, double length) : begin_(std::move(begin)), length_(length) {}
    double value(const Signals &signals, const double *c) const override {
        double sum = 0;
        for (std::size_t i = 0; i < begin_.size(); ++i) sum += c[i] * part(signals.t, i);
        return sum;
    }
    void weights(const Signals &signals, std::size_t count, double *weight) const override {
        for (std::size_t i = 0; i < count; ++i) weight[i] = part(signals.t, i);
    }

  private:
    double part(double t, std::size_t i) const { return std::clamp((t - begin_[i]) / length_, 0.0, 1.0); }
    std::vector<double> begin_;
    double length_;
};

} // namespace

ShapeColumns::ShapeColumns(Problem &problem) : problem_(problem), physics_(problem.physics()) {
    plain_ = plain_currents(physics_) && physics_.terms.empty() && problem.forward().has_linear_base();
}

Eigen::MatrixXd ShapeColumns::of(const Candidate &c) {
    Physics at = physics_;
    c.prepare(at);
    const Term &term = *at.terms.back().term;
    const std::size_t count = c.strengths.size();
    if (plain_ && count <= most_shapes && c.touched == stage_motion && c.target != TermTarget::body_force)
        return problem_.row_scale.asDiagonal() * problem_.forward().shaped(physics_, unit(c.target), term, count);
    if (plain_ && is_of_each_motor(c) && !physics_.unsigned_current)
        return problem_.row_scale.asDiagonal() * problem_.forward().shaped_electric(physics_, electric_unit(c.target), term, count);
    Eigen::MatrixXd columns(problem_.row_scale.size(), static_cast<Eigen::Index>(count));
    for (std::size_t j = 0; j < count; ++j) columns.col(static_cast<Eigen::Index>(j)) = problem_.column(at, c.strengths[j], c.step[j]);
    return columns;
}

std::vector<Eigen::MatrixXd> ShapeColumns::of_each_wheel(const Candidate &c) {
    const std::size_t count = c.strengths.size(), wheels = physics_.wheel.size();
    std::vector<Eigen::MatrixXd> list;
    if (!plain_ || c.touched != stage_motion || wheels < 2 || wheels * count > most_shapes) return list;
    Physics at = physics_;
    c.prepare(at);
    const Eigen::MatrixXd columns =
        problem_.row_scale.asDiagonal() * problem_.forward().shaped(physics_, unit(c.target), *at.terms.back().term, count, true);
    for (std::size_t i = 0; i < wheels; ++i)
        list.push_back(columns.middleCols(static_cast<Eigen::Index>(i * count), static_cast<Eigen::Index>(count)));
    return list;
}

std::vector<Eigen::MatrixXd> ShapeColumns::of_waves(const std::vector<Candidate> &waves) {
    std::vector<Eigen::MatrixXd> list;
    for (std::size_t first = 0; first < waves.size(); first += most_shapes / 2) {
        const std::size_t last = std::min(waves.size(), first + most_shapes / 2);
        if (!plain_) {
            for (std::size_t i = first; i < last; ++i) list.push_back(of(waves[i]));
            continue;
        }
        StackedTerm all;
        for (std::size_t i = first; i < last; ++i) all.add(make_periodic(waves[i].axis, waves[i].order), 2);
        const Eigen::MatrixXd columns =
            problem_.row_scale.asDiagonal() * problem_.forward().shaped(physics_, unit(TermTarget::soil_strength), all, 2 * (last - first));
        for (Eigen::Index i = 0; i < columns.cols(); i += 2) list.push_back(columns.middleCols(i, 2));
    }
    return list;
}

Eigen::MatrixXd ShapeColumns::of_steps(const std::vector<Candidate> &steps) {
    const Candidate &one = steps.front();
    const bool electric = is_of_each_motor(one);
    const bool moves = one.touched == stage_motion && one.target != TermTarget::body_force;
    const std::size_t most = electric ? steps.size() : most_shapes;
    Eigen::MatrixXd columns(problem_.row_scale.size(), static_cast<Eigen::Index>(steps.size()));
    for (std::size_t first = 0; first < steps.size(); first += most) {
        const std::size_t count = std::min(most, steps.size() - first);
        auto part = columns.middleCols(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(count));
        std::vector<double> begin;
        for (std::size_t i = 0; i < count; ++i) begin.push_back(steps[first + i].knots[0]);
        const StepsTerm term(begin, one.knots[1] - one.knots[0]);
        if (plain_ && moves)
            part = problem_.row_scale.asDiagonal() * problem_.forward().shaped(physics_, unit(one.target), term, count);
        else if (plain_ && electric && !physics_.unsigned_current)
            part = problem_.row_scale.asDiagonal() * problem_.forward().shaped_electric(physics_, electric_unit(one.target), term, count);
        else
            for (std::size_t i = 0; i < count; ++i) part.col(static_cast<Eigen::Index>(i)) = of(steps[first + i]);
    }
    return columns;
}

const UnitResponse &ShapeColumns::unit(TermTarget target) {
    auto found = units_.find(target);
    if (found == units_.end())
        found = units_.emplace(target, unit_response(problem_.data(), physics_, problem_.forward().motion(), target)).first;
    return found->second;
}

const std::vector<Forward::ElectricSeries> &ShapeColumns::electric_unit(TermTarget target) {
    auto found = electric_units_.find(target);
    if (found == electric_units_.end()) found = electric_units_.emplace(target, problem_.forward().electric_unit(physics_, target)).first;
    return found->second;
}

namespace {

ShapeScore scored(const Candidate &c, const Eigen::MatrixXd &columns, const Screen &screen, const Dataset *keep) {
    ShapeScore s;
    s.candidate = c;
    s.assessment = screen.assess(columns, Eigen::VectorXd::Zero(columns.cols()), false);
    s.p_value = corrected(s.candidate, s.assessment);
    if (s.p_value < 1e-4) s.balance_fall = screen.best_balance_fall(columns, s.assessment);
    if (keep != nullptr) s.columns = SparseJacobian(*keep, columns);
    return s;
}

Eigen::MatrixXd rows_of(const std::vector<int> &wheels, const Dataset &data, const Eigen::MatrixXd &columns) {
    Eigen::MatrixXd part = Eigen::MatrixXd::Zero(columns.rows(), columns.cols());
    Eigen::Index first = 0;
    for (const Balance &b : data.balance) {
        const auto n = static_cast<Eigen::Index>(b.measured.size());
        if (std::find(wheels.begin(), wheels.end(), b.wheel) != wheels.end()) part.middleRows(first, n) = columns.middleRows(first, n);
        first += n;
    }
    return part;
}

// A shape of torque or voltage moves the rows of each wheel for itself: on some wheels it has the same columns there and nothing elsewhere.
void add_on_some_wheels(std::vector<ShapeScore> &list, const Problem &problem, const Screen &screen, const Candidate &shape,
                        const Eigen::MatrixXd &columns, const Dataset *keep) {
    if (!is_of_each_motor(shape) || shape.varies_between_wheels) return;
    for (const std::vector<int> &group : wheel_groups(problem.physics(), true)) {
        // what acts on one wheel turns the machine: in a straight drive the yaw rate tells of it better than its cause does
        if (shape.axis == Axis::yaw_rate && group.size() == 1) continue;
        list.push_back(scored(on_wheels(shape, group), rows_of(group, problem.data(), columns), screen, keep));
    }
}

// One that moves the body: a straight line alone (what is constant is one too), or the passes become too many.
void add_moving_on_some_wheels(std::vector<ShapeScore> &list, const Problem &problem, const Screen &screen, const Candidate &shape,
                               ShapeColumns &columns, const Dataset *keep) {
    if (shape.touched != stage_motion || !is_straight(shape) || shape.order > 0) return;
    const std::vector<Eigen::MatrixXd> each = columns.of_each_wheel(shape);
    if (each.empty()) return;
    for (const std::vector<int> &group : wheel_groups(problem.physics(), false)) {
        Eigen::MatrixXd part = Eigen::MatrixXd::Zero(each[0].rows(), each[0].cols());
        for (const int i : group) part += each[static_cast<std::size_t>(i)];
        list.push_back(scored(on_wheels(shape, group), part, screen, keep));
    }
}

// Something that changes at once: on all wheels, each and each axle, where it explains most.
void add_steps(std::vector<ShapeScore> &list, const Problem &problem, const Screen &screen, const Candidate &shape, ShapeColumns &columns,
               const Dataset *keep) {
    const std::vector<Candidate> steps = steps_of(shape);
    const Eigen::MatrixXd C = columns.of_steps(steps);
    const auto add_best = [&](const std::vector<int> &group) {
        const Eigen::MatrixXd own = group.empty() ? C : rows_of(group, problem.data(), C);
        std::optional<ShapeScore> best;
        Eigen::Index at = 0;
        for (std::size_t i = 0; i < steps.size(); ++i) {
            const auto j = static_cast<Eigen::Index>(i);
            ShapeScore s = scored(group.empty() ? steps[i] : on_wheels(steps[i], group), own.col(j), screen, nullptr);
            if (!best || s.assessment.gain > best->assessment.gain) best = std::move(s), at = j;
        }
        if (keep != nullptr) best->columns = SparseJacobian(*keep, own.col(at));
        list.push_back(std::move(*best));
    };
    add_best({});
    if (is_of_each_motor(shape))
        for (const std::vector<int> &group : wheel_groups(problem.physics(), true)) add_best(group);
}

// One hat at each inner knot and between two of them, as wide as the knots are apart and half as wide: a resonance has its own place.
void add_bumps(std::vector<ShapeScore> &list, const Screen &screen, const Candidate &shape, ShapeColumns &columns, const Dataset *keep) {
    Candidate fine = shape;
    fine.knots.clear();
    for (std::size_t j = 0; j < shape.knots.size(); ++j) {
        fine.knots.push_back(shape.knots[j]);
        if (j + 1 < shape.knots.size()) fine.knots.push_back(0.5 * (shape.knots[j] + shape.knots[j + 1]));
    }
    fine.strengths.assign(fine.knots.size(), shape.strengths[0]);
    fine.step.assign(fine.knots.size(), shape.step[0]);
    for (std::size_t j = 0; j < fine.strengths.size(); ++j) fine.strengths[j].slots[0].coefficient = static_cast<int>(j);
    const Eigen::MatrixXd C = columns.of(fine);
    const auto last = static_cast<std::size_t>(C.cols()) - 1;
    for (std::size_t j = 1; j < last; ++j)
        for (const std::size_t half : {2, 1}) {
            if (j < half || j + half > last) continue;
            Candidate bump = shape;
            bump.effect += ", a bump";
            bump.knots = {fine.knots[j - half], fine.knots[j], fine.knots[j + half]};
            bump.strengths = {fine.strengths[1]}; // the middle of its three
            const auto at = static_cast<Eigen::Index>(j);
            Eigen::VectorXd column = C.col(at);
            if (half == 2) column += 0.5 * (C.col(at - 1) + C.col(at + 1));
            list.push_back(scored(bump, column, screen, keep));
        }
}

} // namespace

std::vector<ShapeScore> all_shapes(Problem &problem, const Screen &screen, bool keeps) {
    const Dataset *keep = keeps ? &problem.data() : nullptr; // the columns: of no use where nothing is named
    std::vector<ShapeScore> list;
    ShapeColumns columns(problem);
    std::vector<Candidate> waves;
    for (const Candidate &c :
         shape_candidates(problem.data(), problem.forward().motion(), problem.physics(), problem.forward().winding_current_A())) {
        if (c.order > 0 && c.target == TermTarget::soil_strength) {
            waves.push_back(c);
            continue;
        }
        const Eigen::MatrixXd C = columns.of(c);
        list.push_back(scored(c, C, screen, keep));
        add_on_some_wheels(list, problem, screen, c, C, keep);
        add_moving_on_some_wheels(list, problem, screen, c, columns, keep);
        if (c.axis == Axis::abs_wheel_speed) add_bumps(list, screen, c, columns, keep);
        if (c.axis == Axis::time && !is_straight(c) && !problem.data().independent_rows) add_steps(list, problem, screen, c, columns, keep);
    }
    const std::vector<Eigen::MatrixXd> of_waves = columns.of_waves(waves);
    for (std::size_t i = 0; i < waves.size(); ++i) list.push_back(scored(waves[i], of_waves[i], screen, keep));
    std::stable_sort(list.begin(), list.end(),
                     [](const ShapeScore &a, const ShapeScore &b) { return a.assessment.gain > b.assessment.gain; });
    return list;
}

double smoothed_by(const ShapeScore &s, const Problem &problem, const Scatter &scatter) {
    if ((s.candidate.touched & stage_motion) == 0 || s.candidate.some_wheels) return 0;
    Physics with = problem.physics();
    s.candidate.prepare(with);
    for (std::size_t j = 0; j < with.terms.back().coefficients.size(); ++j)
        with.terms.back().coefficients[j] = s.assessment.strength[static_cast<Eigen::Index>(j)];
    return scatter.smoothed_by(problem.data(), with).dot(problem.row_scale.cwiseAbs2());
}

} // namespace traction::lab
