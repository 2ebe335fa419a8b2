// Properties of the laws for any input (rapidcheck, host only; the seed is printed by rapidcheck and fixed by ctest).
#include "firmware/core/rover_config.h"

#include <cstdint>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

namespace {

// Any 32 bits as a float: NaN, infinities and denormals included.
float any_float() {
    const auto bits = *rc::gen::arbitrary<std::uint32_t>();
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

float finite(int limit) { return static_cast<float>(*rc::gen::inRange(-limit * 1000, limit * 1000)) / 1000.0f; }

RC_GTEST_PROP(Property, slip_is_bounded_and_odd, ()) {
    const slip_config_t config = rover_config_default().slip;
    const float w = any_float(), v = any_float();
    const slip_output_t out = slip_measure(&config, w, v), back = slip_measure(&config, -w, -v);
    RC_ASSERT(std::fabs(out.slip) <= 1.0f);
    RC_ASSERT(out.slip == -back.slip);
    RC_ASSERT(out.valid == back.valid);
}

RC_GTEST_PROP(Property, slip_rises_with_the_wheel_and_falls_with_the_ground, ()) {
    const slip_config_t config = rover_config_default().slip;
    const float v = std::fabs(finite(1)) + 0.1f, w = finite(20), more = std::fabs(finite(5));
    RC_ASSERT(slip_measure(&config, w + more, v).slip >= slip_measure(&config, w, v).slip - 1e-6f); // rounding of one division
    RC_ASSERT(slip_measure(&config, w, v + more).slip <= slip_measure(&config, w, v).slip + 1e-6f);
}

RC_GTEST_PROP(Property, wheel_loop_never_exceeds_its_duty_and_its_integral_never_its_bound, ()) {
    const wheel_pid_config_t config = rover_config_default().wheel_pid;
    wheel_pid_state_t state = {};
    for (int i = 0; i < 20; ++i) {
        wheel_pid_slew(&config, &state, any_float());
        const wheel_pid_input_t input = {.speed_rad_s = any_float(), .accel_rad_s2 = any_float(), .feed_forward = any_float()};
        RC_ASSERT(std::fabs(wheel_pid_step(&config, &state, &input).duty) <= config.duty_max);
        RC_ASSERT(std::fabs(state.integral) <= config.integral_max);
    }
}

RC_GTEST_PROP(Property, slip_loop_never_exceeds_its_duty, ()) {
    const slip_pi_config_t config = rover_config_default().slip_pi;
    slip_pi_state_t state = {};
    for (int i = 0; i < 20; ++i) {
        const slip_pi_input_t input = {.slip_ref = any_float(), .slip = any_float(), .speed_m_s = any_float()};
        RC_ASSERT(std::fabs(slip_pi_step(&config, &state, &input).duty) <= config.duty_max);
    }
}

RC_GTEST_PROP(Property, no_command_drives_a_rover_whose_emergency_stop_is_active, ()) {
    const control_config_t config = rover_config_default();
    const auto state = std::make_unique<control_state_t>();
    control_reset(&config, state.get());
    for (std::uint32_t tick = 0; tick < 5; ++tick) {
        sensor_frame_t frame = {};
        frame.tick = tick;
        frame.present = *rc::gen::inRange<std::uint32_t>(0, 0x1000);
        frame.battery_count = *rc::gen::arbitrary<std::uint16_t>();
        for (auto &count : frame.current_count) count = *rc::gen::arbitrary<std::uint16_t>();
        for (auto &count : frame.encoder_count) count = *rc::gen::arbitrary<std::int32_t>();
        frame.radar_samples = *rc::gen::arbitrary<std::uint8_t>();
        frame.emergency_stop = tick >= 3;
        command_t command = {};
        command.mode = static_cast<control_mode_t>(*rc::gen::inRange(0, 6));
        command.platform_speed_m_s = any_float();
        command.slip_ref = any_float();
        command.slip_wheels = *rc::gen::arbitrary<std::uint8_t>();
        for (float &duty : command.duty) duty = any_float();
        const trace_t trace = control_step(&config, state.get(), &command, &frame);
        for (const std::int16_t duty : trace.actuator.duty_q15) RC_ASSERT(tick < 3 || duty == 0);
        RC_ASSERT(tick < 3 || trace.actuator.drive != DRIVE_ON);
    }
}

} // namespace
