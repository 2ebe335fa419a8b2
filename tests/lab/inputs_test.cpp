// inputs_test.cpp - what a log becomes before the model is asked: wheels that jump, samples that are means, a command that comes late.
#include "host_tools/lab/fit/screen.h"
#include "host_tools/lab/forward/forward.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/forward/rounding.h"
#include "host_tools/lab/inputs/dataset.h"
#include "host_tools/lab/inputs/inputs.h"
#include "host_tools/lab/inputs/long_log.h"
#include "host_tools/lab/inputs/smooth.h"
#include "host_tools/lab/inputs/stretch.h"
#include "host_tools/simulate/simulate.h"
#include "tests/lab/generator/generator.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <stdexcept>

#include <cmath>
#include <numbers>

namespace traction::lab {
namespace {

constexpr double tick_s = 0.01, jump_s = 3.005, accel_rad_s2 = 30, counts_per_rad = 6000 / (2 * std::numbers::pi);

// A bench motor that turns at 2 rad/s and, from jump_s on, gains accel_rad_s2 for 0.3 s; the current is the torque's, the duty its own.
log::Log motor(double jump_rad_s2) {
    log::Log log;
    log::Signal count{"wheel0.encoder_count", {}, {}}, current{"wheel0.current_A", {}, {}}, duty{"wheel0.duty", {}, {}},
        battery{"battery.voltage_V", {}, {}};
    for (int i = 0; i < 600; ++i) {
        const double t = tick_s * i, since = std::clamp(t - jump_s, 0.0, 0.3), after = std::max(0.0, t - jump_s - 0.3);
        count.t_s.push_back(t),
            count.value.push_back(std::floor(counts_per_rad * (2 * t + jump_rad_s2 * (0.5 * since * since + 0.3 * after))));
        const bool gains = t > jump_s && t < jump_s + 0.3;
        current.t_s.push_back(t), current.value.push_back((0.03 + (gains ? 5e-3 * jump_rad_s2 : 0.0)) / 0.265);
        duty.t_s.push_back(t), duty.value.push_back(i < 300 ? 0.25 : 0.75);
        battery.t_s.push_back(t), battery.value.push_back(8 - 0.1 * t);
    }
    log.signals = {count, current, duty, battery};
    log.header["noise.wheel0.current_A"] = "0.01";
    return log;
}

Model bench() {
    return parse_model(
        "[rover]\nmotion = \"none\"\n[[wheel]]\nradius_m = 0.057\n[motor]\ntorque_constant_Nm_A = 0.265\nresistance_ohm = 3.24\n"
        "inertia_kg_m2 = 5e-3\nviscous_Nms = 0\ncoulomb_Nm = 0.03\n[sensors.encoder]\ncounts_per_turn = 6000\n",
        "bench");
}

const Balance &balance(const Dataset &data, BalanceKind kind) {
    for (const Balance &b : data.balance)
        if (b.kind == kind) return b;
    throw std::logic_error("the balance is missing");
}

TEST(Smooth, a_cubic_passes_unchanged_with_its_slope) {
    std::vector<double> t, y;
    for (int i = 0; i < 60; ++i) t.push_back(0.02 * i + 0.003 * ((i * 7) % 5)), y.push_back(3 - 2 * t.back() + 7 * std::pow(t.back(), 3));
    const Smooth s = smooth_at(t, y, 0.2, 0.01, 70, 0.1, 3);
    for (std::size_t k = 0; k < 70; ++k) {
        const double x = 0.2 + 0.01 * static_cast<double>(k);
        EXPECT_NEAR(s.value[k], 3 - 2 * x + 7 * x * x * x, 1e-8); // exact but for rounding of the 4 x 4 solution
        EXPECT_NEAR(s.slope[k], -2 + 21 * x * x, 1e-6);
    }
}

TEST(Inputs, where_a_wheel_jumps_its_speed_is_followed_closer_and_elsewhere_stays_as_smooth) {
    const Dataset data = make_dataset(bench(), motor(accel_rad_s2));
    const WheelInput &w = data.wheel[0];
    ASSERT_EQ(w.plain_speed_rad_s.size(), data.count);
    double followed = 0, plain = 0;
    for (std::size_t k = 0; k < data.count; ++k) {
        const double t = data.time(k), truth = 2 + accel_rad_s2 * std::clamp(t - jump_s, 0.0, 0.3);
        const bool near = std::min(std::fabs(t - jump_s), std::fabs(t - jump_s - 0.3)) < 0.05;
        if (near) followed += std::pow(w.speed_rad_s[k] - truth, 2), plain += std::pow(w.plain_speed_rad_s[k] - truth, 2);
        if (t < jump_s - 0.2) {
            EXPECT_EQ(w.speed_rad_s[k], w.plain_speed_rad_s[k]) << t;
        }
    }
    EXPECT_LT(followed, 0.6 * plain); // of the parabolas' squared loss at a kink, cubics of the same width leave less than half
}

TEST(Inputs, rows_at_a_jump_have_a_smoothing_bias_and_calm_rows_have_none) {
    const Dataset data = make_dataset(bench(), motor(accel_rad_s2));
    const Balance &torque = balance(data, BalanceKind::current_torque);
    double calm = 0, jump = 0;
    std::size_t rows_there = 0;
    for (std::size_t r = 0; r < torque.measured.size(); ++r) {
        const double t = 0.5 * (torque.t0_s[r] + torque.t1_s[r]);
        if (t < jump_s - 0.2) calm = std::max(calm, torque.noise_factor[r]);
        if (std::fabs(t - jump_s) < 0.05) jump = std::max(jump, torque.noise_factor[r]), ++rows_there;
    }
    EXPECT_LT(calm, 1.2);                            // the encoder's own noise
    EXPECT_TRUE(jump > 2 || rows_there < 2) << jump; // 30 rad/s^2 is 0.57 A, 127 times a row's noise: widened, or left out
}

TEST(Inputs, a_current_that_is_the_mean_of_its_tick_stands_for_the_middle_of_it) {
    log::Log log = motor(0);
    const Balance instant = balance(make_dataset(bench(), log), BalanceKind::current_torque);
    log.header["window.wheel.current_A"] = "0.01";
    const Balance mean = balance(make_dataset(bench(), log), BalanceKind::current_torque);
    ASSERT_GT(mean.t0_s.size(), 10U);
    const std::size_t last = mean.t0_s.size() - 1, same = instant.t0_s.size() - 1;
    EXPECT_NEAR(instant.t1_s[same] - mean.t1_s[last], 0.005, 1e-9);
}

TEST(Inputs, a_speed_that_is_the_mean_of_its_period_stands_for_the_middle_of_it) {
    log::Log log = motor(0);
    log::Signal &speed = log.signals[0];
    speed.name = "wheel0.speed_rad_s";
    for (std::size_t i = 0; i < speed.value.size(); ++i) speed.value[i] = 2 + 3 * (speed.t_s[i] - 0.02); // of a ramp, the mean of 0.04 s
    const auto ramp = [&] {
        const Dataset data = make_dataset(bench(), log);
        return data.wheel[0].speed_rad_s[100] - (2 + 3 * data.time(100));
    };
    EXPECT_NEAR(ramp(), -0.06, 1e-9);
    log.header["window.wheel.speed_rad_s"] = "0.04";
    EXPECT_NEAR(ramp(), 0, 1e-9);
}

TEST(Inputs, a_late_command_meets_the_supply_of_its_own_time) {
    const Dataset data = make_dataset(bench(), motor(0));
    const WheelInput &w = data.wheel[0];
    const double lag = 0.1;
    const std::vector<double> now = data.voltage_integral(w, 0), late = data.voltage_integral(w, lag);
    ASSERT_EQ(late.size(), w.voltage_t_s.size());
    for (const std::size_t j : {std::size_t{100}, std::size_t{500}}) {
        const double t = w.voltage_t_s[j], change = std::min(t, 3.0), rest = t - change;
        // integral of duty (8 - 0.1 t) by hand; late: of duty (8 - 0.1 (t + lag))
        const double by_hand = 0.25 * (8 * change - 0.05 * change * change) + 0.75 * (8 * rest - 0.05 * (t * t - change * change));
        EXPECT_NEAR(now[j], by_hand, 1e-9);
        EXPECT_NEAR(late[j], by_hand - 0.1 * lag * (0.25 * change + 0.75 * rest), 1e-9);
    }
}

TEST(Inputs, a_stretch_of_a_log_keeps_its_times_and_predicts_what_the_whole_does_there) {
    const Model model = bench();
    Dataset whole = make_dataset(model, motor(accel_rad_s2));
    for (std::size_t k = 0; k < whole.count; ++k) whole.wheel[0].width_s.push_back(whole.time(k)); // (any series of the grid)
    const Dataset part = stretch(whole, 2.005, 4.5);
    ASSERT_GE(part.start_s, 2.005);
    ASSERT_EQ(part.wheel[0].width_s.size(), part.count);
    EXPECT_NEAR(part.wheel[0].width_s[0], part.start_s, 1e-9);
    EXPECT_LE(part.time(part.count - 1), 4.5 + 1e-9);
    EXPECT_NEAR(2.495 / whole.step_s, static_cast<double>(part.count), 2); // both ends on the grid
    const Physics physics = make_physics(model);
    const Eigen::VectorXd all = Forward(whole).predict(physics), some = Forward(part).predict(physics);
    Eigen::Index at = 0, row = 0;
    for (std::size_t b = 0; b < whole.balance.size();
         ++b) { // a motor alone remembers nothing: the same rows to the last digit but for sums
        std::size_t kept = 0;
        for (std::size_t r = 0; r < whole.balance[b].measured.size(); ++r, ++at) {
            if (whole.balance[b].t0_s[r] < part.start_s || whole.balance[b].t1_s[r] > part.time(part.count - 1)) continue;
            EXPECT_EQ(part.balance[b].t0_s[kept], whole.balance[b].t0_s[r]);
            EXPECT_EQ(part.balance[b].measured[kept], whole.balance[b].measured[r]);
            if (!whole.balance[b].smoothing_bias.empty()) {
                EXPECT_EQ(part.balance[b].smoothing_bias[kept], whole.balance[b].smoothing_bias[r]);
            }
            EXPECT_NEAR(some[row++], all[at], 1e-9);
            ++kept;
        }
        EXPECT_EQ(kept, part.balance[b].measured.size());
        EXPECT_GT(kept, 40u); // 2.4 s of rows of 50 ms
    }
}

TEST(Inputs, of_a_long_log_the_part_where_the_wheels_change_their_speeds_is_kept_at_the_full_grid_and_it_says_so) {
    log::Log log;
    log::Signal speed{"wheel0.speed_rad_s", {}, {}}, current{"wheel0.current_A", {}, {}};
    for (int i = 0; i < 20000; ++i) { // 2000 s: steady, but for 500 s
        const double t = 0.1 * i;
        speed.t_s.push_back(t), speed.value.push_back(t > 1200 && t < 1700 ? 3 + std::sin(t) : 3);
        current.t_s.push_back(t), current.value.push_back(0.1);
    }
    log.signals = {speed, current};
    log::Log part = log, shorter = log;
    const std::string told = keep_busiest(bench(), part);
    EXPECT_NE(told.find("the log is 2000 s long"), std::string::npos) << told;
    EXPECT_LE(part.signals[0].t_s.front(), 1200);
    EXPECT_GE(part.signals[0].t_s.back(), 1700 - 0.1); // all of it, in 600 s
    EXPECT_LE(part.duration_s(), longest_log_s + 0.1);
    EXPECT_DOUBLE_EQ(measured_data(bench(), part).step_s, 0.02);
    EXPECT_GT(measured_data(bench(), log).step_s, 0.06); // whole: 30000 steps at most
    keep_part(shorter, 0.05, 600);
    EXPECT_EQ(keep_busiest(bench(), shorter), "");
}

TEST(Inputs, wheels_that_swing_at_4_Hz_are_integrated_in_steps_of_10_ms) {
    for (const auto &[hertz, step_s] : {std::pair{1.0, 0.02}, {4.0, 0.01}}) {
        log::Log log = motor(0);
        const double omega = 2 * std::numbers::pi * hertz;
        for (std::size_t i = 0; i < log.signals[0].value.size(); ++i)
            log.signals[0].value[i] = std::floor(
                counts_per_rad * (6 * tick_s * static_cast<double>(i) - 3 / omega * std::cos(omega * tick_s * static_cast<double>(i))));
        EXPECT_DOUBLE_EQ(make_dataset(bench(), log).step_s, step_s) << hertz; // (omega h)^2 / 3 is 0.5 % and 8 %
    }
}

// I = (e - Vd sgn I)/Ra has a solution with a current only beyond e = Vd: nothing flows below, whatever the shaft does.
TEST(Inputs, a_bridge_with_dead_time_passes_what_is_left_of_the_voltage_and_nothing_below_it) {
    const Dataset data = make_dataset(bench(), motor(0));
    Physics physics = make_physics(bench());
    for (const double dead_V : {0.0, 0.5, 1.3, 1.6}) {
        physics.wheel[0].dead_voltage_V = dead_V;
        const Eigen::VectorXd predicted = Forward(data).predict(physics);
        Eigen::Index row = 0;
        for (const Balance &b : data.balance)
            for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) {
                const double t = 0.5 * (b.t0_s[r] + b.t1_s[r]);
                if (b.kind != BalanceKind::current_voltage || t < 0.5 || t > 2.8) continue; // duty 0.25, 2 rad/s
                const double e = 0.25 * (8 - 0.1 * t) - 0.265 * 2;
                EXPECT_NEAR(predicted[row], std::max(0.0, e - dead_V) / 3.24, 0.003)
                    << dead_V; // a count's rounding in the speed: 3e-3 rad/s; the supply between two samples
            }
    }
}

TEST(Inputs, a_planar_rover_with_a_gyro_has_its_yaw_rate_and_its_sideways_way_and_a_path_with_a_sign) {
    Model model = read_model("models/rover_concrete.toml");
    model.motion = BodyMotion::planar;
    sim::Scenario scenario = sim::parse_scenario(
        "title = \"back\"\nduration_s = 8\n[ground]\nsoil = \"concrete\"\n[[drive]]\nfor_s = 4\nmode = \"platform_speed\"\n"
        "speed_m_s = 0.4\nyaw_rate_rad_s = 0.5\n[[drive]]\nfor_s = 4\nmode = \"platform_speed\"\nspeed_m_s = -0.4\n",
        "back");
    const Dataset data = make_dataset(model, simulate(scenario).log);
    EXPECT_NO_THROW(balance(data, BalanceKind::yaw_rate));
    EXPECT_NO_THROW(balance(data, BalanceKind::camera_y));
    Forward forward(data);
    const Physics physics = make_physics(model);
    const Eigen::VectorXd predicted = forward.predict(physics);
    forward.set_base(physics);
    const std::vector<double> &path = forward.motion().path_m;
    EXPECT_LT(path.back(), 0.6 * *std::max_element(path.begin(), path.end())); // there and back
    Eigen::Index row = 0;
    for (const Balance &b : data.balance) {
        double e = 0;
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) e += std::pow((b.measured[r] - predicted[row]) / b.noise, 2);
        if (b.kind != BalanceKind::yaw_rate) continue;
        EXPECT_LT(std::sqrt(e / static_cast<double>(b.measured.size())), 20); // of noise, before any fit; at rest it would be 110
    }
}

TEST(Inputs, a_radar_that_leads_reads_the_mean_of_its_window_and_a_share_of_the_range) {
    const Model model = read_model("models/rover_concrete.toml");
    const Dataset data = make_dataset(model, simulate(sim::read_scenario("scenarios/cruise.toml")).log);
    Forward forward(data);
    Physics physics = make_physics(model);
    physics.body.radar_lead = 0; // windows of cruise and of the start alike
    forward.set_base(physics);
    const Eigen::VectorXd mean = forward.base();
    physics.body.radar_lead = 0.2;
    const Eigen::VectorXd leads = forward.predict(physics);
    const std::vector<double> &v = forward.motion().v_m_s;
    Eigen::Index row = 0;
    double widest = 0;
    for (const Balance &b : data.balance)
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) {
            if (b.kind != BalanceKind::radar) {
                ASSERT_NEAR(leads[row], mean[row], 1e-7) << b.name; // two searches for one motion
                continue;
            }
            const auto place = [&](double t) { return v.begin() + static_cast<std::ptrdiff_t>((t - data.start_s) / data.step_s); };
            const auto [low, high] = std::minmax_element(place(b.t0_s[r]), place(b.t1_s[r]) + 1);
            EXPECT_NEAR(leads[row] - mean[row], 0.2 * (*high - *low), 1e-6);
            widest = std::max(widest, *high - *low);
        }
    EXPECT_GT(widest, 0.05); // the start is in it
}

TEST(Inputs, a_parameter_that_the_smoothing_could_fake_has_the_wider_error) {
    const Model model = read_model("models/rover_concrete.toml");
    Dataset data = make_dataset(model, simulate(sim::read_scenario("scenarios/cruise.toml")).log);
    const auto inertia_error = [&] {
        Problem problem(data, make_physics(model), free_parameters(model, make_physics(model)));
        problem.linearise();
        const std::vector<ParameterError> errors = Screen(problem).parameter_errors();
        for (std::size_t i = 0; i < errors.size(); ++i)
            if (problem.parameters[i].key == "inertia_kg_m2") return errors[i].standard;
        throw std::logic_error("the inertia is missing");
    };
    const double with = inertia_error();
    for (Balance &b : data.balance) b.smoothing_bias.clear();
    EXPECT_GT(with, inertia_error());
}

double half_of(const Dataset &data) {
    double widest = 0;
    for (const WheelInput &in : data.wheel) widest = std::max(widest, in.half_s);
    return widest;
}

generator::GeneratorConfig rover_of(generator::Size size, generator::Soil soil) {
    generator::GeneratorConfig config;
    config.size = size, config.soil = soil, config.seed = 3, config.duration_s = 60;
    return config;
}

// 60 kg on concrete turn 1 % of a slip into more than the current's noise: its wheels are read over a wider window, and what the encoders'
// rounding leaves in the torques falls. On sand the same rounding is nothing: there the narrow window stays.
TEST(Inputs, wheels_are_smoothed_as_widely_as_the_machine_asks_for) {
    const generator::GeneratorConfig heavy = rover_of(generator::Size::large, generator::Soil::concrete),
                                     light = rover_of(generator::Size::small, generator::Soil::sand);
    const Model stiff = parse_model(generator::data_sheet(heavy), "heavy"), soft = parse_model(generator::data_sheet(light), "light");
    const log::Log on_concrete = generator::generate(heavy), on_sand = generator::generate(light);
    const Dataset narrow = measured_data(stiff, on_concrete), wide = make_dataset(stiff, on_concrete);
    EXPECT_GT(half_of(wide), 1.2 * half_of(narrow));
    const auto scatter = [&](const Dataset &data) { // of half of the torques' rows at least so much, in squares of their noise
        const Eigen::VectorXd squares = rounding_squares(data, make_physics(stiff), 4);
        std::vector<double> all;
        Eigen::Index row = 0;
        for (const Balance &b : data.balance)
            for (std::size_t r = 0; r < b.measured.size(); ++r, ++row)
                if (b.kind == BalanceKind::current_torque) all.push_back(squares[row] / (b.noise * b.noise));
        std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
        return all[all.size() / 2];
    };
    EXPECT_LT(scatter(wide), 0.8 * scatter(narrow));
    Dataset narrowed = wide; // where it starts it has the scatter of the width that it is read with
    for (WheelInput &w : narrowed.wheel) w.width_s.assign(narrowed.count, narrow.wheel[0].half_s);
    EXPECT_NEAR(scatter(narrowed), scatter(narrow), 0.3 * scatter(narrow));
    EXPECT_NEAR(half_of(make_dataset(soft, on_sand)), half_of(measured_data(soft, on_sand)), 1e-9);
}

// Cubics and parabolas differ by noise that goes with the width to -1.5: at half the width 2.8 times as much is none yet, and 1.3 times the
// limit at the whole width is a jump.
TEST(Inputs, a_wheel_that_is_read_more_narrowly_jumps_by_more) {
    const Model model = bench();
    const log::Log none;
    InputBuilder builder{model, none, 0.01, 1, {}};
    builder.data.count = 1000, builder.data.step_s = 0.02, builder.data.smoothing_half_s = 0.08;
    const double calm = 0.01, limit = 5 * calm / 0.2533; // five deviations, from the calmest fifth
    WheelInput input, sharp;
    input.half_s = 0.4;
    input.speed_rad_s.assign(1000, 2), sharp.speed_rad_s.assign(1000, 3);
    input.accel_rad_s2.assign(1000, 0), sharp.accel_rad_s2.assign(1000, calm);
    for (const std::size_t k : {400U, 600U}) sharp.accel_rad_s2[k] = 1.3 * limit;
    sharp.accel_rad_s2[800] = 3 * limit;
    input.width_s.assign(1000, input.half_s);
    input.width_s[600] = input.width_s[800] = 0.5 * input.half_s;
    std::vector<char> jumps(1000, 0);
    builder.add_jumps(input, sharp, 0, jumps), builder.follow_jumps(input, sharp, jumps);
    EXPECT_EQ(input.speed_rad_s[400], 3);
    EXPECT_EQ(input.speed_rad_s[600], 2);
    EXPECT_EQ(input.speed_rad_s[800], 3);
}

// On stiff ground a difference of two wheels' smoothing is a pull between them.
TEST(Inputs, wheels_of_a_side_are_smoothed_alike_and_sides_by_themselves) {
    generator::GeneratorConfig config = generator::draw_fleet_case(1020007, "clean").config; // small, concrete
    config.duration_s = 60;
    const Model model = parse_model(generator::data_sheet(config), "sheet");
    const Dataset data = make_dataset(model, generator::generate(config));
    ASSERT_FALSE(data.wheel[0].width_s.empty());
    EXPECT_NE(std::count(data.wheel[0].width_s.begin(), data.wheel[0].width_s.end(), data.wheel[0].width_s.front()),
              static_cast<std::ptrdiff_t>(data.count));
    EXPECT_EQ(data.wheel[0].width_s, data.wheel[2].width_s);
    EXPECT_EQ(data.wheel[1].width_s, data.wheel[3].width_s);
    EXPECT_NE(data.wheel[0].width_s, data.wheel[1].width_s);
    const auto jumps = [&](std::size_t i) { // where cubics serve
        std::vector<bool> at;
        for (std::size_t k = 0; k < data.count; ++k) at.push_back(data.wheel[i].speed_rad_s[k] != data.wheel[i].plain_speed_rad_s[k]);
        return at;
    };
    EXPECT_GT(std::ranges::count(jumps(0), true), 10);
    EXPECT_EQ(jumps(0), jumps(2));
    EXPECT_EQ(jumps(1), jumps(3));
    EXPECT_NE(jumps(0), jumps(1));
}

// A log of angles is rounded to the encoder's counts, whatever decimals it is written with; without them the count was the last decimal's.
TEST(Inputs, a_count_is_found_in_angles_that_are_written_with_a_few_decimals) {
    generator::GeneratorConfig config = rover_of(generator::Size::small, generator::Soil::concrete);
    config.chain.angle_only = true;
    config.drive = "slow"; // half of its samples run evenly: they say nothing of scatter
    const Model model = parse_model(generator::data_sheet(config), "sheet");
    log::Log log = generator::generate(config);
    const double scatter = make_dataset(model, log).wheel[0].scatter_rad, count = 2 * std::numbers::pi / 6000;
    EXPECT_NEAR(scatter, count / std::sqrt(12.0), 0.01 * count);
    for (log::Signal &s : log.signals)
        if (s.name.ends_with(".angle_rad"))
            for (double &a : s.value) a = 1e-8 * std::round(1e8 * a);
    EXPECT_NEAR(make_dataset(model, log).wheel[0].scatter_rad, scatter, 0.01 * scatter);
}

// A centimetre a second, 0.175 rad/s of this wheel, within 1.25 and 3 % of the top speed of the log.
TEST(Inputs, a_wheel_stands_below_a_centimetre_a_second_and_within_the_logs_own_speeds) {
    const Model model = bench();
    const auto stands = [&](double factor) {
        log::Log log = motor(0);
        for (log::Signal &s : log.signals)
            if (s.name == "wheel0.encoder_count")
                for (double &v : s.value) v = std::floor(factor * v);
        return make_dataset(model, log).standstill_rad_s; // top speed: 2 rad/s times the factor
    };
    EXPECT_NEAR(stands(4), 0.01 / 0.057, 1e-3);
    EXPECT_NEAR(stands(1), 0.03 * 2, 1e-3);
    EXPECT_NEAR(stands(10), 0.0125 * 20, 2e-3);
}

// A driven wheel whose speed the log has not is held by its motor: locked it would drag. It turns as the other of its side, and what it
// would read is left out: the way of the rover is predicted as well as with its speed (wheels 0 and 2 are the left ones).
TEST(Inputs, a_driven_wheel_without_a_speed_turns_as_the_others_of_its_side) {
    const Model model = read_model("models/rover_sand.toml");
    sim::Scenario scenario = sim::parse_scenario(
        "title = \"curve\"\nduration_s = 8\n[ground]\nsoil = \"sand\"\n[[drive]]\nfor_s = 8\nmode = \"platform_speed\"\n"
        "speed_m_s = 0.3\nyaw_rate_rad_s = 0.3\n",
        "curve");
    const log::Log whole = simulate(scenario).log;
    log::Log part = whole;
    std::erase_if(part.signals, [](const log::Signal &s) {
        return s.name.starts_with("wheel2.") &&
               (s.name.ends_with("encoder_count") || s.name.ends_with("_rad") || s.name.ends_with("_rad_s"));
    });
    const auto radar_error = [&](const Dataset &data) {
        const Eigen::VectorXd y = Forward(data).predict(make_physics(model));
        double sum = 0;
        Eigen::Index row = 0;
        for (const Balance &b : data.balance)
            for (std::size_t r = 0; r < b.measured.size(); ++r, ++row)
                if (b.kind == BalanceKind::radar) sum += std::pow((y[row] - b.measured[r]) / b.noise, 2);
        return std::sqrt(sum / static_cast<double>(balance(data, BalanceKind::radar).measured.size()));
    };
    const Dataset with = make_dataset(model, whole), without = make_dataset(model, part);
    ASSERT_EQ(with.count, without.count);
    EXPECT_EQ(without.wheel[2].speed_rad_s, without.wheel[0].speed_rad_s);
    EXPECT_EQ(without.wheel[2].accel_rad_s2, without.wheel[0].accel_rad_s2);
    EXPECT_EQ(without.wheel[2].travel_rad.size(), without.count);
    EXPECT_EQ(std::count(without.messages.begin(), without.messages.end(),
                         "wheel 2 has no speed in the log: taken to turn as the others of its side, its balances are left out"),
              1);
    for (const Balance &b : without.balance) EXPECT_NE(b.wheel, 2) << b.name;
    EXPECT_LT(radar_error(without), 1.1 * radar_error(with) + 0.1); // the two of a side are ordered to turn alike
    std::erase_if(part.signals, [](const log::Signal &s) { return s.name.starts_with("wheel0."); });
    const Dataset none = make_dataset(model, part); // of its side none: as all that are known
    for (std::size_t k = 0; k < none.count; k += 50)
        EXPECT_NEAR(none.wheel[2].speed_rad_s[k], 0.5 * (none.wheel[1].speed_rad_s[k] + none.wheel[3].speed_rad_s[k]), 1e-12);
}

TEST(Inputs, wheels_without_grip_are_told_where_a_body_is_moved_by_them) {
    sim::Scenario scenario = sim::parse_scenario("title = \"on\"\nduration_s = 3\n[ground]\nsoil = \"sand\"\n[[drive]]\nfor_s = 3\nmode = "
                                                 "\"platform_speed\"\nspeed_m_s = 0.3\n",
                                                 "on");
    const log::Log log = simulate(scenario).log;
    Model model = read_model("models/rover_sand.toml");
    const auto told = [&] {
        const std::vector<std::string> messages = make_dataset(model, log).messages;
        return std::count_if(messages.begin(), messages.end(), [](const std::string &m) { return m.ends_with(": it has no grip"); });
    };
    EXPECT_EQ(told(), 0);
    for (std::size_t i = 0; i < 2; ++i) model.wheel[i].soil.at("mu").value = model.wheel[i].soil.at("adhesion_N").value = 0;
    EXPECT_EQ(told(), 2);
    model.motion = BodyMotion::none;
    EXPECT_EQ(told(), 0);
}

} // namespace
} // namespace traction::lab
