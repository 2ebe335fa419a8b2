// The control goals in closed loop on the plant, ours beside the paper's own settings: slip servo (fig. 17) and speed with blocked
// wheels (fig. 16). The figures printed are those of docs/performance.md. Truth is the plant's.
#include "host_tools/simulate/simulate.h"

#include <cstdint>
#include <cstdio>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace traction;

namespace {

constexpr int seeds = 8;

// A signal of the truth, one row per tick, averaged over the seeds.
std::vector<double> mean_over_seeds(const std::string &scenario_name, const std::string &firmware, const std::string &signal) {
    const sim::Scenario scenario = sim::read_scenario("scenarios/" + scenario_name + ".toml");
    std::vector<double> sum;
    for (int seed = 1; seed <= seeds; seed++) {
        SimulateOptions options;
        options.seed = static_cast<std::uint64_t>(seed);
        options.firmware = firmware;
        options.truth = true;
        options.record = false;
        const auto result = simulate(scenario, options);
        const auto &value = result.truth.find(signal)->value;
        sum.resize(value.size());
        for (std::size_t k = 0; k < value.size(); k++) sum[k] += value[k] / seeds;
    }
    return sum;
}

double mean(const std::vector<double> &value, double from_s, double to_s) {
    double sum = 0;
    for (auto k = static_cast<std::size_t>(from_s * 100); k < static_cast<std::size_t>(to_s * 100); k++) sum += value[k];
    return sum / ((to_s - from_s) * 100);
}

// From `start_s` until the value stays within `band` of `target` (until end_s); a mean over 0.1 s of each side.
double settling_s(const std::vector<double> &value, double start_s, double end_s, double target, double band) {
    double last = start_s;
    for (double t = start_s + 0.1; t < end_s - 0.1; t += 0.01)
        if (std::fabs(mean(value, t - 0.1, t + 0.1) - target) > band) last = t;
    return last - start_s;
}

struct Slip {
    double mean, settling_s;
};

Slip slip_of(const std::string &soil, const std::string &firmware) {
    constexpr double start_s = 3; // of the servo in the scenarios
    const auto slip = mean_over_seeds("fig17_slip_servo_" + soil, firmware, "truth.wheel1.slip");
    return {mean(slip, 6, 15), settling_s(slip, start_s, 15, 0.4, 0.04)}; // a tenth of the set point
}

} // namespace

TEST(Goal, slip_is_held_at_0_4_on_every_soil_where_the_papers_settings_wander) {
    for (const auto &[soil, band] :
         {std::pair{std::string("concrete"), 0.02}, {std::string("gravel"), 0.04}, {std::string("sand"), 0.04}}) {
        const Slip ours = slip_of(soil, "default"), paper = slip_of(soil, "paper");
        std::printf("slip servo 0.4 on %-8s ours mean %.3f settling %.2f s | paper mean %.3f settling %.2f s\n", soil.c_str(), ours.mean,
                    ours.settling_s, paper.mean, paper.settling_s);
        EXPECT_NEAR(ours.mean, 0.4, band) << soil;           // the goal of issue 5
        EXPECT_GT(std::fabs(ours.mean - 0.4), 1e-5) << soil; // a noisy estimate cannot be perfect
        EXPECT_LT(ours.settling_s, 1.5) << soil;
        EXPECT_GT(ours.settling_s, 0.1) << soil; // nor instant: the wheel has inertia
        EXPECT_LT(ours.settling_s, paper.settling_s) << soil;
    }
}

TEST(Goal, a_blocked_wheel_costs_less_than_a_twentieth_of_the_speed) {
    const auto ours = mean_over_seeds("fig16_blocked_wheels", "default", "truth.speed_m_s");
    const auto paper = mean_over_seeds("fig16_blocked_wheels", "paper", "truth.speed_m_s");
    for (const auto &[from_s, to_s] : {std::pair{2.0, 5.0}, {5.5, 9.0}, {10.5, 15.0}}) {
        std::printf("0.2 m/s, %4.1f to %4.1f s: ours %.4f m/s, paper %.4f m/s\n", from_s, to_s, mean(ours, from_s, to_s),
                    mean(paper, from_s, to_s));
        EXPECT_NEAR(mean(ours, from_s, to_s), 0.2, 0.05 * 0.2) << from_s;
        EXPECT_GT(std::fabs(mean(ours, from_s, to_s) - 0.2), 1e-6) << from_s;
    }
    EXPECT_GT(std::fabs(mean(paper, 5.5, 9) - 0.2), std::fabs(mean(ours, 5.5, 9) - 0.2)); // (22) alone leaves an error
}

// NEES of slip: mean of (slip - truth)^2 / std^2 over valid ticks of all wheels, three seeds. Bounds: issue 13's for the speed under it, 2
// where it must know; below 0.2 the claim would be more than twice too wide. Truth takes the wheel's own ground speed.
TEST(Goal, slip_knows_how_well_it_is_known) {
    for (const char *name :
         {"fig17_slip_servo_concrete", "fig17_slip_servo_gravel", "fig17_slip_servo_sand", "cruise", "fig16_blocked_wheels"}) {
        double sum = 0, error2 = 0;
        std::size_t n = 0, all = 0;
        for (std::uint64_t seed = 1; seed <= 3; seed++) {
            SimulateOptions options;
            options.seed = seed;
            options.truth = true;
            const auto result = simulate(sim::read_scenario(std::string("scenarios/") + name + ".toml"), options);
            for (int i = 0; i < WHEEL_COUNT; i++) {
                const std::string wheel = "wheel" + std::to_string(i) + '.';
                const auto &slip = *result.log.find(wheel + "slip"), &std = *result.log.find(wheel + "slip_std"),
                           &valid = *result.log.find(wheel + "slip_valid"), &truth = *result.truth.find("truth." + wheel + "slip");
                for (std::size_t k = 300; k < slip.value.size(); k++, all++) {
                    const auto at = static_cast<std::size_t>(std::lower_bound(truth.t_s.begin(), truth.t_s.end(), slip.t_s[k] - 1e-6) -
                                                             truth.t_s.begin());
                    if (valid.value[k] == 0 || at >= truth.value.size()) continue;
                    const double e = slip.value[k] - truth.value[at];
                    sum += e * e / (std.value[k] * std.value[k]);
                    error2 += e * e;
                    n++;
                }
            }
        }
        const double nees = sum / static_cast<double>(n);
        std::printf("%-28s slip RMSE %.3f, NEES %.2f, valid %.0f %%\n", name, std::sqrt(error2 / static_cast<double>(n)), nees,
                    100.0 * static_cast<double>(n) / static_cast<double>(all));
        EXPECT_LE(nees, 2) << name;
        EXPECT_GE(nees, 0.2) << name;
    }
}
