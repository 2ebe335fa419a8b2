// What a model may be grossly wrong in, and when that is believed (suspects.h), on models and fits made by hand.
#include "host_tools/lab/decision/suspects.h"
#include "host_tools/lab/fit/ladder.h"
#include "tests/lab/hand_made.h"

#include <functional>
#include <gtest/gtest.h>
#include <memory>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace traction::lab {
namespace {

const Datum &datum(const std::string &key) {
    const std::vector<const Datum *> all = all_data();
    return **std::find_if(all.begin(), all.end(), [&](const Datum *d) { return key == d->key; });
}

Model two_wheels() {
    Model m;
    m.rover["mass_kg"].value = 3;
    m.wheel.resize(2);
    for (std::size_t i = 0; i < 2; ++i) {
        const double more = static_cast<double>(i);
        m.wheel[i].geometry["radius_m"].value = 0.1 + more;
        m.wheel[i].motor["coulomb_Nm"].value = 0.2 + more;
        m.wheel[i].soil["mu"].value = 0.5 + more;
    }
    return m;
}

TEST(Data, of_a_model_are_found_where_they_stand_on_every_wheel) {
    Model m = two_wheels();
    EXPECT_EQ(all_data().size(), 11U);
    EXPECT_EQ(values_of(m, datum("mass_kg")), std::vector<Parameter *>{&m.rover["mass_kg"]});
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(values_of(m, datum("radius_m")).at(i), &m.wheel[i].geometry["radius_m"]);
        EXPECT_EQ(values_of(m, datum("coulomb_Nm")).at(i), &m.wheel[i].motor["coulomb_Nm"]);
        EXPECT_EQ(values_of(m, datum("mu")).at(i), &m.wheel[i].soil["mu"]);
    }
    EXPECT_TRUE(values_of(m, datum("inertia_kg_m2")).empty());
    m.rover["radius_m"].value = 1; // a rover has none
    EXPECT_EQ(values_of(m, datum("radius_m")).size(), 2U);
}

TEST(Data, set_free_go_from_a_hundredth_to_six_times_where_they_begin) {
    Model m = two_wheels();
    m.wheel[1].motor["coulomb_Nm"].fixed = true, m.wheel[0].motor["coulomb_Nm"].value = 0; // nothing has no multiple
    EXPECT_TRUE(set_free(m, datum("coulomb_Nm"), 0.5));
    const Parameter &p = m.wheel[1].motor["coulomb_Nm"];
    EXPECT_DOUBLE_EQ(p.value, 0.6);
    EXPECT_DOUBLE_EQ(p.prior, 0.6);
    EXPECT_DOUBLE_EQ(p.minimum, 0.006);
    EXPECT_DOUBLE_EQ(p.maximum, 3.6);
    EXPECT_FALSE(p.fixed);
    EXPECT_EQ(m.wheel[0].motor["coulomb_Nm"].prior, 0);
    EXPECT_FALSE(set_free(m, datum("inertia_kg_m2"), 1));
    m.rover["mass_kg"].value = 0;
    EXPECT_FALSE(set_free(m, datum("mass_kg"), 1));
}

Suspect suspect(double fitted, double error = 1, bool more_is_an_effect = false) {
    return {"the mass", 10, fitted, "kg", error, 1.25, more_is_an_effect};
}

TEST(Gross, is_a_ratio_either_way_unless_more_of_it_is_an_effect) {
    EXPECT_TRUE(is_gross(suspect(7.9)));
    EXPECT_FALSE(is_gross(suspect(8.1)));
    EXPECT_FALSE(is_gross(suspect(12.4)));
    EXPECT_TRUE(is_gross(suspect(12.6)));
    EXPECT_FALSE(is_gross(suspect(12.6, 1, true)));
    EXPECT_TRUE(is_gross(suspect(7.9, 1, true)));
}

// Two balances of a row a second from 7 s on.
Problem rows_of(std::size_t seconds, const std::function<double(std::size_t, std::size_t)> &residual) {
    static std::vector<std::unique_ptr<Dataset>> kept; // problems hold their data by address
    kept.push_back(std::make_unique<Dataset>(hand_made::data_of(2, seconds, 1, 7)));
    Eigen::VectorXd e(static_cast<Eigen::Index>(2 * seconds));
    for (std::size_t b = 0; b < 2; ++b)
        for (std::size_t r = 0; r < seconds; ++r) e[static_cast<Eigen::Index>(b * seconds + r)] = residual(b, r);
    return hand_made::problem_of(*kept.back(), {}, Eigen::MatrixXd(e.size(), 0), e);
}

TEST(Worst, stretch_is_the_twenty_seconds_in_which_most_is_left) {
    const auto between = [](double from, double to) {
        return worst_stretch(rows_of(100, [=](std::size_t, std::size_t r) {
            const double t = static_cast<double>(r);
            return t >= from && t < to ? 1.0 : 0.1;
        }));
    };
    for (const double from : {0.0, 15.0, 40.0, 80.0}) {
        const Dataset part = between(from, from + 20);
        EXPECT_NEAR(part.start_s, 7 + from, 0.11) << from; // a step of the grid
        EXPECT_NEAR(part.time(part.count - 1), 27 + from, 0.11) << from;
        EXPECT_EQ(part.balance[0].measured.size(), 20U);
    }
    const Dataset part = between(22, 27); // of stretches that hold it all, by quarters, the first
    EXPECT_LE(part.start_s, 7 + 22);
    EXPECT_GE(part.time(part.count - 1), 7 + 27);
}

TEST(Worst, stretch_that_reaches_beyond_the_end_begins_twenty_seconds_before_it) {
    const Dataset part = worst_stretch(rows_of(103, [](std::size_t, std::size_t r) { return r >= 88 ? 1.0 : 0.0; }));
    EXPECT_NEAR(part.start_s, 7 + 83, 0.11);
    EXPECT_NEAR(part.time(part.count - 1), 7 + 103, 0.11);
}

TEST(Worst, stretch_counts_a_balance_like_another) {
    const auto part = [](double second) { // of the first balance the beginning is the worse by 16 to 1, of the second the other by 4 to 1
        return worst_stretch(rows_of(100, [=](std::size_t b, std::size_t r) {
            if (r < 20) return b == 0 ? 1.0 : 0.5 * second;
            return r >= 60 && r < 80 ? (b == 0 ? 0.25 : second) : 0.0;
        }));
    };
    EXPECT_NEAR(part(0.1).start_s, 7, 0.11);
    EXPECT_NEAR(part(0.9).start_s, 7, 0.11);      // 15/16 of 1 against 3/4 of 0.81
    EXPECT_NEAR(part(1.2).start_s, 7 + 60, 0.11); // against 3/4 of 1.44
}

// Twenty rows of 1, and one of o elsewhere, of a hundred: it counts as 4 (o^2 + 20) / 100, which is less than twenty where o^2 < 480.
TEST(Worst, stretch_counts_a_row_as_four_times_its_balances_mean_at_most) {
    const auto part = [](double square) {
        return worst_stretch(rows_of(100, [=](std::size_t, std::size_t r) {
            return r == 32 ? std::sqrt(square) : r >= 60 && r < 80 ? 1.0 : 0.0;
        }));
    };
    EXPECT_NEAR(part(470).start_s, 7 + 60, 0.11);
    EXPECT_LT(part(490).start_s, 7 + 33);
}

TEST(Worst, stretch_of_a_short_log_or_a_table_is_all_of_it) {
    const auto one = [](std::size_t, std::size_t r) { return r < 20 ? 1.0 : 0.0; };
    EXPECT_EQ(worst_stretch(rows_of(39, one)).balance[0].measured.size(), 39U);
    EXPECT_EQ(worst_stretch(rows_of(41, one)).balance[0].measured.size(), 20U);
    Dataset table = hand_made::data_of(1, 100, 1);
    table.independent_rows = true;
    const Problem p = hand_made::problem_of(table, {}, Eigen::MatrixXd(100, 0), Eigen::VectorXd::Ones(100));
    EXPECT_EQ(worst_stretch(p).balance[0].measured.size(), 100U);
}

TEST(Error, within_a_stretch_is_that_of_the_rows_that_lie_wholly_in_it) {
    const Problem p = rows_of(100, [](std::size_t b, std::size_t r) { return r < 10 ? (b == 0 ? 3.0 : 4.0) : r == 10 ? 100.0 : 0.0; });
    Dataset part = p.data();
    part.start_s = 7, part.count = 101; // a tenth of a second each
    EXPECT_DOUBLE_EQ(error_within(p, part), std::sqrt(12.5));
    part.count = 106; // the row that reaches over its end is not in it
    EXPECT_DOUBLE_EQ(error_within(p, part), std::sqrt(12.5));
    part.start_s = 8.5, part.count = 86;
    EXPECT_DOUBLE_EQ(error_within(p, part), std::sqrt(12.5));
    part.count = 201; // eight rows of ten and one of a thousandfold square
    part.start_s = 9.0;
    EXPECT_DOUBLE_EQ(error_within(p, part), std::sqrt(0.5 * ((8 * 9 + 1e4) / 20 + (8 * 16 + 1e4) / 20)));
    part.start_s = 500;
    EXPECT_EQ(error_within(p, part), 0);
    part = p.data();
    EXPECT_NEAR(error_within(p, part), overall_error(p), 1e-12);
}

// Second differences of a line are none, of alternating +-1 always 4: (1.4826 * 4)^2 / 6.
TEST(Scatter, from_row_to_row_is_none_of_what_is_smooth_and_all_of_what_alternates) {
    const Problem line = rows_of(50, [](std::size_t, std::size_t r) { return static_cast<double>(r); });
    EXPECT_NEAR(fit_scatter(line), 0, 1e-12);
    const Problem zigzag = rows_of(50, [](std::size_t b, std::size_t r) { return b == 0 ? (r % 2 == 0 ? 1.0 : -1.0) : 5.0; });
    EXPECT_NEAR(fit_scatter(zigzag), std::sqrt(std::pow(1.4826 * 4, 2) / 6 / 2), 1e-12);
    const Problem two = rows_of(2, [](std::size_t, std::size_t r) { return static_cast<double>(r); });
    EXPECT_EQ(fit_scatter(two), 0); // no second difference
    const Problem three = rows_of(3, [](std::size_t, std::size_t r) { return r == 1 ? 1.0 : 0.0; });
    EXPECT_NEAR(fit_scatter(three), 1.4826 * 2 / std::sqrt(6), 1e-12);
    const Dataset nothing = hand_made::data_of(0, 10, 1);
    EXPECT_EQ(fit_scatter(hand_made::problem_of(nothing, {}, Eigen::MatrixXd(0, 0), Eigen::VectorXd(0))), 0);
}

TEST(Error, less_what_may_be_scatter_is_the_root_of_what_is_left_and_never_below_nothing) {
    const Problem p = rows_of(4, [](std::size_t b, std::size_t) { return b == 0 ? 3.0 : 4.0; });
    const auto less = [&](double first, double second) {
        Eigen::VectorXd squares(8);
        squares << Eigen::VectorXd::Constant(4, first), Eigen::VectorXd::Constant(4, second);
        return error_less(p, squares);
    };
    EXPECT_DOUBLE_EQ(less(0, 0), overall_error(p));
    EXPECT_DOUBLE_EQ(less(5, 2), 3); // (4 + 14) / 2
    EXPECT_EQ(less(50, 50), 0);
    Dataset bare = hand_made::data_of(2, 4, 1); // a balance without rows is none that errs
    bare.balance[1].measured.clear();
    EXPECT_DOUBLE_EQ(
        error_less(hand_made::problem_of(bare, {}, Eigen::MatrixXd(4, 0), Eigen::VectorXd::Constant(4, 2)), Eigen::VectorXd::Zero(4)),
        std::sqrt(2.0));
    const Dataset nothing = hand_made::data_of(0, 10, 1);
    EXPECT_EQ(error_less(hand_made::problem_of(nothing, {}, Eigen::MatrixXd(0, 0), Eigen::VectorXd(0)), Eigen::VectorXd(0)), 0);
}

TEST(Strained, is_a_model_one_of_whose_data_stands_at_its_bound) {
    const Dataset data = hand_made::data_of(1, 2, 1);
    const auto at = [&](const char *owner, const char *key, double increment) {
        Problem p =
            hand_made::problem_of(data, {hand_made::parameter("sensors", "x", 0, 1), hand_made::parameter(owner, key, 1, 0.1, 0, 9)},
                                  Eigen::MatrixXd::Zero(2, 2), Eigen::VectorXd::Zero(2));
        p.theta[1] = increment;
        return strained(p);
    };
    EXPECT_TRUE(at("motor", "coulomb_Nm", 0.6)); // six stated deviations
    EXPECT_TRUE(at("motor", "coulomb_Nm", -0.6));
    EXPECT_FALSE(at("motor", "coulomb_Nm", 0.59));
    EXPECT_FALSE(at("rover", "coulomb_Nm", 0.6));
    EXPECT_FALSE(at("motor", "mass_kg", 0.6));
}

TEST(Law, of_the_catalogue_that_is_a_datum_by_another_name_is_known) {
    const Dataset data = hand_made::data_of(1, 2, 1);
    const auto is = [&](const char *effect, const char *key) {
        const Problem p = hand_made::problem_of(data, {hand_made::parameter("motor", "x", 1, 1), hand_made::parameter(effect, "y", 1, 0)},
                                                Eigen::MatrixXd::Zero(2, 2), Eigen::VectorXd::Zero(2));
        return kin_of(p, datum(key));
    };
    for (const auto &[effect, key] : {std::pair{"torque_constant", "torque_constant_Nm_A"}, std::pair{"wheel_radius", "radius_m"},
                                      std::pair{"shear_stiffness", "shear_slip"}})
        EXPECT_EQ(is(effect, key), Kin::its_number) << effect;
    for (const auto &[effect, key] : {std::pair{"current_gain", "torque_constant_Nm_A"}, std::pair{"voltage_gain", "back_emf_Vs_rad"},
                                      std::pair{"voltage_gain", "torque_constant_Nm_A"}})
        EXPECT_EQ(is(effect, key), Kin::acts_alike) << effect;
    EXPECT_EQ(is("torque_constant", "radius_m"), Kin::none);
    EXPECT_EQ(is("slip_sinkage", "shear_slip"), Kin::none);
}

TEST(Law, that_changes_a_datum_is_known_by_its_name) {
    EXPECT_STREQ(number_of("shear_stiffness")->key, "shear_slip");
    EXPECT_STREQ(number_of("wheel_radius")->key, "radius_m");
    EXPECT_STREQ(number_of("torque_constant")->key, "torque_constant_Nm_A");
    EXPECT_EQ(number_of("current_gain"), nullptr);
    EXPECT_EQ(number_of(""), nullptr);
}

// (doubt.h) one number must describe what names do: much better than the model as stated, and better than they.
TEST(Suspect, beside_nothing_that_was_named_must_halve_the_error_and_beat_a_shape_by_a_tenth) {
    const auto told = [](const Suspect &s, std::size_t accepted, double before, double left, bool relieves = false, double lead = -1,
                         Kin kin = Kin::none) {
        return is_suspect(
            s, accepted, before, left, [=] { return relieves; }, [=] { return lead; }, [=] { return kin; });
    };
    EXPECT_TRUE(told(suspect(20, 4.9), 0, 10, 10));
    EXPECT_FALSE(told(suspect(20, 5), 0, 10, 10));
    EXPECT_FALSE(told(suspect(11, 1), 0, 10, 10)); // no gross difference
    EXPECT_TRUE(told(suspect(20, 3.5), 0, 10, 4));
    EXPECT_FALSE(told(suspect(20, 3.7), 0, 10, 4));
    EXPECT_FALSE(told(suspect(20, 5.5), 0, 10, 10, true, 9)); // there is no rival
    // beside one effect: three quarters, and nine tenths of what the effect leaves
    EXPECT_TRUE(told(suspect(20, 7.4), 1, 10, 9));
    EXPECT_FALSE(told(suspect(20, 7.6), 1, 10, 9));
    EXPECT_FALSE(told(suspect(20, 7.4), 1, 10, 8));
    // or as much as it, where the effect leaves the sheet contradicted or predicts no better
    EXPECT_TRUE(told(suspect(20, 8.1), 1, 10, 8, true));
    EXPECT_FALSE(told(suspect(20, 8.2), 1, 10, 8, true));  // 1.02
    EXPECT_FALSE(told(suspect(20, 9.5), 1, 10, 12, true)); // no gain worth telling: 0.95
    EXPECT_TRUE(told(suspect(20, 9.4), 1, 10, 12, true));
    EXPECT_TRUE(told(suspect(20, 8.1), 1, 10, 8, false, 0.1));
    EXPECT_FALSE(told(suspect(20, 8.1), 1, 10, 8, false, 0));
    EXPECT_FALSE(told(suspect(20, 8.1), 1, 10, 8, false, 1.9, Kin::acts_alike)); // its own law: surely better
    EXPECT_TRUE(told(suspect(20, 8.1), 1, 10, 8, false, 2.1, Kin::acts_alike));
    EXPECT_TRUE(told(suspect(20, 8.1), 1, 10, 8, true, -1, Kin::acts_alike));
    EXPECT_FALSE(told(suspect(20, 8.1), 1, 10, 8, true, 1.9, Kin::its_number)); // no less contradicted by another name
    EXPECT_TRUE(told(suspect(20, 8.1), 1, 10, 8, true, 2.1, Kin::its_number));
    EXPECT_TRUE(told(suspect(20, 7.1), 1, 10, 8, false, -1, Kin::its_number));   // a tenth better: the name did not find its place
    EXPECT_FALSE(told(suspect(20, 5.4), 2, 10, 5, false, 1.9, Kin::its_number)); // one of the two names has it free already
    EXPECT_TRUE(told(suspect(20, 5.4), 2, 10, 5, false, 2.1, Kin::its_number));
    EXPECT_TRUE(told(suspect(20, 5.4), 2, 10, 5, false, -1, Kin::acts_alike));
    EXPECT_FALSE(told(suspect(11, 8.1), 1, 10, 8, true));
    // beside two: one number is simpler
    EXPECT_TRUE(told(suspect(20, 5.4), 2, 10, 5));
    EXPECT_FALSE(told(suspect(20, 5.6), 2, 10, 5));
    EXPECT_FALSE(told(suspect(20, 7.6), 2, 10, 9));
    EXPECT_FALSE(told(suspect(20, 8.1), 2, 10, 8, true, 9)); // rivals are of one
    // more friction is an effect, unless it alone does what took two names
    EXPECT_FALSE(told(suspect(20, 5.4, true), 1, 10, 9, true, 9));
    EXPECT_TRUE(told(suspect(20, 5.4, true), 2, 10, 5, false, 0.1));
    EXPECT_FALSE(told(suspect(20, 5.4, true), 2, 10, 5, false, 0));
    EXPECT_FALSE(told(suspect(20, 5.6, true), 2, 10, 5, false, 0.1));
    EXPECT_FALSE(told(suspect(20, 7.6, true), 2, 10, 9, false, 0.1));
    EXPECT_FALSE(told(suspect(12, 5.4, true), 2, 10, 5, false, 0.1));
    // a limit itself is not beyond it
    EXPECT_FALSE(told(suspect(20, 0.75 * 10), 1, 10, 90));
    EXPECT_FALSE(told(suspect(20, 0.9 * 8), 1, 10, 8));
    EXPECT_FALSE(told(suspect(20, 1.02 * 8), 1, 10, 8, true));
    EXPECT_FALSE(told(suspect(20, 0.95 * 10), 1, 10, 12, true));
    EXPECT_FALSE(told(suspect(20, 1.1 * 5), 2, 10, 5));
    EXPECT_FALSE(told(suspect(20, 0.5 * 10), 0, 10, 10));
    EXPECT_FALSE(told(suspect(20, 8.1), 1, 10, 8, false, 2, Kin::acts_alike));
    EXPECT_FALSE(told(suspect(20, 5.4), 2, 10, 5, false, 2, Kin::its_number));
    EXPECT_FALSE(told(suspect(12.5, 5.4, true), 2, 10, 5, false, 0.1));
    EXPECT_FALSE(told(suspect(20, 0.75 * 10, true), 2, 10, 9, false, 0.1));
    EXPECT_FALSE(told(suspect(20, 1.1 * 5, true), 2, 10, 5, false, 0.1));
    EXPECT_FALSE(is_gross(suspect(12.5)));
    EXPECT_FALSE(is_gross(suspect(8)));
}

// The share that is looked for is the largest that the rule above accepts.
TEST(Track, is_asked_where_two_witnesses_of_a_speed_are_said_to_read_it_falsely) {
    const auto names = [](std::initializer_list<std::pair<const char *, int>> list) {
        const Dataset data = hand_made::data_of(1, 2, 1);
        std::vector<FreeParameter> parameters;
        for (const auto &[owner, wheel] : list) {
            parameters.push_back(hand_made::parameter(owner, "change", 0, 1));
            parameters.back().wheel = wheel;
        }
        const auto n = static_cast<Eigen::Index>(parameters.size());
        return names_several_scales(hand_made::problem_of(data, parameters, Eigen::MatrixXd::Zero(2, n), Eigen::VectorXd::Zero(2)));
    };
    EXPECT_TRUE(names({{"camera_scale", -1}, {"radar_scale", -1}}));
    EXPECT_TRUE(names({{"wheel_radius", -1}, {"gyro_scale", -1}}));
    EXPECT_FALSE(names({{"wheel_radius", -1}, {"encoder_missed", -1}})); // the wheels are one witness
    EXPECT_FALSE(names({{"camera_scale", -1}, {"wheel_radius", 2}}));    // one wheel is none
    EXPECT_FALSE(names({{"camera_scale", -1}, {"accel_scale", -1}}));
    EXPECT_FALSE(names({}));
}

TEST(Track, takes_their_place_where_it_is_off_by_three_percent_and_does_nine_tenths_of_what_they_do) {
    const auto does = [](double fitted, double error) {
        return does_as_much({"the track", 1, fitted, "1", error, track().gross, false}, 2, 1); // 4 squares, of which the names leave 1
    };
    EXPECT_TRUE(does(1.031, 1.13));  // 2.72 of their 3
    EXPECT_FALSE(does(1.031, 1.15)); // 2.68
    EXPECT_FALSE(does(1.029, 1));
    EXPECT_TRUE(does(0.97, 1));
    EXPECT_FALSE(does(0.972, 1));
}

TEST(Track, is_set_free_by_a_tenth_as_a_ruler_may_be_off) {
    Model m = two_wheels();
    EXPECT_FALSE(set_free(m, track(), 1)) << "a model made by hand that has none";
    m.rover["track_scale"].value = 1;
    EXPECT_TRUE(set_free(m, track(), 0.9));
    EXPECT_DOUBLE_EQ(m.rover["track_scale"].value, 0.9);
    EXPECT_DOUBLE_EQ(m.rover["track_scale"].prior, 0.09);
}

TEST(Suspect, is_looked_for_up_to_the_share_that_would_be_told) {
    for (const std::size_t accepted : {0U, 1U, 2U, 3U})
        for (const double left : {2.0, 5.0, 6.0, 8.0, 9.0, 10.0}) {
            const double share = largest_share(accepted, 10, left);
            const auto told = [&](double error) {
                return is_suspect(
                    suspect(20, error), accepted, 10, left, [] { return true; }, [] { return 9.0; }, [] { return Kin::none; });
            };
            EXPECT_TRUE(told(9.999 * share)) << accepted << ' ' << left;
            EXPECT_FALSE(told(10.001 * share)) << accepted << ' ' << left;
        }
}

TEST(Suspects, are_told_once_each_the_least_error_first) {
    Suspect radius = suspect(5, 2);
    radius.quantity = "the radius";
    const std::vector<Suspect> told = told_once({suspect(20, 3), radius, suspect(25, 1)});
    ASSERT_EQ(told.size(), 2U);
    EXPECT_EQ(told[0].fitted, 25);
    EXPECT_EQ(told[1].quantity, "the radius");
}

TEST(Suspects, are_told_in_words_three_at_most_and_where_there_is_none_what_is_left_of_a_signal) {
    Suspect pure = suspect(0.61234, 2.3456);
    pure.quantity = "the ground's grip", pure.unit = "1", pure.stated = 0.05;
    EXPECT_EQ(what_to_look_at({suspect(20, 1), pure}, 0.5),
              "Look first at the mass: 20 kg would describe it (error 1 x noise), the model has 10; or the ground's grip: 0.6123  would "
              "describe it (error 2.35 x noise), the model has 0.05; then at units, gear, the wheels' order, and the ground's law");
    const std::string many = what_to_look_at({pure, pure, pure, suspect(20, 1)}, 0.5);
    EXPECT_EQ(many.find("the mass"), std::string::npos);
    EXPECT_EQ(what_to_look_at({}, 0.934), "as fitted it leaves 93 % of a measured signal (but for noise). Look at the wheels' order and "
                                          "signs, radius, mass, units and gear, and the ground's law");
}

TEST(Search, that_ends_at_an_edge_goes_on_from_beyond_it) {
    EXPECT_FALSE(from_the_edge(1, 1));
    EXPECT_FALSE(from_the_edge(1, 0.031));
    EXPECT_FALSE(from_the_edge(1, 5.49));
    ASSERT_TRUE(from_the_edge(4, 0.03) && from_the_edge(4, 5.5));
    EXPECT_DOUBLE_EQ(*from_the_edge(4, 0.03), 0.2); // a hundredth is where it may go: a twentieth of the begin
    EXPECT_DOUBLE_EQ(*from_the_edge(4, 0.01), 0.2);
    EXPECT_DOUBLE_EQ(*from_the_edge(4, 5.5), 20);
    EXPECT_DOUBLE_EQ(*from_the_edge(4, 6), 20);
}

TEST(Suspicion, is_of_15_percent_of_a_signal_or_of_two_effects_that_take_a_quarter_off) {
    EXPECT_FALSE(is_suspicious(0.149, 0, 10, 1));
    EXPECT_TRUE(is_suspicious(0.15, 0, 1, 1));
    EXPECT_FALSE(is_suspicious(0, 1, 10, 1));
    EXPECT_TRUE(is_suspicious(0, 2, 1.31, 1));
    EXPECT_FALSE(is_suspicious(0, 2, 1.3, 1));
    EXPECT_TRUE(is_suspicious(0, 3, 2.7, 2));
    EXPECT_FALSE(is_no_ground(25));
    EXPECT_TRUE(is_no_ground(25.1));
    EXPECT_FALSE(describes_nothing(0.899));
    EXPECT_TRUE(describes_nothing(0.9));
    EXPECT_TRUE(describes_nothing(std::nan(""))); // of which nothing is known
}

// Of a signal of 2 a residual of 1.3 at a noise of 0.5: sqrt(1.69 - 0.25) / 2 = 0.6.
TEST(Misfit, is_what_is_left_of_a_signal_beyond_noise_and_the_worst_is_of_what_drives) {
    Dataset data = hand_made::data_of(2, 4, 0.5);
    for (Balance &b : data.balance) {
        b.noise = 0.5;
        for (double &y : b.measured) y = 2;
    }
    Eigen::VectorXd left = Eigen::VectorXd::Zero(8);
    left.tail(4) << 1.3, -1.3, 1.3, -1.3;
    left.head(4).setConstant(0.6); // sqrt(0.36 - 0.25) / 2 = 0.166
    const auto of = [&](BalanceKind kind) {
        data.balance[1].kind = kind;
        return hand_made::problem_of(data, {}, Eigen::MatrixXd(8, 0), left);
    };
    const std::vector<double> m = misfits(of(BalanceKind::radar));
    EXPECT_NEAR(m[0], std::sqrt(0.11) / 2, 1e-12);
    EXPECT_NEAR(m[1], 0.6, 1e-12);
    for (const BalanceKind kind : {BalanceKind::radar, BalanceKind::current_torque, BalanceKind::current_voltage, BalanceKind::camera_x,
                                   BalanceKind::force, BalanceKind::torque})
        EXPECT_NEAR(worst_misfit(of(kind)), 0.6, 1e-12) << static_cast<int>(kind);
    for (const BalanceKind kind : {BalanceKind::accel, BalanceKind::yaw_rate, BalanceKind::camera_y, BalanceKind::camera_yaw})
        EXPECT_NEAR(worst_misfit(of(kind)), std::sqrt(0.11) / 2, 1e-12) << static_cast<int>(kind);
    left.setConstant(0.1); // less than noise, and of no signal
    EXPECT_EQ(worst_misfit(of(BalanceKind::radar)), 0);
    left.setConstant(2);
    for (double &y : data.balance[1].measured) y = 0;
    EXPECT_EQ(misfits(of(BalanceKind::radar))[1], 0);
}

} // namespace
} // namespace traction::lab
