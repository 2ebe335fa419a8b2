// Each rule of control_config_check at its bound, from both sides; the bounds are computed here from what the rule says. And what the
// builder makes of radars and converters unlike the reference's.
#include "firmware/core/doppler_template.h"
#include "firmware/core/rover_config.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace {

using Values = std::vector<std::pair<rover_parameter_t, double>>;

control_refusal_t check(const Values &given, int32_t radar, const doppler_template_t *beam, control_config_t *config) {
    rover_parameters_t parameters;
    bool is_given[ROVER_PARAMETER_COUNT] = {};
    rover_parameters_reference(&parameters);
    parameters.radar = radar;
    parameters.beam = beam;
    for (const auto &[key, value] : given) {
        parameters.value[key] = static_cast<float>(value);
        is_given[key] = true;
    }
    rover_parameters_scale(&parameters, is_given);
    control_config_build(&parameters, config);
    return control_config_check(&parameters, config);
}

std::string refused(const Values &given, int32_t radar = ROVER_RADAR_MDU1130) {
    control_config_t config{};
    const char *const key = check(given, radar, nullptr, &config).key;
    return key == nullptr ? "accepted" : key;
}

// `bound` and beyond it in the direction of `step` is refused with this key; a step before it is accepted.
void expect_bound(const std::string &name, rover_parameter_t key, double bound, double step, const Values &with = {},
                  int32_t radar = ROVER_RADAR_MDU1130) {
    Values before = with, beyond = with;
    before.emplace_back(key, bound - step);
    beyond.emplace_back(key, bound + step);
    EXPECT_EQ(refused(before, radar), "accepted") << name << " " << bound - step;
    EXPECT_EQ(refused(beyond, radar), name) << bound + step;
}

constexpr double V = 7.2, Ra = 3.24, K = 0.265, J = 5e-3, two_pi = 6.283185307;

TEST(RoverCheck, the_radars_rules_hold_at_their_bounds) {
    expect_bound("radar_rate_Hz", ROVER_radar_rate_Hz, 512.01, 0.003);
    expect_bound("radar_rate_Hz", ROVER_radar_rate_Hz, 511.99, -0.003);
    expect_bound("radar_depression_deg", ROVER_radar_depression_deg, 25, 0.01);
    expect_bound("radar_depression_deg", ROVER_radar_depression_deg, 15, -0.01);
    EXPECT_EQ(refused({{ROVER_radar_depression_deg, 25}}), "accepted");
    EXPECT_EQ(refused({{ROVER_radar_depression_deg, 15}}), "accepted");
    expect_bound("radar_offset_count", ROVER_radar_offset_count, 0.75 * 1023, 0.5);
    expect_bound("radar_offset_count", ROVER_radar_offset_count, 0.25 * 1023, -0.5);
    const doppler_template_t &drs = doppler_template_drs1000;
    expect_bound("speed_max_m_s", ROVER_speed_max_m_s, static_cast<double>(drs.speed_m_s[drs.speeds - 1]), 1e-4, {}, ROVER_RADAR_DRS1000);
    control_config_t config{}; // an own template is made for its very depression
    EXPECT_EQ(check({{ROVER_radar_depression_deg, 35}}, ROVER_RADAR_OWN, &doppler_template_mdu1130, &config).key, nullptr);
}

TEST(RoverCheck, speeds_hold_at_their_bounds) {
    expect_bound("wheel_max_rad_s", ROVER_wheel_max_rad_s, V / K, 0.01);
    expect_bound("speed_max_m_s", ROVER_speed_max_m_s, 10 * 0.057, 1e-3, {{ROVER_wheel_max_rad_s, 10}});
    expect_bound("encoder_absurd_rad_s", ROVER_encoder_absurd_rad_s, 25, -0.01);
    EXPECT_EQ(refused({{ROVER_encoder_absurd_rad_s, 25}}), "encoder_absurd_rad_s"); // as fast as they may turn is too near
    // four pulses a tick at 60 rad/s, rounded to the nearest: 3.5 * 2 pi/(60 * 0.01)
    expect_bound("encoder_counts_per_turn", ROVER_encoder_counts_per_turn, 3.5 * two_pi / 0.6, -0.1,
                 {{ROVER_still_m_s, 0.1}, {ROVER_dry_speed_rad_s, 1}});
    expect_bound("encoder_counts_per_turn", ROVER_encoder_counts_per_turn, 65535 * two_pi / (900 * 0.01), 20,
                 {{ROVER_encoder_absurd_rad_s, 900}});
}

TEST(RoverCheck, currents_hold_at_their_bounds) {
    expect_bound("stall_current_A", ROVER_stall_current_A, V / Ra, 0.005);
    expect_bound("current_continuous_A", ROVER_current_continuous_A, std::sqrt(95 / (Ra * 12)), 0.001);
    const rover_parameter_t offsets[] = {ROVER_current_offset_count_0, ROVER_current_offset_count_1, ROVER_current_offset_count_2,
                                         ROVER_current_offset_count_3};
    for (const rover_parameter_t offset : offsets) { // a count before the rail must be more than the limits: 1.5 A are 750 counts
        const std::string name = rover_parameter_name(offset);
        EXPECT_EQ(refused({{offset, 750}}), name);
        EXPECT_EQ(refused({{offset, 752}}), "accepted");
        EXPECT_EQ(refused({{offset, 4095 - 750}}), name);
        EXPECT_EQ(refused({{offset, 4095 - 752}}), "accepted");
        const Values stall = {{ROVER_stall_current_A, 2.0}}; // the larger of both limits counts: 1000 counts
        Values at = stall, beyond = stall;
        at.emplace_back(offset, 1000), beyond.emplace_back(offset, 1002);
        EXPECT_EQ(refused(at), name);
        EXPECT_EQ(refused(beyond), "accepted");
    }
    EXPECT_EQ(refused({{ROVER_current_max_count, 2048 + 750}}), "current_offset_count_0");
    EXPECT_EQ(refused({{ROVER_current_max_count, 2048 + 752}}), "accepted");
    // a time constant of four ticks, and one whose tick float cannot tell from none: 2^-25 of it
    expect_bound("winding_J_K", ROVER_winding_J_K, 0.04, -0.001, {{ROVER_winding_K_W, 1}});
    expect_bound("winding_J_K", ROVER_winding_J_K, 0.04 * 33554432 / 14, 200, {{ROVER_winding_K_W, 14}, {ROVER_current_continuous_A, 1}});
}

TEST(RoverCheck, battery_and_loop_hold_at_their_bounds) {
    expect_bound("battery_min_V", ROVER_battery_min_V, V, 0.001);
    expect_bound("battery_V_per_count", ROVER_battery_V_per_count, V / 4094, -1e-6);
    const double room = 4094 - V / 0.004; // counts that an offset may take
    EXPECT_EQ(refused({{ROVER_battery_offset_count, std::ceil(room) + 1}}), "battery_V_per_count");
    EXPECT_EQ(refused({{ROVER_battery_offset_count, std::floor(room) - 1}}), "accepted");
    expect_bound("wheel_kp_s", ROVER_wheel_kp_s, 1.57 / (0.02 * V * K / (Ra * J)), 0.0005); // 90 deg at 20 ms of delay
}

TEST(RoverCheck, signs_and_masks_are_whole) {
    const rover_parameter_t signs[] = {ROVER_encoder_sign_0, ROVER_encoder_sign_1, ROVER_encoder_sign_2, ROVER_encoder_sign_3};
    for (const rover_parameter_t sign : signs) {
        EXPECT_EQ(refused({{sign, 1}}), "accepted");
        EXPECT_EQ(refused({{sign, -1}}), "accepted");
        for (const double no : {0.999, 0.0, -0.999}) {
            EXPECT_EQ(refused({{sign, no}}), rover_parameter_name(sign)) << no;
        }
    }
    for (int mask = 1; mask <= 15; ++mask) {
        EXPECT_EQ(refused({{ROVER_wheel_mask, mask}}), "accepted") << mask;
        control_config_t config{};
        check({{ROVER_wheel_mask, mask}}, ROVER_RADAR_MDU1130, nullptr, &config);
        EXPECT_EQ(config.geometry.wheels, static_cast<uint32_t>(mask));
        EXPECT_FLOAT_EQ(config.geometry.wheel_share, 1.0f / static_cast<float>(__builtin_popcount(static_cast<unsigned>(mask))));
        const uint32_t absent = ~static_cast<uint32_t>(mask) & 15u; // nobody waits for them
        EXPECT_EQ(config.safety.required, (0xfffu | FRAME_EMERGENCY_STOP) & ~(absent * FRAME_ENCODER_0 | absent * FRAME_CURRENT_0));
        EXPECT_EQ(refused({{ROVER_wheel_mask, mask - 0.25}}), "wheel_mask");
        EXPECT_EQ(refused({{ROVER_wheel_mask, mask + 0.25}}), "wheel_mask");
    }
}

// A range ends where it says: its ends are within it, but for what another rule asks of them.
TEST(RoverCheck, the_ends_of_a_range_are_within_it) {
    for (const rover_parameter_t key :
         {ROVER_stall_s, ROVER_battery_low_s, ROVER_disagree_s, ROVER_disagree_ratio, ROVER_slip_valid_m_s, ROVER_sweep_zero_s,
          ROVER_sweep_duration_s, ROVER_slip_gain_speed_m_s, ROVER_half_wheelbase_m, ROVER_gyro_offset_count}) {
        EXPECT_EQ(refused({{key, static_cast<double>(rover_parameter_low(key))}}), "accepted") << rover_parameter_name(key);
        EXPECT_EQ(refused({{key, static_cast<double>(rover_parameter_high(key))}}), "accepted") << rover_parameter_name(key);
    }
}

// A quarter of a window between two values, more where that would be less than 80 ms, a whole one at most.
TEST(RoverCheck, a_radar_of_another_rate_is_heard_at_its_own) {
    doppler_template_t beam = doppler_template_mdu1130;
    for (const double rate : {256.0, 512.0, 799.0, 801.0, 1024.0, 1599.0, 1601.0, 2500.0, 3199.0, 3201.0, 6400.0}) {
        beam.sample_rate_Hz = static_cast<float>(rate);
        control_config_t config{};
        check({{ROVER_radar_rate_Hz, rate}}, ROVER_RADAR_OWN, &beam, &config);
        const int hop = config.doppler.hop;
        EXPECT_TRUE(hop == 64 || hop == 128 || hop == 192 || hop == 256) << rate;
        EXPECT_TRUE(hop / rate >= 0.08 || hop == 256) << rate;
        EXPECT_TRUE(hop == 64 || (hop - 64) / rate < 0.08) << rate;
        EXPECT_NEAR(config.doppler.per_tick_q8, rate * 2.56, 0.51);
        EXPECT_FLOAT_EQ(config.doppler.per_sample_s, static_cast<float>(1 / rate));
        EXPECT_NEAR(config.safety.radar_dead_blocks * 32 / rate, 0.3 + 32 / rate, 16 / rate + 1e-6); // 0.3 s and a block, to half a block
        EXPECT_EQ(config.doppler.beam, &beam);
    }
    control_config_t config{};
    check({}, ROVER_RADAR_COUNT, nullptr, &config); // none: the check refuses it, and nothing is read through a null pointer
    EXPECT_EQ(config.doppler.beam, &doppler_template_mdu1130);
    // no rover is faster than 10 m/s; what a roadside module hears is
    EXPECT_EQ(config.ground_speed.speed_max_m_s, 10.0f);
    for (const auto &[last, most] : {std::pair{8.9f, 10.0f}, {9.1f, 100.0f}, {60.0f, 100.0f}}) {
        beam.speed_m_s[beam.speeds - 1] = last;
        check({}, ROVER_RADAR_OWN, &beam, &config);
        EXPECT_EQ(config.ground_speed.speed_max_m_s, most);
    }
}

// What the estimator's numbers make of another beam: R with its spread and its deafness, a longer window, a point target's line.
TEST(RoverCheck, the_estimator_follows_the_beam) {
    doppler_template_t beam = doppler_template_mdu1130;
    control_config_t reference{}, other{};
    check({}, ROVER_RADAR_OWN, &beam, &reference);
    beam.spread = 0.5f;
    beam.deaf = 2;
    check({}, ROVER_RADAR_OWN, &beam, &other);
    EXPECT_FLOAT_EQ(other.ground_speed.doppler_noise_m_s, 0.5f * reference.ground_speed.doppler_noise_m_s);
    EXPECT_FLOAT_EQ(other.ground_speed.doppler_noise_m2_s2, 4 * reference.ground_speed.doppler_noise_m2_s2);
    EXPECT_FLOAT_EQ(other.ground_speed.quiet_noise_m2_s2, 4 * reference.ground_speed.quiet_noise_m2_s2);
    EXPECT_FLOAT_EQ(other.ground_speed.slow_m_s, 2 * reference.ground_speed.slow_m_s);
    beam.window.per_s = 1; // a window of a second
    beam.window.tau_s *= 2;
    check({}, ROVER_RADAR_OWN, &beam, &other);
    EXPECT_FLOAT_EQ(other.ground_speed.doppler_accel_s2, 4 * reference.ground_speed.doppler_accel_s2);
    EXPECT_FLOAT_EQ(other.ground_speed.doppler_spread_s, 2 * reference.ground_speed.doppler_spread_s);
    EXPECT_NEAR(other.ground_speed.felt_share, 2 * (1 - std::exp(-0.498 / 0.25)), 0.15); // the closed form that its quotient stands for
    EXPECT_NEAR(reference.ground_speed.felt_share, 2 * (1 - std::exp(-0.249 / 0.25)), 0.03);
    beam.line = true;
    check({}, ROVER_RADAR_OWN, &beam, &other);
    EXPECT_EQ(other.ground_speed.doppler_spread_s, 0.0f);
}

// Gyros and accelerometers so fine or so coarse that 32 bits do not hold their products are left out of the lean, never wrapped.
TEST(RoverCheck, a_lean_that_whole_numbers_cannot_hold_is_left_out) {
    const auto lean = [](rover_parameter_t key, double value) {
        control_config_t config{};
        check({{key, value}}, ROVER_RADAR_MDU1130, nullptr, &config);
        return config.sense.lean;
    };
    const double finest = 256 * 9.81 / 16777216, coarsest = 2147483520 / (0.01 * std::pow(2.0, 44));
    EXPECT_EQ(lean(ROVER_accel_m_s2_per_count, finest * 0.99).gravity_q8, 0);
    EXPECT_NEAR(lean(ROVER_accel_m_s2_per_count, finest * 1.01).gravity_q8, 16777216 / 1.01, 3);
    EXPECT_EQ(lean(ROVER_gyro_rad_s_per_count, coarsest * 1.01).gravity_q8, 0);
    EXPECT_EQ(lean(ROVER_gyro_rad_s_per_count, coarsest * 1.01).turn_q52, 0);
    const lean_config_t coarse = lean(ROVER_gyro_rad_s_per_count, 0.012);
    EXPECT_NEAR(coarse.turn_q52, 0.012 * 0.01 * std::pow(2.0, 44), 200);
    EXPECT_NEAR(coarse.sudden_q8 * 0.012 / 256, 0.05, 0.012 / 256); // 3 deg/s
    EXPECT_NEAR(coarse.steep_q8, coarse.gravity_q8 * 0.05, 0.51);   // 3 deg
}

TEST(RoverCheck, counts_are_rounded_to_the_nearest_on_both_sides) {
    control_config_t config{};
    check({{ROVER_accel_offset_count, 2.4},
           {ROVER_gyro_offset_count, -2.6},
           {ROVER_battery_offset_count, -2.4},
           {ROVER_current_offset_count_1, 2047.6}},
          ROVER_RADAR_MDU1130, nullptr, &config);
    EXPECT_EQ(config.sense.accel_offset_count, 2);
    EXPECT_EQ(config.sense.gyro_offset_count, -3);
    EXPECT_EQ(config.sense.battery_offset_count, -2);
    EXPECT_EQ(config.sense.current_offset_count[1], 2048);
    check({{ROVER_accel_offset_count, 1e9},
           {ROVER_gyro_offset_count, -1e9},
           {ROVER_battery_offset_count, NAN},
           {ROVER_radar_quiet_count2, 1e9},
           {ROVER_sweep_duration_s, 1e9}},
          ROVER_RADAR_MDU1130, nullptr, &config); // refused, and held all the same
    EXPECT_EQ(config.sense.accel_offset_count, 65535);
    EXPECT_EQ(config.sense.gyro_offset_count, -65535);
    EXPECT_EQ(config.sense.battery_offset_count, 0);
    EXPECT_EQ(config.doppler.quiet_power_count2, 65535u);
    EXPECT_EQ(config.soil_sweep.duration_ticks, 3600000u);
}

} // namespace
