// The fit of section V: exact on exact curves, unbiased in noise, and it does not take one law for the other.
#include "host_tools/reproduce/soil_fit.h"

#include "sim/sensors/random.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <cmath>

using namespace traction;

namespace {

struct Data {
    std::vector<double> slip, force_N;
};

Data sample(SoilCurve law, double fm_N, double sc, double noise_N, std::uint64_t seed) {
    sim::Random random(seed);
    Data data;
    for (int i = 0; i < 400; i++) {
        const double s = -1 + 1.4 * i / 399; // the sweep's slips
        const double x = std::fabs(s) / sc;
        const double f = law == SoilCurve::janosi ? (x > 0 ? 1 - (1 - std::exp(-x)) / x : 0) : 1 - std::exp(-x); // (20), (21)
        data.slip.push_back(s);
        data.force_N.push_back((s < 0 ? -f : f) * fm_N + noise_N * random.normal());
    }
    return data;
}

} // namespace

TEST(SoilFit, recovers_table_III_from_exact_curves) {
    for (const auto &[law, fm_N, sc] :
         {std::tuple{SoilCurve::janosi, 5.1, 0.27}, {SoilCurve::janosi, 6.8, 0.088}, {SoilCurve::burckhardt, 5.6, 0.05}}) {
        const Data data = sample(law, fm_N, sc, 0, 1);
        const SoilFit fit = fit_soil(law, data.slip, data.force_N);
        EXPECT_NEAR(fit.fm_N, fm_N, 1e-6 * fm_N); // golden section to 1e-12 of the range; the square root of rounding is 1e-8
        EXPECT_NEAR(fit.shear_slip, sc, 1e-5 * sc);
        EXPECT_LT(fit.rms_N, 1e-5);
    }
}

TEST(SoilFit, is_unbiased_in_force_noise) {
    double fm_N = 0, sc = 0;
    for (std::uint64_t seed = 1; seed <= 40; seed++) {
        const Data data = sample(SoilCurve::janosi, 5.1, 0.27, 0.5, seed);
        const SoilFit fit = fit_soil(SoilCurve::janosi, data.slip, data.force_N);
        fm_N += fit.fm_N / 40;
        sc += fit.shear_slip / 40;
    }
    // 400 values of 0.5 N leave some 0.08 N of Fm and 4 % of sc a run (correlated by 0.9); 40 runs a sixth of it; three of those
    EXPECT_NEAR(fm_N, 5.1, 0.04);
    EXPECT_NEAR(sc, 0.27, 0.27 * 0.02);
}

TEST(SoilFit, the_wrong_law_leaves_a_larger_residual) {
    const Data data = sample(SoilCurve::burckhardt, 5.6, 0.1, 0, 3);
    EXPECT_LT(fit_soil(SoilCurve::burckhardt, data.slip, data.force_N).rms_N, 1e-5);
    EXPECT_GT(fit_soil(SoilCurve::janosi, data.slip, data.force_N).rms_N,
              0.05); // (20) rises linearly where (21) has bent: 1 % of Fm or more
}

TEST(SoilFit, nothing_gives_nothing) { EXPECT_EQ(fit_soil(SoilCurve::janosi, {}, {}).count, 0u); }
