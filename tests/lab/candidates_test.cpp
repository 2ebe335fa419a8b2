// What the lab tries: its candidates, where the knots of a free shape lie, its expressions and its sensitivities. Truth: closed forms and
// the definitions in the headers.
#include "host_tools/lab/decision/candidate.h"
#include "host_tools/lab/decision/columns.h"
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/decision/knots.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "sim/physics/effects/catalogue.h"
#include "tests/lab/generator/generator.h"

#include <cstdint>
#include <gtest/gtest.h>
#include <map>
#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace traction::lab {
namespace {

std::vector<double> even_values(double low, double high, int count = 1001) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(low + (high - low) * i / (count - 1));
    return values;
}

void expect_knots(const std::vector<double> &knots, const std::vector<double> &wanted, double within) {
    ASSERT_EQ(knots.size(), wanted.size());
    for (std::size_t i = 0; i < knots.size(); ++i) EXPECT_NEAR(knots[i], wanted[i], within) << i;
}

TEST(Knots, lie_at_quantiles_and_never_close_together) {
    expect_knots(knots_on(Axis::slip, even_values(0, 1), true), {0.02, 0.2, 0.4, 0.6, 0.8, 0.98}, 1e-3);
    std::vector<double> mostly_still(900, 0.0);
    for (const double x : even_values(0, 1, 101)) mostly_still.push_back(x);
    const std::vector<double> knots = knots_on(Axis::slip, mostly_still, false);
    ASSERT_GE(knots.size(), 2U);
    for (std::size_t i = 1; i < knots.size(); ++i) EXPECT_GT(knots[i] - knots[i - 1], 0.02 * (knots.back() - knots.front()) - 1e-9);
    EXPECT_LT(knots.size(), 4U); // five of the six quantiles are one
}

TEST(Knots, lie_in_even_steps_where_most_of_the_time_is_spent_at_one_value) {
    std::vector<double> straight(2000, 0.0);
    for (const double x : even_values(-1, 1)) straight.push_back(x);
    const std::vector<double> knots = knots_on(Axis::yaw_rate, straight, false);
    ASSERT_EQ(knots.size(), 6U);
    for (std::size_t i = 2; i < knots.size(); ++i)
        EXPECT_NEAR((knots[i] - knots[i - 1]) / (knots.back() - knots.front()), i == 5 ? 0.1875 : 0.2083, 2e-3); // (q - 0.02) / 0.96
    EXPECT_NEAR(knots.back(), -knots.front(), 5e-3);
}

TEST(Knots, of_the_size_of_a_wheels_speed_go_from_zero_to_the_fastest_and_leave_out_what_was_not_driven) {
    const std::vector<double> all = knots_on(Axis::abs_wheel_speed, even_values(0, 8), false);
    ASSERT_EQ(all.size(), 9U);
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_NEAR(all[i], static_cast<double>(i), 0.01);
    std::vector<double> slow = even_values(0, 3.4, 5000); // and one sprint
    slow.push_back(8);
    const std::vector<double> seen = knots_on(Axis::abs_wheel_speed, slow, false);
    expect_knots(seen, {0, 1, 2, 3, 8}, 0.01);
}

TEST(Knots, of_a_saturating_torque_lie_at_the_ends_of_the_current) {
    expect_knots(knots_on(Axis::current, even_values(-1, 2), true), {-1.985, -0.9925, 0, 0.9925, 1.985}, 5e-3); // quantile 0.995
    expect_knots(knots_on(Axis::current, even_values(-2, 1), true), {-1.985, -0.9925, 0, 0.9925, 1.985}, 5e-3);
    EXPECT_EQ(knots_on(Axis::current, even_values(-1, 2), false).size(), 6U); // a voltage over the current is a curve like others
}

TEST(Knots, of_a_bridge_crowd_about_zero_volts) {
    const double end = 0.96 * 5; // 0.98 of -5 to 5
    expect_knots(knots_on(Axis::voltage, even_values(-5, 5), false),
                 {-end, -0.25 * end, -0.12 * end, -0.04 * end, 0.04 * end, 0.12 * end, 0.25 * end, end}, 0.02);
    EXPECT_TRUE(knots_on(Axis::voltage, even_values(0, 0.09), false).empty());
}

TEST(Knots, of_a_turn_are_a_twelfth_of_it_apart_and_its_angle_begins_anew_at_half_a_turn) {
    const std::vector<double> knots = knots_on(Axis::turn, even_values(0, 40), false);
    ASSERT_EQ(knots.size(), 13U);
    for (std::size_t i = 0; i < 13; ++i) EXPECT_NEAR(knots[i], std::numbers::pi / 6 * (static_cast<double>(i) - 6), 1e-12);
    const auto within = [](double theta) {
        Signals s;
        s.theta = theta;
        return axis_value(Axis::turn, s);
    };
    const double turn = 2 * std::numbers::pi;
    for (const double theta : {0.0, 1.0, -3.1, 3.1})
        for (const double turns : {0.0, 1.0, -7.0, 40.0}) EXPECT_NEAR(within(theta + turns * turn), theta, 1e-12) << theta << turns;
    EXPECT_NEAR(within(3.2), 3.2 - turn, 1e-12);
}

TEST(Knots, of_reversal_direction_and_other_motors) {
    EXPECT_EQ(knots_on(Axis::direction, even_values(-1, 1), false), (std::vector<double>{-0.9, 0, 0.9}));
    EXPECT_EQ(knots_on(Axis::reversal, even_values(-0.5, 0.5), false), (std::vector<double>{-0.4, -0.1, -0.005, 0.005, 0.1, 0.4}));
    expect_knots(knots_on(Axis::axle_current, even_values(-1, 1), false), {-0.96, 0, 0.96}, 5e-3);
    expect_knots(knots_on(Axis::axle_current, even_values(1, 2), false), {1.02, 1.5, 1.98}, 5e-3);
    EXPECT_TRUE(knots_on(Axis::side_current, std::vector<double>(100, 1.0), false).empty());
}

struct Log {
    Model model = read_model("models/rover_sand.toml");
    Dataset data;
    explicit Log(const std::string &hidden, double duration_s = 60, std::uint64_t seed = 5) {
        generator::GeneratorConfig config;
        config.duration_s = duration_s;
        config.seed = seed;
        if (!hidden.empty()) config.hidden = {generator::parse_setting(hidden)};
        data = make_dataset(model, generator::generate(config));
    }
    Problem fitted() const {
        const Physics physics = make_physics(model);
        Problem problem(data, physics, free_parameters(model, physics));
        problem.fit({});
        return problem;
    }
};

const Log &plain() {
    static const Log log("", 40);
    return log;
}

TEST(Axes, take_each_wheels_own_values_or_the_bodys) {
    Problem problem = plain().fitted();
    const Motion &motion = problem.forward().motion();
    const auto on = [&](Axis axis) {
        return values_on(axis, plain().data, motion, problem.physics(), problem.forward().winding_current_A());
    };
    const std::size_t count = plain().data.count, wheels = plain().data.wheel.size();
    const AxisValues speed = on(Axis::wheel_speed), size = on(Axis::abs_wheel_speed), time = on(Axis::time);
    ASSERT_EQ(speed.values.size(), wheels * ((count + 9) / 10));
    for (std::size_t k = 0; k < speed.values.size(); ++k) EXPECT_EQ(size.values[k], std::fabs(speed.values[k]));
    EXPECT_EQ(speed.values[1], plain().data.wheel[0].speed_rad_s[10]);
    EXPECT_LT(*std::min_element(speed.values.begin(), speed.values.end()), 0);
    EXPECT_EQ(time.values.front(), plain().data.time(0));
    EXPECT_EQ(time.values[1], plain().data.time(20));
    EXPECT_FALSE(speed.varies_between_wheels); // all drive through all speeds
    EXPECT_TRUE(on(Axis::load).varies_between_wheels || motion.wheel[0].load_N.size() < 2 ||
                motion.wheel[0].load_N == motion.wheel[2].load_N);
    const auto &current = problem.forward().winding_current_A();
    EXPECT_NEAR(on(Axis::axle_current).values[3], current[1][30], 1e-12); // of wheel 0: its axle's other motor
    EXPECT_NEAR(on(Axis::side_current).values[3], current[2][30], 1e-12);
    EXPECT_NEAR(on(Axis::other_current).values[3], current[1][30] + current[2][30] + current[3][30], 1e-12);
}

std::vector<Candidate> candidates(const Model &model) {
    static Problem problem = plain().fitted();
    return catalogue_candidates(model, plain().data, problem.forward().motion());
}

TEST(Candidates, are_every_effect_of_the_catalogue_on_all_wheels_and_on_each) {
    std::set<std::string> effects, labels;
    for (const Candidate &c : candidates(plain().model)) {
        effects.insert(c.effect), labels.insert(c.label());
        const sim::Effect *effect = sim::find_effect(c.effect);
        ASSERT_NE(effect, nullptr);
        EXPECT_TRUE(c.wheel < 0 || effect->per_wheel) << c.label();
        ASSERT_FALSE(c.strengths.empty());
        for (std::size_t j = 0; j < c.strengths.size(); ++j) {
            EXPECT_GT(c.of_interest[j], 0) << c.label();
            EXPECT_GT(c.step[j], 0) << c.label();
            EXPECT_LT(c.minimum[j], c.maximum[j]) << c.label();
            EXPECT_LE(c.strengths[j].minimum, c.minimum[j] + 1e-12) << c.label();
            EXPECT_GE(c.strengths[j].maximum, c.maximum[j] - 1e-12) << c.label();
            EXPECT_EQ(c.strengths[j].slots.size() > 1, c.wheel < 0 && c.strengths[j].slots[0].in_body == nullptr) << c.label();
        }
    }
    for (const sim::Effect &effect : sim::catalogue()) {
        EXPECT_EQ(effects.count(std::string(effect.name)), 1U) << effect.name;
        EXPECT_EQ(labels.count(std::string(effect.name) + " on wheel 3"), effect.per_wheel ? 1U : 0U) << effect.name;
    }
}

TEST(Candidates, count_all_that_are_like_them) {
    std::map<std::string, int> count;
    const std::vector<Candidate> list = candidates(plain().model);
    for (const Candidate &c : list) ++count[c.effect];
    for (const Candidate &c : list) EXPECT_EQ(c.variants, count[c.effect]) << c.label();
}

TEST(Candidates, leave_out_what_the_model_holds_and_what_would_be_its_second_copy) {
    Model model = plain().model;
    const auto labels = [&] {
        std::set<std::string> out;
        for (const Candidate &c : candidates(model)) out.insert(c.label());
        return out;
    };
    model.effects.push_back(effect_of(candidates(plain().model).front(), {0.02}));
    model.effects.back().name = "coulomb_friction", model.effects.back().wheel = 1;
    model.effects.back().parameters = {{"torque_Nm", Parameter{}}};
    const std::set<std::string> beside = labels();
    EXPECT_EQ(beside.count("coulomb_friction"), 0U);
    EXPECT_EQ(beside.count("coulomb_friction on wheel 1"), 0U);
    EXPECT_EQ(beside.count("coulomb_friction on wheel 0"), 1U);
    EXPECT_EQ(beside.count("viscous_friction"), 1U);
    model.effects.back().wheel = -1;
    EXPECT_EQ(labels().count("coulomb_friction on wheel 0"), 0U);
}

TEST(Candidates, of_a_patch_cover_the_driven_path_by_halves_of_themselves) {
    Problem problem = plain().fitted();
    const std::vector<double> &path = problem.forward().motion().path_m;
    const auto [low, high] = std::minmax_element(path.begin(), path.end());
    std::map<double, std::vector<double>> starts; // by length
    for (const Candidate &c : catalogue_candidates(plain().model, plain().data, problem.forward().motion()))
        if (c.effect == "soil_patch") starts[c.variant[1].second].push_back(c.variant[0].second);
    ASSERT_FALSE(starts.empty());
    for (const auto &[length, list] : starts) {
        EXPECT_LE(length, 0.6 * (*high - *low));
        EXPECT_NEAR(list.front(), *low, 0.006); // rounded to centimetres
        for (std::size_t i = 1; i < list.size(); ++i) EXPECT_NEAR(list[i] - list[i - 1], std::max(length / 2, (*high - *low) / 24), 0.011);
        EXPECT_LT(list.back() + 0.5 * length, *high + 0.006);
        EXPECT_GE(list.back() + 0.5 * length + std::max(length / 2, (*high - *low) / 24),
                  *high - 0.011); // the next would lie beyond the end
    }
}

TEST(Candidates, become_effects_of_a_model_with_their_sizes_and_shapes) {
    const std::vector<Candidate> list = candidates(plain().model);
    const auto c =
        std::find_if(list.begin(), list.end(), [](const Candidate &one) { return one.effect == "stribeck_friction" && one.wheel == 2; });
    ASSERT_NE(c, list.end());
    const EffectUse use = effect_of(*c, {0.04});
    EXPECT_EQ(use.name, "stribeck_friction");
    EXPECT_EQ(use.wheel, 2);
    EXPECT_EQ(use.parameters.at("torque_Nm").value, 0.04);
    EXPECT_FALSE(use.parameters.at("torque_Nm").fixed);
    EXPECT_EQ(use.parameters.at("torque_Nm").maximum, c->strengths[0].maximum);
    EXPECT_EQ(use.parameters.at("speed_rad_s").value, c->variant[0].second);
    EXPECT_EQ(use.parameters.at("speed_rad_s").unit, "rad/s");
}

TEST(Expressions, of_a_shape_run_through_its_values_and_stay_level_beyond_them) {
    Candidate c;
    c.axis = Axis::wheel_speed;
    c.knots = {-2, 0, 3, 4};
    const std::vector<double> y = {0.5, -0.25, 0.125, 1};
    mu::Parser parser;
    double w = 0;
    parser.DefineVar("w", &w);
    parser.SetExpr(shape_expression(c, y));
    for (double x = -3; x <= 5; x += 0.25) {
        double wanted = x <= -2 ? y.front() : y.back();
        for (std::size_t i = 1; i < c.knots.size(); ++i)
            if (x >= c.knots[i - 1] && x <= c.knots[i])
                wanted = y[i - 1] + (y[i] - y[i - 1]) * (x - c.knots[i - 1]) / (c.knots[i] - c.knots[i - 1]);
        w = x;
        EXPECT_NEAR(parser.Eval(), wanted, 1e-3) << x; // four digits are printed
    }
    c.order = 3, c.axis = Axis::angle;
    double theta = 0.7;
    parser.DefineVar("theta", &theta);
    parser.SetExpr(shape_expression(c, {0.5, -0.25}));
    EXPECT_NEAR(parser.Eval(), 0.5 * std::cos(2.1) - 0.25 * std::sin(2.1), 1e-9);
}

TEST(Columns, of_all_wheels_are_the_sum_of_each_and_of_a_patch_the_sum_of_its_halves) {
    Problem problem = plain().fitted();
    Columns::Cache cache;
    Columns columns(problem, cache);
    std::vector<Candidate> list = catalogue_candidates(plain().model, plain().data, problem.forward().motion());
    Eigen::VectorXd whole, sum;
    for (const Candidate &c : list) {
        if (c.effect != "coulomb_friction") continue;
        const Eigen::VectorXd column = columns.of(c).col(0);
        if (c.wheel < 0)
            whole = column;
        else
            sum = sum.size() == 0 ? column : Eigen::VectorXd(sum + column);
    }
    ASSERT_GT(whole.norm(), 0);
    EXPECT_LT((whole - sum).norm(), 1e-6 * whole.norm());

    const auto patch = std::find_if(list.begin(), list.end(), [](const Candidate &c) { return c.effect == "soil_patch"; });
    ASSERT_NE(patch, list.end());
    const auto column_of = [&](double start, double length) {
        Candidate c = *patch;
        c.variant = {{"start_m", start}, {"length_m", length}};
        return Eigen::VectorXd(columns.of(c).col(0));
    };
    const Eigen::VectorXd one = column_of(0.2, 1.0);
    ASSERT_GT(one.norm(), 0);
    EXPECT_LT((one - column_of(0.2, 0.4) - column_of(0.6, 0.6)).norm(), 1e-9 * one.norm());
    // cells of the path against the patch itself: an eighth of a metre of cells at each end of one metre of patch
    Physics at = problem.physics();
    at.body.patch_start_m = 0.2, at.body.patch_length_m = 1.0;
    const Eigen::VectorXd direct = problem.column(at, patch->strengths[0], patch->step[0]);
    EXPECT_GT(one.dot(direct) / (one.norm() * direct.norm()), 0.9);
    EXPECT_NEAR(one.norm() / direct.norm(), 1, 0.25);
}

// Nothing of the catalogue, though some of it comes near.
TEST(Verdict, of_a_law_that_no_catalogue_holds) {
    const Log log("friction_resonance:torque_Nm=0.05,speed_rad_s=4", 60, 31);
    const Diagnosis d = diagnose(log.model, log.data, {});
    ASSERT_TRUE(d.unknown) << d.text;
    EXPECT_NE(d.unknown->variable.find("speed"), std::string::npos) << d.text;
    ASSERT_GE(d.unknown->x.size(), 2U);
    ASSERT_EQ(d.unknown->x.size(), d.unknown->y.size());
    for (std::size_t i = 0; i < d.unknown->x.size(); ++i) {
        EXPECT_TRUE(i == 0 || d.unknown->x[i] > d.unknown->x[i - 1]);
        EXPECT_LE(d.unknown->low[i], d.unknown->y[i]);
        EXPECT_GE(d.unknown->high[i], d.unknown->y[i]);
    }
    EXPECT_GT(d.unknown->gain, 0.02);
    EXPECT_FALSE(d.unknown->expression.empty());
    EXPECT_EQ(std::count(d.effects.begin(), d.effects.end(), "viscous_friction"), 0) << d.text; // its proxy
}

} // namespace
} // namespace traction::lab
