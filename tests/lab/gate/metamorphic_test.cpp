// What says nothing about the machine changes no verdict: the clock's origin, the order of the wheels, the unit of an axis, the noise that
// is stated, one log or two.
#include "spoil.h"

#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/inputs/join_runs.h"
#include "tests/lab/generator/generator.h"

#include <gtest/gtest.h>
#include <map>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace traction::gate {
namespace {

constexpr double duration_s = 100;

const log::Log &hidden() { // one effect on one wheel and 100 s: what is named must follow the wheel
    static const log::Log log = [] {
        generator::GeneratorConfig config;
        config.soil = generator::Soil::concrete;
        config.seed = 77;
        config.duration_s = duration_s;
        config.hidden = {generator::parse_setting("viscous_friction:coefficient_Nms=0.006,wheel=1")};
        return generator::generate(config);
    }();
    return log;
}

lab::Model machine() { return lab::read_model("tests/lab/campaign/machine_concrete.toml"); }

lab::Diagnosis verdict(const log::Log &log, const lab::Model &model) {
    lab::DiagnoseOptions quick; // shapes are asked of what is left, and cost most of the time
    quick.shapes = false;
    return lab::diagnose(model, lab::make_dataset(model, log), quick);
}

const lab::Diagnosis &as_it_is() {
    static const lab::Diagnosis d = verdict(hidden(), machine());
    return d;
}

TEST(Metamorphic, the_hidden_effect_is_named_as_it_is) {
    ASSERT_FALSE(as_it_is().effects.empty());
    EXPECT_EQ(as_it_is().effects[0], "viscous_friction on wheel 1");
}

TEST(Metamorphic, the_clock_may_begin_anywhere) {
    log::Log log = hidden();
    for (log::Signal &s : log.signals)
        for (double &t : s.t_s) t += 1000;
    EXPECT_EQ(verdict(log, machine()).effects, as_it_is().effects);
}

TEST(Metamorphic, wheels_may_be_numbered_in_any_order) {
    const std::size_t order[] = {2, 3, 0, 1}; // wheel i of the new numbering was order[i]
    log::Log log = hidden();
    lab::Model model = machine();
    for (std::size_t i = 0; i < 4; ++i) model.wheel[i] = machine().wheel[order[i]];
    for (log::Signal &s : log.signals) {
        if (s.name.rfind("wheel", 0) != 0) continue;
        const auto was = static_cast<std::size_t>(s.name[5] - '0');
        s.name[5] = static_cast<char>('0' + (std::find(order, order + 4, was) - order));
    }
    std::map<std::string, std::string> header;
    for (const auto &[key, value] : hidden().header) {
        std::string name = key;
        if (const auto at = name.find("wheel"); at != std::string::npos && at + 6 < name.size() && name[at + 6] == '.')
            name[at + 5] = static_cast<char>('0' + (std::find(order, order + 4, static_cast<std::size_t>(name[at + 5] - '0')) - order));
        header[name] = value;
    }
    log.header = header;
    const lab::Diagnosis d = verdict(log, model);
    ASSERT_EQ(d.effects.size(), as_it_is().effects.size());
    EXPECT_EQ(d.effects[0], "viscous_friction on wheel 3");
}

// A data sheet's noise is seldom the sensor's: what is named, and which wheel, must not hang on it.
TEST(Metamorphic, the_noise_that_is_stated_may_be_wrong_by_a_factor_of_ten) {
    for (const double factor : {0.316, 3.16}) { // the widest of the two is ten times the least
        log::Log log = hidden();
        for (auto &[key, value] : log.header)
            if (key.rfind("noise.", 0) == 0) value = std::to_string(factor * std::stod(value));
        lab::Model model = machine();
        const lab::Diagnosis d = verdict(log, model);
        ASSERT_FALSE(d.effects.empty()) << factor;
        EXPECT_EQ(d.effects, as_it_is().effects) << factor;
        EXPECT_NEAR(d.accepted[0].value[0], as_it_is().accepted[0].value[0], 0.1 * as_it_is().accepted[0].value[0]) << factor;
    }
}

// The first and the second half of a drive as two logs.
std::vector<log::Log> two_logs(const log::Log &whole) {
    std::vector<log::Log> halves{whole, whole};
    for (std::size_t i = 0; i < 2; ++i)
        for (log::Signal &s : halves[i].signals) {
            log::Signal part{s.name, {}, {}};
            for (std::size_t k = 0; k < s.t_s.size(); ++k)
                if ((s.t_s[k] < duration_s / 2) == (i == 0)) part.t_s.push_back(s.t_s[k]), part.value.push_back(s.value[k]);
            s = std::move(part);
        }
    return halves;
}

TEST(Metamorphic, one_drive_in_two_logs_is_the_same_drive) {
    EXPECT_EQ(verdict(lab::join_runs(two_logs(hidden())).log, machine()).effects, as_it_is().effects);
}

// Between two runs somebody carries the rover to another place and turns it round: its camera sees the same motion from elsewhere.
TEST(Metamorphic, a_run_may_begin_anywhere_and_at_any_heading) {
    std::vector<log::Log> moved = two_logs(hidden());
    const double turn = 2.1, c = std::cos(turn), s = std::sin(turn);
    const auto signal = [&](const char *name) {
        return std::find_if(moved[1].signals.begin(), moved[1].signals.end(), [&](const log::Signal &one) { return one.name == name; });
    };
    const auto x = signal("camera.x_m"), y = signal("camera.y_m"), yaw = signal("camera.yaw_rad");
    ASSERT_TRUE(x != moved[1].signals.end() && y != moved[1].signals.end() && yaw != moved[1].signals.end());
    ASSERT_EQ(x->t_s, y->t_s);
    for (std::size_t k = 0; k < x->value.size(); ++k) {
        const double east = x->value[k], north = y->value[k];
        x->value[k] = c * east - s * north + 3, y->value[k] = s * east + c * north - 5;
    }
    for (double &angle : yaw->value) angle += turn;
    const lab::Diagnosis plain = verdict(lab::join_runs(two_logs(hidden())).log, machine());
    const lab::Diagnosis d = verdict(lab::join_runs(moved).log, machine());
    EXPECT_EQ(d.effects, as_it_is().effects);
    ASSERT_FALSE(d.ladder.empty());
    EXPECT_NEAR(d.ladder[0].train, plain.ladder[0].train, 1e-6 * plain.ladder[0].train); // a rigid motion changes rounding alone
}

// A mass on a rail with friction, driven back and forth by a smooth force: position and current, 200 Hz. Second-order steps of 0.1 ms.
log::Log axis(double radius_m) {
    constexpr double mass = 95, viscous = 200, coulomb = 20, gain = 35;
    log::Log log;
    log.signals = {{"wheel0.angle_rad", {}, {}}, {"wheel0.current_A", {}, {}}};
    std::mt19937_64 random(3);
    const auto noise = [&] {
        double sum = -6;
        for (int i = 0; i < 12; ++i) sum += static_cast<double>(random() >> 11U) * 0x1p-53;
        return sum;
    };
    double x = 0, v = 0;
    for (int k = 0; k < 400000; ++k) {
        const double t = k * 1e-4, force = 170 * std::sin(0.9 * t) * (1 + 0.5 * std::sin(0.23 * t));
        if (k % 50 == 0) {
            log.signals[0].t_s.push_back(t), log.signals[0].value.push_back((x + 2e-6 * noise()) / radius_m);
            log.signals[1].t_s.push_back(t), log.signals[1].value.push_back(force / gain + 0.05 * noise());
        }
        const auto accel = [&](double speed) { return (force - viscous * speed - coulomb * std::tanh(speed / 1e-3)) / mass; };
        const double middle = v + 0.5e-4 * accel(v);
        x += 1e-4 * middle, v += 1e-4 * accel(middle);
    }
    return log;
}

lab::Model axis_model(double radius_m) {
    const auto number = [](double x) { return std::to_string(x); };
    return lab::parse_model(
        "format = \"traction.model/1\"\nname = \"axis\"\n[rover]\nmotion = \"none\"\n[wheels]\nradius_m = " + number(radius_m) +
            "\n[[wheel]]\nname = \"carriage\"\n[motor]\ntorque_constant_Nm_A = { value = " + number(35 * radius_m) +
            ", prior = " + number(0.35 * radius_m) + " }\ninertia_kg_m2 = { value = " + number(90 * radius_m * radius_m) +
            ", prior = " + number(9 * radius_m * radius_m) + " }\nviscous_Nms = { value = " + number(180 * radius_m * radius_m) +
            ", prior = " + number(40 * radius_m * radius_m) + " }\ncoulomb_Nm = { value = " + number(18 * radius_m) +
            ", prior = " + number(5 * radius_m) + " }\n[sensors.current]\nnoise_A = 0.05\n",
        "axis");
}

TEST(Metamorphic, the_radius_chosen_for_a_linear_axis_changes_nothing) {
    double error[2] = {}, mass[2] = {};
    std::size_t rows[2] = {};
    const double radii[2] = {1, 0.1};
    for (int i = 0; i < 2; ++i) {
        lab::Model model = axis_model(radii[i]);
        const lab::Dataset data = lab::make_dataset(model, axis(radii[i]));
        ASSERT_EQ(data.balance.size(), 1U) << "nothing is compared at R = " << radii[i];
        rows[i] = data.balance[0].measured.size();
        error[i] = lab::fit_model(model, data, "fitted").train;
        mass[i] = model.wheel[0].motor.at("inertia_kg_m2").value / (radii[i] * radii[i]);
    }
    EXPECT_EQ(rows[0], rows[1]);
    EXPECT_NEAR(error[0], error[1], 0.02 * error[1]);
    EXPECT_NEAR(mass[0], mass[1], 0.005 * mass[1]);
    EXPECT_NEAR(mass[0], 95, 2); // and it is the truth's, within what the friction's smooth step of 1 mm/s hides
}

} // namespace
} // namespace traction::gate
