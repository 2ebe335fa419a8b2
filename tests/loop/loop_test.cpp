// The closed loop: firmware on the simulated rover. Each mode does its job on each soil, faults run to the end, runs repeat.
//
// Bounds are two-sided where a value that is too good would be as wrong as one too bad.
#include "hal/replay/replay_hal.h"
#include "host_tools/loop/loop.h"
#include "host_tools/simulate/batch.h"
#include "host_tools/simulate/simulate.h"

#include "firmware/core/rover_config.h"

#include <cstdint>
#include <cstdio>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <numeric>
#include <string>
#include <vector>

using namespace traction;

namespace {

SimulationResult run(const sim::Scenario &scenario, std::uint64_t seed = 1) {
    SimulateOptions options;
    options.seed = seed;
    options.truth = true;
    return simulate(scenario, options);
}

SimulationResult run_file(const std::string &name, std::uint64_t seed = 1) {
    return run(sim::read_scenario("scenarios/" + name + ".toml"), seed);
}

sim::Scenario on(const std::string &soil, const std::string &rest, double duration_s) {
    return sim::parse_scenario("duration_s = " + std::to_string(duration_s) + "\n[ground]\nsoil = \"" + soil + "\"\n" + rest,
                               soil + ".toml");
}

double mean_between(
    const log::Log &log, const std::string &name, double from_s, double to_s,
    const std::function<double(double)> &of = [](double x) { return x; }) {
    const log::Signal *signal = log.find(name);
    if (signal == nullptr) return std::nan("");
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < signal->t_s.size(); i++)
        if (signal->t_s[i] >= from_s && signal->t_s[i] < to_s) {
            sum += of(signal->value[i]);
            count++;
        }
    return sum / count;
}

double rms_between(const log::Log &log, const std::string &name, double around, double from_s, double to_s) {
    return std::sqrt(mean_between(log, name, from_s, to_s, [around](double x) { return (x - around) * (x - around); }));
}

// When a signal first rises through a level after from_s.
double crossing_s(const log::Log &log, const std::string &name, double level, double from_s) {
    const log::Signal *signal = log.find(name);
    for (std::size_t i = 1; i < signal->t_s.size(); i++)
        if (signal->t_s[i] > from_s && signal->value[i - 1] < level && signal->value[i] >= level) return signal->t_s[i];
    return std::nan("");
}

std::string bytes(const log::Log &log, const std::string &name) {
    const std::string path = testing::TempDir() + name;
    log::write_csv(log, path);
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class EachSoil : public testing::TestWithParam<const char *> {};

} // namespace

TEST_P(EachSoil, platform_speed_is_held_and_reversed) {
    const auto result = run(on(GetParam(), R"(
[[drive]]
for_s = 8.0
mode = "platform_speed"
speed_m_s = 0.4
[[drive]]
for_s = 8.0
mode = "platform_speed"
speed_m_s = -0.4
)",
                               16));
    // the loop rests on the fused speed: 4.5 % relative error of a window at 0.4 m/s (docs/evidence.md section 3), averaged over 5 s and
    // 10 windows to 1.5 %; the lower bound on the deviation: a loop that rides on a noisy estimate cannot be perfect
    EXPECT_NEAR(mean_between(result.truth, "truth.speed_m_s", 3, 8), 0.4, 0.4 * 0.045);
    EXPECT_NEAR(mean_between(result.truth, "truth.speed_m_s", 11, 16), -0.4, 0.4 * 0.045);
    const double wobble = rms_between(result.truth, "truth.speed_m_s", 0.4, 3, 8);
    EXPECT_LT(wobble, 0.03);
    EXPECT_GT(wobble, 0.0005);
    EXPECT_EQ(result.faults, 0u);
}

TEST_P(EachSoil, a_turn_is_made_at_the_rate_asked_for_within_the_slip) {
    const auto result = run(on(GetParam(), R"(
[[drive]]
for_s = 8.0
mode = "platform_speed"
speed_m_s = 0.3
yaw_rate_rad_s = 0.8
)",
                               8));
    // open-loop by wheel speeds: skid steering loses part of the rate to scrub and slip, and never gains any
    const double rate = mean_between(result.log, "imu.gyro_z_rad_s", 3, 8);
    EXPECT_LT(rate, 0.85);
    EXPECT_GT(rate, 0.3);
}

TEST_P(EachSoil, wheel_speed_is_held_to_an_encoder_step) {
    const auto result = run(on(GetParam(), R"(
[[drive]]
for_s = 5.0
mode = "wheel_speed"
wheel_speed_rad_s = [6.0, 6.0, 6.0, 2.0]
)",
                               5));
    for (int wheel = 0; wheel < 4; wheel++) {
        const std::string name = "wheel" + std::to_string(wheel) + ".speed_rad_s";
        const double asked = wheel == 3 ? 2 : 6;
        EXPECT_NEAR(mean_between(result.log, name, 2, 5), asked, 0.03) << name; // integral action: 0.105/sqrt(12) rounding and soil noise
        const double ripple = rms_between(result.log, name, asked, 2, 5);
        EXPECT_LT(ripple, 0.2) << name;  // twice the step of 0.105 rad/s that a 10 ms count resolves
        EXPECT_GT(ripple, 0.01) << name; // and never without its rounding
    }
}

TEST_P(EachSoil, slip_is_held_at_its_set_point) {
    const auto result = run_file(std::string("fig17_slip_servo_") + GetParam(), 3);
    // estimated slip s = 1 - v/(R w): dv/v = 5 % (docs/evidence.md section 3, at 0.3 m/s) is (1 - s) * 5 % = 0.03; mean of 8 s and 16
    // windows
    EXPECT_NEAR(mean_between(result.log, "wheel1.slip", 6, 15), 0.4, 0.02);
    EXPECT_NEAR(mean_between(result.truth, "truth.wheel1.slip", 6, 15), 0.4, 0.03);
    const double wobble = rms_between(result.truth, "truth.wheel1.slip", 0.4, 6, 15);
    EXPECT_LT(wobble, 0.06);
    EXPECT_GT(wobble, 0.001);
    EXPECT_NEAR(mean_between(result.truth, "truth.speed_m_s", 6, 15), 0.3, 0.3 * 0.06); // the other three hold the speed
}

TEST_P(EachSoil, the_sweep_takes_slip_from_minus_one_through_zero_to_traction) {
    const auto result = run_file(std::string("sweep_") + GetParam(), 2);
    constexpr double start_s = 5; // of the sweep in the scenario
    const log::Log &truth = result.truth;
    // (15): blocked at first while the rover still rolls
    // on soft ground the rear pair pulls no harder than the blocked front pair brakes: v falls towards 0 with slip still building up
    const auto &front = truth.find("truth.wheel2.slip")->value;
    EXPECT_LT(*std::min_element(front.begin(), front.end()), std::string(GetParam()) == "concrete" ? -0.99 : -0.8);
    // zero at 10 s where v = 0.3 m/s; the rear pair lets v differ by up to 15 % while it recovers (measured figure: 11 to 11.7 s)
    const double zero_s = crossing_s(truth, "truth.wheel2.slip", 0, start_s + 3) - start_s;
    EXPECT_GT(zero_s, 9.5);
    EXPECT_LT(zero_s, 12.5);
    // (1) at the end: 1 - 0.3/(0.057 * 10.5) = 0.5 where the duty lasts, about 0.4 where the motors saturate (docs/sources.md section 6)
    const double last = mean_between(truth, "truth.wheel2.slip", start_s + 18.5, start_s + 20);
    EXPECT_GT(last, 0.35);
    EXPECT_LT(last, 0.55);
    EXPECT_LT(mean_between(truth, "truth.wheel0.slip", start_s + 18.5, start_s + 20), -0.1); // rear slip mirrors it
}

INSTANTIATE_TEST_SUITE_P(Loop, EachSoil, testing::Values("sand", "gravel", "concrete"));

TEST(Loop, stop_and_open_loop_do_what_they_say) {
    const auto result = run(on("sand", R"(
[[drive]]
for_s = 2.0
mode = "stop"
[[drive]]
for_s = 2.0
mode = "open_loop"
duty = [0.5, 0.5, 0.5, 0.25]
[[drive]]
for_s = 2.0
mode = "stop"
)",
                               6));
    EXPECT_EQ(mean_between(result.truth, "truth.wheel0.speed_rad_s", 0, 1.99), 0);
    EXPECT_NEAR(mean_between(result.log, "wheel0.duty", 2.5, 3.9), 0.5, 1e-4); // Q15
    EXPECT_NEAR(mean_between(result.log, "wheel3.duty", 2.5, 3.9), 0.25, 1e-4);
    EXPECT_EQ(mean_between(result.log, "wheel0.duty", 4.1, 6), 0);
    EXPECT_LT(std::fabs(mean_between(result.truth, "truth.speed_m_s", 5.5, 6)), 0.01); // friction stops it
}

TEST(Loop, the_rover_drives_on_full_terramechanics_and_sinks) {
    for (const char *contact : {"bekker", "arc"}) {
        const auto result =
            run(sim::parse_scenario(std::string("duration_s = 8\n[ground]\nsoil = \"dry_sand_literature\"\ncontact = \"") + contact +
                                        "\"\n[[drive]]\nfor_s = 8.0\nmode = \"platform_speed\"\nspeed_m_s = 0.3\n",
                                    "x.toml"));
        // resistance takes over half of the grip here, so the rover labours at large slip and the loop, whose gain dv/dw falls with
        // (1 - s), holds its speed within a fifth (measured 0.27 to 0.29 m/s)
        EXPECT_NEAR(mean_between(result.truth, "truth.speed_m_s", 4, 8), 0.3, 0.06) << contact;
        const double slip = mean_between(result.truth, "truth.wheel2.slip", 4, 8);
        EXPECT_GT(slip, 0.1) << contact;
        EXPECT_LT(slip, 0.8) << contact;
        const double sunk_m = mean_between(result.truth, "truth.wheel2.sinkage_m", 4, 8);
        EXPECT_GT(sunk_m, 0.001) << contact; // soft sand under 7 N, and less than a wheel's radius
        EXPECT_LT(sunk_m, 0.03) << contact;
    }
}

TEST(Loop, the_fused_speed_tracks_the_truth) {
    double square = 0, worst = 0, error_sum = 0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 3; seed++) {
        const auto result = run_file("identification", seed);
        const log::Signal &estimate = *result.log.find("estimate.speed_m_s"), &truth = *result.truth.find("truth.speed_m_s");
        ASSERT_EQ(estimate.value.size(), truth.value.size());
        for (std::size_t i = 200; i < estimate.value.size(); i++) {
            const double error = estimate.value[i] - truth.value[i];
            square += error * error;
            error_sum += error;
            worst = std::max(worst, std::fabs(error));
            count++;
        }
    }
    // goal (docs/evidence.md section 3) over all profiles: 1.8 cm/s; the identification drive is harder (reverse, hard braking, slip of one
    // wheel): twice that. Below 0.5 cm/s would beat the posterior bound, hence be wrong.
    EXPECT_LT(std::sqrt(square / count), 0.036);
    EXPECT_GT(std::sqrt(square / count), 0.005);
    EXPECT_LT(std::fabs(error_sum / count), 0.01);
    std::printf("fused speed over %d ticks: rmse %.4f m/s, mean %.4f, worst %.3f\n", count, std::sqrt(square / count), error_sum / count,
                worst);
}

TEST(Loop, speed_is_roughly_held_and_heading_drifts_with_a_blocked_wheel) {
    const auto result = run_file("fig16_blocked_wheels");
    for (const auto &[from_s, to_s] : {std::pair{2.0, 5.0}, {6.0, 9.0}, {11.0, 15.0}})
        EXPECT_NEAR(mean_between(result.truth, "truth.speed_m_s", from_s, to_s), 0.2, 0.02) << from_s; // +-10 %, fig. 10
    const log::Signal &yaw = *result.truth.find("truth.yaw_rad");
    const auto yaw_at = [&yaw](double t_s) { return yaw.value[static_cast<std::size_t>(t_s * 100) - 1]; };
    EXPECT_LT(std::fabs(yaw_at(5)), 0.1);
    EXPECT_GT(yaw_at(9) - yaw_at(5), 0.05);    // left rear held: turns left
    EXPECT_LT(yaw_at(15) - yaw_at(10), -0.05); // right rear held: turns right
    EXPECT_NE(result.faults & FAULT_STALL, 0u);
}

TEST(Loop, the_same_scenario_and_seed_give_the_same_bytes_and_another_seed_does_not) {
    const auto scenario = sim::read_scenario("scenarios/sweep_gravel.toml");
    const auto a = run(scenario, 5), b = run(scenario, 5), c = run(scenario, 6);
    const std::string first = bytes(a.log, "first.csv");
    EXPECT_EQ(first, bytes(b.log, "second.csv"));
    EXPECT_NE(first, bytes(c.log, "third.csv"));
    EXPECT_EQ(a.trace_hash, b.trace_hash);
    EXPECT_NE(a.trace_hash, c.trace_hash);
}

TEST(Loop, a_batch_gives_each_seed_what_it_gives_alone) {
    const auto scenario = sim::read_scenario("scenarios/fig16_blocked_wheels.toml");
    std::vector<std::uint64_t> hash(4);
    simulate_batch(
        scenario, [](std::uint64_t) { return SimulateOptions{}; }, 1, 4, 2,
        [&](std::uint64_t seed, SimulationResult &&result) { hash[seed - 1] = result.trace_hash; });
    for (std::uint64_t seed = 1; seed <= 4; seed++) EXPECT_EQ(hash[seed - 1], run(scenario, seed).trace_hash);
}

namespace {

// Frames and commands read out of a log column by column, by no code of the tools; what the loop makes of them, compared with the log.
class FromLog : public Link {
  public:
    explicit FromLog(const log::Log &log) : log_(log) {
        replay_.source = this;
        replay_.next = [](void *source, sensor_frame_t *frame, command_t *command) {
            auto &self = *static_cast<FromLog *>(source);
            const log::Signal &clock = *self.log_.find("frame.present");
            if (self.tick_ == clock.t_s.size()) return HAL_END;
            self.read(clock.t_s[self.tick_], static_cast<std::uint32_t>(self.tick_), *frame, *command);
            self.tick_++;
            return HAL_OK;
        };
    }
    hal_t hal() { return replay_hal(&replay_); }
    void command(const sensor_frame_t &, command_t &command) override { command = replay_.command; }
    void log(const sensor_frame_t &, const command_t &, const trace_t &trace) override {
        const double t_s = log_.find("frame.present")->t_s[tick_ - 1];
        // the log rounds to 1e-6; float32 of values below 16 adds 1e-6
        ASSERT_NEAR(static_cast<double>(trace.speed_m_s), at("estimate.speed_m_s", t_s), 1.1e-6) << t_s;
        ASSERT_NEAR(static_cast<double>(trace.wheel[3].duty), at("wheel3.duty", t_s), 1.1e-6) << t_s;
        ASSERT_EQ(trace.faults, static_cast<std::uint32_t>(at("control.faults", t_s)));
    }
    std::size_t samples() const { return sample_; }

  private:
    // the value of a signal at a time, or `absent` when it has none then
    double at(const std::string &name, double t_s, double absent = 0) {
        const log::Signal *signal = log_.find(name);
        if (signal == nullptr) return absent;
        std::size_t &i = place_[name];
        while (i < signal->t_s.size() && signal->t_s[i] < t_s) i++;
        return i < signal->t_s.size() && signal->t_s[i] == t_s ? signal->value[i] : absent;
    }
    void read(double t_s, std::uint32_t tick, sensor_frame_t &frame, command_t &command) {
        frame = {};
        command = {};
        frame.tick = tick;
        frame.present = static_cast<std::uint32_t>(at("frame.present", t_s));
        frame.battery_count = static_cast<std::uint16_t>(at("battery.voltage_count", t_s));
        frame.accel_x_count = static_cast<std::int16_t>(at("imu.accel_x_count", t_s));
        frame.gyro_z_count = static_cast<std::int16_t>(at("imu.gyro_z_count", t_s));
        frame.elapsed_ticks = 1;
        frame.time_us = static_cast<std::uint32_t>(at("frame.time_us", t_s));
        frame.accel_y_count = static_cast<std::int16_t>(at("imu.accel_y_count", t_s));
        frame.accel_z_count = static_cast<std::int16_t>(at("imu.accel_z_count", t_s));
        frame.gyro_x_count = static_cast<std::int16_t>(at("imu.gyro_x_count", t_s));
        frame.gyro_y_count = static_cast<std::int16_t>(at("imu.gyro_y_count", t_s));
        frame.radar_sequence = static_cast<std::uint32_t>(at("frame.radar_sequence", t_s));
        frame.radar_samples = static_cast<std::uint8_t>(at("frame.radar_samples", t_s));
        for (int i = 0; i < frame.radar_samples; i++)
            frame.radar_count[i] = static_cast<std::uint16_t>(log_.find("radar.adc_count")->value[sample_++]);
        command.mode = static_cast<control_mode_t>(at("command.mode", t_s));
        command.platform_speed_m_s = static_cast<float>(at("command.speed_m_s", t_s));
        command.yaw_rate_rad_s = static_cast<float>(at("command.yaw_rate_rad_s", t_s));
        command.slip_ref = static_cast<float>(at("command.slip", t_s));
        command.slip_wheels = static_cast<std::uint8_t>(at("command.slip_wheels", t_s));
        for (int i = 0; i < WHEEL_COUNT; i++) {
            const std::string wheel = "wheel" + std::to_string(i) + '.';
            frame.encoder_count[i] = static_cast<std::int32_t>(at(wheel + "encoder_count", t_s));
            frame.current_count[i] = static_cast<std::uint16_t>(at(wheel + "current_count", t_s));
            command.wheel_speed_rad_s[i] = static_cast<float>(at(wheel + "command_speed_rad_s", t_s));
            command.duty[i] = static_cast<float>(at(wheel + "command_duty", t_s));
        }
    }
    const log::Log &log_;
    replay_hal_t replay_{};
    std::size_t tick_ = 0, sample_ = 0;
    std::map<std::string, std::size_t> place_;
};

} // namespace

// The loop fed again with what the log holds must make the trace that the log holds.
TEST(Loop, the_log_holds_all_that_a_replay_needs) {
    auto scenario = sim::read_scenario("scenarios/demo_sand.toml");
    scenario.sensor_faults = {{.sensor = sim::FaultySensor::radar, .kind = sim::FaultKind::dropped, .from_s = 5, .to_s = 5.05},
                              {.sensor = sim::FaultySensor::gyro, .kind = sim::FaultKind::dropped, .from_s = 7, .to_s = 7.04}};
    const auto result = run(scenario);
    const log::Log &log = result.log;
    FromLog again(log);
    EXPECT_EQ(run_loop(again.hal(), rover_config_default(), again).ticks, 6100u);
    EXPECT_EQ(again.samples(), log.find("radar.adc_count")->value.size());
}

TEST(Loop, every_scripted_fault_runs_to_the_end) {
    for (const char *sensor : {"encoder", "current", "battery", "accel", "gyro", "radar", "camera"})
        for (const char *how : {"stuck", "noisy", "dropped", "delayed", "timeout"}) {
            if (std::string(sensor) == "camera" && std::string(how) == "timeout") continue; // no device of the rover: refused
            const std::string text = std::string("[[fault]]\nwhat = \"sensor\"\nsensor = \"") + sensor + "\"\nhow = \"" + how +
                                     "\"\nfrom_s = 1.0\nto_s = 2.0\n" +
                                     (std::string(how) == "noisy"     ? "noise = 0.5\n"
                                      : std::string(how) == "delayed" ? "delay_s = 0.1\n"
                                                                      : "");
            const auto result = run(on("sand", "[[drive]]\nfor_s = 4.0\nmode = \"platform_speed\"\nspeed_m_s = 0.3\n" + text, 4));
            EXPECT_EQ(result.ticks, 400u) << sensor << ' ' << how;
        }
    const auto stopped = run(
        on("sand",
           "[[drive]]\nfor_s = 4.0\nmode = \"platform_speed\"\nspeed_m_s = 0.3\n[[fault]]\nwhat = \"emergency_stop\"\nfrom_s = 2.0\n", 4));
    EXPECT_NE(stopped.faults & FAULT_EMERGENCY_STOP, 0u);
    EXPECT_LT(std::fabs(mean_between(stopped.truth, "truth.speed_m_s", 3.5, 4)), 0.01);
    const auto lost = run(
        on("sand", "[[drive]]\nfor_s = 4.0\nmode = \"platform_speed\"\nspeed_m_s = 0.3\n[[fault]]\nwhat = \"command_lost\"\nfrom_s = 2.0\n",
           4));
    EXPECT_NE(lost.faults & FAULT_COMMAND_TIMEOUT, 0u);
    EXPECT_LT(std::fabs(mean_between(lost.truth, "truth.speed_m_s", 3.5, 4)), 0.01);
}

TEST(Loop, a_log_never_tells_what_is_hidden) {
    const auto scenario = sim::read_scenario("scenarios/demo_sand.toml");
    SimulateOptions options;
    options.hide = sim::HiddenDraw{.seed = 7, .count = 1, .among = {}};
    const auto hidden = simulate(scenario, options), open = simulate(scenario);
    ASSERT_EQ(hidden.hidden.size(), 1u);
    EXPECT_EQ(hidden.log.header, open.log.header);
    ASSERT_EQ(hidden.log.signals.size(), open.log.signals.size());
    for (std::size_t i = 0; i < open.log.signals.size(); i++) EXPECT_EQ(hidden.log.signals[i].name, open.log.signals[i].name);
    EXPECT_NE(hidden.trace_hash, open.trace_hash);
    for (const log::Signal &signal : hidden.log.signals) EXPECT_EQ(signal.name.find("truth"), std::string::npos);
}
