#include "shapes.h"

#include "candidate.h"
#include "host_tools/lab/fit/distribution.h"
#include "host_tools/lab/fit/scatter.h"
#include "host_tools/lab/fit/screen.h"
#include "host_tools/lab/fit/sparse_jacobian.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

namespace traction::lab {

struct ShapeScore {
    Candidate candidate;
    Assessment assessment;
    double p_value = 1, balance_fall = 0;
    SparseJacobian columns;
};

namespace {

constexpr double least_uneven = 0.06; // share of the error: a grip that varies by 6 % over 0.2 m gave up to 0.047 (plant on gravel, clean)
constexpr double some_wheels_share = 0.2; // of the chance of a false alarm, spent on shapes of one wheel or axle
constexpr double some_wheels_tried = 125; // electric shapes, and straight lines of the ground, x wheels and axles
constexpr double shapes_tried = 74;       // axes x targets, straight lines, bumps, waves and periods, less those that are near copies

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

// Columns of all shapes: those that move the body share the response to a unit of their target.
class ShapeColumns {
  public:
    explicit ShapeColumns(Problem &problem) : problem_(problem), physics_(problem.physics()) {
        plain_ = plain_currents(physics_) && physics_.terms.empty() && problem.forward().has_linear_base();
    }

    Eigen::MatrixXd of(const Candidate &c) {
        Physics at = physics_;
        c.prepare(at);
        const Term &term = *at.terms.back().term;
        const std::size_t count = c.strengths.size();
        const bool electric = (c.touched & (stage_torque | stage_voltage)) != 0 && (c.touched & (stage_motion | stage_sensors)) == 0;
        if (plain_ && count <= most_shapes && c.touched == stage_motion && c.target != TermTarget::body_force)
            return problem_.row_scale.asDiagonal() * problem_.forward().shaped(physics_, unit(c.target), term, count);
        if (plain_ && electric && !physics_.unsigned_current)
            return problem_.row_scale.asDiagonal() * problem_.forward().shaped_electric(physics_, electric_unit(c.target), term, count);
        Eigen::MatrixXd columns(problem_.row_scale.size(), static_cast<Eigen::Index>(count));
        for (std::size_t j = 0; j < count; ++j) columns.col(static_cast<Eigen::Index>(j)) = problem_.column(at, c.strengths[j], c.step[j]);
        return columns;
    }

    // Of a shape that moves the body, on each wheel alone; empty where that is not to be had in one pass.
    std::vector<Eigen::MatrixXd> of_each_wheel(const Candidate &c) {
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

    // Of waves, which come many and alike: as many as one pass holds.
    std::vector<Eigen::MatrixXd> of_waves(const std::vector<Candidate> &waves) {
        std::vector<Eigen::MatrixXd> list;
        for (std::size_t first = 0; first < waves.size(); first += most_shapes / 2) {
            const std::size_t last = std::min(waves.size(), first + most_shapes / 2);
            if (!plain_) {
                for (std::size_t i = first; i < last; ++i) list.push_back(of(waves[i]));
                continue;
            }
            StackedTerm all;
            for (std::size_t i = first; i < last; ++i) all.add(make_periodic(waves[i].axis, waves[i].order), 2);
            const Eigen::MatrixXd columns = problem_.row_scale.asDiagonal() *
                                            problem_.forward().shaped(physics_, unit(TermTarget::soil_strength), all, 2 * (last - first));
            for (Eigen::Index i = 0; i < columns.cols(); i += 2) list.push_back(columns.middleCols(i, 2));
        }
        return list;
    }

  private:
    const UnitResponse &unit(TermTarget target) {
        auto found = units_.find(target);
        if (found == units_.end())
            found = units_.emplace(target, unit_response(problem_.data(), physics_, problem_.forward().motion(), target)).first;
        return found->second;
    }
    const std::vector<Forward::ElectricSeries> &electric_unit(TermTarget target) {
        auto found = electric_units_.find(target);
        if (found == electric_units_.end())
            found = electric_units_.emplace(target, problem_.forward().electric_unit(physics_, target)).first;
        return found->second;
    }

    Problem &problem_;
    Physics physics_;
    bool plain_ = true;
    std::map<TermTarget, UnitResponse> units_;
    std::map<TermTarget, std::vector<Forward::ElectricSeries>> electric_units_;
};

// Two tests, corrected for their number and that of the shapes: of the coefficients (robust, but each costs a degree of freedom), and of
// the held-out error's fall over blocks (Diebold and Mariano, J. Business & Economic Statistics 13 (1995) 253). A curve is judged by the
// ranks of its falls: it may matter in few blocks only, whose falls are large and unlike; a wave, which any uneven ground fits a little all
// along, by their mean.
double corrected(const Candidate &c, const Assessment &a) {
    double falls = 1;
    if (c.order == 0) {
        falls = signed_rank_tail({a.block_gain.begin(), a.block_gain.end()});
    } else {
        const double blocks = static_cast<double>(a.block_gain.size()), t = a.gain_error > 0 ? a.gain / a.gain_error : 0;
        if (t > 0 && blocks > 1) falls = 0.5 * f_tail(t * t, 1, blocks - 1);
    }
    const double tried = c.some_wheels ? some_wheels_tried / some_wheels_share : shapes_tried / (1 - some_wheels_share);
    return std::min(1.0, 2 * tried * std::min(a.p_value, falls));
}

ShapeScore scored(const Candidate &c, const Eigen::MatrixXd &columns, const Screen &screen, const Dataset *keep) {
    ShapeScore s;
    s.candidate = c;
    s.assessment = screen.assess(columns, Eigen::VectorXd::Zero(columns.cols()), false);
    s.p_value = corrected(s.candidate, s.assessment);
    if (s.p_value < 1e-4) s.balance_fall = screen.best_balance_fall(columns, s.assessment);
    if (keep != nullptr) s.columns = SparseJacobian(*keep, columns);
    return s;
}

// Near to many laws of the catalogue: takes a name's place only where it does better beside all else.
bool is_straight(const Candidate &c) { return c.knots.size() == 2; }

// One value between two that are nothing: a resonance. What a curve of many values says of it is less sure.
bool is_bump(const Candidate &c) { return c.strengths.size() == 1; }

// Single wheels, and those that stand abreast (axles): at most eight wheels, or the shapes become too many. motors: those with a motor
// alone.
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
    c.effect += group.size() == 1 ? " on wheel " : " on wheels ";
    for (std::size_t i = 0; i < group.size(); ++i) c.effect += (i == 0 ? "" : " and ") + std::to_string(group[i]);
    return c;
}

// A shape of torque or voltage moves the rows of each wheel for itself: on some wheels it has the same columns there and nothing elsewhere.
void add_on_some_wheels(std::vector<ShapeScore> &list, const Problem &problem, const Screen &screen, const Candidate &shape,
                        const Eigen::MatrixXd &columns, const Dataset *keep) {
    const unsigned electric = stage_torque | stage_voltage;
    if ((shape.touched & electric) == 0 || (shape.touched & ~electric) != 0 || shape.varies_between_wheels) return;
    for (const std::vector<int> &group : wheel_groups(problem.physics(), true)) {
        Eigen::MatrixXd part = Eigen::MatrixXd::Zero(columns.rows(), columns.cols());
        Eigen::Index first = 0;
        for (const Balance &b : problem.data().balance) {
            const auto n = static_cast<Eigen::Index>(b.measured.size());
            if (std::find(group.begin(), group.end(), b.wheel) != group.end()) part.middleRows(first, n) = columns.middleRows(first, n);
            first += n;
        }
        list.push_back(scored(on_wheels(shape, group), part, screen, keep));
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

std::vector<ShapeScore> all_shapes(Problem &problem, const Screen &screen, bool keeps = false) {
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
        for (Eigen::Index j = 1; c.axis == Axis::abs_wheel_speed && j + 1 < C.cols(); ++j) {
            Candidate bump = c;
            bump.effect += ", a bump";
            const auto at = c.knots.begin() + j;
            bump.knots.assign(at - 1, at + 2);
            bump.strengths = {c.strengths[static_cast<std::size_t>(j)]};
            list.push_back(scored(bump, C.col(j), screen, keep));
        }
    }
    const std::vector<Eigen::MatrixXd> of_waves = columns.of_waves(waves);
    for (std::size_t i = 0; i < waves.size(); ++i) list.push_back(scored(waves[i], of_waves[i], screen, keep));
    std::stable_sort(list.begin(), list.end(),
                     [](const ShapeScore &a, const ShapeScore &b) { return a.assessment.gain > b.assessment.gain; });
    return list;
}

// Every ground's strength wanders along the way: that alone is not worth a word. Nor is it over slip, which grows where the ground is weak:
// at a steady pull the one follows from the other.
bool uneven(const Candidate &c) {
    return c.target == TermTarget::soil_strength && c.order == 0 &&
           (c.axis == Axis::time || c.axis == Axis::place || c.axis == Axis::path || c.axis == Axis::slip);
}

UnknownShape describe(const ShapeScore &s, double base_error) {
    UnknownShape u;
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
    for (std::size_t j = 0; j < s.candidate.knots.size(); ++j) {
        u.x.push_back(s.candidate.knots[j]);
        u.y.push_back(y[j]);
        u.low.push_back(y[j] - 1.96 * error[j]);
        u.high.push_back(y[j] + 1.96 * error[j]);
    }
    return u;
}

// A problem less one of its effects, at the same linearisation: its columns are handed out and what it contributes goes back into the
// residual.
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

// What the effect still gains where the shape's coefficients are free beside it.
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

// A curve through three values is no curve (a straight line or a bump is one), and one over wheels that each keep to a value of X is none
// either: f(X) may stand for anything that differed between them.
bool is_curve(const Candidate &shape) {
    return shape.order == 0 && !shape.varies_between_wheels &&
           (shape.knots.size() > 3 || is_straight(shape) || is_bump(shape) || shape.axis == Axis::direction ||
            shape.axis == Axis::other_current || shape.axis == Axis::axle_current || shape.axis == Axis::side_current);
}

// The confounding shape of which the effect is a proxy, if there is one: needed beside the effect, and explaining more than it by itself,
// while the effect is not needed beside the shape. A law that is right passes: no freer shape does better than it.
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

// The named effects that say the same as the shape. One that keeps more than half of what it gains beside it is about something else, and
// neither stands nor falls with it.
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

// Evidence that repeats: sure beside its scatter over blocks, or very sure by the test and not the work of two blocks alone.
bool repeats(const ShapeScore &s) {
    if (s.assessment.gain > 2.5 * s.assessment.gain_error) return true;
    Eigen::VectorXd gain = s.assessment.block_gain;
    std::sort(gain.begin(), gain.end());
    return s.p_value < 2e-3 && gain.size() > 2 && gain.head(gain.size() - 2).sum() > 0;
}

// What a shape that moves the body gains by smoothing the encoders' scatter: no evidence (fit/scatter.h).
class Smoothing {
  public:
    Smoothing(const Problem &problem, const Scatter &scatter) : problem_(problem), scatter_(scatter) {}
    double of(const ShapeScore &s) {
        if ((s.candidate.touched & stage_motion) == 0 || s.candidate.some_wheels) return 0;
        Physics with = problem_.physics();
        s.candidate.prepare(with);
        for (std::size_t j = 0; j < with.terms.back().coefficients.size(); ++j)
            with.terms.back().coefficients[j] = s.assessment.strength[static_cast<Eigen::Index>(j)];
        return (scatter_.squares - rounding_squares(problem_.data(), with)).cwiseProduct(scatter_.part).dot(problem_.row_scale.cwiseAbs2());
    }

  private:
    const Problem &problem_;
    const Scatter &scatter_;
};

} // namespace

ShapeFindings find_unknown(const Problem &first, const Problem &last, const std::vector<Candidate> &named, const DiagnoseOptions &options,
                           ShapeScores &of_first) {
    const std::size_t named_count = named.size();
    ShapeFindings findings;
    Problem at_last = last, at_first = first; // their forward models are moved about
    const auto beside_first = [&](const Screen &screen) -> const std::vector<ShapeScore> & {
        if (!of_first) of_first = std::make_shared<const std::vector<ShapeScore>>(all_shapes(at_first, screen));
        return *of_first;
    };
    const Screen last_screen(at_last);
    const Scatter scatter(last); // slow on stiff ground (at a steady speed counts beat with samples): it stands in few blocks, like a law
    const double least = named_count > 0 ? 0.05 : options.least_shape_gain;
    // a precise balance weighs little among all: there a shape may stand on that balance alone, if it is very sure
    const auto material = [&](const ShapeScore &s) {
        const double share = s.candidate.some_wheels ? 0.5 : 1; // one wheel's rows are few among all
        return s.assessment.gain > std::max({share * least, uneven(s.candidate) ? least_uneven : 0.0, of_scatter * scatter.share}) *
                                       last_screen.heldout_error() ||
               (s.balance_fall > 0.15 + scatter.share && s.p_value < 1e-4);
    };
    const bool alone = &first == &last && named_count == 0;
    std::vector<ShapeScore> of_last;
    if (!alone) of_last = all_shapes(at_last, last_screen, named_count > 0);
    const std::vector<ShapeScore> &scores = alone ? beside_first(last_screen) : of_last;
    const ShapeScore *best = nullptr;
    double best_gain = 0;
    Smoothing smoothing(last, scatter);
    for (const ShapeScore &s : scores) {
        if (!(s.p_value < options.shape_p_limit) || !material(s) || !repeats(s)) continue;
        ShapeScore sharp = s;
        const double smoothed = smoothing.of(s);
        sharp.assessment.gain -= smoothed;
        sharp.assessment.block_gain.array() -=
            smoothed / static_cast<double>(std::max<Eigen::Index>(1, sharp.assessment.block_gain.size()));
        if (sharp.assessment.gain < s.assessment.gain && (!material(sharp) || !repeats(sharp))) continue;
        // of shapes that do nearly as well, the one with the fewest coefficients
        if (best != nullptr && !(s.assessment.gain > 0.85 * best_gain && s.candidate.strengths.size() < best->candidate.strengths.size()))
            continue;
        if (best == nullptr) best_gain = s.assessment.gain;
        best = &s;
    }
    if (best != nullptr) findings.shape = describe(*best, last_screen.heldout_error());
    if (named_count == 0) return findings;
    for (std::size_t i = named_count; i-- > 0 && !findings.proxy;)
        if ((findings.cause = confounding_shape(last, named[i], scores, best, options))) findings.proxy = i;
    // where nothing is left that any shape would explain, no shape can do better than what was named
    double left = 0;
    for (const ShapeScore &s : scores) left = std::max(left, s.assessment.gain);
    if (!findings.shape && left < 0.01 * last_screen.heldout_error()) return findings;
    // does one shape alone do better than all that was named?
    const Screen first_screen(at_first);
    at_last.keep_scales(first);
    at_last.linearise();
    const Screen named_screen(at_last);
    const double named_gain = first_screen.heldout_error() - named_screen.heldout_error();
    for (const ShapeScore &s : beside_first(first_screen)) {
        if (!(s.p_value < options.shape_p_limit) || is_straight(s.candidate) || !(s.assessment.gain > 0.95 * named_gain)) continue;
        const std::vector<std::size_t> replaced = explained_by_shape(last, named, s.candidate.effect, scores);
        if (replaced.empty()) continue;
        // one shape in place of several effects is the simpler model; of one effect that leaves a shape behind only a proxy's name
        // goes
        const double margin = replaced.size() > 1 ? 0.95 : findings.shape ? 2.0 : options.shape_margin;
        const double error = sum_error(s.assessment.block_gain - (first_screen.block_error() - named_screen.block_error()));
        if (!(s.assessment.gain > margin * named_gain) || (replaced.size() == 1 && s.assessment.gain - named_gain < 2 * error)) continue;
        findings.shape = describe(s, first_screen.heldout_error());
        findings.replaced = replaced, findings.gain_squares = s.assessment.gain;
        return findings;
    }
    return findings;
}

} // namespace traction::lab
