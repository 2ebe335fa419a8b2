// What control_step writes into its trace is what its modules say of the trace's own numbers; references beyond their range count as its
// end.
#include "firmware/core/motor.h"
#include "firmware/core/rover_config.h"
#include "tests/unit/clutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

// Wheels that turn at 3 rad/s and draw current of their own each, over ground that passes at about the same speed.
sensor_frame_t rolling_frame(uint32_t tick) {
    sensor_frame_t frame = {};
    frame.tick = tick;
    frame.present = ~0u; // everything is there, whatever a frame may hold
    frame.battery_count = 1800;
    frame.radar_samples = 5;
    for (uint32_t n = 0; n < 5; ++n)
        frame.radar_count[n] = static_cast<uint16_t>(512 + 100 * std::cos(2 * clutter::pi * 10 * (5 * tick + n) / 512));
    for (int i = 0; i < WHEEL_COUNT; ++i) {
        frame.encoder_count[i] = static_cast<int32_t>(29 * tick);
        frame.current_count[i] = static_cast<uint16_t>(2048 + 40 * (i + 1));
    }
    return frame;
}

std::vector<trace_t> run(command_t command, uint32_t ticks) {
    const control_config_t config = rover_config_default();
    control_state_t state;
    control_reset(&config, &state);
    std::vector<trace_t> traces;
    for (uint32_t tick = 0; tick < ticks; ++tick) {
        const sensor_frame_t frame = rolling_frame(tick);
        traces.push_back(control_step(&config, &state, &command, &frame));
    }
    return traces;
}

TEST(ControlTrace, holds_torque_and_traction_of_its_own_current_and_speed) {
    command_t command = {};
    command.mode = MODE_WHEEL_SPEED;
    for (float &speed : command.wheel_speed_rad_s) speed = 3;
    const control_config_t config = rover_config_default();
    for (const trace_t &trace : run(command, 100))
        for (const wheel_trace_t &wheel : trace.wheel) {
            const motor_output_t motor = motor_measure(&config.motor, wheel.current_A, wheel.speed_rad_s, wheel.accel_rad_s2);
            EXPECT_EQ(wheel.torque_Nm, motor.torque_Nm);
            EXPECT_EQ(wheel.traction_N, motor.traction_N);
        }
    const trace_t last = run(command, 100).back();
    for (int i = 1; i < WHEEL_COUNT; ++i) EXPECT_GT(last.wheel[i].torque_Nm, last.wheel[i - 1].torque_Nm); // each its own
}

// The bias is the filter's; a wheel's saturation is forgotten in the first tick without one.
TEST(ControlTrace, holds_the_bias_of_the_accelerometer_and_the_saturation_of_its_own_tick) {
    const control_config_t config = rover_config_default();
    control_state_t state;
    control_reset(&config, &state);
    command_t command = {};
    command.mode = MODE_OPEN_LOOP;
    int told = 0;
    for (uint32_t tick = 0; tick < 200; ++tick) {
        sensor_frame_t frame = rolling_frame(tick);
        frame.accel_x_count = 100;
        command.duty[1] = 0.2f;
        command.mode = tick % 20 < 10 ? MODE_WHEEL_SPEED : MODE_STOP;
        for (float &speed : command.wheel_speed_rad_s) speed = 1000; // beyond any duty
        const trace_t trace = control_step(&config, &state, &command, &frame);
        EXPECT_EQ(trace.accel_bias_m_s2, state.ground_speed.bias_m_s2) << tick;
        told += trace.accel_bias_m_s2 < 0.0f || trace.accel_bias_m_s2 > 0.0f ? 1 : 0;
        bool any = false;
        for (const wheel_trace_t &wheel : trace.wheel) any = any || wheel.saturated;
        EXPECT_EQ(state.saturated, any) << tick;
        if (trace.mode == MODE_STOP) {
            EXPECT_FALSE(any) << tick;
        }
    }
    EXPECT_GT(told, 50);
}

std::vector<float> duties(float slip_ref) {
    command_t command = {};
    command.mode = MODE_SLIP;
    command.platform_speed_m_s = 0.17f;
    command.slip_wheels = 2;
    command.slip_ref = slip_ref;
    std::vector<float> out;
    for (const trace_t &trace : run(command, 300)) out.push_back(trace.wheel[1].duty);
    return out;
}

TEST(ControlTrace, a_slip_reference_beyond_one_counts_as_one) {
    EXPECT_EQ(duties(-1.05f), duties(-1));
    EXPECT_EQ(duties(1.05f), duties(1));
    EXPECT_NE(duties(-0.9f), duties(-1)); // and it is the reference that drives
    EXPECT_NE(duties(0.9f), duties(1));
    EXPECT_EQ(duties(std::nanf("")), duties(0));
}

} // namespace
