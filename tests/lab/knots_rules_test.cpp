// Where the knots of a free shape lie (knots.h), on values made by hand.
#include "host_tools/lab/decision/knots.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace traction::lab {
namespace {

TEST(Knots, are_a_fiftieth_of_the_range_apart_at_least_and_stay_where_a_log_does_not_come_but_on_wheel_speeds) {
    std::vector<double> values; // quantiles of 0.02, 0.2, 0.4, .. at 0, 0.03, 0.045, 0.5, 0.8 and 1
    for (const auto &[count, x] :
         {std::pair{110, 0.0}, std::pair{190, 0.03}, std::pair{200, 0.045}, std::pair{200, 0.5}, std::pair{200, 0.8}, std::pair{100, 1.0}})
        values.insert(values.end(), static_cast<std::size_t>(count), x);
    EXPECT_EQ(knots_on(Axis::slip, values, false), (std::vector<double>{0, 0.03, 0.5, 0.8, 1}));
    std::vector<double> two(100, -1.0), speeds(100, 1.0);
    two.insert(two.end(), 100, 1.0), speeds.insert(speeds.end(), 100, 9.0);
    EXPECT_EQ(knots_on(Axis::yaw_rate, two, false).size(), 6U);
    EXPECT_EQ(knots_on(Axis::abs_wheel_speed, speeds, false).size(), 3U); // the ends, and of those between the one at 1.1
}

TEST(Knots, of_what_hardly_varies_are_few_and_of_a_voltage_that_does_not_none) {
    const std::vector<double> same(100, 3.0);
    EXPECT_EQ(knots_on(Axis::slip, same, false).size(), 1U);
    EXPECT_EQ(knots_on(Axis::slip, {}, false), std::vector<double>{0});
    EXPECT_TRUE(knots_on(Axis::voltage, same, false).empty());
    EXPECT_TRUE(knots_on(Axis::other_current, same, false).empty());
    std::vector<double> up, down;
    for (int i = 0; i <= 1000; ++i) up.push_back(5 + 0.001 * i), down.push_back(-5 - 0.001 * i);
    const std::vector<double> one_way = knots_on(Axis::other_current, down, false);
    ASSERT_EQ(one_way.size(), 3U);
    EXPECT_NEAR(one_way[1], -5.5, 2e-3);                                  // nought is not among them
    const std::vector<double> knots = knots_on(Axis::voltage, up, false); // about nought, as far as the larger end
    ASSERT_EQ(knots.size(), 8U);
    EXPECT_NEAR(knots.back(), 5.98, 2e-3);
    EXPECT_NEAR(knots.front(), -5.98, 2e-3);
    EXPECT_NEAR(knots[4], 0.04 * 5.98, 1e-3);
}

} // namespace
} // namespace traction::lab
