// Templates of radars that are drawn (radar_template.h): each is whole, and the same whatever the stack held before.
#include "firmware/template/radar_template.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <random>

namespace {

// What lies where the next function's arrays will: numbers that nobody may read.
double leave_on_the_stack(double value) {
    volatile double array[6000];
    for (volatile double &x : array) x = value;
    return array[17];
}

radar_geometry_t drawn(std::mt19937_64 &random, double widest_deg) {
    const auto between = [&random](double low, double high) {
        return low + (high - low) * static_cast<double>(random() >> 11) / 9007199254740992.0;
    };
    static constexpr double rates_Hz[] = {512, 1000, 2000, 4000};
    const double carrier_Hz = std::exp(between(std::log(9e9), std::log(80e9)));
    radar_geometry_t out = radar_geometry_like_reference(carrier_Hz, between(6, widest_deg), between(6, widest_deg),
                                                         rates_Hz[static_cast<std::size_t>(random() % 4)]);
    out.depression_deg = between(15, 60);
    out.target = random() % 8 == 0 ? RADAR_TARGET_POINT : RADAR_TARGET_GROUND;
    return out;
}

// A search whose best place was the last that it had looked at went on to one that it had not: speeds of nought, or of another run's stack.
TEST(RadarTemplate, every_speed_is_told_whatever_the_stack_held) {
    std::mt19937_64 random(20261127);
    int made = 0;
    for (int i = 0; i < 4; i++) {
        const radar_geometry_t radar = drawn(random, i % 2 == 0 ? 14 : 60); // narrow beams are sought from their peak
        if (radar_geometry_check(&radar).field != nullptr) continue;
        doppler_template_t one, other;
        EXPECT_EQ(leave_on_the_stack(-1e300), -1e300);
        radar_template_make(&radar, &one);
        EXPECT_EQ(leave_on_the_stack(0.5), 0.5);
        radar_template_make(&radar, &other);
        EXPECT_EQ(std::memcmp(one.speed_m_s, other.speed_m_s, sizeof one.speed_m_s), 0) << i;
        EXPECT_EQ(one.spread, other.spread) << i;
        for (int k = 0; k < one.speeds; k++) { // a board refuses others (firmware/app/template_text.h)
            EXPECT_TRUE(std::isfinite(one.speed_m_s[k])) << i << ' ' << k;
            EXPECT_GT(one.speed_m_s[k], k == 0 ? 0.0f : one.speed_m_s[k - 1]) << i << ' ' << k;
        }
        made++;
    }
    EXPECT_EQ(made, 4);
}

} // namespace
