// Whole diagnoses of a rover of one wheel that drives on soft ground: what is hidden moves the body, and is found by fits that are not
// linear.
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/fit/heldout.h"
#include "host_tools/lab/fit/ladder.h"
#include "sim/physics/effects/catalogue.h"
#include "tests/lab/consistent.h"
#include "tests/lab/hand_made.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace traction::lab {
namespace {

using Labels = std::vector<std::string>;

struct Rover {
    Model model;
    Dataset data;
    explicit Rover(const std::string &hidden = "", const std::vector<std::pair<std::string, double>> &values = {}, double seconds = 60)
        : data(hand_made::data_of(4, static_cast<std::size_t>(5 * seconds), 0.2)) {
        model = parse_model("[rover]\nmass_kg = 3\n[wheels]\nradius_m = 0.05\n[motor]\ntorque_constant_Nm_A = 0.3\nback_emf_Vs_rad = 0.3\n"
                            "resistance_ohm = 3\ncoulomb_Nm = 0.05\nviscous_Nms = 0.002\ninertia_kg_m2 = 0.002\n"
                            "[soil]\nmu = 0.7\nshear_slip = 0.2\nrolling_coefficient = 0.05\n[[wheel]]\n",
                            "rover");
        const auto hold = [](Parameters &table) {
            for (auto &[key, p] : table) p.prior = p.each_wheel = 0;
        };
        hold(model.rover), hold(model.sensors);
        for (WheelSpec &w : model.wheel) {
            hold(w.geometry), hold(w.motor), hold(w.soil);
            for (const auto &[key, share] : {std::pair{"coulomb_Nm", 0.1}, std::pair{"viscous_Nms", 0.1}})
                w.motor.at(key).prior = share * w.motor.at(key).value;
            for (const char *key : {"mu", "shear_slip", "rolling_coefficient"}) w.soil.at(key).prior = 0.2 * w.soil.at(key).value;
        }
        WheelInput w;
        double angle = 0;
        for (std::size_t k = 0; k < data.count; ++k) {
            const double t = data.time(k), speed = 6 + 4 * std::sin(0.5 * t) + 1.5 * std::sin(1.7 * t);
            w.speed_rad_s.push_back(speed), w.accel_rad_s2.push_back(2 * std::cos(0.5 * t) + 2.55 * std::cos(1.7 * t));
            w.angle_rad.push_back(angle), w.travel_rad.push_back(angle);
            angle += 0.1 * speed;
        }
        data.wheel = {w};
        data.yaw_rate_rad_s.assign(data.count, 0), data.yaw_rad.assign(data.count, 0);
        const BalanceKind kinds[] = {BalanceKind::current_torque, BalanceKind::radar, BalanceKind::accel, BalanceKind::camera_x};
        const double noises[] = {0.01, 0.004, 0.03, 0.001};
        for (std::size_t b = 0; b < 4; ++b)
            data.balance[b].kind = kinds[b], data.balance[b].noise = noises[b], data.balance[b].wheel = b == 0 ? 0 : -1;
        Model truth = model;
        if (!hidden.empty()) {
            EffectUse use;
            use.name = hidden;
            for (const auto &[key, value] : values) use.parameters[key].value = value, use.parameters[key].given = true;
            truth.effects = {use};
        }
        const Eigen::VectorXd y = Forward(data).predict(make_physics(truth));
        std::mt19937 random(5);
        std::normal_distribution<double> normal;
        Eigen::Index row = 0;
        for (Balance &b : data.balance)
            for (double &one : b.measured) one = y[row++] + b.noise * normal(random);
    }
    Diagnosis ask() const {
        Diagnosis d = diagnose(model, data, {});
        expect_consistent(d, model, data);
        return d;
    }
};

TEST(Rover, of_which_nothing_is_hidden_names_nothing) {
    const Diagnosis d = Rover().ask();
    EXPECT_EQ(d.kind, "nothing") << d.text;
    EXPECT_LT(d.ladder.at(0).heldout, 1.05);
    EXPECT_TRUE(d.messages.empty());
}

// What is hidden is named, or of the class that is told; then nothing but noise is left, and a size that is told of it is its own.
struct Hidden {
    const char *effect;
    double size;
};

void expect_told(std::initializer_list<Hidden> all) {
    for (const Hidden &h : all) {
        const sim::Effect *effect = sim::find_effect(h.effect);
        ASSERT_NE(effect, nullptr) << h.effect;
        std::vector<std::pair<std::string, double>> values;
        for (const sim::EffectParameter &p : effect->parameters)
            values.emplace_back(std::string(p.name), p.strength ? h.size : p.variants.empty() ? 0 : p.variants[0]);
        const Rover rover(h.effect, values);
        const Diagnosis d = rover.ask();
        ASSERT_EQ(d.accepted.size(), 1U) << h.effect << ": " << d.text;
        const CandidateResult &first = d.accepted[0];
        if (d.classes.empty()) {
            EXPECT_EQ(first.candidate.effect, h.effect) << d.text;
            EXPECT_EQ(d.kind, "named");
        } else {
            const Labels &members = d.classes[0].members;
            EXPECT_EQ(std::count(members.begin(), members.end(), h.effect), 1) << d.text;
            EXPECT_EQ(d.kind, "class");
            EXPECT_EQ(members[0], first.candidate.label());
        }
        if (first.candidate.effect == h.effect) {
            EXPECT_NEAR(first.value[0], h.size, 3 * (first.high[0] - first.value[0]) / 1.96) << h.effect; // three standard errors
        }
        EXPECT_LT(d.ladder.back().heldout, 1.05) << h.effect; // 1200 rows of noise: 2 %, and what is fitted to them
        EXPECT_GT(d.ladder.front().heldout, 1.9) << h.effect;
        EXPECT_FALSE(d.unknown) << d.text;
        ASSERT_EQ(d.ladder.size(), 2U);
        EXPECT_EQ(d.ladder[1].label, "+ " + first.candidate.label());
        ASSERT_EQ(d.model.effects.size(), 1U);
        EXPECT_EQ(d.model.effects[0].name, first.candidate.effect);
        const Problem anew = fitted_problem(d.model, rover.data); // what is told is what a fit of the model finds
        EXPECT_NEAR(d.ladder[1].train, overall_error(anew), 2e-3) << h.effect;
        EXPECT_NEAR(d.ladder[1].heldout, held_out(anew).error, 5e-3) << h.effect;
        for (std::size_t i = 0; i < anew.parameters.size(); ++i)
            if (anew.parameters[i].owner == first.candidate.effect && first.shapes.empty()) {
                const double size = anew.parameters[i].base + anew.theta[static_cast<Eigen::Index>(i)];
                EXPECT_NEAR(first.value[0], size, 0.1 * (first.high[0] - first.low[0])) << h.effect;
            }
        if (!d.messages.empty()) continue; // another was found first, and dropped: the ranking is of that round
        for (const CandidateResult &r : d.ranking) {
            const bool told =
                r.candidate.label() == first.candidate.label() ||
                (!d.classes.empty() && std::count(d.classes[0].members.begin(), d.classes[0].members.end(), r.candidate.label()) == 1);
            EXPECT_EQ(r.verdict == "named" || r.verdict == "class", told) << h.effect << ": " << r.candidate.label() << ' ' << r.verdict;
            EXPECT_EQ(r.class_index.has_value(), told && !d.classes.empty()) << r.candidate.label();
        }
    }
}

TEST(Rover, has_what_resists_it_named_or_told_as_one_of_a_class) {
    expect_told({{"rolling_resistance", 0.3}, {"speed_resistance", 0.3}, {"squared_resistance", 1}, {"fluid_drag", 30}, {"body_drag", 5}});
}

TEST(Rover, has_what_its_wheels_do_named_or_told_as_one_of_a_class) { expect_told({{"slip_sinkage", 0.6}, {"encoder_missed", 0.3}}); }

TEST(Rover, has_what_pulls_it_along_the_way_named_or_told_as_one_of_a_class) { expect_told({{"grade", 0.3}, {"tether_drag", 3}}); }

} // namespace
} // namespace traction::lab
