#include "rover_config.h"

#include "doppler_template.h"
#include "fixed.h"

static const float tick_s = 0.01f;            // [s] dT of (13)
static const float ticks_per_s = 100.0f;      // exact, where tick_s is not
static const float rate_tolerance_Hz = 0.01f; // [Hz] a converter's clock in a description

const doppler_template_t *doppler_template_of(int32_t radar)
{
    switch (radar) {
    case ROVER_RADAR_MDU1130:
        return &doppler_template_mdu1130;
    case ROVER_RADAR_DJ_2:
        return &doppler_template_dj_radar_2;
    case ROVER_RADAR_DJ_3:
        return &doppler_template_dj_radar_3;
    case ROVER_RADAR_DRS1000:
        return &doppler_template_drs1000;
    default:
        return 0;
    }
}

// Nearest whole number, held in the range of 16 bits unsigned and signed.
static int32_t whole(float value)
{
    const float held = fixed_clamp(fixed_finite(value), -65535.0f, 65535.0f);
    return held < 0.0f ? (int32_t)(held - 0.5f) : (int32_t)(held + 0.5f);
}

// --- the parts

static void build_sense(const float *v, sense_config_t *sense)
{
    const float rad_per_count = 6.28318531f / v[ROVER_encoder_counts_per_turn];
    sense->encoder_rad_per_count = rad_per_count;
    sense->speed_rad_s_per_count = rad_per_count / tick_s;
    sense->accel_rad_s2_per_count = rad_per_count / (16.0f * tick_s * tick_s);
    sense->current_A_per_count = v[ROVER_current_A_per_count];
    sense->battery_V_per_count = v[ROVER_battery_V_per_count];
    sense->accel_m_s2_per_count = v[ROVER_accel_m_s2_per_count];
    sense->gyro_rad_s_per_count = v[ROVER_gyro_rad_s_per_count];
    sense->level_m_s2_per_q8 = v[ROVER_accel_m_s2_per_count] / 256.0f;
    const float gravity_q8 = 256.0f * 9.81f / v[ROVER_accel_m_s2_per_count];
    const float turn_q52 = v[ROVER_gyro_rad_s_per_count] * tick_s * 1.759218604e13f; // 2^52/256
    const bool fine = gravity_q8 < 16777216.0f && turn_q52 < 2147483520.0f;          // as it is for any gyro that could tell
    sense->lean.gravity_q8 = fine ? (int32_t)(gravity_q8 + 0.5f) : 0;
    sense->lean.turn_q52 = fine ? (int32_t)turn_q52 : 0;
    sense->lean.sudden_q8 = fine ? (int32_t)(256.0f * 0.05f / v[ROVER_gyro_rad_s_per_count] + 0.5f) : 0; // 3 deg/s, assumed
    sense->lean.calm_count = fine ? whole(0.035f / v[ROVER_gyro_rad_s_per_count]) + 1 : 0;               // 2 deg/s, assumed
    sense->lean.steep_q8 = fine ? (int32_t)(0.05f * gravity_q8 + 0.5f) : 0;                              // 3 deg, assumed
    for (int32_t i = 0; i < WHEEL_COUNT; i++) {
        sense->encoder_sign[i] = v[ROVER_encoder_sign_0 + i] < 0.0f ? -1 : 1;
        sense->current_offset_count[i] = whole(v[ROVER_current_offset_count_0 + i]);
    }
    sense->battery_offset_count = whole(v[ROVER_battery_offset_count]);
    sense->accel_offset_count = whole(v[ROVER_accel_offset_count]);
    sense->gyro_offset_count = whole(v[ROVER_gyro_offset_count]);
    sense->current_max_count = whole(v[ROVER_current_max_count]);
    sense->battery_max_count = whole(v[ROVER_battery_max_count]);
    sense->radar_max_count = whole(v[ROVER_radar_max_count]);
    sense->encoder_step_max = whole(v[ROVER_encoder_absurd_rad_s] / (rad_per_count * ticks_per_s));
}

// The circuit of a motor, and what it may be wrong by: docs/firmware.md.
static void build_circuit(const float *v, circuit_config_t *circuit, sense_config_t *sense)
{
    const float V = v[ROVER_battery_voltage_V];
    const float Ra = v[ROVER_resistance_ohm];
    const circuit_config_t built = {
        .resistance_ohm = Ra,
        .back_emf_Vs = v[ROVER_back_emf_Vs_rad],
        .per_back_emf_1_Vs = 1.0f / v[ROVER_back_emf_Vs_rad],
        .contradict_V = 0.22f * V, // 1.6 V of 7.2: drop of bridge and brushes, and a bridge's dead time, of which 1.5 V are known: assumed
        .contradict_current = 0.35f, // a winding of copper 95 K warmer: 37 %
        .contradict_speed = 0.25f,   // a magnet as warm, a divider 10 % off, rounded up: assumed
        .open_A = 0.02f * V / Ra,    // four sigma of the current sensor's noise, assumed
        .open_V = 0.07f * V,         // half a volt of 7.2: drop of a bridge and of brushes, assumed
        .dead_V = 0.22f * V,         // as above: behind a dead band no current flows either
        .open_speed = 0.1f,          // a current of nothing has no winding to be wrong by
        .jump_rad_s = tick_s * v[ROVER_torque_constant_Nm_A] * V / (Ra * v[ROVER_inertia_kg_m2]), // (4)
        .hold_ticks = 3,
        .refused_ticks = 30,
        .contradict_looks = 8, // 0.32 s
        .open_looks = 6,       // 0.24 s
    };
    *circuit = built;
    sense->encoder_jump_max = 1 + whole(built.jump_rad_s / sense->speed_rad_s_per_count);
}

// A quarter of a window, or more where that would be less than 80 ms: between two values the search for lines and the filter's chores need
// ticks of their own. Beyond 3200 Hz a whole window is shorter.
static int32_t hop_of(float rate_Hz)
{
    int32_t hop = 64;
    while (hop < FFT_LENGTH && (float)hop < 0.08f * rate_Hz) {
        hop += 64;
    }
    return hop;
}

static void build_doppler(const rover_parameters_t *parameters, doppler_config_t *doppler)
{
    const doppler_template_t *beam = rover_template(parameters);
    doppler->beam = beam != 0 ? beam : &doppler_template_mdu1130;
    doppler->method = DOPPLER_LIKELIHOOD;
    doppler->offset_count = whole(parameters->value[ROVER_radar_offset_count]);
    doppler->max_count = whole(parameters->value[ROVER_radar_max_count]);
    doppler->per_tick_q8 = whole(doppler->beam->sample_rate_Hz * tick_s * 256.0f);
    doppler->per_sample_s = 1.0f / doppler->beam->sample_rate_Hz;
    doppler->hop = hop_of(doppler->beam->sample_rate_Hz);
    doppler->scale = parameters->value[ROVER_doppler_scale];
    doppler->quiet_power_count2 = (uint32_t)whole(fixed_clamp(parameters->value[ROVER_radar_quiet_count2], 0.0f, 65535.0f));
}

// What does not depend on the rover: the accelerometer's and the radar's noise, and the estimator's patience.
// What does: the window's length, and what the radar's spectrum tells at best and cannot tell at all; each ratio is 1 for the reference.
static void build_ground_speed(const float *v, const doppler_template_t *beam, ground_speed_config_t *ground_speed)
{
    const float longer = 2.0f / beam->window.per_s; // than half a second
    const float middle = 4.0f * beam->window.tau_s; // its age over the 0.25 s of (10)
    const float deaf = beam->deaf;
    const float gyro_mean_s = 1.5f;  // t1 of (16): the bias follows a ramp within about 1 s
    const float gyro_learn_s = 3.0f; // t2: twice that, for a damping of 0.7
    const float gyro_lag_s = 0.36f;  // by which a mean of the lean is behind: 32 ticks, and those that are busy
    const float gyro_q8_s_m = 256.0f / (9.81f * v[ROVER_gyro_rad_s_per_count]);
    const ground_speed_config_t method = {
        .method = GROUND_SPEED_BIAS,
        .window = &beam->window,
        .tick_s = tick_s,
        .per_tick_1_s = ticks_per_s,
        .tick_q20_s = tick_s * 1048576.0f,
        .speed_noise_m2_s2 = 4e-6f,     // [m^2/s^2] per tick: (0.2 m/s^2 T)^2, accelerometer noise assumed
        .speed_noise_max_m2_s2 = 4e-4f, // (2 m/s^2 T)^2, assumed: above, it is no noise
        .bias_noise_m2_s4 = 5e-7f,      // [m^2/s^4] per tick: 5e-5 per second; jumps are found by (4)
        .blind_noise_m2_s2 = 7.5e-4f,   // without an accelerometer: 0.5 m/s^2 that lasts for 0.3 s, assumed
        .bias_start_m_s2 = 1.0f,        // 6 deg: slopes to 10 are 1.7 of it
        .bias_max_m_s2 = 3.0f,          // 17 deg of slope and 0.1 m/s^2 of the device
        .speed_max_m_s = beam->speed_m_s[beam->speeds - 1] < 9.0f ? 10.0f : 100.0f, // no rover; cars that a roadside module hears
        .doppler_noise_m2_s2 = 3e-5f * (deaf * deaf),
        .doppler_noise_m_s = 5.8e-4f * beam->spread,
        .doppler_accel_s2 = 0.004f * (longer * longer),
        .deaf_noise_m2_s2 = 4e-4f * (deaf * deaf), // (2 cm/s)^2
        .per_slow_s_m = 1.0f / (0.12f * deaf),
        .lowest_m_s = 1.02f * beam->speed_m_s[0] * v[ROVER_doppler_scale], // the grid's steps are 4 %
        .doppler_spread_s = beam->line ? 0.0f : 0.25f * longer,
        .gate_sigma = 3.5f,
        .gate_patience = 4,
        .jump_share = 0.25f,  // half a second of values 0.125 s apart
        .jump_limit = 2.0f,   // [1] 2.5 settles a slope 0.2 s later and is 0.01 cm/s better in speed_bench
        .jump_m2_s4 = 0.002f, // [m^2/s^4] assumed: (0.045 m/s^2)^2, a quarter of a degree
        .agile_m2_s4 = 0.5f,  // [m^2/s^4] (0.7 m/s^2)^2: 4 deg of slope within 0.125 s, assumed
        .agile_limit = 20.0f, // exp(10) to one
        .agile_sure = 5.0f,
        .agile_drift = 0.0f,
        .agile_most = 10.0f,
        .apart_told_m_s = 0.06f,
        .apart_forget = 0.04f,
        .apart_share = 1.0f,
        .apart_least_m_s = 0.03f,
        .apart_noise = 112.0f,
        .felt_share = 2.0f * middle / (1.0f + 0.58f * middle), // 2 (1 - exp(-x)) within 0.03 for x <= 1.2
        .felt_noise = 12.5f,                                   // T/(2 T/0.25 s) per T
        .roll_told_m_s = 0.1f,                                 // a step of 2.5 deg and more: what is gentler, (5) and (7) find
        .slip_force_m_s2 = 0.3f,                               // a friction of 0.03, and more than the device's bias
        .roll_odds = 6.0f,           // exp(3) to one, assumed: an obstacle that stops the rover looks the same at first
        .roll_noise_m2_s2 = 1.5e-5f, // slip changes by 1.4 cm/s within a value's time, assumed
        .roll_share = 0.1f,          // 0.1 s
        .roll_bias_m2_s4 = 0.01f,    // the accelerometer's noise over that time: (0.06 m/s^2)^2, and the wheels'
        .agile_values = 4,           // half a second: a window's length
        .misfit_share = 0.02f,
        .misfit_max = 30.0f,
        .quiet_needed = 3,
        .lean_m_s2_per_q8 = v[ROVER_accel_m_s2_per_count] / 256.0f,
        .gyro_slow = tick_s / gyro_mean_s,
        .gyro_learns_q8_s2_m = gyro_q8_s_m * tick_s / (gyro_mean_s * gyro_learn_s),
        .gyro_turns = -v[ROVER_accel_m_s2_per_count] / 256.0f * gyro_q8_s_m / gyro_lag_s,
        .gyro_runs_m2_s6 = 0.0025f, // (0.05 m/s^3)^2: 0.3 deg/s of offset, assumed
        .gyro_sure_m_s2 = 0.05f,    // its bias moves so far by noise (outdoors_bench, calm rows), assumed
        .gyro_steady_m2_s2 = 4e-4f, // (2 cm/s)^2: twice what wheels on a calm floor make of X, assumed
        .lean_told_q8 = (int32_t)(256.0f * 0.2f / v[ROVER_accel_m_s2_per_count] + 0.5f), // [m/s^2] 0.2: 1 deg, assumed
        .quiet_noise_m2_s2 = 9e-4f * (deaf * deaf), // (0.03 m/s)^2: the band-pass blinds below 0.05 m/s
        .still_m_s = v[ROVER_still_m_s],
        .rest_m_s = 0.25f * v[ROVER_still_m_s],
        .still_needed = 25,            // 0.25 s, assumed: blocked wheels stop 0.12 m/s within 0.05 s on any soil
        .parked_needed = 100,          // 1 s: eight values of the radar that tell of no speed, assumed
        .standing_noise_m2_s2 = 1e-4f, // (1 cm/s)^2 per tick
        .slow_m_s = 0.12f * deaf,
        .loud_needed = 3,
        .sign_sure = 18.0f,  // exp(9) to one
        .wheel_spins = 6.0f, // exp(3) to one, assumed
        .wheel_odds = 2.0f,  // e to one, assumed
        .wheel_match = 14.0f,
        .wheel_pull = 0.5f,
        .against_values = 4, // half a second
        .against_odds = 4.0f,
        .force_per_s2_m = 4.0f,  // 1/(0.25 m/s^2), assumed: 25 mg of a small MEMS part
        .force_most = 12.0f,     // assumed: as a value of the radar
        .force_pull = 0.25f,     // four values share their samples
        .wheel_noise_m_s = 0.1f, // assumed
        .wheel_slip = 0.5f,
    };
    *ground_speed = method;
}

static void build_motor(const float *v, motor_config_t *motor)
{
    const float KG = v[ROVER_torque_constant_Nm_A];
    const float Ra = v[ROVER_resistance_ohm];
    motor->torque_constant_Nm_A = KG;
    motor->volt_per_speed_Vs = Ra * v[ROVER_viscous_Nms] / KG + v[ROVER_back_emf_Vs_rad];
    motor->volt_dry_V = Ra * v[ROVER_coulomb_Nm] / KG;
    motor->back_emf_Vs = v[ROVER_back_emf_Vs_rad];
    motor->resistance_ohm = Ra;
    motor->viscous_Nms = v[ROVER_viscous_Nms];
    motor->dry_Nm = v[ROVER_coulomb_Nm];
    motor->per_dry_speed_s = 1.0f / v[ROVER_dry_speed_rad_s];
    motor->inertia_kg_m2 = v[ROVER_inertia_kg_m2];
    motor->per_radius_1_m = 1.0f / v[ROVER_wheel_radius_m];
}

static void build_control(const float *v, control_config_t *config)
{
    const wheel_pid_config_t wheel_pid = {.kp_s = v[ROVER_wheel_kp_s],
                                          .ki_T_s = v[ROVER_wheel_ki_1] / ticks_per_s,
                                          .kd_s2 = 0.0f,
                                          .slew_T_rad_s = v[ROVER_wheel_slew_rad_s2] / ticks_per_s,
                                          .integral_max = 2.0f,
                                          .duty_max = 1.0f};
    const slip_pi_config_t slip_pi = {.kp = v[ROVER_slip_kp_1],
                                      .ki_T = v[ROVER_slip_ki_1_s] / ticks_per_s,
                                      .duty_max = 1.0f,
                                      .per_speed_s_m = 1.0f / v[ROVER_slip_gain_speed_m_s],
                                      .gain_min = 0.25f,
                                      .gain_max = 2.5f};
    const speed_control_config_t speed_control = {.per_radius_1_m = 1.0f / v[ROVER_wheel_radius_m],
                                                  .half_track_per_radius = v[ROVER_half_track_m] / v[ROVER_wheel_radius_m],
                                                  .kv_rad_m = v[ROVER_speed_kv_rad_m],
                                                  .ki_T_rad_m = v[ROVER_speed_ki_rad_m_s] / ticks_per_s,
                                                  .integral_max_rad_s = v[ROVER_speed_integral_max_rad_s],
                                                  .speed_max_m_s = v[ROVER_speed_max_m_s],
                                                  .yaw_rate_max_rad_s = v[ROVER_yaw_rate_max_rad_s],
                                                  .wheel_max_rad_s = v[ROVER_wheel_max_rad_s]};
    config->wheel_pid = wheel_pid;
    config->slip_pi = slip_pi;
    config->speed_control = speed_control;
    config->steering.front_m = v[ROVER_steer_front_m];
    config->steering.rear_m = v[ROVER_steer_rear_m];
    config->steering.limit_1_m = v[ROVER_steer_limit_1_m];
    config->soil_sweep.ramp_1_m = tick_s / (v[ROVER_wheel_radius_m] * v[ROVER_sweep_zero_s]); // (15)
    config->soil_sweep.duration_ticks =
        (uint32_t)(fixed_clamp(fixed_finite(v[ROVER_sweep_duration_s]), 0.0f, 36000.0f) * ticks_per_s + 0.5f);
    config->soil_sweep.wheel_max_rad_s = v[ROVER_wheel_max_rad_s];
    config->feed_forward = true;
}

static uint32_t wheel_mask(const float *v) { return (uint32_t)whole(fixed_clamp(v[ROVER_wheel_mask], 0.0f, 15.0f)); }

// FRAME_* bits of wheels that are not there: nobody waits for them.
static uint32_t absent_bits(const float *v)
{
    const uint32_t absent = ~wheel_mask(v) & 0xfu;
    return absent * FRAME_ENCODER_0 | absent * FRAME_CURRENT_0 | absent * FRAME_BRIDGE_0;
}

static void build_safety(const float *v, safety_config_t *safety)
{
    const float continuous_A = v[ROVER_current_continuous_A];
    const safety_config_t built = {
        .tick_s = tick_s,
        .required = (0xfffu | FRAME_EMERGENCY_STOP) & ~absent_bits(v),
        .patience_ticks = 7,         // off in the 8th bad tick: 80 ms, inside the 100 ms asked for
        .command_patience_ticks = 8, // 80 ms
        .missed_ticks_max = 5,       // 50 ms
        .missed_forget_ticks = 100,  // assumed: 1 % missed ticks are tolerated for ever
        .current_continuous_A2 = continuous_A * continuous_A,
        .current_continuous_A = continuous_A,
        .i2t_max_A2_ticks = v[ROVER_current_peak_A2s] * ticks_per_s,
        .stall_current_A = v[ROVER_stall_current_A],
        .stall_speed_rad_s = v[ROVER_stall_speed_rad_s],
        .stall_s = v[ROVER_stall_s],
        .heating_K_A2 = 4.0f * tick_s * v[ROVER_resistance_ohm] / v[ROVER_winding_J_K],
        .keeping = 1.0f - 4.0f * tick_s / (v[ROVER_winding_K_W] * v[ROVER_winding_J_K]),
        .temperature_rise_max_K = v[ROVER_winding_rise_max_K],
        .battery_min_V = v[ROVER_battery_min_V],
        .battery_s = v[ROVER_battery_low_s],
        .brown_out_V = 0.8f * v[ROVER_battery_min_V], // [V] assumed: what feeds the logic lets go
        .brown_out_ticks = 2,
        .radar_dead_count2 = (uint32_t)whole(0.4f * 1024.0f * fixed_clamp(v[ROVER_radar_quiet_count2], 0.0f, 100.0f)),
        .radar_dead_blocks = 1u + (uint32_t)whole(0.3f * v[ROVER_radar_rate_Hz] / 32.0f), // 0.3 s and a block: within half a second
        .sigmas = 3.0f,
        .disagree_m_s = v[ROVER_disagree_m_s],
        .disagree_ratio_m = v[ROVER_disagree_ratio] * v[ROVER_wheel_radius_m],
        .turning_rad_s = v[ROVER_disagree_m_s] / v[ROVER_wheel_radius_m],
        .disagree_s = v[ROVER_disagree_s],
    };
    *safety = built;
}

static void build_self_test(const float *v, const safety_config_t *safety, self_test_config_t *self_test)
{
    const float stall_A = v[ROVER_battery_voltage_V] / v[ROVER_resistance_ohm];
    const float pulses = v[ROVER_encoder_counts_per_turn] / 6.28318531f; // of a radian
    const self_test_config_t built = {
        .required = safety->required,
        .wheels = wheel_mask(v),
        .rest_ticks = 100,
        .pulse_ticks = 20,
        .settle_ticks = 15,
        .duty_max = 0.5f, // torque of the reference: 0.29 N m, 5.2 N at the rim: what starts one wheel up 5 deg, the others shorted
        .enough_count = 4 + whole(0.025f * pulses), // 1.4 mm of the reference's rim
        .least_count = 2 + whole(0.003f * pulses),
        .still_count = 2 + whole(0.02f * pulses), // a touch, not a motion
        .radar_offset_count = 10.0f,              // assumed: a hundredth of the converter
        .radar_dead_count2 = 0.4f * v[ROVER_radar_quiet_count2],
        .radar_noisy_count2 = 12.5f * v[ROVER_radar_quiet_count2], // 5 counts of the reference
        .radar_rest_count = whole(v[ROVER_radar_offset_count]),
        .gravity_m_s2 = 9.81f,
        .gravity_slack_m_s2 = 0.5f, // 5 %: scale and bias of a small MEMS part
        .accel_slope_m_s2 = 2.1f,   // 12 deg: steeper, no rover is tested
        .accel_m_s2_per_count = v[ROVER_accel_m_s2_per_count],
        .gyro_rad_s = 0.05f, // 3 deg/s
        .battery_V = v[ROVER_battery_min_V],
        .zero_A = 0.03f * stall_A,
        .winding_1_ohm = 1.0f / v[ROVER_resistance_ohm],
        .current_least = 0.3f, // 0.6 of it flows at least: the wheel hardly turns
    };
    *self_test = built;
}

static float share_of(uint32_t wheels)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < WHEEL_COUNT; i++) {
        count += (wheels >> i) & 1u;
    }
    return 1.0f / (float)(count > 0u ? count : 1u);
}

void control_config_build(const rover_parameters_t *parameters, control_config_t *config)
{
    const float *v = parameters->value;
    config->geometry.wheel_radius_m = v[ROVER_wheel_radius_m];
    config->geometry.half_wheelbase_m = v[ROVER_half_wheelbase_m];
    config->geometry.half_track_m = v[ROVER_half_track_m];
    config->geometry.mass_kg = v[ROVER_mass_kg];
    config->geometry.wheels = wheel_mask(v);
    config->geometry.wheel_share = share_of(config->geometry.wheels);
    build_sense(v, &config->sense);
    build_circuit(v, &config->circuit, &config->sense);
    build_doppler(parameters, &config->doppler);
    build_ground_speed(v, config->doppler.beam, &config->ground_speed);
    config->slip.wheel_radius_m = v[ROVER_wheel_radius_m];
    config->slip.valid_m_s = v[ROVER_slip_valid_m_s];
    config->slip.valid_std = 0.25f; // [1] assumed: beyond it slip does not tell a gripping wheel from a spinning one
    config->slip.rim_std_m_s =
        0.40824829f * config->sense.speed_rad_s_per_count * v[ROVER_wheel_radius_m]; // q/(T sqrt 6): docs/log_format.md
    build_motor(v, &config->motor);
    build_control(v, config);
    build_safety(v, &config->safety);
    build_self_test(v, &config->safety, &config->self_test);
}

// --- what cannot work

static control_refusal_t refuse(const char *key, const char *reason)
{
    const control_refusal_t refusal = {key, reason};
    return refusal;
}

static control_refusal_t check_ranges(const rover_parameters_t *parameters)
{
    for (int32_t i = 0; i < ROVER_PARAMETER_COUNT; i++) {
        const float value = parameters->value[i];
        if (!fixed_is_finite(value) || value < rover_parameter_low(i) || value > rover_parameter_high(i)) {
            return refuse(rover_parameter_name(i), "not finite, or outside the range of docs/rover_format.md; mend the number or its unit");
        }
    }
    for (int32_t i = 0; i < WHEEL_COUNT; i++) {
        const float sign = parameters->value[ROVER_encoder_sign_0 + i];
        if (sign > -1.0f && sign < 1.0f) {
            return refuse(rover_parameter_name(ROVER_encoder_sign_0 + i), "a sign is 1 or -1; give one of them");
        }
    }
    const float mask = parameters->value[ROVER_wheel_mask];
    if (mask > (float)whole(mask) || mask < (float)whole(mask)) {
        return refuse(rover_parameter_name(ROVER_wheel_mask), "not a sum of 1, 2, 4, 8 for the wheels 0 to 3; give 15 for all four");
    }
    const bool axle = parameters->value[ROVER_steer_front_m] > 0.0f || parameters->value[ROVER_steer_rear_m] < 0.0f;
    if (axle != (parameters->value[ROVER_steer_limit_1_m] > 0.0f)) {
        return refuse(rover_parameter_name(ROVER_steer_limit_1_m),
                      "an axle that steers (steer_front_m, steer_rear_m) and how far belong together; give both, or none");
    }
    return refuse(0, 0);
}

static control_refusal_t check_radar(const rover_parameters_t *parameters, const control_config_t *config)
{
    const float *v = parameters->value;
    const doppler_template_t *beam = rover_template(parameters);
    if (beam == 0) {
        return refuse("radar",
                      "no template of this radar; use MDU1130, DJ Radar II, DJ Radar III, DRS1000, or give one (`traction rover`)");
    }
    const float off_Hz = v[ROVER_radar_rate_Hz] - beam->sample_rate_Hz;
    if (off_Hz > rate_tolerance_Hz || off_Hz < -rate_tolerance_Hz) {
        return refuse("radar_rate_Hz",
                      "the radar's template is made for another rate; sample at 512 Hz, or let `traction rover` make its template");
    }
    if (parameters->beam == 0 && (v[ROVER_radar_depression_deg] < 15.0f || v[ROVER_radar_depression_deg] > 25.0f)) {
        return refuse("radar_depression_deg", "the templates are made for 20 deg, which a scale mends within 5; mount it at 15 to 25 deg");
    }
    if (config->speed_control.speed_max_m_s > beam->speed_m_s[beam->speeds - 1]) {
        return refuse("speed_max_m_s", "faster than the radar hears at this rate; lower it, or choose a radar of longer wave");
    }
    if (v[ROVER_radar_offset_count] < 0.25f * v[ROVER_radar_max_count] || v[ROVER_radar_offset_count] > 0.75f * v[ROVER_radar_max_count]) {
        return refuse("radar_offset_count", "an echo around it meets the converter's rail; bring it near the middle of the range");
    }
    return refuse(0, 0);
}

static control_refusal_t check_speeds(const rover_parameters_t *parameters, const control_config_t *config)
{
    const float *v = parameters->value;
    const float wheel_max = config->speed_control.wheel_max_rad_s;
    if (wheel_max * config->motor.back_emf_Vs > v[ROVER_battery_voltage_V]) {
        return refuse("wheel_max_rad_s", "beyond the no-load speed V/ke, where no duty reaches; lower it");
    }
    if (config->speed_control.speed_max_m_s > wheel_max * config->slip.wheel_radius_m) {
        return refuse("speed_max_m_s", "faster than the wheels may turn (wheel_max_rad_s * wheel_radius_m); lower it");
    }
    if (v[ROVER_encoder_absurd_rad_s] <= wheel_max) {
        return refuse("encoder_absurd_rad_s", "speeds that the wheels may have would count as absurd; give more than wheel_max_rad_s");
    }
    if (config->sense.encoder_step_max < 4) {
        return refuse("encoder_counts_per_turn", "less than four pulses a tick at encoder_absurd_rad_s tell no speed; use a finer encoder");
    }
    if (v[ROVER_encoder_absurd_rad_s] * v[ROVER_encoder_counts_per_turn] > 65535.0f * 6.28318531f * ticks_per_s) {
        return refuse("encoder_counts_per_turn", "more than 65535 pulses in a tick; use a coarser encoder or lower encoder_absurd_rad_s");
    }
    return refuse(0, 0);
}

static control_refusal_t check_currents(const rover_parameters_t *parameters, const control_config_t *config)
{
    const float *v = parameters->value;
    const safety_config_t *safety = &config->safety;
    const float stalled_A = v[ROVER_battery_voltage_V] / v[ROVER_resistance_ohm];
    const float most_A = safety->stall_current_A > safety->current_continuous_A ? safety->stall_current_A : safety->current_continuous_A;
    if (safety->stall_current_A >= stalled_A) {
        return refuse("stall_current_A", "a stalled wheel takes V/Ra, which is less: a stall would never be seen; lower it");
    }
    for (int32_t i = 0; i < WHEEL_COUNT; i++) {
        const int32_t offset = config->sense.current_offset_count[i];
        const int32_t above = config->sense.current_max_count - offset;
        const int32_t room = above < offset ? above : offset;
        if ((float)(room - 1) * config->sense.current_A_per_count <= most_A) {
            return refuse(rover_parameter_name(ROVER_current_offset_count_0 + i),
                          "the converter's rail comes before the current limits; mend offset, current_A_per_count or current_max_count");
        }
    }
    if (safety->current_continuous_A2 * v[ROVER_resistance_ohm] * v[ROVER_winding_K_W] >= safety->temperature_rise_max_K) {
        return refuse("current_continuous_A", "a wheel limited to it still overheats (I^2 Ra R_th reaches winding_rise_max_K); lower it");
    }
    if (!(safety->keeping > 0.0f && safety->keeping < 1.0f)) {
        return refuse("winding_J_K",
                      "the winding's time constant is below four ticks or beyond what float resolves; mend winding_J_K or winding_K_W");
    }
    if (safety->battery_min_V >= v[ROVER_battery_voltage_V]) {
        return refuse("battery_min_V", "not below the battery's own voltage: it would always count as low; lower it");
    }
    if ((float)(config->sense.battery_max_count - 1 - config->sense.battery_offset_count) * config->sense.battery_V_per_count <=
        v[ROVER_battery_voltage_V]) {
        return refuse("battery_V_per_count", "the converter's rail comes before the battery's voltage; mend scale, offset or rail");
    }
    return refuse(0, 0);
}

// Crossover k Kp times the delay of 20 ms (half a tick of hold, half of difference, one of computation) against the phase left.
static control_refusal_t check_loop(const rover_parameters_t *parameters, const control_config_t *config)
{
    const float *v = parameters->value;
    const float gain = v[ROVER_battery_voltage_V] * v[ROVER_torque_constant_Nm_A] / (v[ROVER_resistance_ohm] * v[ROVER_inertia_kg_m2]);
    if (gain * config->wheel_pid.kp_s * 0.02f >= 1.57f) {
        return refuse("wheel_kp_s", "the wheel's loop is unstable: crossover times 20 ms of delay reaches 90 deg; lower it");
    }
    return refuse(0, 0);
}

control_refusal_t control_config_check(const rover_parameters_t *parameters, const control_config_t *config)
{
    control_refusal_t refusal = check_ranges(parameters);
    if (refusal.key == 0) {
        refusal = check_radar(parameters, config);
    }
    if (refusal.key == 0) {
        refusal = check_speeds(parameters, config);
    }
    if (refusal.key == 0) {
        refusal = check_currents(parameters, config);
    }
    if (refusal.key == 0) {
        refusal = check_loop(parameters, config);
    }
    return refusal;
}

// --- the reference

control_config_t rover_config_default(void)
{
    rover_parameters_t parameters;
    control_config_t config;
    rover_parameters_reference(&parameters);
    control_config_build(&parameters, &config);
    return config;
}

void control_config_make_paper(control_config_t *config)
{
    config->doppler.method = DOPPLER_ARGMAX;
    config->doppler.hop = FFT_LENGTH; // one value every 0.5 s
    config->ground_speed.method = GROUND_SPEED_PAPER;
    // With Q per tick and one value every 50 ticks a gain of 0.22 has a time constant of 2 s: Q = R 0.22^2/(1 - 0.22)/50
    config->ground_speed.doppler_noise_m2_s2 = 4e-4f; // (0.02 m/s)^2: 10 % at 0.2 m/s, (12)
    config->ground_speed.speed_noise_m2_s2 = 5e-7f;
    config->ground_speed.speed_noise_max_m2_s2 = 5e-7f;
    config->sense.lean.gravity_q8 = 0;            // (13) takes the accelerometer as it is
    config->ground_speed.bias_noise_m2_s4 = 0.0f; // and has no bias
    config->ground_speed.bias_start_m_s2 = 0.0f;
    config->wheel_pid.slew_T_rad_s = 1e6f;
    config->wheel_pid.kd_s2 = 0.005f * config->wheel_pid.kp_s; // the paper names a PID, no gains: 5 ms of derivative time, assumed
    config->feed_forward = false;
    config->speed_control.ki_T_rad_m = 0.0f; // (22) has no integral
    config->slip_pi.per_speed_s_m = 0.0f;    // (23) has no schedule
    config->slip_pi.gain_min = 1.0f;
    config->slip_pi.gain_max = 1.0f;
}

control_config_t rover_config_paper(void)
{
    control_config_t config = rover_config_default();
    control_config_make_paper(&config);
    return config;
}
