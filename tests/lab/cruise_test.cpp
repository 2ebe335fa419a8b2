// Whole diagnoses of a drive of one manner (manner.h), a sixth of a second each: what may be named from one velocity.
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/decision/manner.h"
#include "tests/lab/consistent.h"
#include "tests/lab/four_wheels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace traction::lab {
namespace {

EffectUse use_of(const std::string &name, const std::string &key, double size, int wheel = -1) {
    EffectUse use;
    use.name = name, use.wheel = wheel;
    use.parameters[key].value = size, use.parameters[key].given = true;
    return use;
}

Diagnosis told(const EffectUse &hidden, bool cruise) {
    hand_made::FourWheels rover("", cruise);
    rover.hide({hidden});
    Diagnosis d = diagnose(rover.model, rover.data, {});
    expect_consistent(d, rover.model, rover.data);
    return d;
}

bool says(const Diagnosis &d, const std::string &words) {
    return std::any_of(d.messages.begin(), d.messages.end(), [&](const std::string &m) { return m.find(words) != std::string::npos; });
}

TEST(Cruise, is_of_one_manner_and_the_other_drive_is_not) {
    EXPECT_TRUE(is_of_one_manner(hand_made::FourWheels("", true).data));
    EXPECT_FALSE(is_of_one_manner(hand_made::FourWheels().data));
}

TEST(Cruise, of_which_nothing_is_hidden_names_nothing) {
    const hand_made::FourWheels rover("", true);
    const Diagnosis d = diagnose(rover.model, rover.data, {});
    EXPECT_EQ(d.kind, "nothing") << d.text;
}

// At one speed a drag and a rolling resistance are one force: of the class the number that the model states comes first.
TEST(Cruise, of_what_one_speed_cannot_tell_apart_names_the_number_that_the_model_states) {
    const Diagnosis d = told(use_of("body_drag", "force_N", 3), true);
    ASSERT_EQ(d.accepted.size(), 1U) << d.text;
    EXPECT_EQ(d.accepted[0].candidate.label(), "rolling_resistance") << d.text;
    EXPECT_NEAR(d.accepted[0].value[0], 3 / (6 * 9.81), 0.005); // 3 N of a weight of 59
    EXPECT_EQ(d.kind, "class");
    ASSERT_EQ(d.classes.size(), 1U);
    EXPECT_EQ(d.classes[0].members.front(), "rolling_resistance");
    EXPECT_EQ(std::count(d.classes[0].members.begin(), d.classes[0].members.end(), "body_drag"), 1);
    ASSERT_EQ(d.model.effects.size(), 1U);
    EXPECT_EQ(d.model.effects[0].name, "rolling_resistance");
    ASSERT_EQ(d.ladder.size(), 2U);
    EXPECT_EQ(d.ladder[1].label, "+ rolling_resistance");
    EXPECT_LT(d.ladder[1].heldout, 1.1);
}

// Another drive says what it says: of the class the one that explains the most of what is left out, be it a drag.
TEST(Cruise, is_what_puts_the_stated_number_first_and_no_other_drive) {
    const Diagnosis d = told(use_of("rolling_resistance", "coefficient", 0.09), false);
    ASSERT_EQ(d.classes.size(), 1U) << d.text;
    const std::vector<std::string> &members = d.classes[0].members;
    EXPECT_EQ(std::count(members.begin(), members.end(), "rolling_resistance"), 1);
    const auto gain = [&](const std::string &label) {
        return std::find_if(d.ranking.begin(), d.ranking.end(), [&](const CandidateResult &r) { return r.candidate.label() == label; })
            ->gain_squares;
    };
    for (const std::string &member : members) EXPECT_GE(gain(members.front()), gain(member)) << member;
    EXPECT_NE(members.front(), "rolling_resistance"); // hidden so that the drag happens to explain more
}

// What moves the rover must act on all wheels: else a note says with what it would have to be believed.
TEST(Cruise, believes_nothing_of_one_wheel_that_moves_the_rover) {
    const EffectUse hidden = use_of("wheel_radius", "change", 0.1, 2);
    const Diagnosis d = told(hidden, true), elsewhere = told(hidden, false);
    EXPECT_TRUE(std::any_of(elsewhere.accepted.begin(), elsewhere.accepted.end(), [](const CandidateResult &a) {
        return a.candidate.label() == "wheel_radius on wheel 2";
    })) << elsewhere.text;
    EXPECT_FALSE(says(elsewhere, "one manner"));
    for (const CandidateResult &a : d.accepted)
        EXPECT_TRUE(a.candidate.wheel < 0 || (a.candidate.touched & stage_motion) == 0) << a.candidate.label();
    EXPECT_TRUE(says(d, "wheel_radius on wheel 2 would explain a part, but only with one wheel unlike the others, and this drive has "
                        "one manner: not named"))
        << d.text;
}

// The ground that gets firmer along the way takes the numbers of the model far away; a refit of another law finds them a better place.
TEST(Cruise, begins_anew_where_a_refit_found_the_model_a_better_place) {
    const Diagnosis d = told(use_of("soil_gradient", "change_per_m", -0.2), true);
    EXPECT_EQ(d.kind, "named") << d.text; // with no shape beside it: nothing else is hidden
    EXPECT_EQ(d.effects, std::vector<std::string>{"soil_gradient"});
}

// What leaves the motion alone is seen in that wheel's own current.
TEST(Cruise, names_what_one_motor_shows_by_itself) {
    const Diagnosis d = told(use_of("coulomb_friction", "torque_Nm", 0.06, 2), true);
    ASSERT_FALSE(d.accepted.empty()) << d.text;
    bool found = d.accepted[0].candidate.label() == "coulomb_friction on wheel 2";
    for (const ConfoundedClass &c : d.classes)
        found = found || std::count(c.members.begin(), c.members.end(), "coulomb_friction on wheel 2");
    EXPECT_TRUE(found) << d.text;
}

} // namespace
} // namespace traction::lab
