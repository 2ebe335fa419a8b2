// Frames as text: what is written is read back bit for bit, and what is no frame is refused with field, value and mend.
#include "hal/replay/frames.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>

namespace {

sensor_frame_t extreme_frame() {
    sensor_frame_t frame{};
    frame.tick = UINT32_MAX;
    frame.present = UINT32_MAX;
    frame.encoder_count[0] = INT32_MIN;
    frame.encoder_count[3] = INT32_MAX;
    for (auto &count : frame.current_count) count = UINT16_MAX;
    frame.battery_count = UINT16_MAX;
    frame.accel_x_count = INT16_MIN;
    frame.gyro_z_count = INT16_MAX;
    frame.radar_samples = RADAR_SAMPLES_PER_TICK_MAX;
    for (auto &count : frame.radar_count) count = UINT16_MAX;
    frame.emergency_stop = true;
    frame.elapsed_ticks = frame.time_us = frame.radar_sequence = UINT32_MAX;
    frame.accel_y_count = frame.accel_z_count = frame.gyro_x_count = frame.gyro_y_count = frame.gyro_z_count = INT16_MIN;
    for (auto &status : frame.bridge_status) status = UINT8_MAX;
    return frame;
}

command_t extreme_command() {
    command_t command{};
    command.mode = MODE_SOIL_SWEEP;
    command.platform_speed_m_s = std::numeric_limits<float>::quiet_NaN();
    command.yaw_rate_rad_s = -std::numeric_limits<float>::infinity();
    command.wheel_speed_rad_s[1] = std::numeric_limits<float>::denorm_min();
    command.duty[3] = -0.0f;
    command.slip_ref = 0.1f;
    command.slip_wheels = UINT8_MAX;
    command.age_ticks = UINT32_MAX;
    return command;
}

std::string line_of(const sensor_frame_t &frame, const command_t &command) {
    char line[FRAMES_LINE];
    const std::size_t length = frames_print(&frame, &command, line);
    EXPECT_EQ(length, std::strlen(line));
    return line;
}

std::string refusal(const std::string &line) {
    sensor_frame_t frame;
    command_t command;
    char why[FRAMES_WHY];
    return frames_parse(line.c_str(), &frame, &command, why) ? "accepted" : why;
}

// The line with its field `index` (from 0) replaced.
std::string with(const std::string &line, int index, const std::string &value) {
    std::size_t at = 0;
    for (int i = 0; i < index; i++) at = line.find(' ', at) + 1;
    const std::size_t end = line.find_first_of(" \n", at);
    return line.substr(0, at) + value + line.substr(end);
}

} // namespace

TEST(Frames, extremes_come_back_bit_for_bit_and_the_line_fits) {
    const std::string line = line_of(extreme_frame(), extreme_command());
    EXPECT_LE(line.size(), 694u); // frames.h
    EXPECT_EQ(line.back(), '\n');
    sensor_frame_t frame;
    command_t command;
    char why[FRAMES_WHY];
    ASSERT_TRUE(frames_parse(line.c_str(), &frame, &command, why)) << why;
    EXPECT_EQ(line_of(frame, command), line);
    EXPECT_EQ(frame.encoder_count[0], INT32_MIN);
    EXPECT_EQ(frame.accel_x_count, INT16_MIN);
    EXPECT_EQ(frame.radar_count[63], UINT16_MAX);
    const command_t given = extreme_command();
    EXPECT_EQ(std::memcmp(&command.platform_speed_m_s, &given.platform_speed_m_s, sizeof(float)), 0); // the NaN's own bits
    EXPECT_EQ(std::memcmp(&command.duty[3], &given.duty[3], sizeof(float)), 0);                       // minus zero
}

TEST(Frames, a_line_that_is_none_is_refused_with_field_value_and_mend) {
    const std::string line = line_of({}, {}); // 0 radar samples: 26 fields of the frame, 14 of the command
    EXPECT_EQ(refusal(line), "accepted");
    EXPECT_EQ(refusal(with(line, 0, "-1")), "tick = -1: out of range; 0 to 4294967295");
    EXPECT_EQ(refusal(with(line, 3, "0x3")), "present = 0x3: not a hexadecimal number");
    EXPECT_EQ(refusal(with(line, 4, "2147483648")), "enc = 2147483648: out of range; -2147483648 to 2147483647");
    EXPECT_EQ(refusal(with(line, 4, "99999999999999999999")), "enc = 99999999999999999999: out of range; -2147483648 to 2147483647");
    EXPECT_EQ(refusal(with(line, 8, "12.5")), "cur = 12.5: not a whole number");
    EXPECT_EQ(refusal(with(line, 19, "2")), "estop = 2: out of range; 0 to 1");
    EXPECT_EQ(refusal(with(line, 25, "65")), "n = 65: out of range; 0 to 64");
    EXPECT_EQ(refusal(with(line, 26, "6")), "mode = 6: out of range; 0 to 5");
    EXPECT_EQ(refusal(with(line, 27, "1.5")), "v = 1.5: not a hexadecimal number");
    EXPECT_NE(refusal(with(line, 25, "1")), "accepted"); // the mode is then a radar sample, and the line one field short
}

TEST(Frames, a_line_that_is_cut_or_goes_on_is_refused) {
    const std::string line = line_of(extreme_frame(), extreme_command());
    for (std::size_t length = 0; length < line.size(); length++) EXPECT_NE(refusal(line.substr(0, length)), "accepted") << length;
    EXPECT_NE(refusal(line.substr(0, line.size() - 1)).find("cut off"), std::string::npos);
    EXPECT_EQ(refusal(line.substr(0, line.size() - 1) + " 7\n"), "age = 4294967295: is the last field; something follows it");
    EXPECT_NE(refusal("\n").find("tick = : missing"), std::string::npos);
    EXPECT_NE(refusal("tick present\n").find("tick = tick: not a whole number"), std::string::npos);
}
