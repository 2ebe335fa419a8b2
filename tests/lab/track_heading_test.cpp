// A place that is measured without a heading: an antenna's track in a frame of its own, beside a gyro that drifts.
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/inputs/join_runs.h"
#include "host_tools/lab/inputs/track_heading.h"
#include "tests/lab/generator/generator.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace traction::lab {
namespace {

using Complex = std::complex<double>;

constexpr double step_s = 0.28, noise_m = 0.007, bias_rad_s = 0.01;
const Complex lever_m(0.3, -0.2);

struct Ride {
    std::vector<TrackRow> rows;
    std::vector<double> delta_rad; // what is sought: the true heading less the gyro's integral, in the middle of each row
};

// An eight with stretches backwards, from `heading_rad` in the track's frame; the wheels slip by a tenth.
void ride(Ride &out, double seconds, double heading_rad, double turned_rad, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> error(0, noise_m / std::numbers::sqrt2);
    Complex at(3, -7), fix = at + lever_m * std::polar(1.0, heading_rad);
    bool begins = true;
    for (double t = 0; t < seconds; t += step_s) {
        TrackRow row;
        row.turned_rad[0] = turned_rad;
        const double delta = heading_rad - turned_rad, h = step_s / 28;
        for (int i = 0; i < 28; ++i) {
            const double now = t + h * i, speed = 0.5 * (std::fmod(now, 12) < 8 ? 1 : -1), rate = 0.8 * std::sin(0.3 * now);
            at += std::polar(speed * h, heading_rad + 0.5 * rate * h);
            heading_rad += rate * h, turned_rad += (rate + bias_rad_s) * h, row.rim_m += 1.1 * speed * h;
        }
        row.turned_rad[1] = turned_rad;
        row.begins = begins, begins = false;
        const Complex next = at + lever_m * std::polar(1.0, heading_rad) + Complex(error(random), error(random));
        row.way_m = next - fix, fix = next;
        out.rows.push_back(row);
        out.delta_rad.push_back(0.5 * (delta + heading_rad - turned_rad));
    }
}

TEST(TrackHeading, is_found_in_any_frame_beside_a_gyro_that_drifts_and_after_a_pause_anew) {
    Ride drive;
    ride(drive, 120, 2.5, 0, 1);
    ride(drive, 90, -1.2, 40, 2); // another frame, another zero
    const TrackHeading found = track_heading(drive.rows, lever_m, noise_m, step_s);
    ASSERT_EQ(found.delta_rad.size(), drive.rows.size());
    EXPECT_GT(found.agreement, 0.98);
    for (std::size_t i = 0; i < drive.rows.size(); ++i) { // 0.05: the gyro's drift in half a window, at a drive's ends
        EXPECT_LT(std::fabs(std::remainder(found.delta_rad[i] - drive.delta_rad[i], 2 * std::numbers::pi)), 0.06) << i;
        const Complex way = way_of_body(drive.rows[i], lever_m, found.delta_rad[i]);
        EXPECT_NEAR(std::fabs(way.real()), std::fabs(drive.rows[i].rim_m) / 1.1, 5 * noise_m) << i;
    }
}

// A satellite receiver's fix a second.
TEST(TrackHeading, has_a_window_of_seconds_and_not_of_rows) {
    Ride drive;
    ride(drive, 240, 2.5, 0, 1);
    std::vector<TrackRow> slow;
    std::vector<double> delta_rad;
    for (std::size_t i = 0; i + 4 <= drive.rows.size(); i += 4) {
        TrackRow row = drive.rows[i];
        for (std::size_t j = i + 1; j < i + 4; ++j) row.way_m += drive.rows[j].way_m, row.rim_m += drive.rows[j].rim_m;
        row.turned_rad[1] = drive.rows[i + 3].turned_rad[1];
        slow.push_back(row);
        delta_rad.push_back(0.5 * (drive.delta_rad[i + 1] + drive.delta_rad[i + 2]));
    }
    const TrackHeading found = track_heading(slow, lever_m, noise_m, 4 * step_s);
    ASSERT_EQ(found.delta_rad.size(), slow.size());
    for (std::size_t i = 0; i < slow.size(); ++i) // the drift in half a window at the ends is 0.05, in 40 s 0.2
        EXPECT_LT(std::fabs(std::remainder(found.delta_rad[i] - delta_rad[i], 2 * std::numbers::pi)), 0.1) << i;
}

TEST(TrackHeading, of_a_track_that_is_not_these_wheels_is_none) {
    Ride drive;
    ride(drive, 120, 0, 0, 1);
    std::vector<TrackRow> other = drive.rows;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-std::numbers::pi, std::numbers::pi);
    for (TrackRow &row : other) row.way_m = std::polar(std::abs(row.way_m), any(random));
    EXPECT_TRUE(track_heading(other, lever_m, noise_m, step_s).delta_rad.empty());
    for (TrackRow &row : other) row.rim_m = 0; // nothing turns
    EXPECT_TRUE(track_heading(other, lever_m, noise_m, step_s).delta_rad.empty());
    EXPECT_TRUE(track_heading({}, lever_m, noise_m, step_s).delta_rad.empty());
}

generator::GeneratorConfig curves() {
    generator::GeneratorConfig config;
    config.drive = "curves", config.duration_s = 80, config.seed = 12;
    return config;
}

log::Signal &signal(log::Log &log, const std::string &name) {
    return *std::find_if(log.signals.begin(), log.signals.end(), [&](const log::Signal &s) { return s.name == name; });
}

// The same drive by an antenna: its frame turned, no heading, a gyro that reads bias_rad_s too much.
log::Log by_antenna(log::Log log, double turn_rad) {
    std::erase_if(log.signals, [](const log::Signal &s) { return s.name == "camera.yaw_rad"; });
    log::Signal &x = signal(log, "camera.x_m"), &y = signal(log, "camera.y_m");
    for (std::size_t k = 0; k < x.value.size(); ++k) {
        const Complex turned = Complex(x.value[k], y.value[k]) * std::polar(1.0, turn_rad) + Complex(100, -40);
        x.value[k] = turned.real(), y.value[k] = turned.imag();
    }
    for (double &rate : signal(log, "imu.gyro_z_rad_s").value) rate += bias_rad_s;
    return log;
}

const Balance *forward(const Dataset &data) {
    const auto found =
        std::find_if(data.balance.begin(), data.balance.end(), [](const Balance &b) { return b.kind == BalanceKind::camera_x; });
    return found == data.balance.end() ? nullptr : &*found;
}

bool says(const Dataset &data, const std::string &words) {
    return std::any_of(data.messages.begin(), data.messages.end(),
                       [&](const std::string &m) { return m.find(words) != std::string::npos; });
}

// Root mean square of what the rows of one read otherwise than those of the other, which began shift_s later.
double difference_m(const Balance &one, const Balance &other, double shift_s) {
    double sum = 0, count = 0;
    for (std::size_t r = 0, q = 0; r < one.measured.size(); ++r) {
        while (q < other.t0_s.size() && other.t0_s[q] - shift_s < one.t0_s[r] - 1e-3) ++q;
        if (q == other.t0_s.size()) break;
        if (std::hypot(other.t0_s[q] - shift_s - one.t0_s[r], other.t1_s[q] - shift_s - one.t1_s[r]) > 1e-3) continue; // another fix
        sum += std::pow(one.measured[r] - other.measured[q], 2), count += 1;
    }
    EXPECT_GT(count, 0.8 * static_cast<double>(one.measured.size()));
    return std::sqrt(sum / count);
}

TEST(TrackHeading, of_an_antenna_reads_the_way_that_a_camera_with_a_heading_reads) {
    const Model model = parse_model(generator::data_sheet(curves()), "sheet");
    const log::Log log = generator::generate(curves()), antenna = by_antenna(log, 2.1);
    const Dataset with = make_dataset(model, log), without = make_dataset(model, antenna);
    const Balance *told = forward(with), *found = forward(without);
    ASSERT_TRUE(told != nullptr && found != nullptr);
    EXPECT_LT(difference_m(*told, *found, 0), 0.5 * told->noise);
    EXPECT_TRUE(says(without, "the heading is the gyro's, turned until the wheels' way lies on the track"));
    EXPECT_FALSE(says(with, "no camera.yaw_rad"));
    EXPECT_TRUE(with.camera_heading && !without.camera_heading);

    generator::GeneratorConfig own_frame = curves();
    own_frame.habits.heading = false; // the same drive and noise, the track alone and turned
    const log::Log track = generator::generate(own_frame);
    EXPECT_EQ(track.find("camera.yaw_rad"), nullptr);
    EXPECT_GT(std::fabs(track.find("camera.y_m")->value.back() - log.find("camera.y_m")->value.back()), 1);
    const Dataset of_track = make_dataset(model, track);
    ASSERT_NE(forward(of_track), nullptr);
    EXPECT_LT(difference_m(*told, *forward(of_track), 0), 0.5 * told->noise);

    const JoinedRuns joined = join_runs({antenna, by_antenna(log, -0.7)}); // each run's frame is its own
    const Dataset two = make_dataset(model, joined.log);
    ASSERT_NE(forward(two), nullptr);
    for (const double start_s : joined.start_s)
        EXPECT_LT(difference_m(*told, *forward(two), start_s - joined.start_s[0]), 0.5 * told->noise);
}

TEST(TrackHeading, that_nothing_tells_leaves_the_place_out_aloud) {
    const Model model = parse_model(generator::data_sheet(curves()), "sheet");
    log::Log blind = by_antenna(generator::generate(curves()), 2.1);
    std::erase_if(blind.signals, [](const log::Signal &s) { return s.name == "imu.gyro_z_rad_s"; });
    const Dataset data = make_dataset(model, blind);
    EXPECT_EQ(forward(data), nullptr);
    EXPECT_TRUE(says(data, "the camera balance is left out"));
}

TEST(TrackHeading, of_wheels_with_rollers_is_not_asked) {
    Model model = parse_model(generator::data_sheet(curves()), "sheet");
    for (WheelSpec &wheel : model.wheel) wheel.grips_sideways = false;
    model.motion = BodyMotion::planar;
    const Dataset data = make_dataset(model, by_antenna(generator::generate(curves()), 2.1));
    EXPECT_NE(forward(data), nullptr);
    EXPECT_FALSE(says(data, "no camera.yaw_rad"));
}

} // namespace
} // namespace traction::lab
