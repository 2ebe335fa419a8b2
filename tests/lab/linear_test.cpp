// Screening, held-out error and the rival of the tolerances on a machine that is linear in all that is fitted (linear_machine.h): each
// answer beside the same by ridge regression in its textbook form, block by block, with nothing of the lab's own algebra.
#include "host_tools/lab/decision/tolerance.h"
#include "host_tools/lab/fit/distribution.h"
#include "host_tools/lab/fit/heldout.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/fit/screen.h"
#include "tests/lab/linear_machine.h"

#include <gtest/gtest.h>
#include <optional>

#include <algorithm>
#include <cmath>
#include <set>

namespace traction::lab {
namespace {

using namespace hand_made;

// A model of these parameters fitted to the machine, by the lab and by the textbook.
struct Fitted {
    const LinearMachine &machine;
    std::vector<FreeParameter> parameters;
    Eigen::MatrixXd J;
    Eigen::VectorXd y, precision;
    Fitted(const LinearMachine &m, std::vector<FreeParameter> p)
        : machine(m), parameters(std::move(p)), J(m.columns(parameters)), y(m.left()) {
        precision.resize(J.cols());
        for (std::size_t i = 0; i < parameters.size(); ++i)
            precision[static_cast<Eigen::Index>(i)] = parameters[i].prior > 0 ? 1 / (parameters[i].prior * parameters[i].prior) : 0;
    }
    Problem problem() const {
        Problem p(machine.data, machine.physics, parameters);
        p.gauss_newton(2);
        return p;
    }
    Eigen::VectorXd theta(const Eigen::VectorXd &weight) const { return ridge(J, y, weight, precision); }
    Eigen::VectorXd theta() const { return theta(Eigen::VectorXd::Ones(y.size())); }
    double penalty(const Eigen::VectorXd &at) const { return at.cwiseAbs2().dot(precision); }
    double cost() const { return (y - J * theta()).squaredNorm() + penalty(theta()); }
    // Of every row the block of this length that its middle lies in.
    std::vector<std::size_t> blocks(double length) const {
        std::vector<std::size_t> out;
        for (const Balance &b : machine.data.balance)
            for (std::size_t r = 0; r < b.measured.size(); ++r)
                out.push_back(static_cast<std::size_t>((0.5 * (b.t0_s[r] + b.t1_s[r]) - machine.data.start_s) / length));
        return out;
    }
    // Residual of every row, predicted without the rows of its group.
    Eigen::VectorXd left_out(const std::vector<std::size_t> &group) const {
        Eigen::VectorXd out(y.size());
        for (const std::size_t g : std::set<std::size_t>(group.begin(), group.end())) {
            Eigen::VectorXd weight(y.size());
            for (Eigen::Index r = 0; r < y.size(); ++r) weight[r] = group[static_cast<std::size_t>(r)] == g ? 0 : 1;
            const Eigen::VectorXd e = y - J * theta(weight);
            for (Eigen::Index r = 0; r < y.size(); ++r)
                if (weight[r] == 0) out[r] = e[r];
        }
        return out;
    }
    // The held-out residual: blocks of 5 s in at most ten parts.
    Eigen::VectorXd held_out() const {
        std::vector<std::size_t> part = blocks(std::min(5.0, machine.data.duration_s / 10));
        for (std::size_t &one : part) one %= 10;
        return left_out(part);
    }
};

Eigen::VectorXd sums(const Eigen::VectorXd &rows, const std::vector<std::size_t> &block) {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(*std::max_element(block.begin(), block.end()) + 1));
    for (Eigen::Index r = 0; r < rows.size(); ++r) out[static_cast<Eigen::Index>(block[static_cast<std::size_t>(r)])] += rows[r];
    return out;
}

constexpr double close = 1e-6; // relative: the lab's ridge of 1e-9 of the normal matrix, many times over

void expect_close(const Eigen::VectorXd &is, const Eigen::VectorXd &wanted, const char *what) {
    ASSERT_EQ(is.size(), wanted.size()) << what;
    EXPECT_LT((is - wanted).norm(), close * (1 + wanted.norm())) << what << ": " << is.transpose() << " for " << wanted.transpose();
}

TEST(HeldOut, error_is_that_of_refits_without_each_of_ten_parts) {
    for (const std::size_t rows : {std::size_t(120), std::size_t(60)}) { // 60 s, and 30 s: blocks of 3 s
        LinearMachine m(rows);
        m.hide(a2(), 0.02);
        const Fitted f(m, {a0(0.2), r0(0.05), g0()});
        const HeldOut held = held_out(f.problem());
        expect_close(held.residual, f.held_out(), "residual");
        EXPECT_EQ(held.block, f.blocks(rows == 120 ? 5 : 3));
        EXPECT_EQ(held.blocks, rows == 120 ? 12U : 10U);
        EXPECT_NEAR(held.error, std::sqrt(held.residual.squaredNorm() / static_cast<double>(m.rows())), 1e-9); // three balances alike
        const HeldOut as = as_fitted(f.problem());
        expect_close(as.residual, f.y - f.J * f.theta(), "as fitted");
        EXPECT_LT(as.error, held.error);
    }
}

TEST(HeldOut, error_of_a_table_leaves_out_rows_and_that_of_nothing_to_fit_leaves_all_as_it_is) {
    LinearMachine m(24);
    m.data.independent_rows = true, m.data.step_s = 0.5, m.data.count = 25; // a row a step
    m.data.body_speed_m_s.assign(25, 1);
    const Fitted f(m, {a0(0.2), g0()});
    EXPECT_EQ(held_out(f.problem()).blocks, 24U);
    const Fitted none(m, {});
    const HeldOut held = held_out(none.problem());
    EXPECT_EQ(held.residual, as_fitted(none.problem()).residual);
}

TEST(Fall, is_summed_by_blocks_with_its_standard_error) {
    HeldOut before, after;
    before.blocks = after.blocks = 2;
    before.block = after.block = {0, 1, 0};
    before.residual = Eigen::Vector3d(3, 2, 1), after.residual = Eigen::Vector3d(1, 2, -2);
    const Fall fall = fall_between(before, after, Eigen::Vector3d(1, 10, 2));
    EXPECT_DOUBLE_EQ(fall.of_block[0], 8 - 6);
    EXPECT_DOUBLE_EQ(fall.of_block[1], 0);
    EXPECT_DOUBLE_EQ(fall.sum, 2);
    EXPECT_DOUBLE_EQ(fall.error, 2); // of 2 and 0: deviations of 1, n / (n - 1) = 2
    EXPECT_FALSE(fall.sure());
    Fall more = fall;
    more.sum = 2.01;
    EXPECT_TRUE(more.sure());
}

TEST(Weights, of_noise_make_the_mean_over_balances_of_their_mean_squares) {
    Dataset data = data_of(2, 2, 1);
    data.balance[1].noise = 2;
    data.balance[1].noise_factor = {1, 3};
    const Problem p = problem_of(data, {}, Eigen::MatrixXd(4, 0), Eigen::Vector4d(1, 2, 3, 4));
    const Eigen::VectorXd weight = noise_weight(p);
    EXPECT_LT((weight - Eigen::Vector4d(0.25, 0.25, 0.0625, 0.25 / 36)).norm(), 1e-15);
    EXPECT_DOUBLE_EQ(as_fitted(p).error, overall_error(p));
}

// The candidate beside a baseline, by direct solutions.
struct Assessed {
    Fitted base, joint;
    Eigen::Index n, k;
    Assessed(const LinearMachine &m, const std::vector<FreeParameter> &own, const std::vector<FreeParameter> &candidate)
        : base(m, own), joint(m, together(own, candidate)), n(static_cast<Eigen::Index>(own.size())),
          k(static_cast<Eigen::Index>(candidate.size())) {}
    static std::vector<FreeParameter> together(std::vector<FreeParameter> a, const std::vector<FreeParameter> &b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
    }
    Eigen::MatrixXd columns() const { return joint.J.rightCols(k); }
    // Held-out error per block of 5 s, at most four times that of the fit.
    Eigen::VectorXd block_error(const Fitted &f) const {
        const std::vector<std::size_t> block = f.blocks(5);
        const Eigen::VectorXd fit = base.y - base.J * base.theta(); // of the baseline: what both are measured by
        return sums(f.left_out(block).cwiseAbs2(), block).cwiseMin(4 * sums(fit.cwiseAbs2(), block));
    }
    Eigen::MatrixXd without_fine_block(const Fitted &f) const { // a column of increments per block of 2.5 s
        const std::vector<std::size_t> block = f.blocks(2.5);
        const std::size_t count = *std::max_element(block.begin(), block.end()) + 1;
        Eigen::MatrixXd out(f.J.cols(), static_cast<Eigen::Index>(count));
        for (std::size_t b = 0; b < count; ++b) {
            Eigen::VectorXd weight(f.y.size());
            for (Eigen::Index r = 0; r < f.y.size(); ++r) weight[r] = block[static_cast<std::size_t>(r)] == b ? 0 : 1;
            out.col(static_cast<Eigen::Index>(b)) = f.theta(weight);
        }
        return out;
    }
    // Change of the strengths where a prior's mean moves by one deviation, a column per prior.
    Eigen::MatrixXd by_prior() const {
        Eigen::MatrixXd normal = joint.J.transpose() * joint.J, moved = Eigen::MatrixXd::Zero(n + k, n);
        normal.diagonal() += joint.precision;
        for (Eigen::Index i = 0; i < n; ++i) moved(i, i) = std::sqrt(joint.precision[i]); // precision times a deviation
        return normal.fullPivLu().solve(moved).bottomRows(k);
    }
};

TEST(Assessment, of_one_strength_is_the_step_of_the_joint_regression) {
    LinearMachine m;
    m.hide(a2(), 0.03);
    const Assessed by(m, {a0(0.2), r0(0.05), g0()}, {a2()});
    const Problem problem = by.base.problem();
    const Screen screen(problem);
    const Assessment a = screen.assess(by.columns(), Eigen::VectorXd::Zero(1), true);
    const Eigen::VectorXd whole = by.joint.theta();
    expect_close(a.strength, whole.tail(1), "strength");
    expect_close(a.change, whole.head(by.n) - by.base.theta(), "change");
    EXPECT_NEAR(a.error_reduction, by.base.cost() - by.joint.cost(), close * by.base.cost());
    EXPECT_NEAR(screen.error(), by.base.cost(), close * by.base.cost());
    EXPECT_NEAR(screen.penalty(), by.base.penalty(by.base.theta()), close);
    EXPECT_NEAR(a.column_norm, by.columns().norm(), 1e-9);
    expect_close(screen.block_error(), by.block_error(by.base), "blocks");
    expect_close(a.block_gain, by.block_error(by.base) - by.block_error(by.joint), "gain of blocks");
    EXPECT_NEAR(a.prior_reduction, by.base.penalty(by.base.theta()) - by.joint.penalty(whole), close);
    EXPECT_NEAR(a.spared, a.prior_reduction, 1e-9); // no row counts for less
    EXPECT_NEAR(a.gain, a.block_gain.sum() + a.prior_reduction, 1e-9);
    EXPECT_NEAR(a.gain_error, sum_error(a.block_gain), 1e-9);
    EXPECT_NEAR(screen.heldout_error(), by.block_error(by.base).sum() + screen.penalty(), close * by.base.cost());
    EXPECT_NEAR(screen.explainable(), std::max(0.0, screen.heldout_error() - static_cast<double>(m.rows())), 1e-6);
    // what the baseline cannot imitate of it
    Eigen::MatrixXd normal = by.base.J.transpose() * by.base.J;
    normal.diagonal() += by.base.precision;
    const Eigen::VectorXd c = by.columns(), imitation = normal.fullPivLu().solve(by.base.J.transpose() * c);
    const double beside = c.squaredNorm() - c.dot(by.base.J * imitation);
    EXPECT_NEAR(a.information, beside / c.squaredNorm(), close);
    EXPECT_NEAR(a.projected.squaredNorm(), beside, close * beside);
    expect_close(screen.projected(c), a.projected, "projected");
    expect_close(a.projected.head(c.size()), c - by.base.J * imitation, "rows");
}

// Jackknife over blocks of 2.5 s, and what the priors' own deviations may move.
TEST(Assessment, has_the_jackknifes_errors_and_students_t_of_the_blocks_that_inform_it) {
    LinearMachine m(120, 2.0); // twice the noise stated
    m.hide(a2(), 0.02);
    const Assessed by(m, {a0(0.2), r0(0.05), g0()}, {a2()});
    const Problem problem = by.base.problem();
    const Assessment a = Screen(problem).assess(by.columns(), Eigen::VectorXd::Zero(1), false);
    const Eigen::VectorXd strength = by.without_fine_block(by.joint).bottomRows(1).transpose();
    const double count = static_cast<double>(strength.size());
    ASSERT_EQ(count, 24);
    const double data = (count - 1) / count * (strength.array() - a.strength[0]).square().sum(), prior = by.by_prior().squaredNorm();
    EXPECT_GT(prior, 0.05 * data);                                                         // both matter
    EXPECT_NEAR(a.standard_error[0], std::sqrt(data + prior), 1e-4 * a.standard_error[0]); // its ridge is 1e-6
    Eigen::MatrixXd normal = by.base.J.transpose() * by.base.J;
    normal.diagonal() += by.base.precision;
    const Eigen::VectorXd c = by.columns(), own = c - by.base.J * normal.fullPivLu().solve(by.base.J.transpose() * c);
    const Eigen::VectorXd inform = sums(own.cwiseAbs2(), by.base.blocks(2.5));
    const double effective = std::pow(inform.sum(), 2) / inform.squaredNorm(), share = (data + prior) / data;
    const double freedom = std::clamp((effective - 1) * share * share, 5.0, count - 1);
    EXPECT_NEAR(a.freedom, freedom, 1e-3 * freedom);
    const double t = a.strength[0] / a.standard_error[0];
    EXPECT_NEAR(a.p_value, f_tail(t * t, 1, a.freedom), 1e-9);
    EXPECT_TRUE(a.projected.size() == 0);
}

TEST(Assessment, is_never_surer_than_half_of_what_white_noise_of_the_stated_size_gives) {
    LinearMachine quiet(120, 0.01);
    const Assessed by(quiet, {r0(0.05)}, {a2()});
    const Problem problem = by.base.problem();
    const Assessment a = Screen(problem).assess(by.columns(), Eigen::VectorXd::Zero(1), false);
    EXPECT_NEAR(a.standard_error[0], 0.5 / by.columns().norm(), 1e-6 * a.standard_error[0]);
    EXPECT_EQ(a.freedom, 23); // the error is not the blocks'
}

// One block alone tells of it.
TEST(Assessment, that_one_block_carries_has_five_degrees_of_freedom_and_counts_that_block_four_times_at_most) {
    LinearMachine m;
    const Assessed by(m, {a0(0.2)}, {r0()});
    const Problem problem = by.base.problem();
    Eigen::MatrixXd column = Eigen::MatrixXd::Zero(m.rows(), 1);
    column.middleRows(20, 5).setConstant(3); // 10 s to 12.5 s of the accelerometer
    Problem with = problem;
    with.residual.segment(20, 5).array() += 6; // a size of 2
    const Screen screen(with);
    const Assessment a = screen.assess(column, Eigen::VectorXd::Zero(1), false);
    EXPECT_NEAR(a.freedom, 5, 1e-9);
    EXPECT_NEAR(a.strength[0], 2, 1);
    // without its block nothing is known of its size: nothing is gained there
    EXPECT_NEAR(a.block_gain[2], 0, 0.1 * screen.block_error()[2]);
}

TEST(Assessment, of_two_strengths_is_a_joint_one) {
    LinearMachine m;
    m.hide(a2(), 0.03), m.hide(r1(), 0.4);
    const Assessed by(m, {a0(0.2), g0()}, {a2(), r1()});
    const Problem problem = by.base.problem();
    const Assessment a = Screen(problem).assess(by.columns(), Eigen::VectorXd::Zero(2), false);
    expect_close(a.strength, by.joint.theta().tail(2), "strength");
    EXPECT_NEAR(a.error_reduction, by.base.cost() - by.joint.cost(), close * by.base.cost());
    expect_close(a.block_gain, by.block_error(by.base) - by.block_error(by.joint), "gain of blocks");
    const Eigen::MatrixXd left = by.without_fine_block(by.joint).bottomRows(2).colwise() - Eigen::VectorXd(a.strength),
                          prior = by.by_prior();
    const double count = static_cast<double>(left.cols());
    const Eigen::MatrixXd covariance = (count - 1) / count * left * left.transpose() + prior * prior.transpose();
    for (Eigen::Index j = 0; j < 2; ++j) EXPECT_NEAR(a.standard_error[j], std::sqrt(covariance(j, j)), 1e-4 * a.standard_error[j]);
    const double wald = a.strength.dot(covariance.fullPivLu().solve(a.strength)) / 2, freedom = a.freedom - 1; // Hotelling
    EXPECT_NEAR(std::log(a.p_value), std::log(f_tail(wald * freedom / a.freedom, 2, freedom)), 0.01);
}

TEST(Assessment, counts_what_is_present_and_finds_nothing_in_what_cannot_be_told) {
    LinearMachine m;
    m.hide(a2(), 0.03);
    const Assessed by(m, {a0(), g0()}, {a2()});
    const Problem joint = by.joint.problem();
    const Screen beside(joint, 2);
    const Assessment a = beside.assess(by.columns(), joint.theta.tail(1), false);
    expect_close(a.strength, joint.theta.tail(1), "strength"); // it stands at its optimum
    EXPECT_NEAR(a.error_reduction, 0, close);
    EXPECT_LT(a.p_value, 1e-3); // of what stands, not of the step
    const Problem base = by.base.problem();
    const Assessment same = Screen(base).assess(m.columns({a1()}), Eigen::VectorXd::Zero(1), false); // collinear with a0, which is free
    EXPECT_NEAR(same.gain, 0, 1e-6);                                                                 // but for the ridge that holds a0
    EXPECT_GT(same.p_value, 0.99);
    const Assessment none = Screen(base).assess(Eigen::MatrixXd::Zero(m.rows(), 1), Eigen::VectorXd::Zero(1), false);
    EXPECT_EQ(none.strength[0], 0);
    EXPECT_TRUE(std::isinf(none.standard_error[0]));
    EXPECT_EQ(none.p_value, 1);
    EXPECT_EQ(none.column_norm, 0);
    const Assessment of_two = Screen(base).assess(m.columns({a2(), a2()}), Eigen::VectorXd::Zero(2), false); // one thing twice
    EXPECT_TRUE(of_two.strength.allFinite());
}

TEST(Screen, profiles_the_baseline_out_of_any_residual) {
    LinearMachine m;
    const Fitted f(m, {a0(0.2), r0(0.05), g0()});
    const Problem problem = f.problem();
    Eigen::VectorXd moved = problem.residual, change;
    for (Eigen::Index r = 0; r < moved.size(); ++r) moved[r] += std::sin(0.01 * static_cast<double>(r * r));
    const double error = Screen(problem).profiled_error(moved, change);
    const Eigen::VectorXd y = moved + f.J * problem.theta, theta = ridge(f.J, y, Eigen::VectorXd::Ones(y.size()), f.precision);
    EXPECT_NEAR(error, (y - f.J * theta).squaredNorm() + f.penalty(theta), close * error);
    expect_close(change, theta - problem.theta, "change");
}

TEST(Screen, knows_when_a_step_takes_a_stated_number_off_its_limit_by_more_than_a_deviation) {
    LinearMachine m(24);
    const Fitted f(m, {a0(0.5), g0()});
    Problem problem = f.problem();
    const auto leaves = [&](double at, double by, double of_free = 0) {
        problem.theta[0] = at;
        return Screen(problem).leaves_active_set(Eigen::Vector2d(by, of_free));
    };
    EXPECT_TRUE(leaves(3, -0.51)); // six deviations is the limit
    EXPECT_FALSE(leaves(3, -0.49));
    EXPECT_FALSE(leaves(3, 0.51)); // further out
    EXPECT_TRUE(leaves(-3, 0.51));
    EXPECT_FALSE(leaves(2.9, -0.51));
    EXPECT_FALSE(leaves(0, 0, -1e12)); // of which nothing is stated
}

TEST(Screen, tells_the_largest_fall_of_a_balance) {
    LinearMachine m;
    m.hide(r1(), 0.5);
    const Assessed by(m, {a0(0.2), g0()}, {r1()});
    const Problem problem = by.base.problem();
    const Screen screen(problem);
    const Assessment a = screen.assess(by.columns(), Eigen::VectorXd::Zero(1), false);
    const Eigen::VectorXd before = problem.residual.segment(120, 120),
                          after = (by.joint.y - by.joint.J * by.joint.theta()).segment(120, 120);
    EXPECT_NEAR(screen.best_balance_fall(by.columns(), a), 1 - after.squaredNorm() / before.squaredNorm(), close);
    const std::vector<double> held = screen.heldout_by_balance(), noise = screen.heldout_by_balance(true);
    ASSERT_EQ(held.size(), 3U);
    EXPECT_NEAR(held[0] + held[1] + held[2], screen.block_error().sum(), close * screen.block_error().sum());
    const Eigen::VectorXd left = by.base.left_out(by.base.blocks(5));
    for (std::size_t b = 0; b < 3; ++b) {
        EXPECT_NEAR(held[b], left.segment(static_cast<Eigen::Index>(120 * b), 120).squaredNorm(), close * held[b]) << b;
        EXPECT_NEAR(noise[b], held[b], 1e-9 * held[b]); // rows count as the noise is
    }
    Problem halved = problem; // rows of half their weight: in noise as before
    halved.row_scale *= 0.5, halved.jacobian *= 0.5;
    for (FreeParameter &p : halved.parameters) p.prior *= p.prior > 0 ? 2 : 1;
    const Screen half(halved);
    EXPECT_NEAR(half.heldout_by_balance()[1], 0.25 * held[1], close * held[1]);
    EXPECT_NEAR(half.heldout_by_balance(true)[1], held[1], close * held[1]);
}

TEST(Errors, of_parameters_are_the_jackknifes_over_short_or_long_blocks_and_the_priors) {
    LinearMachine m(120, 1.5);
    const Assessed by(m, {a0(0.2), a2(), r0(0.05)}, {});
    const Problem problem = by.base.problem();
    const std::vector<ParameterError> errors = Screen(problem).parameter_errors();
    const Eigen::VectorXd theta = by.base.theta();
    Eigen::MatrixXd normal = by.base.J.transpose() * by.base.J;
    normal.diagonal() += by.base.precision;
    const Eigen::MatrixXd inverse = normal.inverse();
    ASSERT_EQ(errors.size(), 3U);
    for (Eigen::Index j = 0; j < 3; ++j) {
        double widest = 0, error = 0;
        for (const double length : {2.5, 5.0}) {
            const std::vector<std::size_t> block = by.base.blocks(length);
            const std::size_t count = *std::max_element(block.begin(), block.end()) + 1;
            double squares = 0, information = 0, of_squares = 0;
            for (std::size_t b = 0; b < count; ++b) {
                Eigen::VectorXd weight(by.base.y.size());
                for (Eigen::Index r = 0; r < weight.size(); ++r) weight[r] = block[static_cast<std::size_t>(r)] == b ? 0 : 1;
                squares += std::pow(by.base.theta(weight)[j] - theta[j], 2);
                const Eigen::VectorXd in = Eigen::VectorXd::Ones(weight.size()) - weight,
                                      score = by.base.J * inverse.col(j); // of each row in the estimate
                const double own = score.cwiseAbs2().dot(in);
                information += own, of_squares += own * own;
            }
            const double n = static_cast<double>(count), data = squares * (n - 1) / n;
            const double prior = inverse.row(j).cwiseAbs2().dot(by.base.precision); // (precision * deviation)^2 = precision
            const double all = std::max(data + prior, 0.25 * inverse(j, j)), share = (data + prior) / data;
            const double freedom = std::clamp((information * information / of_squares - 1) * share * share, 4.0, 1e3);
            const double half = t_quantile(0.05, freedom) * std::sqrt(all);
            if (half > widest) widest = half, error = std::sqrt(all);
        }
        EXPECT_NEAR(errors[static_cast<std::size_t>(j)].standard, error, 1e-4 * error) << j;
        EXPECT_NEAR(errors[static_cast<std::size_t>(j)].half_width, widest, 1e-3 * widest) << j;
    }
    const std::vector<ParameterError> of_sum = Screen(problem).errors_of(Eigen::RowVector3d(2, 0, 0));
    ASSERT_EQ(of_sum.size(), 1U);
    EXPECT_NEAR(of_sum[0].standard, 2 * errors[0].standard, 1e-9);
    EXPECT_NEAR(of_sum[0].half_width, 2 * errors[0].half_width, 1e-9);
}

// tolerance.h: the rival, by direct solutions of the same two regressions with a stated deviation three times as wide.
struct Rivalry {
    std::vector<FreeParameter> own, effect;
    LinearMachine machine;

    static void widen(std::vector<FreeParameter> &list, const std::vector<std::size_t> &group) {
        for (const std::size_t i : group) list[i].prior *= 3;
    }
    std::optional<ToleranceRival> found() const {
        Problem before = Fitted(machine, own).problem(), with(machine.data, machine.physics, Assessed::together(own, effect));
        with.keep_scales(before);
        with.gauss_newton(2);
        return tolerance_rival(before, with, effect.size());
    }
    // What the effect still explains beside the group, by held-out squares and priors; its error; the deviations that the group takes.
    void expect(const std::string &name, const std::vector<std::size_t> &group) const {
        std::vector<FreeParameter> wide = own;
        widen(wide, group);
        const Fitted alone(machine, wide), both(machine, Assessed::together(wide, effect));
        const Eigen::VectorXd fall = sums(alone.held_out().cwiseAbs2() - both.held_out().cwiseAbs2(), alone.blocks(5));
        const double lead = fall.sum() + alone.penalty(alone.theta()) - both.penalty(both.theta());
        double deviations = 0;
        for (const std::size_t i : group)
            deviations = std::max(deviations, std::fabs(alone.theta()[static_cast<Eigen::Index>(i)]) / own[i].prior);
        ASSERT_LT(deviations, 8.9); // within its bounds
        const std::optional<ToleranceRival> rival = found();
        ASSERT_TRUE(rival);
        EXPECT_EQ(rival->name, name);
        EXPECT_NEAR(rival->lead, lead, 1e-4 * (1 + std::fabs(lead)));
        EXPECT_NEAR(rival->error, sum_error(fall), 1e-4 * (1 + rival->error));
        EXPECT_NEAR(rival->deviations, deviations, 1e-4 * deviations);
    }
};

TEST(Rival, of_an_offset_is_a_stated_offset_that_is_wider_than_stated) {
    Rivalry r{{r0(0.05), a0(0.2), g0(0.1)}, {a1()}, LinearMachine()};
    r.machine.hide(a1(), 1.2); // six stated deviations
    r.expect("tolerance of sensors.accel.bias_m_s2", {1});
    EXPECT_TRUE(r.found()->explains_as_much());
    EXPECT_NEAR(r.found()->deviations, 6, 1);
}

TEST(Rival, of_a_drift_is_an_offset_that_leaves_most_of_it) {
    Rivalry r{{r0(0.05), a0(0.07), g0(0.1)}, {a2()}, LinearMachine(240)};
    r.machine.hide(a2(), 0.01); // from 0 to 1.2: its mean, 0.6, is nine deviations, and what varies about it 29 squares
    r.expect("tolerance of sensors.accel.bias_m_s2", {1});
    EXPECT_FALSE(r.found()->explains_as_much());
}

TEST(Rival, of_what_moves_two_numbers_of_the_soil_are_both_together) {
    FreeParameter yaw = g0(0.1), two = r1();
    yaw.owner = "soil";
    two.slots.push_back(yaw.slots[0]);
    Rivalry r{{r0(0.1), yaw, a0(0.2)}, {two}, LinearMachine()};
    r.machine.hide(two, 0.6);
    r.expect("tolerance of the soil", {0, 1});
    r.own[1].owner = "sensors"; // one number of the soil is no group
    EXPECT_NE(r.found()->name, "tolerance of the soil");
}

TEST(Rival, of_what_moves_all_wheels_is_what_every_wheel_has_of_its_own) {
    FreeParameter first = r0(0.1), second = g0(0.1), two = r1(), other = a0(0.2);
    for (FreeParameter *p : {&first, &second}) p->owner = "motor", p->key = "x", p->own = true;
    first.wheel = 0, second.wheel = 1;
    two.slots.push_back(second.slots[0]);
    Rivalry r{{other, first, second}, {two}, LinearMachine()};
    r.machine.hide(two, 0.6);
    r.expect("tolerance of motor.x on every wheel", {1, 2});
    Rivalry one{{other, first, second}, {r1()}, LinearMachine()};
    one.machine.hide(r1(), 0.6);
    one.expect("tolerance of motor.x on wheel 0", {1});
}

TEST(Rival, goes_no_farther_than_nine_stated_deviations_nor_than_a_natural_end) {
    Rivalry r{{r0(0.05), a0(0.2), g0(0.1)}, {a1()}, LinearMachine()};
    r.machine.hide(a1(), 3); // fifteen
    ASSERT_TRUE(r.found());
    EXPECT_NEAR(r.found()->deviations, 9, 1e-6);
    EXPECT_FALSE(r.found()->explains_as_much());
    r.own[1].maximum = 0.5;
    EXPECT_NEAR(r.found()->deviations, 2.5, 1e-6);
    Rivalry down{{r0(0.05), a0(0.2), g0(0.1)}, {a1()}, LinearMachine()};
    down.machine.hide(a1(), -3);
    EXPECT_NEAR(down.found()->deviations, 9, 1e-6);
    down.own[1].minimum = -0.5;
    EXPECT_NEAR(down.found()->deviations, 2.5, 1e-6);
}

TEST(Rival, is_none_where_no_stated_deviation_does_a_quarter_of_it_or_nothing_is_stated) {
    Rivalry other{{r0(0.05), a0(0.2)}, {g0()}, LinearMachine()};
    other.machine.hide(g0(), 1);
    EXPECT_FALSE(other.found());
    Rivalry free{{r0(), a0()}, {a2()}, LinearMachine()};
    free.machine.hide(a2(), 0.03);
    EXPECT_FALSE(free.found());
}

// A natural end that lies nearer than six deviations contradicts no sheet.
TEST(Sheet, is_broken_by_what_stands_at_six_deviations_and_did_not_before) {
    const LinearMachine m(24);
    FreeParameter ended = a0(0.1);
    ended.maximum = 0.4;
    Problem before(m.data, m.physics, {a0(0.1), r0(0.1), ended, g0()}), with = before;
    for (const auto &[first, third, count] : {std::tuple{0.6, 0.0, 1U}, std::tuple{-0.6, 0.0, 1U}, std::tuple{0.59, 0.0, 0U},
                                              std::tuple{0.0, 0.4, 0U}, std::tuple{0.0, 0.0, 0U}}) {
        with.theta << first, 0, third, 1e9;
        with.parameters[2].wheel = before.parameters[2].wheel = 3;
        EXPECT_EQ(newly_at_limits(before, with), count) << first << third;
    }
    with.theta << 0.6, -0.6, 0, 0;
    EXPECT_EQ(newly_at_limits(before, with), 2U);
    before.theta << -0.6, 0, 0, 0; // it was broken before, at whichever end
    EXPECT_EQ(newly_at_limits(before, with), 1U);
}

// Two squared deviations, or two of its standard errors.
TEST(Rival, explains_as_much_where_the_effect_leads_by_less_than_two_errors_or_four_squares) {
    const auto as_much = [](double lead, double error) { return ToleranceRival{"", 0, lead, error}.explains_as_much(); };
    EXPECT_TRUE(as_much(3.9, 0));
    EXPECT_FALSE(as_much(4.1, 0));
    EXPECT_TRUE(as_much(19.9, 10));
    EXPECT_FALSE(as_much(20.1, 10));
    EXPECT_TRUE(as_much(-100, 1));
}

} // namespace
} // namespace traction::lab
