// calibrate finds a radar that was mounted or scaled wrongly, and tune finds the motor of table I, both from the simulated rover.
#include "host_tools/calibrate/calibrate.h"
#include "host_tools/calibrate/tune.h"
#include "host_tools/simulate/simulate.h"

#include "firmware/app/parameters.h"
#include "firmware/core/rover_config.h"
#include "hal/sim/sim_rover.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>

using namespace traction;

namespace {

log::Log drive(const std::string &radar, const std::string &effect = "", int seed = 3) {
    const std::string text = "duration_s = 60\nseed = " + std::to_string(seed) + "\n[ground]\nsoil = \"concrete\"\n" + radar +
                             "[[drive]]\nfor_s = 20.0\nmode = \"platform_speed\"\nspeed_m_s = 0.3\n[[drive]]\nfor_s = 20.0\nmode = "
                             "\"platform_speed\"\nspeed_m_s = 0.5\n"
                             "[[drive]]\nfor_s = 20.0\nmode = \"platform_speed\"\nspeed_m_s = 0.7\n";
    SimulateOptions options;
    if (!effect.empty()) options.effects = {sim::parse_effect(effect)};
    return simulate(sim::parse_scenario(text, "calibrate.toml"), options).log;
}

} // namespace

TEST(Calibrate, finds_the_scale_within_its_own_uncertainty_from_camera_and_from_wheels) {
    const log::Log right = drive(""), scaled = drive("", "radar_scale:change=0.06");
    for (const CalibrationTruth truth : {CalibrationTruth::camera, CalibrationTruth::wheels}) {
        const Calibration a = calibrate(right, truth, 0.057), b = calibrate(scaled, truth, 0.057);
        // 450 windows of 2.5 % (docs/evidence.md section 3), four of which share samples: 0.25 %
        EXPECT_LT(a.scale_std, 0.006);
        EXPECT_GT(a.scale_std, 0.0005);
        // three sigma; 0.3 % between the radar's geometry and the template's; wheels: plus 0.5 % of slip where the rover pulls itself
        EXPECT_NEAR(a.scale, 1, 3 * a.scale_std + 0.003 + (truth == CalibrationTruth::wheels ? 0.005 : 0));
        EXPECT_NEAR(a.scale / b.scale, 1.06, 3 * std::hypot(a.scale_std, b.scale_std));
        std::printf("%s: scale %.4f +- %.4f; radar 6 %% high: %.4f +- %.4f\n", a.truth.c_str(), a.scale, a.scale_std, b.scale, b.scale_std);
    }
}

TEST(Calibrate, tells_a_mounting_error_by_its_direction_and_size) {
    const Calibration level = calibrate(drive(""), CalibrationTruth::camera, 0.057);
    const Calibration steep = calibrate(drive("[radar]\nmounting_error_deg = 6.0\n"), CalibrationTruth::camera, 0.057);
    const double found = steep.angle_deg - level.angle_deg,
                 std = std::hypot(steep.angle_known_ground_std_deg, level.angle_known_ground_std_deg);
    EXPECT_NEAR(found, 6, 3 * std); // the same ground: its exponent falls out
    EXPECT_GT(found, 2);
    EXPECT_LT(std, 4);
    EXPECT_GT(std, 0.1);
    std::printf("mounted 6 deg steeper: found %.1f +- %.1f deg, level %.1f +- %.1f deg; were the ground known +- %.1f and %.1f\n",
                steep.angle_deg, steep.angle_std_deg, level.angle_deg, level.angle_std_deg, steep.angle_known_ground_std_deg,
                level.angle_known_ground_std_deg);
}

// Truth 20 deg on each. Eight drives: their mean is right to 3/sqrt(8) of one's uncertainty. Before, all of them were 2 to 3 deg too steep.
TEST(Calibrate, angle_of_a_level_radar_is_right_on_the_mean_of_eight_drives) {
    double sum = 0, claimed = 0;
    for (int seed = 1; seed <= 8; seed++) {
        const Calibration c = calibrate(drive("", "", seed), CalibrationTruth::camera, 0.057);
        EXPECT_NEAR(c.angle_deg, 20, 3 * c.angle_known_ground_std_deg) << seed;
        sum += c.angle_deg / 8;
        claimed += c.angle_known_ground_std_deg / 8;
        std::printf("seed %d: scale %.4f +- %.4f, angle %.1f +- %.1f deg, the ground known +- %.1f\n", seed, c.scale, c.scale_std,
                    c.angle_deg, c.angle_std_deg, c.angle_known_ground_std_deg);
    }
    EXPECT_NEAR(sum, 20, 3 * claimed / std::sqrt(8.0));
    std::printf("mean %.2f deg, one claims +- %.2f\n", sum, claimed);
}

TEST(Calibrate, says_that_the_ground_may_be_taken_for_an_angle_and_covers_it) {
    for (const int exponent : {0, 2}) {
        const Calibration c =
            calibrate(drive("[radar]\nground_exponent = " + std::to_string(exponent) + ".0\n"), CalibrationTruth::camera, 0.057);
        const double known = c.angle_by_exponent_deg[static_cast<std::size_t>(exponent)];
        std::printf("exponent %d: %.1f +- %.1f deg; by exponent %.1f, %.1f, %.1f\n", exponent, c.angle_deg, c.angle_std_deg,
                    c.angle_by_exponent_deg[0], c.angle_by_exponent_deg[1], c.angle_by_exponent_deg[2]);
        EXPECT_NEAR(known, 20, 3 * c.angle_known_ground_std_deg) << exponent; // who knows the ground knows the angle
        EXPECT_GT(std::fabs(c.angle_deg - 20), c.angle_known_ground_std_deg)
            << exponent; // who does not is off by more than the radar's spread,
        EXPECT_NEAR(c.angle_deg, 20, 2.5 * c.angle_std_deg)
            << exponent; // as the uncertainty says: exponents at the ends of 0..2 are 1.7 sigma
        EXPECT_GT(c.angle_by_exponent_deg[0], c.angle_by_exponent_deg[1]);
        EXPECT_GT(c.angle_by_exponent_deg[1], c.angle_by_exponent_deg[2]);
    }
}

TEST(Calibrate, refuses_a_log_that_cannot_tell) {
    log::Log log = drive("");
    std::erase_if(log.signals, [](const log::Signal &s) { return s.name.rfind("camera", 0) == 0; });
    EXPECT_THROW(calibrate(log, CalibrationTruth::camera, 0.057), log::LogError);
    std::erase_if(log.signals, [](const log::Signal &s) { return s.name == "radar.adc_count"; });
    EXPECT_THROW(calibrate(log, CalibrationTruth::automatic, 0.057), log::LogError);
}

TEST(Calibrate, sets_its_line_in_the_parameter_file_and_keeps_the_others) {
    const std::string path = testing::TempDir() + "rover_parameters.txt";
    std::remove(path.c_str());
    put_parameter(path, "doppler_scale", 1.02, "first");
    put_parameter(path, "wheel_kp_s", 0.15, "gain");
    put_parameter(path, "doppler_scale", 1.03, "second");
    control_config_t config = rover_config_default();
    char message[PARAMETERS_MESSAGE];
    ASSERT_TRUE(parameters_read(path.c_str(), &config, nullptr, message)) << message; // the firmware reads what the tools write
    EXPECT_FLOAT_EQ(config.doppler.scale, 1.03f);
    EXPECT_FLOAT_EQ(config.wheel_pid.kp_s, 0.15f);
}

namespace {

// A rover whose last order and stop can be seen.
struct Watched {
    hal_t inner;
    bool stopped = false, driven_after_stop = false;
    int fail_at = -1, ticks = 0;
    static hal_t wrap(Watched &w) {
        return {.context = &w,
                .wait_tick =
                    [](void *c) {
                        auto &x = *static_cast<Watched *>(c);
                        return ++x.ticks == x.fail_at ? HAL_ERR_IO : x.inner.wait_tick(x.inner.context);
                    },
                .read =
                    [](void *c, sensor_frame_t *f) {
                        auto &x = *static_cast<Watched *>(c);
                        return x.inner.read(x.inner.context, f);
                    },
                .write =
                    [](void *c, const actuator_frame_t *a) {
                        auto &x = *static_cast<Watched *>(c);
                        x.driven_after_stop = x.stopped;
                        return x.inner.write(x.inner.context, a);
                    },
                .safe_stop =
                    [](void *c) {
                        auto &x = *static_cast<Watched *>(c);
                        x.stopped = true;
                        x.inner.safe_stop(x.inner.context);
                    },
                .open = nullptr,
                .self_test = nullptr,
                .status = nullptr,
                .kick_watchdog = nullptr,
                .close = nullptr};
    }
};

hal::SimHalConfig world() {
    hal::SimHalConfig config;
    config.sensors = sim::default_sensors();
    config.plant.ground.soil = *sim::find_soil("concrete");
    config.ticks = 60000;
    return config;
}

} // namespace

TEST(Tune, finds_the_gripping_motor_within_its_limits_and_stops_it) {
    hal::SimHal rover(world());
    Watched watched{.inner = rover.hal()};
    const TuneLimits limits{.torque_Nm = 0.25};
    const TuneResult r = tune(Watched::wrap(watched), rover_config_default(), limits);
    std::printf("tune: pole %.2f 1/s, gain %.0f rad/s^2, kp %.3f ki %.3f, torque %.2f N m, %.1f s\n", r.pole_1_s[0], r.gain_rad_s2[0],
                r.kp_s, r.ki_1, r.largest_torque_Nm, r.used_s);
    EXPECT_TRUE(watched.stopped);
    EXPECT_FALSE(watched.driven_after_stop);
    // docs/firmware.md: 80 rad/s^2 per duty gripping, 118 free; poles 3.2 and 4.65 1/s; the wheels slip in the pulses: in between
    EXPECT_GT(r.kp_s, 0.24 * 0.2 / 0.24 * 0.9); // 24.4/118 = 0.207
    EXPECT_LT(r.kp_s, 24.4 / 80 * 1.15);        // 0.305, and the rover's body counts less while its wheels slip
    EXPECT_LT(r.used_s, limits.time_s);
    EXPECT_LE(r.largest_torque_Nm, 0.25);
    EXPECT_GT(r.largest_torque_Nm, 0.15); // and it is made use of
}

TEST(Tune, stops_the_motors_whatever_ends_it) {
    for (const int fail_at : {1, 30, 200}) {
        hal::SimHal rover(world());
        Watched watched{.inner = rover.hal(), .fail_at = fail_at};
        EXPECT_THROW(tune(Watched::wrap(watched), rover_config_default(), {}), std::runtime_error);
        EXPECT_TRUE(watched.stopped) << fail_at;
    }
    hal::SimHal rover(world());
    Watched watched{.inner = rover.hal()};
    EXPECT_THROW(tune(Watched::wrap(watched), rover_config_default(), {.time_s = 1.5}), std::runtime_error);
    EXPECT_TRUE(watched.stopped);
    EXPECT_LE(watched.ticks, 152);
}

// What makes an order late leaves less phase: the crossover that leaves the margin asked for is (90 deg - margin)/(2 T + D).
TEST(Tune, sees_how_late_an_order_acts_and_keeps_the_margin) {
    const auto tuned = [](const std::string &delay_s) {
        const auto scenario =
            sim::parse_scenario("duration_s = 60\n[ground]\nsoil = \"concrete\"\n[[drive]]\nfor_s = 60\nmode = \"stop\"\n" +
                                    (delay_s.empty() ? "" : "[[effect]]\nname = \"actuation_delay\"\ndelay_s = " + delay_s + "\n"),
                                "late.toml");
        hal::SimRover rover(scenario, scenario.effects, 7);
        return tune(rover.hal(), rover_config_default(), {});
    };
    const TuneResult now = tuned("");
    EXPECT_EQ(now.order_delay_s, 0);
    for (const auto &[text, late_s] : {std::pair{"0.013", 0.013}, {"0.05", 0.05}, {"0.12", 0.12}}) {
        const TuneResult r = tuned(text);
        EXPECT_NEAR(r.order_delay_s, late_s, 0.0015) << text; // the grid's step, and its half
        // the motor is the same one: 4 %, the spread of the largest of four gains over seeds (80 to 83.5 rad/s^2)
        EXPECT_NEAR(r.kp_s * (0.02 + late_s), now.kp_s * 0.02, 0.04 * now.kp_s * 0.02) << text;
        EXPECT_LE(r.largest_torque_Nm, 0.3 * 1.2) << text;
    }
}
