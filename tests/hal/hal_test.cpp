// The simulated HAL: counts inside the converters, scales that agree with the firmware's, faults that never stall the loop.
#include "hal/sim/fault_hal.h"
#include "hal/sim/sim_hal.h"
#include "hal/sim/sim_rover.h"

#include "firmware/app/daemon.h"
#include "firmware/core/rover_config.h"
#include "hal/open.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

using namespace traction;

namespace {

// A HAL whose frames count up, so that a fault's doing can be told from the truth.
class CountingHal {
  public:
    hal_t hal() {
        hal_t hal{};
        hal.context = this;
        hal.wait_tick = [](void *context) {
            static_cast<CountingHal *>(context)->ticks++;
            return HAL_OK;
        };
        hal.read = [](void *context, sensor_frame_t *frame) {
            auto *self = static_cast<CountingHal *>(context);
            *frame = {};
            frame->tick = self->ticks - 1;
            frame->present = FRAME_ALL;
            const int n = static_cast<int>(frame->tick);
            for (int i = 0; i < WHEEL_COUNT; i++) {
                frame->encoder_count[i] = 100 * n + i;
                frame->current_count[i] = static_cast<std::uint16_t>(2048 + n % 100);
            }
            frame->battery_count = static_cast<std::uint16_t>(1800 + n % 50);
            frame->accel_x_count = static_cast<std::int16_t>(n);
            frame->gyro_z_count = static_cast<std::int16_t>(-n);
            frame->radar_samples = n % 5 == 0 ? 6 : 5;
            for (int i = 0; i < frame->radar_samples; i++) frame->radar_count[i] = static_cast<std::uint16_t>(self->sample++ % 1024);
            return HAL_OK;
        };
        hal.write = [](void *context, const actuator_frame_t *) {
            static_cast<CountingHal *>(context)->writes++;
            return HAL_OK;
        };
        hal.safe_stop = [](void *context) { static_cast<CountingHal *>(context)->stops++; };
        return hal;
    }
    std::uint32_t ticks = 0;
    int sample = 0, writes = 0, stops = 0;
};

std::vector<sensor_frame_t> run(hal::FaultScript script, int ticks) {
    CountingHal inner;
    hal::FaultHal faulty(inner.hal(), std::move(script), {}, 5);
    const hal_t hal = faulty.hal();
    std::vector<sensor_frame_t> frames;
    for (int i = 0; i < ticks; i++) {
        EXPECT_EQ(hal.wait_tick(hal.context), HAL_OK);
        sensor_frame_t frame{};
        EXPECT_EQ(hal.read(hal.context, &frame), HAL_OK);
        frames.push_back(frame);
    }
    return frames;
}

constexpr double never_s = 1e9;

hal::SimHalConfig sand() {
    hal::SimHalConfig config;
    config.plant.ground.soil = *sim::find_soil("sand");
    config.sensors = sim::default_sensors();
    config.ticks = 300;
    return config;
}

} // namespace

TEST(Counts, scales_are_those_that_the_firmware_assumes) {
    const control_config_t firmware = rover_config_default();
    const hal::CountScale scale;
    // the firmware's are floats: equal to 1 part in 2^24
    EXPECT_FLOAT_EQ(static_cast<float>(scale.current_A), firmware.sense.current_A_per_count);
    EXPECT_FLOAT_EQ(static_cast<float>(scale.battery_V), firmware.sense.battery_V_per_count);
    EXPECT_FLOAT_EQ(static_cast<float>(scale.accel_m_s2), firmware.sense.accel_m_s2_per_count);
    EXPECT_FLOAT_EQ(static_cast<float>(scale.gyro_rad_s), firmware.sense.gyro_rad_s_per_count);
    EXPECT_FLOAT_EQ(static_cast<float>(sim::encoder_rad_per_count), firmware.sense.encoder_rad_per_count);
    for (std::size_t i = 0; i < WHEEL_COUNT; i++) EXPECT_EQ(scale.current_offset[i], firmware.sense.current_offset_count[i]);
    EXPECT_EQ(scale.current_max, firmware.sense.current_max_count);
    EXPECT_EQ(sim::RadarConfig{}.max_count, firmware.sense.radar_max_count);
    EXPECT_EQ(sim::RadarConfig{}.rate_Hz, static_cast<double>(firmware.doppler.beam->sample_rate_Hz));
}

TEST(Counts, a_quantity_comes_back_within_half_a_count) {
    const control_config_t firmware = rover_config_default();
    for (double current = -4; current <= 4; current += 0.0317) {
        sim::Measurements measured;
        measured.current_A.fill(current);
        measured.battery_V = 7 + current / 2;
        measured.accel_m_s2 = {3 * current, -current, current};
        measured.gyro_rad_s = {-current, current, current / 2};
        sensor_frame_t frame{};
        hal::to_counts({}, measured, &frame);
        sense_state_t state{};
        const sense_output_t out = sense_measure(&firmware.sense, &state, &frame);
        // rounding leaves half a count; 1e-6 for the firmware's single precision
        EXPECT_NEAR(static_cast<double>(out.current_A[2]), current, 0.001 + 1e-6);
        EXPECT_NEAR(static_cast<double>(out.battery_V), measured.battery_V, 0.002 + 1e-6);
        EXPECT_NEAR(static_cast<double>(out.accel_x_m_s2), measured.accel_m_s2[0], 0.002 + 1e-6);
        EXPECT_NEAR(static_cast<double>(out.gyro_z_rad_s), measured.gyro_rad_s[2], 0.00025 + 1e-6);
    }
}

TEST(Counts, stay_inside_the_converters_for_any_quantity) {
    constexpr double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    for (const double value : {-inf, -1e30, -5.0, 0.0, 5.0, 1e30, inf, nan}) {
        sim::Measurements measured;
        measured.current_A.fill(value);
        measured.battery_V = value;
        measured.accel_m_s2.fill(value);
        measured.gyro_rad_s.fill(value);
        measured.radar_count.assign(70, 1023); // more than a frame holds
        sensor_frame_t frame{};
        hal::to_counts({}, measured, &frame);
        for (const auto count : frame.current_count) EXPECT_LE(count, 4095);
        EXPECT_LE(frame.battery_count, 4095);
        EXPECT_EQ(frame.radar_samples, RADAR_SAMPLES_PER_TICK_MAX);
    }
}

TEST(Encoder, counts_pulses_of_the_motor_side_and_wraps) {
    const sim::Encoder encoder;
    EXPECT_EQ(encoder.count(0), 0);
    EXPECT_EQ(encoder.count(2 * 3.14159265358979323846 + 1e-9), 6000); // 120 pulses x gear 50, docs/sources.md section 3
    EXPECT_EQ(encoder.count(-1e-9), -1);
    EXPECT_EQ(encoder.count((2147483648.0 + 0.5) * sim::encoder_rad_per_count), INT32_MIN);
    // one pulse in ten lost: 5400 of 6000
    EXPECT_EQ(sim::Encoder(0.1).count(2 * 3.14159265358979323846 + 1e-9), 5400);
}

TEST(FaultHal, changes_nothing_when_nothing_fails) {
    CountingHal plain;
    const hal_t direct = plain.hal();
    for (const sensor_frame_t &frame : run({}, 50)) {
        direct.wait_tick(direct.context);
        sensor_frame_t expected{};
        direct.read(direct.context, &expected);
        EXPECT_EQ(frame.present, expected.present);
        EXPECT_EQ(frame.encoder_count[3], expected.encoder_count[3]);
        EXPECT_EQ(frame.radar_count[4], expected.radar_count[4]);
    }
}

TEST(FaultHal, a_dropped_sensor_loses_its_bit_and_no_other) {
    struct Case {
        sim::FaultySensor sensor;
        int wheel;
        std::uint32_t lost;
    };
    using enum sim::FaultySensor;
    for (const Case &c : {Case{encoder, 1, 0x002}, Case{encoder, -1, 0x00f}, Case{current, 3, 0x080}, Case{current, -1, 0x0f0},
                          Case{battery, -1, 0x100}, Case{accel, -1, 0x2200}, Case{gyro, -1, 0x4400}, Case{radar, -1, 0x800}}) {
        const auto frames =
            run({.sensors = {{.sensor = c.sensor, .wheel = c.wheel, .kind = sim::FaultKind::dropped, .from_s = 0.1, .to_s = 0.2}},
                 .emergency_stop_s = {}},
                40);
        for (std::size_t i = 0; i < frames.size(); i++) {
            const bool failing = i + 1 >= 10 && i + 1 < 20; // frame i ends at (i + 1) * 10 ms
            EXPECT_EQ(frames[i].present, failing ? 0xfffffu & ~c.lost : 0xfffffu) << i;
        }
    }
}

TEST(FaultHal, a_device_that_times_out_is_told_and_the_others_are_still_read) {
    CountingHal inner;
    hal::FaultHal faulty(inner.hal(),
                         {.sensors = {{.sensor = sim::FaultySensor::gyro, .kind = sim::FaultKind::timeout, .from_s = 0.02, .to_s = 0.04}},
                          .emergency_stop_s = {}},
                         {}, 1);
    const hal_t hal = faulty.hal();
    for (std::uint32_t tick = 0; tick < 5; tick++) {
        hal.wait_tick(hal.context);
        sensor_frame_t frame{};
        const bool silent = tick == 1 || tick == 2; // a tick ends its 10 ms
        EXPECT_EQ(hal.read(hal.context, &frame), silent ? HAL_ERR_TIMEOUT : HAL_OK) << tick;
        EXPECT_EQ(frame.tick, tick); // hal.h: the tick and what the others said
        EXPECT_EQ(frame.present, silent ? 0xfffffu & ~static_cast<unsigned>(FRAME_GYRO | FRAME_GYRO_XY) : 0xfffffu) << tick;
    }
}

TEST(FaultHal, a_stuck_sensor_repeats_and_a_delayed_one_tells_the_past) {
    const auto stuck =
        run({.sensors = {{.sensor = sim::FaultySensor::encoder, .wheel = 2, .kind = sim::FaultKind::stuck, .from_s = 0.1, .to_s = never_s}},
             .emergency_stop_s = {}},
            30);
    EXPECT_EQ(stuck[8].encoder_count[2], 802);
    for (std::size_t i = 9; i < stuck.size(); i++) EXPECT_EQ(stuck[i].encoder_count[2], 902);
    EXPECT_EQ(stuck[29].encoder_count[1], 2901);

    const auto late = run(
        {.sensors = {{.sensor = sim::FaultySensor::accel, .kind = sim::FaultKind::delayed, .from_s = 0, .to_s = never_s, .amount = 0.05}},
         .emergency_stop_s = {}},
        30);
    for (std::size_t i = 5; i < late.size(); i++) EXPECT_EQ(late[i].accel_x_count, static_cast<int>(i) - 5);
    EXPECT_EQ(late[29].gyro_z_count, -29);
}

TEST(FaultHal, a_late_radar_loses_no_sample) {
    const auto frames = run(
        {.sensors = {{.sensor = sim::FaultySensor::radar, .kind = sim::FaultKind::delayed, .from_s = 0, .to_s = never_s, .amount = 0.1}},
         .emergency_stop_s = {}},
        60);
    std::vector<int> samples;
    for (const sensor_frame_t &frame : frames) samples.insert(samples.end(), frame.radar_count, frame.radar_count + frame.radar_samples);
    const std::size_t late = 51; // 0.1 s at 512 Hz
    for (std::size_t i = late; i < samples.size(); i++) EXPECT_EQ(samples[i], static_cast<int>(i - late) % 1024);
}

TEST(FaultHal, added_noise_has_the_stated_size) {
    const auto frames = run({.sensors = {{.sensor = sim::FaultySensor::current,
                                          .wheel = 0,
                                          .kind = sim::FaultKind::noisy,
                                          .from_s = 0,
                                          .to_s = never_s,
                                          .amount = 0.1}},
                             .emergency_stop_s = {}},
                            4000);
    double square = 0;
    for (std::size_t i = 0; i < frames.size(); i++) {
        const double error = frames[i].current_count[0] - (2048.0 + static_cast<double>(i % 100));
        square += error * error;
    }
    // 0.1 A is 50 counts of 2 mA; standard deviation of the estimate 50/sqrt(2*4000) = 0.56, three of them
    EXPECT_NEAR(std::sqrt(square / 4000), 50, 1.7);
}

TEST(FaultHal, the_emergency_line_and_the_calls_of_the_loop_pass_through) {
    CountingHal inner;
    hal::FaultHal faulty(inner.hal(), {.sensors = {}, .emergency_stop_s = {{0.02, 0.04}}}, {}, 1);
    const hal_t hal = faulty.hal();
    std::vector<bool> stop;
    for (int i = 0; i < 5; i++) {
        hal.wait_tick(hal.context);
        sensor_frame_t frame{};
        hal.read(hal.context, &frame);
        stop.push_back(frame.emergency_stop);
        const actuator_frame_t actuator{};
        EXPECT_EQ(hal.write(hal.context, &actuator), HAL_OK);
    }
    hal.safe_stop(hal.context);
    EXPECT_EQ(stop, (std::vector<bool>{false, true, true, false, false}));
    EXPECT_EQ(inner.writes, 5);
    EXPECT_EQ(inner.stops, 1);
}

TEST(SimHal, a_tick_is_ten_milliseconds_and_the_run_ends) {
    hal::SimHal world(sand());
    const hal_t hal = world.hal();
    sensor_frame_t frame{};
    EXPECT_EQ(hal.read(hal.context, &frame), HAL_ERR_TIMEOUT); // nothing measured before the first tick
    std::uint32_t ticks = 0;
    int samples = 0;
    while (hal.wait_tick(hal.context) == HAL_OK) {
        ASSERT_EQ(hal.read(hal.context, &frame), HAL_OK);
        EXPECT_EQ(frame.tick, ticks++);
        EXPECT_EQ(frame.present, FRAME_ALL);
        EXPECT_NEAR(world.truth().t_s, 0.01 * ticks, 1e-9); // sums of 1 ms in double precision
        samples += frame.radar_samples;
    }
    EXPECT_EQ(ticks, 300u);
    EXPECT_EQ(samples, 3 * 512); // 512 Hz, none lost, none twice
    EXPECT_EQ(hal.wait_tick(hal.context), HAL_END);
}

TEST(SimHal, a_blocked_wheel_stands_and_is_let_go) {
    hal::SimHalConfig config = sand();
    config.wheel_blocks = {{.wheel = 2, .from_s = 1, .to_s = 2}};
    hal::SimHal world(config);
    const hal_t hal = world.hal();
    for (int tick = 0; hal.wait_tick(hal.context) == HAL_OK; tick++) {
        const actuator_frame_t actuator{.sequence = static_cast<std::uint32_t>(tick) + 1,
                                        .drive = DRIVE_ON,
                                        .duty_q15 = {16000, 16000, 16000, 16000},
                                        .status_led = false,
                                        .curvature_1_m = 0};
        hal.write(hal.context, &actuator);
        const double speed = world.truth().wheel[2].speed_rad_s;
        const bool held = tick > 102 && tick < 199, free = tick == 90 || tick == 290;
        EXPECT_TRUE(!held || speed == 0) << tick;
        EXPECT_TRUE(!free || speed > 2) << tick; // duty 0.5 turns a free wheel at 13 rad/s
    }
}

TEST(SimHal, a_released_bridge_carries_no_current_and_safe_stop_releases) {
    hal::SimHal world(sand());
    const hal_t hal = world.hal();
    actuator_frame_t push{
        .sequence = 0, .drive = DRIVE_ON, .duty_q15 = {30000, 30000, 30000, 30000}, .status_led = false, .curvature_1_m = 0};
    for (int i = 0; i < 50; i++) {
        hal.wait_tick(hal.context);
        push.sequence++;
        hal.write(hal.context, &push);
    }
    EXPECT_GT(std::fabs(world.truth().wheel[0].current_A), 0.1);
    hal.safe_stop(hal.context);
    hal.wait_tick(hal.context);
    for (const auto &wheel : world.truth().wheel) EXPECT_EQ(wheel.current_A, 0);
}

TEST(SimHal, a_bridge_that_hears_nothing_new_releases_itself_after_its_time) {
    // written each tick: all new; the same number again and again; nothing after tick 49
    for (const int how : {0, 1, 2}) {
        hal::SimHal world(sand());
        const hal_t hal = world.hal();
        actuator_frame_t push{
            .sequence = 0, .drive = DRIVE_ON, .duty_q15 = {9000, 9000, 9000, 9000}, .status_led = false, .curvature_1_m = 0};
        for (int tick = 0; tick < 60; tick++) {
            hal.wait_tick(hal.context);
            const double current_A = world.truth().wheel[0].current_A;
            const bool early = tick >= 1 && tick < 55, late = tick >= 56; // the order of tick 49 acts for 50 ms
            EXPECT_TRUE(!early || current_A != 0) << how << " " << tick;
            EXPECT_TRUE(!late || (current_A == 0) == (how != 0)) << how << " " << tick;
            if (tick < 50 || how == 0) push.sequence++;
            if (tick < 50 || how != 2) hal.write(hal.context, &push);
        }
    }
}

// Duty 0 on a driven bridge and the brake are one circuit: the shorted winding, ke w/Ra against the motion.
TEST(SimHal, a_brake_shorts_the_winding_and_a_coast_opens_it) {
    std::array<double, 2> speed{}, current_A{};
    for (const drive_state_t drive : {DRIVE_BRAKE, DRIVE_COAST}) {
        hal::SimHal world(sand());
        const hal_t hal = world.hal();
        actuator_frame_t order{
            .sequence = 0, .drive = DRIVE_ON, .duty_q15 = {16000, 16000, 16000, 16000}, .status_led = false, .curvature_1_m = 0};
        for (int tick = 0; tick < 103; tick++) {
            hal.wait_tick(hal.context);
            if (tick == 100) order.drive = drive; // the duty it still names counts for nothing
            order.sequence++;
            hal.write(hal.context, &order);
        }
        const std::size_t n = drive == DRIVE_BRAKE ? 0 : 1;
        speed[n] = world.truth().wheel[0].speed_rad_s;
        current_A[n] = world.truth().wheel[0].current_A;
    }
    EXPECT_EQ(current_A[1], 0);
    EXPECT_NEAR(current_A[0], -0.265 * speed[0] / 3.24, 0.05); // of the millisecond before: the wheel loses 0.5 rad/s in it
    EXPECT_LT(speed[0], speed[1] - 0.5);
}

TEST(SimHal, a_frame_tells_its_time_and_what_was_missed) {
    hal::SimHal world(sand());
    const hal_t hal = world.hal();
    sensor_frame_t frame{};
    std::uint32_t next = 1; // the sample at t = 0 belongs to no tick
    for (const int ticks : {1, 1, 3, 1}) {
        for (int i = 0; i < ticks; i++) hal.wait_tick(hal.context);
        ASSERT_EQ(hal.read(hal.context, &frame), HAL_OK);
        EXPECT_EQ(frame.elapsed_ticks, static_cast<std::uint32_t>(ticks));
        EXPECT_EQ(frame.time_us, (frame.tick + 1) * 10000);
        EXPECT_GE(frame.radar_sequence, next);
        EXPECT_TRUE(ticks != 1 || frame.tick > 1 || frame.radar_sequence == next);
        next = frame.radar_sequence + frame.radar_samples;
        EXPECT_EQ(next - 1, (frame.tick + 1) * 512 / 100); // the newest: n/512 s <= t
        EXPECT_NEAR(frame.accel_z_count * 0.004, 9.81, 0.5);
    }
}

TEST(HalOpen, what_a_hal_does_not_say_of_itself_is_no) {
    hal_opened_t opened;
    std::memset(static_cast<void *>(&opened), 0xff, sizeof opened); // as memory may be
    std::array<char, HAL_MESSAGE> message{};
    const char *const scenario = "scenarios/cruise.toml";
    ASSERT_EQ(hal_open("sim", 1, &scenario, &opened, message.data()), HAL_OK) << message.data();
    EXPECT_FALSE(opened.devices); // a daemon with --link takes the wall clock's time then, and its log is patient
    opened.close(opened.hal.context);
}

TEST(HalStatus, a_wrapper_hands_on_what_the_devices_say) {
    hal::SimHal world(sand());
    hal::DelayHal late(world.hal(), 2);
    hal::FaultHal faulty(late.hal(), {}, {}, 1);
    const hal_t hal = faulty.hal();
    EXPECT_EQ(hal_open_devices(&hal), HAL_OK);
    hal_status_t status;
    EXPECT_EQ(hal_self_test(&hal, &status), HAL_OK);
    for (const auto device : status.device) EXPECT_EQ(device, HAL_DEVICE_WORKS);
    const hal_t bare{}; // one that can tell nothing
    EXPECT_EQ(hal_status(&bare, &status), HAL_OK);
    for (const auto device : status.device) EXPECT_EQ(device, HAL_DEVICE_ABSENT);
    hal_kick_watchdog(&bare);
    hal_close_devices(&bare);
}

TEST(DelayHal, gives_each_order_late_by_its_ticks_and_none_before) {
    struct Orders {
        int tick = 0;
        std::vector<std::pair<int, int>> seen; // tick, duty
    } orders;
    hal_t inner{};
    inner.context = &orders;
    inner.wait_tick = [](void *c) { return static_cast<Orders *>(c)->tick++, HAL_OK; };
    inner.write = [](void *c, const actuator_frame_t *actuator) {
        auto &o = *static_cast<Orders *>(c);
        return o.seen.emplace_back(o.tick, actuator->duty_q15[0]), HAL_OK;
    };
    inner.safe_stop = [](void *c) { static_cast<Orders *>(c)->seen.emplace_back(-1, 0); };
    hal::DelayHal late(inner, 3);
    const hal_t hal = late.hal();
    for (std::int16_t i = 0; i < 8; i++) {
        hal.wait_tick(hal.context);
        const actuator_frame_t actuator{.sequence = static_cast<std::uint32_t>(i),
                                        .drive = DRIVE_ON,
                                        .duty_q15 = {i, i, i, i},
                                        .status_led = false,
                                        .curvature_1_m = 0};
        if (i != 2) hal.write(hal.context, &actuator); // a tick without an order moves no other
    }
    // order i is written after tick i + 1 has begun, and seen three ticks later; those of the last three are still under way
    EXPECT_EQ(orders.seen, (std::vector<std::pair<int, int>>{{4, 0}, {5, 1}, {7, 3}}));
    hal.safe_stop(hal.context);
    hal.wait_tick(hal.context);
    hal.wait_tick(hal.context);
    EXPECT_EQ(orders.seen.back(), (std::pair{-1, 0})); // at once, and what was under way is forgotten
}

TEST(DelayHal, a_bridge_that_is_lost_ends_the_loop_though_the_order_was_late) {
    hal_t inner{};
    inner.wait_tick = [](void *) { return HAL_OK; };
    inner.write = [](void *, const actuator_frame_t *) { return HAL_ERR_IO; };
    hal::DelayHal late(inner, 1);
    const hal_t hal = late.hal();
    const actuator_frame_t actuator{};
    EXPECT_EQ(hal.wait_tick(hal.context), HAL_OK);
    EXPECT_EQ(hal.write(hal.context, &actuator), HAL_OK);
    EXPECT_EQ(hal.wait_tick(hal.context), HAL_OK);
    EXPECT_EQ(hal.wait_tick(hal.context), HAL_ERR_IO);
}

// The delay of an effect, split into whole ticks (DelayHal) and the bus's part of one, acts as one delay of 1 ms grain.
TEST(SimRover, a_delayed_duty_acts_late_by_the_delay) {
    const auto mean_current_A = [](const std::string &delay) {
        const auto scenario = sim::parse_scenario("duration_s = 1\n[[drive]]\nfor_s = 1\nmode = \"stop\"\n" + delay, "x.toml");
        hal::SimRover rover(scenario, scenario.effects, 3);
        const hal_t hal = rover.hal();
        actuator_frame_t push{
            .sequence = 0, .drive = DRIVE_ON, .duty_q15 = {30000, 30000, 30000, 30000}, .status_led = false, .curvature_1_m = 0};
        std::vector<double> current_A;
        while (hal.wait_tick(hal.context) == HAL_OK) {
            push.sequence++;
            hal.write(hal.context, &push);
            sensor_frame_t frame{};
            hal.read(hal.context, &frame);
            current_A.push_back((frame.current_count[0] - 2048) * 0.002);
        }
        return current_A;
    };
    const auto effect = [](const char *delay_s) {
        return std::string("[[effect]]\nname = \"actuation_delay\"\ndelay_s = ") + delay_s + "\n";
    };
    const auto now = mean_current_A(""), late = mean_current_A(effect("0.10")), part = mean_current_A(effect("0.037"));
    EXPECT_GT(now[1], 1.8); // 0.92 of 7.2 V over 3.24 ohm, less what the turning wheel takes
    for (std::size_t k = 0; k <= 10; k++) EXPECT_NEAR(late[k], 0, 0.05) << k; // noise and offset of the sensor
    EXPECT_NEAR(late[11], now[1], 0.1);
    EXPECT_NEAR(part[3], 0, 0.05);
    EXPECT_NEAR(part[4], 0.3 * 0.92 * 7.2 / 3.24, 0.15); // the last 3 of its 10 ms; at rest
}

TEST(SimHal, a_dead_sensor_never_stalls_the_loop) {
    using enum sim::FaultySensor;
    for (const sim::FaultySensor sensor : {encoder, current, battery, accel, gyro, radar}) {
        for (const sim::FaultKind kind :
             {sim::FaultKind::dropped, sim::FaultKind::stuck, sim::FaultKind::noisy, sim::FaultKind::delayed, sim::FaultKind::timeout}) {
            hal::SimHal world(sand());
            hal::FaultHal faulty(
                world.hal(),
                {.sensors = {{.sensor = sensor, .kind = kind, .from_s = 0.5, .to_s = never_s, .amount = 0.3}}, .emergency_stop_s = {}}, {},
                3);
            const hal_t hal = faulty.hal();
            const control_config_t config = rover_config_default();
            const daemon_link_t person{.context = nullptr,
                                       .command =
                                           [](void *, const sensor_frame_t *, command_t *command) {
                                               command->mode = MODE_PLATFORM_SPEED;
                                               command->platform_speed_m_s = 0.3f;
                                           },
                                       .log = nullptr};
            const daemon_result_t result = daemon_run(&hal, &config, &person);
            EXPECT_EQ(result.ended_by, HAL_END);
            EXPECT_EQ(result.ticks, 300u);
        }
    }
}

// Five ticks that nobody reads: the FIFO keeps their radar samples, the frame says what was missed.
TEST(FaultHal, missed_ticks_are_told_and_lose_no_radar_sample) {
    hal::SimHal world(sand());
    hal::FaultHal faulty(
        world.hal(),
        {.sensors = {}, .emergency_stop_s = {}, .missed_ticks = {{.ticks = 5, .every_s = 0.5, .from_s = 0.5, .to_s = never_s}}}, {}, 1);
    const hal_t hal = faulty.hal();
    sensor_frame_t frame{};
    std::uint32_t next = 0, missed = 0, expected_tick = 0;
    while (hal.wait_tick(hal.context) == HAL_OK) {
        ASSERT_EQ(hal.read(hal.context, &frame), HAL_OK);
        expected_tick += frame.elapsed_ticks;
        EXPECT_EQ(frame.tick + 1, expected_tick);
        missed += frame.elapsed_ticks - 1;
        EXPECT_TRUE(next == 0 || frame.radar_sequence == next);
        next = frame.radar_sequence + frame.radar_samples;
    }
    EXPECT_EQ(missed, 25u); // five times in 3 s: at 0.5, 1.0, 1.5, 2.0 and 2.5 s
}

TEST(FaultHal, a_sensor_that_drifts_jumps_or_slips_does_so_by_its_amount) {
    using enum sim::FaultySensor;
    const auto with = [](sim::FaultySensor sensor, sim::FaultKind kind, double amount) {
        return run({.sensors = {{.sensor = sensor, .wheel = 1, .kind = kind, .from_s = 0.1, .to_s = never_s, .amount = amount}},
                    .emergency_stop_s = {}},
                   30);
    };
    // the counting HAL: current 2048 + n, encoder 100 n + wheel, accelerometer n; frame n ends at (n + 1) 10 ms
    EXPECT_EQ(with(current, sim::FaultKind::offset, 0.2)[20].current_count[1], 2048 + 20 + 100); // 2 mA a count
    EXPECT_EQ(with(current, sim::FaultKind::drift, 1.0)[29].current_count[1], 2048 + 29 + 100);  // 0.2 s after it began
    const auto spiked = with(accel, sim::FaultKind::spike, 0.4);
    EXPECT_EQ(spiked[9].accel_x_count, 9 + 100); // 4 mm/s^2 a count, in one tick
    EXPECT_EQ(spiked[10].accel_x_count, 10);
    for (int axis = 0; axis < 3; axis++) { // 0.5 mrad/s a count; one axis alone
        const auto turned = run(
            {.sensors = {{.sensor = gyro, .axis = axis, .kind = sim::FaultKind::offset, .from_s = 0.1, .to_s = never_s, .amount = 0.05}},
             .emergency_stop_s = {}},
            30);
        const auto sound = run({.sensors = {}, .emergency_stop_s = {}}, 30);
        EXPECT_EQ(turned[20].gyro_x_count - sound[20].gyro_x_count, axis == 0 ? 100 : 0);
        EXPECT_EQ(turned[20].gyro_y_count - sound[20].gyro_y_count, axis == 1 ? 100 : 0);
        EXPECT_EQ(turned[20].gyro_z_count - sound[20].gyro_z_count, axis == 2 ? 100 : 0);
    }
    const auto slips = with(encoder, sim::FaultKind::slipping, 0.5);
    EXPECT_EQ(slips[29].encoder_count[1] - slips[19].encoder_count[1], 500); // half of 100 a tick
    EXPECT_EQ(slips[29].encoder_count[0] - slips[19].encoder_count[0], 1000);
}

TEST(FaultHal, lost_samples_leave_one_run_and_its_number_tells_what_is_missing) {
    const auto frames =
        run({.sensors = {{.sensor = sim::FaultySensor::radar, .kind = sim::FaultKind::lost, .from_s = 0, .to_s = never_s, .amount = 0.05}},
             .emergency_stop_s = {}},
            500);
    int lost = 0, sample = 0;
    for (std::size_t n = 0; n < frames.size(); n++) {
        const sensor_frame_t &frame = frames[n];
        const int whole = n % 5 == 0 ? 6 : 5;
        for (int i = 0; i < frame.radar_samples; i++) // the counting HAL numbers its samples; its frames begin at 0
            EXPECT_EQ(frame.radar_count[i], (sample + static_cast<int>(frame.radar_sequence) + i) % 1024);
        sample += whole;
        lost += whole - frame.radar_samples;
    }
    EXPECT_GT(lost, 130 - 40); // 0.05 of 2600 at least, three sigma; more, as a run has no hole
    EXPECT_LT(lost, 3 * 130);
}
