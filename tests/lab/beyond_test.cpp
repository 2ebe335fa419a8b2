// What the catalogue does not hold: the lab says on what it depends, and asserts no effect that is merely its proxy.
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/decision/shape_refit.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/result/result.h"
#include "tests/lab/generator/generator.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <numeric>
#include <utility>

namespace traction::lab {
namespace {

using generator::GeneratorConfig;
using generator::Soil;

// Logs outlive the fits of them, which a diagnosis holds.
const Dataset &kept(Dataset data) {
    static std::deque<Dataset> all;
    return all.emplace_back(std::move(data));
}

Diagnosis ask(const GeneratorConfig &config) {
    const Model model = read_model("models/rover_" + generator::name_of(config.soil) + ".toml");
    return diagnose(model, kept(make_dataset(model, generator::generate(config))), {});
}

Diagnosis ask(Soil soil, const std::string &hidden, std::uint64_t seed) {
    GeneratorConfig config;
    config.soil = soil;
    config.seed = seed;
    config.duration_s = 120;
    config.hidden.push_back(generator::parse_setting(hidden));
    return ask(config);
}

// Told alone, and with the coefficients of its fit: fitted from there it stays.
void expect_as_fitted(const Diagnosis &d) {
    ASSERT_TRUE(d.unknown && d.accepted.empty());
    const Eigen::VectorXd told = d.unknown->score->assessment.strength,
                          again = with_shape(*d.stated_fit, *d.unknown->score).theta.tail(told.size());
    EXPECT_LT((again - told).norm(), 0.03 * told.norm()) << told.transpose() << " and " << again.transpose();
}

bool is_nearest(const Diagnosis &d, const std::string &effect) {
    return std::find(d.nearest.begin(), d.nearest.end(), effect) != d.nearest.end();
}

TEST(Shapes, a_proxy_is_the_nearest_and_not_the_cause) {
    GeneratorConfig config;
    config.soil = Soil::gravel;
    config.seed = 31;
    config.hidden.push_back(generator::parse_setting("friction_hysteresis:torque_Nm=0.06"));
    const Model sheet = parse_model(generator::data_sheet(config), "sheet");
    const Diagnosis d = diagnose(sheet, kept(make_dataset(sheet, generator::generate(config))), {});
    EXPECT_EQ(d.kind, "unknown") << d.text;
    ASSERT_TRUE(d.unknown);
    EXPECT_NE(d.unknown->variable.find("reversal"), std::string::npos) << d.unknown->variable;
    EXPECT_TRUE(is_nearest(d, "coulomb_friction"));
    EXPECT_TRUE(d.effects.empty());
    EXPECT_TRUE(d.accepted.empty());
    EXPECT_EQ(std::count_if(d.ranking.begin(), d.ranking.end(), [](const CandidateResult &r) { return r.verdict == "named"; }), 0);
    nlohmann::json json;
    put_diagnosis(json, d);
    EXPECT_EQ(json["verdict"]["nearest"], nlohmann::json(d.nearest));
    EXPECT_NE(d.text.find("and not named"), std::string::npos);
    expect_as_fitted(d);
}

TEST(Shapes, a_law_that_is_right_keeps_its_name_beside_freer_shapes) {
    const Diagnosis d = ask(Soil::sand, "viscous_friction:coefficient_Nms=0.005", 31);
    EXPECT_EQ(d.kind, "named") << d.text;
    ASSERT_EQ(d.effects.size(), 1U);
    EXPECT_EQ(d.effects[0], "viscous_friction");
    EXPECT_TRUE(d.nearest.empty());
}

TEST(Shapes, a_lead_shared_by_an_axle_is_no_wiring_of_one_motor) {
    const Diagnosis d = ask(Soil::concrete, "wheel_coupling:ohm=1", 32);
    ASSERT_EQ(d.effects, std::vector<std::string>{"shared_lead"}) << d.text;
    ASSERT_EQ(d.accepted.front().candidate.variant.size(), 1U);
    EXPECT_EQ(d.accepted.front().candidate.variant[0].second, 1); // the motors of an axle
    EXPECT_LE(d.accepted.front().low[0], 1);
    EXPECT_GE(d.accepted.front().high[0], 1);
}

// Of the pulse once a turn, a ripple of one period a turn is a quarter.
TEST(Shapes, a_bad_tooth_is_no_ripple) {
    const Diagnosis d = ask(Soil::sand, "bad_tooth:torque_Nm=0.08,wheel=1", 36);
    EXPECT_EQ(d.kind, "unknown") << d.text;
    ASSERT_TRUE(d.unknown) << d.text;
    EXPECT_EQ(d.unknown->balance, "friction(wheel angle) on wheel 1");
    EXPECT_GT(d.unknown->gain, 0.05);
    expect_as_fitted(d);
}

Diagnosis ask_fleet(std::uint64_t seed, const char *category) {
    const generator::BlindCase one = generator::draw_fleet_case(seed, category);
    const Model model = parse_model(generator::data_sheet(one.config), "sheet");
    return diagnose(model, kept(make_dataset(model, generator::generate(one.config))), {});
}

// A grip that fades by a third in the run; along the way it fades too, but not as evenly.
TEST(Shapes, a_grip_that_fades_in_time_is_no_gradient_along_the_way) {
    const Diagnosis d = ask_fleet(923011, "outside");
    EXPECT_EQ(d.kind, "unknown") << d.text;
    ASSERT_TRUE(d.unknown) << d.text;
    EXPECT_EQ(d.unknown->variable, "time");
    EXPECT_EQ(d.unknown->target, "soil_strength");
    EXPECT_TRUE(is_nearest(d, "soil_gradient"));
    expect_as_fitted(d);
    // the fit that --apply writes into this model is this model's, without the name that was taken back
    if (d.model_fit) {
        EXPECT_EQ(d.model_fit->parameters.size(), free_parameters(d.model, make_physics(d.model)).size());
    }
}

// A resistance to turning that the catalogue lacks: the log tells it from wheels that dig in no better than the other way about.
TEST(Shapes, a_shape_that_does_as_well_as_a_name_is_told_beside_it) {
    const Diagnosis d = ask_fleet(923002, "outside");
    EXPECT_EQ(d.kind, "class") << d.text;
    EXPECT_EQ(d.effects, std::vector<std::string>{"slip_sinkage"});
    ASSERT_TRUE(d.unknown) << d.text;
    EXPECT_EQ(d.unknown->instead_of, "slip_sinkage");
    EXPECT_EQ(d.unknown->variable, "yaw rate");
    ASSERT_EQ(d.classes.size(), 1U);
    EXPECT_EQ(d.classes[0].members, (std::vector<std::string>{"slip_sinkage", d.unknown->balance}));
    EXPECT_EQ(d.text.find("only partly"), std::string::npos);
}

TEST(Shapes, a_dead_band_of_the_bridge_shows_over_the_motors_voltage) {
    const Diagnosis d = ask(Soil::sand, "duty_dead_band:duty=0.08", 33);
    EXPECT_EQ(d.kind, "unknown") << d.text;
    ASSERT_TRUE(d.unknown);
    EXPECT_EQ(d.unknown->target, "voltage");
    EXPECT_NE(d.unknown->variable.find("motor voltage"), std::string::npos);
    expect_as_fitted(d);
}

TEST(Shapes, a_torque_that_saturates_shows_over_the_motors_current) {
    const Diagnosis d = ask(Soil::concrete, "torque_limit:torque_Nm=0.22", 34);
    ASSERT_TRUE(d.unknown) << d.text;
    EXPECT_NE(d.unknown->variable.find("current"), std::string::npos) << d.text;
}

// A law that matters in few blocks: each gains, none much alike another.
TEST(Shapes, a_resonance_at_a_speed_seldom_driven_shows_over_the_wheels_speed) {
    const Diagnosis d = ask(Soil::sand, "friction_resonance:torque_Nm=0.05,speed_rad_s=6", 36);
    EXPECT_EQ(d.kind, "unknown") << d.text;
    ASSERT_TRUE(d.unknown);
    EXPECT_NE(d.unknown->variable.find("wheel speed"), std::string::npos) << d.text;
    expect_as_fitted(d);
}

// A tank that swings on the rover, its frequency and its amplitude: before, nothing at twice the noise, or a friction over the speed.
TEST(Shapes, a_force_that_swings_the_body_is_told_with_its_frequency) {
    const Diagnosis d = ask(Soil::sand, "swinging_force:force_N=1.2,frequency_Hz=0.37", 41);
    EXPECT_TRUE(d.effects.empty()) << d.text;
    EXPECT_EQ(d.kind, "unknown") << d.text;
    ASSERT_TRUE(d.unknown);
    EXPECT_TRUE(d.unknown->of_body);
    EXPECT_EQ(d.unknown->balance, "force on the body");
    EXPECT_EQ(d.unknown->variable.find("time (it swings at 0.37"), 0U) << d.unknown->variable;
    EXPECT_NEAR(std::stod(d.unknown->expression), 1.2, 0.12) << d.unknown->expression; // its amplitude comes first
}

// Something rubs from the first minute on: five values over time miss where it began, and a law of the path looked as much like it.
TEST(Shapes, a_friction_that_begins_at_once_is_a_step_at_its_time) {
    const Diagnosis d = ask(Soil::concrete, "friction_step:torque_Nm=0.04,time_s=60", 38);
    EXPECT_EQ(d.kind, "unknown") << d.text;
    ASSERT_TRUE(d.unknown);
    EXPECT_EQ(d.unknown->variable, "time");
    ASSERT_EQ(d.unknown->x.size(), 4U) << d.unknown->balance;
    EXPECT_NEAR(0.5 * (d.unknown->x[1] + d.unknown->x[2]), 60, 4); // half of what the steps are apart
    EXPECT_EQ(d.unknown->target, "wheel_friction") << d.text;
    EXPECT_NEAR(d.unknown->y[3], 0.04, 0.01);
    expect_as_fitted(d);
}

TEST(Shapes, a_slow_drift_of_the_grip_shows_over_time) {
    const Diagnosis d = ask(Soil::gravel, "grip_drift:change=-0.4", 37);
    EXPECT_EQ(d.kind, "unknown") << d.text;
    ASSERT_TRUE(d.unknown);
    EXPECT_EQ(d.unknown->variable, "time");
    EXPECT_EQ(d.unknown->target, "soil_strength");
    const std::vector<double> &y = d.unknown->y; // a straight line or a curve: it falls
    const auto half = static_cast<std::ptrdiff_t>(y.size() / 2);
    EXPECT_LT(std::accumulate(y.end() - half, y.end(), 0.0), std::accumulate(y.begin(), y.begin() + half, 0.0));
    expect_as_fitted(d);
}

TEST(Shapes, a_shape_takes_no_name_that_is_about_something_else) {
    GeneratorConfig config;
    config.soil = Soil::gravel;
    config.seed = 35;
    config.duration_s = 120;
    for (const char *hidden : {"speed_resistance:coefficient_s_m=0.175", "accel_scale:change=0.11"})
        config.hidden.push_back(generator::parse_setting(hidden));
    const Diagnosis d = ask(config); // resistance(ground speed) holds the first, not the second
    for (const char *effect : {"speed_resistance", "accel_scale"})
        EXPECT_NE(std::find(d.effects.begin(), d.effects.end(), effect), d.effects.end()) << effect << ": " << d.text;
}

// The fit of the baseline lies at bounds there: what its linear steps predict for the blocks left out is less than its own error.
TEST(Shapes, a_held_out_error_below_that_of_the_fit_is_not_believed) {
    const Diagnosis d = ask(generator::draw_case(30302, 120).config); // encoder_missed and accel_scale, on gravel
    for (const char *effect : {"encoder_missed", "accel_scale"})
        EXPECT_NE(std::find(d.effects.begin(), d.effects.end(), effect), d.effects.end()) << effect << ": " << d.text;
}

} // namespace
} // namespace traction::lab
