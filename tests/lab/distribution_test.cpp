// Tails of the distributions (distribution.h) beside tables and closed forms.
#include "host_tools/lab/fit/distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace traction::lab {
namespace {

TEST(Distribution, the_tail_of_F_agrees_with_tables_and_closed_forms) {
    EXPECT_NEAR(f_tail(4.964602743730711, 1, 10), 0.05, 1e-9);            // tabulated 5 % point of F(1, 10)
    EXPECT_NEAR(f_tail(3.0, 2, 8), std::pow(1 + 2 * 3.0 / 8, -4), 1e-12); // d1 = 2: (1 + 2 f/d2)^(-d2/2)
    EXPECT_EQ(f_tail(0, 1, 5), 1);
}

TEST(Distribution, signed_ranks_agree_with_tables) {
    EXPECT_DOUBLE_EQ(signed_rank_tail({3, 1, 4, 1.5, 9}), 1.0 / 32);                        // all signs alike: one choice of 2^n
    EXPECT_NEAR(signed_rank_tail({-1, -2, -3, -4, 5, 6, 7, 8, 9, 10}), 43.0 / 1024, 1e-12); // tabulated: n = 10, W = 10
    EXPECT_NEAR(signed_rank_tail({100, 0, -1, 2, 300, 4, 5, -0.5, 6}), 5.0 / 256,
                1e-12); // n = 8, W = 3: only ranks count, and zeros do not
    EXPECT_GT(signed_rank_tail({-5, -6, -7, 1}), 0.9);
    std::vector<double> many;
    for (int i = 1; i <= 60; ++i) many.push_back(i % 5 == 0 ? -i : i);
    const double exact = signed_rank_tail(many);
    many.push_back(-0.01), many.push_back(0.02); // two more, the smallest: now by the normal approximation
    EXPECT_NEAR(std::log10(signed_rank_tail(many)), std::log10(exact), 0.5);
    EXPECT_EQ(signed_rank_tail({}), 1);
}

} // namespace
} // namespace traction::lab
