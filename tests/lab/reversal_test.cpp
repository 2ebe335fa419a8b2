// Rows in which a wheel rolls so slowly that nobody knows its rolling resistance weigh as little as is known of them.
#include "host_tools/lab/fit/problem.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/forward/reversal.h"
#include "host_tools/lab/model/model.h"
#include "tests/lab/generator/generator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace traction::lab {
namespace {

generator::GeneratorConfig creeping() {
    generator::GeneratorConfig config;
    config.soil = generator::Soil::loam;
    config.seed = 850015;
    config.duration_s = 150;
    config.apart = true;
    config.drive = "slow";
    return config;
}

// The generator's resistance reverses by another law than the lab's and over another speed, as any machine's would: six stated deviations
// off, its limit, and all that goes with it.
TEST(Reversal, a_rover_that_creeps_keeps_to_its_sheet) {
    const generator::GeneratorConfig config = creeping();
    const Model model = parse_model(generator::data_sheet(config), "sheet");
    const Dataset data = make_dataset(model, generator::generate(config));
    const Physics physics = make_physics(model);
    Problem problem(data, physics, free_parameters(model, physics));
    problem.fit({});
    for (std::size_t i = 0; i < problem.parameters.size(); ++i)
        if (problem.parameters[i].key == "rolling_coefficient")
            EXPECT_LT(std::fabs(problem.theta[static_cast<Eigen::Index>(i)]), 3 * problem.parameters[i].prior);
}

double largest_factor(const Dataset &data, BalanceKind kind) {
    double most = 0;
    for (const Balance &b : data.balance)
        if (b.kind == kind)
            for (const double factor : b.noise_factor) most = std::max(most, factor);
    return most;
}

TEST(Reversal, widens_torque_rows_where_wheels_creep_and_nothing_else) {
    const generator::GeneratorConfig config = creeping();
    Model model = parse_model(generator::data_sheet(config), "sheet");
    Dataset data = make_dataset(model, generator::generate(config));
    for (Balance &b : data.balance) b.noise_factor.assign(b.measured.size(), 1);
    Dataset smooth = data;
    add_reversal(model, data);
    EXPECT_GT(largest_factor(data, BalanceKind::current_torque), 1.3); // 0.12 A of resistance, 6 % of it, beside 0.0067 A
    for (const BalanceKind kind : {BalanceKind::current_voltage, BalanceKind::accel, BalanceKind::radar, BalanceKind::camera_x})
        EXPECT_LE(largest_factor(data, kind), 1) << static_cast<int>(kind);
    for (auto &wheel : model.wheel) wheel.soil.at("rolling_coefficient").value = 0;
    add_reversal(model, smooth);
    EXPECT_EQ(largest_factor(smooth, BalanceKind::current_torque), 1) << "ground that does not resist";
}

} // namespace
} // namespace traction::lab
