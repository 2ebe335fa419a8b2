// The two sensor effects that need an accelerating rover: the body that rocks, and the radar beam that nods.
#include "sim/physics/effects/laws.h"
#include "sim/sensors/sensors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using namespace traction::sim;

// A rover at 0.2 m/s that accelerates steadily; no sensor has noise.
std::vector<Measurements> spurt(SensorConfig config, const ActiveEffect &active, double accel_m_s2, double seconds) {
    config.accel.noise = config.accel_vibration_1_s = config.radar.noise_count = config.radar.flicker_count = 0;
    apply_sensor_effects({&active, 1}, config);
    Truth truth;
    truth.v_body_m_s[0] = 0.2;
    Sensors sensors(config, 1, truth);
    std::vector<Measurements> out;
    for (int ms = 1; ms <= static_cast<int>(seconds * 1000); ++ms) {
        truth.t_s = ms * 1e-3;
        truth.v_body_m_s[0] = 0.2 + accel_m_s2 * truth.t_s;
        truth.path_m = truth.position_m[0] = (0.2 + 0.5 * accel_m_s2 * truth.t_s) * truth.t_s;
        truth.specific_force_m_s2[0] = accel_m_s2;
        sensors.step(truth);
        if (ms % 10 == 0) sensors.measure(out.emplace_back());
    }
    return out;
}

ActiveEffect effect(const char *name, double value) { return {find_effect(name), -1, {value}}; }

TEST(SensorEffects, a_rocking_body_adds_gravity_a_tenth_of_a_second_late) {
    const auto seen = spurt(default_sensors(), effect("accel_tilt", 0.012), 0.5, 3);
    const double full = law::accel_tilt(0.5, 9.81, 0.012, 0.5);
    EXPECT_NEAR(seen.back().accel_m_s2[0], full, 1e-9); // rounding; the lags are over, exp(-29) is left
    // the tick that ends at 0.11 s averages 0.1 to 0.11 s: 1 - exp(-t'/0.1), t' later by the 10 ms smoothing of the acceleration
    const double share = (seen[10].accel_m_s2[0] - 0.5) / (full - 0.5);
    EXPECT_NEAR(share, 1 - std::exp(-0.95), 0.02); // two lags of 0.1 and 0.01 s in series, against their sum's delay: 0.01
}

TEST(SensorEffects, a_nodding_beam_is_a_wrong_scale_as_long_as_the_rover_accelerates) {
    const auto nod = spurt(default_sensors(), effect("radar_pitch", 0.1), 0.5, 1.2);
    const auto scaled = spurt(default_sensors(), effect("radar_scale", 0.05), 0.5, 1.2),
               plain = spurt(default_sensors(), effect("radar_scale", 0), 0.5, 1.2);
    double to_scaled = 0, to_plain = 0;
    for (std::size_t i = 0; i < nod.size(); ++i)
        for (std::size_t k = 0; k < nod[i].radar_count.size(); ++k) {
            to_scaled += std::pow(nod[i].radar_count[k] - scaled[i].radar_count[k], 2);
            to_plain += std::pow(nod[i].radar_count[k] - plain[i].radar_count[k], 2);
        }
    // the smoothing of 10 ms costs 0.2 m/s * 10 ms * 5 % = 0.1 mm of path, 4 % of a radian of echo phase (4 pi/30 mm): amplitude 4 %;
    // without the effect the path of 0.6 m falls 30 mm behind, two turns of phase: nothing in common
    EXPECT_LT(to_scaled, 0.01 * to_plain);
    EXPECT_GT(to_plain, 0);
}

// A rover that stands until 0.5 s, then accelerates: what a late sensor says is what a prompt one said its delay before.
std::vector<Measurements> start(const ActiveEffect &active) {
    SensorConfig config = default_sensors();
    config.accel.noise = config.accel_vibration_1_s = config.gyro.noise = config.radar.noise_count = config.radar.flicker_count = 0;
    for (AnalogConfig &current : config.current) current.noise = 0;
    apply_sensor_effects({&active, 1}, config);
    Truth truth;
    Sensors sensors(config, 1, truth);
    std::vector<Measurements> out;
    for (int ms = 1; ms <= 1500; ++ms) {
        truth.t_s = ms * 1e-3;
        const double since = std::fmax(0, truth.t_s - 0.5);
        truth.v_body_m_s[0] = 0.5 * since;
        truth.path_m = truth.position_m[0] = 0.25 * since * since;
        truth.specific_force_m_s2[0] = since > 0 ? 0.5 : 0;
        truth.rate_body_rad_s[2] = 0.3 * since;
        for (auto &wheel : truth.wheel) wheel.current_A = 0.8 * since;
        sensors.step(truth);
        if (ms % 10 == 0) sensors.measure(out.emplace_back());
    }
    return out;
}

// The rover of start(): r = 0.3 (t - 0.5), so that 0.2 m ahead feels -0.2 r^2 and 0.1 m to the left -0.1 * 0.3.
TEST(SensorEffects, an_accelerometer_off_the_centre_feels_the_turn_and_a_gyro_is_scaled) {
    const auto plain = start(effect("accel_bias", 0)), scaled = start(effect("gyro_scale", 0.1));
    const auto ahead = start({find_effect("accel_place"), -1, {0.2, 0}}), left = start({find_effect("accel_place"), -1, {0, 0.1}});
    const std::size_t i = plain.size() - 1;
    const double r = 0.3 * (static_cast<double>(i + 1) * 0.01 - 0.5 - 0.0045); // a sample is the mean of its 10 ms
    ASSERT_GT(r, 0.29);
    EXPECT_NEAR(ahead[i].accel_m_s2[0] - plain[i].accel_m_s2[0], -0.2 * r * r, 1e-4);
    EXPECT_NEAR(left[i].accel_m_s2[0] - plain[i].accel_m_s2[0], -0.03, 1e-4);
    EXPECT_NEAR(scaled[i].gyro_rad_s[2] - plain[i].gyro_rad_s[2], 0.1 * r, 1e-4);
}

TEST(SensorEffects, a_late_sensor_says_what_a_prompt_one_said_its_delay_before) {
    const auto prompt = start(effect("accel_bias", 0));
    const auto accel = start(effect("accel_delay", 0.12)), gyro = start(effect("gyro_delay", 0.12)),
               current = start(effect("current_delay", 0.05)), radar = start(effect("radar_delay", 0.25));
    double late = 0, at_once = 0;
    for (std::size_t i = 30; i < prompt.size(); ++i) {
        EXPECT_NEAR(accel[i].accel_m_s2[0], prompt[i - 12].accel_m_s2[0], 1e-12);
        EXPECT_NEAR(gyro[i].gyro_rad_s[2], prompt[i - 12].gyro_rad_s[2], 1e-12);
        EXPECT_NEAR(current[i].current_A[1], prompt[i - 5].current_A[1], 1e-12);
        // the phase of the echo, sampled at 512 Hz: 0.25 s are 128 samples
        const auto first = static_cast<std::ptrdiff_t>(radar[i].radar_first), before = static_cast<std::ptrdiff_t>(prompt[0].radar_first);
        for (std::size_t k = 0; k < radar[i].radar_count.size(); ++k) {
            const auto find = [&](std::ptrdiff_t sample) {
                for (const Measurements &m : prompt) {
                    const std::ptrdiff_t at = sample - static_cast<std::ptrdiff_t>(m.radar_first);
                    if (at >= 0 && at < static_cast<std::ptrdiff_t>(m.radar_count.size()))
                        return static_cast<double>(m.radar_count[static_cast<std::size_t>(at)]);
                }
                return 0.0;
            };
            const std::ptrdiff_t sample = first + static_cast<std::ptrdiff_t>(k);
            if (sample - 128 < before) continue;
            late += std::pow(radar[i].radar_count[k] - find(sample - 128), 2);
            at_once += std::pow(radar[i].radar_count[k] - find(sample), 2);
        }
    }
    EXPECT_LT(late,
              0.02 * at_once); // its delay is whole steps of the plant, 1 ms: 0.5 mm of path at most, a tenth of the echo's phase squared
}

TEST(SensorEffects, a_low_pass_has_reached_all_but_a_share_of_1_over_e_after_its_time_constant) {
    const auto slow = start(effect("accel_lag", 0.12));
    // the tick that ends at 0.5 + 0.12 s averages the last 10 ms of 1 - exp(-t/lag), and steps of 1 ms act 0.5 ms early
    EXPECT_NEAR(slow[61].accel_m_s2[0] / 0.5, 1 - std::exp(-0.115 / 0.12), 0.005);
    EXPECT_NEAR(slow.back().accel_m_s2[0], 0.5, 0.5 * std::exp(-0.98 / 0.12));
}

} // namespace
