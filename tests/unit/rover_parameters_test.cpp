// The builder, its scaling and its check. What the reference rover's numbers were before there was a builder is written out here.
#include "firmware/core/doppler_template.h"
#include "firmware/core/rover_config.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace {

static const float wheel_radius_m = 0.057f;                       // [m] under load, table I
static const float half_wheelbase_m = 0.083f;                     // [m] table I
static const float half_track_m = 0.12f;                          // [m] table I
static const float mass_kg = 2.88f;                               // [kg] table I
static const float wheel_inertia_kg_m2 = 5e-3f;                   // [kg m^2] identified, section 3
static const float torque_constant_Nm_A = 0.265f;                 // [N m/A] at the wheel, (17)
static const float viscous_Nms = 1.6e-3f;                         // [N m s] (18)
static const float dry_Nm = 0.03f;                                // [N m] (18)
static const float resistance_ohm = 3.24f;                        // [ohm] assumed: V^2/(4 Ra) = 4 W at 7.2 V
static const float speed_max_m_s = 1.0f;                          // [m/s] table I
static const float tick_s = 0.01f;                                // [s] dT of (13)
static const float encoder_rad_per_count = 6.28318531f / 6000.0f; // [rad] 120 pulses x gear 50, section 3

static sense_config_t sense_default() {
    const sense_config_t sense = {
        .encoder_rad_per_count = encoder_rad_per_count,
        .speed_rad_s_per_count = encoder_rad_per_count / tick_s,
        .accel_rad_s2_per_count = encoder_rad_per_count / (16.0f * tick_s * tick_s),
        .current_A_per_count = 0.002f,   // [A] assumed: 12 bit over +-4.1 A
        .battery_V_per_count = 0.004f,   // [V] assumed: 12 bit over 16.4 V
        .accel_m_s2_per_count = 0.004f,  // [m/s^2] assumed, about 0.4 mg
        .gyro_rad_s_per_count = 0.0005f, // [rad/s] assumed
        .level_m_s2_per_q8 = 0.004f / 256.0f,
        .lean = {.turn_q52 = 87960936, // 0.0005 rad/s 0.01 s 2^52/256 is 87,960,930; a float of that size counts by eights
                 .gravity_q8 = 627840,
                 .sudden_q8 = 25600, // 256 9.81/0.004
                 .calm_count = 71,   // 0.035 rad/s, and a count
                 .steep_q8 = 31392}, // a twentieth
        .encoder_sign = {1, 1, 1, 1},
        .current_offset_count = {2048, 2048, 2048, 2048},
        .battery_offset_count = 0,
        .accel_offset_count = 0,
        .gyro_offset_count = 0,
        .current_max_count = 4095,
        .battery_max_count = 4095,
        .radar_max_count = 1023,
        .encoder_step_max = 573, // [count/tick] 60 rad/s, twice the no-load speed 7.2 V/ke = 27 rad/s (assumed margin)
        .encoder_jump_max = 12,  // [count/tick] 1.18 rad/s: stall torque 0.589 N m over 5e-3 kg m^2 for 10 ms, and a pulse
    };
    return sense;
}

static doppler_config_t doppler_default() {
    const doppler_config_t doppler = {
        .beam = &doppler_template_mdu1130,
        .method = DOPPLER_LIKELIHOOD,
        .offset_count = 512, // [count] assumed: mid-scale of 10 bit
        .hop = 64,
        .scale = 1.0f, // until `traction calibrate` has measured it
        .max_count = 1023,
        .per_tick_q8 = 1311, // 5.12 samples
        .per_sample_s = 1.0f / 512.0f,
        .quiet_power_count2 = 2, // [count^2] assumed
    };
    return doppler;
}

static ground_speed_config_t ground_speed_default() {
    const ground_speed_config_t ground_speed = {
        .method = GROUND_SPEED_BIAS,
        .window = &doppler_template_mdu1130.window,
        .tick_s = tick_s,
        .per_tick_1_s = 100.0f,
        .tick_q20_s = tick_s * 1048576.0f,
        .speed_noise_m2_s2 = 4e-6f,     // [m^2/s^2] per tick: (0.2 m/s^2 T)^2, accelerometer noise assumed
        .speed_noise_max_m2_s2 = 4e-4f, // (2 m/s^2 T)^2, assumed: above, it is no noise
        .blind_noise_m2_s2 = 7.5e-4f,   // without an accelerometer: 0.5 m/s^2 that lasts for 0.3 s, assumed
        .bias_noise_m2_s4 = 5e-7f,      // [m^2/s^4] per tick: 5e-5 per second; jumps are found by (4)
        .bias_start_m_s2 = 1.0f,        // as rover_config.c has it
        .bias_max_m_s2 = 3.0f,          // 17 deg of slope and 0.1 m/s^2 of the device
        .speed_max_m_s = 10.0f,
        .doppler_noise_m2_s2 = 3e-5f,
        .doppler_noise_m_s = 5.8e-4f,
        .doppler_accel_s2 = 0.004f,
        .deaf_noise_m2_s2 = 4e-4f, // (2 cm/s)^2
        .per_slow_s_m = 1.0f / 0.12f,
        .lowest_m_s = 1.02f * doppler_template_mdu1130.speed_m_s[0],
        .doppler_spread_s = 0.25f,
        .gate_sigma = 3.5f,
        .gate_patience = 4,
        .jump_share = 0.25f,  // half a second of values 0.125 s apart
        .jump_limit = 2.0f,   // [1] 2.5 settles a slope 0.2 s later and is 0.01 cm/s better in speed_bench
        .jump_m2_s4 = 0.002f, // [m^2/s^4] assumed: (0.045 m/s^2)^2, a quarter of a degree
        .agile_m2_s4 = 0.5f,  // [m^2/s^4] (0.7 m/s^2)^2: 4 deg of slope within 0.125 s, assumed
        .agile_limit = 20.0f, // exp(10) to one
        .agile_sure = 5.0f,
        .apart_told_m_s = 0.06f,
        .agile_drift = 0.0f,
        .agile_most = 10.0f,
        .apart_forget = 0.04f,
        .apart_share = 1.0f,
        .apart_least_m_s = 0.03f,
        .apart_noise = 112.0f,
        .felt_share = 2.0f * 4.0f * doppler_template_mdu1130.window.tau_s / (1.0f + 0.58f * 4.0f * doppler_template_mdu1130.window.tau_s),
        .felt_noise = 12.5f,
        .roll_told_m_s = 0.1f,
        .slip_force_m_s2 = 0.3f,
        .roll_odds = 6.0f,
        .roll_noise_m2_s2 = 1.5e-5f,
        .roll_share = 0.1f,
        .roll_bias_m2_s4 = 0.01f,
        .agile_values = 4, // half a second: a window's length
        .misfit_share = 0.02f,
        .misfit_max = 30.0f,
        .quiet_needed = 3,
        .lean_m_s2_per_q8 = 0.004f / 256.0f,
        .lean_told_q8 = 12800, // 0.2 m/s^2
        .gyro_slow = 0.01f / 1.5f,
        .gyro_learns_q8_s2_m = 256.0f / (9.81f * 0.0005f) * 0.01f / (1.5f * 3.0f),
        .gyro_turns = -0.004f / 256.0f * (256.0f / (9.81f * 0.0005f)) / 0.36f,
        .gyro_runs_m2_s6 = 0.0025f,
        .gyro_sure_m_s2 = 0.05f,
        .gyro_steady_m2_s2 = 4e-4f,
        .quiet_noise_m2_s2 = 9e-4f, // (0.03 m/s)^2: the band-pass blinds below 0.05 m/s
        .still_m_s = 0.006f,        // one encoder pulse a tick
        .rest_m_s = 0.0015f,        // a quarter of it
        .still_needed = 25,         // 0.25 s, assumed: blocked wheels stop 0.12 m/s within 0.05 s on any soil
        .parked_needed = 100,       // 1 s: eight values of the radar that tell of no speed, assumed
        .loud_needed = 3,
        .standing_noise_m2_s2 = 1e-4f, // (1 cm/s)^2 per tick
        .slow_m_s = 0.12f,
        .sign_sure = 18.0f,  // exp(9) to one
        .wheel_spins = 6.0f, // exp(3) to one, assumed
        .wheel_odds = 2.0f,  // e to one, assumed
        .wheel_match = 14.0f,
        .wheel_pull = 0.5f,
        .against_values = 4,
        .against_odds = 4.0f,
        .force_per_s2_m = 4.0f,
        .force_most = 12.0f,
        .force_pull = 0.25f,
        .wheel_noise_m_s = 0.1f, // assumed
        .wheel_slip = 0.5f,
    };
    return ground_speed;
}

static safety_config_t safety_default() {
    const safety_config_t safety = {
        .tick_s = tick_s,
        .required = 0x1fffu,
        .patience_ticks = 7,          // off in the 8th bad tick: 80 ms, inside the 100 ms asked for
        .command_patience_ticks = 8,  // 80 ms
        .missed_ticks_max = 5,        // 50 ms
        .missed_forget_ticks = 100,   // assumed: 1 % missed ticks are tolerated for ever
        .current_continuous_A = 1.5f, // [A] assumed: above the 1.35 A of full traction on concrete (5.6 N R + Gr)/KG
        .current_continuous_A2 = 2.25f,
        .i2t_max_A2_ticks = 800.0f,                            // 8 A^2 s assumed: 3 s of stall at 2.2 A
        .stall_current_A = 1.4f,                               // [A] assumed: above the current of a wheel held by full traction
        .stall_speed_rad_s = 0.3f,                             // [rad/s] assumed
        .stall_s = 1.0f,                                       // [s] assumed
        .heating_K_A2 = 4.0f * tick_s * resistance_ohm / 5.0f, // C_th = 5 J/K assumed
        .keeping = 1.0f - 4.0f * tick_s / (12.0f * 5.0f),      // R_th = 12 K/W assumed: time constant 60 s
        .temperature_rise_max_K = 95.0f,                       // [K] assumed: class B winding at 35 C
        .battery_min_V = 5.4f,                                 // [V] assumed: 0.9 V per cell of 6
        .battery_s = 0.5f,                                     // [s] assumed
        .brown_out_V = 0.8f * 5.4f,
        .brown_out_ticks = 2,
        .radar_dead_count2 = 819, // 0.8 count^2 times 32^2
        .radar_dead_blocks = 6,   // 0.375 s
        .sigmas = 3.0f,
        .disagree_m_s = 0.15f,             // [m/s] assumed
        .disagree_ratio_m = 1.5f * 0.057f, // [1] assumed, times the radius
        .turning_rad_s = 0.15f / 0.057f,
        .disagree_s = 1.0f, // [s] assumed
    };
    return safety;
}

control_config_t written_out() {
    const control_config_t config = {
        .geometry = {.wheel_radius_m = wheel_radius_m,
                     .half_wheelbase_m = half_wheelbase_m,
                     .half_track_m = half_track_m,
                     .mass_kg = mass_kg,
                     .wheels = 0xf,
                     .wheel_share = 0.25f},
        .sense = sense_default(),
        .circuit = {.resistance_ohm = resistance_ohm,
                    .back_emf_Vs = torque_constant_Nm_A,
                    .per_back_emf_1_Vs = 1.0f / torque_constant_Nm_A,
                    .contradict_V = 0.22f * 7.2f,
                    .contradict_current = 0.35f,
                    .contradict_speed = 0.25f,
                    .open_A = 0.02f * 7.2f / resistance_ohm,
                    .open_V = 0.07f * 7.2f,
                    .dead_V = 0.22f * 7.2f,
                    .open_speed = 0.1f,
                    .jump_rad_s = tick_s * torque_constant_Nm_A * 7.2f / (resistance_ohm * wheel_inertia_kg_m2),
                    .hold_ticks = 3,
                    .refused_ticks = 30,
                    .contradict_looks = 8,
                    .open_looks = 6},
        .doppler = doppler_default(),
        .ground_speed = ground_speed_default(),
        .slip = {.wheel_radius_m = wheel_radius_m,
                 .valid_m_s = 0.05f,
                 .valid_std = 0.25f,
                 .rim_std_m_s =
                     0.40824829f * (6.28318531f / 6000.0f / tick_s) * wheel_radius_m}, // [m/s] the band-pass blinds the radar below
        .motor = {.torque_constant_Nm_A = torque_constant_Nm_A,
                  .volt_per_speed_Vs = resistance_ohm * viscous_Nms / torque_constant_Nm_A + torque_constant_Nm_A,
                  .volt_dry_V = resistance_ohm * dry_Nm / torque_constant_Nm_A,
                  .back_emf_Vs = torque_constant_Nm_A, // assumed: equal in SI
                  .resistance_ohm = resistance_ohm,
                  .viscous_Nms = viscous_Nms,
                  .dry_Nm = dry_Nm,
                  .per_dry_speed_s = 5.0f, // 1/0.2 [rad/s] assumed: five steps of the speed's rounding noise
                  .inertia_kg_m2 = wheel_inertia_kg_m2,
                  .per_radius_1_m = 1.0f / wheel_radius_m},
        .wheel_pid = {.kp_s = 0.2f,     // docs/firmware.md: crossover 24 rad/s free, 16 rad/s gripping
                      .ki_T_s = 0.009f, // zero of the PI on the motor's pole 4.6 rad/s
                      .kd_s2 = 0.0f,
                      .slew_T_rad_s = 0.6f, // 60 rad/s^2: half of what stall torque gives a free wheel
                      .integral_max = 2.0f,
                      .duty_max = 1.0f},
        .slip_pi = {.kp = 2.0f, .ki_T = 0.09f, .duty_max = 1.0f, .per_speed_s_m = 5.0f, .gain_min = 0.25f, .gain_max = 2.5f},
        .speed_control = {.per_radius_1_m = 1.0f / wheel_radius_m,
                          .half_track_per_radius = half_track_m / wheel_radius_m,
                          .kv_rad_m = 17.5f,   // 1/R: halves the error, docs/firmware.md
                          .ki_T_rad_m = 0.35f, // 35 rad/s per m/s per s
                          .integral_max_rad_s = 6.0f,
                          .speed_max_m_s = speed_max_m_s,
                          .yaw_rate_max_rad_s = 4.0f, // [rad/s] assumed
                          .wheel_max_rad_s = 25.0f},  // [rad/s] below the no-load speed of 27
        .steering = {},
        .soil_sweep = {.ramp_1_m = tick_s / (wheel_radius_m * 10.0f), // t_zero = 10 s, section 6
                       .duration_ticks = 2000,
                       .wheel_max_rad_s = 25.0f},
        .safety = safety_default(),
        .self_test = {}, // no part of a tick: self_test_test.cpp
        .feed_forward = true,
    };
    return config;
}

template <class T> void expect_same_bits(const T &a, const T &b, const char *what) { EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0) << what; }

TEST(ControlConfig, the_reference_rover_keeps_every_bit) {
    const control_config_t built = rover_config_default(), before = written_out();
    // these hold 32-bit numbers alone: no padding
    expect_same_bits(built.geometry, before.geometry, "geometry");
    expect_same_bits(built.sense, before.sense, "sense");
    expect_same_bits(built.circuit, before.circuit, "circuit");
    expect_same_bits(built.slip, before.slip, "slip");
    expect_same_bits(built.motor, before.motor, "motor");
    expect_same_bits(built.wheel_pid, before.wheel_pid, "wheel_pid");
    expect_same_bits(built.slip_pi, before.slip_pi, "slip_pi");
    expect_same_bits(built.speed_control, before.speed_control, "speed_control");
    expect_same_bits(built.soil_sweep, before.soil_sweep, "soil_sweep");
    expect_same_bits(built.safety, before.safety, "safety");
    EXPECT_EQ(built.feed_forward, before.feed_forward);
    EXPECT_EQ(built.doppler.beam, before.doppler.beam);
    EXPECT_EQ(built.doppler.method, before.doppler.method);
    EXPECT_EQ(built.doppler.offset_count, before.doppler.offset_count);
    EXPECT_EQ(built.doppler.hop, before.doppler.hop);
    EXPECT_EQ(built.doppler.scale, before.doppler.scale);
    EXPECT_EQ(built.doppler.max_count, before.doppler.max_count);
    EXPECT_EQ(built.doppler.per_tick_q8, before.doppler.per_tick_q8);
    EXPECT_EQ(built.doppler.per_sample_s, before.doppler.per_sample_s);
    EXPECT_EQ(built.doppler.quiet_power_count2, before.doppler.quiet_power_count2);
    EXPECT_EQ(built.ground_speed.method, before.ground_speed.method);
    EXPECT_EQ(built.ground_speed.window, before.ground_speed.window);
    const auto rest = offsetof(ground_speed_config_t, tick_s);
    EXPECT_EQ(std::memcmp(reinterpret_cast<const char *>(&built.ground_speed) + rest,
                          reinterpret_cast<const char *>(&before.ground_speed) + rest,
                          offsetof(ground_speed_config_t, wheel_slip) + sizeof(float) - rest),
              0);
}

TEST(ControlConfig, scaling_the_reference_rover_changes_no_bit) {
    rover_parameters_t reference, scaled;
    rover_parameters_reference(&reference);
    scaled = reference;
    for (int i = 0; i < ROVER_PARAMETER_COUNT; ++i)
        if (rover_parameter_scaled(i)) scaled.value[i] = -1; // all of them are made anew
    const bool none[ROVER_PARAMETER_COUNT] = {};
    rover_parameters_scale(&scaled, none);
    for (int i = 0; i < ROVER_PARAMETER_COUNT; ++i) EXPECT_EQ(scaled.value[i], reference.value[i]) << rover_parameter_name(i);
}

// The window's table as it was measured and written by hand for 512 Hz; a template of another rate has its own.
TEST(ControlConfig, the_window_of_512_Hz_is_the_one_the_estimator_had) {
    constexpr std::array<int16_t, 51> before{
        0,    0,    1,    3,    8,    18,   35,   61,   99,   151,  217,  298,  396,  507,  629,  762,  902,
        1044, 1184, 1317, 1440, 1551, 1632, 1695, 1733, 1745, 1728, 1685, 1617, 1532, 1417, 1291, 1157, 1016,
        874,  736,  604,  484,  375,  281,  203,  140,  91,   55,   31,   15,   6,    2,    0,    0,    0,
    };
    for (int radar = 0; radar < ROVER_RADAR_LINKED; ++radar) {
        const doppler_window_t &window = doppler_template_of(radar)->window;
        ASSERT_EQ(window.ticks, 51);
        EXPECT_EQ(window.tau_s, 0.249f);
        EXPECT_EQ(window.tau_ticks, 24.9f);
        EXPECT_EQ(window.per_s, 2.0f);
        for (std::size_t j = 0; j < before.size(); ++j) EXPECT_EQ(window.weight_q15[j], before[j]) << j;
    }
}

using Values = std::vector<std::pair<rover_parameter_t, float>>;

struct Made {
    rover_parameters_t parameters;
    control_config_t config;
    control_refusal_t refusal;
};

Made make(const Values &given, int32_t radar = ROVER_RADAR_MDU1130) {
    Made made{};
    bool is_given[ROVER_PARAMETER_COUNT] = {};
    rover_parameters_reference(&made.parameters);
    made.parameters.radar = radar;
    for (const auto &[key, value] : given) {
        made.parameters.value[key] = value;
        is_given[key] = true;
    }
    rover_parameters_scale(&made.parameters, is_given);
    control_config_build(&made.parameters, &made.config);
    made.refusal = control_config_check(&made.parameters, &made.config);
    return made;
}

std::string refused(const Values &given, int32_t radar = ROVER_RADAR_MDU1130) {
    const Made made = make(given, radar);
    return made.refusal.key == nullptr ? "accepted" : made.refusal.key;
}

// Every derived number follows the wheel radius: none is left at the reference's (they stood in five places once).
TEST(ControlConfig, a_radius_reaches_every_place_that_it_is_in) {
    const control_config_t small = make({{ROVER_wheel_radius_m, 0.057f}}).config, large = make({{ROVER_wheel_radius_m, 0.114f}}).config;
    EXPECT_FLOAT_EQ(large.slip.wheel_radius_m, 0.114f);
    EXPECT_FLOAT_EQ(large.geometry.wheel_radius_m, 0.114f);
    EXPECT_FLOAT_EQ(large.motor.per_radius_1_m * 2, small.motor.per_radius_1_m);
    EXPECT_FLOAT_EQ(large.speed_control.per_radius_1_m * 2, small.speed_control.per_radius_1_m);
    EXPECT_FLOAT_EQ(large.speed_control.half_track_per_radius * 2, small.speed_control.half_track_per_radius);
    EXPECT_FLOAT_EQ(large.soil_sweep.ramp_1_m * 2, small.soil_sweep.ramp_1_m);
    EXPECT_FLOAT_EQ(large.speed_control.kv_rad_m * 2, small.speed_control.kv_rad_m);
    EXPECT_FLOAT_EQ(large.slip_pi.kp * 2, small.slip_pi.kp);
    EXPECT_FLOAT_EQ(large.ground_speed.still_m_s, 2 * small.ground_speed.still_m_s);
}

// (5): crossover k Kp and zero Ki/Kp - pole stay where the reference has them, so its margins hold for any machine.
TEST(ControlConfig, the_wheel_loop_keeps_its_crossover_and_its_zero) {
    const auto figures = [](const Made &made) {
        const float *v = made.parameters.value;
        const float k = v[ROVER_battery_voltage_V] * v[ROVER_torque_constant_Nm_A] / (v[ROVER_resistance_ohm] * v[ROVER_inertia_kg_m2]);
        const float p = v[ROVER_torque_constant_Nm_A] * v[ROVER_back_emf_Vs_rad] / (v[ROVER_resistance_ohm] * v[ROVER_inertia_kg_m2]) +
                        v[ROVER_viscous_Nms] / v[ROVER_inertia_kg_m2];
        return std::pair{k * made.config.wheel_pid.kp_s, made.config.wheel_pid.ki_T_s * 100 / made.config.wheel_pid.kp_s / p};
    };
    const auto reference = figures(make({}));
    const Made heavy = make({{ROVER_torque_constant_Nm_A, 3.0f},
                             {ROVER_resistance_ohm, 0.6f},
                             {ROVER_inertia_kg_m2, 0.15f},
                             {ROVER_viscous_Nms, 0.05f},
                             {ROVER_coulomb_Nm, 0.8f},
                             {ROVER_battery_voltage_V, 24.0f},
                             {ROVER_mass_kg, 60.0f},
                             {ROVER_current_A_per_count, 0.02f},
                             {ROVER_battery_V_per_count, 0.01f},
                             {ROVER_wheel_radius_m, 0.165f}});
    const auto other = figures(heavy);
    EXPECT_NEAR(other.first, reference.first, 1e-4f * reference.first); // a few float roundings
    EXPECT_NEAR(other.second, reference.second, 1e-4f * reference.second);
    EXPECT_EQ(heavy.config.motor.back_emf_Vs, 3.0f);
    EXPECT_EQ(heavy.refusal.key, nullptr) << (heavy.refusal.key != nullptr ? heavy.refusal.key : "");
}

TEST(ControlConfigCheck, lets_the_reference_rover_pass) {
    EXPECT_EQ(refused({}), "accepted");
    EXPECT_EQ(refused({{ROVER_speed_max_m_s, 0.9f}}, ROVER_RADAR_DRS1000), "accepted");
}

TEST(ControlConfigCheck, every_number_must_be_finite_and_within_its_range) {
    for (int i = 0; i < ROVER_PARAMETER_COUNT; ++i) {
        const auto key = static_cast<rover_parameter_t>(i);
        const float above = std::nextafter(rover_parameter_high(i), INFINITY), below = std::nextafter(rover_parameter_low(i), -INFINITY);
        for (const float value : {above, below, NAN, INFINITY, -INFINITY}) {
            const std::string name = refused({{key, value}});
            // what is scaled from an impossible number may be refused first, but something always is
            EXPECT_NE(name, "accepted") << rover_parameter_name(i) << " = " << value;
        }
        EXPECT_LT(rover_parameter_low(i), rover_parameter_high(i)) << rover_parameter_name(i);
    }
}

// One case per rule: what is given, and the key that the refusal names.
TEST(ControlConfigCheck, refuses_what_cannot_work_and_names_the_key) {
    EXPECT_EQ(refused({{ROVER_mass_kg, -1}}), "mass_kg");
    EXPECT_EQ(refused({{ROVER_encoder_sign_2, 0}}), "encoder_sign_2");
    EXPECT_EQ(refused({}, ROVER_RADAR_COUNT), "radar");
    EXPECT_EQ(refused({}, -1), "radar");
    EXPECT_EQ(refused({{ROVER_radar_rate_Hz, 640}}), "radar_rate_Hz");
    EXPECT_EQ(refused({{ROVER_radar_depression_deg, 35}}), "radar_depression_deg");
    EXPECT_EQ(refused({{ROVER_speed_max_m_s, 1.2f}}, ROVER_RADAR_DRS1000), "speed_max_m_s"); // 35.5 GHz: 0.99 m/s at 512 Hz
    EXPECT_EQ(refused({{ROVER_radar_offset_count, 900}}), "radar_offset_count");
    EXPECT_EQ(refused({{ROVER_wheel_max_rad_s, 28}}), "wheel_max_rad_s"); // 7.2 V/0.265 = 27.2 rad/s
    EXPECT_EQ(refused({{ROVER_wheel_max_rad_s, 10}, {ROVER_speed_max_m_s, 0.8f}}), "speed_max_m_s");
    EXPECT_EQ(refused({{ROVER_encoder_absurd_rad_s, 20}}), "encoder_absurd_rad_s");
    EXPECT_EQ(refused({{ROVER_encoder_counts_per_turn, 30}, {ROVER_still_m_s, 0.1f}, {ROVER_dry_speed_rad_s, 1}}),
              "encoder_counts_per_turn");
    EXPECT_EQ(refused({{ROVER_encoder_counts_per_turn, 900000}, {ROVER_encoder_absurd_rad_s, 900}}), "encoder_counts_per_turn");
    EXPECT_EQ(refused({{ROVER_stall_current_A, 2.3f}}), "stall_current_A"); // 7.2 V/3.24 ohm = 2.22 A
    EXPECT_EQ(refused({{ROVER_current_A_per_count, 0.0005f}}), "current_offset_count_0");
    EXPECT_EQ(refused({{ROVER_current_offset_count_3, 300}}), "current_offset_count_3");
    EXPECT_EQ(refused({{ROVER_current_continuous_A, 1.7f}}), "current_continuous_A"); // 1.7^2 * 3.24 * 12 = 112 K
    EXPECT_EQ(refused({{ROVER_winding_J_K, 0.01f}, {ROVER_winding_K_W, 1}}), "winding_J_K");
    EXPECT_EQ(refused({{ROVER_battery_min_V, 7.5f}}), "battery_min_V");
    EXPECT_EQ(refused({{ROVER_battery_V_per_count, 0.001f}}), "battery_V_per_count");
    EXPECT_EQ(refused({{ROVER_wheel_mask, 2.5f}}), "wheel_mask");
    EXPECT_EQ(refused({{ROVER_wheel_kp_s, 0.7f}}), "wheel_kp_s"); // 118 * 0.7 * 0.02 = 1.65 rad
}

TEST(ControlConfigCheck, a_reason_tells_the_mend) {
    const std::string reason = make({{ROVER_stall_current_A, 2.3f}}).refusal.reason;
    EXPECT_NE(reason.find("lower it"), std::string::npos) << reason;
}

// A rover of two wheels: nothing is asked of the others, whatever stands in their fields.
TEST(ControlConfig, wheels_that_are_not_there_are_neither_waited_for_nor_driven) {
    const Made made = make({{ROVER_wheel_mask, 3}});
    EXPECT_EQ(made.refusal.key, nullptr);
    const uint32_t absent = 0xcu * FRAME_ENCODER_0 | 0xcu * FRAME_CURRENT_0 | 0xcu * FRAME_BRIDGE_0;
    control_state_t state;
    control_reset(&made.config, &state);
    command_t command{};
    command.mode = MODE_PLATFORM_SPEED;
    command.platform_speed_m_s = 0.3f;
    trace_t trace{};
    for (uint32_t tick = 0; tick < 300; ++tick) {
        sensor_frame_t frame{};
        frame.tick = tick, frame.elapsed_ticks = 1, frame.present = FRAME_ALL & ~(absent | FRAME_TIME);
        for (int i = 0; i < WHEEL_COUNT; ++i) // 50 pulses a tick: 5.2 rad/s; of what is not there, noise
            frame.encoder_count[i] = i < 2 ? static_cast<int32_t>(50 * tick) : static_cast<int32_t>(tick * 2654435761u),
            frame.current_count[i] = i < 2 ? 2148 : static_cast<uint16_t>(tick * 977);
        frame.battery_count = 1800;
        frame.radar_samples = 5, frame.radar_sequence = 5 * tick;
        for (uint32_t k = 0; k < 5; ++k) frame.radar_count[k] = static_cast<uint16_t>(tick * 7919u % 200u + 412u);
        trace = control_step(&made.config, &state, &command, &frame);
        EXPECT_EQ(trace.faults & ~static_cast<uint32_t>(FAULT_SPEED_DISAGREE | FAULT_ENCODER_CIRCUIT | FAULT_SPEED_BEYOND), 0u) << tick;
        for (int i = 2; i < WHEEL_COUNT; ++i) {
            EXPECT_EQ(trace.wheel[i].duty, 0.0f);
            EXPECT_EQ(trace.wheel[i].speed_rad_s, 0.0f);
            EXPECT_FALSE(trace.wheel[i].slip_valid);
        }
    }
    EXPECT_NEAR(trace.wheel[0].speed_rad_s, 50 * 6.2831853f / 6000 * 100, 0.01f);
}

// A mask of no wheel at all (which the check refuses) ends a self-test, it drives no fifth motor.
TEST(ControlConfig, a_self_test_of_no_wheels_ends) {
    control_config_t config = rover_config_default();
    config.self_test.wheels = 0;
    config.self_test.required = 0;
    self_test_state_t state;
    self_test_result_t result;
    self_test_begin(&state, &result);
    trace_t trace{};
    trace.battery_voltage_V = 7.2f;
    sensor_frame_t frame{};
    for (uint32_t tick = 0; tick < 200 && !result.done; ++tick) {
        const command_t command = self_test_step(&config.self_test, &config.sense, &state, &frame, &trace, &result);
        for (const float duty : command.duty) EXPECT_EQ(duty, 0.0f);
    }
    EXPECT_TRUE(result.done);
}

// Signs and offsets of the converters, each wheel its own.
TEST(ControlConfig, signs_and_offsets_reach_the_measurement) {
    const Made made = make({{ROVER_encoder_sign_1, -1},
                            {ROVER_current_offset_count_1, 2000},
                            {ROVER_battery_offset_count, -100},
                            {ROVER_accel_offset_count, 25},
                            {ROVER_gyro_offset_count, -40}});
    ASSERT_EQ(made.refusal.key, nullptr);
    sense_state_t state{};
    sensor_frame_t frame{};
    frame.present = 0x7ffu;
    frame.battery_count = 1700;
    frame.accel_x_count = 25;
    frame.gyro_z_count = -40;
    for (int i = 0; i < WHEEL_COUNT; ++i) frame.current_count[i] = 2000;
    sense_measure(&made.config.sense, &state, &frame);
    frame.encoder_count[0] = frame.encoder_count[1] = 40;
    const sense_output_t out = sense_measure(&made.config.sense, &state, &frame);
    EXPECT_FLOAT_EQ(out.speed_rad_s[1], -out.speed_rad_s[0]);
    EXPECT_FLOAT_EQ(out.accel_rad_s2[1], -out.accel_rad_s2[0]);
    EXPECT_GT(out.speed_rad_s[0], 4.0f);
    EXPECT_FLOAT_EQ(out.current_A[0], -0.096f);
    EXPECT_EQ(out.current_A[1], 0.0f);
    EXPECT_FLOAT_EQ(out.battery_V, 7.2f);
    EXPECT_EQ(out.accel_x_m_s2, 0.0f);
    EXPECT_EQ(out.gyro_z_rad_s, 0.0f);
}

// A value every quarter of a window, or later where that would be sooner than 80 ms; beyond 3200 Hz a whole window is shorter.
TEST(RoverParameters, two_values_are_eighty_milliseconds_apart_or_more) {
    rover_parameters_t parameters;
    rover_parameters_reference(&parameters);
    for (const double rate_Hz : {100.0, 512.0, 799.0, 800.0, 810.0, 1600.0, 1620.0, 2400.0, 2500.0, 3200.0, 5000.0}) {
        doppler_template_t beam = doppler_template_mdu1130;
        beam.sample_rate_Hz = static_cast<float>(rate_Hz);
        parameters.beam = &beam;
        control_config_t config;
        control_config_build(&parameters, &config);
        int hop = 64;
        while (hop < 256 && hop < 0.08 * rate_Hz - 1e-6) hop += 64;
        EXPECT_EQ(config.doppler.hop, hop) << rate_Hz;
    }
}

} // namespace
