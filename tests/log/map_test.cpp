// Foreign files through a map: every key does what docs/log_format.md says, every wrong key is named with its line.
#include "files.h"

#include "host_tools/log/read.h"

#include <algorithm>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

using namespace traction::log;
using traction::test::File;

namespace {

const std::string top = "format = \"traction-map 1\"\n[time]\ncolumn = \"time_ms\"\nscale = 0.001\n";

Log through(const std::string &map, const std::string &csv) {
    const File log("foreign.csv", csv), rules("map.toml", map);
    return read_csv(log.path(), rules.path());
}

std::string refusal(const std::string &map, const std::string &csv = "time_ms,a\n0,1\n") {
    const File log("foreign.csv", csv), rules("map.toml", map);
    try {
        read_csv(log.path(), rules.path());
    } catch (const LogError &error) {
        std::string message = error.what();
        const std::size_t at = message.find(rules.path());
        if (at != std::string::npos) message.replace(at, rules.path().size(), "map.toml");
        return message;
    }
    return "(read without complaint)";
}

std::string signal(const std::string &name, const std::string &rest) { return "[[signal]]\nname = \"" + name + "\"\n" + rest + "\n"; }

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

const std::filesystem::path data = "../shared/data";
#define NEED_DATA()                                                                                                                        \
    if (!std::filesystem::exists(data)) GTEST_SKIP() << "the measured data (" << data << ") is not here"

} // namespace

TEST(Map, scales_shifts_and_delays) {
    const Log log = through(top + signal("wheel1.current_A", "column = \"i\"\nscale = 0.001\nsign = -1\noffset = 0.5\ndelay_s = 0.02"),
                            "time_ms,i,text\n100,250,abc\n200,-500,def\n");
    ASSERT_EQ(log.signals.size(), 1u);
    EXPECT_EQ(log.signals[0].name, "wheel1.current_A");
    EXPECT_NEAR(log.signals[0].t_s[0], 0.08, 1e-15); // one rounding of 0.1
    EXPECT_DOUBLE_EQ(log.signals[0].value[0], 0.25); // -0.001 * 250 + 0.5
    EXPECT_DOUBLE_EQ(log.signals[0].value[1], 1.0);
}

TEST(Map, a_magnitude_only_current_is_marked_for_the_lab) {
    const Log log = through(top + signal("wheel0.current_A", "column = \"a\"\nunsigned = true\nquantum = 0.025"), "time_ms,a\n0,-1\n");
    EXPECT_EQ(log.header.at("unsigned.wheel0.current_A"), "1");
    EXPECT_EQ(log.header.at("quantum.wheel0.current_A"), "0.025");
    EXPECT_EQ(log.signals[0].value[0], 1.0);
}

TEST(Map, constants_noise_and_header_entries_reach_the_log) {
    const Log log = through(top + signal("battery.voltage_V", "value = 24") + signal("camera.x_m", "column = \"a\"\nnoise = 0.001") +
                                "[header]\nmachine = \"cart\"\nmass_kg = 11.5\n",
                            "time_ms,a\n0,1\n10,1\n");
    EXPECT_EQ(log.find("battery.voltage_V")->value, (std::vector<double>{24, 24}));
    EXPECT_EQ(log.header.at("constant.battery.voltage_V"), "1");
    EXPECT_EQ(log.header.at("noise.camera.x_m"), "0.001");
    EXPECT_EQ(log.header.at("machine"), "cart");
    EXPECT_EQ(log.header.at("mass_kg"), "11.5");
}

TEST(Map, an_angle_that_wraps_becomes_continuous_and_its_rate_a_speed) {
    std::string csv = "time_ms,deg\n";
    for (int i = 0; i < 200; ++i) csv += std::to_string(10 * i) + "," + std::to_string((i * 7) % 360 - 180) + "\n";
    const Log log =
        through(top + signal("wheel0.angle_rad", "column = \"deg\"\nscale = 0.017453292519943295\nunwrap = true") +
                    signal("wheel0.speed_rad_s",
                           "column = \"deg\"\nscale = 0.017453292519943295\nunwrap = true\ndifferentiate = true\nwindow_s = 0.05"),
                csv);
    const Signal &angle = *log.find("wheel0.angle_rad"), &speed = *log.find("wheel0.speed_rad_s");
    EXPECT_NEAR(angle.value.back() - angle.value.front(), 199 * 7 * 0.017453292519943295, 1e-9); // sum of 200 roundings of 25
    for (const double w : speed.value) EXPECT_NEAR(w, 700 * 0.017453292519943295, 1e-9);         // 7 deg per 10 ms
}

// A heading of 7 deg a row over three turns, under a pitch and a roll that stay.
TEST(Map, a_quaternion_becomes_a_heading_without_jumps) {
    constexpr double deg = 0.017453292519943295, pitch = 0.2, roll = -0.3;
    std::string csv = "time_ms,q.x,q.y,q.z,q.w\n";
    for (int i = 0; i < 160; ++i) {
        const double yaw = 7 * deg * i - 2, cy = std::cos(yaw / 2), sy = std::sin(yaw / 2), cp = std::cos(pitch / 2),
                     sp = std::sin(pitch / 2), cr = std::cos(roll / 2), sr = std::sin(roll / 2);
        const double sign = i % 3 == 0 ? -1 : 1; // q and -q are one rotation
        char row[160];
        std::snprintf(row, sizeof row, "%d,%.12f,%.12f,%.12f,%.12f\n", 10 * i, sign * (cy * cp * sr - sy * sp * cr),
                      sign * (cy * sp * cr + sy * cp * sr), sign * (sy * cp * cr - cy * sp * sr), sign * (cy * cp * cr + sy * sp * sr));
        csv += row;
    }
    const std::string heading = "quaternion = [\"q.w\", \"q.x\", \"q.y\", \"q.z\"]";
    const Log log = through(top + signal("camera.yaw_rad", heading + "\nsign = -1") +
                                signal("imu.gyro_z_rad_s", heading + "\ndifferentiate = true\nwindow_s = 0.03"),
                            csv);
    const Signal &yaw = *log.find("camera.yaw_rad"), &rate = *log.find("imu.gyro_z_rad_s");
    ASSERT_EQ(yaw.value.size(), 160u);
    for (std::size_t i = 0; i < yaw.value.size(); ++i) EXPECT_NEAR(yaw.value[i], 2 - 7 * deg * static_cast<double>(i), 1e-10);
    for (const double w : rate.value) EXPECT_NEAR(w, 700 * deg, 1e-7);

    EXPECT_HAS(refusal(top + signal("camera.yaw_rad", "quaternion = [\"a\", \"b\", \"c\"]")), "write the columns of w, x, y and z");
    EXPECT_HAS(refusal(top + signal("camera.yaw_rad", heading + "\ncolumn = \"q.w\"")), "needs either 'column' or 'value'");
    EXPECT_HAS(refusal(top + signal("camera.yaw_rad", heading), "time_ms,q.w,q.x,q.y\n0,1,0,0\n"), "wants column 'q.z'");
    EXPECT_HAS(refusal(top + signal("camera.yaw_rad", heading), "time_ms,q.w,q.x,q.y,q.z\n0,1,0,0,0\n10,1,0,0,2\n"),
               "is none at row 2 of its numbers: its length squared is 5.000000, not 1");
    EXPECT_HAS(refusal(top + signal("camera.yaw_rad", heading), "time_ms,q.w,q.x,q.y,q.z\n0,1,0,0,0\n10,1,0,,0\n"),
               "has rows in which a number of 'q.y' or 'q.w' is missing; to mend: leave those rows out");
}

TEST(Map, a_signal_is_made_of_columns_by_an_expression) {
    const std::string made = "expression = \"p/255*(2*d - 1)\"\ncolumns = { p = \"pwm\", d = \"dir\" }\nscale = 10\n";
    const Log log = through(top + signal("wheel0.duty", made), "time_ms,pwm,dir\n0,255,1\n10,51,0\n20,0,0\n");
    EXPECT_EQ(log.signals[0].value[0], 10);
    EXPECT_DOUBLE_EQ(log.signals[0].value[1], -2);
    EXPECT_EQ(log.signals[0].t_s, (std::vector<double>{0, 0.01, 0.02}));
    EXPECT_EQ(through(top + signal("camera.x_m", "expression = \"1/a\"\ncolumns = { a = \"a\" }"), "time_ms,a\n0,4\n10,0\n20,2\n")
                  .signals[0]
                  .value,
              (std::vector<double>{0.25, 0.5}))
        << "what is no number is no sample";
    EXPECT_HAS(refusal(top + signal("camera.x_m", "expression = \"a\"")), "needs 'expression' and 'columns' together");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "expression = \"a+*2\"\ncolumns = { a = \"a\" }")),
               "map.toml, line 5: the expression of 'camera.x_m' is not understood");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "expression = \"b\"\ncolumns = { a = \"a\" }")),
               "use the names in 'columns', pi and muparser's functions");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "expression = \"a\"\ncolumns = \"a\"")), "write short names of columns");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "expression = \"a\"\ncolumns = { a = \"x\" }")), "wants column 'x'");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "expression = \"a\"\ncolumns = { a = \"a\" }\nvalue = 1")),
               "needs either 'column' or 'value'");
    EXPECT_HAS(
        refusal(top + signal("camera.x_m", "expression = \"a+b\"\ncolumns = { a = \"a\", b = \"b\" }"), "time_ms,a,b\n0,1,1\n10,1,\n"),
        "is missing; to mend: leave those rows out by [[where]]");
}

TEST(Map, a_time_in_seconds_and_nanoseconds_is_one) {
    const std::string time = "format = \"traction-map 1\"\n[time]\ncolumn = \"sec\"\nnanoseconds = \"nsec\"\nfrom_zero = true\n";
    const Log log = through(time + signal("camera.x_m", "column = \"x\""),
                            "sec,nsec,x\n1732600000,990000000,1\n1732600001,0,2\n1732600001,10000000,3\n");
    EXPECT_NEAR(log.signals[0].t_s[1], 0.01, 5e-7); // a double of 1.7e9 s has steps of 0.24 us
    EXPECT_NEAR(log.signals[0].t_s[2], 0.02, 5e-7);
    EXPECT_HAS(refusal(time + signal("camera.x_m", "column = \"x\""), "sec,x\n0,1\n"),
               "there is no column 'nsec'; to mend: correct time.nanoseconds");
    EXPECT_HAS(refusal(time + signal("camera.x_m", "column = \"x\""), "sec,nsec,x\n0,,1\n"),
               "the row has no time; to mend: write its time in column 'nsec'");
    EXPECT_HAS(refusal("format = \"traction-map 1\"\n[time]\nrow_period_s = 1\nnanoseconds = \"nsec\"\n"), "stands without 'column'");
}

// The example for ROS, on a file as PlotJuggler writes it: a row for each stamp, empty where a topic is silent.
TEST(Map, the_example_for_ros_reads_what_it_says) {
    std::string names = "__time", motors = "", pose = ",0.5,-0.25,0,0,0.6,0.8";
    for (const char *wheel : {"rear_left", "rear_right", "front_left", "front_right"}) {
        const std::string at = std::string(wheel);
        names += ",/joint_states/" + at + "_wheel/position,/motors/" + at + "/current_mA,/motors/" + at + "/pwm,/motors/" + at + "/forward";
        motors += ",3.14,-250,51,0";
    }
    names += ",/battery_state/voltage,/imu/data/linear_acceleration/x,/imu/data/angular_velocity/z";
    for (const char *part : {"position/x", "position/y", "orientation/x", "orientation/y", "orientation/z", "orientation/w"})
        names += std::string(",/mocap/pose/") + part;
    const File log("foreign.csv", names + "\n1732600000.25" + motors + ",24.1,0.5,-0.02" + ",,,,,,\n1732600000.26" + std::string(16, ',') +
                                      ",,," + pose + "\n");
    const Log read = read_csv(log.path(), "models/maps/ros_skid_steer.toml");
    for (int wheel = 0; wheel < 4; ++wheel) {
        const std::string name = "wheel" + std::to_string(wheel) + '.';
        EXPECT_EQ(read.find(name + "angle_rad")->value, (std::vector<double>{3.14}));
        EXPECT_EQ(read.find(name + "current_A")->value, (std::vector<double>{-0.25}));
        EXPECT_DOUBLE_EQ(read.find(name + "duty")->value.at(0), -0.2);
    }
    EXPECT_EQ(read.find("battery.voltage_V")->value, (std::vector<double>{24.1}));
    EXPECT_NEAR(read.find("camera.yaw_rad")->value.at(0), 2 * std::atan2(0.6, 0.8), 1e-12);
    EXPECT_NEAR(read.find("camera.x_m")->t_s.at(0), 0.01, 5e-7);
}

TEST(Map, missing_numbers_repeats_filters_and_skipped_rows_are_left_out) {
    const Log log = through("format = \"traction-map 1\"\nskip_rows = 2\nseparator = \";\"\n[time]\ncolumn = \"t\"\nfrom_zero = "
                            "true\n[[where]]\ncolumn = \"ok\"\nequals = 1\n" +
                                signal("camera.x_m", "column = \"x\"\nmissing = [-999]\ndrop_repeats = true"),
                            "logger 3000\nserial,12;x\nt;x;ok\n5,0;1,5;1\n5,1;1,5;1\n5,2;-999;1\n5,3;7;0\n5,4;2,5;1\n");
    EXPECT_EQ(log.signals[0].value, (std::vector<double>{1.5, 2.5}));
    EXPECT_NEAR(log.signals[0].t_s[1], 0.4, 1e-12); // 5.4 - 5.0 in doubles
}

TEST(Map, a_file_without_names_is_read_by_column_number_and_row_period) {
    const Log log =
        through("format = \"traction-map 1\"\nrow_of_names = false\n[time]\nrow_period_s = 0.5\n" + signal("camera.x_m", "column = 2"),
                "7,1\n8,2\n9,3\n");
    EXPECT_EQ(log.signals[0].t_s, (std::vector<double>{0, 0.5, 1}));
    EXPECT_EQ(log.signals[0].value, (std::vector<double>{1, 2, 3}));
}

TEST(Map, wrong_keys_and_values_are_named_with_their_line) {
    EXPECT_HAS(refusal("x = ["), "map.toml, line 1, column");
    EXPECT_HAS(refusal("[time]\ncolumn = \"time_ms\"\n"), "the map's format is ''; to mend: write format = \"traction-map 1\"");
    EXPECT_HAS(refusal("format = \"traction-map 1\"\n" + signal("camera.x_m", "column = \"a\"")), "the map has no [time]");
    EXPECT_HAS(refusal(top), "the map has no [[signal]]");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "column = \"a\"\nscael = 2")),
               "map.toml, line 8: unknown key 'scael' in [[signal]] number 1; to mend: use one of: column, columns, delay_s, "
               "differentiate, drop_repeats, expression, missing, name, noise, offset,");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "column = \"a\"\nscale = \"2\"")),
               "map.toml, line 8: 'scale' in [[signal]] number 1 has the wrong value; to mend: write a finite number");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "column = \"a\"\nunsigned = 1")), "write true or false");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "")), "map.toml, line 5: signal 'camera.x_m' needs either 'column' or 'value'");
    EXPECT_HAS(refusal(top + signal("wheel0.speed_rpm", "column = \"a\"")),
               "signal 'wheel0.speed_rpm' is not in SI; to mend: write name = \"wheel0.speed_rad_s\" and scale = 0.104720");
    EXPECT_HAS(refusal(top + signal("wheel0.sped_rad_s", "column = \"a\"")), "is not in the vocabulary");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "column = \"a\"\nsign = 2")), "is neither 1 nor -1");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "column = \"a\"") + signal("camera.x_m", "column = \"a\"")),
               "map.toml, line 8: signal 'camera.x_m' stands twice");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "column = \"b\"")), "map.toml, line 5: signal 'camera.x_m' wants column 'b', which");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "column = \"a\""), "time,a\n0,1\n"), "there is no column 'time_ms'");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "column = \"a\""), "time_ms,a\n0,x1\n"), "'x1' in column 'a' is not a number");
}

TEST(Map, what_the_header_says_of_a_signal_is_a_number_of_one_that_is_there_and_not_mistyped) {
    const auto with = [](const std::string &entry) {
        return refusal(top + signal("wheel0.current_A", "column = \"a\"") + "[header]\n" + entry);
    };
    EXPECT_HAS(with("\"noise.wheel0.current_A\" = \"abc\"\n"), "line 9: header entry 'noise.wheel0.current_A' is 'abc', no number above 0");
    EXPECT_HAS(with("\"noise.wheel0.current_A\" = -3\n"), "no number above 0");
    EXPECT_HAS(with("\"window.wheel.current_A\" = 0\n"), "no number above 0");
    EXPECT_HAS(with("\"noise.wheel9.current_A\" = 0.1\n"), "speaks of a signal that there is not");
    EXPECT_HAS(with("\"noise.wheel.curent_A\" = 0.1\n"), "speaks of a signal that there is not");
    EXPECT_HAS(with("\"nois.wheel0.current_A\" = 0.1\n"), "write 'noise.wheel0.current_A'");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "column = \"a\"\nnoise = 0")), "noise of 'camera.x_m' is not above 0");
    EXPECT_HAS(refusal(top + signal("camera.x_m", "column = \"a\"\nquantum = -1")), "quantum of 'camera.x_m' is not above 0");
    const Log log = through(top + signal("wheel0.current_A", "column = \"a\"") +
                                "[header]\n\"noise.wheel0.current_A\" = 0.1\n\"window.wheel.current_A\" = "
                                "\"0.01\"\n\"window.radar.speed_m_s\" = 0.5\n\"my.note\" = \"x\"\n",
                            "time_ms,a\n0,1\n10,1\n");
    EXPECT_EQ(log.header.at("window.wheel.current_A"), "0.01");
    EXPECT_EQ(log.header.at("my.note"), "x");
}

TEST(Map, a_filter_that_keeps_no_row_is_no_file_without_rows) {
    const Log log =
        through(top + "[[where]]\ncolumn = \"a\"\nmin = 5\n" + signal("camera.x_m", "column = \"a\""), "time_ms,a\n0,1\n10,2\n");
    EXPECT_TRUE(log.find("camera.x_m")->value.empty());
}

TEST(Map, a_missing_map_is_a_file_error) { EXPECT_THROW(read_csv("any.csv", "/nonexistent.toml"), FileError); }

TEST(MeasuredData, robotino_runs_are_read_and_the_camera_moves_as_commanded) {
    NEED_DATA();
    int runs = 0;
    for (const auto &entry : std::filesystem::directory_iterator(data / "robotino")) {
        const std::string name = entry.path().filename().string();
        if (name.find("_dir") == std::string::npos) continue;
        ++runs;
        const Log log = read_csv(entry.path().string(), "models/maps/robotino.toml");
        const Signal &x = *log.find("camera.x_m"), &y = *log.find("camera.y_m"), &yaw = *log.find("camera.yaw_rad");
        double forward = 0, left = 0;
        for (std::size_t i = 1; i < x.value.size(); ++i) {
            const double dx = x.value[i] - x.value[i - 1], dy = y.value[i] - y.value[i - 1], a = yaw.value[i];
            forward += dx * std::cos(a) + dy * std::sin(a);
            left += -dx * std::sin(a) + dy * std::cos(a);
        }
        const double vx = log.find("command.speed_m_s")->value[0], vy = log.find("command.speed_y_m_s")->value[0];
        // The direction moved is the direction commanded within 15 deg: wheels of an omni robot slip unevenly (its authors' subject).
        EXPECT_GT((forward * vx + left * vy) / (std::hypot(forward, left) * std::hypot(vx, vy)), std::cos(15 * 3.14159 / 180)) << name;
        for (int i = 0; i < 3; ++i) {
            const std::string wheel = "wheel" + std::to_string(i);
            // The authors' kinematics, rows of M: set speeds at the wheel follow from the commanded velocity. 1e-4: six printed digits.
            const double d = (60 + 120 * i) * 3.141592653589793 / 180;
            EXPECT_NEAR(log.find(wheel + ".set_speed_rad_s")->value[0], (-std::sin(d) * vx + std::cos(d) * vy) / 0.04, 1e-4) << name;
            // The angle advances as the speed says: within the tick count's doubt (1976 against 2000) and one quantum of speed (0.177
            // rad/s).
            const Signal &w = *log.find(wheel + ".speed_rad_s"), &angle = *log.find(wheel + ".angle_rad");
            double turned = 0;
            for (std::size_t k = 1; k < w.value.size(); ++k) turned += 0.5 * (w.value[k] + w.value[k - 1]) * (w.t_s[k] - w.t_s[k - 1]);
            EXPECT_NEAR(angle.value.back() - angle.value.front(), turned, 0.03 * std::fabs(turned) + 0.177 * log.duration_s() / 2) << name;
        }
    }
    EXPECT_GT(runs, 30);
}

TEST(MeasuredData, robotino_unloaded_motors_and_the_cmu_wheel_are_read) {
    NEED_DATA();
    const Log motors =
        read_csv((data / "robotino/motor_data_for_identification_with_integral.csv").string(), "models/maps/robotino_unloaded.toml");
    EXPECT_EQ(motors.signals.size(), 9u);
    const Log trials =
        read_csv((data / "cmu_single_wheel/cmu_wheel_smooth_steady_state.csv").string(), "models/maps/cmu_steady_state_straight.toml");
    const Signal &slip = *trials.find("wheel0.slip"), &w = *trials.find("wheel0.speed_rad_s"), &v = *trials.find("carriage.speed_m_s");
    EXPECT_EQ(slip.value.size(), 27u); // 27 of the 189 trials have slip angle 0
    for (std::size_t i = 0; i < slip.value.size(); ++i) {
        const double rim = 0.058 * w.value[i];
        EXPECT_NEAR(slip.value[i], (rim - v.value[i]) / std::max(rim, v.value[i]),
                    2e-3); // the file's slip is the mean of the ratio over 70-75 s, this the ratio of the means
    }
    const Log motion =
        read_csv((data / "cmu_single_wheel/motion_smooth_rim100_trial1_12-3-20.csv").string(), "models/maps/cmu_motion.toml");
    EXPECT_NEAR(motion.find("wheel0.sinkage_m")->value.back(), 0.05715, 1e-9);
    const Log plate = read_csv((data / "cmu_single_wheel/plate_100mm_4.csv").string(), "models/maps/cmu_plate.toml");
    EXPECT_NEAR(plate.find("plate.normal_N")->value.back(), 292.91, 1e-9);
}

namespace {

// A wheel and a gyro that see one motion, the gyro 1.4 s late by its own clock and ten times as often.
std::string wheel_csv() {
    std::string text = "t,w\n";
    for (int i = 0; i < 400; ++i)
        text += std::to_string(0.1 * i) + "," + std::to_string(std::sin(0.7 * 0.1 * i) + 0.3 * std::sin(3.1 * 0.1 * i)) + "\n";
    return text;
}
std::string gyro_csv() {
    std::string text = "t,g\n";
    for (int i = 0; i < 3900; ++i) {
        const double t = 0.01 * i; // the world's time is t - 1.4
        text += std::to_string(t) + "," + std::to_string(0.5 * (std::sin(0.7 * (t - 1.4)) + 0.3 * std::sin(3.1 * (t - 1.4)))) + "\n";
    }
    return text;
}
const std::string wheel_map =
    "format = \"traction-map 1\"\n[time]\ncolumn = \"t\"\n[[signal]]\nname = \"wheel0.speed_rad_s\"\ncolumn = \"w\"\n";
const std::string gyro_map =
    "format = \"traction-map 1\"\n[time]\ncolumn = \"t\"\n[[signal]]\nname = \"imu.gyro_z_rad_s\"\ncolumn = \"g\"\n";

std::string name_of(const std::string &path) { return path.substr(path.find_last_of('/') + 1); }

} // namespace

TEST(MapJoin, two_files_meet_by_a_given_offset_or_by_what_both_see) {
    const File wheel("drive_pro_1.csv", wheel_csv()), gyro("drive_imu_1.csv", gyro_csv()), second("second.toml", gyro_map);
    const std::string join = "[join]\nreplace = \"_pro_\"\nwith = \"_imu_\"\nmap = \"" + name_of(second.path()) + "\"\n";
    const File given("given.toml", wheel_map + join + "offset_s = -1.4\n");
    const Log by_offset = read_csv(wheel.path(), given.path());
    ASSERT_NE(by_offset.find("imu.gyro_z_rad_s"), nullptr);
    EXPECT_NEAR(by_offset.find("imu.gyro_z_rad_s")->t_s.front(), -1.4, 1e-9);
    const File searched("searched.toml", wheel_map + join + "correlate = \"wheel0.speed_rad_s, imu.gyro_z_rad_s\"\n");
    const Log by_motion = read_csv(wheel.path(), searched.path());
    EXPECT_NEAR(by_motion.find("imu.gyro_z_rad_s")->t_s.front(), -1.4, 0.02); // the step of the search
    EXPECT_NE(by_motion.repairs.back().find("joined"), std::string::npos);
}

TEST(MapJoin, refuses_what_does_not_meet) {
    std::string noise = "t,g\n";
    unsigned state = 1;
    for (int i = 0; i < 3900; ++i)
        noise += std::to_string(0.01 * i) + "," + std::to_string((state = state * 1664525U + 1013904223U) >> 16U) + "\n";
    const File wheel("drive_pro_2.csv", wheel_csv()), gyro("drive_imu_2.csv", noise), second("second_2.toml", gyro_map);
    const std::string join = "[join]\nreplace = \"_pro_\"\nwith = \"_imu_\"\nmap = \"" + name_of(second.path()) + "\"\n";
    const auto said = [&](const std::string &rules) {
        const File map("refused.toml", rules);
        try {
            read_csv(wheel.path(), map.path());
        } catch (const LogError &error) {
            return std::string(error.what());
        }
        return std::string("(read without complaint)");
    };
    EXPECT_HAS(said(wheel_map + join + "correlate = \"wheel0.speed_rad_s, imu.gyro_z_rad_s\"\n"), "agree nowhere");
    EXPECT_HAS(said(wheel_map + join + "correlate = \"wheel0.speed_rad_s, imu.accel_x_m_s2\"\n"), "does not have");
    EXPECT_HAS(said(wheel_map + "[join]\nreplace = \"_x_\"\nwith = \"_y_\"\nmap = \"" + name_of(second.path()) + "\"\n"), "has no '_x_'");
    EXPECT_HAS(said(wheel_map + "[join]\nwith = \"_y_\"\n"), "[join] needs");
}
