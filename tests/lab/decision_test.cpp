// The lab's decisions on logs of the independent generator (tests/lab/generator), where the answer is known.
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/result/addition.h"
#include "host_tools/lab/result/compare.h"
#include "host_tools/lab/result/result.h"
#include "tests/lab/four_wheels.h"
#include "tests/lab/generator/generator.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace traction::lab {
namespace {

using generator::GeneratorConfig;
using generator::Soil;

log::Log log_with(Soil soil, const std::string &effect, std::uint64_t seed, double duration_s = 120) {
    GeneratorConfig config;
    config.soil = soil;
    config.seed = seed;
    config.duration_s = duration_s;
    if (!effect.empty()) config.hidden.push_back(generator::parse_setting(effect));
    return generator::generate(config);
}

Model model_for(Soil soil) { return read_model("models/rover_" + generator::name_of(soil) + ".toml"); }

Diagnosis ask(Soil soil, const log::Log &log) {
    const Model model = model_for(soil);
    return diagnose(model, make_dataset(model, log), {});
}

Diagnosis ask_drawn(const generator::BlindCase &drawn) {
    const Model sheet = parse_model(generator::data_sheet(drawn.config), "sheet");
    return diagnose(sheet, make_dataset(sheet, generator::generate(drawn.config)), {});
}

TEST(Diagnose, names_nothing_when_nothing_is_hidden) {
    for (const Soil soil : {Soil::sand, Soil::concrete}) {
        const Diagnosis d = ask(soil, log_with(soil, "", 3));
        EXPECT_EQ(d.kind, "nothing") << d.text;
        EXPECT_TRUE(d.accepted.empty());
    }
}

// rolling_resistance for 0.05 % of the error: the rows told next to nothing, and the tolerances gained less than nine squared deviations.
TEST(Diagnose, names_nothing_that_hardly_helps_where_the_tolerances_gain_little_by_it) {
    const Diagnosis d = ask_drawn(generator::draw_fleet_case(340008, "clean"));
    EXPECT_TRUE(d.accepted.empty()) << d.text;
}

// True where the first name, or a member of its class, begins with `label`.
bool told(const Diagnosis &d, const std::string &label) {
    if (d.effects.empty()) return false;
    bool found = d.effects[0].starts_with(label);
    for (const ConfoundedClass &c : d.classes)
        if (c.members.front() == d.effects[0])
            for (const std::string &member : c.members) found = found || member.starts_with(label);
    return found;
}

// Curves on sand at 1.12 times the noise: the height takes off 0.5 % of all squares, 3 % of those that are not noise. It was silent.
TEST(Diagnose, names_an_effect_that_is_little_beside_the_noise_but_not_beside_what_is_left_of_it) {
    const Diagnosis d = ask_drawn(generator::draw_strange_case(791007, "one"));
    EXPECT_TRUE(told(d, "load_transfer")) << d.text;
}

// A friction by direction explains a fifth more than the slip-sinkage, both next to nothing of the error: the name gives way, and is told.
TEST(Diagnose, a_name_that_a_shape_outdoes_is_told_as_the_nearest) {
    const Diagnosis d = ask_drawn(generator::draw_fleet_case(782009, "one"));
    EXPECT_EQ(d.kind, "unknown") << d.text;
    EXPECT_NE(std::find(d.nearest.begin(), d.nearest.end(), "slip_sinkage"), d.nearest.end()) << d.text;
    EXPECT_TRUE(d.effects.empty()) << d.text;
}

// At the nearest of the speeds that are tried a Stribeck friction of 1.51 rad/s leaves what a curve over the wheel's speed
// explains; at its own it leaves nothing to that.
TEST(Diagnose, a_law_takes_its_own_speed_before_a_shape_takes_its_place) {
    const Diagnosis d = ask_drawn(generator::draw_fleet_case(941038, "one"));
    ASSERT_EQ(d.effects, std::vector<std::string>{"stribeck_friction"}) << d.text;
    ASSERT_FALSE(d.accepted[0].shapes.empty());
    EXPECT_LT(d.accepted[0].shapes[0].low, 1.51);
    EXPECT_GT(d.accepted[0].shapes[0].high, 1.51);
    EXPECT_LT(d.accepted[0].low[0], 0.3288);
    EXPECT_GT(d.accepted[0].high[0], 0.3288);
}

// A gear that loses with speed takes a tenth more off the log by the step of its refit, unevenly: of the class that is a viscous friction's
// too. Fitted in full the friction predicts better. Numbers of the sheet stay far off beside it, but the rows are very sure.
TEST(Diagnose, of_a_class_the_law_that_predicts_best_stands_for_it) {
    const Diagnosis d = ask_drawn(generator::draw_fleet_case(925021, "one"));
    ASSERT_EQ(d.effects, std::vector<std::string>{"viscous_friction"}) << d.text;
    EXPECT_LT(d.accepted[0].low[0], 0.0183);
    EXPECT_GT(d.accepted[0].high[0], 0.0183);
}

// A slow drive, wide smoothing: a relaxation length explains ten times as much, by smoothing the encoders' scatter, which is no evidence.
// What it kept from being fitted must have its turn when it is refused.
TEST(Diagnose, what_is_refused_stands_in_nobodys_way) {
    const Diagnosis d = ask_drawn(generator::draw_fleet_case(782015, "one"));
    EXPECT_TRUE(told(d, "viscous_friction")) << d.text;
}

TEST(Diagnose, names_slip_sinkage_and_its_size_and_the_error_falls) {
    const Diagnosis d = ask(Soil::sand, log_with(Soil::sand, "slip_sinkage:coefficient=0.2", 5));
    ASSERT_FALSE(d.accepted.empty());
    EXPECT_EQ(d.accepted[0].candidate.effect, "slip_sinkage");
    EXPECT_NEAR(d.accepted[0].value[0], 0.2, 0.02); // size of interest: below it a difference is not worth knowing
    EXPECT_LT(d.ladder.back().heldout, 0.7 * d.ladder.front().heldout);
}

TEST(Diagnose, names_the_wheel_that_has_more_friction) {
    const Diagnosis d = ask(Soil::concrete, log_with(Soil::concrete, "coulomb_friction:torque_Nm=0.04,wheel=2", 4));
    ASSERT_FALSE(d.accepted.empty());
    EXPECT_EQ(d.accepted[0].candidate.effect, "coulomb_friction");
    EXPECT_EQ(d.accepted[0].candidate.wheel, 2);
    EXPECT_LT(d.accepted[0].low[0], 0.04); // the other wheels' tolerances are in its interval
    EXPECT_GT(d.accepted[0].high[0], 0.04);
    EXPECT_GT(d.accepted[0].low[0], 0.004); // size of interest
}

TEST(Diagnose, two_wheels_of_one_side_that_a_log_cannot_tell_apart_are_a_class) {
    const Diagnosis d = ask(Soil::sand, log_with(Soil::sand, "rolling_resistance:coefficient=0.1,wheel=1", 6));
    ASSERT_FALSE(d.classes.empty()) << d.text;
    const std::vector<std::string> &members = d.classes[0].members;
    for (const char *wheel :
         {"rolling_resistance on wheel 1", "rolling_resistance on wheel 3"}) // both push on the right side: the same moment, the same sum
        EXPECT_EQ(std::count(members.begin(), members.end(), wheel), 1) << d.text;
}

Diagnosis ask_campaign(std::uint64_t seed) {
    const GeneratorConfig config = generator::draw_case(seed, 120).config;
    const Model model = read_model("tests/lab/campaign/machine_" + generator::name_of(config.soil) + ".toml");
    return diagnose(model, make_dataset(model, generator::generate(config)), {});
}

// The baseline's own Coulomb torque lies at its bound, and the weight, the rolling resistance and the viscous friction with it: linear
// steps from there go nowhere.
TEST(Diagnose, names_a_friction_that_drove_the_baseline_to_its_bounds) {
    const Diagnosis d = ask_campaign(80009); // 0.0254 N m on concrete
    ASSERT_EQ(d.effects.size(), 1U) << d.text;
    EXPECT_EQ(d.effects[0], "coulomb_friction");
    EXPECT_NEAR(d.accepted[0].value[0], 0.0254, 0.004); // size of interest
}

TEST(Diagnose, what_promises_most_is_tried_though_others_are_surer) {
    const Diagnosis d = ask_campaign(80176); // rolling_resistance on wheel 1; friction on both wheels of that side is very sure too
    ASSERT_EQ(d.effects.size(), 1U) << d.text;
    EXPECT_EQ(d.accepted[0].candidate.effect, "rolling_resistance");
    ASSERT_EQ(d.classes.size(), 1U) << d.text;
    EXPECT_EQ(d.classes[0].members.size(), 2U) << d.text;
}

// A sliding wheel is rare: its effect helps in all blocks, but what its coefficient says scatters over them.
TEST(Diagnose, names_an_effect_that_acts_in_few_blocks) {
    // sliding_speed_loss; and 0.0166 N m on wheel 0, 3.7 of the deviations that a wheel's own friction may have: its tolerance, not named
    const Diagnosis d = ask_campaign(80000);
    ASSERT_EQ(d.effects.size(), 1U) << d.text;
    EXPECT_EQ(d.effects[0], "sliding_speed_loss") << d.text;
}

TEST(Diagnose, what_only_the_data_sheets_tolerances_decide_is_a_class) {
    const Diagnosis d = ask_campaign(80109); // torque_constant; voltage_gain leaves no more, and moves other parameters as far
    ASSERT_EQ(d.classes.size(), 1U) << d.text;
    for (const char *effect : {"torque_constant", "voltage_gain"})
        EXPECT_NE(std::find(d.classes[0].members.begin(), d.classes[0].members.end(), effect), d.classes[0].members.end())
            << effect << ": " << d.text;
}

// Twice the range: nothing smaller does as well, so it is named as a least size; what it dwarfs is not named at the end of its own range.
TEST(Diagnose, a_size_beyond_its_range_is_told_as_a_least_one) {
    const Diagnosis d = ask(Soil::concrete, log_with(Soil::concrete, "body_drag:force_N=11", 38, 60));
    ASSERT_EQ(d.effects.size(), 1U) << d.text;
    EXPECT_EQ(d.effects[0], "body_drag");
    EXPECT_NEAR(d.accepted[0].value[0], 7.5, 0.01); // the catalogue's 5 N and half of it
    EXPECT_TRUE(std::any_of(d.messages.begin(), d.messages.end(),
                            [](const std::string &m) { return m.find("at least that") != std::string::npos; }));
}

TEST(Diagnose, says_the_same_bytes_twice) {
    hand_made::FourWheels rover; // what is asked twice is made once: its noise is seeded
    EffectUse scale;
    scale.name = "accel_scale", scale.parameters["change"].value = 0.2, scale.parameters["change"].given = true;
    rover.hide({scale});
    const auto text = [&] {
        nlohmann::json json;
        put_diagnosis(json, diagnose(rover.model, rover.data, {}));
        return json.dump();
    };
    EXPECT_NE(text().find("accel_scale"), std::string::npos);
    EXPECT_EQ(text(), text());
}

TEST(Robustness, any_signal_may_be_missing_and_is_then_told) {
    const log::Log whole = log_with(Soil::sand, "", 7, 30);
    const Model model = model_for(Soil::sand);
    for (const char *gone : {"wheel0.current_A", "wheel1.encoder_count", "wheel2.duty", "battery.voltage_V", "imu.accel_x_m_s2",
                             "imu.gyro_z_rad_s", "radar.speed_m_s", "camera.x_m", "camera.yaw_rad"}) {
        log::Log log = whole;
        std::erase_if(log.signals, [&](const log::Signal &s) { return s.name == gone; });
        const Dataset data = make_dataset(model, log);
        const Comparison c = compare(model, data, true);
        EXPECT_TRUE(std::isfinite(c.error)) << gone;
        EXPECT_FALSE(c.balances.empty()) << gone;
    }
    const Dataset nothing = make_dataset(model, log::Log{});
    EXPECT_TRUE(compare(model, nothing, true).balances.empty());
    EXPECT_EQ(diagnose(model, nothing, {}).kind, "nothing");
    EXPECT_FALSE(nothing.messages.empty());
}

TEST(Robustness, truth_columns_change_nothing) {
    log::Log log = log_with(Soil::sand, "", 8, 30);
    const Model model = model_for(Soil::sand);
    const double before = compare(model, make_dataset(model, log), true).error;
    log.signals.push_back({"truth.speed_m_s", log.signals[0].t_s, std::vector<double>(log.signals[0].t_s.size(), 99.0)});
    EXPECT_EQ(compare(model, make_dataset(model, log), true).error, before);
}

TEST(Add, a_users_own_expression_takes_part_like_an_effect_of_the_catalogue) {
    const log::Log log = log_with(Soil::sand, "viscous_friction:coefficient_Nms=0.005", 9);
    Model model = model_for(Soil::sand);
    const Dataset data = make_dataset(model, log);
    Model bare = model;
    const double before = fit_model(bare, data, "baseline").heldout;
    EffectUse own;
    own.name = "grease";
    own.acts_on = "wheel_torque";
    own.expression = "k*w";
    Parameter k;
    k.value = 1e-3;
    k.minimum = 0;
    k.maximum = 0.1;
    own.parameters["k"] = k;
    model.effects.push_back(own);
    EXPECT_LT(fit_model(model, data, "+ grease").heldout, 0.9 * before);
    EXPECT_NEAR(model.effects[0].parameters.at("k").value, 0.005, 4e-4); // size of interest of viscous friction
}

TEST(Add, keeps_the_ladder_in_the_model) {
    const log::Log log = log_with(Soil::sand, "body_drag:force_N=2", 10);
    const Model model = model_for(Soil::sand);
    const Added added = add_effect(model, make_dataset(model, log), "body_drag", -1, "");
    EXPECT_TRUE(added.helps);
    EXPECT_NEAR(added.model.effects[0].parameters.at("force_N").value, 2,
                0.3); // rolling resistance, known to 0.004 * 28 N = 0.11 N, stands in: 3 of that
    ASSERT_EQ(added.model.lineage.size(), 2U);
    EXPECT_LT(added.model.lineage[1].heldout, added.model.lineage[0].heldout);
    EXPECT_THROW(add_effect(added.model, make_dataset(model, log), "body_drag", -1, ""), ModelError);
    EXPECT_THROW(add_effect(model, make_dataset(model, log), "gremlin", -1, ""), ModelError);
}

} // namespace
} // namespace traction::lab
