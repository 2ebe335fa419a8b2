// The independent rover obeys what it states: (17)-(20) in steady motion, momentum, repeatability. Truth here is closed form.
#include "tests/lab/generator/generator.h"

#include <algorithm>
#include <cstdint>
#include <gtest/gtest.h>
#include <stdexcept>

#include <cmath>
#include <numbers>
#include <string_view>

using namespace traction;
using namespace traction::generator;

namespace {

GeneratorConfig plain(double duration_s) {
    GeneratorConfig config;
    config.duration_s = duration_s;
    config.exact = config.quiet = config.truth = true;
    return config;
}

double at_end(const log::Log &log, const std::string &name) {
    for (const log::Signal &signal : log.signals)
        if (signal.name == name) return signal.value.back();
    throw std::out_of_range(name);
}

const log::Signal &signal_of(const log::Log &log, std::string_view name) {
    for (const log::Signal &signal : log.signals)
        if (signal.name == name) return signal;
    throw std::out_of_range(std::string(name));
}

} // namespace

TEST(IndependentRover, cruises_where_traction_equals_rolling_resistance_and_the_motor_gives_both) {
    GeneratorConfig config = plain(40);
    config.drive = "cruise";
    const log::Log log = generate(config);
    const Machine m = nominal(Soil::sand);
    const double load = m.mass * m.gravity / 4, need = m.rolling * load;
    const log::Signal &count = signal_of(log, "wheel0.encoder_count");
    const std::size_t n = count.value.size();
    const double w = (count.value[n - 1] - count.value[n - 101]) * 2 * std::numbers::pi / 6000 / 1.0;
    // Ft = Rr; printed to 1e-8, approach within exp(-20 s / 2 s) of the rest: 1e-3 N
    EXPECT_NEAR(at_end(log, "truth.wheel0.traction_N"), need, 1e-3);
    // KG*I = Gr(w) + R*Ft, (17)-(18); 1e-3 N * R / KG = 2e-4 A, and the loop hunts by one PWM step: 5e-4 * 7.5 V / Ra = 1.2e-3 A
    EXPECT_NEAR(at_end(log, "wheel0.current_A"), (m.viscous * w + m.coulomb + m.radius * need) / m.KG, 1.4e-3);
    // I = (duty*V - ke*w)/Ra; duty in steps of 5e-4 of 7.2 V: 1.1e-3 A
    EXPECT_NEAR(at_end(log, "wheel0.current_A"), (at_end(log, "wheel0.duty") * at_end(log, "battery.voltage_V") - m.ke * w) / m.Ra, 2.5e-3);
    // s = 1 - v/(R w) satisfies (20): Fm*(1 - sc/s*(1 - exp(-s/sc))) = Rr; slip to 1e-4 is 1e-4 * Fm/(2 sc) = 1e-3 N
    const double s = 1 - at_end(log, "truth.speed_m_s") / (m.radius * w);
    EXPECT_NEAR(m.mu * load * (1 - m.sc / s * (1 - std::exp(-s / m.sc))), need, 3e-3);
}

TEST(IndependentRover, holds_the_voltage_balance_whatever_the_friction) {
    GeneratorConfig config = plain(30);
    config.hidden = {parse_setting("coulomb_friction:torque_Nm=0.05")};
    const log::Log log = generate(config);
    const Machine m = nominal(Soil::sand);
    const log::Signal &I = signal_of(log, "wheel1.current_A"), &count = signal_of(log, "wheel1.encoder_count"),
                      &V = signal_of(log, "battery.voltage_V");
    const log::Signal &duty = signal_of(log, "wheel1.duty");
    double worst = 0;
    for (std::size_t k = 1; k < I.value.size(); ++k) { // row k: means over the 10 ms that end there; duty[k] of the row that began them
        const double w = (count.value[k] - count.value[k - 1]) * 2 * std::numbers::pi / 6000 / 0.01;
        worst = std::max(worst, std::fabs(I.value[k] - (duty.value[k] * V.value[k] - m.ke * w) / m.Ra));
    }
    // means of ten 1 ms samples at their ends against a mean over the interval: half a step of dw/dt (<= 150 rad/s^2) * ke/Ra
    EXPECT_LT(worst, 0.5e-3 * 150 * m.ke / m.Ra + 1e-3);
}

TEST(IndependentRover, an_accelerometer_on_a_slope_feels_gravity) {
    GeneratorConfig config = plain(30);
    config.drive = "cruise";
    config.hidden = {parse_setting("grade:slope_rad=0.1,direction_rad=0")};
    EXPECT_NEAR(at_end(generate(config), "imu.accel_x_m_s2"), 9.81 * std::sin(0.1), 5e-3); // steady: dv/dt below 5e-3
}

TEST(IndependentRover, repeats_to_the_last_digit_and_differs_by_seed) {
    GeneratorConfig config;
    config.duration_s = 5;
    config.drive = "stairs";
    const log::Log first = generate(config), again = generate(config);
    for (std::size_t i = 0; i < first.signals.size(); ++i)
        EXPECT_EQ(first.signals[i].value, again.signals[i].value) << first.signals[i].name;
    config.seed = 2;
    EXPECT_NE(signal_of(first, "imu.accel_x_m_s2").value, signal_of(generate(config), "imu.accel_x_m_s2").value);
}

TEST(IndependentRover, draws_every_wheel_for_itself_by_its_tolerances_and_leaves_the_rest_of_the_machine_as_it_was) {
    GeneratorConfig config;
    double squares = 0, friction = 0;
    constexpr int machines = 200;
    for (config.seed = 1; config.seed <= machines; ++config.seed) {
        config.apart = false;
        const Machine alike = machine_of(config);
        config.apart = true;
        const Machine apart = machine_of(config);
        EXPECT_EQ(alike.KG_each, (PerWheel{1, 1, 1, 1}));
        EXPECT_EQ(alike.KG, apart.KG); // the same machine of the same type, on the same ground
        EXPECT_EQ(alike.mu, apart.mu);
        for (std::size_t i = 0; i < wheels; ++i)
            squares += std::pow(apart.KG_each[i] - 1, 2), friction += std::pow(apart.coulomb_each[i] - 1, 2);
    }
    // 800 draws of a normal cut off at 2.5 sigma (its deviation 0.977 of it): the estimate is within 3 * 0.977/sqrt(1600) of that
    EXPECT_NEAR(std::sqrt(squares / (4 * machines)) / WheelSpread().KG, 0.977, 0.074);
    EXPECT_NEAR(std::sqrt(friction / (4 * machines)) / WheelSpread().friction, 0.977, 0.074);
}

TEST(IndependentRover, a_repeat_run_differs_in_noise_alone) {
    GeneratorConfig config;
    config.duration_s = 5;
    config.drive = "stairs";
    config.truth = true;
    const log::Log first = generate(config);
    config.noise_seed = 1;
    const log::Log again = generate(config);
    EXPECT_NE(signal_of(first, "imu.accel_x_m_s2").value, signal_of(again, "imu.accel_x_m_s2").value);
    // the drive hangs on encoder counts (noise-free but quantised) and battery voltage noise: the run is the same to 1 cm/s
    EXPECT_NEAR(at_end(first, "truth.speed_m_s"), at_end(again, "truth.speed_m_s"), 0.01);
}

TEST(IndependentRover, every_kind_changes_the_log_and_none_diverges) {
    GeneratorConfig config = plain(45); // the whole plan, shortened; past the earliest friction_step at 40 s
    const log::Log clean = generate(config);
    for (const Kind &kind : kinds()) {
        config.hidden.assign(1, {std::string(kind.name), -1, {}});
        for (const KindParameter &p : kind.parameters)
            config.hidden[0].values.emplace_back(p.name, p.strength ? p.high : p.choices.front());
        const log::Log log = generate(config);
        bool changed = false;
        for (std::size_t i = 0; i < clean.signals.size() && !changed; ++i) changed = clean.signals[i].value != log.signals[i].value;
        EXPECT_TRUE(changed) << kind.name;
    }
}

TEST(Blind, the_header_never_says_what_is_hidden) {
    for (std::uint64_t seed = 1; seed < 40; ++seed) {
        BlindCase blind = draw_case(seed, 2);
        const log::Log log = generate(blind.config);
        for (const auto &[key, value] : log.header)
            for (const Setting &setting : blind.config.hidden) EXPECT_EQ((key + value).find(setting.name), std::string::npos);
        for (const log::Signal &signal : log.signals) EXPECT_NE(signal.name.rfind("truth.", 0), 0U);
    }
}
