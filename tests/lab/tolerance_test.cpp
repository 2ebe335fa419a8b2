// Tolerances first: wheels that differ as those of one machine do are no physics, and the model file says how far they may.
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/model/model.h"
#include "tests/lab/generator/generator.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace traction::lab {
namespace {

using generator::GeneratorConfig;
using generator::Soil;

const std::string four_wheels = "[rover]\nmass_kg = 3\n[wheels]\nradius_m = 0.05\n[[wheel]]\n[[wheel]]\n[[wheel]]\n[[wheel]]\n";

GeneratorConfig apart(Soil soil, std::uint64_t seed) {
    GeneratorConfig config;
    config.soil = soil;
    config.seed = seed;
    config.duration_s = 90;
    config.apart = true;
    return config;
}

std::vector<FreeParameter> free_of(const Model &model) { return free_parameters(model, make_physics(model)); }

std::size_t count_of(const std::vector<FreeParameter> &list, const std::string &key, bool own) {
    return static_cast<std::size_t>(
        std::count_if(list.begin(), list.end(), [&](const FreeParameter &p) { return p.key == key && p.own == own; }));
}

TEST(Tolerance, wheels_share_a_value_and_differ_by_their_own) {
    const Model model = parse_model(four_wheels + "[motor]\ncoulomb_Nm = { value = 0.04, prior = 0.001, each_wheel = 0.1 }\n"
                                                  "torque_constant_Nm_A = 0.2\nresistance_ohm = { value = 3, each_wheel = 0 }\n"
                                                  "inertia_kg_m2 = 1e-3\nviscous_Nms = { value = 1e-3, fixed = true }\n",
                                    "m");
    const std::vector<FreeParameter> list = free_of(model);
    EXPECT_EQ(count_of(list, "coulomb_Nm", false), 1U);
    EXPECT_EQ(count_of(list, "coulomb_Nm", true), 4U);
    EXPECT_EQ(count_of(list, "torque_constant_Nm_A", true), 4U); // by default
    EXPECT_EQ(count_of(list, "radius_m", true), 4U);
    EXPECT_EQ(count_of(list, "resistance_ohm", true), 0U);
    EXPECT_EQ(count_of(list, "inertia_kg_m2", true), 4U); // by default
    EXPECT_EQ(count_of(list, "viscous_Nms", true) + count_of(list, "viscous_Nms", false), 0U);
    for (const FreeParameter &p : list) EXPECT_TRUE(!p.own || p.key != "coulomb_Nm" || std::fabs(p.prior - 0.004) < 1e-15);
    Physics physics = make_physics(model);
    for (const FreeParameter &p : list)
        if (p.own && p.key == "torque_constant_Nm_A" && p.wheel == 2) p.add(physics, 0.01);
    EXPECT_DOUBLE_EQ(physics.wheel[2].KG, 0.21);
    EXPECT_DOUBLE_EQ(physics.wheel[2].ke, 0.21); // the same magnets
    EXPECT_DOUBLE_EQ(physics.wheel[1].KG, 0.2);
}

Diagnosis ask(const GeneratorConfig &config) {
    const Model sheet = parse_model(generator::data_sheet(config), "sheet");
    return diagnose(sheet, make_dataset(sheet, generator::generate(config)), {});
}

// To and fro on stiff ground slip is small, and what a count is worth beside it softened the ground to its bound: two current gains named.
TEST(Clean, a_drive_to_and_fro_on_concrete_names_nothing) {
    GeneratorConfig config = apart(Soil::concrete, 3);
    config.drive = "shuttle", config.duration_s = 60;
    const Diagnosis d = ask(config);
    EXPECT_TRUE(d.effects.empty()) << d.text;
}

// The body was taken to drive straight, and the model for wrong.
TEST(Clean, a_log_that_turns_without_a_yaw_rate_is_no_wrong_model) {
    GeneratorConfig config = apart(Soil::sand, 1);
    config.habits.gyro = config.camera = false, config.duration_s = 60;
    EXPECT_EQ(ask(config).kind, "nothing");
}

TEST(Tolerance, what_is_written_is_read_again_and_still_shared) {
    Model model = parse_model(four_wheels + "[motor]\ncoulomb_Nm = { value = 0.04, each_wheel = 0.1 }\n"
                                            "resistance_ohm = { value = 3, each_wheel = 0 }\n",
                              "m");
    model.wheel[1].motor.at("coulomb_Nm").value = 0.043; // as a fit leaves it
    const Model again = parse_model(model_text(model), "n");
    EXPECT_DOUBLE_EQ(again.wheel[1].motor.at("coulomb_Nm").value, 0.043);
    EXPECT_DOUBLE_EQ(again.wheel[1].motor.at("coulomb_Nm").each_wheel, 0.1);
    EXPECT_EQ(again.wheel[0].motor.at("resistance_ohm").each_wheel, 0);
    EXPECT_EQ(count_of(free_of(again), "coulomb_Nm", false), 1U);
    EXPECT_EQ(count_of(free_of(again), "coulomb_Nm", true), 4U);
}

TEST(Tolerance, a_share_that_cannot_be_is_told) {
    const auto message = [](const std::string &text) {
        try {
            parse_model(text, "m.toml");
        } catch (const ModelError &error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(message(four_wheels + "[motor]\ncoulomb_Nm = { value = 0.04, each_wheel = 15 }\n").find("m.toml:10: motor.coulomb_Nm"),
              std::string::npos);
    EXPECT_NE(message("[rover]\nmass_kg = { value = 3, each_wheel = 0.1 }\n[[wheel]]\nradius_m = 1\n").find("for all wheels"),
              std::string::npos);
}

// Without tolerances of their own 9 of 10 such logs were given names (up to four each).
class Apart : public testing::TestWithParam<std::tuple<Soil, std::uint64_t>> {};

TEST_P(Apart, a_clean_log_of_a_machine_whose_wheels_differ_gets_no_name) {
    const GeneratorConfig config = apart(std::get<0>(GetParam()), std::get<1>(GetParam()));
    const Model model = parse_model(generator::data_sheet(config), "sheet");
    const Diagnosis d = diagnose(model, make_dataset(model, generator::generate(config)), {});
    EXPECT_EQ(d.kind, "nothing") << d.text;
}

INSTANTIATE_TEST_SUITE_P(Tolerance, Apart,
                         testing::Combine(testing::Values(Soil::sand, Soil::gravel, Soil::concrete), testing::Values(7001u, 7002u)),
                         [](const auto &one) {
                             return generator::name_of(std::get<0>(one.param)) + "_" + std::to_string(std::get<1>(one.param));
                         });

// 95 % of 20 values: 15 and fewer would be a chance of 1 in 380.
TEST(Tolerance, the_interval_of_a_wheel_is_that_of_the_shared_value_and_its_own) {
    int inside = 0, count = 0;
    for (const std::uint64_t seed : {7011u, 7012u, 7013u, 7014u, 7015u}) {
        const GeneratorConfig config = apart(Soil::sand, seed);
        Model model = parse_model(generator::data_sheet(config), "sheet");
        fit_model(model, make_dataset(model, generator::generate(config)), "");
        const generator::Machine machine = generator::machine_of(config);
        for (std::size_t i = 0; i < 4; ++i, ++count) {
            const Parameter &p = model.wheel[i].motor.at("coulomb_Nm");
            const double truth = machine.coulomb * machine.coulomb_each[i];
            inside += p.low <= truth && truth <= p.high;
        }
    }
    EXPECT_GT(inside, 15) << "of " << count;
}

} // namespace
} // namespace traction::lab
