// The fit itself (fit/), on a machine that is linear in all that is fitted and on rows made by hand.
#include "host_tools/lab/fit/checkpoint.h"
#include "host_tools/lab/fit/distribution.h"
#include "host_tools/lab/fit/heldout.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/fit/normal_equations.h"
#include "host_tools/lab/fit/remainder.h"
#include "host_tools/lab/fit/scatter.h"
#include "host_tools/lab/fit/sparse_jacobian.h"
#include "tests/lab/four_wheels.h"
#include "tests/lab/linear_machine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace traction::lab {
namespace {

using namespace hand_made;
using Labels = std::vector<std::string>;

// Two balances of three rows; the second column is nothing in the first, the third in the second.
struct Sparse {
    Dataset data = data_of(2, 3, 1);
    Eigen::MatrixXd J = (Eigen::MatrixXd(6, 3) << 1, 0, 2, 3, 0, 0, 5, 0, 1, 2, 7, 0, 0, 1, 0, 4, 3, 0).finished();
    SparseJacobian sparse{data, J};
};

TEST(Sparse, products_are_those_of_the_whole) {
    const Sparse s;
    ASSERT_EQ(s.sparse.parts().size(), 2U);
    EXPECT_EQ(s.sparse.parts()[0].column, (std::vector<Eigen::Index>{0, 2}));
    EXPECT_EQ(s.sparse.parts()[1].column, (std::vector<Eigen::Index>{0, 1}));
    EXPECT_EQ(s.sparse.parts()[1].first, 3);
    EXPECT_EQ(s.sparse.whole(), s.J);
    EXPECT_EQ(s.sparse.cols(), 3);
    EXPECT_EQ(s.sparse.gram(), s.J.transpose() * s.J);
    Eigen::VectorXd w(6);
    w << 1, 2, 0, 0, 0, 3;
    EXPECT_EQ(s.sparse.gram(w), s.J.transpose() * w.asDiagonal() * s.J);
    w.tail(3).setZero();
    EXPECT_EQ(s.sparse.gram(w), s.J.transpose() * w.asDiagonal() * s.J);
    w << 1, -2, 3, 4, 5, 6;
    EXPECT_EQ(s.sparse.moment(w), s.J.transpose() * w);
    EXPECT_EQ(SparseJacobian().whole().size(), 0);
}

TEST(Normal, equations_are_solved_and_their_inverse_has_no_negative_diagonal) {
    const Eigen::Matrix2d A = (Eigen::Matrix2d() << 4, 1, 1, 3).finished();
    EXPECT_LT((A * solve_normal(A, Eigen::Vector2d(1, 2)) - Eigen::Vector2d(1, 2)).norm(), 1e-14);
    EXPECT_LT((inverse_diagonal(A) - Eigen::Vector2d(3.0 / 11, 4.0 / 11)).norm(), 1e-14);
}

TEST(Tail, of_f_has_its_closed_forms) {
    for (const double f : {0.1, 1.0, 3.0, 40.0}) {
        EXPECT_NEAR(f_tail(f, 2, 8), std::pow(1 + 2 * f / 8, -4), 1e-12);                        // two of the numerator
        EXPECT_NEAR(f_tail(f, 1, 1), 1 - 2 / std::numbers::pi * std::atan(std::sqrt(f)), 1e-12); // Cauchy
        EXPECT_NEAR(f_tail(f, 1, 2), 1 - std::sqrt(f / (f + 2)), 1e-12);                         // t of two
        EXPECT_NEAR(f_tail(f, 5, 2), 1 - std::pow(5 * f / (5 * f + 2), 2.5), 1e-12);             // two of the denominator
        EXPECT_NEAR(f_tail(f, 3, 7) + f_tail(1 / f, 7, 3), 1, 1e-12);                            // its own reciprocal
    }
    EXPECT_EQ(f_tail(0, 3, 5), 1);
    EXPECT_EQ(f_tail(-1, 3, 5), 1);
    EXPECT_EQ(f_tail(1, 3, 0), 1);
}

TEST(Quantile, of_students_t_is_as_tabulated) {
    EXPECT_NEAR(t_quantile(0.05, 1), 12.7062047364, 1e-7);
    EXPECT_NEAR(t_quantile(0.05, 10), 2.22813885196, 1e-8);
    EXPECT_NEAR(t_quantile(0.01, 5), 4.03214298356, 1e-8);
    EXPECT_NEAR(t_quantile(0.05, 1000), 1.96233908082, 1e-8);
    EXPECT_NEAR(t_quantile(0.5, 1), 1, 1e-9);
    EXPECT_NEAR(t_quantile(1e-4, 1), 1000, 1e-6); // 6366, but none beyond a thousand
}

TEST(Ranks, of_signs_are_counted_exactly_and_by_the_normal_where_there_are_many) {
    EXPECT_DOUBLE_EQ(signed_rank_tail({1, 2, 3}), 1.0 / 8);
    EXPECT_DOUBLE_EQ(signed_rank_tail({-1, 2, 3}), 2.0 / 8); // sums 0, 1 of the negative ranks
    EXPECT_DOUBLE_EQ(signed_rank_tail({1, 2, -3}), 5.0 / 8); // 0, 1, 2, 3 (twice)
    EXPECT_DOUBLE_EQ(signed_rank_tail({-3, -2, -1}), 1);
    EXPECT_DOUBLE_EQ(signed_rank_tail({0, 5, 0}), 1.0 / 2); // nothing tells nothing
    EXPECT_EQ(signed_rank_tail({0, 0}), 1);
    EXPECT_EQ(signed_rank_tail({}), 1);
    std::vector<double> many;
    for (int i = 1; i <= 100; ++i) many.push_back(i % 3 == 0 ? -i : i);
    double below = 0;
    for (int i = 3; i <= 100; i += 3) below += i;
    const double z = (100.0 * 101 / 4 - below - 0.5) / std::sqrt(100.0 * 101 * 201 / 24);
    EXPECT_NEAR(signed_rank_tail(many), 0.5 * std::erfc(z / std::sqrt(2)), 1e-15);
    std::vector<double> sixty, more;
    for (int i = 1; i <= 61; ++i) (i <= 60 ? sixty : more).push_back(i);
    EXPECT_DOUBLE_EQ(signed_rank_tail(sixty), std::ldexp(1, -60)); // the last that is exact
    more.insert(more.end(), sixty.begin(), sixty.end());
    EXPECT_GT(signed_rank_tail(more), 1e-13);
}

TEST(Checkpoint, asks_the_innermost_that_lives) {
    std::string asked;
    checkpoint();
    {
        const CheckpointScope outer([&] { asked += 'o'; });
        checkpoint();
        {
            const CheckpointScope inner([&] { asked += 'i'; });
            checkpoint();
        }
        checkpoint();
    }
    checkpoint();
    EXPECT_EQ(asked, "oio");
    const LinearMachine m(24);
    Problem p(m.data, m.physics, {a0(0.2)});
    const CheckpointScope ends([] { throw std::runtime_error("enough"); });
    EXPECT_THROW(p.gauss_newton(1), std::runtime_error);
    EXPECT_THROW(p.fit({}), std::runtime_error);
    EXPECT_THROW(p.fit({.reweight = false, .thorough = true}), std::runtime_error);
    EXPECT_THROW(p.quick_fit(p, 1), std::runtime_error);
}

Eigen::VectorXd ones(const LinearMachine &m) { return Eigen::VectorXd::Ones(m.rows()); }

TEST(Problem, starts_as_stated_with_rows_in_their_own_noise) {
    LinearMachine m(24);
    m.data.balance[1].noise = 2, m.data.balance[1].noise_factor.assign(24, 1), m.data.balance[1].noise_factor[5] = 3;
    m.data.balance[2].smoothing_bias.assign(24, 0), m.data.balance[2].smoothing_bias[7] = 0.5;
    m.data.accel_bias_prior_m_s2 = 0.4; // the sensor's own word
    const Problem p(m.data, m.physics, {a0(0.2), r0(0.05), g0()});
    EXPECT_EQ(p.parameters[0].prior, 0.4);
    EXPECT_EQ(p.parameters[1].prior, 0.05);
    EXPECT_EQ(p.theta, Eigen::Vector3d::Zero());
    const Eigen::VectorXd noise = p.noise_rows(), bias = p.smoothing_bias_rows();
    EXPECT_EQ(noise[0], 1);
    EXPECT_EQ(noise[24 + 4], 2);
    EXPECT_EQ(noise[24 + 5], 6);
    EXPECT_EQ(p.row_scale, noise.cwiseInverse());
    EXPECT_EQ(p.sigma, (std::vector<double>{1, 2, 1}));
    EXPECT_EQ(bias[48 + 7], 0.5);
    EXPECT_EQ(bias.sum(), 0.5);
    EXPECT_LT((p.stated_precision() - Eigen::Vector3d(1 / 0.16, 400, 0)).norm(), 1e-9);
    Problem alike = p;
    alike.parameters[1].alike = 3;
    EXPECT_EQ(alike.alike(), Eigen::Vector3d(1, 3, 1));
    EXPECT_LT((alike.prior_precision() - Eigen::Vector3d(1 / 0.16, 1200, 0)).norm(), 1e-9);
}

TEST(Problem, has_the_columns_of_its_machine_and_the_optimum_of_a_regression) {
    LinearMachine m;
    m.hide(a0(), 0.3), m.hide(r1(), 0.2);
    const std::vector<FreeParameter> free = {a0(0.2), r1(), g0()};
    Problem p(m.data, m.physics, free);
    p.row_scale *= 0.5; // whatever the scales
    p.linearise();
    EXPECT_LT((p.jacobian - 0.5 * m.columns(free)).norm(), 1e-6);
    EXPECT_LT((p.residual - m.left()).norm(), 1e-12);
    EXPECT_NEAR(p.cost(), 0.25 * m.left().squaredNorm(), 1e-9);
    for (const int way : {0, 1, 2}) {
        Problem q = p;
        if (way == 0) q.gauss_newton(2);
        if (way == 1) q.gauss_newton(2, false), q.get_ready();
        if (way == 2) q.fit({.iterations = 20, .reweight = false, .thorough = true}); // Ceres
        const Eigen::VectorXd by = ridge(m.columns(free), m.left(), 0.25 * ones(m), q.prior_precision());
        EXPECT_LT((q.theta - by).norm(), 1e-5) << way;
        EXPECT_LT((q.residual - m.left() + m.columns(free) * q.theta).norm(), 1e-9) << way;
        EXPECT_LT((q.jacobian - p.jacobian).norm(), 1e-6) << way;
        EXPECT_NEAR(q.cost(), 0.25 * q.residual.squaredNorm() + by[0] * by[0] * 25, 1e-4) << way;
    }
}

TEST(Bounds, are_the_range_and_six_stated_deviations_about_what_is_stated) {
    const LinearMachine m(24);
    FreeParameter both = a0(0.2), range = r0();
    both.base = 1, both.minimum = 0.5, both.maximum = 9;
    range.base = 1, range.minimum = -1, range.maximum = 2;
    Problem p(m.data, m.physics, {both, range});
    const auto held = [&](double first, double second) {
        p.theta << first, second;
        p.within_bounds();
        return Eigen::Vector2d(p.theta);
    };
    EXPECT_LT((held(-9, -9) - Eigen::Vector2d(-0.5, -2)).norm(), 1e-12);
    EXPECT_TRUE(p.at_bound(0) && p.at_bound(1));
    EXPECT_LT((held(9, 9) - Eigen::Vector2d(1.2, 1)).norm(), 1e-12);
    EXPECT_TRUE(p.at_bound(0) && p.at_bound(1));
    EXPECT_EQ(held(0.3, -0.4), Eigen::Vector2d(0.3, -0.4));
    EXPECT_FALSE(p.at_bound(0) || p.at_bound(1));
    p.theta << 1.2 - 1.6e-6, 1 - 3.1e-6; // a millionth of the range, 1.7 and 3
    EXPECT_TRUE(p.at_bound(0));
    EXPECT_FALSE(p.at_bound(1));
}

// The optimum of a quadratic in a box: at each bound the gradient points out of it.
TEST(Bounds, hold_a_step_at_the_optimum_of_the_box) {
    const LinearMachine m(24);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int held = 0;
    for (int trial = 0; trial < 40; ++trial) {
        std::vector<FreeParameter> free = {a0(), r0(), g0()};
        for (FreeParameter &f : free) f.minimum = -0.5, f.maximum = 0.4;
        Problem p(m.data, m.physics, free);
        Eigen::Matrix3d A;
        Eigen::Vector3d moment;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) A(i, j) = uniform(random);
            moment[i] = 2 * uniform(random), p.theta[i] = 0.3 * uniform(random);
        }
        const Eigen::Matrix3d normal =
            A.transpose() * A + 2 * Eigen::Matrix3d::Identity(); // nearly apart: one pass of holding is the optimum
        const Eigen::Vector3d step = p.step_within_bounds(normal, moment), gradient = moment - normal * step;
        for (int i = 0; i < 3; ++i) {
            const double x = p.theta[i] + step[i];
            EXPECT_GE(x, -0.5 - 1e-9);
            EXPECT_LE(x, 0.4 + 1e-9);
            const bool inside = x > -0.5 + 1e-9 && x < 0.4 - 1e-9;
            if (inside) {
                EXPECT_NEAR(gradient[i], 0, 1e-9);
            } else {
                ++held;
            }
        }
    }
    EXPECT_GT(held, 10);
}

TEST(Bounds, of_a_fit_leave_the_others_at_their_optimum) {
    LinearMachine m;
    m.hide(a0(), 0.5), m.hide(a2(), 0.02);
    FreeParameter bounded = a0();
    bounded.minimum = -1, bounded.maximum = 0.2;
    Problem p(m.data, m.physics, {bounded, a2()});
    p.gauss_newton(3);
    EXPECT_NEAR(p.theta[0], 0.2, 1e-6);
    const Eigen::MatrixXd J = m.columns({a0(), a2()});
    const Eigen::VectorXd y = m.left() - 0.2 * J.col(0);
    EXPECT_NEAR(p.theta[1], J.col(1).dot(y) / J.col(1).squaredNorm(), 1e-4 * p.theta[1]);
}

TEST(Quick, fit_of_a_candidate_beside_kept_sensitivities_is_the_joint_regression) {
    LinearMachine m;
    m.hide(a2(), 0.02);
    Problem base(m.data, m.physics, {a0(0.2), r0(0.05)});
    base.row_scale *= 0.7;
    base.gauss_newton(2);
    FreeParameter effect = a2();
    for (const double most : {1e9, 0.005}) {
        effect.maximum = most;
        Problem p(m.data, m.physics, {a0(0.2), r0(0.05), effect});
        p.theta.head(2) = base.theta;
        p.quick_fit(base, 4);
        const std::vector<FreeParameter> all = {a0(0.2), r0(0.05), a2()};
        const Eigen::MatrixXd J = m.columns(all);
        EXPECT_EQ(p.row_scale, base.row_scale);
        if (most > 1) {
            EXPECT_LT((p.theta - ridge(J, m.left(), 0.49 * ones(m), p.prior_precision())).norm(), 1e-5);
        } else {
            EXPECT_NEAR(p.theta[2], 0.005, 1e-9);
        }
        EXPECT_LT((p.jacobian - 0.7 * J).norm(), 1e-5);
        EXPECT_LT((p.residual - m.left() + J * p.theta).norm(), 1e-9);
    }
}

// Noise of three times what is stated is found; what is less than stated is not believed; one wild row counts as Huber has it.
TEST(Scales, are_the_residuals_and_never_below_what_is_stated) {
    for (const double size : {3.0, 0.3}) {
        LinearMachine m(400, size);
        Problem p(m.data, m.physics, {a0(0.2)});
        p.fit({});
        for (const double sigma : p.sigma)
            EXPECT_NEAR(sigma, std::max(1.0, size), 0.15 * std::max(1.0, size)); // 400 rows: 4 % and its six parts
        if (size < 1) {
            EXPECT_LT((p.row_scale - Eigen::VectorXd::Ones(p.row_scale.size())).norm(), 1e-12);
        }
    }
    LinearMachine wild(400, 0.3);
    wild.data.balance[2].measured[100] += 12; // four times beyond three
    Problem p(wild.data, wild.physics, {a0(0.2)});
    p.fit({});
    EXPECT_NEAR(p.row_scale[800 + 100], std::sqrt(3 / std::fabs(p.residual[800 + 100])), 0.02);
    EXPECT_NEAR(p.row_scale[800 + 99], 1, 1e-9);
    EXPECT_NEAR(p.balance_rms(2, false), p.residual.tail(400).norm() / 20, 1e-12);
    wild.data.balance[2].noise = 2;
    const Problem halved = [&] {
        Problem one(wild.data, wild.physics, {a0(0.2)});
        one.residual = p.residual;
        return one;
    }();
    EXPECT_NEAR(halved.balance_rms(2, true), 0.5 * halved.balance_rms(2, false), 1e-12);
}

// Noise that grows with the speed is told from what is the same everywhere.
TEST(Scales, follow_the_drive) {
    LinearMachine m(1200, 0);
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    for (std::size_t r = 0; r < 1200; ++r) {
        const double t = 0.5 * (m.data.balance[0].t0_s[r] + m.data.balance[0].t1_s[r]);
        m.data.balance[0].measured[r] = 2 * (2 + std::sin(0.7 * t)) * normal(random);
        m.data.balance[2].measured[r] = 4 * normal(random);
    }
    Problem p(m.data, m.physics, {a0(0.2)});
    p.fit({});
    const Eigen::VectorXd by_speed = p.variance_parts(0), flat = p.variance_parts(2);
    EXPECT_NEAR(by_speed.sum(), 4 * 4.5, 0.15 * 4 * 4.5); // the mean of v^2 is 4.5
    EXPECT_GT(by_speed[4], 0.6 * by_speed.sum());
    EXPECT_NEAR(flat.sum(), 16, 0.15 * 16);
    EXPECT_GT(flat[0], 0.5 * flat.sum());
    EXPECT_EQ(by_speed[1], 0); // nothing pulls here, and no wheel turns
    EXPECT_EQ(by_speed[2] + by_speed[3], 0);
    EXPECT_GE(by_speed.minCoeff(), 0);
    // slow rows count for more: at a speed of 1 and of 3 scales of 2 and 6
    double slow = 0, fast = 0;
    for (std::size_t r = 0; r < 1200; ++r) {
        const double v = 2 + std::sin(0.35 * (m.data.balance[0].t0_s[r] + m.data.balance[0].t1_s[r]));
        if (v < 1.05) slow = std::max(slow, p.row_scale[static_cast<Eigen::Index>(r)]);
        if (v > 2.95) fast = std::max(fast, p.row_scale[static_cast<Eigen::Index>(r)]);
    }
    EXPECT_NEAR(slow, 0.5, 0.12);
    EXPECT_NEAR(fast, 1.0 / 6, 0.03);
}

// Of a rover whose wheels slip, each square of a balance made to be one of the things that it may follow: nearly all is told as that.
TEST(Scales, tell_each_thing_that_what_is_left_may_follow) {
    const FourWheels rover;
    const Physics physics = make_physics(rover.model);
    Problem p(rover.data, physics, free_parameters(rover.model, physics));
    p.linearise();
    const Motion &m = p.forward().motion();
    const auto squares = [&](Eigen::Index part, std::size_t balance, std::size_t r) {
        const Balance &b = rover.data.balance[balance];
        const auto at = [&](double t) { return static_cast<std::size_t>(t / rover.data.step_s); };
        const std::size_t k = at(0.5 * (b.t0_s[r] + b.t1_s[r]));
        const auto [low, high] = std::minmax_element(m.v_m_s.begin() + static_cast<std::ptrdiff_t>(at(b.t0_s[r])),
                                                     m.v_m_s.begin() + static_cast<std::ptrdiff_t>(at(b.t1_s[r])) + 1);
        double of_wheels = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            if (b.wheel >= 0 && static_cast<std::size_t>(b.wheel) != i) continue; // the body's sensors see all
            const WheelInput &w = rover.data.wheel[i];
            of_wheels += std::pow(part == 1   ? m.wheel[i].traction_N[k]
                                  : part == 2 ? w.accel_rad_s2[k]
                                              : std::exp(-std::fabs(m.wheel[i].slip[k]) / 0.1) / std::max(0.2, std::fabs(w.speed_rad_s[k])),
                                  2);
        }
        return part == 0 ? 1 : part == 4 ? std::pow(m.v_m_s[k], 2) : part == 5 ? std::pow(*high - *low, 2) : of_wheels;
    };
    const Eigen::VectorXd noise = p.noise_rows();
    for (const std::size_t balance : {std::size_t(1), std::size_t(8)})
        for (Eigen::Index part = 0; part < 6; ++part) {
            Eigen::VectorXd wanted(120);
            for (std::size_t r = 0; r < 120; ++r) wanted[static_cast<Eigen::Index>(r)] = squares(part, balance, r);
            wanted *= 25 / wanted.mean();
            const double cut = 4 * 1.4826 * 5; // no less than the four robust deviations of which a residual is clipped may be
            ASSERT_GT(wanted.mean(), 1);
            const auto first = static_cast<Eigen::Index>(p.forward().first_row(balance));
            for (Eigen::Index r = 0; r < 120; ++r) p.residual[first + r] = (r % 2 == 0 ? 1 : -1) * std::sqrt(wanted[r]) * noise[first + r];
            const Eigen::VectorXd told = p.variance_parts(balance);
            if (wanted.maxCoeff() < cut * cut) {
                EXPECT_NEAR(told.sum(), 25, 2.5) << part;
            }
            EXPECT_GT(told[part], 0.9 * told.sum()) << part << ": " << told.transpose();
        }
}

TEST(Scales, are_kept_of_another_problem_with_what_its_rows_tell_alike) {
    const LinearMachine m(24);
    Problem one(m.data, m.physics, {a0(0.2), r0(0.05)}), other(m.data, m.physics, {r0(0.05), g0()});
    one.row_scale *= 3, one.sigma = {7, 8, 9}, one.parameters[1].alike = 2.5, other.parameters[1].alike = 4;
    other.keep_scales(one);
    EXPECT_EQ(other.row_scale, one.row_scale);
    EXPECT_EQ(other.sigma, one.sigma);
    EXPECT_EQ(other.parameters[0].alike, 2.5);
    EXPECT_EQ(other.parameters[1].alike, 1); // of which the other knows nothing
    FreeParameter wheel = r0(0.05), own = r0(0.05);
    wheel.wheel = 1, own.own = true;
    for (const FreeParameter &q : {wheel, own}) { // another number
        Problem third(m.data, m.physics, {q});
        third.keep_scales(one);
        EXPECT_EQ(third.parameters[0].alike, 1);
    }
}

// Residuals that are one value over each 2.5 s, five rows: they tell of an offset as often as there are blocks. Never more than four.
TEST(Alike, are_rows_whose_scores_add_up_over_blocks) {
    const auto alike = [](double common, const char *owner, bool table = false) {
        LinearMachine m(400, std::sqrt(1 - common));
        std::mt19937 random(2);
        std::normal_distribution<double> normal;
        double block = 0;
        for (std::size_t r = 0; r < 400; ++r) {
            if (r % 5 == 0) block = normal(random);
            m.data.balance[0].measured[r] += std::sqrt(common) * block;
        }
        m.data.independent_rows = table;
        FreeParameter offset = a0();
        offset.owner = owner;
        Problem p(m.data, m.physics, {offset});
        p.fit({});
        const Eigen::VectorXd e = (p.residual.cwiseProduct(p.row_scale)).head(400);
        double variance = 0, sum = 0, information = 0;
        std::vector<double> score(80, 0);
        for (Eigen::Index r = 0; r < 400; ++r)
            score[static_cast<std::size_t>(r / 5)] += e[r] * p.row_scale[r], information += p.row_scale[r] * p.row_scale[r];
        for (const double s : score) sum += s;
        for (const double s : score) variance += std::pow(s - sum / 81, 2); // one block more, empty, at the end
        variance += std::pow(sum / 81, 2);
        return std::make_pair(p.parameters[0].alike, std::clamp(variance / information, 1.0, 4.0));
    };
    const auto white = alike(0, "motor"), some = alike(0.3, "motor"), all = alike(1, "motor");
    EXPECT_NEAR(white.first, white.second, 0.05); // the scales have moved a little since
    EXPECT_LT(white.first, 1.4);
    EXPECT_NEAR(some.first, some.second, 0.15);
    EXPECT_GT(some.first, 1.5);
    EXPECT_LT(some.first, 3.5);
    EXPECT_EQ(all.first, 4);
    EXPECT_EQ(alike(1, "soil").first, 1);        // another at the next place
    EXPECT_EQ(alike(1, "motor", true).first, 1); // of a table every row is one
}

TEST(Settled, fit_has_scales_that_no_longer_move_it) {
    LinearMachine m(240, 2);
    m.hide(a0(), 0.5);
    Problem p(m.data, m.physics, {a0(), r0(0.05)});
    p.settle();
    const double before = overall_error(p);
    const Eigen::VectorXd theta = p.theta, by = ridge(m.columns(p.parameters), m.left(), p.row_scale.cwiseAbs2(), p.prior_precision());
    EXPECT_LT((theta - by).norm(), 1e-4);
    p.settle_from_here();
    EXPECT_NEAR(overall_error(p), before, 1e-3 * before);
    LinearMachine brief(2);
    brief.data.count = 2; // nothing can be integrated
    Problem none(brief.data, brief.physics, {a0()});
    none.fit({});
    none.settle();
    EXPECT_EQ(none.theta[0], 0);
}

// Two wheels have 0.1 A more friction than the two others, whose sensors are four times as rough; the model has one friction for all.
// Scales that follow the residual have two optima, a fifth of the way and nearly all of it: from the model's number the first.
TEST(Settled, fit_does_not_stay_where_its_scales_have_weighed_down_what_it_misses) {
    FourWheels rover;
    for (const std::size_t b : {1U, 3U}) rover.data.balance[b].noise = 0.04;
    Model truth = rover.model;
    for (const std::size_t w : {0U, 2U}) truth.wheel[w].motor.at("coulomb_Nm").value += 0.03;
    rover.measure(make_physics(truth));
    for (WheelSpec &w : rover.model.wheel) w.motor.at("coulomb_Nm").prior = 0.1;
    const Physics physics = make_physics(rover.model);
    Problem settled(rover.data, physics, free_parameters(rover.model, physics));
    settled.settle();
    const Problem fitted = fitted_problem(rover.model, rover.data);
    EXPECT_GT(settled.balance_rms(0, true), 5); // the trap is there
    for (const std::size_t b : {0U, 2U}) EXPECT_LT(fitted.balance_rms(b, true), 2) << b;
    EXPECT_LT(unlikelihood(fitted).sum(), unlikelihood(settled).sum());
    EXPECT_LT(overall_error(fitted), 0.7 * overall_error(settled));
}

TEST(Unlikelihood, is_twice_the_negative_logarithm_of_the_normal_density_and_falls_over_blocks) {
    FourWheels rover;
    const Physics physics = make_physics(rover.model);
    Problem one(rover.data, physics, free_parameters(rover.model, physics));
    one.settle();
    Problem other = one;
    other.row_scale *= 0.5;
    other.residual *= 3;
    const Eigen::VectorXd rows = unlikelihood(other);
    for (Eigen::Index r = 0; r < rows.size(); r += 17) {
        const double sigma = 1 / other.row_scale[r], z = other.residual[r] / sigma;
        EXPECT_NEAR(rows[r], z * z + 2 * std::log(sigma), 1e-9);
    }
    const Fall fall = fall_of_unlikelihood(other, one);
    EXPECT_NEAR(fall.sum, (rows - unlikelihood(one)).sum(), 1e-6);
    EXPECT_NEAR(fall.of_block.sum(), fall.sum, 1e-6);
    EXPECT_TRUE(fall.sure());
    EXPECT_FALSE(fall_of_unlikelihood(one, other).sure());
    EXPECT_FALSE(fall_of_unlikelihood(one, one).sure());
}

TEST(Error, of_all_is_the_root_mean_over_balances_in_noises) {
    Dataset data = data_of(2, 2, 1);
    data.balance[1].noise = 2;
    const Problem p = problem_of(data, {}, Eigen::MatrixXd(4, 0), Eigen::Vector4d(3, 4, 6, 8));
    EXPECT_DOUBLE_EQ(overall_error(p), std::sqrt(12.5)); // 12.5 of both
    EXPECT_DOUBLE_EQ(p.balance_rms(1, false), std::sqrt(50));
    data.balance.clear();
    EXPECT_EQ(overall_error(problem_of(data, {}, Eigen::MatrixXd(0, 0), Eigen::VectorXd(0))), 0);
}

TEST(Remainder, of_noise_is_the_sensors_and_what_follows_the_speed_is_vibration) {
    LinearMachine m(1200, 1);
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    for (std::size_t r = 0; r < 1200; ++r)
        m.data.balance[0].measured[r] = 4 * (2 + std::sin(0.7 * (m.data.balance[0].t0_s[r] + 0.25))) * normal(random);
    m.data.balance[2].measured[50] += 200; // one wild row
    Problem p(m.data, m.physics, {a0(0.2)});
    p.fit({});
    const Remainder left = remainder_of(p);
    double squares = 0;
    for (const double part : left.part) squares += part * part;
    EXPECT_NEAR(left.error, std::sqrt(squares), 1e-12);
    EXPECT_NEAR(left.error, overall_error(p), 1e-9 * left.error);
    EXPECT_NEAR(left.of(LeftBy::sensors), 1, 0.03);                       // of each balance one square of noise
    EXPECT_GT(left.of(LeftBy::vibration), 0.7 * std::sqrt(16 * 4.5 / 3)); // most of what grows with v
    EXPECT_NEAR(left.of(LeftBy::outliers), std::sqrt(200.0 * 200 / 1200 / 3), 0.5);
    EXPECT_EQ(left.of(LeftBy::ground), 0);
    EXPECT_EQ(left.of(LeftBy::encoders), 0);
    LinearMachine quiet(240, 0.5);
    Problem q(quiet.data, quiet.physics, {a0(0.2)});
    q.fit({});
    EXPECT_NEAR(remainder_of(q).of(LeftBy::sensors), 0.5, 0.05); // less than stated is the sensors' too
    EXPECT_NEAR(remainder_of(q).of(LeftBy::everywhere), 0, 1e-12);
    const Dataset nothing = data_of(0, 3, 1);
    EXPECT_EQ(remainder_of(problem_of(nothing, {}, Eigen::MatrixXd(0, 0), Eigen::VectorXd(0))).error, 0);
    Labels words;
    for (std::size_t c = 0; c < left_by_count; ++c) words.push_back(words_of(static_cast<LeftBy>(c)));
    std::sort(words.begin(), words.end());
    EXPECT_EQ(std::unique(words.begin(), words.end()), words.end());
    EXPECT_FALSE(words.front().empty());
}

TEST(Scatter, is_none_where_no_encoder_scatters) {
    const LinearMachine m(24);
    Problem p(m.data, m.physics, {a0(0.2)});
    p.linearise();
    const Scatter s(p);
    EXPECT_EQ(s.squares.sum(), 0);
    EXPECT_EQ(s.part.sum(), 0);
    EXPECT_EQ(s.share, 0);
}

TEST(Stored, fit_has_its_values_intervals_and_errors) {
    LinearMachine m(240);
    m.hide(a0(), 0.3);
    Model model;
    model.motion = BodyMotion::imposed;
    model.sensors["accel.bias_m_s2"].prior = 0.5, model.sensors["radar.scale"].prior = 0.05;
    Model same = model;
    const Problem p = fitted_problem(model, m.data);
    const LadderStep step = fit_model(model, m.data, "label");
    EXPECT_EQ(step.label, "label");
    EXPECT_DOUBLE_EQ(step.train, overall_error(p));
    EXPECT_GT(step.heldout, step.train);
    EXPECT_EQ(step.floor, 1);
    const Parameter &bias = model.sensors.at("accel.bias_m_s2");
    EXPECT_NEAR(bias.value, 0.3, 3.5 / std::sqrt(240));
    EXPECT_NEAR(bias.value, p.theta[0], 1e-12);
    EXPECT_NEAR(bias.high - bias.value, bias.value - bias.low, 1e-12);
    EXPECT_NEAR((bias.high - bias.low) / 2, 2 / std::sqrt(240), 0.7 / std::sqrt(240));
    store_fit(same, p, "");
    EXPECT_EQ(same.sensors.at("accel.bias_m_s2").value, bias.value);
}

} // namespace
} // namespace traction::lab
