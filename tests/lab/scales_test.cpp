// What the rows weigh in a fit: as the independent ones that they are worth, against what the model states.
#include "host_tools/lab/fit/problem.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "tests/lab/generator/generator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace traction::lab {
namespace {

constexpr double duration_s = 120, rows_of_block = 50; // of 2.5 s, rows of 50 ms

struct Case {
    Model model;
    Dataset data;
};

Case drive() {
    generator::GeneratorConfig config;
    config.soil = generator::Soil::concrete;
    config.seed = 31;
    config.duration_s = duration_s;
    Case one;
    one.model = parse_model(generator::data_sheet(config), "sheet");
    one.data = make_dataset(one.model, generator::generate(config));
    return one;
}

// Every row of every balance as the model has it, off by three noises: white, or a first-order autoregression of the same variance.
void replace_measured(Case &one, double remembered, unsigned seed) {
    const Eigen::VectorXd predicted = Forward(one.data).predict(make_physics(one.model));
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Eigen::Index row = 0;
    for (Balance &b : one.data.balance) {
        b.noise_factor.assign(b.measured.size(), 1), b.smoothing_bias.clear();
        double e = normal(random);
        for (double &measured : b.measured) {
            measured = predicted[row++] + 3 * b.noise * e;
            e = remembered * e + std::sqrt(1 - remembered * remembered) * normal(random);
        }
    }
}

std::vector<FreeParameter> camera_scale(const Case &one) {
    std::vector<FreeParameter> all = free_parameters(one.model, make_physics(one.model)), out;
    for (FreeParameter &p : all)
        if (p.owner == "sensors" && p.key == "camera.scale") out.push_back(std::move(p));
    return out;
}

// Mean over the motors' balances of the weight of a row, in 1 / (3 noises)^2.
double weight_of(Case &one, double remembered, unsigned seed) {
    replace_measured(one, remembered, seed);
    Problem problem(one.data, make_physics(one.model), camera_scale(one));
    problem.fit({.iterations = 1});
    double sum = 0, rows = 0;
    Eigen::Index row = 0;
    for (const Balance &b : one.data.balance)
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row)
            if (b.kind == BalanceKind::current_voltage) sum += std::pow(3 * b.noise * problem.row_scale[row], 2), rows += 1;
    return sum / rows;
}

// Of n rows in a block, with correlations a^k: (1 + a)/(1 - a) - 2 a (1 - a^n) / (n (1 - a)^2), the variance of their mean over that of
// independent ones.
double design_effect(double a, double n) { return (1 + a) / (1 - a) - 2 * a * (1 - std::pow(a, n)) / (n * (1 - a) * (1 - a)); }

TEST(Scales, rows_that_remember_weigh_as_the_independent_ones_that_they_are_worth) {
    Case one = drive();
    const double white = weight_of(one, 0, 1);
    EXPECT_GT(white, 0.7); // some blocks of white noise agree by chance: a few per cent, never more weight than one
    EXPECT_LE(white, 1.1);
    for (const double remembered : {0.5, 0.9}) {
        const double expected = white / design_effect(remembered, rows_of_block);
        // four balances of 48 blocks: the variance of a sum over blocks is known to sqrt(2/192), a tenth; three of these, and a little for
        // the scale of a series that remembers
        EXPECT_NEAR(weight_of(one, remembered, 2) / expected, 1, 0.35) << remembered;
    }
}

// A number that is stated with deviation P and true is drawn from there by P^2 e / (P^2 + V), e the error of the rows' own estimate, of
// variance V: never by more than P/2 (rms), whatever V. Rows counted one by one drew it by 1.7 P here.
TEST(Scales, what_is_stated_and_true_is_left_by_half_a_stated_deviation_at_most) {
    Case one = drive();
    constexpr int draws = 24;
    double sum = 0;
    for (unsigned seed = 0; seed < draws; ++seed) {
        replace_measured(one, 0.9, 100 + seed);
        Problem problem(one.data, make_physics(one.model), camera_scale(one));
        problem.settle();
        sum += std::pow(problem.theta[0] / problem.parameters[0].prior, 2);
    }
    EXPECT_LT(std::sqrt(sum / draws), 0.5 * (1 + 3 / std::sqrt(2.0 * draws)));
}

} // namespace
} // namespace traction::lab
