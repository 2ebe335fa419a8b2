// Does the model describe the log (doubt.h)? In milliseconds: one motor at imposed speeds, whose current is read twice, I = (u - ke w) / R
// by its voltage and I = (t0 + b w) / K by its friction.
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/decision/doubt.h"
#include "host_tools/lab/fit/ladder.h"
#include "tests/lab/hand_made.h"

#include <cstdio>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <string>

namespace traction::lab {
namespace {

constexpr double ke = 0.1, R = 3, K = 0.3, t0 = 0.05, b = 0.002;

struct Motor {
    Model model;
    Dataset data;
    // `wandering`: what the friction's current does beside, over time. `hidden`: effects that the log holds and the model does not.
    explicit Motor(std::size_t rows = 240, const std::function<double(double)> &wandering = nullptr, double noise = 0.01,
                   std::vector<EffectUse> hidden = {})
        : data(hand_made::data_of(2, rows, 0.5)) {
        model = parse_model("[rover]\nmotion = \"imposed\"\nmass_kg = 3\n[wheels]\nradius_m = 0.05\n[motor]\ntorque_constant_Nm_A = 0.3\n"
                            "back_emf_Vs_rad = 0.1\nresistance_ohm = 3\ncoulomb_Nm = 0.05\nviscous_Nms = 0.002\n[[wheel]]\n",
                            "motor");
        const auto hold = [](Parameters &table) {
            for (auto &[key, p] : table) p.prior = p.each_wheel = 0;
        };
        hold(model.rover), hold(model.sensors);
        for (WheelSpec &w : model.wheel) hold(w.geometry), hold(w.motor), hold(w.soil);
        for (const char *key : {"torque_constant_Nm_A", "back_emf_Vs_rad", "resistance_ohm", "coulomb_Nm", "viscous_Nms"})
            stated(key, 1, 0.05);
        std::mt19937 random(11);
        std::normal_distribution<double> normal;
        WheelInput w;
        double angle = 0, integral = 0;
        for (std::size_t k = 0; k < data.count; ++k) {
            const double t = data.time(k), speed = 40 + 20 * std::sin(0.7 * t), u = 8 + 3 * std::sin(0.43 * t);
            data.body_speed_m_s.push_back(speed * 0.05);
            w.speed_rad_s.push_back(speed), w.accel_rad_s2.push_back(0), w.angle_rad.push_back(angle), w.travel_rad.push_back(angle);
            w.voltage_V.push_back(u), w.voltage_t_s.push_back(t), w.voltage_integral_Vs.push_back(integral);
            angle += 0.1 * speed, integral += 0.1 * u;
        }
        data.wheel = {w};
        for (std::size_t i = 0; i < 2; ++i) {
            Balance &balance = data.balance[i];
            balance.kind = i == 0 ? BalanceKind::current_voltage : BalanceKind::current_torque;
            balance.wheel = 0, balance.noise = noise;
        }
        Model truth = model;
        truth.effects = std::move(hidden);
        const Eigen::VectorXd true_current = Forward(data).predict(make_physics(truth));
        Eigen::Index row = 0;
        for (Balance &balance : data.balance)
            for (std::size_t r = 0; r < rows; ++r) {
                balance.measured[r] = true_current[row++] + noise * normal(random);
                if (wandering && balance.kind == BalanceKind::current_torque) balance.measured[r] += wandering(balance.t0_s[r]);
            }
    }
    // What the sheet says: times what is true, known to this share of it.
    void stated(const char *key, double times, double share) {
        for (WheelSpec &w : model.wheel) {
            Parameter &p = w.motor.at(key);
            p.value *= times, p.prior = share * p.value, p.given = true;
        }
    }
    double fit_error() const { return overall_error(fitted_problem(model, data)); }
    std::optional<Doubt> asked(std::size_t accepted = 0, double shape_gain = 0, const Problem *last = nullptr) const {
        Problem first = fitted_problem(model, data);
        const Problem same = first;
        return doubt(model, data, first, last != nullptr ? *last : same, accepted, shape_gain);
    }
};

const Suspect *find(const std::vector<Suspect> &list, const std::string &quantity) {
    const auto found = std::find_if(list.begin(), list.end(), [&](const Suspect &s) { return s.quantity == quantity; });
    return found == list.end() ? nullptr : &*found;
}

TEST(Motor, is_predicted_by_its_two_balances) {
    const Motor m;
    const Eigen::VectorXd I = Forward(m.data).predict(make_physics(m.model));
    double u = 0, w = 0; // means over the row from 10 s to 10.5 s
    for (int i = 0; i < 5; ++i) {
        const auto at = [&](double base, double by, double rate, double t) { return base + by * std::sin(rate * t); };
        u += 0.2 * at(8, 3, 0.43, 10 + 0.1 * i + 0.05), w += 0.2 * at(40, 20, 0.7, 10 + 0.1 * i + 0.05);
    }
    EXPECT_NEAR(I[20], (u - ke * w) / R, 0.03); // the integral is a sum of steps
    EXPECT_NEAR(I[240 + 20], (t0 + b * w) / K, 0.002);
}

TEST(Motor, that_is_as_stated_is_not_doubted) {
    const Motor m;
    EXPECT_LT(m.fit_error(), 1.1);
    EXPECT_FALSE(m.asked());
    EXPECT_FALSE(m.asked(1));
    EXPECT_FALSE(m.asked(2));
    EXPECT_FALSE(m.asked(0, 0.5));
}

// Of each datum that a sheet may have wrong threefold: found, with the true value, and told as the first to look at.
TEST(Motor, of_another_data_sheet_is_told_which_number_would_describe_it) {
    struct Wrong {
        const char *key, *quantity, *unit;
        double truth, times;
    };
    for (const Wrong &w : {Wrong{"resistance_ohm", "the motors' resistance", "ohm", R, 3},
                           Wrong{"back_emf_Vs_rad", "the back-EMF (of the wheel's side of the gear)", "V s/rad", ke, 3},
                           Wrong{"torque_constant_Nm_A", "the torque constant (of the wheel's side of the gear)", "N m/A", K, 3},
                           Wrong{"viscous_Nms", "the viscous friction of the drives", "N m s", b, 4}}) {
        Motor m(120);
        m.stated(w.key, w.times, 0.04); // six deviations are no gross ratio
        ASSERT_GT(m.fit_error(), 3) << w.key;
        const std::vector<Suspect> all = gross_errors(m.model, m.data);
        EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), [](const Suspect &x, const Suspect &y) { return x.error < y.error; }));
        const Suspect *s = find(all, w.quantity);
        ASSERT_NE(s, nullptr) << w.key;
        EXPECT_NEAR(s->fitted, w.truth, 0.05 * w.truth) << w.key; // the others may move within their 5 %
        EXPECT_DOUBLE_EQ(s->stated, w.times * w.truth);
        EXPECT_LT(s->error, 1.1);
        EXPECT_EQ(s->unit, w.unit);
        const std::optional<Doubt> d = m.asked();
        ASSERT_TRUE(d) << w.key;
        ASSERT_FALSE(d->suspects.empty());
        EXPECT_EQ(d->suspects[0].quantity, w.quantity);
        EXPECT_NEAR(d->error, m.fit_error(), 1e-9);
        EXPECT_EQ(d->text.find(std::string("Look first at ") + w.quantity), 0U) << d->text;
        for (std::size_t i = 0; i < d->suspects.size(); ++i) EXPECT_LT(d->suspects[i].error, 0.5 * d->error); // each does much
    }
}

TEST(Motor, whose_number_is_farther_off_than_a_search_goes_is_found_from_where_it_ends) {
    Motor m;
    m.stated("back_emf_Vs_rad", 0.1, 0.05); // a search goes to six times
    const std::vector<Suspect> all = gross_errors(m.model, m.data);
    const Suspect *s = find(all, "the back-EMF (of the wheel's side of the gear)");
    ASSERT_NE(s, nullptr);
    EXPECT_NEAR(s->fitted, ke, 0.05 * ke);
    Motor over;
    over.stated("resistance_ohm", 300, 0.05); // and to a hundredth
    const std::vector<Suspect> other = gross_errors(over.model, over.data);
    const Suspect *r = find(other, "the motors' resistance");
    ASSERT_NE(r, nullptr);
    EXPECT_NEAR(r->fitted, R, 0.1 * R); // three steps from afar
}

// More friction than stated is an effect of the catalogue; less is the model's mistake.
TEST(Motor, with_more_friction_than_stated_is_a_matter_of_the_catalogue) {
    Motor more;
    more.stated("viscous_Nms", 0.25, 0.05);
    ASSERT_GT(more.fit_error(), 3);
    const std::optional<Doubt> d = more.asked();
    EXPECT_TRUE(!d || find(d->suspects, "the viscous friction of the drives") == nullptr);
}

// The sheet's deviation is so wide that the fit itself goes there: told, with the error that the stated number would leave.
TEST(Motor, that_the_fit_moved_grossly_within_too_wide_a_deviation_is_told) {
    Motor m, held;
    m.stated("resistance_ohm", 3, 0.2); // 9 +- 1.8: three is 3.3 deviations off
    held.stated("resistance_ohm", 3, 1e-6);
    EXPECT_LT(m.fit_error(), 1.1);
    const std::optional<Doubt> d = m.asked();
    ASSERT_TRUE(d);
    ASSERT_EQ(d->suspects.size(), 1U);
    EXPECT_EQ(d->suspects[0].quantity, "the motors' resistance");
    EXPECT_NEAR(d->suspects[0].fitted, R, 0.05 * R);
    EXPECT_NEAR(d->suspects[0].stated, 3 * R, 1e-9);
    EXPECT_NEAR(d->suspects[0].error, m.fit_error(), 1e-9);
    EXPECT_NEAR(d->error, held.fit_error(), 0.15 * held.fit_error()); // other weights of the rows
    EXPECT_GT(d->error, 3);
    Motor near; // two and a half deviations: a sheet may be off by that
    near.stated("resistance_ohm", 3, 0.28);
    EXPECT_FALSE(near.asked());
    Motor slight; // four deviations, but no gross ratio
    slight.stated("resistance_ohm", 1.3, 0.055);
    EXPECT_FALSE(slight.asked());
    Motor named; // where something was found that decides
    named.stated("resistance_ohm", 3, 0.2);
    EXPECT_FALSE(named.asked(1));
}

// An error of some noises: looked for in the twenty seconds where the model fails most, and told by what it does to the whole log.
TEST(Motor, that_is_missed_by_some_noises_is_told_what_would_describe_it) {
    Motor m(240, nullptr, 0.03);
    m.stated("torque_constant_Nm_A", 1.5, 0.01);
    for (const char *known : {"coulomb_Nm", "viscous_Nms"}) m.stated(known, 1, 0.001); // or they would give way instead
    ASSERT_GT(m.fit_error(), 2.5);
    ASSERT_LT(m.fit_error(), 20);
    const std::optional<Doubt> d = m.asked();
    ASSERT_TRUE(d);
    ASSERT_FALSE(d->suspects.empty());
    EXPECT_EQ(d->suspects[0].quantity, "the torque constant (of the wheel's side of the gear)");
    EXPECT_NEAR(d->suspects[0].fitted, K, 0.05 * K);
    EXPECT_LT(d->suspects[0].error, 1.1);
    EXPECT_TRUE(m.asked(0, 0.1)); // a shape that takes off a tenth; one that takes off all but the noise leaves nothing to a number
    EXPECT_FALSE(m.asked(0, 1 - 1 / m.fit_error()));
    EXPECT_TRUE(m.asked(1)); // one number does far more than one name did
    EXPECT_TRUE(m.asked(2));
    Motor right(240, nullptr, 0.03); // named was what explains all: the number does no more
    const Problem all = fitted_problem(right.model, right.data);
    EXPECT_FALSE(m.asked(1, 0, &all));
}

EffectUse effect(const char *name, const std::vector<std::pair<const char *, double>> &values) {
    EffectUse use;
    use.name = name;
    for (const auto &[key, value] : values) use.parameters[key].value = value, use.parameters[key].given = true;
    return use;
}

// exp(-t / 33) of a friction more: tried at 10, 30 and 80 s, told at what it is.
TEST(Motor, that_wears_in_is_named_with_the_time_that_it_takes) {
    const Motor m(480, nullptr, 0.01, {effect("wear_in", {{"torque_Nm", 0.05}, {"time_constant_s", 33}})});
    const Diagnosis d = diagnose(m.model, m.data, {});
    ASSERT_EQ(d.accepted.size(), 1U) << d.text;
    EXPECT_EQ(d.accepted[0].candidate.effect, "wear_in");
    EXPECT_NEAR(d.accepted[0].value[0], 0.05, 0.003);
    ASSERT_EQ(d.accepted[0].shapes.size(), 1U);
    const ShapeEstimate &time = d.accepted[0].shapes[0];
    EXPECT_EQ(time.key, "time_constant_s");
    EXPECT_EQ(time.unit, "s");
    EXPECT_NEAR(time.value, 33, 3);
    EXPECT_LT(time.low, 33);
    EXPECT_GT(time.high, 33);
    EXPECT_NEAR(time.value - time.low, time.high - time.value, 1e-9);
    EXPECT_EQ(d.accepted[0].candidate.variant[0].second, time.value);
    ASSERT_EQ(d.model.effects.size(), 1U);
    const Parameter &kept = d.model.effects[0].parameters.at("time_constant_s");
    EXPECT_EQ(kept.value, time.value);
    EXPECT_EQ(kept.low, time.low);
    EXPECT_EQ(kept.high, time.high);
    EXPECT_TRUE(kept.fixed);
    EXPECT_FALSE(std::isfinite(kept.minimum) || std::isfinite(kept.maximum));
    ASSERT_TRUE(d.model_fit); // of this model, its time fixed where it was found
    EXPECT_EQ(d.model_fit->parameters.size(), free_parameters(d.model, make_physics(d.model)).size());
    EXPECT_NEAR(d.model_fit->physics().wheel[0].wear_in_time_s, time.value, 1e-9);
    ASSERT_EQ(d.ladder.size(), 2U);
    EXPECT_LT(d.ladder[1].train, 1.1);
    EXPECT_LT(d.ladder[1].heldout, 1.1);
    EXPECT_GT(d.ladder[0].train, 2);
}

// A resistance beside the friction's: each is named in its own balance, and the time is that of the friction.
TEST(Motor, with_two_faults_has_both_named) {
    const Motor m(
        480, nullptr, 0.01,
        {effect("wiring_resistance", {{"resistance_ohm", 1.0}}), effect("wear_in", {{"torque_Nm", 0.05}, {"time_constant_s", 33}})});
    const Diagnosis d = diagnose(m.model, m.data, {});
    ASSERT_EQ(d.accepted.size(), 2U) << d.text;
    const auto of = [&](const char *name) {
        return *std::find_if(d.accepted.begin(), d.accepted.end(), [&](const CandidateResult &a) { return a.candidate.effect == name; });
    };
    EXPECT_NEAR(of("wiring_resistance").value[0], 1, 0.15) << d.text; // beside 5 % of 3 ohm that the sheet may be off
    EXPECT_TRUE(of("wiring_resistance").shapes.empty());
    EXPECT_NEAR(of("wear_in").value[0], 0.05, 0.003);
    ASSERT_EQ(of("wear_in").shapes.size(), 1U);
    EXPECT_NEAR(of("wear_in").shapes[0].value, 33, 3);
    for (const EffectUse &use : d.model.effects)
        if (use.name == "wiring_resistance") {
            EXPECT_EQ(use.parameters.size(), 1U);
            EXPECT_TRUE(std::isfinite(use.parameters.at("resistance_ohm").maximum));
        }
}

// What no number of the sheet does: told only where as much is left as the signal itself, or at 25 times the noise with nothing found.
TEST(Motor, whose_current_wanders_by_itself_is_doubted_where_it_is_far_off) {
    const auto missed_by = [](double error) { // times the noise, in all
        const auto with = [](double size) { return Motor(240, [=](double t) { return size * std::sin(0.05 * t); }); };
        double size = 0.1 * error / 8; // what is left grows nearly as the wandering does
        for (int i = 0; i < 4; ++i) size *= error / with(size).fit_error();
        return with(size);
    };
    EXPECT_NEAR(missed_by(24).fit_error(), 24, 0.5);
    EXPECT_FALSE(missed_by(24).asked());
    EXPECT_TRUE(missed_by(25.8).asked());
    Motor near(240, [](double t) { return 0.1 * std::sin(0.05 * t); }), far(240, [](double t) { return 2 * std::sin(0.05 * t); });
    EXPECT_FALSE(near.asked()) << near.fit_error();
    ASSERT_GT(far.fit_error(), 25);
    const std::optional<Doubt> d = far.asked();
    ASSERT_TRUE(d);
    EXPECT_NEAR(d->error, far.fit_error(), 1e-9);
    EXPECT_TRUE(d->suspects.empty());
    char text[60];
    std::snprintf(text, sizeof text, "as fitted it leaves %.0f %% of a measured signal",
                  100 * misfits(fitted_problem(far.model, far.data))[1]);
    EXPECT_EQ(d->text.find(text), 0U) << d->text;
}

// A resistance that stands at six of its deviations, and leaves three noises but less than 15 % of any signal: nothing but the bound says
// that something is wrong.
TEST(Motor, whose_number_stands_at_its_limit_is_asked_though_no_signal_is_missed) {
    Motor m(960, nullptr, 0.04);
    for (const char *known : {"back_emf_Vs_rad", "torque_constant_Nm_A", "coulomb_Nm", "viscous_Nms"}) m.stated(known, 1, 0.001);
    m.stated("resistance_ohm", 1.5, 0.037); // 4.5 to 3.5, of three
    const Problem first = fitted_problem(m.model, m.data);
    ASSERT_LT(worst_misfit(first), 0.15);
    ASSERT_LT(m.fit_error(), 25);
    ASSERT_GT(m.fit_error(), 3);
    const std::optional<Doubt> d = m.asked();
    ASSERT_TRUE(d);
    ASSERT_FALSE(d->suspects.empty());
    EXPECT_EQ(d->suspects[0].quantity, "the motors' resistance");
    EXPECT_NEAR(d->suspects[0].fitted, R, 0.1 * R);
}

// A number that the model holds for known and that is not: nothing stands at a bound, the friction's current is right, and all that is
// missed is the current by the voltage, by some noises and a fifth of itself. Less resistance than stated is no effect of the catalogue.
TEST(Motor, whose_held_number_shows_in_the_balance_of_the_voltage_alone_is_told_it) {
    Motor m(480, nullptr, 0.1);
    for (const char *known : {"back_emf_Vs_rad", "torque_constant_Nm_A", "coulomb_Nm", "viscous_Nms"}) m.stated(known, 1, 0);
    m.stated("resistance_ohm", 1.6, 0);
    Problem first = fitted_problem(m.model, m.data);
    const std::vector<double> missed = misfits(first);
    ASSERT_GT(missed[0], 0.2);
    ASSERT_LT(missed[1], 0.1);
    ASSERT_LT(m.fit_error(), 10);
    for (std::size_t i = 0; i < first.parameters.size(); ++i) ASSERT_FALSE(first.at_bound(i)) << name_of(first.parameters[i]);
    const std::optional<Doubt> d = m.asked();
    ASSERT_TRUE(d);
    ASSERT_FALSE(d->suspects.empty());
    EXPECT_EQ(d->suspects[0].quantity, "the motors' resistance");
    EXPECT_NEAR(d->suspects[0].fitted, R, 0.1 * R);
}

// Four stated deviations and a gross ratio, but the error falls by 3 %: the log hardly asks for it.
TEST(Motor, that_the_fit_moved_grossly_for_little_is_not_told) {
    Motor m(2000, nullptr, 1.2);
    m.stated("viscous_Nms", 2, 0.1);
    const Problem first = fitted_problem(m.model, m.data);
    double moved = 1;
    for (std::size_t i = 0; i < first.parameters.size(); ++i)
        if (first.parameters[i].key == "viscous_Nms" && !first.parameters[i].own)
            moved = 1 + first.theta[static_cast<Eigen::Index>(i)] / first.parameters[i].base;
    ASSERT_LT(moved, 1 / 1.4);
    ASSERT_LT(moved, 1 - 3 * 0.1);
    EXPECT_FALSE(m.asked());
}

// Half of the size of interest, and nearly all of the error: it is named, and the friction that it is.
TEST(Bench, of_a_friction_below_the_size_of_interest_names_what_takes_most_of_the_error) {
    EffectUse hidden;
    hidden.name = "churning_friction";
    hidden.parameters["coefficient_Nms2"].value = 3e-5;
    const Motor m(240, nullptr, 0.01, {hidden});
    const Diagnosis d = diagnose(m.model, m.data, {});
    ASSERT_EQ(d.effects, std::vector<std::string>{"churning_friction"}) << d.text;
    EXPECT_TRUE(d.accepted[0].matters);
    EXPECT_LT(d.accepted[0].low[0], 3e-5);
    EXPECT_GT(d.accepted[0].high[0], 3e-5);
}

} // namespace
} // namespace traction::lab
