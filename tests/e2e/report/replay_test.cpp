// The drive of a log as the page gets it: against closed forms, and against the rounding that 16 bits leave.
#include "host_tools/report/pack.h"
#include "host_tools/report/replay.h"
#include "host_tools/report/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

using namespace traction::report;
using traction::log::Log;
using traction::log::Signal;

namespace {

constexpr double pi = std::numbers::pi;

Signal sampled(const std::string &name, double rate_Hz, double to_s, const std::function<double(double)> &of) {
    Signal signal{.name = name, .t_s = {}, .value = {}};
    for (int i = 0; i / rate_Hz <= to_s + 1e-9; ++i) signal.t_s.push_back(i / rate_Hz), signal.value.push_back(of(i / rate_Hz));
    return signal;
}

RoverShape four_wheels() {
    RoverShape shape{.name = "test", .mass_kg = 3, .length_m = 0.3, .width_m = 0.27, .height_m = 0.18, .wheel = {}};
    for (const double x : {-0.1, 0.1})
        for (const double y : {0.12, -0.12}) shape.wheel.push_back({.x_m = x, .y_m = y, .radius_m = 0.057, .width_m = 0.04});
    return shape;
}

// RFC 4648 read back, and the page's rule: value = lowest + step * code, 65535 is nothing.
std::vector<double> read_back(const nlohmann::json &channel) {
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/", text = channel.at("data");
    std::vector<unsigned> bytes;
    unsigned word = 0, bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        word = word << 6U | static_cast<unsigned>(letters.find(c));
        if ((bits += 6) >= 8) bytes.push_back(word >> (bits -= 8) & 255U);
    }
    std::vector<double> out;
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
        const unsigned code = bytes[i] + 256 * bytes[i + 1];
        out.push_back(code == 65535 ? std::nan("") : channel.at("lowest").get<double>() + channel.at("step").get<double>() * code);
    }
    return out;
}

std::vector<double> values(const nlohmann::json &replay, const std::string &name) { return read_back(replay.at("channels").at(name)); }
double time_of(const nlohmann::json &replay, std::size_t row) {
    return replay.at("t0_s").get<double>() + static_cast<double>(row) * replay.at("dt_s").get<double>();
}

// A circle of 2 m at 0.5 m/s, as a camera of 7 Hz sees it: its heading jumps from pi to -pi.
Log circle(double to_s) {
    Log log;
    log.signals = {sampled("camera.x_m", 7, to_s, [](double t) { return 2 * std::sin(0.25 * t); }),
                   sampled("camera.y_m", 7, to_s, [](double t) { return 2 - 2 * std::cos(0.25 * t); }),
                   sampled("camera.yaw_rad", 7, to_s, [](double t) { return std::remainder(0.25 * t, 2 * pi); }),
                   sampled("estimate.speed_m_s", 100, to_s, [](double) { return 0.5; }),
                   sampled("imu.gyro_z_rad_s", 100, to_s, [](double) { return 0.25; })};
    return log;
}

} // namespace

TEST(Packed, text_is_that_of_the_standard) { // RFC 4648, section 10
    const auto of = [](const std::string &text) { return base64({text.begin(), text.end()}); };
    EXPECT_EQ(of(""), "");
    EXPECT_EQ(of("f"), "Zg==");
    EXPECT_EQ(of("fo"), "Zm8=");
    EXPECT_EQ(of("foobar"), "Zm9vYmFy");
}

TEST(Packed, no_value_is_farther_off_than_half_a_step_and_none_comes_from_nothing) {
    std::vector<double> all{std::nan("")};
    for (int i = 0; i < 5000; ++i) all.push_back(7.3 * std::sin(0.37 * i));
    all.push_back(std::numeric_limits<double>::infinity());
    const std::vector<double> back = read_back(packed(all));
    ASSERT_EQ(back.size(), all.size());
    EXPECT_TRUE(std::isnan(back.front()) && std::isnan(back.back()));
    for (std::size_t i = 1; i + 1 < all.size(); ++i) EXPECT_NEAR(back[i], all[i], 14.6 / 65534 / 2 * 1.0001); // a range of 14.6
}

TEST(Packed, counts_come_back_to_the_last_digit_and_one_value_is_itself) {
    const std::vector<double> counts{512, 0, 1023, 511}, one{0.1, 0.1};
    EXPECT_EQ(read_back(packed(counts)), counts);
    EXPECT_EQ(read_back(packed(one)), one);
    EXPECT_TRUE(read_back(packed({})).empty());
}

TEST(Replay, a_log_without_a_pose_has_none) {
    Log log;
    log.signals = {sampled("wheel0.speed_rad_s", 100, 2, [](double) { return 1; })};
    EXPECT_TRUE(replay_of(log, nullptr, four_wheels()).is_null());
}

TEST(Replay, the_camera_s_circle_is_a_circle_and_its_heading_does_not_jump) {
    const nlohmann::json replay = replay_of(circle(30), nullptr, four_wheels());
    EXPECT_EQ(replay.at("pose_from"), "camera");
    const auto x = values(replay, "x_m"), y = values(replay, "y_m"), yaw = values(replay, "yaw_rad");
    ASSERT_EQ(x.size(), replay.at("rows").get<std::size_t>());
    // between pictures a straight line: the sagitta of the arc, a dt^2/8 with a = v^2/r = 0.125 m/s^2, is 0.32 mm; half a step is 0.03 mm
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double t = time_of(replay, i);
        EXPECT_NEAR(x[i], 2 * std::sin(0.25 * t), 4e-4);
        EXPECT_NEAR(y[i], 2 - 2 * std::cos(0.25 * t), 4e-4);
        EXPECT_NEAR(yaw[i], 0.25 * t, 1e-4); // up to 7.5 rad: more than a turn; half a step of 7.5 rad is 6e-5
    }
}

TEST(Replay, the_ghost_goes_by_speed_and_gyro_alone) {
    Log log = circle(20);
    for (Signal &signal : log.signals)
        if (signal.name == "estimate.speed_m_s")
            for (double &value : signal.value) value = 0.55; // a tenth too fast: its circle is a tenth too wide
    const nlohmann::json replay = replay_of(log, nullptr, four_wheels());
    const auto x = values(replay, "ghost.x_m"), y = values(replay, "ghost.y_m");
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double t = time_of(replay, i);
        EXPECT_NEAR(x[i], 2.2 * std::sin(0.25 * t), 1e-4); // midpoint rule at 100 Hz: r (w dt)^2/24 = 6e-7 m; half a step is 4e-5 m
        EXPECT_NEAR(y[i], 2.2 - 2.2 * std::cos(0.25 * t), 1e-4);
    }
}

TEST(Replay, the_truth_is_preferred_and_its_forces_stand_before_the_estimates) {
    Log log = circle(5), truth;
    log.signals.push_back(sampled("wheel1.traction_N", 100, 5, [](double) { return 9; }));
    truth.signals = {sampled("truth.x_m", 100, 5, [](double t) { return t; }),
                     sampled("truth.y_m", 100, 5, [](double) { return -1; }),
                     sampled("truth.yaw_rad", 100, 5, [](double) { return 0.5; }),
                     sampled("truth.z_m", 100, 5, [](double t) { return 0.1 * t; }),
                     sampled("truth.wheel1.traction_N", 100, 5, [](double) { return 4; }),
                     sampled("truth.wheel2.sinkage_m", 100, 5, [](double t) { return 1e-3 * t; })};
    const nlohmann::json replay = replay_of(log, &truth, four_wheels());
    EXPECT_EQ(replay.at("pose_from"), "truth");
    EXPECT_NEAR(values(replay, "x_m").back(), time_of(replay, values(replay, "x_m").size() - 1), 1e-4);
    EXPECT_NEAR(values(replay, "z_m").back(), 0.5, 0.005);
    EXPECT_EQ(values(replay, "wheel1.traction_N").at(7), 4);
    EXPECT_NEAR(values(replay, "wheel2.sinkage_m").at(50), 2e-3, 1e-7); // row 50 is at 2 s; half a step of 5 mm is 4e-8 m
}

TEST(Replay, a_slip_that_means_nothing_and_a_silence_are_nothing) {
    Log log = circle(10);
    log.signals.push_back(sampled("wheel0.slip", 100, 10, [](double) { return 0.3; }));
    log.signals.push_back(sampled("wheel0.slip_valid", 100, 10, [](double t) { return t < 5 ? 1 : 0; }));
    Signal current = sampled("wheel0.current_A", 100, 10, [](double) { return 1; });
    current.t_s.erase(current.t_s.begin() + 300, current.t_s.begin() + 600); // 3 s to 6 s
    current.value.erase(current.value.begin() + 300, current.value.begin() + 600);
    log.signals.push_back(current);
    const nlohmann::json replay = replay_of(log, nullptr, four_wheels());
    const auto slip = values(replay, "wheel0.slip"), amps = values(replay, "wheel0.current_A");
    EXPECT_EQ(slip.at(100), 0.3); // 4 s
    EXPECT_TRUE(std::isnan(slip.at(150)));
    EXPECT_EQ(amps.at(50), 1);
    EXPECT_TRUE(std::isnan(amps.at(112))); // 4.48 s: more than half a second from either side
    EXPECT_EQ(amps.at(200), 1);
}

TEST(Replay, a_heading_that_was_not_recorded_is_the_way_of_the_path_and_is_told) {
    Log log = circle(20);
    log.signals.erase(log.signals.begin() + 2);
    const nlohmann::json replay = replay_of(log, nullptr, four_wheels());
    const auto yaw = values(replay, "yaw_rad");
    // a chord of 0.07 m (a picture's way) on a circle of 2 m is turned by half its angle, 0.018 rad, and is known one picture late, 0.036
    // rad
    for (std::size_t i = 25; i + 25 < yaw.size(); ++i) EXPECT_NEAR(yaw[i], 0.25 * time_of(replay, i), 0.06);
    EXPECT_NE(replay.at("notes").dump().find("the log has none"), std::string::npos);
}

TEST(Replay, a_long_log_has_no_more_rows_and_no_more_radar_than_a_page_can_carry) {
    Log log = circle(600);
    log.signals.push_back(sampled("radar.adc_count", 512, 600, [](double t) { return std::floor(512 + 100 * std::sin(2 * pi * 40 * t)); }));
    const nlohmann::json replay = replay_of(log, nullptr, four_wheels());
    EXPECT_LE(replay.at("rows").get<std::size_t>(), 6000u);
    EXPECT_NEAR(time_of(replay, replay.at("rows").get<std::size_t>() - 1), 600, 0.15); // a picture of the camera
    const nlohmann::json &radar = replay.at("radar");
    EXPECT_LE(read_back(radar).size(), (1u << 18U));
    EXPECT_GT(read_back(radar).size(), (1u << 17U));
    EXPECT_NEAR(radar.at("rate_Hz").get<double>(), 512, 1e-6);
    for (const auto &stretch : radar.at("stretches")) EXPECT_EQ(stretch.at(2), 256);
    EXPECT_LT(replay.dump().size(), 2'300'000u); // with the page and its code (0.6 MB) below 3 MB
}

TEST(Replay, radar_samples_are_kept_as_they_are_in_stretches_without_a_hole) {
    Log log = circle(4);
    Signal echo = sampled("radar.adc_count", 512, 4, [](double t) { return std::floor(512 + 200 * std::sin(2 * pi * 40 * t)); });
    const std::vector<double> all = echo.value;
    echo.t_s.erase(echo.t_s.begin() + 1000, echo.t_s.begin() + 1010),
        echo.value.erase(echo.value.begin() + 1000, echo.value.begin() + 1010);
    log.signals.push_back(echo);
    const nlohmann::json radar = replay_of(log, nullptr, four_wheels()).at("radar");
    ASSERT_EQ(radar.at("stretches").size(), 2u);
    EXPECT_EQ(radar["stretches"][0], nlohmann::json({0.0, 0, 1000}));
    EXPECT_EQ(radar["stretches"][1][1], 1000);
    EXPECT_NEAR(radar["stretches"][1][0].get<double>(), 1010 / 512.0, 1e-9);
    EXPECT_EQ(read_back(radar).at(1005), all.at(1015));
}

TEST(Replay, wheels_that_the_rover_lacks_are_told) {
    Log log = circle(4);
    log.signals.push_back(sampled("wheel5.slip", 100, 4, [](double) { return 0; }));
    EXPECT_NE(replay_of(log, nullptr, four_wheels()).at("notes").dump().find("The log has 6 wheels"), std::string::npos);
}

TEST(Replay, a_wheel_is_told_by_its_number_in_the_log_not_by_its_place_in_the_list) { // two wheels and a caster: 0, 1, 4
    RoverShape shape = four_wheels();
    shape.wheel.pop_back();
    shape.wheel[2].number = 4;
    Log log = circle(4), truth;
    truth.signals = {sampled("truth.wheel2.normal_N", 100, 4, [](double) { return 9; }),
                     sampled("truth.wheel4.normal_N", 100, 4, [](double) { return 3; })};
    log.signals.push_back(sampled("wheel1.slip", 100, 4, [](double) { return 0.25; }));
    const nlohmann::json replay = replay_of(log, &truth, shape);
    EXPECT_EQ(values(replay, "wheel2.normal_N").at(9), 3);
    EXPECT_EQ(replay["rover"]["wheel"][2]["number"], 4);
    EXPECT_EQ(values(replay, "wheel1.slip").at(9), 0.25);
    EXPECT_EQ(replay.at("notes").dump().find("The log has"), std::string::npos);
}

TEST(Replay, a_page_carries_the_code_of_the_scene_only_where_there_is_a_drive) {
    const nlohmann::json without{{"schema", "traction.lab/1"}, {"title", "no drive"}};
    nlohmann::json with = without;
    with["replay"] = replay_of(circle(4), nullptr, four_wheels());
    const std::string plain = to_html(without), drive = to_html(with);
    EXPECT_LT(plain.size(), 200'000u); // the page of the results alone
    EXPECT_EQ(plain.find("three.js authors"), std::string::npos);
    EXPECT_NE(drive.find("three.js authors"), std::string::npos); // its licence's notice
    EXPECT_NE(drive.find("Permission is hereby granted, free of charge", drive.find("three.js authors")), std::string::npos);
    const std::size_t opened = drive.find("id=\"scene\">"), closed = drive.find("</script>", opened);
    EXPECT_GT(closed - opened, 300'000u); // the code is whole: nothing in it ends its element
    EXPECT_EQ(drive.substr(opened, closed - opened).find("<!--"), std::string::npos);
}
