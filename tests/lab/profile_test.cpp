// Profile likelihood where the answer is known: a parabola, a ridge, a bound, a changed coordinate.
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/result/profile_result.h"
#include "tests/lab/generator/generator.h"

#include <cstdint>
#include <gtest/gtest.h>
#include <limits>

#include <algorithm>
#include <cmath>

namespace traction::lab {
namespace {

Model sand() { return read_model("models/rover_sand.toml"); }

Dataset data_with(const std::string &effect, std::uint64_t seed, double duration_s) {
    generator::GeneratorConfig config;
    config.soil = generator::Soil::sand;
    config.seed = seed;
    config.duration_s = duration_s;
    if (!effect.empty()) config.hidden.push_back(generator::parse_setting(effect));
    return make_dataset(sand(), generator::generate(config));
}

EffectUse own(const std::string &name, const std::string &expression, double value, double low, double high) {
    EffectUse use;
    use.name = name;
    use.acts_on = "wheel_torque";
    use.expression = expression;
    Parameter k;
    k.value = value;
    k.minimum = low;
    k.maximum = high;
    use.parameters["k"] = k;
    return use;
}

constexpr double infinity = std::numeric_limits<double>::infinity();

void expect_whole(const Profile &p) {
    EXPECT_TRUE(std::is_sorted(p.x.begin(), p.x.end()));
    EXPECT_EQ(p.x.size(), p.rise.size());
    for (const double r : p.rise) EXPECT_GE(r, 0);
    EXPECT_LE(p.low, p.value);
    EXPECT_GE(p.high, p.value);
}

TEST(Profile, of_a_linear_parameter_is_the_robust_wald_interval) {
    Model model = sand();
    model.effects.push_back(own("grease", "k*w", 1e-3, -infinity, infinity));
    const Profile p = profile_likelihood(model, data_with("viscous_friction:coefficient_Nms=0.004", 3, 24), {}).at(0);
    expect_whole(p);
    EXPECT_EQ(p.parameter, "grease.k");
    EXPECT_EQ(p.verdict, "identifiable");
    // k enters the torque linearly; what bends is only how the others give way: 5 % of the half width
    EXPECT_NEAR(p.low, p.wald_low, 0.05 * 1.96 * p.standard_error);
    EXPECT_NEAR(p.high, p.wald_high, 0.05 * 1.96 * p.standard_error);
}

TEST(Profile, does_not_depend_on_the_coordinate) {
    const Dataset data = data_with("viscous_friction:coefficient_Nms=0.004", 3, 24);
    Model plain = sand(), logarithmic = sand();
    plain.effects.push_back(own("grease", "k*w", 1e-3, -infinity, infinity));
    logarithmic.effects.push_back(own("grease", "exp(k)*w", std::log(1e-3), -infinity, infinity));
    const Profile a = profile_likelihood(plain, data, {"grease.k"}).at(0), b = profile_likelihood(logarithmic, data, {"grease"}).at(0);
    const double half = 0.5 * (a.high - a.low);
    EXPECT_NEAR(std::exp(b.value), a.value,
                0.05 * half); // ends are found to 1 % of their root; phi (1 %) and row scales come from two fits
    EXPECT_NEAR(std::exp(b.low), a.low, 0.05 * half);
    EXPECT_NEAR(std::exp(b.high), a.high, 0.05 * half);
}

TEST(Profile, a_bent_coordinate_is_flagged_where_the_wald_interval_cannot_know) {
    Model model = sand();
    model.effects.push_back(own("grease", "exp(12*k)*2e-4*w", 0.1, -2, 2)); // e^12k: half its size and twice are not equally far
    const Profile p = profile_likelihood(model, data_with("viscous_friction:coefficient_Nms=0.0006", 4, 8), {}).at(0);
    expect_whole(p);
    EXPECT_NE(p.verdict, "identifiable") << profile_text({p});
    EXPECT_GT(p.value - p.low, 1.5 * (p.high - p.value)) << profile_text({p});
}

TEST(Profile, two_parallel_parameters_are_not_identifiable_and_their_bounds_make_them_so) {
    const Dataset data = data_with("viscous_friction:coefficient_Nms=0.004", 5, 16);
    Model ridge = sand();
    ridge.effects = {own("grease", "k*w", 2e-3, -infinity, infinity), own("oil", "k*w", 2e-3, -infinity, infinity)};
    for (const Profile &p : profile_likelihood(ridge, data, {})) {
        EXPECT_EQ(p.verdict, "not_identifiable") << profile_text({p});
        EXPECT_TRUE(p.low_open && p.high_open);
        EXPECT_LT(*std::max_element(p.rise.begin(), p.rise.end()), 0.1) << p.parameter; // exactly parallel: the other takes it all
    }
    Model bounded = sand();
    bounded.effects = {own("grease", "k*w", 2e-3, 0, 0.1), own("oil", "k*w", 2e-3, 0, 0.1)};
    for (const Profile &p : profile_likelihood(bounded, data, {})) {
        EXPECT_TRUE(p.low_at_bound) << profile_text({p}); // it may be nothing, then the other is all
        EXPECT_FALSE(p.high_open || p.high_at_bound) << profile_text({p});
        EXPECT_LT(p.high, 0.008); // but not twice the sum that is there
        EXPECT_GT(p.high, 0.003);
    }
}

TEST(Profile, at_its_bound_is_said) {
    Model model = sand();
    EffectUse drag;
    drag.name = "body_drag";
    Parameter force;
    force.value = 0.1;
    force.minimum = 0;
    force.maximum = 5;
    force.unit = "N";
    drag.parameters["force_N"] = force;
    model.effects = {drag};
    const Profile p = profile_likelihood(model, data_with("", 6, 24), {}).at(0);
    expect_whole(p);
    EXPECT_EQ(p.verdict, "at_bound") << profile_text({p});
    EXPECT_TRUE(p.low_at_bound);
    EXPECT_EQ(p.low, 0);
    EXPECT_LT(p.high, 1);
}

TEST(Profile, names_what_can_be_profiled_when_asked_for_something_else) {
    const Dataset data = data_with("", 7, 12);
    for (const auto &wanted : {std::vector<std::string>{"gremlin"}, std::vector<std::string>{}}) {
        try {
            profile_likelihood(sand(), data, wanted);
            FAIL();
        } catch (const ModelError &error) {
            EXPECT_NE(std::string(error.what()).find("motor.resistance_ohm"), std::string::npos) << error.what();
        }
    }
    const Profile p = profile_likelihood(sand(), data, {"motor.resistance_ohm"}).at(0);
    const nlohmann::json json = profile_json({p});
    EXPECT_EQ(json[0]["parameter"], "motor.resistance_ohm");
    EXPECT_EQ(json[0]["x"].size(), json[0]["rise"].size());
    EXPECT_THROW(profile_likelihood(sand(), make_dataset(sand(), log::Log{}), {}), ModelError);
}

} // namespace
} // namespace traction::lab
