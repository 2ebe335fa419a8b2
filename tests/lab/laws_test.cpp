// What the later laws of the catalogue are for: real drives show them, and an independent rover that hides one is told its name; sensors
// that are late within what such sensors are give none.
#include "host_tools/lab/creeps.h"
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/decision/trial.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/forward/rounding.h"
#include "host_tools/lab/model/model.h"
#include "host_tools/lab/result/addition.h"
#include "tests/lab/generator/generator.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace traction::lab {
namespace {

using generator::GeneratorConfig;
using generator::Soil;

GeneratorConfig rover(Soil soil, std::uint64_t seed, const std::string &hidden = "") {
    GeneratorConfig config;
    config.soil = soil;
    config.seed = seed;
    config.duration_s = 120;
    config.apart = true;
    if (!hidden.empty()) config.hidden = {generator::parse_setting(hidden)};
    return config;
}

struct Answer {
    GeneratorConfig config;
    Diagnosis d;
    const CandidateResult *named(const std::string &name) const {
        for (const CandidateResult &a : d.accepted)
            if (a.candidate.effect == name) return &a;
        return nullptr;
    }
    bool may_be(const std::string &name) const { // named, or of the class of a name
        return named(name) != nullptr || std::any_of(d.classes.begin(), d.classes.end(), [&](const ConfoundedClass &c) {
                   return std::find(c.members.begin(), c.members.end(), name) != c.members.end();
               });
    }
};

Answer ask(const GeneratorConfig &config) {
    const Model model = parse_model(generator::data_sheet(config), "sheet");
    return {config, diagnose(model, make_dataset(model, generator::generate(config)), {})};
}

// Without it the fit ends where every small step of it, and every size of the scan from there, only makes the error larger: nothing was
// found at 5.4 times the noise, 12.7 times it in the yaw rate.
TEST(Afar, a_law_that_took_the_fit_to_where_its_steps_are_blind_is_found) {
    const generator::BlindCase hidden = generator::draw_fleet_case(827944, "one");
    ASSERT_EQ(hidden.config.hidden.front().name, "lateral_scrub");
    const double truth = hidden.config.hidden.front().values.front().second;
    const Answer a = ask(hidden.config);
    ASSERT_EQ(a.d.effects, std::vector<std::string>{"lateral_scrub"}) << a.d.text;
    const CandidateResult *found = a.named("lateral_scrub");
    ASSERT_NE(found, nullptr);
    EXPECT_LE(found->low[0], truth);
    EXPECT_GE(found->high[0], truth);
    EXPECT_LT(a.d.ladder.back().heldout, 0.5 * a.d.ladder.front().heldout);
}

// What was passed over by 2.7 to 6.6 times the noise, or called a wrong model.
struct Missed {
    std::uint64_t seed;
    const char *effect;
    const char *why;
};

class Far : public testing::TestWithParam<Missed> {};

TEST_P(Far, a_large_law_is_named_with_its_size) {
    const generator::BlindCase hidden = generator::draw_fleet_case(GetParam().seed, "one");
    ASSERT_EQ(hidden.config.hidden.front().name, GetParam().effect);
    const double truth = hidden.config.hidden.front().values.front().second;
    const Answer a = ask(hidden.config);
    ASSERT_EQ(a.d.effects, std::vector<std::string>{GetParam().effect}) << GetParam().why << '\n' << a.d.text;
    EXPECT_LE(a.d.accepted.front().low[0], truth);
    EXPECT_GE(a.d.accepted.front().high[0], truth);
}

INSTANTIATE_TEST_SUITE_P(Afar, Far,
                         testing::Values(Missed{914014, "relaxation_length", "its refit began beside a linear step and went astray"},
                                         Missed{921012, "relaxation_length", "its rows where speeds change hardly count on blown scales"},
                                         Missed{921044, "lateral_scrub", "on blown scales it is nearly sure alone"},
                                         Missed{921029, "shear_stiffness", "the fit had taken the ground's stiffness to its limit"},
                                         Missed{991007, "soil_gradient", "five numbers at their limits held it at half its size"},
                                         Missed{991021, "lateral_scrub", "a shape that fits 40 times the noise took its place"},
                                         Missed{1043013, "soil_patch", "it was driven over in few blocks, of which no rank tells"}),
                         [](const auto &missed) { return std::string(missed.param.effect) + "_" + std::to_string(missed.param.seed); });

// A grip that falls with sliding speed fits the log as well as one that falls beyond a slip (within 5 % of the error) and predicts what is
// left out worse: the log does not tell which, and the other is not named in its place alone.
TEST(Afar, of_two_laws_that_fit_as_well_none_takes_a_name_alone_by_scales_of_its_own) {
    generator::BlindCase hidden = generator::draw_case(913009, 120, "one");
    ASSERT_EQ(hidden.config.hidden.front().name, "sliding_speed_loss");
    hidden.config.apart = true;
    const Answer a = ask(hidden.config);
    EXPECT_NEAR(a.d.ladder.front().heldout, 2.932, 0.05); // the log that this was seen in
    if (a.named("shear_peak") == nullptr) return;
    const auto holds = [](const ConfoundedClass &c, const std::string &name) {
        return std::find(c.members.begin(), c.members.end(), name) != c.members.end();
    };
    EXPECT_TRUE(std::any_of(a.d.classes.begin(), a.d.classes.end(), [&](const ConfoundedClass &c) {
        return holds(c, "shear_peak") && holds(c, "sliding_speed_loss");
    })) << a.d.text;
    EXPECT_EQ(a.d.kind, "class") << a.d.text;
}

// What lies near explains a part: shear_peak was told, 7.0 to 6.7 times the noise, with the yaw rate at 21 times it.
TEST(Afar, a_law_is_found_though_another_passes_that_leaves_a_signal_missed) {
    const generator::BlindCase hidden = generator::draw_fleet_case(827283, "one");
    ASSERT_EQ(hidden.config.hidden.front().name, "lateral_scrub");
    const double truth = hidden.config.hidden.front().values.front().second;
    const Answer a = ask(hidden.config);
    ASSERT_EQ(a.d.effects, std::vector<std::string>{"lateral_scrub"}) << a.d.text;
    EXPECT_LE(a.d.accepted.front().low[0], truth);
    EXPECT_GE(a.d.accepted.front().high[0], truth);
    EXPECT_LT(a.d.ladder.back().heldout, 0.5 * a.d.ladder.front().heldout);
}

// Beside the ripple the step led lost counts to 0.03 of a wheel's, where a wheel's radius explained more; alone they had been 0.107, and
// from there they are 0.109.
TEST(Rounds, a_size_that_one_round_was_sure_of_is_where_the_next_one_looks_too) {
    generator::BlindCase hidden = generator::draw_case(841007, 120, "two");
    hidden.config.apart = true;
    ASSERT_EQ(hidden.config.hidden.front().name, "encoder_missed");
    const Answer a = ask(hidden.config);
    ASSERT_EQ(a.d.effects, (std::vector<std::string>{"torque_ripple", "encoder_missed on wheel 3"})) << a.d.text;
    EXPECT_LT(a.d.ladder.back().heldout, 0.5 * a.d.ladder.front().heldout);
}

// Two of six clean logs of such sensors were told as accel_tilt with accel_scale.
TEST(Sensors, an_accelerometer_filtered_and_late_as_such_parts_are_gets_no_name) {
    for (const Soil soil : {Soil::sand, Soil::concrete}) {
        GeneratorConfig config = rover(soil, 7101);
        config.chain.accel_cutoff_Hz = 9;
        config.chain.accel_late_s = 0.025;
        const Answer a = ask(config);
        EXPECT_EQ(a.d.kind, "nothing") << generator::name_of(soil) << ": " << a.d.text;
    }
}

// On concrete a count is a force of a newton; a relaxation length smooths it, and was named in stop and go (error 2.1 -> 1.1 x noise).
// Nothing is hidden. By mesh_loss and by multi_pass the error of blocks left out falls, surely, and the numbers lie farther from the sheet:
// neither is told.
TEST(Sheet, is_strained_for_no_name_that_explains_little) {
    const generator::BlindCase clean = generator::draw_fleet_case(962019, "clean");
    ASSERT_TRUE(clean.config.hidden.empty());
    const Answer a = ask(clean.config);
    EXPECT_EQ(a.d.effects, std::vector<std::string>()) << a.d.text;
    const auto strained =
        std::find_if(a.d.ranking.begin(), a.d.ranking.end(), [](const CandidateResult &r) { return r.verdict == "strains_sheet"; });
    ASSERT_NE(strained, a.d.ranking.end());
    EXPECT_TRUE(strained->candidate.effect == "mesh_loss" || strained->candidate.effect == "multi_pass") << strained->candidate.effect;
}

// Nothing is hidden. current_gain spared squared deviations of the sheet, with the motor's inertia at 5.1 of them beside it, and the error
// of blocks left out fell by 0.6 %.
TEST(Sheet, bears_no_witness_where_a_name_leaves_it_contradicted) {
    const generator::BlindCase clean = generator::draw_fleet_case(942023, "clean");
    ASSERT_TRUE(clean.config.hidden.empty());
    const Answer a = ask(clean.config);
    EXPECT_EQ(a.d.effects, std::vector<std::string>()) << a.d.text;
    EXPECT_TRUE(std::any_of(a.d.messages.begin(), a.d.messages.end(), [](const std::string &m) {
        return m.starts_with("current_gain was found, but for the data sheet's sake alone");
    })) << a.d.text;
}

// Nothing is hidden: where gravel holds less the wheels slip more, and shear_peak was named (2.37 to 2.08 times the noise).
TEST(Gravel, that_grips_unevenly_is_no_grip_that_falls_with_slip) {
    const generator::BlindCase clean = generator::draw_fleet_case(926030, "clean");
    ASSERT_TRUE(clean.config.hidden.empty());
    const Answer a = ask(clean.config);
    EXPECT_EQ(a.d.effects, std::vector<std::string>()) << a.d.text;
}

// A soil that changes along the way, beside a late camera: by linear steps soil that fades in time under wheel 0 explained it, and the
// error stayed at 2.4 times the noise; fitted in full the law leaves 1.1.
TEST(Rivals, a_law_that_predicts_better_than_the_shape_in_its_place_is_no_proxy) {
    const generator::BlindCase hidden = generator::draw_fleet_case(940011, "two");
    ASSERT_EQ(hidden.config.hidden.front().name, "soil_gradient");
    const Answer a = ask(hidden.config);
    ASSERT_NE(a.named("soil_gradient"), nullptr) << a.d.text;
    EXPECT_LT(a.d.ladder.back().heldout, 0.6 * a.d.ladder.front().heldout);
}

// Beside a late radar the soil's change along the way has a coefficient that few blocks tell; without it 4.1 times the noise is left, with
// it 2.7 (with a long patch, of its class, 1.8).
TEST(Rivals, a_law_that_takes_most_of_the_error_stays_though_its_coefficient_is_unsure) {
    const generator::BlindCase hidden = generator::draw_fleet_case(919008, "two");
    ASSERT_EQ(hidden.config.hidden.front().name, "soil_gradient");
    const Answer a = ask(hidden.config);
    EXPECT_TRUE(a.may_be("soil_gradient")) << a.d.text;
    EXPECT_NE(a.named("radar_delay"), nullptr) << a.d.text;
    EXPECT_LT(a.d.ladder.back().heldout, 0.7 * a.d.ladder.front().heldout);
}

// Smoothed over +-0.36 s throughout, its starts were blurred, and a relaxation length mended that (1.31 to 1.20 times the noise, p 3e-36),
// with the ground at six of its prior's deviations. Nothing is hidden.
TEST(Smoothing, blurs_no_start_that_a_lag_would_mend) {
    const generator::BlindCase clean = generator::draw_fleet_case(962003, "clean");
    ASSERT_TRUE(clean.config.hidden.empty());
    const Answer a = ask(clean.config);
    EXPECT_EQ(a.d.kind, "nothing") << a.d.text;
    EXPECT_TRUE(a.d.limits.empty());
    EXPECT_LT(a.d.ladder.front().heldout, 1.25);
}

// A ripple of eight periods a turn swings the wheel on concrete; smoothed over +-0.9 s nothing of it was left to find.
TEST(Smoothing, hides_no_ripple) {
    generator::BlindCase hidden = generator::draw_case(904009, 120, "one");
    hidden.config.apart = true;
    ASSERT_EQ(hidden.config.hidden.front().name, "torque_ripple");
    EXPECT_EQ(ask(hidden.config).d.effects, std::vector<std::string>{"torque_ripple on wheel 1"});
}

// At wheel speeds of nearly a whole number of counts a sample a relaxation length averages what is false in them (1.07 to 1.01 times the
// noise, a slow drive on concrete). None is there; and a real one was silent, of a rover in curves on concrete.
TEST(Smoothing, tells_a_lag_from_an_average) {
    const generator::BlindCase clean = generator::draw_fleet_case(962023, "clean");
    ASSERT_TRUE(clean.config.hidden.empty());
    EXPECT_EQ(ask(clean.config).d.effects, std::vector<std::string>());
    GeneratorConfig lags = rover(Soil::concrete, 970008, "relaxation_length:length_m=0.12");
    lags.duration_s = 100;
    lags.drive = "curves";
    const Answer a = ask(lags);
    ASSERT_EQ(a.d.effects, std::vector<std::string>{"relaxation_length"}) << a.d.text;
    EXPECT_LE(a.d.accepted.front().low[0], 0.12);
    EXPECT_GE(a.d.accepted.front().high[0], 0.12);
}

// By a linear step torque(slip) on two wheels takes a hundredth off the error of this clean log, surely (p 4e-25), and was told.
TEST(Shapes, what_its_own_fit_does_not_bear_is_not_told) {
    const generator::BlindCase clean = generator::draw_fleet_case(850001, "clean");
    const Answer a = ask(clean.config);
    EXPECT_EQ(a.d.kind, "nothing") << a.d.text;
    EXPECT_TRUE(std::any_of(a.d.messages.begin(), a.d.messages.end(),
                            [](const std::string &m) { return m.find("torque(slip) on wheels 2 and 3 seemed to explain") == 0; }));
}

// Currents that come 0.11 s late in stop and go: their edges are shorter than that, so the step at none sees next to nothing of it, and a
// scan of sizes does.
TEST(Delay, is_seen_at_its_size_though_a_small_one_says_nothing) {
    GeneratorConfig config = rover(Soil::sand, 942002, "current_delay:delay_s=0.11");
    config.drive = "stop_and_go";
    config.duration_s = 60;
    const Model model = parse_model(generator::data_sheet(config), "sheet");
    const Dataset data = make_dataset(model, generator::generate(config));
    const Physics physics = make_physics(model);
    Problem base(data, physics, free_parameters(model, physics));
    base.settle();
    const Screen screen(base);
    Columns::Cache cache;
    Columns columns(base, cache);
    const std::vector<Candidate> all = catalogue_candidates(model, data, base.forward().motion());
    const auto late = std::find_if(all.begin(), all.end(), [](const Candidate &c) { return c.effect == "current_delay" && c.wheel < 0; });
    ASSERT_NE(late, all.end());
    Trial t = screen_candidate(*late, screen, columns);
    EXPECT_LT(t.error_reduction, 0.2 * screen.error()); // by the step
    scan(t, base, screen);
    EXPECT_GT(t.error_reduction, 0.5 * screen.error());
    EXPECT_GT(t.nonlinear_reduction, 0.3 * screen.error());
    refit(t, base, screen);
    EXPECT_NEAR(t.value[0], 0.11, 0.005);
}

// Wheels whose ground states none beside one that does have the assumed one.
TEST(Creep, may_be_stated_of_one_wheel) {
    GeneratorConfig config = rover(Soil::sand, 850015);
    config.duration_s = 10;
    Model one = parse_model(generator::data_sheet(config), "sheet"), all = one;
    one.wheel[2].soil.at("reversal_speed_m_s").value = 0.005;
    for (WheelSpec &wheel : all.wheel) wheel.soil.at("reversal_speed_m_s").value = 0.005;
    const Dataset data = make_dataset(one, generator::generate(config));
    const Eigen::VectorXd by_one = Forward(data).predict(make_physics(one)), by_all = Forward(data).predict(make_physics(all));
    EXPECT_LT((by_one - by_all).lpNorm<Eigen::Infinity>(), 1e-12);
}

// At centimetres a second how rolling resistance reverses tells more than how large it is: the generator's goes as tanh(v / 8 mm/s), the
// lab's speed of reversal is fitted. At 5 mm/s for good the coefficient lay six stated deviations off, dry friction three.
TEST(Creep, leaves_resistance_and_friction_within_what_is_stated) {
    GeneratorConfig config = rover(Soil::sand, 850015);
    config.drive = "slow";
    config.duration_s = 150;
    Model model = parse_model(generator::data_sheet(config), "sheet");
    const log::Log log = generator::generate(config);
    ASSERT_TRUE(creeps(model, make_dataset(model, log)));
    ask_for_reversal(model);
    const Dataset data = make_dataset(model, log);
    const Physics physics = make_physics(model);
    Problem problem(data, physics, free_parameters(model, physics));
    problem.settle();
    const auto of = [&](const std::string &name) {
        const auto found =
            std::find_if(problem.parameters.begin(), problem.parameters.end(), [&](const FreeParameter &p) { return name_of(p) == name; });
        EXPECT_NE(found, problem.parameters.end()) << name;
        return found - problem.parameters.begin();
    };
    for (const char *name : {"soil.rolling_coefficient", "motor.coulomb_Nm"})
        EXPECT_LT(std::fabs(problem.theta[of(name)]), 2.5 * problem.parameters[static_cast<std::size_t>(of(name))].prior) << name;
    const auto reversal = of("soil.reversal_speed_m_s");
    const double e = problem.parameters[static_cast<std::size_t>(reversal)].base + problem.theta[reversal];
    EXPECT_NEAR(e, 0.010, 0.001); // where x/(x^4 + e^4)^(1/4) is nearest to tanh(x / 0.008): 0.2 % apart at 15 and 20 mm/s
}

// A quick drive has hardly a row that tells it, and who states it is not asked.
TEST(Creep, is_asked_of_slow_drives_alone) {
    GeneratorConfig config = rover(Soil::sand, 850015);
    config.duration_s = 40;
    const std::string sheet = generator::data_sheet(config);
    const Model model = parse_model(sheet, "sheet");
    EXPECT_FALSE(creeps(model, make_dataset(model, generator::generate(config))));
    config.drive = "slow";
    std::string stating = sheet;
    stating.insert(stating.find("[soil]\n") + 7, "reversal_speed_m_s = 0.002\n");
    const Model stated = parse_model(stating, "sheet");
    const Dataset slow = make_dataset(model, generator::generate(config));
    ASSERT_TRUE(creeps(model, slow));
    EXPECT_FALSE(creeps(stated, slow));
    EXPECT_EQ(stated.wheel[0].soil.at("reversal_speed_m_s").prior, 0);
}

TEST(Rounding, what_only_smooths_the_encoders_noise_is_not_named) {
    GeneratorConfig config = rover(Soil::concrete, 240004);
    config.drive = "stop_and_go";
    config.duration_s = 70;
    const Answer a = ask(config);
    EXPECT_EQ(a.named("relaxation_length"), nullptr) << a.d.text;
}

// E[(p(w + n) - p(w))^2] is quadratic in the count, and nothing where wheels roll on slippery ground: 0.3 N per unit of slip.
// On concrete the fit with the law softens the ground too, which smooths: the law was refused for it (310 squares left of 346 asked for),
// and a viscous_friction that is not there was named. On the ground as it was without the law 422 are gained, by no smoothing.
TEST(Rounding, a_law_keeps_its_name_where_only_the_softer_ground_beside_it_smooths) {
    generator::BlindCase hidden = generator::draw_case(852010, 120, "one");
    hidden.config.apart = true;
    ASSERT_EQ(hidden.config.hidden.front().name, "speed_resistance");
    const double truth = hidden.config.hidden.front().values.front().second;
    const Answer a = ask(hidden.config);
    ASSERT_EQ(a.d.effects, std::vector<std::string>{"speed_resistance"}) << a.d.text;
    EXPECT_LE(a.d.accepted.front().low[0], truth);
    EXPECT_GE(a.d.accepted.front().high[0], truth);
}

TEST(Rounding, goes_with_the_square_of_the_count) {
    const GeneratorConfig config = rover(Soil::concrete, 7102);
    const Model model = parse_model(generator::data_sheet(config), "sheet");
    const Dataset data = make_dataset(model, generator::generate(config));
    const Physics physics = make_physics(model);
    const auto sum = [&](double factor) {
        Dataset scaled = data;
        for (WheelInput &w : scaled.wheel) w.scatter_rad *= factor;
        return rounding_squares(scaled, physics).sum();
    };
    const double one = sum(1);
    EXPECT_GT(one, 0);
    EXPECT_NEAR(sum(0.1) / one, 0.01, 0.002); // the curve of the soil bends over a count: a fifth of it
    EXPECT_EQ(sum(0), 0);
}

struct Case {
    const char *name;
    Soil soil;
    const char *hidden;
};

// Not among them, for such logs are answered by silence still: shear_peak, resistance_patch, radar_delay (docs/lab_diary.md).
class Law : public testing::TestWithParam<Case> {};

TEST_P(Law, that_an_independent_rover_hides_is_named) {
    const auto [name, soil, hidden] = GetParam();
    const Answer a = ask(rover(soil, 7200, hidden));
    ASSERT_FALSE(a.d.effects.empty()) << a.d.text;
    EXPECT_EQ(a.d.accepted.front().candidate.effect, name) << a.d.text;
    const generator::Setting setting = generator::parse_setting(hidden);
    if (setting.name == name) { // the generator calls it so too: its size is in the same unit
        const double truth = setting.values.front().second;
        EXPECT_NEAR(a.d.accepted.front().value.front(), truth, 0.3 * std::fabs(truth));
    }
}

INSTANTIATE_TEST_SUITE_P(
    OfTheCatalogue, Law,
    testing::Values(Case{"churning_friction", Soil::sand, "friction_squared:coefficient_Nms2=8e-4"},
                    Case{"shared_lead", Soil::concrete, "wheel_coupling:ohm=1.1"},
                    Case{"reverse_friction", Soil::gravel, "reverse_friction:torque_Nm=0.04"},
                    Case{"fluid_drag", Soil::sand, "water_drag:coefficient_Ns2_m2=12"},
                    Case{"wear_in", Soil::sand, "wear_in:torque_Nm=0.05,time_s=20"},
                    Case{"squared_resistance", Soil::concrete, "rolling_grows_with_speed_squared:coefficient_s2_m2=0.5"},
                    Case{"accel_delay", Soil::sand, "accel_delay:delay_s=0.15"},
                    Case{"current_delay", Soil::sand, "current_delay:delay_s=0.06"},
                    Case{"gyro_delay", Soil::sand, "gyro_delay:delay_s=0.15"}, Case{"gyro_scale", Soil::sand, "gyro_scale:change=0.08"},
                    Case{"accel_place", Soil::concrete, "accel_place:ahead_m=0.15,left_m=0.05"}),
    [](const testing::TestParamInfo<Case> &one) { return std::string(one.param.name); });

// Where a rover starts and stops it swings on its slip, which the steps of the integration must not damp: by the first order 0.157 m were
// told as 0.207. The generator's slip wears off below 2 cm/s, the lab's below 15 mm/s: a tenth.
TEST(Relaxation, has_its_length_in_a_drive_with_stops) {
    const GeneratorConfig config = generator::draw_fleet_case(981029, "one").config; // small, on loam, stop and go
    ASSERT_EQ(config.hidden.front().name, "relaxation_length");
    const double truth = config.hidden.front().values.front().second;
    const Model model = parse_model(generator::data_sheet(config), "sheet");
    const Added added = add_effect(model, make_dataset(model, generator::generate(config)), "relaxation_length", -1, "");
    EXPECT_NEAR(added.model.effects.back().parameters.at("length_m").value, truth, 0.15 * truth);
}

struct ShapeCase {
    const char *name, *key;
    double truth;
    Soil soil;
    const char *hidden;
};

class Refined : public testing::TestWithParam<ShapeCase> {};

// Truths between the stations that are tried. The interval holds it, and is no wider than the stations are apart.
TEST_P(Refined, shape_is_told_with_an_interval_that_holds_the_truth) {
    const auto [name, key, truth, soil, hidden] = GetParam();
    const Answer a = ask(rover(soil, 7300, hidden));
    const CandidateResult *found = a.named(name);
    ASSERT_NE(found, nullptr) << a.d.text;
    const auto shape =
        std::find_if(found->shapes.begin(), found->shapes.end(), [key = key](const ShapeEstimate &s) { return s.key == key; });
    ASSERT_NE(shape, found->shapes.end());
    EXPECT_GE(truth, shape->low - 0.25 * (shape->high - shape->low)); // 95 %: a quarter of the width more is 3 deviations
    EXPECT_LE(truth, shape->high + 0.25 * (shape->high - shape->low));
    EXPECT_LT(shape->high - shape->low, 1.5 * truth);
}

INSTANTIATE_TEST_SUITE_P(
    OfALaw, Refined,
    testing::Values(ShapeCase{"stribeck_friction", "speed_rad_s", 1.4, Soil::sand, "stribeck_friction:torque_Nm=0.05,speed_rad_s=1.4"},
                    ShapeCase{"wear_in", "time_constant_s", 18, Soil::sand, "wear_in:torque_Nm=0.07,time_s=18"},
                    ShapeCase{"soil_patch", "start_m", 1.33, Soil::sand, "soil_patch:change=-0.5,start_m=1.33,length_m=1.2"},
                    // between two lengths that are tried, 2.5 and 4.2 m, so that both edges are far from where the search begins
                    ShapeCase{"soil_patch", "length_m", 3.7, Soil::snow, "soil_patch:change=0.5,start_m=0.9,length_m=3.7"}),
    [](const testing::TestParamInfo<ShapeCase> &one) { return std::string(one.param.name) + "_" + one.param.key; });

} // namespace
} // namespace traction::lab
