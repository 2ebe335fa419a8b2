// A rover of another size in the lab: its model comes from its description, a clean drive is explained, a hidden effect is named.
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/model/model.h"
#include "host_tools/lab/result/compare.h"
#include "host_tools/rover/rover.h"
#include "host_tools/simulate/simulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace traction::lab {
namespace {

log::Log driven(const sim::RoverDescription &rover, const std::string &effect, double duration_s) {
    sim::Scenario scenario = sim::read_scenario("scenarios/identification.toml");
    scenario.duration_s = duration_s;
    sim::set_rover(scenario, rover);
    SimulateOptions options;
    options.seed = 3;
    if (!effect.empty()) options.effects.push_back(sim::parse_effect(effect));
    return simulate(scenario, options).log;
}

const sim::RoverDescription &heavy() {
    static const sim::RoverDescription rover = sim::read_rover_file("rovers/heavy.toml");
    return rover;
}

Model heavy_on_sand() { return parse_model(traction::model_text(heavy(), "sand"), "heavy on sand"); }

TEST(SecondRover, its_model_has_the_numbers_of_its_description) {
    const Model model = heavy_on_sand();
    EXPECT_EQ(model.rover.at("mass_kg").value, 60);
    ASSERT_EQ(model.wheel.size(), 4U);
    EXPECT_EQ(model.wheel[3].geometry.at("radius_m").value, 0.165);
    EXPECT_EQ(model.wheel[3].geometry.at("y_m").value, -0.32);
    EXPECT_EQ(model.wheel[0].motor.at("torque_constant_Nm_A").value, 2.7);
    EXPECT_EQ(model.wheel[0].motor.at("torque_constant_Nm_A").source, "assumed");
    EXPECT_THROW(traction::model_text(heavy(), "mud"), std::invalid_argument);
}

// The model of the reference that the verb writes says what the shipped one says.
TEST(SecondRover, the_reference_model_is_the_shipped_one) {
    const Model made = parse_model(traction::model_text(sim::read_rover_file("rovers/lhomme_desages.toml"), "sand"), "made");
    const Model shipped = read_model("models/rover_sand.toml");
    for (const auto &[key, parameter] : shipped.wheel[0].motor) EXPECT_EQ(made.wheel[0].motor.at(key).value, parameter.value) << key;
    for (const auto &[key, parameter] : shipped.wheel[2].geometry) EXPECT_EQ(made.wheel[2].geometry.at(key).value, parameter.value) << key;
    EXPECT_EQ(made.rover.at("mass_kg").value, shipped.rover.at("mass_kg").value);
    EXPECT_NEAR(made.rover.at("yaw_inertia_kg_m2").value, shipped.rover.at("yaw_inertia_kg_m2").value, 1e-4);
    EXPECT_NEAR(made.wheel[0].soil.at("mu").value, shipped.wheel[0].soil.at("mu").value, 1e-6); // the shipped one has six digits
}

// Two halves on a joint are tipped each by its own pull; one stiff chassis, or wheels on rockers, are not.
TEST(SecondRover, its_model_has_halves_where_the_chassis_has) {
    const auto halves = [](const sim::RoverDescription &rover) { return parse_model(traction::model_text(rover, "sand"), "made").halves; };
    const sim::RoverDescription reference = sim::read_rover_file("rovers/lhomme_desages.toml");
    EXPECT_TRUE(halves(reference));
    for (const char *soil : {"sand", "gravel", "concrete"})
        EXPECT_TRUE(read_model("models/rover_" + std::string(soil) + ".toml").halves) << soil;
    std::ifstream file("rovers/lhomme_desages.toml");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_FALSE(halves(sim::parse_rover(text + "\n[layout]\nrigid = 1\n", "stiff")));
}

TEST(SecondRover, a_clean_drive_is_explained) {
    const Model model = heavy_on_sand();
    const Diagnosis d = diagnose(model, make_dataset(model, driven(heavy(), "", 120)), {});
    EXPECT_TRUE(d.effects.empty()) << d.text;
}

// Without them two wheels seem to turn against the drive.
TEST(SecondRover, the_headers_signs_are_used) {
    const Model model = heavy_on_sand();
    log::Log log = driven(heavy(), "", 60);
    const double error = compare(model, make_dataset(model, log), true).adjusted;
    log.header.erase("firmware.encoder_sign_1");
    log.header.erase("firmware.encoder_sign_3");
    EXPECT_GT(compare(model, make_dataset(model, log), true).adjusted, 10 * error);
}

void expect_slip_sinkage(double duration_s) {
    const Model model = heavy_on_sand();
    const Diagnosis d = diagnose(model, make_dataset(model, driven(heavy(), "slip_sinkage:coefficient=0.2", duration_s)), {});
    ASSERT_EQ(d.effects.size(), 1U) << d.text;
    EXPECT_EQ(d.effects[0], "slip_sinkage") << d.text;
    ASSERT_FALSE(d.accepted.empty());
    // a 95 % interval, and three of its half widths beside the truth at most
    const double half = 0.5 * (d.accepted[0].high[0] - d.accepted[0].low[0]);
    EXPECT_NEAR(d.accepted[0].value[0], 0.2, 1.5 * half + 0.01) << d.text;
}

TEST(SecondRover, a_hidden_effect_is_named) { expect_slip_sinkage(60); }
TEST(SecondRover, a_hidden_effect_is_named_in_two_minutes) { expect_slip_sinkage(120); } // every night

} // namespace
} // namespace traction::lab
