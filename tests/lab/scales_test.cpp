// What the rows of a fit are worth beside what the model states: as many as were independent.
#include "host_tools/lab/fit/problem.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "tests/lab/generator/generator.h"

#include <gtest/gtest.h>

#include <algorithm>
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

std::vector<FreeParameter> sensors(const Case &one, const char *key) {
    std::vector<FreeParameter> all = free_parameters(one.model, make_physics(one.model)), out;
    for (FreeParameter &p : all)
        if (p.owner == "sensors" && p.key == key) out.push_back(std::move(p));
    return out;
}

// Of the accelerometer's bias, which does the same to every row, over some draws of the noise.
double alike_of(Case &one, double remembered) {
    constexpr unsigned draws = 8;
    double sum = 0;
    for (unsigned seed = 0; seed < draws; ++seed) {
        replace_measured(one, remembered, 1 + seed);
        Problem problem(one.data, make_physics(one.model), sensors(one, "accel.bias_m_s2"));
        problem.fit({.iterations = 1});
        sum += problem.parameters[0].alike;
    }
    return sum / draws;
}

// Of n rows in a block, with correlations a^k: (1 + a)/(1 - a) - 2 a (1 - a^n) / (n (1 - a)^2), the variance of their mean over that of
// independent ones.
double design_effect(double a, double n) { return (1 + a) / (1 - a) - 2 * a * (1 - std::pow(a, n)) / (n * (1 - a) * (1 - a)); }

TEST(Scales, rows_that_remember_count_as_the_independent_ones_that_they_are_worth) {
    Case one = drive();
    // eight draws of 48 blocks: known to sqrt(2/384), 7 %; three of these. White noise is never worth more rows than there are
    EXPECT_GE(alike_of(one, 0), 1);
    EXPECT_LT(alike_of(one, 0), 1.3);
    for (const double remembered : {0.3, 0.5})
        EXPECT_NEAR(alike_of(one, remembered) / design_effect(remembered, rows_of_block), 1, 0.3) << remembered;
    EXPECT_DOUBLE_EQ(alike_of(one, 0.95), 4); // 25: the limit
}

// A table's numbers of a soil stay as loosely stated as they were.
TEST(Scales, the_soils_numbers_count_once) {
    Case one = drive();
    replace_measured(one, 0.9, 1);
    Problem problem(one.data, make_physics(one.model), free_parameters(one.model, make_physics(one.model)));
    problem.fit({.iterations = 1});
    double most = 1;
    for (const FreeParameter &p : problem.parameters)
        if (p.owner == "soil")
            EXPECT_EQ(p.alike, 1) << p.key;
        else
            most = std::max(most, p.alike);
    EXPECT_EQ(most, 4);
}

// A number that is stated with deviation P and true is drawn from there by P^2 e / (P^2 + V), e the error of the rows' own estimate, of
// variance V: never by more than P/2 (rms), whatever V. Rows counted one by one drew it by 1.7 P here.
TEST(Scales, what_is_stated_and_true_is_left_by_half_a_stated_deviation_at_most) {
    Case one = drive();
    constexpr int draws = 24;
    double sum = 0;
    for (unsigned seed = 0; seed < draws; ++seed) {
        replace_measured(one, 0.9, 100 + seed);
        Problem problem(one.data, make_physics(one.model), sensors(one, "camera.scale"));
        problem.settle();
        sum += std::pow(problem.theta[0] / problem.parameters[0].prior, 2);
    }
    EXPECT_LT(std::sqrt(sum / draws), 0.5 * (1 + 3 / std::sqrt(2.0 * draws)));
}

} // namespace
} // namespace traction::lab
