// The wheels of one step against closed forms: slip that lags, loads of a chassis in two halves, a body that slides sideways.
#include "host_tools/lab/forward/forward.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/forward/wheel_step.h"
#include "host_tools/simulate/simulate.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <limits>

#include <bit>
#include <cstdint>
#include <random>

namespace traction::lab {
namespace {

constexpr double speed_m_s = 0.4, radius_m = 0.057;

// The rover followed sideways, its chassis in two halves.
Model sliding(const std::string &soil) {
    Model model = read_model("models/rover_" + soil + ".toml");
    model.motion = BodyMotion::planar;
    model.halves = true;
    return model;
}

// All wheels roll at speed_m_s, the body turns at yaw_rad_s.
Dataset rolling(double yaw_rad_s, std::size_t count) {
    Dataset data;
    data.step_s = 0.02;
    data.count = count;
    data.wheel.resize(4);
    for (WheelInput &w : data.wheel)
        w.speed_rad_s.assign(count, speed_m_s / radius_m), w.accel_rad_s2.assign(count, 0), w.angle_rad.assign(count, 0);
    data.yaw_rate_rad_s.assign(count, yaw_rad_s);
    data.gyro = true;
    return data;
}

// (4), (5) and (7) of wheel_laws.h: with b of second order, from the third step on, s' = s_1 + (b/3)(s_1 - s_2) and h = (1 - b/3) step over
// length. At a steady speed it comes as 1 - exp(-way/length), and at rest it goes.
TEST(WheelStep, slip_across_comes_over_the_relaxation_length_and_goes_at_rest) {
    constexpr double relaxation_m = 0.1, aside_m_s = 0.02, rest_m_s = 0.015;
    Dataset data = rolling(0, 240);
    const std::size_t stops = 40;
    for (WheelInput &w : data.wheel) std::fill(w.speed_rad_s.begin() + static_cast<std::ptrdiff_t>(stops), w.speed_rad_s.end(), 0.0);
    Physics physics = make_physics(sliding("gravel"));
    for (WheelPhysics &w : physics.wheel) w.relaxation = relaxation_m, w.radius = radius_m, w.lateral = 0;
    WheelStep step(data, physics);
    const double x = 9.81 * physics.wheel[0].mu / physics.wheel[0].sc * 0.5 * data.step_s * data.step_s / relaxation_m; // (20)
    const double b = 1 / (1 + x * x);
    double side = 0, last = 0;
    for (std::size_t k = 0; k < data.count; ++k) {
        const bool rolls = k < stops;
        const double v = rolls ? speed_m_s : 0, aside = rolls ? aside_m_s : 0;
        step.prepare(k, v, 0, 0, 0);
        step.forces({v, aside, 0}, nullptr);
        const double g = v + rest_m_s / (1 + std::pow(v / rest_m_s, 4)); // m + r r^4 / (m^4 + r^4)
        const double share = k < 2 ? 1 : 1 - b / 3, per_m = share * data.step_s / relaxation_m,
                     memory = k < 2 ? side : side + b / 3 * (side - last);
        last = std::exchange(side, (memory - per_m * aside) / (1 + per_m * g));
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(step.state(i).side_slip, side, 1e-12) << k; // rounding
        step.commit();
        if (k + 1 != stops) continue;
        const double all = aside_m_s / speed_m_s, way = static_cast<double>(stops) * data.step_s * speed_m_s; // of four lengths
        EXPECT_NEAR(side, -all * (1 - std::exp(-way / relaxation_m)), 0.005 * all);                           // second order in 0.08
        EXPECT_NEAR(side, -all, 0.1 * all);
    }
    EXPECT_NEAR(side, -aside_m_s / speed_m_s * std::exp(-0.6), 0.1 * aside_m_s / speed_m_s); // 4 s at r over the length: 0.15 / s
}

// (6) of wheel_laws.h by hand: stiffness and strength stay the law's, and between them the curve bends; by each wheel and by four at once.
TEST(WheelStep, the_knee_of_a_grounds_curve_bends_and_its_ends_do_not) {
    for (const SoilLaw soil : {SoilLaw::janosi, SoilLaw::burckhardt})
        for (const double curve : {-0.4, 0.0, 0.3}) {
            const auto share = [&](double x) { // of the strength
                return grip_of<double>(soil, 1.0, 0.2, curve, 0.2 * x, 0.0, 0.0, false).traction;
            };
            const auto law = [&](double x) { return soil == SoilLaw::burckhardt ? 1 - std::exp(-x) : 1 - (1 - std::exp(-x)) / x; };
            for (const double x : {0.05, 0.5, 1.0, 2.0, 4.0})
                EXPECT_NEAR(share(x), law(x) * (1 + curve * x * x * std::exp(-x)), 1e-12) << x;
            EXPECT_NEAR(share(0.01) / law(0.01), 1, 1e-4);
            EXPECT_NEAR(share(20) / law(20), 1, 1e-6);
            EXPECT_GT(share(0.5), share(0.25)) << "a pull that grows with slip";
        }
    Dataset data = rolling(0, 3);
    for (WheelInput &w : data.wheel) std::fill(w.speed_rad_s.begin(), w.speed_rad_s.end(), 1.3 * speed_m_s / radius_m);
    Model model = sliding("sand");
    model.motion = BodyMotion::longitudinal;
    Physics plain = make_physics(model);
    for (WheelPhysics &w : plain.wheel) w.relaxation = 0;
    Physics bent = plain;
    for (WheelPhysics &w : bent.wheel) w.curve = 0.4;
    const auto pulls = [&](const Physics &physics, bool at_once) {
        WheelStep step(data, physics);
        step.prepare(1, speed_m_s, 0, 0, 0);
        if (at_once) step.forces({speed_m_s, 0, 0}, nullptr);
        std::vector<double> out;
        for (std::size_t i = 0; i < 4; ++i) {
            if (!at_once) step.force(i, {speed_m_s, 0, 0});
            out.push_back(step.state(i).traction);
        }
        return out;
    };
    for (const bool at_once : {false, true}) {
        const std::vector<double> a = pulls(plain, at_once), b = pulls(bent, at_once);
        for (std::size_t i = 0; i < 4; ++i) {
            const WheelPhysics &w = plain.wheel[i];
            const double rim = rolling_radius(w) * 1.3 * speed_m_s / radius_m, x = (rim - speed_m_s) / rim / w.sc;
            EXPECT_NEAR(b[i] / a[i], 1 + 0.4 * x * x * std::exp(-x), 1e-9) << i << at_once;
        }
    }
}

// Grounds that are of neither law, over four of their own slips: with (6) and a stiffness and strength of its own each law meets them
// within a hundredth of the strength; without, (20) is three off from tanh.
TEST(WheelStep, a_bent_law_meets_other_grounds) {
    const auto tanh = [](double x) { return std::tanh(x); };
    const auto hyperbola = [](double x) { return x / (1 + x); };
    const auto magic = [](double x) { return std::sin(1.25 * std::atan(x / 1.25)); };
    struct Case {
        SoilLaw law;
        double (*ground)(double);
        double strength, slip, curve;
    };
    const auto miss = [](const Case &c, double strength, double slip, double curve) {
        double sum = 0;
        for (int i = 0; i < 80; ++i) {
            const double x = 4 * (i + 0.5) / 80;
            sum += std::pow(grip_of<double>(c.law, strength, slip, curve, x, 0.0, 0.0, false).traction - c.ground(x), 2);
        }
        return std::sqrt(sum / 80);
    };
    for (const Case &c : {Case{SoilLaw::burckhardt, tanh, 0.967, 0.787, 0.174},
                          {SoilLaw::burckhardt, hyperbola, 0.873, 1.010, -0.215},
                          {SoilLaw::burckhardt, magic, 0.977, 0.805, 0.138},
                          {SoilLaw::janosi, tanh, 1.153, 0.537, 0.394},
                          {SoilLaw::janosi, hyperbola, 0.898, 0.470, -0.105},
                          {SoilLaw::janosi, magic, 1.159, 0.537, 0.340}})
        EXPECT_LT(miss(c, c.strength, c.slip, c.curve), 0.01) << c.curve;
    EXPECT_NEAR(miss({SoilLaw::janosi, tanh, 0, 0, 0}, 1.154, 0.385, 0), 0.03, 0.005);
}

// Of a mass to one side the wheels there carry more and, at the same slip, pull more: just as much as turns nothing about that mass.
TEST(WheelStep, a_mass_to_one_side_is_not_turned_by_wheels_that_slip_alike) {
    Dataset data = rolling(0, 3);
    for (WheelInput &w : data.wheel) std::fill(w.speed_rad_s.begin(), w.speed_rad_s.end(), 1.2 * speed_m_s / radius_m);
    Model model = sliding("sand");
    model.motion = BodyMotion::longitudinal;
    Physics physics = make_physics(model);
    physics.body.offset_y_m = 0.03;
    for (WheelPhysics &w : physics.wheel) w.relaxation = 0, w.adhesion = 0; // all of the pull goes by the load
    WheelStep step(data, physics);
    step.prepare(1, speed_m_s, 0, 0, 0);
    std::array<Eigen::Vector3d, most_wheels> each;
    const Eigen::Vector3d at_once = step.forces({speed_m_s, 0, 0}, &each);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < 4; ++i) sum += step.force(i, {speed_m_s, 0, 0});
    EXPECT_GT(at_once[0], 1);
    EXPECT_NEAR(at_once[2], 0, 1e-12 * at_once[0]);
    EXPECT_NEAR(sum[2], 0, 1e-12 * at_once[0]);
    EXPECT_GT(step.state(0).load, 1.3 * step.state(1).load) << "0 and 2 are to the left";
}

TEST(Lane, exp_is_the_exponential_and_ends_where_a_double_would) {
    std::mt19937_64 random(20261125);
    std::uniform_real_distribution<double> any(-700, 700), small(-2, 2);
    for (int i = 0; i < 20000; ++i) {
        const double x[4] = {any(random), small(random), -std::fabs(small(random)) * 1e-6, i == 0 ? 0.0 : any(random)};
        const Lane y = exp(Lane(x[0], x[1], x[2], x[3]));
        for (std::size_t j = 0; j < 4; ++j)
            EXPECT_NEAR(y[j] / std::exp(x[j]), 1, 4.5e-16) << x[j]; // two units of the last place, of 2.2e-16 at most
    }
    const Lane ends = exp(Lane(-1e5, -708, 709, -std::numeric_limits<double>::infinity()));
    for (const std::size_t j : {0, 1, 3}) EXPECT_TRUE(ends[j] > 0 && ends[j] < 1e-307) << ends[j]; // nothing beside one
    EXPECT_TRUE(std::isfinite(ends[2]));
    EXPECT_TRUE(std::isnan(larger_of(Lane(std::nan("")), Lane(0.0))[0])); // what is no number stays none
}

// Every law that acts where four wheels go side by side, on either body motion, at rest, sliding, forward and backward.
TEST(WheelStep, wide_vectors_give_the_same_bits_and_one_wheel_after_the_other_the_same_forces) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> any(-1, 1);
    Dataset data = rolling(0.3, 3);
    for (const BodyMotion motion : {BodyMotion::longitudinal, BodyMotion::planar})
        for (const bool effects : {false, true}) {
            Model model = sliding("sand");
            model.motion = motion;
            Physics physics = make_physics(model);
            if (effects) {
                physics.body.slip_sinkage = 0.1, physics.body.speed_resistance_s_m = 0.1, physics.body.squared_resistance_s2_m2 = 0.1;
                physics.body.sliding_loss_s_m = 0.3, physics.body.shear_peak = 0.4, physics.body.relaxation_m = 0.05;
                physics.body.multi_pass = 0.2, physics.body.heavy_resistance = 0.1, physics.body.heavy_length_m = 5,
                physics.body.scrub = 0.2;
            }
            WheelStep narrow(data, physics), wide(data, physics);
            EXPECT_FALSE(narrow.widen(false));
            if (!wide.widen(true)) GTEST_SKIP() << "this processor has no wide vectors";
            for (int i = 0; i < 500; ++i) {
                for (WheelInput &w : data.wheel) w.speed_rad_s[1] = i % 7 == 0 ? 0 : 10 * any(random);
                const Eigen::Vector3d q(i % 5 == 0 ? 0 : any(random), motion == BodyMotion::planar ? 0.1 * any(random) : 0, any(random));
                std::array<Eigen::Vector3d, most_wheels> of_narrow, of_wide;
                for (WheelStep *step : {&narrow, &wide}) step->prepare(1, q[0], 0.5 * q[2], 1.0, 1.0);
                const Eigen::Vector3d a = narrow.forces(q, &of_narrow), b = wide.forces(q, &of_wide);
                for (Eigen::Index c = 0; c < 3; ++c) EXPECT_EQ(std::bit_cast<std::uint64_t>(a[c]), std::bit_cast<std::uint64_t>(b[c]));
                Eigen::Vector3d sum = Eigen::Vector3d::Zero();
                for (std::size_t w = 0; w < 4; ++w) {
                    EXPECT_EQ(of_narrow[w], of_wide[w]);
                    EXPECT_EQ(narrow.state(w).slip, wide.state(w).slip);
                    sum += narrow.force(w, q);
                }
                EXPECT_LT((sum - a).cwiseAbs().maxCoeff(), 1e-11); // tens of newtons, rounded in another order
                for (WheelStep *step : {&narrow, &wide}) step->commit();
            }
        }
}

TEST(WheelStep, in_a_turn_the_outer_wheels_carry_what_the_height_of_the_mass_asks) {
    const double yaw_rad_s = 0.8;
    const Dataset data = rolling(yaw_rad_s, 3);
    Physics physics = make_physics(sliding("gravel"));
    physics.body.raised_m = 0.1;
    WheelStep step(data, physics);
    step.prepare(1, speed_m_s, 0, 0, 0);
    step.forces({speed_m_s, 0, yaw_rad_s}, nullptr); // to the left: the right wheels are outside
    const BodyPhysics &b = physics.body;
    const double outer = b.mass * speed_m_s * yaw_rad_s * 0.1 / (4 * 0.12),
                 rest = b.mass * b.gravity / 4; // moments about the track's middle
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(step.state(i).load, rest + (i % 2 == 1 ? outer : -outer), 1e-9);
}

TEST(WheelStep, each_half_of_the_chassis_is_tipped_by_its_own_pull) {
    const Dataset data = rolling(0, 3);
    Physics physics = make_physics(sliding("gravel"));
    physics.body.raised_m = 0.1;
    for (const bool halves : {false, true}) {
        physics.halves = halves;
        WheelStep step(data, physics);
        step.remember_twist(3); // N: the left wheels pull 3 N, the right ones -3 N
        step.prepare(1, speed_m_s, 0, 0, 0);
        step.forces({speed_m_s, 0, 0}, nullptr);
        const double shift = halves ? 3 * 0.1 / (2 * 0.083) : 0; // moments about the joint; rigid: the two cancel
        const double rest = physics.body.mass * physics.body.gravity / 4,
                     sign[4] = {1, -1, -1, 1}; // rear left, rear right, front left, front right
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(step.state(i).load, rest + sign[i] * shift, 1e-9);
        step.commit();
        if (!halves) continue;
        EXPECT_NEAR(step.twist(), 0, 1e-9); // both sides pull alike now
    }
}

// What a row of the gyro is compared with must not hold the row's own noise: else every law that loosens the ground predicts the gyro
// better, for its noise comes through.
TEST(Forward, the_gyro_draws_the_yaw_rate_by_what_is_past_alone) {
    Dataset data = rolling(0.1, 60);
    data.yaw_late = 5;
    const Physics physics = make_physics(sliding("sand"));
    Motion plain, moved;
    integrate(data, physics, plain, nullptr, false);
    data.yaw_rate_rad_s[20] += 1;
    integrate(data, physics, moved, nullptr, false);
    for (std::size_t k = 0; k < 25; ++k) EXPECT_EQ(moved.yaw_rate_rad_s[k], plain.yaw_rate_rad_s[k]) << k;
    EXPECT_GT(moved.yaw_rate_rad_s[25], plain.yaw_rate_rad_s[25]);
    const double by_ground = moved.yaw_rate_rad_s[25] - plain.yaw_rate_rad_s[25];
    EXPECT_LE(by_ground, 4 * 2.0 / 3 * data.step_s); // 4 rad/s^2 by the pull of one rad/s, (1) of motion.h; the ground holds against it
}

// The ODE plant on even ground, by a baseline that knows its numbers: what the sensors read is predicted to their noise.
TEST(Forward, turns_of_the_plant_on_even_ground_are_predicted_to_the_gyros_noise) {
    const sim::Scenario scenario = sim::parse_scenario(
        "title = \"turns\"\nduration_s = 20\n[ground]\nsoil = \"concrete\"\ngrip_noise = 0\n[[drive]]\nfor_s = 3\nmode = "
        "\"platform_speed\"\nspeed_m_s = 0.3\n"
        "[[drive]]\nfor_s = 9\nmode = \"platform_speed\"\nspeed_m_s = 0.4\nyaw_rate_rad_s = { amplitude = 0.6, period_s = 3.0 }\n"
        "[[drive]]\nfor_s = 8\nmode = \"platform_speed\"\nspeed_m_s = 0.3\nyaw_rate_rad_s = 0.8\n",
        "turns");
    Model model = sliding("concrete");
    for (WheelSpec &w : model.wheel) w.soil.at("lateral_grip").value = 1; // as the plant's concrete has it
    const Dataset data = make_dataset(model, simulate(scenario, {}).log);
    const Eigen::VectorXd predicted = Forward(data).predict(make_physics(model));
    Eigen::Index row = 0;
    for (const Balance &b : data.balance) {
        double e = 0;
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) e += std::pow((b.measured[r] - predicted[row]) / b.noise, 2);
        if (b.kind != BalanceKind::yaw_rate) continue;
        // 1 is the noise itself; the gyro holds the model over 0.3 s, what is left of the sideways motion's start may double its variance
        EXPECT_LT(std::sqrt(e / static_cast<double>(b.measured.size())), 1.4);
    }
}

} // namespace
} // namespace traction::lab
