// The self-test in the simulated rover: a whole one passes on any soil and drives on; each defect is named, and then nothing drives.
#include "host_tools/simulate/simulate.h"

#include "firmware/core/rover_config.h"
#include "hal/sim/forwarding.h"
#include "hal/sim/sim_hal.h"
#include "host_tools/loop/loop.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>

using namespace traction;

namespace {

SimulationResult run(const std::string &text, const std::string &ground = "[ground]\nsoil = \"concrete\"\n", std::uint64_t seed = 3) {
    SimulateOptions options;
    options.self_test = true;
    options.truth = true;
    options.seed = seed;
    return simulate(
        sim::parse_scenario("duration_s = 6\n" + ground + "[[drive]]\nfor_s = 6.0\nmode = \"platform_speed\"\nspeed_m_s = 0.3\n" + text,
                            "self.toml"),
        options);
}

// A simulated rover whose wires are swapped between the devices and whoever reads them.
class Miswired {
  public:
    Miswired(const std::string &soil, std::function<void(sensor_frame_t &)> reads, std::function<void(actuator_frame_t &)> writes = {})
        : world_(config_of(soil)), inner_(world_.hal()), reads_(std::move(reads)), writes_(std::move(writes)) {}
    const hal_t &inner() const { return inner_; }
    hal_t hal() {
        hal_t hal = hal::forwarding(this);
        hal.read = [](void *c, sensor_frame_t *frame) {
            auto &self = *static_cast<Miswired *>(c);
            const hal_result_t result = self.inner_.read(self.inner_.context, frame);
            if (self.reads_) self.reads_(*frame);
            return result;
        };
        hal.write = [](void *c, const actuator_frame_t *actuator) {
            auto &self = *static_cast<Miswired *>(c);
            actuator_frame_t changed = *actuator;
            if (self.writes_) self.writes_(changed);
            return self.inner_.write(self.inner_.context, &changed);
        };
        return hal;
    }
    double path_m() const { return world_.truth().path_m; }

  private:
    static hal::SimHalConfig config_of(const std::string &soil) {
        hal::SimHalConfig config;
        config.sensors = sim::default_sensors();
        config.plant.ground.soil = *sim::find_soil(soil);
        config.ticks = 600;
        return config;
    }
    hal::SimHal world_;
    hal_t inner_;
    std::function<void(sensor_frame_t &)> reads_;
    std::function<void(actuator_frame_t &)> writes_;
};

class Person : public Link {
  public:
    void command(const sensor_frame_t &, command_t &command) override {
        command.mode = MODE_WHEEL_SPEED;
        asked = true;
    }
    void log(const sensor_frame_t &, const command_t &, const trace_t &trace) override {
        for (const wheel_trace_t &wheel : trace.wheel) most_duty = std::fmax(most_duty, static_cast<double>(std::fabs(wheel.duty)));
    }
    bool asked = false;
    double most_duty = 0;
};

constexpr daemon_start_t tested{.self_test = true, .warm = false, .rise_K = nullptr, .rise_out_K = nullptr};

self_test_result_t test(Miswired &rover, Person &person) { return run_loop(rover.hal(), rover_config_default(), person, tested).self_test; }

void swap_wheels(sensor_frame_t &frame, int a, int b, bool current) {
    std::swap(frame.encoder_count[a], frame.encoder_count[b]);
    if (current) std::swap(frame.current_count[a], frame.current_count[b]);
}

} // namespace

TEST(SelfTest, a_whole_rover_passes_on_every_soil_and_on_a_gentle_slope_and_then_drives) {
    for (const char *soil : {"sand", "gravel", "concrete"})
        for (const double slope_deg : {-4.0, 0.0, 4.0})
            for (const std::uint64_t seed : {1u, 2u, 3u}) {
                const auto result = run("",
                                        std::string("[ground]\nsoil = \"") + soil +
                                            "\"\nslope_rad = " + std::to_string(slope_deg * 3.14159265358979 / 180) + "\n",
                                        seed);
                EXPECT_TRUE(result.self_test.done);
                EXPECT_EQ(result.self_test.failures, 0u) << soil << " " << slope_deg << " " << seed;
                EXPECT_EQ(result.ticks, 600u);
                EXPECT_NEAR(result.self_test.battery_V, 7.2f, 0.05f);
                EXPECT_GT(result.self_test.radar_noise_count, 1.0f); // 1.15: 1.0 white, 0.5 flicker, rounding;
                EXPECT_LT(result.self_test.radar_noise_count, 2.0f); // more on a slope, where the rover settles into its contacts
            }
    EXPECT_GT(run("").truth.find("truth.speed_m_s")->value.back(), 0.2);
}

TEST(SelfTest, its_pulses_are_small_and_move_the_rover_by_millimetres) {
    Miswired rover("concrete", {});
    Person person;
    EXPECT_EQ(test(rover, person).failures, 0u);
    EXPECT_TRUE(person.asked);
    EXPECT_LE(person.most_duty, 0.51);          // the bound of the test, and nothing else drove
    EXPECT_LT(std::fabs(rover.path_m()), 0.02); // four pulses that end after 1.4 mm of the rim each, and what shorted wheels roll on
}

TEST(SelfTest, a_defect_at_rest_is_named_and_no_motor_is_driven) {
    struct Case {
        const char *name;
        std::string text;
        std::uint32_t failure;
    };
    const auto fault = [](const std::string &more) { return "[[fault]]\nwhat = \"sensor\"\nfrom_s = 0.0\n" + more; };
    const Case cases[] = {
        {"radar dead", fault("sensor = \"radar\"\nhow = \"dead\"\n"), SELF_TEST_RADAR_DEAD},
        {"radar offset", "[radar]\noffset_error_count = 15\n", SELF_TEST_RADAR_OFFSET},
        {"radar line", "[radar]\n[[radar.interference]]\nfrequency_Hz = 50\nrms_count = 10\n", SELF_TEST_RADAR_NOISY},
        {"accelerometer biased", "[sensors.accel]\noffset_m_s2 = 3.0\n", SELF_TEST_ACCEL},
        {"gyro biased", "[sensors.gyro]\noffset_rad_s = 0.2\n", SELF_TEST_GYRO},
        {"battery low", "[rover]\nbattery_voltage_V = 5.0\n", SELF_TEST_BATTERY},
        {"current offset", fault("sensor = \"current\"\nhow = \"offset\"\noffset = 0.2\nwheel = 1\n"), SELF_TEST_CURRENT_ZERO},
        {"gyro silent", fault("sensor = \"gyro\"\nhow = \"dropped\"\n"), SELF_TEST_SILENT},
    };
    for (const Case &c : cases) {
        const auto result = run(c.text);
        EXPECT_EQ(result.self_test.failures, c.failure) << c.name;
        EXPECT_LE(result.ticks, 110u) << c.name; // ended at rest
        for (int wheel = 0; wheel < 4; wheel++)
            for (const double duty : result.log.find("wheel" + std::to_string(wheel) + ".duty")->value) ASSERT_EQ(duty, 0) << c.name;
    }
}

TEST(SelfTest, a_defect_of_a_wheel_is_named_with_its_wheel_on_the_ground) {
    struct Case {
        const char *name;
        std::function<void(sensor_frame_t &)> reads;
        std::function<void(actuator_frame_t &)> writes;
        std::uint32_t failure, wheels;
    };
    const Case cases[] = {
        {"encoder sign", [](sensor_frame_t &f) { f.encoder_count[2] = -f.encoder_count[2]; }, {}, SELF_TEST_ENCODER_SIGN, 4},
        {"current sign",
         [](sensor_frame_t &f) { f.current_count[1] = static_cast<std::uint16_t>(4096 - f.current_count[1]); },
         {},
         SELF_TEST_CURRENT_SIGN,
         2},
        {"motor leads",
         {},
         [](actuator_frame_t &a) { a.duty_q15[0] = static_cast<std::int16_t>(-a.duty_q15[0]); },
         SELF_TEST_ENCODER_SIGN | SELF_TEST_CURRENT_SIGN,
         1},
        {"encoder dead", [](sensor_frame_t &f) { f.encoder_count[3] = 77; }, {}, SELF_TEST_ENCODER_DEAD, 8},
        {"motor open", {}, [](actuator_frame_t &a) { a.duty_q15[3] = 0; }, SELF_TEST_MOTOR_OPEN, 8},
        {"current channels swapped",
         [](sensor_frame_t &f) { std::swap(f.current_count[0], f.current_count[1]); },
         {},
         SELF_TEST_WHEEL_ORDER,
         3},
        {"wheels swapped", [](sensor_frame_t &f) { swap_wheels(f, 1, 3, true); }, {}, SELF_TEST_WHEEL_ORDER, 10},
    };
    for (const char *soil : {"sand", "concrete"})
        for (const Case &c : cases) {
            Miswired rover(soil, c.reads, c.writes);
            Person person;
            const self_test_result_t result = test(rover, person);
            EXPECT_EQ(result.failures, c.failure) << c.name << " on " << soil;
            EXPECT_EQ(result.wheels, c.wheels) << c.name << " on " << soil;
            EXPECT_FALSE(person.asked) << c.name; // nobody else drove
        }
}

TEST(SelfTest, an_emergency_stop_ends_it) {
    const auto result = run("[[fault]]\nwhat = \"emergency_stop\"\nfrom_s = 1.3\n");
    EXPECT_EQ(result.self_test.failures, static_cast<std::uint32_t>(SELF_TEST_STOPPED));
}

TEST(SelfTest, every_failure_has_words_of_its_own) {
    for (std::int32_t i = 0; i < SELF_TEST_FAILURES; i++)
        for (std::int32_t k = 0; k < i; k++) EXPECT_STRNE(self_test_name(i), self_test_name(k));
    EXPECT_STREQ(self_test_name(-1), "");
    EXPECT_STREQ(self_test_name(SELF_TEST_FAILURES), "");
}
