// The campaign's judge: Wilson's interval against published values, and what counts as right, silent, flagged.
#include "host_tools/bench_lab/score.h"

#include <gtest/gtest.h>
#include <stdexcept>

using namespace traction::bench_lab;
using nlohmann::json;

namespace {

json seal(const std::string &category, const std::string &effect, int wheel = -1, const std::string &variable = "") {
    json one = {{"schema", "traction.seal/1"}, {"category", category}, {"soil", "sand"}, {"seed", 1}, {"effects", json::array()}};
    if (!effect.empty())
        one["effects"].push_back({{"name", effect},
                                  {"wheel", wheel},
                                  {"outside", category == "outside"},
                                  {"variable", variable},
                                  {"parameters", {{"size", 2.0}}}});
    return one;
}

json answer(const std::string &kind, const std::vector<std::string> &effects) {
    json one = {{"verdict", {{"kind", kind}, {"effects", effects}}},
                {"candidates", json::array()},
                {"accepted", json::array()},
                {"classes", json::array()}};
    for (const std::string &effect : effects) {
        const std::string plain = effect.substr(0, effect.find(' '));
        one["candidates"].push_back({{"effect", plain},
                                     {"wheel", plain == effect ? -1 : effect.back() - '0'},
                                     {"verdict", "named"},
                                     {"detectability", 10.0},
                                     {"parameters", {{"size", {{"value", 2.1}, {"low", 1.9}, {"high", 2.3}}}}}});
        one["accepted"].push_back(one["candidates"].back());
    }
    return one;
}

const Line &line(const Score &score, const std::string &key) {
    for (const Line &one : score.lines)
        if (one.key == key) return one;
    throw std::out_of_range(key);
}

} // namespace

TEST(Share, interval_is_wilsons) {
    Share share{81, 263}; // Newcombe, Statistics in Medicine 17 (1998) 857-872, table I, method 3: 0.2553 to 0.3662
    EXPECT_NEAR(share.interval().first, 0.2553, 5e-5); // four digits printed
    EXPECT_NEAR(share.interval().second, 0.3662, 5e-5);
    Share none{0, 20}; // the same table: 0 to 0.1611
    EXPECT_DOUBLE_EQ(none.interval().first, 0);
    EXPECT_NEAR(none.interval().second, 0.1611, 5e-5);
}

TEST(Judge, counts_a_right_name_its_wheel_and_its_interval) {
    const Score score = judge({{"a", seal("one", "wiring_resistance", 2), answer("named", {"wiring_resistance on wheel 2"}), 0.5}});
    EXPECT_EQ(line(score, "right_when_naming").value, 1);
    EXPECT_EQ(line(score, "wheel_right").value, 1);
    EXPECT_EQ(line(score, "coverage").value, 1);
    EXPECT_EQ(line(score, "false_discoveries").value, 0);
}

TEST(Judge, an_interval_counts_as_the_joint_fit_states_it_for_the_hidden_wheel) {
    const json hidden = seal("one", "wiring_resistance", 2);
    json said = answer("named", {"wiring_resistance on wheel 2"});
    said["accepted"][0]["parameters"]["size"] = {{"value", 2.5}, {"low", 2.2}, {"high", 2.8}}; // the candidate alone would hold 2.0
    EXPECT_EQ(line(judge({{"a", hidden, said, 0.5}}), "coverage").count, 1);
    EXPECT_EQ(line(judge({{"a", hidden, said, 0.5}}), "coverage").value, 0);
    EXPECT_EQ(line(judge({{"a", hidden, answer("named", {"wiring_resistance on wheel 1"}), 0.5}}), "coverage").count, 0);
}

TEST(Judge, counts_a_wrong_name_and_shows_it_in_the_confusion) {
    const Score score = judge({{"a", seal("one", "slip_sinkage"), answer("named", {"mesh_loss"}), 0.5}});
    EXPECT_EQ(line(score, "right_when_naming").value, 0);
    EXPECT_EQ(line(score, "false_discoveries").value, 1);
    EXPECT_EQ(score.confusion.at("slip_sinkage").at("mesh_loss"), 1);
}

TEST(Judge, accepts_a_class_that_holds_the_truth_once) {
    json said = answer("class", {"mesh_loss", "slip_sinkage"});
    said["classes"].push_back({{"members", {"mesh_loss", "slip_sinkage"}}, {"separate_by", "three wheels push, one drags"}});
    const Score score = judge({{"a", seal("one", "slip_sinkage"), said, 0.5}});
    EXPECT_EQ(line(score, "right_when_naming").value, 1);
    EXPECT_EQ(line(score, "false_discoveries").value, 0);
    EXPECT_EQ(line(score, "false_discoveries").count, 1); // one discovery, not two
}

TEST(Judge, a_clean_log_must_stay_silent) {
    const Score named = judge({{"a", seal("clean", ""), answer("named", {"grade"}), 0.5}});
    EXPECT_EQ(line(named, "clean_named").value, 1);
    const Score wrong = judge({{"a", seal("clean", ""), answer("wrong_model", {}), 0.5}});
    EXPECT_EQ(line(wrong, "clean_named").value, 1); // a false alarm, too
    const Score silent = judge({{"a", seal("clean", ""), answer("nothing", {}), 0.5}});
    EXPECT_EQ(line(silent, "clean_named").value, 0);
}

TEST(Judge, outside_the_catalogue_a_bare_name_is_the_worst_answer) {
    const Score bare = judge({{"a", seal("outside", "friction_squared", -1, "speed"), answer("named", {"viscous_friction"}), 0.5}});
    EXPECT_EQ(line(bare, "outside_misnamed").value, 1);
    EXPECT_EQ(line(bare, "outside_flagged").value, 0);
    json partial = answer("partial", {"viscous_friction"});
    partial["unknown"] = {{"variable", "wheel speed"}, {"balance", "wheel_torque"}};
    const Score flagged = judge({{"a", seal("outside", "friction_squared", -1, "speed"), partial, 0.5}});
    EXPECT_EQ(line(flagged, "outside_misnamed").value, 0);
    EXPECT_EQ(line(flagged, "outside_flagged").value, 1);
    EXPECT_EQ(line(flagged, "outside_variable").value, 1);
}

TEST(Judge, a_silent_log_whose_first_candidate_is_right_does_not_count_as_named) {
    json silent = answer("nothing", {});
    silent["candidates"].push_back({{"effect", "grade"}, {"wheel", -1}, {"detectability", 3.0}});
    silent["detectability_with_truth"] = 3.0;
    const Score score = judge({{"a", seal("one", "grade"), silent, 0.5}, {"b", seal("one", "grade"), answer("named", {"grade"}), 0.5}});
    EXPECT_EQ(line(score, "named_first_detectable").value, 0.5);
    EXPECT_EQ(line(score, "silent_detectable").value, 0.5);
    EXPECT_EQ(line(score, "right_first_detectable").value, 1);
}

TEST(Judge, an_effect_that_no_candidate_stands_for_is_judged_visible_by_the_fit_that_was_given_the_truth) {
    json silent = answer("nothing", {});
    silent["detectability_with_truth"] = 5.0;
    EXPECT_EQ(line(judge({{"a", seal("one", "grade"), silent, 0.5}}), "named_first_detectable").count, 1);
    silent["detectability_with_truth"] = 1.0;
    EXPECT_EQ(line(judge({{"a", seal("one", "grade"), silent, 0.5}}), "named_first_detectable").count, 0);
}

TEST(Judge, a_law_that_the_catalogue_has_learnt_may_be_called_by_its_name) {
    json hidden = seal("outside", "water_drag", -1, "speed");
    hidden["effects"][0]["law"] = "drag_squared|rolling_squared";
    const Score named = judge({{"a", hidden, answer("named", {"drag_squared"}), 0.5}});
    EXPECT_EQ(line(named, "outside_flagged").value, 1);
    EXPECT_EQ(line(named, "outside_variable").value, 1);
    EXPECT_EQ(line(named, "outside_misnamed").value, 0);
    EXPECT_EQ(line(named, "false_discoveries").value, 0);
    EXPECT_EQ(line(judge({{"a", hidden, answer("named", {"drag"}), 0.5}}), "outside_misnamed").value, 1); // the whole name counts
}

TEST(Judge, what_is_true_of_the_sensors_is_no_false_name_and_no_answer) {
    json clean = seal("clean", "");
    EXPECT_EQ(line(judge({{"a", clean, answer("named", {"accel_delay"}), 0.5}}), "clean_named").value, 1);
    clean["chain"] = {{"accel_late_s", 0.02}};
    EXPECT_EQ(line(judge({{"a", clean, answer("named", {"accel_delay"}), 0.5}}), "clean_named").value, 0);
    json hidden = seal("one", "accel_lag"); // a late accelerometer in which more of it is hidden: that is the question
    hidden["chain"] = clean["chain"];
    EXPECT_EQ(line(judge({{"a", hidden, answer("named", {"accel_lag"}), 0.5}}), "right_when_naming").value, 1);
    EXPECT_EQ(line(judge({{"a", hidden, answer("named", {"accel_delay"}), 0.5}}), "right_when_naming").count, 0);
}

TEST(Judge, intervals_that_always_hold_the_truth_are_too_wide) {
    std::vector<Judged> logs;
    for (int i = 0; i < 20; ++i) logs.push_back({"a", seal("one", "grade"), answer("named", {"grade"}), 0.5});
    EXPECT_EQ(line(judge(logs), "coverage").value, 1);
    EXPECT_FALSE(line(judge(logs), "coverage").met);
}

TEST(Judge, tells_sizes_and_sensor_chains_apart_and_seconds_by_two_minutes_of_log) {
    json small = seal("clean", ""), large = seal("clean", "");
    small["size"] = "small", small["chain"] = json::object(), small["duration_s"] = 60;
    large["size"] = "large", large["chain"] = {{"angle_only", true}}, large["duration_s"] = 240;
    const Score score = judge({{"a", small, answer("nothing", {}), 1}, {"b", large, answer("named", {"grade"}), 2}});
    EXPECT_EQ(score.by_group.count("small") + score.by_group.count("large") + score.by_group.count("chain 1") +
                  score.by_group.count("chain 2"),
              4U);
    EXPECT_NE(table_text(score).find("chain 2"), std::string::npos);
    EXPECT_EQ(line(score, "seconds_median").value, 1.5); // 2 s for two minutes and 1 s for two minutes
}

TEST(Judge, a_lab_that_fails_is_counted) {
    const Score score = judge({{"a", seal("one", "grade"), {{"error", "no wheel speed"}}, 0.1}});
    EXPECT_EQ(score.failures, 1);
    EXPECT_EQ(line(score, "right_first").value, 0);
}
