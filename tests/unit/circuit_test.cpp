// What the motor's circuit says of its encoder: impossible speeds are refused and replaced, contradictions and open windings named.
#include "firmware/core/rover_config.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace {

constexpr double ke = 0.265, Ra = 3.24, supply_V = 7.2, rad_per_count = 2 * M_PI / 6000;

// A rover whose wheels obey (a) of motor.h: the test sets true speeds, the fixture makes encoder and current of them.
class Circuit : public ::testing::Test {
  protected:
    control_config_t config = rover_config_default();
    control_state_t state = {};
    command_t command = {};
    sensor_frame_t frame = {};
    trace_t trace = {};
    double speed_rad_s[WHEEL_COUNT] = {5, 5, 5, 5}, angle_rad[WHEEL_COUNT] = {};
    double Ra_true = Ra, ke_true = ke, V_true = supply_V, dead_V = 0;
    bool frozen[WHEEL_COUNT] = {}, open[WHEEL_COUNT] = {};
    int glitch_count = 0; // added to wheel 1 in the next frame alone

    void SetUp() override {
        config.safety.required = 0;
        control_reset(&config, &state);
        command.mode = MODE_WHEEL_SPEED;
        for (float &speed : command.wheel_speed_rad_s) {
            speed = 5;
        }
        frame.present = 0xffu | FRAME_BATTERY | FRAME_EMERGENCY_STOP;
        frame.battery_count = 1800;
    }
    // Behind the bridge's dead band.
    double current_A(int i) const {
        const double drop_V = static_cast<double>(trace.wheel[i].duty) * V_true - ke_true * speed_rad_s[i];
        return std::copysign(std::fmax(std::fabs(drop_V) - dead_V, 0), drop_V) / Ra_true;
    }
    // Every wheel turns as its motor and a load make it: 0.72 kg a wheel over 0.057 m beside J, and the losses of (18).
    void turn_by_torque(double load_Nm) {
        for (int i = 0; i < WHEEL_COUNT; ++i) {
            const double motor_Nm = open[i] ? 0 : ke_true * current_A(i);
            const double loss_Nm = 0.03 * std::tanh(5 * speed_rad_s[i]) + 1.6e-3 * speed_rad_s[i];
            speed_rad_s[i] += 0.01 * (motor_Nm - loss_Nm - load_Nm) / (5e-3 + 2.3e-3);
        }
    }
    void run(int ticks, int missed = 0) {
        for (int k = 0; k < ticks; ++k) {
            frame.elapsed_ticks = 1 + static_cast<uint32_t>(missed);
            frame.tick += frame.elapsed_ticks;
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                angle_rad[i] += speed_rad_s[i] * 0.01 * (1 + missed);
                if (!frozen[i]) {
                    frame.encoder_count[i] = static_cast<int32_t>(std::floor(angle_rad[i] / rad_per_count));
                }
                const bool driven = trace.actuator.drive >= DRIVE_BRAKE && !open[i];
                frame.current_count[i] = static_cast<uint16_t>(2048 + std::lround((driven ? current_A(i) : 0) / 0.002));
            }
            sensor_frame_t given = frame;
            given.encoder_count[1] += glitch_count;
            glitch_count = 0;
            trace = control_step(&config, &state, &command, &given);
        }
    }
};

TEST_F(Circuit, missed_ticks_do_not_make_a_wheel_faster) {
    for (const int missed : {1, 2, 4}) {
        SetUp(); // what was missed before is forgotten
        run(50);
        run(1, missed);
        for (const wheel_trace_t &wheel : trace.wheel) {
            EXPECT_NEAR(wheel.speed_rad_s, 5, 0.11); // a pulse in 10 ms
            EXPECT_NEAR(wheel.accel_rad_s2, 0, 2.7); // four roundings of a pulse in (2): 0.65 rad/s^2 each
            EXPECT_FALSE(wheel.encoder_refused);
        }
        for (int k = 0; k < 10; ++k) {
            run(1);
            EXPECT_NEAR(trace.wheel[2].accel_rad_s2, 0, 2.7) << k;
        }
        EXPECT_EQ(trace.faults, 0u);
    }
}

// The first and the last tick that a glitch touches, and the eight of (2): nothing of it is left.
TEST_F(Circuit, a_glitch_of_one_tick_is_refused_and_leaves_no_traction_behind) {
    for (const bool driven : {true, false}) {
        command.mode = driven ? MODE_WHEEL_SPEED : MODE_STOP;
        run(100);
        const double traction_N = static_cast<double>(trace.wheel[1].traction_N), duty = static_cast<double>(trace.wheel[1].duty);
        for (const int size : {300, -300, 60, 570}) {
            glitch_count = size;
            for (int k = 0; k < 12; ++k) {
                run(1);
                EXPECT_NEAR(trace.wheel[1].speed_rad_s, 5, 0.22) << size << " " << k;
                // J times the rounding of (2) over R, 0.65 rad/s^2 4 times, and 2 counts of current
                EXPECT_NEAR(trace.wheel[1].traction_N, traction_N, 0.3) << size << " " << k;
                EXPECT_NEAR(trace.wheel[1].duty, duty, 0.06) << size << " " << k; // Kp times a pulse
            }
            EXPECT_EQ(trace.faults, 0u);
        }
    }
}

TEST_F(Circuit, a_frozen_encoder_is_named_within_half_a_second_and_its_wheel_never_driven_full) {
    for (const double cruise : {2.0, 5.0, 12.0}) {
        SetUp();
        frozen[2] = false;
        for (int i = 0; i < WHEEL_COUNT; ++i) {
            speed_rad_s[i] = cruise;
            command.wheel_speed_rad_s[i] = static_cast<float>(cruise);
        }
        run(200);
        ASSERT_EQ(trace.faults, 0u);
        frozen[2] = true;
        int ticks = 0;
        for (; ticks < 100 && trace.faults == 0u; ++ticks) {
            run(1);
            EXPECT_LT(std::fabs(trace.wheel[2].duty), 0.95f) << cruise << " " << ticks;
        }
        EXPECT_LE(ticks, 50) << cruise;
        EXPECT_EQ(trace.faults, static_cast<uint32_t>(FAULT_ENCODER_CIRCUIT)) << cruise;
        EXPECT_EQ(trace.fault_wheels, 4u);
        EXPECT_EQ(trace.actuator.drive, DRIVE_BRAKE);
    }
}

// A wheel that a stone stops does stand: its current says so, and the encoder is believed within the tick that follows.
TEST_F(Circuit, a_jammed_wheel_is_believed) {
    run(200);
    speed_rad_s[3] = 0;
    run(2);
    EXPECT_FALSE(trace.wheel[3].encoder_refused);
    EXPECT_NEAR(trace.wheel[3].speed_rad_s, 0, 0.11);
    run(60);
    EXPECT_EQ(trace.faults & FAULT_ENCODER_CIRCUIT, 0u);
}

// It may stop at any moment of a tick: the encoder tells the tick's mean and the current its end, of a winding that may be warm and behind
// leads that a stalled motor draws down. Four that stop at once are a wall, not four broken encoders.
TEST_F(Circuit, wheels_that_jam_at_any_moment_of_a_tick_are_believed) {
    for (const unsigned mask : {1u, 3u, 15u}) {
        for (const double warm : {1.0, 1.3}) {
            for (const double V : {supply_V, 0.93 * supply_V}) {
                for (int tenth = 0; tenth <= 10; ++tenth) {
                    SetUp();
                    frame.tick = 0, trace = {}, Ra_true = warm * Ra, V_true = supply_V;
                    for (double &speed : speed_rad_s) speed = 5;
                    run(200);
                    ASSERT_EQ(trace.faults, 0u);
                    V_true = V;
                    for (int i = 0; i < WHEEL_COUNT; ++i) {
                        if ((mask >> i & 1u) == 0) continue;
                        angle_rad[i] += 0.1 * tenth * speed_rad_s[i] * 0.01;
                        speed_rad_s[i] = 0;
                    }
                    run(3);
                    for (const wheel_trace_t &wheel : trace.wheel)
                        EXPECT_FALSE(wheel.encoder_refused) << mask << ' ' << warm << ' ' << tenth;
                    run(60);
                    EXPECT_EQ(trace.faults & FAULT_ENCODER_CIRCUIT, 0u) << mask << ' ' << warm << ' ' << tenth;
                }
            }
        }
    }
}

// Level hard ground, the least that a driving motor draws: the other wheels drag the dead one, 1 % slower.
TEST_F(Circuit, an_open_winding_is_named_and_the_rover_drives_on) {
    for (int tick = 0; tick < 200; ++tick) {
        turn_by_torque(0.0);
        run(1);
    }
    EXPECT_NEAR(speed_rad_s[0], 5, 0.1);
    EXPECT_EQ(trace.faults, 0u);
    open[0] = true;
    int ticks = 0;
    for (; ticks < 100 && trace.faults == 0u; ++ticks) {
        turn_by_torque(0.0);
        speed_rad_s[0] = 0.99 * speed_rad_s[1];
        run(1);
    }
    EXPECT_LE(ticks, 50);
    EXPECT_EQ(trace.faults, static_cast<uint32_t>(FAULT_MOTOR_OPEN));
    EXPECT_EQ(trace.fault_wheels, 1u);
    EXPECT_EQ(trace.actuator.drive, DRIVE_ON);
}

// One wheel that draws on less voltage than the dead one has is witness enough, whichever of the two has the lower number; one that needs
// more voltage than the dead one has is none.
TEST_F(Circuit, any_wheel_is_witness_to_an_open_winding_and_one_that_needs_more_voltage_is_not) {
    for (const int dead : {0, 3}) {
        for (const bool less : {true, false}) {
            SetUp();
            trace = {};
            command.mode = MODE_OPEN_LOOP;
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                speed_rad_s[i] = 5;
                command.duty[i] = static_cast<float>(ke * 5 / supply_V); // no voltage is left, no current flows
            }
            command.duty[dead] += 0.1f;                    // 0.72 V, 0.22 A, were it whole
            command.duty[3 - dead] += less ? 0.05f : 0.2f; // the one other that draws
            open[dead] = true;
            run(100);
            EXPECT_EQ(trace.faults & FAULT_MOTOR_OPEN, less ? static_cast<uint32_t>(FAULT_MOTOR_OPEN) : 0u) << dead << less;
            EXPECT_EQ(trace.fault_wheels, less ? 1u << static_cast<uint32_t>(dead) : 0u) << dead << less;
            open[dead] = false;
        }
    }
}

// A bridge whose dead time takes 1.5 V, the most of the catalogue, passes no current on less: no encoder and no winding is to blame.
TEST_F(Circuit, a_dead_band_of_the_bridges_is_neither_a_frozen_encoder_nor_an_open_winding) {
    for (const double load_Nm : {0.0, 0.05, 0.15})
        for (const float speed : {5.0f, 1.0f, -5.0f}) {
            SetUp();
            dead_V = 1.5;
            for (double &now : speed_rad_s) now = 0;
            for (float &asked : command.wheel_speed_rad_s) asked = speed;
            for (int tick = 0; tick < 800; ++tick) {
                if (tick == 500) // and slower again
                    for (float &asked : command.wheel_speed_rad_s) asked = 0.3f * speed;
                turn_by_torque(speed > 0 ? load_Nm : -load_Nm);
                run(1);
                ASSERT_EQ(trace.faults, 0u) << load_Nm << " N m, " << speed << " rad/s, tick " << tick;
            }
        }
}

// Downhill the ground turns the wheels, and a motor may draw nothing at all for long.
TEST_F(Circuit, a_motor_that_the_slope_relieves_is_not_called_open) {
    for (int tick = 0; tick < 3000; ++tick) {
        turn_by_torque(-0.08 * tick / 3000); // N m: from level ground to 11 deg for a wheel of 0.72 kg
        run(1);
        ASSERT_EQ(trace.faults, 0u) << tick;
    }
    EXPECT_LT(trace.wheel[0].current_A, -0.05f);
}

// A winding 37 % hotter, magnets and battery divider 10 % weaker, in both directions, through starts, stops and reversals.
TEST_F(Circuit, a_motor_unlike_its_description_is_not_called_broken) {
    for (const double hot : {1.37, 0.85}) {
        for (const double weak : {0.9, 1.1}) {
            SetUp();
            Ra_true = Ra * hot;
            ke_true = ke * weak;
            trace = {};
            double target = 0;
            for (int tick = 0; tick < 3000; ++tick) {
                if (tick % 300 == 0) {
                    target = (tick / 300 % 4 - 1.5) * 8; // -12, -4, 4, 12 rad/s
                }
                for (float &speed : command.wheel_speed_rad_s) {
                    speed = static_cast<float>(target);
                }
                turn_by_torque(0.0);
                run(1);
                ASSERT_EQ(trace.faults & (FAULT_ENCODER_CIRCUIT | FAULT_MOTOR_OPEN), 0u) << hot << " " << weak << " " << tick;
            }
        }
    }
}

TEST_F(Circuit, any_number_is_accepted) {
    const float odd[] = {0.0f, -0.0f, 1e30f, -1e30f, std::nanf(""), INFINITY, 1e-40f};
    for (const float a : odd) {
        for (const float b : odd) {
            circuit_state_t circuit = {};
            sense_state_t sense_state = {};
            sense_output_t sense = {};
            circuit.refused = 0xfu;
            const float duty[WHEEL_COUNT] = {a, b, a, b};
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                sense.speed_rad_s[i] = b;
                sense.current_A[i] = a;
                circuit.past[0].speed_rad_s[i] = circuit.past[1].speed_rad_s[i] = a;
                circuit.circuit_V[i] = b;
            }
            sense.battery_V = b;
            sense.jumped = 0xfu;
            sense.usable = 0x1ffu;
            sense.elapsed_ticks = 1;
            const circuit_input_t input = {.duty = duty, .driven = true, .look = true};
            for (int k = 0; k < 40; ++k) {
                circuit_step(&config.circuit, &circuit, &input, &config.sense, &sense_state, &sense);
                sense.battery_V = b;
            }
        }
    }
}

// (1) to (4) in double, of any measurements in any order: which speed each wheel is given, and what is named.
struct CircuitModel {
    struct Wheel {
        bool refused = false;
        int refused_ticks = 0, contradicts = 0, opens = 0;
        double left_V = 0, from_A = 0;
        double speed[2] = {}, current[2] = {}, duty[2] = {}; // of the last tick, and of the one before
    } wheel[WHEEL_COUNT];
    double supply_V[2] = {};
    bool driven[2] = {};
    int turn = 0;
    double margin = 1; // how near the nearest decision was to its limit, as a share

    bool beyond(double a, double b) {
        margin = std::fmin(margin, std::fabs(a - b) / (std::fabs(a) + std::fabs(b) + 1e-9));
        return a > b;
    }

    // Between the last speed and what the circuit makes of it an encoder's mean over a tick may lie anywhere.
    bool believes(double said, double old, double expected, double through_A, double jump) {
        const double off = std::fmax(std::fmax(std::fmin(old, expected) - said, said - std::fmax(old, expected)), 0);
        const bool explained = beyond(std::fabs(said - old) / 2, off);                  // at least half of it
        return explained || !beyond(off, jump + 0.35 * Ra * std::fabs(through_A) / ke); // (4), and the winding's resistance
    }
};

TEST(CircuitSteps, any_measurements_are_judged_by_the_four_equations) {
    const control_config_t whole = rover_config_default();
    const circuit_config_t &config = whole.circuit;
    uint64_t seed = 5;
    const auto next = [&](unsigned n) { return static_cast<int>(((seed = seed * 6364136223846793005u + 1442695040888963407u) >> 33) % n); };
    const auto between = [&](double low, double high) { return low + (high - low) * next(1000000) / 1e6; };
    int refused = 0, believed = 0, held = 0, contradicted = 0, long_refused = 0, broken = 0, without = 0, late = 0;
    for (int drive = 0; drive < 120; ++drive) {
        CircuitModel model;
        circuit_state_t state = {};
        sense_state_t sense_state = {};
        float duty[WHEEL_COUNT] = {};
        double true_speed[WHEEL_COUNT] = {}, bias[WHEEL_COUNT] = {};
        const bool steady = drive % 2 == 0, dead_band = drive % 8 == 3;
        for (double &b : bias) b = next(3) == 0 ? between(-14, 14) : 0; // an encoder that lies for good
        const int open = next(6), frozen = drive % 5 == 1 ? next(4) : -1;
        for (int k = 0; k < 160; ++k) {
            sense_output_t sense = {};
            sense.usable = 0xfff;
            for (uint32_t bit = 0; bit < 9; ++bit)
                if (next(steady ? 200 : 25) == 0) sense.usable &= ~(1u << bit);
            sense.battery_V = static_cast<float>(between(7.0, 7.4));
            const bool driven = next(steady ? 100 : 12) != 0, look = next(5) != 0;
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                true_speed[i] += between(-0.3, 0.3);
                if (k == 0 || next(60) == 0) duty[i] = static_cast<float>(between(-1, 1));
                const double back = static_cast<double>(duty[i]) * supply_V - ke * true_speed[i];
                const double V = dead_band && std::fabs(back) < 1 ? 0 : back;
                sense.current_A[i] = i == open ? static_cast<float>(between(-0.03, 0.03)) : static_cast<float>(V / Ra * between(0.9, 1.1));
                const double jump = next(12) == 0 ? between(-8, 8) : 0;
                if (next(40) == 0) true_speed[i] += jump; // what a stone does, and the current tells
                const double says = i == frozen ? 3.0 : true_speed[i] + bias[i] + (next(2) == 0 ? 0 : jump);
                sense.speed_rad_s[i] = static_cast<float>(says);
                if (next(8) == 0 || jump != 0) sense.jumped |= 1u << static_cast<unsigned>(i);
            }
            const sense_output_t was = sense;
            const circuit_input_t input = {.duty = duty, .driven = driven, .look = look};
            const circuit_output_t out = circuit_step(&config, &state, &input, &whole.sense, &sense_state, &sense);
            uint32_t expect_refused = 0, expect_contradict = 0, expect_broken = 0;
            double speed[WHEEL_COUNT];
            model.margin = 1;
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                auto &wheel = model.wheel[i];
                const uint32_t bit = 1u << static_cast<unsigned>(i);
                const double says = static_cast<double>(was.speed_rad_s[i]), current = static_cast<double>(was.current_A[i]);
                const double old = wheel.speed[0], now_V = static_cast<double>(duty[i]) * static_cast<double>(was.battery_V) - Ra * current;
                const auto left_V = [&](int ago) { return wheel.duty[ago] * model.supply_V[ago] - Ra * wheel.current[ago]; };
                speed[i] = says;
                if (((was.jumped & bit) != 0 || wheel.refused) && (was.usable & bit) != 0) {
                    if (driven && model.driven[0] && (was.usable & FRAME_CURRENT_0 << static_cast<unsigned>(i)) != 0) {
                        const double from_A = wheel.refused ? wheel.from_A : wheel.current[0],
                                     jump = static_cast<double>(config.jump_rad_s);
                        const double expected = old + (now_V - (wheel.refused ? wheel.left_V : left_V(0))) / ke; // (1)
                        const bool one = model.believes(says, old, expected, current - from_A, jump);
                        const bool two = !one && !wheel.refused && model.driven[1] &&
                                         model.believes(says, wheel.speed[1], wheel.speed[1] + (now_V - left_V(1)) / ke,
                                                        current - wheel.current[1], jump);
                        late += two ? 1 : 0;
                        wheel.refused = !one && !two;
                        (wheel.refused ? refused : believed) += 1;
                        wheel.refused_ticks = wheel.refused ? wheel.refused_ticks + 1 : 0;
                        if (wheel.refused) wheel.left_V = now_V, wheel.from_A = from_A, speed[i] = expected;
                    } else { // nothing to judge by: for three ticks at most
                        const bool back = !model.beyond(std::fabs(says - old), static_cast<double>(config.jump_rad_s));
                        wheel.refused = !back && wheel.refused_ticks < 3;
                        wheel.refused_ticks = wheel.refused ? wheel.refused_ticks + 1 : 0;
                        if (wheel.refused) wheel.left_V = left_V(0), wheel.from_A = wheel.current[0], speed[i] = old, held++;
                    }
                }
                speed[i] = wheel.refused && speed[i] != says ? std::clamp(speed[i], -60.0, 60.0) : speed[i];
                expect_refused |= wheel.refused ? bit : 0;
                if (wheel.refused_ticks > 30) expect_contradict |= bit, long_refused++; // 0.3 s
            }
            const auto across = [&](int i) { return static_cast<double>(duty[i]) * static_cast<double>(was.battery_V) - ke * speed[i]; };
            if (look) { // (2), (3) of one wheel
                const int i = model.turn;
                auto &wheel = model.wheel[i];
                const auto u = static_cast<unsigned>(i);
                const double current = static_cast<double>(was.current_A[i]), mine = std::fabs(across(i)), emf = std::fabs(ke * speed[i]);
                const uint32_t needed = FRAME_BATTERY | FRAME_ENCODER_0 << u | FRAME_CURRENT_0 << u;
                bool opens = false, contradicts = false;
                if ((was.usable & needed) == needed && driven && model.driven[0]) {
                    bool others = false;
                    for (int other = 0; other < WHEEL_COUNT; ++other)
                        others = others || (other != i && (was.usable & FRAME_CURRENT_0 << static_cast<unsigned>(other)) != 0 &&
                                            model.beyond(std::fabs(static_cast<double>(was.current_A[other])), 2 * 0.02 * 7.2 / Ra) &&
                                            model.beyond(mine, std::fabs(across(other))));
                    const double over = mine - 0.1 * emf;
                    opens = model.beyond(0.02 * 7.2 / Ra, std::fabs(current)) && model.beyond(over, 0.07 * 7.2) &&
                            (model.beyond(over, 0.22 * 7.2) || others);
                    contradicts = !opens && model.beyond(std::fabs(across(i) - Ra * current),
                                                         0.22 * 7.2 + 0.35 * std::fabs(Ra * current) + 0.25 * emf);
                } else {
                    without++;
                }
                wheel.opens = opens ? wheel.opens + 1 : 0;
                wheel.contradicts = contradicts ? wheel.contradicts + 1 : 0;
                if (wheel.opens >= 6) expect_broken |= 1u << u, broken++;
                if (wheel.contradicts >= 8) expect_contradict |= 1u << u, contradicted++;
                model.turn = (i + 1) % WHEEL_COUNT;
            }
            if (model.margin < 1e-4) break; // either is right, and what follows hangs on it
            ASSERT_EQ(out.refused, expect_refused) << drive << ' ' << k;
            ASSERT_EQ(out.contradict, expect_contradict) << drive << ' ' << k;
            ASSERT_EQ(out.broken, expect_broken) << drive << ' ' << k;
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                auto &wheel = model.wheel[i];
                ASSERT_NEAR(sense.speed_rad_s[i], speed[i], 1e-3) << drive << ' ' << k << ' ' << i;
                wheel.speed[1] = wheel.speed[0], wheel.current[1] = wheel.current[0], wheel.duty[1] = wheel.duty[0];
                wheel.speed[0] = static_cast<double>(sense.speed_rad_s[i]);
                wheel.current[0] = static_cast<double>(was.current_A[i]);
                wheel.duty[0] = static_cast<double>(duty[i]);
            }
            model.supply_V[1] = model.supply_V[0], model.driven[1] = model.driven[0];
            model.supply_V[0] = static_cast<double>(was.battery_V);
            model.driven[0] = driven;
        }
    }
    EXPECT_GT(std::min({refused, believed, held, contradicted, long_refused, broken, without, late}), 20)
        << refused << ' ' << believed << ' ' << held << ' ' << contradicted << ' ' << long_refused << ' ' << broken << ' ' << without << ' '
        << late;
}

} // namespace
