// Whole diagnoses in milliseconds: a wheel at an imposed speed, read by an accelerometer, a radar and a gyro (linear_machine.h). What is
// hidden is known, and how large it must be told is a textbook's regression.
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/decision/knots.h"
#include "host_tools/lab/decision/shapes.h"
#include "host_tools/lab/fit/ladder.h"
#include "tests/lab/consistent.h"
#include "tests/lab/linear_machine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace traction::lab {
namespace {

using namespace hand_made;
using Labels = std::vector<std::string>;

constexpr double noise = 0.05;

struct Bench {
    LinearMachine machine;
    Model model;

    explicit Bench(std::size_t rows = 240) : machine(rows, noise) {
        for (Balance &b : machine.data.balance) b.noise = noise;
        model = parse_model("[rover]\nmotion = \"imposed\"\nmass_kg = 3\n[wheels]\nradius_m = 0.05\n[[wheel]]\n", "bench");
        const auto hold = [](Parameters &table) {
            for (auto &[key, p] : table) p.prior = p.each_wheel = 0;
        };
        hold(model.rover), hold(model.sensors);
        for (WheelSpec &w : model.wheel) hold(w.geometry), hold(w.motor), hold(w.soil);
        model.sensors["accel.bias_m_s2"].prior = 0.02, model.sensors["radar.scale"].prior = 0.005;
        model.sensors["gyro.bias_rad_s"].prior = 0.01;
        WheelInput wheel;
        double angle = 0;
        for (const double v : machine.data.body_speed_m_s) {
            wheel.speed_rad_s.push_back(v / 0.05), wheel.accel_rad_s2.push_back(0);
            wheel.angle_rad.push_back(angle), wheel.travel_rad.push_back(angle);
            angle += v / 0.05 * machine.data.step_s;
        }
        machine.data.wheel = {wheel};
    }
    void hide(const FreeParameter &p, double size) { machine.hide(p, size); }
    void add(std::size_t balance, const std::function<double(double)> &of_time) {
        Balance &b = machine.data.balance[balance];
        for (std::size_t r = 0; r < b.measured.size(); ++r) b.measured[r] += of_time(0.5 * (b.t0_s[r] + b.t1_s[r]));
    }
    Diagnosis ask(const DiagnoseOptions &options = {}) const {
        Diagnosis d = diagnose(model, machine.data, options);
        if (!machine.data.balance.empty() && machine.data.count > 2) expect_consistent(d, model, machine.data);
        return d;
    }

    // Size of the last parameter and its standard error by regression on all rows and the stated deviations; and what is left, in noises.
    struct Textbook {
        double size = 0, error = 0, left = 0;
    };
    // What is left where the radar's stated scale stands at its limit, six deviations.
    double radar_held(const FreeParameter &effect) const {
        Bench at = *this;
        at.hide(r0(), -0.03);
        std::vector<FreeParameter> all = {a0(0.02), g0(0.01), effect};
        const Eigen::MatrixXd J = at.machine.columns(all) / noise;
        const Eigen::VectorXd y = at.machine.left() / noise,
                              theta = ridge(J, y, Eigen::VectorXd::Ones(y.size()), Eigen::Vector3d(2500, 1e4, effect.prior > 0 ? 1e9 : 0));
        return std::sqrt((y - J * theta).squaredNorm() / static_cast<double>(y.size()));
    }
    Textbook textbook(const std::vector<FreeParameter> &effects) const {
        std::vector<FreeParameter> all = {a0(0.02), r0(0.005), g0(0.01)};
        all.insert(all.end(), effects.begin(), effects.end());
        const Eigen::MatrixXd J = machine.columns(all) / noise;
        const Eigen::VectorXd y = machine.left() / noise;
        Eigen::VectorXd precision = Eigen::VectorXd::Zero(J.cols());
        for (std::size_t i = 0; i < 3; ++i) precision[static_cast<Eigen::Index>(i)] = 1 / (all[i].prior * all[i].prior);
        Eigen::MatrixXd normal = J.transpose() * J;
        normal.diagonal() += precision;
        const Eigen::VectorXd theta = normal.fullPivLu().solve(J.transpose() * y);
        const Eigen::Index last = J.cols() - 1;
        return {theta[last], std::sqrt(normal.inverse()(last, last)),
                std::sqrt((y - J * theta).squaredNorm() / static_cast<double>(y.size()))};
    }
};

const CandidateResult &of(const std::vector<CandidateResult> &list, const std::string &label) {
    return *std::find_if(list.begin(), list.end(), [&](const CandidateResult &r) { return r.candidate.label() == label; });
}

void expect_size(const CandidateResult &r, const Bench::Textbook &by, double truth) {
    EXPECT_NEAR(r.value[0], by.size, 0.3 * by.error); // weights of single rows differ
    EXPECT_NEAR(r.value[0], truth, 3 * by.error);     // but for one log of 370
    EXPECT_NEAR(r.value[0], 0.5 * (r.low[0] + r.high[0]), 1e-9);
    const double half = 0.5 * (r.high[0] - r.low[0]); // robust: by 24 blocks, a seventh to one error of the error
    EXPECT_GT(half, 1.96 * 0.6 * by.error);
    EXPECT_LT(half, 2.1 * 1.6 * by.error);
}

TEST(Bench, of_which_nothing_is_hidden_names_nothing_and_tells_what_it_could_not_have_seen) {
    const Bench bench;
    int ticks = 0;
    DiagnoseOptions options;
    options.progress = [&](int done, int) { EXPECT_EQ(done, ++ticks); };
    const Diagnosis d = bench.ask(options);
    EXPECT_EQ(d.kind, "nothing") << d.text;
    EXPECT_TRUE(d.effects.empty() && d.accepted.empty() && d.classes.empty() && d.nearest.empty() && !d.unknown);
    ASSERT_EQ(d.ladder.size(), 1U);
    EXPECT_EQ(d.ladder[0].label, "baseline");
    EXPECT_NEAR(d.ladder[0].train, bench.textbook({}).left, 1e-3);
    EXPECT_GT(d.ladder[0].heldout, d.ladder[0].train);
    EXPECT_LT(d.ladder[0].heldout, 1.02 * d.ladder[0].train);
    EXPECT_TRUE(d.model.effects.empty());
    ASSERT_TRUE(d.stated_fit);
    const auto excited = [&](const char *effect) {
        return std::none_of(d.not_excited.begin(), d.not_excited.end(), [&](const auto &one) { return one.first == effect; });
    };
    for (const char *effect : {"accel_bias", "accel_drift", "radar_scale"}) {
        EXPECT_TRUE(excited(effect)) << effect;
        EXPECT_EQ(of(d.ranking, effect).verdict, "not_significant") << effect;
    }
    for (const char *effect : {"grade", "body_drag", "camera_scale", "coulomb_friction", "accel_scale"}) {
        EXPECT_FALSE(excited(effect)) << effect; // no current, no camera, no acceleration
        EXPECT_EQ(of(d.ranking, effect).verdict, "not_excited") << effect;
    }
    EXPECT_GE(static_cast<std::size_t>(ticks), d.ranking.size());
}

// What a diagnosis hands on for whoever asks the same again is what they would find.
void expect_same_fit(const Problem *handed_on, const Model &model, const Dataset &data) {
    ASSERT_NE(handed_on, nullptr);
    const Problem anew = fitted_problem(model, data);
    EXPECT_EQ(handed_on->theta, anew.theta);
    EXPECT_EQ(handed_on->residual, anew.residual);
    EXPECT_EQ(handed_on->jacobian, anew.jacobian);
    EXPECT_EQ(handed_on->row_scale, anew.row_scale);
}

TEST(Bench, whose_radar_is_off_names_that_with_its_size_and_interval) {
    Bench bench;
    bench.hide(r1(), 0.08);
    const Diagnosis d = bench.ask();
    ASSERT_EQ(d.effects, Labels{"radar_scale"}) << d.text;
    EXPECT_EQ(d.kind, "named");
    expect_size(d.accepted[0], bench.textbook({r1()}), 0.08);
    ASSERT_EQ(d.ladder.size(), 2U);
    EXPECT_EQ(d.ladder[1].label, "+ radar_scale");
    EXPECT_NEAR(d.ladder[0].train, bench.radar_held(a1(0.001)), 0.05);
    EXPECT_NEAR(d.ladder[1].train, bench.textbook({r1()}).left, 1e-3);
    EXPECT_LT(d.ladder[1].heldout, 1.02 * d.ladder[1].train);
    ASSERT_EQ(d.model.effects.size(), 1U);
    EXPECT_NEAR(d.model.effects[0].parameters.at("change").value, d.accepted[0].value[0], 0.3 * bench.textbook({r1()}).error);
    EXPECT_NEAR(overall_error(*d.model_fit), d.ladder[1].train, 1e-3);
    expect_same_fit(d.stated_fit.get(), bench.model, bench.machine.data);
    expect_same_fit(d.model_fit.get(), d.model, bench.machine.data);
    EXPECT_EQ(d.ranking[0].candidate.label(), "radar_scale");
    EXPECT_EQ(d.ranking[0].verdict, "named");
    EXPECT_LT(d.ranking[0].p_value, 1e-6);
    EXPECT_EQ(of(d.ranking, "accel_drift").verdict, "not_significant");
    EXPECT_TRUE(d.classes.empty() && !d.unknown && d.nearest.empty() && d.messages.empty());
}

// Each by itself and both: the one that explains more first, the other as needed beside it.
TEST(Bench, of_two_faults_names_both_the_larger_first) {
    Bench bench;
    bench.hide(r1(), 0.08), bench.hide(a2(), 0.003);
    const Diagnosis d = bench.ask();
    ASSERT_EQ(d.effects, (Labels{"accel_drift", "radar_scale"})) << d.text;
    EXPECT_EQ(d.kind, "named");
    expect_size(d.accepted[0], bench.textbook({r1(), a2()}), 0.003);
    expect_size(d.accepted[1], bench.textbook({a2(), r1()}), 0.08);
    ASSERT_EQ(d.ladder.size(), 3U);
    EXPECT_NEAR(d.ladder[1].train, bench.radar_held(a2()), 0.05); // the stated scale goes to its limit and no farther
    EXPECT_GT(d.ladder[1].heldout, d.ladder[1].train);
    EXPECT_NEAR(d.ladder[2].train, bench.textbook({a2(), r1()}).left, 1e-3);
    EXPECT_EQ(of(d.ranking, "radar_scale").verdict, "not_needed"); // of the first round
    EXPECT_EQ(of(d.ranking, "accel_bias").verdict, "not_needed");  // what the drift's mean looks like
    EXPECT_EQ(d.model.effects.size(), 2U);
    DiagnoseOptions one;
    one.most_effects = 1;
    EXPECT_EQ(bench.ask(one).effects, Labels{"accel_drift"});
    one.most_effects = 0;
    EXPECT_TRUE(bench.ask(one).effects.empty());
}

TEST(Bench, finds_what_the_first_name_uncovers) {
    Bench bench; // an offset and a drift that takes it back: by itself the drift says nothing
    bench.hide(a1(), 0.3), bench.hide(a2(), -0.0025);
    const Diagnosis d = bench.ask();
    ASSERT_EQ(d.effects, (Labels{"accel_bias", "accel_drift"})) << d.text;
    EXPECT_EQ(of(d.ranking, "accel_drift").verdict, "not_significant");
    expect_size(d.accepted[0], bench.textbook({a2(), a1()}), 0.3);
    expect_size(d.accepted[1], bench.textbook({a1(), a2()}), -0.0025);
}

TEST(Bench, asks_for_its_limit_of_p_and_for_a_size_of_interest) {
    Bench bench;
    bench.hide(r1(), 0.04);
    const Diagnosis d = bench.ask();
    ASSERT_LT(d.ladder.front().heldout, 1.4); // of three balances: the one is missed by less than twice its noise
    const double p = of(d.ranking, "radar_scale").p_value;
    DiagnoseOptions options;
    options.p_limit = 2 * p;
    EXPECT_EQ(bench.ask(options).effects, Labels{"radar_scale"});
    options.p_limit = 0.5 * p;
    EXPECT_TRUE(bench.ask(options).effects.empty());
    Bench little; // 0.02 is of interest; forty times as many rows would make it sure
    for (Balance &b : little.machine.data.balance) {
        b.noise /= 10;
        for (double &y : b.measured) y = 0.1 * y;
    }
    const Eigen::VectorXd v = little.machine.prediction({});
    for (std::size_t r = 0; r < 240; ++r) little.machine.data.balance[1].measured[r] += 0.9 * v[static_cast<Eigen::Index>(240 + r)];
    little.hide(r1(), 0.018);
    EXPECT_TRUE(little.ask().effects.empty());
}

// A law of no catalogue: what the radar's scale is at each speed.
struct Law {
    std::vector<double> knots, value = {0, 0, 0.12, 0.12, 0, 0};
    explicit Law(const Bench &bench) {
        std::vector<double> v;
        for (std::size_t k = 0; k < bench.machine.data.count; k += 10) v.push_back(bench.machine.data.body_speed_m_s[k]);
        knots = knots_on(Axis::abs_speed, v, false);
    }
    double operator()(double v) const {
        for (std::size_t i = 1; i < knots.size(); ++i)
            if (v < knots[i])
                return v < knots[0] ? value[0] : value[i - 1] + (value[i] - value[i - 1]) * (v - knots[i - 1]) / (knots[i] - knots[i - 1]);
        return value.back();
    }
    void put_into(Bench &bench) const {
        bench.add(1, [&](double t) {
            const double v = 2 + std::sin(0.7 * t);
            return v * (*this)(v);
        });
    }
};

void expect_law(const UnknownShape &u, const Law &law) {
    EXPECT_EQ(u.balance, "radar(speed)");
    EXPECT_EQ(u.variable, axis_name(Axis::abs_speed));
    ASSERT_EQ(u.x.size(), law.knots.size());
    for (std::size_t i = 0; i < u.x.size(); ++i) {
        EXPECT_DOUBLE_EQ(u.x[i], law.knots[i]);
        // four errors of six values, and what a row's mean over half a second rounds off the corners of: v moves by 0.35, a quarter of a
        // piece
        EXPECT_NEAR(u.y[i], law.value[i], 2 * (u.high[i] - u.low[i]) / 1.96 + 0.03) << i;
    }
}

TEST(Bench, whose_radar_follows_no_law_of_the_catalogue_tells_of_what_it_depends) {
    Bench bench;
    const Law law(bench);
    ASSERT_EQ(law.knots.size(), 6U);
    law.put_into(bench);
    const Diagnosis d = bench.ask();
    EXPECT_EQ(d.kind, "unknown") << d.text;
    EXPECT_TRUE(d.effects.empty());
    ASSERT_TRUE(d.unknown);
    expect_law(*d.unknown, law);
    EXPECT_EQ(d.ladder.size(), 1U);
    DiagnoseOptions options;
    options.shapes = false;
    EXPECT_FALSE(bench.ask(options).unknown);
    options.shapes = true, options.shape_p_limit = 0;
    EXPECT_FALSE(bench.ask(options).unknown);
}

TEST(Bench, of_a_law_of_the_catalogue_and_one_that_is_none_names_the_one_as_a_part) {
    Bench bench;
    const Law law(bench);
    law.put_into(bench);
    bench.hide(a2(), 0.003);
    const Diagnosis d = bench.ask();
    EXPECT_EQ(d.kind, "partial") << d.text;
    EXPECT_EQ(d.effects, Labels{"accel_drift"});
    ASSERT_TRUE(d.unknown);
    expect_law(*d.unknown, law);
    EXPECT_NEAR(d.accepted[0].value[0], 0.003, 3 * bench.textbook({a2()}).error);
}

// Of 120 s: the ninth of sixteen steps is the nearest to 60 s.
const char *const jump_in_the_middle = "accelerometer(time), a step at 62 s";

// A sensor that jumps in the middle looks like a drift, which leaves more than a curve over time does.
TEST(Bench, whose_accelerometer_jumps_tells_the_drift_as_the_nearest_and_not_the_cause) {
    Bench bench;
    bench.add(0, [](double t) { return t > 60 ? 0.4 : 0.0; });
    const Diagnosis d = bench.ask();
    EXPECT_EQ(d.kind, "unknown") << d.text;
    EXPECT_EQ(d.nearest, Labels{"accel_drift"});
    EXPECT_TRUE(d.effects.empty() && d.accepted.empty() && d.model.effects.empty());
    ASSERT_TRUE(d.unknown);
    EXPECT_EQ(d.unknown->variable, "time");
    EXPECT_EQ(d.unknown->balance, jump_in_the_middle);
    ASSERT_EQ(d.unknown->x.size(), 4U);
    EXPECT_NEAR(0.5 * (d.unknown->x[1] + d.unknown->x[2]), 60, 0.5 * 0.96 * 120 / 17); // half of what the steps are apart
    EXPECT_NEAR(d.unknown->y[3], 0.4, 0.06);
    EXPECT_EQ(d.messages,
              Labels{"accel_drift of the catalogue comes near, but " + d.unknown->balance + " alone explains as much: not named"});
    EXPECT_EQ(of(d.ranking, "accel_drift").verdict, "nearest");
    ASSERT_EQ(d.ladder.size(), 1U);
    // -a0 and 0.4 - a0 in either half of the accelerometer's rows, the others noise: a0 between nothing and its limit, six deviations of
    // 0.02
    const auto with = [](double a) { return std::sqrt((0.5 * (a * a + (0.4 - a) * (0.4 - a)) / (noise * noise) + 3) / 3); };
    EXPECT_GT(d.ladder[0].train, 0.98 * with(0.12));
    EXPECT_LT(d.ladder[0].train, 1.02 * with(0));
    EXPECT_GT(d.ladder[0].heldout, d.ladder[0].train);
}

// A sensor that begins to run away: a line is most of it, an offset and a drift; the curve alone is more than both.
TEST(Bench, of_two_names_that_one_curve_explains_tells_both_as_near) {
    Bench bench;
    bench.add(0, [](double t) { return 0.012 * std::max(0.0, t - 60); });
    const Diagnosis d = bench.ask();
    EXPECT_EQ(d.kind, "unknown") << d.text;
    EXPECT_TRUE(d.effects.empty() && d.model.effects.empty());
    ASSERT_TRUE(d.unknown);
    EXPECT_EQ(d.unknown->balance, "accelerometer(time)");
    EXPECT_NEAR(d.unknown->y.front(), 0, 0.06);
    EXPECT_NEAR(d.unknown->y.back(), 0.012 * (d.unknown->x.back() - 60), 0.06);
    EXPECT_EQ(d.ladder.size(), 1U);
    EXPECT_EQ(d.nearest.size(), 2U);
    for (const char *near : {"accel_bias", "accel_drift"}) EXPECT_EQ(std::count(d.nearest.begin(), d.nearest.end(), near), 1) << near;
    EXPECT_EQ(d.messages.size(), 2U);
    EXPECT_EQ(of(d.ranking, d.nearest[0]).verdict, "nearest");
}

// The name that stands keeps its rung, with the errors of the model as it is left.
TEST(Bench, of_a_right_name_beside_a_proxys_keeps_the_right_one) {
    Bench bench;
    bench.add(0, [](double t) { return t > 60 ? 0.4 : 0.0; });
    bench.hide(r1(), 0.08);
    const Diagnosis d = bench.ask();
    EXPECT_EQ(d.kind, "partial") << d.text;
    EXPECT_EQ(d.effects, Labels{"radar_scale"});
    EXPECT_EQ(d.nearest, Labels{"accel_drift"});
    ASSERT_TRUE(d.unknown);
    EXPECT_EQ(d.unknown->balance, jump_in_the_middle);
    EXPECT_NEAR(d.accepted[0].value[0], 0.08, 3 * bench.textbook({r1()}).error);
    ASSERT_EQ(d.ladder.size(), 2U);
    EXPECT_EQ(d.ladder[1].label, "+ radar_scale");
    Bench jump;
    jump.add(0, [](double t) { return t > 60 ? 0.4 : 0.0; });
    EXPECT_NEAR(d.ladder[1].train, jump.ask().ladder[0].train, 0.02); // as where the radar is right
    EXPECT_GT(d.ladder[1].heldout, d.ladder[1].train);
    EXPECT_EQ(d.model.effects.size(), 1U);
    EXPECT_EQ(d.model.effects[0].name, "radar_scale");
}

// The radar's stated scale gives way by nearly six deviations, its rows gain less than is asked of rows alone, and the accelerometer jumps:
// that leaves 2.3 and 4.7 times the noise, by which the deviations are widened. 36 squared deviations are more than 4 x 2.3^2 and less
// than 4 x 4.7^2.
TEST(Bench, whose_sheet_alone_speaks_for_a_name_is_told_it_beside_a_shape_only_where_little_is_left) {
    DiagnoseOptions options;
    options.least_gain = 0.5, options.least_gain_one = 0.6; // the radar's rows gain a tenth, the drift's as many as three quarters
    const auto with_jump = [&](double jump) {
        Bench bench;
        bench.add(0, [=](double t) { return t > 60 ? jump : 0.0; });
        bench.hide(r1(), 0.04);
        return bench.ask(options);
    };
    const Diagnosis little = with_jump(0.3), much = with_jump(0.6);
    EXPECT_EQ(little.kind, "partial") << little.text;
    EXPECT_EQ(little.effects, Labels{"radar_scale"});
    ASSERT_TRUE(little.accepted.at(0).sheet_alone);
    EXPECT_LE(*little.accepted[0].sheet_alone, 36 + 1e-6); // of its own limit; what it leaves of it, and the bias's, is less
    EXPECT_GT(*little.accepted[0].sheet_alone, 25);
    EXPECT_EQ(much.kind, "unknown") << much.text;
    EXPECT_TRUE(much.effects.empty() && much.model.effects.empty());
    EXPECT_EQ(much.nearest, Labels{"accel_drift"}); // the name of the sheet is not even near
    ASSERT_TRUE(much.unknown);
    EXPECT_EQ(much.unknown->balance, jump_in_the_middle);
    EXPECT_EQ(much.ladder.size(), 1U);
    EXPECT_EQ(std::count(much.messages.begin(), much.messages.end(),
                         "radar_scale was found, but for the data sheet's sake alone, whose numbers are bent by what the model lacks: not "
                         "named"),
              1);
    EXPECT_EQ(of(much.ranking, "radar_scale").verdict, "not_needed");
    // without the shape it stands, whatever is left; and with a shape where its rows speak
    options.shapes = false;
    const Diagnosis no_shape = with_jump(0.6);
    EXPECT_EQ(no_shape.effects, (Labels{"accel_drift", "radar_scale"})) << no_shape.text;
    options = {};
    const Diagnosis by_rows = with_jump(0.6);
    EXPECT_EQ(by_rows.effects, Labels{"radar_scale"}) << by_rows.text;
    EXPECT_FALSE(by_rows.accepted[0].sheet_alone);
}

TEST(Bench, of_a_size_beyond_the_catalogues_says_that_it_is_a_least_one) {
    Bench bench;
    bench.hide(r1(), 1.5); // the fit may go to 0.6
    bench.model.sensors["radar.scale"].prior = 0.05;
    const Diagnosis d = bench.ask();
    EXPECT_EQ(d.effects, Labels{"radar_scale"});
    ASSERT_EQ(d.messages.size(), 1U);
    EXPECT_NE(d.messages[0].find("only beyond its range (change at 0.6): read its size as at least that"), std::string::npos);
    EXPECT_NEAR(d.accepted[0].value[0], 0.6, 1e-6);
    ASSERT_FALSE(d.limits.empty()); // at which it stands, and the stated scale, six deviations off
    EXPECT_EQ(d.limits.size(), 2U);
}

TEST(Bench, that_is_missed_by_far_in_what_no_name_explains_is_a_wrong_model) {
    Bench bench;
    bench.hide(g0(), 0.5); // no effect of the catalogue; five times the noise is no verdict
    EXPECT_EQ(bench.ask().kind, "nothing");
    Bench far;
    far.hide(g0(), 5);
    const Diagnosis d = far.ask();
    EXPECT_EQ(d.kind, "wrong_model") << d.text;
    EXPECT_TRUE(d.effects.empty());
}

TEST(Bench, of_an_empty_log_says_nothing_and_hands_on_what_the_log_said) {
    Bench bench;
    bench.machine.data.messages = {"no current"};
    const Diagnosis full = bench.ask();
    EXPECT_EQ(full.messages.at(0), "no current");
    bench.machine.data.balance.clear();
    Diagnosis d = bench.ask();
    EXPECT_EQ(d.kind, "nothing");
    EXPECT_EQ(d.text, "The log has nothing that this model predicts: nothing can be said.");
    EXPECT_EQ(d.messages, Labels{"no current"});
    Bench brief;
    brief.machine.data.count = 2;
    EXPECT_EQ(brief.ask().text, d.text);
}

// The search's last question by itself: which names does one shape stand for?
struct Named {
    Bench bench;
    std::vector<Candidate> names;
    ShapeFindings found(const std::vector<std::string> &effects) {
        Model with = bench.model;
        names.clear();
        for (const Candidate &c : catalogue_candidates(bench.model, bench.machine.data, Motion()))
            if (std::count(effects.begin(), effects.end(), c.effect) == 1 && c.wheel < 0) {
                names.push_back(c);
                with.effects.push_back(effect_of(c, std::vector<double>(c.strengths.size(), 0)));
            }
        const Problem first = fitted_problem(bench.model, bench.machine.data), last = fitted_problem(with, bench.machine.data);
        ShapeScores of_first;
        return find_unknown(first, last, names, DiagnoseOptions{}, of_first);
    }
};

TEST(Unknown, shape_that_explains_more_than_all_names_stands_for_those_that_say_the_same) {
    Named n;
    n.bench.add(0, [](double t) { return 0.012 * std::max(0.0, t - 60); });
    const ShapeFindings both = n.found({"accel_bias", "accel_drift"});
    ASSERT_TRUE(both.shape);
    EXPECT_EQ(both.shape->balance, "accelerometer(time)");
    EXPECT_EQ(both.replaced, (std::vector<std::size_t>{0, 1}));
    const Problem stated = fitted_problem(n.bench.model, n.bench.machine.data);
    EXPECT_NEAR(both.shape->gain, both.gain_squares / Screen(stated).heldout_error(), 1e-9); // of what the model leaves with no name
    EXPECT_GT(both.gain_squares, 120); // on the fit's scales each of the accelerometer's 240 rows counts one: most of them
    const ShapeFindings none = n.found({});
    ASSERT_TRUE(none.shape);
    EXPECT_TRUE(none.replaced.empty() && !none.proxy && !none.cause);
    EXPECT_EQ(none.gain_squares, 0);
    n.bench.hide(r1(), 0.08);
    const ShapeFindings other = n.found({"radar_scale"}); // about something else
    ASSERT_TRUE(other.shape);
    EXPECT_TRUE(other.replaced.empty() && !other.proxy);
}

TEST(Unknown, shapes_of_the_baseline_are_asked_once) {
    Named n;
    n.bench.add(0, [](double t) { return 0.012 * std::max(0.0, t - 60); });
    const Problem first = fitted_problem(n.bench.model, n.bench.machine.data), same = first;
    ShapeScores of_first;
    EXPECT_TRUE(find_unknown(first, same, {}, DiagnoseOptions{}, of_first).shape);
    EXPECT_TRUE(of_first == nullptr); // of another fit
    EXPECT_TRUE(find_unknown(first, first, {}, DiagnoseOptions{}, of_first).shape);
    ASSERT_TRUE(of_first != nullptr);
    const ShapeScores kept = of_first;
    EXPECT_TRUE(find_unknown(first, first, {}, DiagnoseOptions{}, of_first).shape);
    EXPECT_TRUE(of_first == kept);
}

TEST(Unknown, shape_stands_for_no_name_that_is_right) {
    Named n;
    n.bench.hide(a2(), 0.003), n.bench.hide(a1(), 0.3);
    const ShapeFindings right = n.found({"accel_bias", "accel_drift"});
    EXPECT_FALSE(right.shape);
    EXPECT_TRUE(right.replaced.empty() && !right.proxy && !right.cause);
    const ShapeFindings half = n.found({"accel_bias"}); // the drift is left: a shape
    ASSERT_TRUE(half.shape);
    EXPECT_EQ(half.shape->balance, "accelerometer(time)");
}

TEST(Unknown, shape_beside_which_a_name_is_not_needed_is_its_cause) {
    Named n;
    n.bench.add(0, [](double t) { return t > 60 ? 0.4 : 0.0; });
    n.bench.hide(r1(), 0.08);
    const ShapeFindings found = n.found({"accel_drift", "radar_scale"});
    ASSERT_TRUE(found.proxy && found.cause);
    EXPECT_EQ(n.names[*found.proxy].effect, "accel_drift");
    EXPECT_EQ(found.cause->balance, jump_in_the_middle);
}

} // namespace
} // namespace traction::lab
