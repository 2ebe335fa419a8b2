// Each sensor errs as it says, no more and no less, and only by its seed.
#include "sim/sensors/sensors.h"

#include <cstdint>
#include <gtest/gtest.h>
#include <stdexcept>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace traction::sim;

namespace {

// A rover that glides at constant speed, told every so many milliseconds.
std::vector<Measurements> glide(const SensorConfig &config, std::uint64_t seed, double speed_m_s, double seconds, int step_ms = 1) {
    Truth truth;
    truth.battery_voltage_V = 7;
    truth.v_body_m_s[0] = speed_m_s;
    Sensors sensors(config, seed, truth);
    std::vector<Measurements> out;
    for (int ms = step_ms; ms <= static_cast<int>(seconds * 1000); ms += step_ms) {
        truth.t_s = ms * 1e-3;
        truth.position_m[0] = truth.path_m = speed_m_s * truth.t_s;
        truth.specific_force_m_s2[0] = 0.3;
        truth.rate_body_rad_s[2] = 0.1;
        for (WheelTruth &wheel : truth.wheel) {
            wheel.current_A = 0.5;
            wheel.motor_angle_rad = speed_m_s / 0.057 * truth.t_s;
        }
        sensors.step(truth);
        if (ms % 10 == 0) sensors.measure(out.emplace_back());
    }
    return out;
}

struct Moments {
    double mean = 0, deviation = 0;
};

template <class Pick> Moments moments(const std::vector<Measurements> &all, Pick pick) {
    Moments m;
    for (const auto &one : all) m.mean += pick(one) / static_cast<double>(all.size());
    for (const auto &one : all) m.deviation += (pick(one) - m.mean) * (pick(one) - m.mean) / static_cast<double>(all.size());
    m.deviation = std::sqrt(m.deviation);
    return m;
}

ActiveEffect effect(const char *name, double value, int wheel = -1) {
    const Effect *found = find_effect(name);
    if (found == nullptr) throw std::runtime_error(name);
    ActiveEffect active{.effect = found, .wheel = wheel, .values = {}};
    for (const EffectParameter &parameter : found->parameters) active.values.push_back(parameter.strength ? value : parameter.typical);
    return active;
}

std::vector<Measurements> glide_with(const ActiveEffect &active, double speed_m_s = 0.5, double seconds = 40) {
    SensorConfig config = default_sensors();
    apply_sensor_effects({&active, 1}, config);
    return glide(config, 3, speed_m_s, seconds);
}

} // namespace

TEST(Sensors, each_has_the_noise_that_it_states) {
    const auto all = glide(default_sensors(), 7, 0, 100); // 10000 values: deviation known to 0.7 %, mean to 1 % of sigma
    const auto check = [](const Moments &m, double mean, double sigma) {
        EXPECT_NEAR(m.deviation, sigma, 3 * 0.0071 * sigma);
        EXPECT_NEAR(m.mean, mean, 3 * 0.01 * sigma);
    };
    check(moments(all, [](const auto &m) { return m.current_A[1]; }), 0.5, current_noise_A);
    check(moments(all, [](const auto &m) { return m.battery_V; }), 7, battery_noise_V);
    check(moments(all, [](const auto &m) { return m.accel_m_s2[0]; }), 0.3, accel_noise_m_s2);
    check(moments(all, [](const auto &m) { return m.gyro_rad_s[2]; }), 0.1, gyro_noise_rad_s);
}

TEST(Sensors, driving_shakes_the_accelerometer) {
    const auto all = glide(default_sensors(), 7, 0.8, 100);
    const double sigma = std::hypot(accel_noise_m_s2, accel_vibration_1_s * 0.8);
    EXPECT_NEAR(moments(all, [](const auto &m) { return m.accel_m_s2[0]; }).deviation, sigma, 3 * 0.0071 * sigma);
}

// The readings with the shaking less those without, by one seed: what is left are the two harmonic motions, averaged over a tick's ten
// steps, which takes sin(10 a)/(10 sin a) of them, a = pi f/1000.
TEST(Sensors, a_body_that_hops_and_nods_shows_both_motions_and_at_rest_none) {
    constexpr double rate_Hz = 5, heave_m = 0.002, nod_rad = 0.01, w = 2 * M_PI * rate_Hz, a = M_PI * rate_Hz / 1000;
    const double kept = std::sin(10 * a) / (10 * std::sin(a)) / std::sqrt(2);
    SensorConfig shaken = default_sensors();
    shaken.heave_m = heave_m, shaken.heave_Hz = rate_Hz;
    shaken.pitch_vibration_rad = nod_rad, shaken.pitch_vibration_Hz = rate_Hz;
    for (const auto &[speed_m_s, share] : {std::pair{0.0, 0.0}, {0.05, 0.5}, {0.1, 1.0}, {-0.4, 1.0}}) {
        auto with = glide(shaken, 7, speed_m_s, 10);
        const auto without = glide(default_sensors(), 7, speed_m_s, 10);
        for (std::size_t i = 0; i < with.size(); i++) {
            with[i].accel_m_s2[2] -= without[i].accel_m_s2[2];
            with[i].gyro_rad_s[1] -= without[i].gyro_rad_s[1];
        }
        const double lift = share * heave_m * w * w * kept, turn = share * nod_rad * w * kept;
        EXPECT_NEAR(moments(with, [](const auto &m) { return m.accel_m_s2[2]; }).deviation, lift, 1e-6) << speed_m_s;
        EXPECT_NEAR(moments(with, [](const auto &m) { return m.gyro_rad_s[1]; }).deviation, turn, 1e-6) << speed_m_s;
    }
}

TEST(Sensors, the_camera_looks_seven_times_a_second_with_a_millimetre) {
    std::vector<Pose> poses;
    for (const auto &one : glide(default_sensors(), 9, 0.5, 200)) poses.insert(poses.end(), one.camera.begin(), one.camera.end());
    ASSERT_NEAR(static_cast<double>(poses.size()), 1400, 1); // 7 Hz for 200 s, first look at t = 0
    double square = 0;
    for (std::size_t i = 0; i < poses.size(); i++) {
        EXPECT_NEAR(poses[i].t_s, static_cast<double>(i) / 7, 1e-12);
        square += std::pow(poses[i].x_m - 0.5 * poses[i].t_s, 2) / 1400;
    }
    EXPECT_NEAR(std::sqrt(square), camera_noise_m, 3 * camera_noise_m / std::sqrt(2 * 1400.0));
}

TEST(Sensors, an_effect_acts_on_its_sensor_by_its_amount) {
    const double n = std::sqrt(4000.0); // values averaged
    EXPECT_NEAR(moments(glide_with(effect("accel_bias", 0.2)), [](const auto &m) { return m.accel_m_s2[0]; }).mean, 0.5, 3 * 0.032 / n);
    EXPECT_NEAR(moments(glide_with(effect("accel_scale", 0.2)), [](const auto &m) { return m.accel_m_s2[0]; }).mean, 0.36, 3 * 0.032 / n);
    EXPECT_NEAR(moments(glide_with(effect("voltage_gain", -0.1)), [](const auto &m) { return m.battery_V; }).mean, 6.3, 3 * 0.01 / n);
    EXPECT_NEAR(moments(glide_with(effect("current_gain", 0.2, 2)), [](const auto &m) { return m.current_A[2]; }).mean, 0.6, 3 * 0.01 / n);
    EXPECT_NEAR(moments(glide_with(effect("current_gain", 0.2, 2)), [](const auto &m) { return m.current_A[1]; }).mean, 0.5, 3 * 0.01 / n);
    EXPECT_NEAR(moments(glide_with(effect("current_offset", -0.1)), [](const auto &m) { return m.current_A[0]; }).mean, 0.4, 3 * 0.01 / n);
    const auto drift = glide_with(effect("accel_drift", 0.005));
    EXPECT_NEAR(moments(drift, [](const auto &m) { return m.accel_m_s2[0]; }).mean, 0.3 + 0.005 * 20, 3 * 0.032 / n); // mean time 20 s
    // 0.5 m/s for 40 s: 20 m, 55846.9 pulses; a fifth is lost
    EXPECT_NEAR(glide_with(effect("encoder_missed", 0.2, 0)).back().encoder_count[0], 0.8 * 20 / 0.057 / encoder_rad_per_count, 1);
}

TEST(Sensors, a_late_camera_shows_where_the_rover_was_and_a_scaled_one_how_it_looks) {
    const auto mean_error = [](const ActiveEffect &active, double factor) {
        double error = 0;
        int count = 0;
        for (const auto &one : glide_with(active))
            for (const Pose &pose : one.camera)
                if (pose.t_s > 1) {
                    error += pose.x_m - factor * 0.5 * pose.t_s;
                    count++;
                }
        return error / count;
    };
    EXPECT_NEAR(mean_error(effect("camera_delay", 0.2), 1), -0.1, 3 * 0.001 / std::sqrt(270.0));
    EXPECT_NEAR(mean_error(effect("camera_scale", 0.1), 1.1), 0, 3 * 0.001 / std::sqrt(270.0));
}

TEST(Sensors, a_scaled_radar_sees_the_ground_pass_that_much_faster) {
    // the echo is a function of path alone, so 10 % more scale at 0.5 m/s is the echo of 0.55 m/s, sample for sample
    SensorConfig quiet = default_sensors();
    quiet.radar.noise_count = quiet.radar.flicker_count = 0;
    SensorConfig scaled = quiet;
    const ActiveEffect active = effect("radar_scale", 0.1);
    apply_sensor_effects({&active, 1}, scaled);
    const auto a = glide(scaled, 5, 0.5, 5), b = glide(quiet, 5, 0.55, 5);
    int different = 0;
    for (std::size_t i = 0; i < a.size(); i++) {
        ASSERT_EQ(a[i].radar_count.size(), b[i].radar_count.size());
        for (std::size_t k = 0; k < a[i].radar_count.size(); k++) different += a[i].radar_count[k] != b[i].radar_count[k] ? 1 : 0;
    }
    EXPECT_LE(different, 3); // of 2560: paths that agree to 1e-12 may still round apart
}

TEST(Sensors, a_radar_sample_is_of_its_own_instant_within_a_step) {
    // its clock is no multiple of the plant's: at constant speed the path within a step is a straight line, so longer steps change nothing
    SensorConfig quiet = default_sensors();
    quiet.radar.noise_count = quiet.radar.flicker_count = 0;
    std::vector<std::uint16_t> fine, coarse;
    for (const Measurements &one : glide(quiet, 5, 0.5, 5)) fine.insert(fine.end(), one.radar_count.begin(), one.radar_count.end());
    for (const Measurements &one : glide(quiet, 5, 0.5, 5, 10)) coarse.insert(coarse.end(), one.radar_count.begin(), one.radar_count.end());
    ASSERT_EQ(fine.size(), coarse.size());
    int different = 0;
    for (std::size_t i = 0; i < fine.size(); i++) different += fine[i] != coarse[i] ? 1 : 0;
    EXPECT_LE(different, 3); // of 2560: as above
}

TEST(Sensors, repeat_by_seed_and_differ_between_seeds) {
    const auto a = glide(default_sensors(), 1, 0.5, 2), b = glide(default_sensors(), 1, 0.5, 2), c = glide(default_sensors(), 2, 0.5, 2);
    int same_as_c = 0;
    for (std::size_t i = 0; i < a.size(); i++) {
        EXPECT_EQ(a[i].current_A, b[i].current_A);
        EXPECT_EQ(a[i].radar_count, b[i].radar_count);
        same_as_c += a[i].accel_m_s2[0] == c[i].accel_m_s2[0] ? 1 : 0;
    }
    EXPECT_EQ(same_as_c, 0);
}

TEST(Random, is_uniform_and_normal_and_documented) {
    Random random(2024, "test");
    constexpr int n = 200000;
    double sum = 0, square = 0, fourth = 0, uniform = 0;
    int beyond = 0;
    for (int i = 0; i < n; i++) {
        const double x = random.normal();
        sum += x;
        square += x * x;
        fourth += x * x * x * x;
        beyond += std::fabs(x) > 1.959964 ? 1 : 0;
        uniform += random.uniform();
    }
    EXPECT_NEAR(sum / n, 0, 4 / std::sqrt(n));
    EXPECT_NEAR(square / n, 1, 4 * std::sqrt(2.0 / n));
    EXPECT_NEAR(fourth / n, 3, 4 * std::sqrt(96.0 / n));
    EXPECT_NEAR(beyond / double{n}, 0.05, 4 * std::sqrt(0.05 * 0.95 / n));
    EXPECT_NEAR(uniform / n, 0.5, 4 * std::sqrt(1 / 12.0 / n));
    // first value of splitmix64 from state 0 (Vigna's reference program)
    EXPECT_EQ(mix64(0), 0xe220a8397b1dcdafu);
}
