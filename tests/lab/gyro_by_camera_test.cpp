// A gyro's scale by the camera's heading (gyro_by_camera.h), of turns made by hand: what is recovered, what it denies, where it is silent.
#include "host_tools/lab/decision/evidence.h"
#include "host_tools/lab/decision/gyro_by_camera.h"
#include "host_tools/lab/decision/turned_by_wheels.h"
#include "tests/lab/four_wheels.h"
#include "tests/lab/linear_machine.h"

#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <random>
#include <utility>

namespace traction::lab {
namespace {

using namespace hand_made;

const double pace_rad_s = 2 * std::acos(-1.0) / 7;

struct Turns {
    double scale = 0, offset_rad_s = 0, late_s = 0, noise_rad = 0, strays_rad_s = 0 /* times root s */, hiss_rad_s = 0, fastest_rad_s = 0.6,
           duration_s = 80, step_s = 0.01;
};

// Turns to and fro of 7 s; a gyro that reads (1 + scale) of the rate and an offset more, a camera that is late.
Dataset turning(const Turns &is, std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Dataset data;
    data.gyro = data.camera_heading = true, data.step_s = is.step_s;
    data.count = static_cast<std::size_t>(std::lround(is.duration_s / data.step_s));
    double strayed_rad = 0;
    for (std::size_t k = 0; k < data.count; ++k) {
        const double t = data.time(k);
        strayed_rad += is.strays_rad_s * std::sqrt(data.step_s) * normal(random);
        data.yaw_rate_rad_s.push_back((1 + is.scale) * is.fastest_rad_s * std::sin(pace_rad_s * t) + is.offset_rad_s +
                                      is.hiss_rad_s * normal(random));
        data.yaw_rad.push_back(is.fastest_rad_s / pace_rad_s * (1 - std::cos(pace_rad_s * (t - is.late_s))) +
                               is.noise_rad * normal(random) + strayed_rad);
    }
    return data;
}

TEST(GyroByCamera, is_the_scale_whatever_the_offset_and_the_delay) {
    for (const double scale : {-0.12, 0.0, 0.05}) {
        const auto seen = gyro_by_camera(turning({.scale = scale, .offset_rad_s = 0.02, .late_s = 0.08}));
        ASSERT_TRUE(seen);
        EXPECT_NEAR(seen->scale, scale, 1.1 * 0.5 * std::pow(pace_rad_s * 0.08, 2)); // the delay is of the first order
    }
}

// Of a camera's noise, whose windows share their ends, and of a heading that strays (odometry), whose windows do not.
TEST(GyroByCamera, misses_by_no_more_than_its_standard_error_says) {
    constexpr int draws = 200;
    for (const Turns &is : {Turns{.scale = 0.05, .noise_rad = 0.02}, Turns{.scale = 0.05, .strays_rad_s = 0.02}}) {
        double squares = 0;
        for (std::uint32_t seed = 1; seed <= draws; ++seed) {
            const auto seen = gyro_by_camera(turning(is, seed));
            ASSERT_TRUE(seen);
            squares += (seen->scale - is.scale) * (seen->scale - is.scale) / (seen->error * seen->error);
        }
        EXPECT_LT(squares / draws, 1) << is.noise_rad;
        EXPECT_GT(squares / draws, 0.3) << is.noise_rad; // no more than twice too wide
    }
}

TEST(GyroByCamera, denies_a_scale_that_none_is_nearer_to_by_three_errors) {
    const ScaleByPeer none{0.003, 0.01};
    EXPECT_TRUE(none.denies(-0.055));
    EXPECT_TRUE(none.denies(0.055));
    EXPECT_FALSE(none.denies(0.02)); // too small to be told from none
    const ScaleByPeer half{0.05, 0.01};
    EXPECT_FALSE(half.denies(0.05));
    EXPECT_FALSE(half.denies(0.09)); // of another size, but there is one
    EXPECT_TRUE(half.denies(-0.05)); // of the other sign
}

TEST(GyroByCamera, says_nothing_without_both_or_without_turns) {
    const Turns is{.scale = 0.05, .noise_rad = 0.004};
    ASSERT_TRUE(gyro_by_camera(turning(is)));
    Dataset by_gyro_alone = turning(is);
    by_gyro_alone.camera_heading = false; // its heading is the gyro's own
    EXPECT_FALSE(gyro_by_camera(by_gyro_alone));
    Dataset by_camera_alone = turning(is);
    by_camera_alone.gyro = false;
    EXPECT_FALSE(gyro_by_camera(by_camera_alone));
    Turns brief = is, straight = is;
    brief.duration_s = 18;
    EXPECT_FALSE(gyro_by_camera(turning(brief)));
    straight.fastest_rad_s = 0, straight.hiss_rad_s = 0.005;
    for (std::uint32_t seed = 1; seed <= 10; ++seed) EXPECT_FALSE(gyro_by_camera(turning(straight, seed))) << seed;
}

TEST(GyroByCamera, does_not_look_across_the_end_of_a_run) {
    Dataset two = turning({.scale = 0.05});
    for (std::size_t k = two.count / 2; k < two.count; ++k) two.yaw_rad[k] += 2; // the second begins with another heading
    const double middle = two.time(two.count / 2) - 0.5;
    for (std::size_t k = two.count / 2 - 50; k < two.count / 2; ++k) two.yaw_rad[k] += 2; // in the middle of a window
    two.run_start_s = {two.start_s, middle};
    const auto seen = gyro_by_camera(two);
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->scale, 0.05, 0.002);
    EXPECT_LT(seen->error, 0.001);
    two.run_start_s.clear();
    EXPECT_GT(gyro_by_camera(two)->error, 0.05);
}

// What the wheels' speeds have of the gyro's rate.
void turn_by_wheels(Dataset &data, const Physics &physics, double share) {
    for (std::size_t i = 0; i < physics.wheel.size(); ++i)
        for (std::size_t k = 0; k < data.count; ++k)
            data.wheel[i].speed_rad_s[k] = 2 - share * physics.wheel[i].y / physics.wheel[i].radius * data.yaw_rate_rad_s[k];
}

TEST(TurnedByWheels, where_their_speeds_have_the_yaw_rate_and_not_the_ground) {
    FourWheels rover;
    Physics physics = make_physics(rover.model);
    Dataset data = rover.data;
    data.yaw_rate_rad_s =
        turning({.offset_rad_s = 0.3, .duration_s = static_cast<double>(data.count) * data.step_s, .step_s = data.step_s}).yaw_rate_rad_s;
    ASSERT_EQ(data.yaw_rate_rad_s.size(), data.count);
    for (const auto &[share, turned] : {std::pair(1.5, true), {0.81, true}, {0.79, false}, {0.0, false}, {-1.0, false}}) {
        turn_by_wheels(data, physics, share);
        EXPECT_EQ(turned_by_wheels(data, physics), turned) << share;
    }
    Dataset hissing = data; // what the encoders scatter turns nothing
    std::mt19937 random(1);
    std::normal_distribution<double> normal(0, 5);
    for (WheelInput &w : hissing.wheel)
        for (double &speed : w.speed_rad_s) speed += normal(random);
    EXPECT_FALSE(turned_by_wheels(hissing, physics));
    Physics rollers = physics;
    rollers.grips_sideways.assign(rollers.grips_sideways.size(), false);
    EXPECT_TRUE(turned_by_wheels(data, rollers)) << "(1) is not theirs";
    Dataset without = data;
    without.yaw_rate_rad_s.clear();
    EXPECT_TRUE(turned_by_wheels(without, physics));
    for (WheelPhysics &w : physics.wheel) w.y = 0.3;
    EXPECT_TRUE(turned_by_wheels(data, physics)) << "all on one line";
}

TEST(Evidence, of_a_gyros_scale_is_none_where_the_ground_turns_the_machine) {
    FourWheels rover;
    const Physics physics = make_physics(rover.model);
    Candidate scale = candidate("gyro_scale");
    scale.touched = stage_sensors;
    for (const double share : {0.5, 1.2}) {
        Dataset data = rover.data;
        data.gyro = true, data.camera_heading = false;
        data.yaw_rate_rad_s = turning({.duration_s = static_cast<double>(data.count) * data.step_s, .step_s = data.step_s}).yaw_rate_rad_s;
        turn_by_wheels(data, physics, share);
        Physics moved = physics;
        moved.body.gyro_scale = 0.1;
        Problem before(data, physics, {}), with(data, moved, {});
        before.linearise(), with.linearise();
        EXPECT_EQ(evidence_of(scale, before, as_fitted(before), with, as_fitted(with)).smooths, share < 1);
    }
}

TEST(Evidence, of_a_gyros_scale_is_none_where_the_camera_denies_it) {
    FourWheels rover;
    const Physics physics = make_physics(rover.model);
    const double lasts_s = static_cast<double>(rover.data.count) * rover.data.step_s;
    const Dataset turns = turning({.scale = 0.05, .noise_rad = 0.004, .duration_s = lasts_s, .step_s = rover.data.step_s});
    Candidate scale = candidate("gyro_scale"), other = candidate("gyro_delay");
    scale.touched = other.touched = stage_sensors;
    for (const bool camera : {true, false})
        for (const double named : {0.05, -0.05}) {
            Dataset with_turns = rover.data;
            with_turns.gyro = true, with_turns.camera_heading = camera;
            with_turns.yaw_rate_rad_s = turns.yaw_rate_rad_s, with_turns.yaw_rad = turns.yaw_rad;
            turn_by_wheels(with_turns, physics, 1);
            Physics moved = physics;
            moved.body.gyro_scale = named;
            Problem before(with_turns, physics, {}), with(with_turns, moved, {});
            before.linearise(), with.linearise();
            const HeldOut left_before = as_fitted(before), left_with = as_fitted(with);
            EXPECT_EQ(evidence_of(scale, before, left_before, with, left_with).smooths, camera && named < 0) << camera << named;
            EXPECT_FALSE(evidence_of(other, before, left_before, with, left_with).smooths);
        }
}

} // namespace
} // namespace traction::lab
