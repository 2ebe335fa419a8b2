// The model file: what is read, what is written back, and that every mistake is told with its place and its mend.
#include "host_tools/lab/forward/physics.h"
#include "host_tools/lab/forward/wheel_step.h"
#include "host_tools/lab/inputs/smooth.h"
#include "host_tools/lab/model/model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace traction::lab {
namespace {

const std::string bench = R"(
[rover]
motion = "imposed"
[wheels]
radius_m = 0.058
[[wheel]]
load_N = 20
[soil]
law = "janosi"
mu = 0.6
shear_slip = 0.3
)";

std::string message_of(const std::string &text) {
    try {
        parse_model(text, "m.toml");
    } catch (const ModelError &error) {
        return error.what();
    }
    return "";
}

TEST(Model, a_bench_an_unloaded_motor_and_an_omni_drive_can_be_expressed) {
    EXPECT_EQ(parse_model(bench, "b").motion, BodyMotion::imposed);
    EXPECT_EQ(parse_model("[rover]\nmotion = \"none\"\n[[wheel]]\nradius_m = 0.04\n", "m").wheel.size(), 1U);
    std::string omni = "[rover]\nmotion = \"planar\"\nmass_kg = 12\n[wheels]\nradius_m = 0.04\n";
    for (int i = 0; i < 3; ++i) omni += "[[wheel]]\ngrips_sideways = false\nheading_rad = " + std::to_string(2.0 * i) + "\n";
    const Model model = parse_model(omni, "o");
    EXPECT_EQ(model.wheel.size(), 3U);
    EXPECT_FALSE(model.wheel[2].grips_sideways);
}

TEST(Model, every_mistake_is_told_with_file_line_key_value_and_mend) {
    EXPECT_NE(message_of("[rover]\nmass_kg = \"heavy\"\n[[wheel]]\nradius_m = 1\n").find("m.toml:2: rover.mass_kg: is not a number"),
              std::string::npos);
    EXPECT_NE(message_of("[rover]\nmas_kg = 1\n").find("did you mean mass_kg"), std::string::npos);
    EXPECT_NE(message_of("[rover]\nmass_kg = -3\n").find("-3 is outside 0"), std::string::npos);
    EXPECT_NE(message_of("[rover]\nmass_kg = { value = 3, unit = \"g\" }\n").find("this key is in kg"), std::string::npos);
    EXPECT_NE(message_of("[rover]\nmass_kg = 3\n").find("add a [[wheel]]"), std::string::npos);
    EXPECT_NE(message_of("[[wheel]]\nradius_m = 1\n").find("rover.mass_kg: is missing"), std::string::npos);
    EXPECT_NE(message_of(bench + "[[effect]]\nname = \"gremlin\"\n").find("unknown effect \"gremlin\""), std::string::npos);
    EXPECT_NE(message_of(bench + "[[effect]]\nname = \"slip_sinkage\"\nwheel = 4\n").find("wheels are 0 to 0"), std::string::npos);
    EXPECT_NE(
        message_of(bench + "[[effect]]\nname = \"mine\"\nacts_on = \"wheel_torque\"\nexpression = \"q*w\"\nk = 1\n").find("expression"),
        std::string::npos);
    EXPECT_NE(message_of("[rover\n").find("m.toml:1"), std::string::npos);
}

TEST(Model, what_is_of_another_kind_is_told_and_not_left_out) {
    const std::string wheel = "[[wheel]]\nradius_m = 0.1\n", rover = "[rover]\nmotion = \"imposed\"\n";
    const auto is = [](const std::string &text, const std::string &key, const std::string &wrong) {
        EXPECT_NE(message_of(text).find(key + ": " + wrong), std::string::npos) << text << message_of(text);
    };
    const std::string no_flag = "is neither true nor false; write true or false, without quotes",
                      no_text = "is not a text; write it in quotes";
    is(rover + wheel + "driven = \"no\"\n", "m.toml:5: wheel[0].driven", no_flag);
    is(rover + wheel + "grips_sideways = 0\n", "wheel[0].grips_sideways", no_flag);
    is(rover + "halves = \"yes\"\n" + wheel, "m.toml:3: rover.halves", no_flag);
    is(rover + wheel + "[sensors.current]\nunsigned = \"yes\"\n", "sensors.current.unsigned", no_flag);
    is(rover + wheel + "[motor]\nresistance_ohm = { value = 3, fixed = \"true\" }\n", "motor.resistance_ohm.fixed", no_flag);
    is("[rover]\nmotion = 1\n" + wheel, "rover.motion", no_text);
    is(rover + wheel + "[soil]\nlaw = 3\n", "soil.law", no_text);
    is("format = 1\n" + rover + wheel, "format", no_text);
    is(rover + wheel + "[motor]\nresistance_ohm = { value = 3, unit = 1 }\n", "motor.resistance_ohm.unit", no_text);
    is(rover + wheel + "[[effect]]\nname = \"slip_sinkage\"\nwheel = \"0\"\n", "effect[0].wheel", "is not a whole number");
}

TEST(Model, a_number_given_twice_is_refused_and_a_key_is_known_by_what_may_stand_there) {
    const std::string rover = "[rover]\nmotion = \"imposed\"\n", wheel = "[[wheel]]\nradius_m = 0.1\nload_N = 7\n";
    const auto is = [](const std::string &text, const std::string &what) {
        EXPECT_NE(message_of(text).find(what), std::string::npos) << text << message_of(text);
    };
    is(rover + wheel + "[motor]\ntorque_constant_Nm_A = 0.5\nmotor_constant_Nm_A = 0.01\ngear_ratio = 50\n",
       "m.toml:8: motor.motor_constant_Nm_A: stands beside torque_constant_Nm_A, which it makes; give one of the two");
    is(rover + wheel + "[motor]\nback_emf_Vs_rad = 0.5\nmotor_back_emf_Vs_rad = 0.01\n", "stands beside back_emf_Vs_rad");
    is(rover + wheel + "[motor]\ninertia_kg_m2 = 0.5\nmotor_inertia_kg_m2 = 0.01\n", "stands beside inertia_kg_m2");
    is(rover + wheel + "[soil]\nmu = 0.6\nstrength_N = 5\n", "soil.mu: stands beside strength_N, which makes it");
    const std::string bekker = "[soil]\nlaw = \"bekker\"\ncohesion_Pa = 1\nfriction_angle_rad = 0.4\nshear_length_m = 0.02\n"
                               "contact_length_m = 0.04\n";
    EXPECT_EQ(message_of(rover + wheel + bekker), "");
    is(rover + wheel + bekker + "shear_slip = 0.4\n", "soil.shear_slip: stands beside shear_length_m, which makes it");
    // a motor of one side for all, and of the other side for one wheel: the wheel's own holds
    const Model one = parse_model(rover + wheel +
                                      "[wheel.motor]\nmotor_constant_Nm_A = 0.01\ngear_ratio = 30\n[motor]\n"
                                      "torque_constant_Nm_A = 0.5\n",
                                  "m");
    EXPECT_DOUBLE_EQ(one.wheel[0].motor.at("torque_constant_Nm_A").value, 0.3);

    is(rover + wheel + "drivn = false\n", "wheel[0].drivn: is not a known key; did you mean driven?"); // not x_m
    is(rover + wheel + "[sensors.radar]\nunsigned = true\n", "sensors.radar.unsigned: is not a known key; known here: noise_m_s");
    is(rover + wheel + "[sensors.acel]\nnoise_m_s2 = 1\n", "did you mean accel.noise_m_s2?");
    is(rover + wheel + "[motor]\ncolour = 1\n", "known here: ");
}

TEST(Model, what_is_written_reads_back_to_the_same_numbers) {
    const Model model =
        parse_model(bench + "[[effect]]\nname = \"slip_sinkage\"\ncoefficient = { value = 0.15, low = 0.1, high = 0.2 }\n", "b");
    const std::string once = model_text(model);
    EXPECT_EQ(once, model_text(parse_model(once, "b")));
    EXPECT_EQ(make_physics(parse_model(once, "b")).body.slip_sinkage, 0.15);
}

TEST(Model, bekker_parameters_become_those_of_the_literature_sand) {
    const Model model =
        parse_model("[rover]\nmotion = \"imposed\"\n[[wheel]]\nradius_m = 0.057\nwidth_m = 0.042\nload_N = 7\n[soil]\nlaw = \"bekker\"\n"
                    "cohesion_Pa = 1040\nfriction_angle_rad = 0.4886921906\nshear_length_m = 0.02\ncontact_length_m = 0.04\n",
                    "m");
    const WheelPhysics w = make_physics(model).wheel[0];
    EXPECT_NEAR(w.adhesion + w.mu * 7, 5.47, 0.005); // docs/sources.md section 7, fig 15: Fm = 5.47 N, rounded to 0.01
    EXPECT_NEAR(w.sc, 0.5, 1e-12);                   // K/l = 2 cm / 4 cm
}

TEST(Slip, is_bounded_odd_and_zero_at_rest) {
    for (double rim = -1; rim <= 1; rim += 0.125)
        for (double v = -1; v <= 1; v += 0.125) {
            EXPECT_LE(std::fabs(slip_of(rim, v)), 1);
            EXPECT_EQ(slip_of(-rim, -v), -slip_of(rim, v));
        }
    EXPECT_EQ(slip_of(0, 0), 0);
    EXPECT_NEAR(slip_of(0.2, 0.15), 0.25, 1e-15);  // 1 - v/(R w)
    EXPECT_NEAR(slip_of(0.15, 0.2), -0.25, 1e-15); // R w/v - 1
}

// Tyres that are wound up at a stop turn the body until nothing pulls: two seconds later a slip of 5 mm is gone. On the way it is kept.
TEST(Slip, that_lags_is_worn_off_at_rest_and_kept_on_the_way) {
    const double step_s = 0.01, h_1_m = step_s / 0.005;
    double along = 0.1, across = 0.1;
    for (int k = 0; k < 200; ++k) along = lagging_slip(along, h_1_m, 0.0, 0.0), across = side_slip(across, h_1_m, 0.0, 0.0, 0.0);
    EXPECT_LT(along, 0.1 * std::exp(-5.0));
    EXPECT_LT(across, 0.1 * std::exp(-5.0));
    for (const double speed : {0.05, 0.1, 0.5}) {
        double slip = 0;
        for (int k = 0; k < 2000; ++k) slip = lagging_slip(slip, h_1_m, speed, 0.9 * speed);
        EXPECT_NEAR(slip, 0.1, 0.001) << speed; // 1 - v/(R w), within a hundredth
    }
}

TEST(Smooth, a_parabola_passes_unchanged_with_its_slope) {
    std::vector<double> t, y;
    for (int i = 0; i < 60; ++i) t.push_back(0.02 * i + 0.003 * ((i * 7) % 5)), y.push_back(3 - 2 * t.back() + 5 * t.back() * t.back());
    const Smooth s = smooth_at(t, y, 0.1, 0.01, 90, 0.07, 2);
    for (std::size_t k = 0; k < 90; ++k) {
        const double x = 0.1 + 0.01 * static_cast<double>(k);
        EXPECT_NEAR(s.value[k], 3 - 2 * x + 5 * x * x, 1e-9); // exact but for rounding of the 3 x 3 solution
        EXPECT_NEAR(s.slope[k], -2 + 10 * x, 1e-7);
    }
}

} // namespace
} // namespace traction::lab
