// The check names each way a log can be spoilt, and nothing on a log that is sound.
#include "files.h"
#include "synthetic.h"

#include "host_tools/check/check.h"

#include <cstdint>
#include <functional>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

using namespace traction;
using namespace traction::test;
using check::Severity;

namespace {

std::string listed(const check::Report &report, Severity from) {
    std::string out;
    for (const check::Finding &finding : report.findings) {
        if (finding.severity < from) continue;
        out.append(check::severity_name(finding.severity))
            .append(" ")
            .append(finding.id)
            .append(" [")
            .append(finding.signal)
            .append("] ")
            .append(finding.text)
            .append("\n");
    }
    return out;
}

check::Machine spec_rover() {
    return {.wheel_radius_m = 0.057, .back_emf_Vs = 0.265, .resistance_ohm = 3.24, .wheels_point_forward = true};
}

// Exactly this finding at warning level or above, with and without knowledge of the machine.
void expect_only(const log::Log &log, const std::string &id, const std::string &signal, Severity severity,
                 const std::vector<log::Repair> &repairs = {}, std::size_t how_many = 1) {
    for (const bool known : {false, true}) {
        const check::Report report = check::check(log, repairs, known ? spec_rover() : check::Machine{});
        const check::Finding *finding = report.find(id, signal);
        ASSERT_NE(finding, nullptr) << (known ? "machine known\n" : "machine unknown\n") << listed(report, Severity::note);
        EXPECT_EQ(finding->severity, severity);
        EXPECT_FALSE(finding->mend.empty());
        EXPECT_EQ(report.passed(), severity != Severity::error);
        std::size_t others = 0;
        for (const check::Finding &other : report.findings) others += other.severity >= Severity::warning;
        EXPECT_EQ(others, how_many) << (known ? "machine known\n" : "machine unknown\n") << listed(report, Severity::warning);
    }
}

log::Log good() { return drive({}); }

// Drops samples of all signals (or one) for which `drop` holds.
void thin(log::Log &log, const std::string &only, const std::function<bool(double)> &drop) {
    for (log::Signal &signal : log.signals) {
        if (!only.empty() && signal.name != only) continue;
        log::Signal kept{signal.name, {}, {}};
        for (std::size_t i = 0; i < signal.t_s.size(); ++i) {
            if (drop(signal.t_s[i])) continue;
            kept.t_s.push_back(signal.t_s[i]);
            kept.value.push_back(signal.value[i]);
        }
        signal = std::move(kept);
    }
}

} // namespace

TEST(Check, finds_nothing_at_all_on_a_sound_and_rich_log) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        for (const check::Machine &machine : {check::Machine{}, spec_rover()})
            EXPECT_EQ(listed(check::check(drive({.seed = seed}), {}, machine), Severity::note), "") << "seed " << seed;
    }
}

TEST(Check, raises_no_alarm_on_noisy_slippery_or_dull_logs) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        for (const check::Machine &machine : {check::Machine{}, spec_rover()}) {
            EXPECT_EQ(listed(check::check(drive({.seed = seed, .noise = 3}), {}, machine), Severity::warning), "")
                << "noisy, seed " << seed;
            EXPECT_EQ(listed(check::check(drive({.seed = seed, .soil_noise_N = 0.5, .grip_N = 2.5}), {}, machine), Severity::warning), "")
                << "slippery, seed " << seed;
            EXPECT_TRUE(check::check(drive({.seed = seed, .rich = false}), {}, machine).passed()) << "dull, seed " << seed;
        }
    }
}

TEST(Check, names_a_wrong_sign) {
    for (const char *name : {"wheel2.speed_rad_s", "wheel1.current_A", "wheel3.duty", "imu.accel_x_m_s2", "imu.gyro_z_rad_s", "camera.y_m",
                             "battery.voltage_V"}) {
        SCOPED_TRACE(name);
        log::Log log = good();
        scale(log, name, -1);
        if (std::string(name) == "battery.voltage_V") {
            EXPECT_NE(check::check(log, {}).find("sign", name), nullptr);
        } else {
            expect_only(log, "sign", name, Severity::error);
        }
    }
}

// A caster, or a motor whose encoder nobody logged: the wheels that turn are judged, the others are no wheels of that rule.
TEST(Check, judges_the_wheels_whose_speed_was_logged) {
    for (const std::string unknown : {"wheel3", "wheel0"}) {
        log::Log log = good();
        std::erase_if(log.signals,
                      [&](const log::Signal &s) { return s.name == unknown + ".speed_rad_s" || s.name == unknown + ".encoder_count"; });
        EXPECT_TRUE(check::check(log, {}).passed()) << unknown;
        const check::Report report = check::check(log, {}, spec_rover());
        EXPECT_EQ(report.find("sign", "wheel1.speed_rad_s"), nullptr) << unknown;
    }
}

TEST(Check, names_a_rover_of_other_wheels_than_the_model) {
    log::Log log = good();
    log.header["rover.wheels"] = "6";
    check::Machine machine = spec_rover();
    EXPECT_TRUE(check::check(log, {}, machine).passed()); // nothing is known of the model's wheels
    machine.wheel_y_m = {0.12, -0.12, 0.12, -0.12};
    const check::Report report = check::check(log, {}, machine);
    ASSERT_NE(report.find("wheels"), nullptr);
    EXPECT_NE(report.find("wheels")->text.find("drives 6 wheels"), std::string::npos);
    EXPECT_FALSE(report.passed());
    log.header["rover.wheels"] = "4";
    EXPECT_EQ(check::check(log, {}, machine).find("wheels"), nullptr);
}

TEST(Check, names_a_radar_that_is_negative_forwards) {
    log::Log log = good();
    log::Signal &radar = at(log, "radar.speed_m_s");
    const log::Signal &wheel = at(log, "wheel0.speed_rad_s");
    for (std::size_t i = 0; i < radar.value.size(); ++i) {
        if (wheel.value[50 * i] > 0) radar.value[i] *= -1; // a radar that knows the direction, mounted the wrong way round
    }
    expect_only(log, "sign", "radar.speed_m_s", Severity::error);
}

TEST(Check, names_a_heading_that_is_turned_and_one_by_half_a_turn) {
    log::Log log = good();
    for (double &yaw : at(log, "camera.yaw_rad").value) yaw += 1.0;
    expect_only(log, "heading", "camera.yaw_rad", Severity::error);
    EXPECT_NEAR(check::check(log, {}).find("heading")->value, 1.0, 0.05); // yaw noise 5 mrad, side drift of the camera's slope 0.02
    log = good();
    for (double &yaw : at(log, "camera.yaw_rad").value) yaw += 3.14159265;
    expect_only(log, "sign", "camera.yaw_rad", Severity::error);
}

TEST(Check, names_a_wrong_unit) {
    const struct {
        const char *signal;
        double factor;
        const char *word;
    } cases[] = {{"wheel1.speed_rad_s", 9.5493, "rpm"},  {"wheel1.speed_rad_s", 57.2958, "deg/s"},
                 {"wheel3.current_A", 1000, "mA"},       {"imu.gyro_z_rad_s", 57.2958, "deg/s"},
                 {"imu.accel_x_m_s2", 1 / 9.80665, "g"}, {"camera.yaw_rad", 57.2958, "degrees"},
                 {"radar.speed_m_s", 1000, "mm"},        {"wheel0.duty", 100, "duty"},
                 {"battery.voltage_V", 1000, "mV"}};
    for (const auto &one : cases) {
        SCOPED_TRACE(std::string(one.signal) + " in " + one.word);
        log::Log log = good();
        scale(log, one.signal, one.factor);
        const check::Finding *finding = check::check(log, {}).find("unit", one.signal);
        ASSERT_NE(finding, nullptr) << listed(check::check(log, {}), Severity::note);
        const check::Report report = check::check(log, {}, spec_rover());
        ASSERT_NE(report.find("unit", one.signal), nullptr) << listed(report, Severity::note);
        EXPECT_NE(report.find("unit", one.signal)->text.find(one.word), std::string::npos) << report.find("unit", one.signal)->text;
        if (std::string(one.signal) != "battery.voltage_V") expect_only(log, "unit", one.signal, Severity::error);
    }
}

TEST(Check, names_a_unit_that_is_wrong_on_every_wheel) {
    for (const double factor : {9.5493, 57.2958}) {
        log::Log log = good();
        for (int i = 0; i < 4; ++i) scale(log, "wheel" + std::to_string(i) + ".speed_rad_s", factor);
        const check::Report unknown = check::check(log, {}), known = check::check(log, {}, spec_rover());
        ASSERT_NE(unknown.find("unit", "wheel.speed_rad_s"), nullptr) << listed(unknown, Severity::note);
        EXPECT_NE(unknown.find("unit", "wheel.speed_rad_s")->text.find(factor < 20 ? "rpm" : "deg/s"), std::string::npos)
            << unknown.find("unit")->text;
        for (int i = 0; i < 4; ++i)
            EXPECT_NE(known.find("unit", "wheel" + std::to_string(i) + ".speed_rad_s"), nullptr) << listed(known, Severity::note);
    }
    log::Log log = good();
    for (int i = 0; i < 4; ++i) scale(log, "wheel" + std::to_string(i) + ".current_A", 1000);
    for (int i = 0; i < 4; ++i) EXPECT_NE(check::check(log, {}).find("unit", "wheel" + std::to_string(i) + ".current_A"), nullptr);
    log = good();
    for (const char *name : {"camera.x_m", "camera.y_m"}) scale(log, name, 1000);
    expect_only(log, "unit", "camera.x_m", Severity::error);
}

// Angles are no speeds: what is said of them is an angle's unit.
TEST(Check, names_angles_in_degrees) {
    for (const bool every : {true, false}) {
        log::Log log = good();
        for (int i = 0; i < 4; ++i) {
            log::Signal &speed = at(log, "wheel" + std::to_string(i) + ".speed_rad_s");
            double angle = 0;
            for (std::size_t k = 0; k < speed.value.size(); ++k) {
                const double rad_s = speed.value[k];
                if (k > 0) angle += rad_s * (speed.t_s[k] - speed.t_s[k - 1]);
                speed.value[k] = angle * (every || i == 1 ? 57.29577951 : 1);
            }
            speed.name = "wheel" + std::to_string(i) + ".angle_rad";
        }
        const check::Report report = check::check(log, {}, {});
        const check::Finding *finding = report.find("unit", every ? "wheel.angle_rad" : "wheel1.angle_rad");
        ASSERT_NE(finding, nullptr) << listed(report, Severity::note);
        EXPECT_NE(finding->text.find("like degrees"), std::string::npos) << finding->text;
        EXPECT_EQ(finding->text.find("deg/s"), std::string::npos) << finding->text;
    }
}

// What the model says of the currents is enough: no header is asked for beside it. A current with its sign is no magnitude.
TEST(Check, knows_currents_as_magnitudes_by_the_model_as_by_the_header) {
    check::Machine machine = spec_rover();
    machine.unsigned_current = true;
    log::Log folded = good(), by_header = good();
    for (log::Log *log : {&folded, &by_header})
        for (int i = 0; i < 4; ++i)
            for (double &v : at(*log, "wheel" + std::to_string(i) + ".current_A").value) v = std::fabs(v);
    EXPECT_NE(check::check(folded, {}, spec_rover()).find("magnitude"), nullptr);
    EXPECT_EQ(listed(check::check(folded, {}, machine), Severity::warning), "");
    for (int i = 0; i < 4; ++i) by_header.header["unsigned.wheel" + std::to_string(i) + ".current_A"] = "1";
    EXPECT_EQ(listed(check::check(by_header, {}, spec_rover()), Severity::warning), "");
    const check::Report of_signed = check::check(good(), {}, machine);
    ASSERT_NE(of_signed.find("magnitude", "wheel0.current_A"), nullptr);
    EXPECT_NE(of_signed.find("magnitude")->text.find("is declared a magnitude, but reaches -"), std::string::npos);
}

// The catalogue's radar_delay goes to 1 s: what lies within it the lab names, what is later or early the check refuses.
TEST(Check, names_a_radar_that_is_later_than_its_law_goes_or_early) {
    const auto late = [](double seconds) {
        log::Log log = good();
        for (double &t : at(log, "radar.speed_m_s").t_s) t += seconds;
        const check::Report report = check::check(log, {}, {});
        return report.find("late", "radar.speed_m_s") != nullptr;
    };
    for (const double seconds : {0.0, 0.3, 0.7, 0.9}) EXPECT_FALSE(late(seconds)) << seconds;
    for (const double seconds : {1.4, 1.6, -0.8}) EXPECT_TRUE(late(seconds)) << seconds;
}

TEST(Check, names_swapped_wheels) {
    for (const char *quantity : {"current_A", "speed_rad_s", "duty"}) {
        SCOPED_TRACE(quantity);
        log::Log log = good();
        exchange(log, std::string("wheel0.") + quantity, std::string("wheel3.") + quantity);
        if (std::string(quantity) == "speed_rad_s") exchange(log, "wheel0.encoder_count", "wheel3.encoder_count");
        expect_only(log, "swapped_wheels", std::string("wheel0.") + quantity, Severity::error);
    }
}

TEST(Check, names_left_and_right_exchanged) {
    log::Log log = good();
    for (const char *quantity : {"current_A", "speed_rad_s", "duty", "encoder_count"}) {
        exchange(log, std::string("wheel0.") + quantity, std::string("wheel1.") + quantity);
        exchange(log, std::string("wheel2.") + quantity, std::string("wheel3.") + quantity);
    }
    expect_only(log, "swapped_wheels", "wheel.speed_rad_s", Severity::error);
}

TEST(Check, names_samples_that_are_missing) {
    log::Log log = good();
    Random random(3);
    thin(log, "wheel1.current_A", [&](double) { return random.uniform() < 0.3; });
    expect_only(log, "samples_missing", "wheel1.current_A", Severity::error);
    EXPECT_NEAR(check::check(log, {}).find("samples_missing")->value, 0.3, 0.03); // 8000 trials at 0.3: 3 sigma is 0.015
    log = good();
    thin(log, "", [&](double t) { return std::fmod(t * 7919.0, 1.0) < 0.3; });
    EXPECT_NE(check::check(log, {}).find("samples_missing", "wheel0.speed_rad_s"), nullptr);
}

// One clock is told once, with how many signals have it; another clock by itself.
TEST(Check, names_a_clock_that_jitters_once) {
    log::Log log = good();
    const auto shake = [](log::Signal &signal, double share) {
        for (std::size_t k = 1; k + 1 < signal.t_s.size(); ++k)
            signal.t_s[k] += share * 0.01 * (k % 3 == 0 ? 1.0 : k % 3 == 1 ? -1.0 : 0.0);
    };
    std::size_t shaken = 0;
    for (log::Signal &signal : log.signals) {
        const double period_s = signal.t_s.size() > 1 ? signal.t_s[1] - signal.t_s[0] : 0;
        if (std::fabs(period_s - 0.01) > 1e-6) continue;
        shake(signal, signal.name == "imu.accel_x_m_s2" ? 0.3 : 0.4);
        shaken += signal.name != "imu.accel_x_m_s2";
    }
    ASSERT_GT(shaken, 8U);
    const check::Report report = check::check(log, {});
    std::vector<const check::Finding *> told;
    for (const check::Finding &f : report.findings)
        if (f.id == "jitter") told.push_back(&f);
    ASSERT_EQ(told.size(), 2U) << listed(report, Severity::note);
    for (const check::Finding *f : told) {
        const bool alone = f->signal == "imu.accel_x_m_s2";
        EXPECT_EQ(f->text.find("others beside it") == std::string::npos, alone) << f->text;
        EXPECT_EQ(f->text.find("and of " + std::to_string(shaken - 1) + " others") == std::string::npos, alone) << f->text;
    }
}

TEST(Check, names_a_gap_and_a_clock_that_jumps) {
    log::Log log = good();
    thin(log, "", [](double t) { return t > 7 && t < 9; });
    expect_only(log, "gap", "", Severity::warning);
    EXPECT_NEAR(check::check(log, {}).find("gap")->value, 2, 0.05); // to the next sample at 100 Hz
    log = good();
    for (log::Signal &signal : log.signals) {
        for (double &t : signal.t_s) t += t > 7 ? 5 : 0;
    }
    expect_only(log, "clock_jump", "", Severity::error);
    EXPECT_NEAR(check::check(log, {}).find("clock_jump")->value, 5, 0.05);
}

TEST(Check, names_a_clock_set_back_that_the_reader_refuses) {
    std::string text = "# format: traction-log 1\nt_s,wheel0.speed_rad_s\n";
    for (int i = 0; i < 1000; ++i) text += std::to_string(i < 600 ? 0.01 * i : 0.01 * i - 2) + ",1\n";
    const File file("back.csv", text);
    const check::Report report = check::check_file(file.path());
    ASSERT_NE(report.find("clock_jump"), nullptr);
    EXPECT_FALSE(report.passed());
}

TEST(Check, names_a_dead_and_a_stuck_sensor_and_not_a_blocked_wheel) {
    for (const char *name : {"wheel1.speed_rad_s", "wheel2.current_A", "imu.gyro_z_rad_s", "imu.accel_x_m_s2"}) {
        SCOPED_TRACE(name);
        log::Log dead = good(), stuck = good();
        for (double &v : at(dead, name).value) v = 0;
        EXPECT_NE(check::check(dead, {}).find("dead_sensor", name), nullptr) << listed(check::check(dead, {}), Severity::note);
        log::Signal &signal = at(stuck, name);
        for (std::size_t i = 500; i < 900; ++i) signal.value[i] = signal.value[500];
        EXPECT_NE(check::check(stuck, {}).find("stuck_sensor", name), nullptr) << listed(check::check(stuck, {}), Severity::note);
    }
    log::Log log = good();
    for (const char *name : {"camera.x_m", "camera.y_m", "camera.yaw_rad"}) {
        log::Signal &signal = at(log, name);
        for (std::size_t i = 30; i < 65; ++i) signal.value[i] = signal.value[30];
    }
    EXPECT_NE(check::check(log, {}).find("stuck_sensor", "camera.x_m"), nullptr);
    log = good(); // wheel 0 is held fast for 4 s: its winding takes the whole voltage
    log::Signal &speed = at(log, "wheel0.speed_rad_s"), &current = at(log, "wheel0.current_A"), &count = at(log, "wheel0.encoder_count");
    const log::Signal &duty = at(log, "wheel0.duty"), &battery = at(log, "battery.voltage_V");
    const double turned = count.value[900] - count.value[500];
    for (std::size_t i = 500; i < speed.value.size(); ++i) {
        if (i < 900)
            speed.value[i] = 0, current.value[i] = duty.value[i] * battery.value[i] / 3.24, count.value[i] = count.value[500];
        else
            count.value[i] -= turned;
    }
    EXPECT_EQ(listed(check::check(log, {}), Severity::warning), "");
}

// A loop's integral rests inside its bridge's dead band: the wheel stands for seconds at a duty that drives nothing. By its speed, and by
// its count where the log has no speeds.
TEST(Check, names_no_wheel_that_stands_in_its_bridges_dead_band) {
    for (const bool turns : {false, true})
        for (const bool by_count : {false, true}) {
            log::Log log = good();
            log::Signal &speed = at(log, "wheel0.speed_rad_s"), &current = at(log, "wheel0.current_A"), &duty = at(log, "wheel0.duty"),
                        &count = at(log, "wheel0.encoder_count");
            const double turned = count.value[900] - count.value[500];
            for (std::size_t i = 500; i < speed.value.size(); ++i) {
                if (i < 900)
                    speed.value[i] = 0, count.value[i] = count.value[500], duty.value[i] = 0.055,
                    current.value[i] = (turns ? 0.06 : 0) + (i % 3 == 0 ? 0.02 : -0.01); // what turns is braked by its friction
                else
                    count.value[i] -= turned;
            }
            if (by_count) std::erase_if(log.signals, [](const log::Signal &s) { return s.name.find(".speed_rad_s") != std::string::npos; });
            EXPECT_EQ(check::check(log, {}).find("stuck_sensor", by_count ? "wheel0.encoder_count" : "wheel0.speed_rad_s") != nullptr,
                      turns)
                << by_count << '\n'
                << listed(check::check(log, {}), Severity::note);
        }
}

TEST(Check, names_clipping_outliers_and_coarse_steps) {
    log::Log log = good();
    for (double &v : at(log, "wheel0.current_A").value) v = std::clamp(v, -0.35, 0.35);
    EXPECT_NE(check::check(log, {}).find("clipped", "wheel0.current_A"), nullptr) << listed(check::check(log, {}), Severity::note);
    log = good();
    for (double &v : at(log, "imu.accel_x_m_s2").value) v = std::clamp(v, -0.5, 0.5);
    expect_only(log, "clipped", "imu.accel_x_m_s2", Severity::error, {}, 2); // at both ends
    log = good();
    at(log, "imu.gyro_z_rad_s").value[1234] = 327.67;
    expect_only(log, "outlier", "imu.gyro_z_rad_s", Severity::warning);
    log = good(); // an interference in a current, a speed and the supply is told, and refuses nothing
    at(log, "wheel0.current_A").value[2345] = 80, at(log, "wheel1.speed_rad_s").value[3456] = -900;
    EXPECT_TRUE(check::check(log, {}).passed()) << listed(check::check(log, {}), Severity::note);
    log = good();
    for (double &v : at(log, "wheel0.speed_rad_s").value) v = std::round(v);
    const check::Report report = check::check(log, {});
    ASSERT_NE(report.find("coarse", "wheel0.speed_rad_s"), nullptr);
    EXPECT_DOUBLE_EQ(report.find("coarse")->value, 1.0);
}

TEST(Check, names_no_clipping_where_a_value_was_held_or_the_current_is_coarse) {
    log::Log log = good(); // the logger held one reading, larger than all others, for 0.6 s: one stay of 60 samples
    log::Signal &held = at(log, "wheel0.current_A");
    const double most = 1.05 * *std::max_element(held.value.begin(), held.value.end());
    for (std::size_t i = 500; i < 560; ++i) held.value[i] = most;
    EXPECT_EQ(check::check(log, {}).find("clipped"), nullptr) << listed(check::check(log, {}), Severity::note);

    log = good(); // no voltage, a magnitude in coarse steps, held for 0.6 s (as in the Robotino's drives)
    std::erase_if(log.signals, [](const log::Signal &s) { return s.name.find("duty") != std::string::npos; });
    for (double &v : at(log, "wheel1.current_A").value) v = 0.02 * std::round(std::fabs(v) / 0.02);
    log::Signal &coarse = at(log, "wheel1.current_A");
    const double top = *std::max_element(coarse.value.begin(), coarse.value.end()) + 0.04;
    for (std::size_t i = 500; i < 560; ++i) coarse.value[i] = top;
    EXPECT_EQ(check::check(log, {}).find("clipped"), nullptr) << listed(check::check(log, {}), Severity::note);

    log = good(); // steps so coarse that the steady drives all read the top one, again and again; the voltage asks for no more there
    log::Signal &current = at(log, "wheel2.current_A");
    const log::Signal &speed = at(log, "wheel2.speed_rad_s"), &battery = at(log, "battery.voltage_V");
    log::Signal &duty = at(log, "wheel2.duty");
    for (std::size_t i = 0; i < current.value.size(); ++i) {
        const bool steady = i % 100 >= 30; // 0.7 s at 0.5 A, then a swing through every other step of 0.03 A
        const double phase = static_cast<double>(i % 100) / 30 * 6.283185307179586;
        current.value[i] = steady ? 0.51 : 0.03 * std::round((0.07 + 0.40 * std::cos(phase)) / 0.03);
        duty.value[i] = (0.265 * speed.value[i] + 3.24 * current.value[i]) / battery.value[i];
    }
    EXPECT_EQ(check::check(log, {}).find("clipped"), nullptr) << listed(check::check(log, {}), Severity::note);
}

TEST(Check, names_clipping_by_one_stay_that_the_voltage_contradicts_and_by_many_stays_without_a_voltage) {
    log::Log log = good(); // wheel 0 pulls hard once, for 2 s: the winding takes 4 A, the sensor ends at 3.1 A
    log::Signal &current = at(log, "wheel0.current_A"), &duty = at(log, "wheel0.duty");
    const log::Signal &speed = at(log, "wheel0.speed_rad_s"), &battery = at(log, "battery.voltage_V");
    for (std::size_t i = 500; i < 700; ++i) {
        duty.value[i] = (0.265 * speed.value[i] + 3.24 * 4.0) / battery.value[i];
        current.value[i] = 3.1;
    }
    ASSERT_LT(*std::max_element(current.value.begin(), current.value.end()), 3.1001); // nothing lies beyond
    EXPECT_NE(check::check(log, {}).find("clipped", "wheel0.current_A"), nullptr) << listed(check::check(log, {}), Severity::note);

    log = good(); // a magnitude without a voltage, cut at its 70 % quantile
    std::erase_if(log.signals, [](const log::Signal &s) { return s.name.find("duty") != std::string::npos; });
    log::Signal &magnitude = at(log, "wheel1.current_A");
    for (double &v : magnitude.value) v = std::fabs(v);
    std::vector<double> sorted = magnitude.value;
    std::sort(sorted.begin(), sorted.end());
    for (double &v : magnitude.value) v = std::min(v, sorted[sorted.size() * 7 / 10]);
    EXPECT_NE(check::check(log, {}).find("clipped", "wheel1.current_A"), nullptr) << listed(check::check(log, {}), Severity::note);
}

TEST(Check, passes_on_what_the_reader_mended) {
    log::Log log = good();
    std::string text = "# format: traction-log 1\nt_s,imu.gyro_z_rad_s\n";
    for (int i = 0; i < 1000; ++i)
        text.append(std::to_string(0.01 * i)).append(",").append(i % 10 < 3 ? "nan" : std::to_string(std::sin(0.1 * i))).append("\n");
    const File file("nan.csv", text);
    const check::Report report = check::check_file(file.path());
    ASSERT_NE(report.find("not_finite", "imu.gyro_z_rad_s"), nullptr);
    EXPECT_EQ(report.find("not_finite")->severity, Severity::error);
    EXPECT_NEAR(report.find("not_finite")->value, 0.3, 1e-12); // 300 of 1000
}

TEST(Check, a_gyro_that_turns_farther_than_the_cameras_heading_is_told_by_how_much) {
    EXPECT_EQ(check::check(good(), {}).find("scale"), nullptr);
    for (const double scale : {1.06, 0.94}) {
        log::Log log = good();
        for (log::Signal &signal : log.signals)
            if (signal.name == "imu.gyro_z_rad_s")
                for (double &w : signal.value) w = scale * w + 0.2; // an offset is none
        const check::Report report = check::check(log, {});
        ASSERT_NE(report.find("scale", "imu.gyro_z_rad_s"), nullptr) << scale;
        EXPECT_NEAR(report.find("scale", "imu.gyro_z_rad_s")->value, scale, 0.01);
        EXPECT_EQ(report.find("scale")->severity, Severity::warning);
    }
}

// A side that slips more turns faster and pushes less: straight ahead the machine turns towards it, which is no wrong sign.
TEST(Check, a_gyros_sign_is_judged_by_turns_and_not_by_a_straight_drives_slip) {
    const auto without_camera = [](log::Log log) {
        std::erase_if(log.signals, [](const log::Signal &s) { return s.name.starts_with("camera."); });
        return log;
    };
    log::Log straight = without_camera(drive({.rich = false}));
    for (const char *left : {"wheel0.speed_rad_s", "wheel2.speed_rad_s"}) {
        log::Signal &speed = at(straight, left);
        for (std::size_t k = 0; k < speed.t_s.size(); ++k) speed.value[k] *= 1 + 0.06 * std::sin(0.7 * speed.t_s[k]);
    }
    log::Signal &gyro = at(straight, "imu.gyro_z_rad_s");
    for (std::size_t k = 0; k < gyro.t_s.size(); ++k) gyro.value[k] = 0.05 * std::sin(0.7 * gyro.t_s[k]); // to the left
    const check::Report report = check::check(straight, {}, spec_rover());
    EXPECT_EQ(report.find("sign"), nullptr) << listed(report, Severity::warning);

    log::Log turned_round = without_camera(good());
    scale(turned_round, "imu.gyro_z_rad_s", -1);
    ASSERT_NE(check::check(turned_round, {}).find("sign", "imu.gyro_z_rad_s"), nullptr);
}

TEST(Check, tells_a_clock_that_stands_still_once_and_not_for_each_column) {
    std::string text = "t_s,wheel0.speed_rad_s,wheel1.speed_rad_s,wheel2.speed_rad_s\n";
    for (int i = 0; i < 400; ++i) text.append(i < 300 ? std::to_string(0.01 * i) : "2.99").append(",1,2,3\n");
    const File file("stands.csv", text);
    const check::Report report = check::check_file(file.path());
    std::size_t told = 0;
    for (const check::Finding &finding : report.findings) told += finding.id == "duplicate_time" ? 1 : 0;
    EXPECT_EQ(told, 1U);
    ASSERT_NE(report.find("duplicate_time"), nullptr);
    EXPECT_NE(report.find("duplicate_time")->text.find("so have 2 other signals"), std::string::npos)
        << report.find("duplicate_time")->text;
}

TEST(Check, names_times_in_another_unit_by_it_and_a_log_without_anything_known) {
    for (const auto &[times, unit] : {std::pair(1e3, "milliseconds"), {1e6, "microseconds"}, {1e9, "nanoseconds"}, {1e-6, "no seconds"}}) {
        log::Log log = good();
        for (log::Signal &signal : log.signals) {
            for (double &t : signal.t_s) t *= times;
        }
        const check::Report report = check::check(log, {});
        ASSERT_NE(report.find("time_unit"), nullptr) << unit;
        EXPECT_NE(report.find("time_unit")->text.find(unit), std::string::npos) << report.find("time_unit")->text;
    }
    EXPECT_NE(check::check(log::Log{{}, {{"a", {0, 1}, {1, 2}}}, {}, ""}, {}).find("nothing_to_use"), nullptr);
    EXPECT_FALSE(check::check(log::Log{}, {}).passed());
}

TEST(Excitation, tells_what_a_dull_drive_cannot_show_and_measures_a_rich_one) {
    const check::Report dull = check::check(drive({.rich = false}), {});
    for (const char *id : {"no_reverse", "no_standstill", "few_starts", "no_turns", "no_place_twice", "constant_input"})
        EXPECT_NE(dull.find(id), nullptr) << id << "\n" << listed(dull, Severity::note);
    const check::Excitation rich = check::check(good(), {}).excitation;
    EXPECT_NEAR(rich.duration_s, 80, 0.2);
    EXPECT_NEAR(rich.speed_max_m_s, 0.5, 0.03); // the last leg; the camera's slope has 3 mm/s of noise
    EXPECT_NEAR(rich.speed_min_m_s, -0.4, 0.03);
    EXPECT_NEAR(rich.standstill_s, 3, 0.4);
    EXPECT_NEAR(rich.yaw_rate_max_rad_s, 0.6, 0.05);
    EXPECT_GT(rich.reverse_s, 18); // legs of 17 s and 7 s in reverse, less their ramps
    EXPECT_LT(rich.reverse_s, 26);
    EXPECT_EQ(rich.starts, 5);
    EXPECT_GT(rich.revisited, 0.3);
    EXPECT_GT(rich.slip_high, 0.25); // the sweep imposes 0.35
    EXPECT_LT(rich.slip_low, -0.25);
    ASSERT_EQ(rich.wheel.size(), 4u);
}

TEST(MeasuredData, robotino_and_cmu_logs_pass_the_check) {
    const std::filesystem::path data = "../shared/data";
    if (!std::filesystem::exists(data)) GTEST_SKIP() << "the measured data (" << data << ") is not here";
    for (const auto &entry : std::filesystem::directory_iterator(data / "robotino")) {
        const std::string name = entry.path().filename().string();
        if (name.rfind("wheel_", 0) == 0) continue;
        const bool floor = name.find("_dir") != std::string::npos;
        const check::Report report =
            check::check_file(entry.path().string(), floor ? "models/maps/robotino.toml" : "models/maps/robotino_unloaded.toml");
        EXPECT_TRUE(report.passed()) << name << "\n" << listed(report, Severity::warning);
    }
    for (const auto &[file, map] :
         {std::pair{"cmu_wheel_smooth_steady_state.csv", "cmu_steady_state.toml"},
          std::pair{"motion_smooth_rim100_trial1_12-3-20.csv", "cmu_motion.toml"}, std::pair{"plate_100mm_4.csv", "cmu_plate.toml"}}) {
        const check::Report report = check::check_file((data / "cmu_single_wheel" / file).string(), std::string("models/maps/") + map);
        EXPECT_TRUE(report.passed()) << file << "\n" << listed(report, Severity::warning);
    }
}

TEST(MeasuredData, the_linear_axis_and_the_skid_steer_pass_the_check) {
    const std::filesystem::path data = "../shared/data";
    if (!std::filesystem::exists(data / "husky")) GTEST_SKIP() << "the measured data (" << data << ") is not here";
    for (const auto &[file, map] :
         {std::pair{"emps/emps_estimation.csv", "emps.toml"}, std::pair{"husky/ASPHALT_pro_03.csv", "husky.toml"},
          std::pair{"husky/FLOORING_pro_01.csv", "husky.toml"}, std::pair{"husky/SNOW_pro_02.csv", "husky.toml"}}) {
        const check::Report report = check::check_file((data / file).string(), std::string("models/maps/") + map);
        EXPECT_TRUE(report.passed()) << file << "\n" << listed(report, Severity::warning);
    }
    // all its wheels stand at one value, and nothing else tells whether that is true: said, not refused
    const check::Report snow = check::check_file((data / "husky/SNOW_pro_02.csv").string(), "models/maps/husky.toml");
    ASSERT_NE(snow.find("dead_sensor", "wheel0.speed_rad_s"), nullptr);
    EXPECT_EQ(snow.find("dead_sensor", "wheel0.speed_rad_s")->severity, Severity::warning);
}
