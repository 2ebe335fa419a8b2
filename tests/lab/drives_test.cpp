// A motor that turns several wheels: the model's key and its refusals, and the motor's balance in closed form.
#include "host_tools/lab/forward/forward.h"
#include "host_tools/lab/forward/physics.h"
#include "host_tools/lab/model/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace traction::lab {
namespace {

const std::string rover =
    "[rover]\nmass_kg = 8\nDRIVES\n[wheels]\nradius_m = 0.1\n[motor]\ntorque_constant_Nm_A = 0.5\nresistance_ohm = 1\n"
    "coulomb_Nm = 0.2\n[soil]\nmu = 0.7\nshear_slip = 0.1\n[[wheel]]\nx_m = -0.2\ny_m = 0.3\n[[wheel]]\nx_m = -0.2\ny_m = "
    "-0.3\n[[wheel]]\nx_m = 0.2\ny_m = 0.3\n[[wheel]]\nx_m = 0.2\ny_m = -0.3\n";

std::string with(const std::string &drives, const std::string &more = "") {
    std::string text = rover + more;
    return text.replace(text.find("DRIVES"), 6, drives.empty() ? "" : "drives = " + drives);
}

std::string refusal(const std::string &text) {
    try {
        parse_model(text, "m.toml");
    } catch (const ModelError &error) {
        return error.what();
    }
    return "accepted";
}

std::vector<std::size_t> motors(const Model &model) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < model.wheel.size(); ++i) out.push_back(model.motor_of(i));
    return out;
}

TEST(Drives, a_motor_turns_the_wheels_of_its_side_or_those_that_are_named) {
    using Of = std::vector<std::size_t>;
    EXPECT_EQ(motors(parse_model(with(""), "m")), (Of{0, 1, 2, 3}));
    EXPECT_EQ(motors(parse_model(with("[0, 1]"), "m")), (Of{0, 1, 0, 1}));
    EXPECT_EQ(motors(parse_model(with("[2, 3]"), "m")), (Of{2, 3, 2, 3}));
    EXPECT_EQ(motors(parse_model(with("[[2, 0], 1]"), "m")), (Of{2, 1, 2, 1}));
    EXPECT_EQ(motors(parse_model(with("[[0, 1], [2], [3]]"), "m")), (Of{0, 0, 2, 3})); // an axle on one motor
    const std::string six = with("[0, 1]", "[[wheel]]\ny_m = 0.3\n[[wheel]]\ny_m = -0.3\n");
    EXPECT_EQ(motors(parse_model(six, "m")), (Of{0, 1, 0, 1, 0, 1}));
    EXPECT_EQ(motors(parse_model(with("[0, 1]", "[[wheel]]\ndriven = false\n"), "m")), (Of{0, 1, 0, 1, 4})); // a caster
    EXPECT_EQ(motors(read_model("models/husky.toml")), (Of{0, 1, 0, 1}));
}

TEST(Drives, a_grouping_that_cannot_be_is_refused_with_line_and_mend) {
    const auto told = [](const std::string &drives, const std::string &words, const std::string &more = "") {
        const std::string message = refusal(with(drives, more));
        EXPECT_NE(message.find(words), std::string::npos) << drives << ": " << message;
    };
    told("[0]", "m.toml:3: rover.drives: leaves wheel 1 without a drive; add it to a motor's wheels");
    told("[[0, 2], [1]]", "leaves wheel 3 without a drive");
    told("[[0, 2], [1, 2, 3]]", "has wheel 2 twice; a wheel turns with one motor");
    told("[0, 1, 0]", "has wheel 0 twice");
    told("[0, 2, 1, 5]", "names wheel 5; wheels are 0 to 3");
    told("[0, -1]", "names wheel -1");
    told("2", "is no list of wheels");
    told("[]", "is no list of wheels");
    told("[[], 0, 1]", "has an empty list");
    told("[0, 1.5]", "holds what is no wheel");
    told("[0, 2, 1]", "wheel 4 may turn with wheel 0 or with wheel 2", "[[wheel]]\ny_m = 0.3\n");
    told("[0, 1, 4]", "names wheel 4, which has driven = false", "[[wheel]]\ndriven = false\n");
    told("[0, 1]", "wheel[3].motor: is the motor of a wheel that turns with wheel 1; write it at wheel 1",
         "[wheel.motor]\ncoulomb_Nm = 0.3\n");
    told("[0, 1]", "2 turns with wheel 0, and wiring_resistance is on a motor; write wheel = 0",
         "[[effect]]\nname = \"wiring_resistance\"\nwheel = 2\nresistance_ohm = 0.1\n");
    told("[0, 1]", "3 turns with wheel 1, and grease is on a motor",
         "[[effect]]\nname = \"grease\"\nwheel = 3\nacts_on = \"wheel_friction\"\nexpression = \"k\"\nk = 0.1\n");
    EXPECT_EQ(refusal(with("[0, 1]", "[[effect]]\nname = \"rolling_resistance\"\nwheel = 2\ncoefficient = 0.05\n")), "accepted");
}

TEST(Drives, what_is_written_reads_back_to_the_same_machine) {
    for (const char *drives : {"[2, 3]", "[[1, 3], [2, 0]]", "[[3, 0], [1], [2]]"}) {
        Model model = parse_model(with(drives), "m");
        for (std::size_t i = 0; i < 4; ++i) // as a fit leaves it: each motor's own number
            if (model.motor_of(i) == i) model.wheel[i].motor.at("coulomb_Nm").value = 0.2 + 0.01 * static_cast<double>(i);
        const std::string once = model_text(model);
        const Model again = parse_model(once, "m");
        EXPECT_EQ(motors(again), motors(model)) << once;
        EXPECT_EQ(model_text(again), once);
        const Physics a = make_physics(model), b = make_physics(again);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(a.wheel[i].t0, b.wheel[i].t0) << drives;
            EXPECT_EQ(a.wheel[i].t0, a.wheel[model.motor_of(i)].t0) << drives;
        }
    }
}

// Steady wheels at w, motion imposed by hand: rows of the balances that the motors have.
Dataset steady(const Model &model, const std::vector<double> &w_rad_s, bool spins) {
    Dataset data;
    data.step_s = 0.02, data.count = 400;
    data.gap.assign(data.count, 0);
    for (std::size_t i = 0; i < model.wheel.size(); ++i) {
        WheelInput in;
        const double w = w_rad_s[model.motor_of(i)];
        in.speed_rad_s.assign(data.count, w), in.accel_rad_s2.assign(data.count, 0);
        for (std::size_t k = 0; k < data.count; ++k) in.angle_rad.push_back(w * data.step_s * static_cast<double>(k));
        in.turns_with = model.wheel[i].drive;
        data.wheel.push_back(in);
    }
    data.yaw_free = spins;
    for (std::size_t i = 0; i < model.wheel.size(); ++i) {
        if (model.motor_of(i) != i) continue;
        Balance b;
        b.kind = BalanceKind::current_torque, b.wheel = static_cast<int>(i), b.noise = 0.01;
        for (double t = 6; t < 7.8; t += 0.05) b.t0_s.push_back(t), b.t1_s.push_back(t + 0.05), b.measured.push_back(0);
        data.balance.push_back(b);
    }
    return data;
}

// Straight ahead, steady: the tractions make up for the rolling resistance, so KG I = t0 + sum R Ft = t0 + R c (sum of the motor's loads):
// twice what a motor of one wheel pulls, friction once.
TEST(Drives, a_motor_carries_the_tractions_of_its_wheels_and_one_friction) {
    const double weight = 8 * 9.81, crr = 0.05;
    const auto current = [&](const std::string &drives, double offset_m) {
        Model model = parse_model(with(drives), "m");
        for (WheelSpec &wheel : model.wheel) wheel.soil.at("rolling_coefficient").value = crr;
        Physics physics = make_physics(model);
        physics.body.offset_x_m = offset_m;
        const Dataset data = steady(model, {5, 5, 5, 5}, false);
        return Forward(data).predict(physics);
    };
    // 5e-5 A: the rolling resistance turns over 5 mm/s, so at 0.5 m/s 5e-5 of it is not there yet
    EXPECT_NEAR(current("[0, 1]", 0)[0], (0.2 + 0.1 * crr * weight / 2) / 0.5, 5e-5);
    EXPECT_NEAR(current("", 0)[0], (0.2 + 0.1 * crr * weight / 4) / 0.5, 5e-5);
    EXPECT_NEAR(current("[[0, 1, 2, 3]]", 0)[0], (0.2 + 0.1 * crr * weight) / 0.5, 5e-5);
    // wherever the weight lies between its wheels, a side's motor carries half of it
    EXPECT_NEAR(current("[0, 1]", 0.1)[0], (0.2 + 0.1 * crr * weight / 2) / 0.5, 5e-5);
}

// A wheel with a radius of its own slips by what its rim differs from the other's: on ground where they grip, the two of a motor then work
// against each other, and the motor carries the sum of R Ft.
TEST(Drives, each_wheel_of_a_motor_keeps_its_own_radius_slip_and_load) {
    Model model = parse_model(with("[0, 1]"), "m");
    Physics physics = make_physics(model);
    for (const std::size_t i : {2U, 3U}) physics.wheel[i].radius_change = 0.02;
    const Dataset data = steady(model, {5, 5}, false);
    Motion motion;
    integrate(data, physics, motion, nullptr, true);
    const std::size_t k = 380;
    const double v = motion.v_m_s[k];
    EXPECT_GT(v, 0.5); // between the two rims
    EXPECT_LT(v, 0.51);
    for (std::size_t i = 0; i < 4; ++i) {
        const double rim = i < 2 ? 0.5 : 0.51;
        EXPECT_NEAR(motion.wheel[i].slip[k], (rim - v) / std::max(rim, v), 1e-6) << i; // (1) of wheel_laws.h
    }
    const double rear = motion.wheel[0].traction_N[k], front = motion.wheel[2].traction_N[k];
    EXPECT_NEAR(rear, -front, 1e-3); // nothing else pulls: within what a step of the search leaves
    EXPECT_GT(front, 0.5);           // each slips by 1 %: a tenth of the shear slip, Fm (x/2 - x^2/6) = 0.65 N
    const Eigen::VectorXd rows = Forward(data).predict(physics);
    EXPECT_NEAR(rows[0], (0.2 + 0.1 * rear + 0.102 * front) / 0.5, 1e-5); // friction reverses smoothly
}

// On the spot, at -w and w: front and rear wheel of a side share a speed, hence, equally loaded, a slip and a traction.
TEST(Drives, on_the_spot_front_and_rear_wheel_of_a_side_do_the_same) {
    Model model = parse_model(with("[0, 1]"), "m");
    for (WheelSpec &wheel : model.wheel) wheel.soil.at("lateral_coefficient").value = 0.3, wheel.soil.at("lateral_grip").value = 0;
    const Physics physics = make_physics(model);
    const Dataset data = steady(model, {-4, 4}, true);
    Motion motion;
    integrate(data, physics, motion, nullptr, true);
    const std::size_t k = 380;
    EXPECT_GT(motion.yaw_rate_rad_s[k], 0.5);
    // the pulls at 0.3 m beside the middle make up for the scrub at 0.2 m ahead of it and behind: 2e-3, it turns over 5 mm/s of 0.2
    EXPECT_NEAR(motion.wheel[1].traction_N[k], 0.3 * (8 * 9.81 / 4) * 0.2 / 0.3, 2e-3);
    EXPECT_NEAR(motion.v_m_s[k], 0, 1e-6); // by symmetry
    for (const std::size_t side : {0U, 1U}) {
        EXPECT_NEAR(motion.wheel[side].slip[k], motion.wheel[side + 2].slip[k], 1e-6);
        EXPECT_NEAR(motion.wheel[side].traction_N[k], motion.wheel[side + 2].traction_N[k], 1e-6);
    }
    const Eigen::VectorXd rows = Forward(data).predict(physics);
    const double pull = 2 * motion.wheel[1].traction_N[k];
    EXPECT_NEAR(rows[rows.size() - 1], (0.2 + 0.1 * pull) / 0.5, 1e-5); // the right motor's; friction reverses smoothly
}

} // namespace
} // namespace traction::lab
