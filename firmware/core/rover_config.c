#include "rover_config.h"

#include "doppler_template.h"

// --- table I and text (docs/sources.md section 3)
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

static sense_config_t sense_default(void)
{
    const sense_config_t sense = {
        .encoder_rad_per_count = encoder_rad_per_count,
        .speed_rad_s_per_count = encoder_rad_per_count / tick_s,
        .accel_rad_s2_per_count = encoder_rad_per_count / (16.0f * tick_s * tick_s),
        .current_A_per_count = 0.002f,   // [A] assumed: 12 bit over +-4.1 A
        .battery_V_per_count = 0.004f,   // [V] assumed: 12 bit over 16.4 V
        .accel_m_s2_per_count = 0.004f,  // [m/s^2] assumed, about 0.4 mg
        .gyro_rad_s_per_count = 0.0005f, // [rad/s] assumed
        .current_offset_count = 2048,    // [count] assumed: offset binary, 12 bit
        .current_max_count = 4095,
        .battery_max_count = 4095,
        .radar_max_count = 1023,
        .encoder_step_max = 573, // [count/tick] 60 rad/s, twice the no-load speed 7.2 V/ke = 27 rad/s (assumed margin)
    };
    return sense;
}

static doppler_config_t doppler_default(void)
{
    const doppler_config_t doppler = {
        .beam = &doppler_template_mdu1130,
        .method = DOPPLER_LIKELIHOOD,
        .offset_count = 512, // [count] assumed: mid-scale of 10 bit
        .hop = 64,
        .scale = 1.0f,           // until `traction calibrate` has measured it
        .quiet_power_count2 = 2, // [count^2] assumed
    };
    return doppler;
}

static ground_speed_config_t ground_speed_default(void)
{
    const ground_speed_config_t ground_speed = {
        .method = GROUND_SPEED_BIAS,
        .tick_s = tick_s,
        .speed_noise_m2_s2 = 4e-6f,     // [m^2/s^2] per tick: (0.2 m/s^2 T)^2, accelerometer noise assumed
        .speed_noise_max_m2_s2 = 4e-4f, // (2 m/s^2 T)^2, assumed: above, it is no noise
        .bias_noise_m2_s4 = 5e-7f,      // [m^2/s^4] per tick: 5e-5 per second; jumps are found by (4)
        .bias_start_m_s2 = 0.1f,
        .bias_max_m_s2 = 1.0f,
        .doppler_noise_m2_s2 = 3e-5f,
        .doppler_noise_m_s = 5.8e-4f,
        .doppler_accel_s2 = 0.0125f,
        .gate_sigma = 3.5f,
        .gate_patience = 8,
        .jump_share = 0.25f,  // half a second of values 0.125 s apart
        .jump_limit = 2.0f,   // [1] 2.5 settles a slope 0.2 s later and is 0.01 cm/s better in speed_bench
        .jump_m2_s4 = 0.002f, // [m^2/s^4] assumed: (0.045 m/s^2)^2, a quarter of a degree
        .quiet_needed = 3,
        .quiet_noise_m2_s2 = 9e-4f,    // (0.03 m/s)^2: the band-pass blinds below 0.05 m/s
        .still_m_s = 0.006f,           // one encoder pulse a tick
        .still_needed = 25,            // 0.25 s, assumed: blocked wheels stop 0.12 m/s within 0.05 s on any soil
        .standing_noise_m2_s2 = 1e-4f, // (1 cm/s)^2 per tick
        .sign_hysteresis_m_s = 0.12f,
    };
    return ground_speed;
}

static safety_config_t safety_default(void)
{
    const safety_config_t safety = {
        .tick_s = tick_s,
        .required = 0xfffu,
        .patience_ticks = 7,         // off in the 8th bad tick: 80 ms, inside the 100 ms asked for
        .command_patience_ticks = 8, // 80 ms
        .missed_ticks_max = 5,       // 50 ms
        .missed_forget_ticks = 100,  // assumed: 1 % missed ticks are tolerated for ever
        .current_continuous_A2 = 2.25f,
        .current_continuous_A = 1.5f, // [A] assumed: above the 1.35 A of full traction on concrete (5.6 N R + Gr)/KG
        .i2t_max_A2_ticks = 800.0f,   // 8 A^2 s assumed: 3 s of stall at 2.2 A
        .stall_current_A = 1.4f,      // [A] assumed: above the current of a wheel held by full traction
        .stall_speed_rad_s = 0.3f,    // [rad/s] assumed
        .stall_s = 1.0f,              // [s] assumed
        .heating_K_A2 = 4.0f * tick_s * resistance_ohm / 5.0f, // C_th = 5 J/K assumed
        .keeping = 1.0f - 4.0f * tick_s / (12.0f * 5.0f),      // R_th = 12 K/W assumed: time constant 60 s
        .temperature_rise_max_K = 95.0f,                       // [K] assumed: class B winding at 35 C
        .battery_min_V = 5.4f,                                 // [V] assumed: 0.9 V per cell of 6
        .battery_s = 0.5f,                                     // [s] assumed
        .disagree_m_s = 0.15f,                                 // [m/s] assumed
        .disagree_ratio = 1.5f,                                // [1] assumed
        .disagree_s = 1.0f,                                    // [s] assumed
    };
    return safety;
}

control_config_t rover_config_default(void)
{
    const control_config_t config = {
        .geometry = {.wheel_radius_m = wheel_radius_m,
                     .half_wheelbase_m = half_wheelbase_m,
                     .half_track_m = half_track_m,
                     .mass_kg = mass_kg},
        .sense = sense_default(),
        .doppler = doppler_default(),
        .ground_speed = ground_speed_default(),
        .slip = {.wheel_radius_m = wheel_radius_m, .valid_m_s = 0.05f}, // [m/s] the band-pass blinds the radar below
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
                          .yaw_rate_max_rad_s = 4.0f,                 // [rad/s] assumed
                          .wheel_max_rad_s = 25.0f},                  // [rad/s] below the no-load speed of 27
        .soil_sweep = {.ramp_1_m = tick_s / (wheel_radius_m * 10.0f), // t_zero = 10 s, section 6
                       .duration_ticks = 2000,
                       .wheel_max_rad_s = 25.0f},
        .safety = safety_default(),
        .feed_forward = true,
    };
    return config;
}

control_config_t rover_config_paper(void)
{
    control_config_t config = rover_config_default();
    config.doppler.method = DOPPLER_ARGMAX;
    config.doppler.hop = FFT_LENGTH; // one value every 0.5 s
    config.ground_speed.method = GROUND_SPEED_PAPER;
    // With Q per tick and one value every 50 ticks a gain of 0.22 has a time constant of 2 s: Q = R 0.22^2/(1 - 0.22)/50
    config.ground_speed.doppler_noise_m2_s2 = 4e-4f; // (0.02 m/s)^2: 10 % at 0.2 m/s, (12)
    config.ground_speed.speed_noise_m2_s2 = 5e-7f;
    config.ground_speed.speed_noise_max_m2_s2 = 5e-7f;
    config.ground_speed.bias_noise_m2_s4 = 0.0f; // (13) has no bias
    config.ground_speed.bias_start_m_s2 = 0.0f;
    config.wheel_pid.slew_T_rad_s = 1e6f;
    config.feed_forward = false;
    config.speed_control.ki_T_rad_m = 0.0f; // (22) has no integral
    config.slip_pi.per_speed_s_m = 0.0f;    // (23) has no schedule
    config.slip_pi.gain_min = 1.0f;
    config.slip_pi.gain_max = 1.0f;
    return config;
}
