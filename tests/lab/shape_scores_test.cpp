// Columns of structure-free shapes, as many in a pass as go (shape_scores.h), beside the differences of whole predictions: four wheels on
// soft ground that turn unlike.
#include "host_tools/lab/decision/columns.h"
#include "host_tools/lab/decision/shape_scores.h"
#include "host_tools/lab/decision/shapes.h"
#include "host_tools/lab/forward/rounding.h"
#include "tests/lab/four_wheels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>

namespace traction::lab {
namespace {

struct Shaped : hand_made::FourWheels {
    std::unique_ptr<Problem> problem;
    std::unique_ptr<Screen> screen;
    std::vector<ShapeScore> scores;
    // `friction`: what all drives have beside, over the wheel's speed.
    explicit Shaped(const std::string &more = "", double friction = 0) : FourWheels(more) {
        const Physics physics = make_physics(model);
        Physics truth = physics;
        if (friction != 0) {
            ExtraTerm term;
            term.target = TermTarget::wheel_friction;
            term.term = make_piecewise(Axis::abs_wheel_speed, {0, 4, 6, 8, 20});
            term.coefficients = {0, 0, friction, 0, 0};
            truth.terms.push_back(term);
        }
        measure(truth);
        problem = std::make_unique<Problem>(data, physics, free_parameters(model, physics));
        problem->gauss_newton(2);
        screen = std::make_unique<Screen>(*problem);
        scores = all_shapes(*problem, *screen, true);
    }
    const ShapeScore *find(const std::string &effect) const {
        for (const ShapeScore &s : scores)
            if (s.candidate.effect == effect) return &s;
        return nullptr;
    }
    // Of the shape's coefficient j, by predictions on either side of nothing.
    Eigen::VectorXd difference(const Candidate &c, std::size_t j) const {
        const double size = c.target == TermTarget::soil_strength || c.target == TermTarget::motor_constant ? 1e-3 : 1e-4;
        const auto at = [&](double x) {
            Physics p = problem->physics();
            c.prepare(p);
            c.strengths[j].add(p, x);
            return Forward(data).predict(p);
        };
        return ((at(size) - at(-size)) / (2 * size)).cwiseProduct(problem->row_scale);
    }
};

const Shaped &four_wheels() {
    static const Shaped one("", 0.03);
    return one;
}

std::vector<int> wheels_of(const std::string &effect) {
    std::vector<int> list;
    if (const std::size_t at = effect.find(" on wheel"); at != std::string::npos)
        for (const char c : effect.substr(at))
            if (c >= '0' && c <= '9') list.push_back(c - '0');
    return list;
}

void expect_columns(const Shaped &f, const ShapeScore &s) {
    const Eigen::MatrixXd C = s.columns.whole();
    ASSERT_EQ(static_cast<std::size_t>(C.cols()), s.candidate.strengths.size());
    EXPECT_EQ(s.candidate.on, wheels_of(s.candidate.effect));
    for (Eigen::Index j = 0; j < C.cols(); ++j) {
        const Eigen::VectorXd by = f.difference(s.candidate, static_cast<std::size_t>(j));
        // to first order of what bends: a hundredth of the column, and what a search of 1e-5 m/s leaves of a body's speed
        EXPECT_LT((C.col(j) - by).norm(), 0.01 * by.norm() + 1e-3) << s.candidate.effect << ' ' << j;
    }
}

// The lead that an axle or a side shares: 0.4 ohm of Ia take 0.4 V per ampere from a motor's voltage, so its current by that falls by
// 0.4 / 3 of what the others' torques ask for. 0 and 1 are in front, 0 and 2 to the left.
TEST(Terms, over_the_currents_of_others_have_them_in_every_prediction) {
    const Shaped &f = four_wheels();
    const Physics plain = make_physics(f.model);
    const Eigen::VectorXd without = Forward(f.data).predict(plain);
    for (const auto &[name, axis] : {std::pair{"Io", Axis::other_current}, {"Ia", Axis::axle_current}, {"Is", Axis::side_current}}) {
        ExtraTerm line, by_knots;
        line.target = by_knots.target = TermTarget::voltage;
        line.term = make_expression(std::string("c*") + name, {"c"}), line.coefficients = {0.4};
        by_knots.term = make_piecewise(axis, {-20, 20}), by_knots.coefficients = {-8, 8};
        for (const ExtraTerm &term : {line, by_knots}) {
            Physics physics = plain;
            physics.terms.push_back(term);
            Forward forward(f.data);
            const Eigen::VectorXd with = forward.predict(physics);
            for (Eigen::Index i = 0; i < 4; ++i) {
                Eigen::VectorXd others = Eigen::VectorXd::Zero(120);
                for (Eigen::Index j = 0; j < 4; ++j)
                    if (j != i && (axis == Axis::other_current || (axis == Axis::axle_current ? j / 2 == i / 2 : j % 2 == i % 2)))
                        others += without.segment(120 * j, 120);
                EXPECT_GT(others.norm(), 1) << name;
                EXPECT_LT((with.segment(480 + 120 * i, 120) - without.segment(480 + 120 * i, 120) + 0.4 / 3 * others).norm(),
                          1e-9 * others.norm())
                    << name << i;
            }
            EXPECT_EQ(with.head(480), without.head(480)); // what a motor's torque asks for is the same
            forward.set_base(physics);
            EXPECT_LT((forward.base() - with).norm(), 1e-9 * with.norm());
            forward.set_base(plain); // what another prediction asked for is not remembered
            EXPECT_LT((forward.base() - without).norm(), 1e-9 * with.norm());
            EXPECT_LT((forward.predict(physics) - with).norm(), 1e-9 * with.norm());
        }
    }
}

TEST(ShapeColumns, of_all_wheels_are_what_predictions_differ_by) {
    const Shaped &f = four_wheels();
    std::map<TermTarget, int> seen;
    for (const ShapeScore &s : f.scores) {
        if (s.candidate.some_wheels || is_bump(s.candidate) || is_step(s.candidate)) continue;
        expect_columns(f, s);
        ++seen[s.candidate.target];
    }
    for (const TermTarget target :
         {TermTarget::wheel_torque, TermTarget::wheel_friction, TermTarget::rolling, TermTarget::voltage, TermTarget::soil_strength,
          TermTarget::motor_constant, TermTarget::resistance, TermTarget::accel, TermTarget::radar})
        EXPECT_GT(seen[target], 0) << target_name(target);
    EXPECT_GT(seen[TermTarget::soil_strength], 16); // waves, more than two passes of eight columns
}

TEST(ShapeColumns, of_some_wheels_are_those_of_each_wheel_and_axle) {
    const Shaped &f = four_wheels();
    std::map<std::string, int> groups;
    for (const ShapeScore &s : f.scores) {
        if (!s.candidate.some_wheels) continue;
        expect_columns(f, s);
        ++groups[s.candidate.effect.substr(0, s.candidate.effect.find(" on wheel"))];
    }
    const unsigned electric = stage_torque | stage_voltage;
    for (const ShapeScore &s : f.scores) {
        const Candidate &c = s.candidate;
        if (c.some_wheels || is_bump(c) || is_step(c)) continue;
        const bool of_motors = (c.touched & electric) != 0 && (c.touched & ~electric) == 0 && !c.varies_between_wheels,
                   line_of_the_ground = c.touched == stage_motion && is_straight(c);
        EXPECT_EQ(groups[c.effect], of_motors || line_of_the_ground ? 6 : 0) << c.effect; // four wheels, two axles
    }
    EXPECT_EQ(groups["soil strength(time), a straight line"], 6);
    EXPECT_EQ(groups["torque(motor current)"], 6);
}

// Two wheels would hold a curve's columns of each in one pass; of what moves the body it is lines alone that are tried on one wheel.
// What acts on one wheel turns the machine: over the yaw rate no wheel has a shape of its own, all of them and an axle have.
TEST(ShapeColumns, over_the_yaw_rate_are_of_no_single_wheel) {
    hand_made::FourWheels turning;
    for (std::size_t k = 0; k < turning.data.count; ++k) turning.data.yaw_rate_rad_s[k] = std::sin(0.8 * turning.data.time(k));
    Problem problem(turning.data, make_physics(turning.model), free_parameters(turning.model, make_physics(turning.model)));
    problem.gauss_newton(2);
    std::size_t of_all = 0, of_axles = 0;
    for (const ShapeScore &s : all_shapes(problem, Screen(problem))) {
        if (s.candidate.axis != Axis::yaw_rate) continue;
        EXPECT_NE(s.candidate.on.size(), 1U) << s.candidate.effect;
        of_all += s.candidate.on.empty(), of_axles += s.candidate.on.size() == 2;
    }
    EXPECT_GT(of_all, 0U);
    EXPECT_GT(of_axles, 0U);
}

TEST(ShapeColumns, of_one_wheel_that_move_the_body_are_of_lines_alone) {
    hand_made::FourWheels two;
    two.model.wheel.resize(2), two.data.wheel.resize(2);
    std::erase_if(two.data.balance, [](const Balance &b) { return b.wheel > 1; });
    two.measure(make_physics(two.model));
    const Physics physics = make_physics(two.model);
    Problem problem(two.data, physics, free_parameters(two.model, physics));
    problem.gauss_newton(2);
    const Screen screen(problem);
    int lines = 0, curves = 0;
    for (const ShapeScore &s : all_shapes(problem, screen)) {
        if (!s.candidate.some_wheels || s.candidate.touched != stage_motion) continue;
        EXPECT_TRUE(is_straight(s.candidate) && s.candidate.order == 0) << s.candidate.effect;
        (is_straight(s.candidate) ? lines : curves) += 1;
    }
    EXPECT_GT(lines, 0);
    EXPECT_EQ(curves, 0);
}

TEST(ShapeColumns, of_a_bump_are_hats_at_the_knots_of_its_curve_and_between_them_of_two_widths) {
    const Shaped &f = four_wheels();
    const ShapeScore *curve = f.find("friction(wheel speed)");
    ASSERT_TRUE(curve);
    const std::vector<double> &knots = curve->candidate.knots;
    const double apart = knots[1] - knots[0];
    std::map<std::pair<int, int>, int> seen; // where it stands and how wide it is, in halves of what the knots are apart
    for (const ShapeScore &s : f.scores) {
        if (!is_bump(s.candidate)) continue;
        EXPECT_EQ(s.candidate.effect, "friction(wheel speed), a bump");
        ASSERT_EQ(s.candidate.knots.size(), 3U);
        expect_columns(f, s);
        ++seen[{static_cast<int>(std::lround(2 * (s.candidate.knots[1] - knots[0]) / apart)),
                static_cast<int>(std::lround((s.candidate.knots[2] - s.candidate.knots[0]) / apart))}];
    }
    const int last = 2 * static_cast<int>(knots.size()) - 2; // the log drives all speeds: the knots are evenly apart
    for (int at = 1; at < last; ++at) {
        EXPECT_EQ((seen[{at, 1}]), 1) << at;
        EXPECT_EQ((seen[{at, 2}]), at > 1 && at + 1 < last ? 1 : 0) << at;
    }
}

// Where it explains most: of each target on all wheels, of what each motor has for itself on each wheel and axle too.
TEST(ShapeColumns, of_steps_are_what_predictions_differ_by) {
    const Shaped &f = four_wheels();
    std::map<TermTarget, std::size_t> of_all, of_some;
    for (const ShapeScore &s : f.scores) {
        if (!is_step(s.candidate)) continue;
        expect_columns(f, s);
        ++(s.candidate.some_wheels ? of_some : of_all)[s.candidate.target];
    }
    using T = TermTarget;
    EXPECT_EQ(of_all, (std::map<T, std::size_t>{{T::wheel_friction, 1},
                                                {T::rolling, 1},
                                                {T::voltage, 1},
                                                {T::soil_strength, 1},
                                                {T::motor_constant, 1},
                                                {T::resistance, 1},
                                                {T::accel, 1}}));
    EXPECT_EQ(of_some, (std::map<T, std::size_t>{{T::wheel_friction, 6}, {T::voltage, 6}, {T::motor_constant, 6}, {T::resistance, 6}}));
}

// One of the sixteen, and not the first that comes.
TEST(ShapeScores, of_steps_are_those_of_the_one_that_explains_most) {
    const Shaped &f = four_wheels();
    const auto step = std::find_if(f.scores.begin(), f.scores.end(), [](const ShapeScore &s) {
        return is_step(s.candidate) && !s.candidate.some_wheels && s.candidate.target == TermTarget::wheel_friction;
    });
    const ShapeScore *over_time = f.find("friction(time)");
    ASSERT_TRUE(step != f.scores.end() && over_time != nullptr);
    Problem problem = *f.problem;
    ShapeColumns columns(problem);
    int better = 0;
    for (const Candidate &c : steps_of(over_time->candidate)) {
        const Assessment a = f.screen->assess(columns.of_steps({c}), Eigen::VectorXd::Zero(1), false);
        EXPECT_LE(a.gain, step->assessment.gain * (1 + 1e-9));
        better += a.gain > step->assessment.gain * (1 - 1e-9) ? 1 : 0;
    }
    EXPECT_EQ(better, 1);
}

TEST(ShapeScores, are_sorted_by_gain_with_their_corrected_p_and_the_fall_of_a_balance_where_they_are_very_sure) {
    const Shaped &f = four_wheels();
    EXPECT_TRUE(std::is_sorted(f.scores.begin(), f.scores.end(),
                               [](const ShapeScore &a, const ShapeScore &b) { return a.assessment.gain > b.assessment.gain; }));
    bool sure = false, unsure = false;
    for (const ShapeScore &s : f.scores) {
        const Eigen::MatrixXd C = s.columns.whole();
        EXPECT_NEAR(s.assessment.gain, f.screen->assess(C, Eigen::VectorXd::Zero(C.cols()), false).gain,
                    1e-6 * std::fabs(s.assessment.gain) + 1e-6);
        EXPECT_EQ(s.p_value, corrected(s.candidate, s.assessment));
        EXPECT_EQ(s.balance_fall, s.p_value < 1e-4 ? f.screen->best_balance_fall(C, s.assessment) : 0) << s.candidate.effect;
        (s.p_value < 1e-4 ? sure : unsure) = true;
    }
    EXPECT_TRUE(sure && unsure);
    EXPECT_EQ(f.scores[0].candidate.target, TermTarget::wheel_friction) << f.scores[0].candidate.effect; // what is hidden
    EXPECT_EQ(f.scores[0].candidate.axis, Axis::abs_wheel_speed);
    Problem again = *f.problem;
    for (const ShapeScore &s : all_shapes(again, *f.screen)) ASSERT_EQ(s.columns.cols(), 0); // not kept unasked
}

// A lag of the wheels' traction that begins at nothing, or heating, is in no pass beside the base: the columns are differences there.
TEST(ShapeColumns, of_a_machine_that_remembers_are_differences) {
    for (const char *more :
         {"[[effect]]\nname = \"relaxation_length\"\nlength_m = 0.05\n", "[[effect]]\nname = \"current_gain\"\nchange = 0.1\n"}) {
        Shaped f(more);
        std::size_t waves = 0, others = 0; // every seventh
        for (const ShapeScore &s : f.scores) {
            std::size_t &seen = s.candidate.order > 0 ? waves : others;
            if (!is_bump(s.candidate) && seen++ % 7 == 0) expect_columns(f, s);
        }
        EXPECT_GT(waves, 16U);
        EXPECT_GT(others, 50U);
    }
}

TEST(Smoothed, is_what_a_shape_that_moves_the_body_takes_off_the_encoders_scatter) {
    const Shaped &f = four_wheels();
    const Scatter scatter(*f.problem);
    EXPECT_GT(scatter.squares.sum(), 0);
    const Eigen::VectorXd weight = f.problem->row_scale.cwiseAbs2();
    ShapeScore s = *f.find("soil strength(speed)");
    s.assessment.strength.setConstant(-0.5); // half of the grip
    Physics soft = f.problem->physics();
    for (WheelPhysics &w : soft.wheel) w.mu *= 0.5;
    const Eigen::VectorXd squares = rounding_squares(f.data, soft);
    const double by_hand = (scatter.squares - squares).cwiseProduct(scatter.part).dot(weight);
    EXPECT_NEAR(smoothed_by(s, *f.problem, scatter), by_hand, 1e-6 * std::fabs(by_hand));
    EXPECT_NE(by_hand, 0);
    s.candidate.some_wheels = true; // of some wheels, and of what leaves the motion alone, nothing
    EXPECT_EQ(smoothed_by(s, *f.problem, scatter), 0);
    ShapeScore torque = *f.find("torque(wheel speed)");
    torque.assessment.strength.setConstant(-0.5);
    EXPECT_EQ(smoothed_by(torque, *f.problem, scatter), 0);
}

// Of a catalogue's law its strength from nothing, as it may be in a log: to either side, or to one where it has no other.
Eigen::VectorXd difference(const Shaped &f, const Candidate &c, std::size_t j) {
    const double size = 1e-4 * (c.maximum[j] - c.minimum[j]);
    const auto at = [&](double x) {
        Physics p = f.problem->physics();
        c.prepare(p);
        c.strengths[j].add(p, x);
        return Forward(f.data).predict(p);
    };
    return ((at(size) - at(-size)) / (2 * size)).cwiseProduct(f.problem->row_scale);
}

TEST(Columns, of_the_catalogue_are_what_predictions_differ_by_on_all_wheels_and_on_each) {
    const Shaped &f = four_wheels();
    Problem at = *f.problem;
    Columns::Cache cache;
    Columns columns(at, cache);
    std::map<std::string, int> seen;
    for (const Candidate &c : catalogue_candidates(f.model, f.data, at.forward().motion())) {
        if (find_handle(c.effect)->remembers || c.effect.ends_with("_patch") || c.wheel > 1) continue;
        if (++seen[c.label()] > 2) continue; // two variants of each
        const Eigen::MatrixXd C = columns.of(c);
        ASSERT_EQ(static_cast<std::size_t>(C.cols()), c.strengths.size());
        for (Eigen::Index j = 0; j < C.cols(); ++j) {
            const Eigen::VectorXd by = difference(f, c, static_cast<std::size_t>(j));
            EXPECT_LE((C.col(j) - by).norm(), 0.02 * by.norm() + 1e-6) << c.label() << ' ' << j;
        }
    }
    EXPECT_GT(seen.size(), 40U);
}

// Patches whose edges lie on those of the cells are exact sums of them: 32 cells of the path at most, an eighth of a metre at least.
TEST(Columns, of_a_patch_are_those_of_the_cells_that_it_covers) {
    const Shaped &f = four_wheels();
    Problem at = *f.problem;
    Columns::Cache cache;
    Columns columns(at, cache);
    const std::vector<double> &path = at.forward().motion().path_m;
    const auto [low, high] = std::minmax_element(path.begin(), path.end());
    const double cell = std::max(0.125, (*high - *low) / 32);
    for (const char *effect : {"soil_patch", "resistance_patch"}) {
        Candidate c;
        for (const Candidate &one : catalogue_candidates(f.model, f.data, at.forward().motion()))
            if (one.effect == effect && one.wheel < 0) c = one;
        ASSERT_FALSE(c.effect.empty()) << effect;
        for (const auto &[first, count] : {std::pair{3, 9}, std::pair{0, 1}, std::pair{11, 14}}) {
            c.variant = {{"start_m", *low + first * cell}, {"length_m", count * cell}};
            const Eigen::VectorXd by = difference(f, c, 0), column = columns.of(c).col(0);
            // an edge lies within a step of the grid: of few cells a part
            EXPECT_LT((column - by).norm(), 0.1 * by.norm()) << effect << first;
        }
        const auto whole = [&](int first, double count) {
            c.variant = {{"start_m", *low + first * cell}, {"length_m", count * cell}};
            return Eigen::VectorXd(columns.of(c).col(0));
        };
        const Eigen::VectorXd half = whole(7, 2.5), two = whole(7, 2), three = whole(7, 3);
        EXPECT_LT((half - 0.5 * (two + three)).norm(), 1e-9 * three.norm()) << effect;
        EXPECT_LT((whole(5, 4) - whole(5, 3) - whole(8, 1)).norm(), 1e-9 * three.norm()) << effect;
    }
}

} // namespace
} // namespace traction::lab
