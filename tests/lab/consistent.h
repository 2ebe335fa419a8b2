// consistent.h - what holds of every diagnosis, whatever it found: its names, its model, its ladder and its errors tell of one fit.
#pragma once

#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/fit/heldout.h"
#include "host_tools/lab/fit/ladder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace traction::lab {

inline void expect_consistent(const Diagnosis &d, const Model &stated, const Dataset &data) {
    SCOPED_TRACE(d.text);
    ASSERT_FALSE(d.ladder.empty());
    EXPECT_EQ(d.ladder[0].label, "baseline");
    ASSERT_TRUE(d.stated_fit);
    if (d.accepted.size() > 0) { // beside names the first rung stays what the stated model leaves
        EXPECT_NEAR(d.ladder[0].train, overall_error(*d.stated_fit), 0.005 * d.ladder[0].train);
    }
    if (d.kind == "wrong_model") { // nothing is named, and the model is the stated one
        EXPECT_TRUE(d.accepted.empty() && d.effects.empty() && d.classes.empty() && !d.unknown);
        EXPECT_EQ(d.model.effects.size(), stated.effects.size());
        return;
    }
    ASSERT_EQ(d.ladder.size(), d.accepted.size() + 1);
    ASSERT_EQ(d.model.effects.size(), stated.effects.size() + d.accepted.size());
    EXPECT_EQ(d.effects.size(), d.accepted.size());
    for (std::size_t i = 0; i < d.accepted.size(); ++i) {
        const CandidateResult &a = d.accepted[i];
        EXPECT_EQ(d.ladder[i + 1].label, "+ " + a.candidate.label());
        EXPECT_EQ(std::count(d.effects.begin(), d.effects.end(), a.candidate.label()), 1) << a.candidate.label();
        EXPECT_TRUE(std::any_of(d.model.effects.begin(), d.model.effects.end(), [&](const EffectUse &use) {
            return use.name == a.candidate.effect && use.wheel == a.candidate.wheel;
        })) << a.candidate.label();
        for (std::size_t j = 0; j < a.value.size(); ++j) {
            EXPECT_LE(a.low[j], a.value[j]);
            EXPECT_GE(a.high[j], a.value[j]);
        }
    }
    for (const ConfoundedClass &c : d.classes) { // of a class the first is what is named, and none of the others is
        EXPECT_EQ(std::count(d.effects.begin(), d.effects.end(), c.members.front()), 1) << c.members.front();
        EXPECT_GT(c.members.size(), 1U);
        for (std::size_t i = 1; i < c.members.size(); ++i)
            EXPECT_EQ(std::count(d.effects.begin(), d.effects.end(), c.members[i]), 0) << c.members[i];
    }
    for (const std::string &near : d.nearest) EXPECT_EQ(std::count(d.effects.begin(), d.effects.end(), near), 0) << near;
    EXPECT_EQ(d.kind, d.accepted.empty()  ? (d.unknown ? "unknown" : "nothing")
                      : d.unknown         ? "partial"
                      : d.classes.empty() ? "named"
                                          : "class");
    // what is told is what a fit of the model finds: within half a per cent
    const Problem anew = fitted_problem(d.model, data);
    EXPECT_NEAR(d.ladder.back().train, overall_error(anew), 0.005 * overall_error(anew));
    EXPECT_NEAR(d.ladder.back().heldout, held_out(anew).error, 0.01 * overall_error(anew));
    std::vector<std::string> limits, told;
    for (const Limit &limit : limits_of(anew)) limits.push_back(limit.parameter);
    for (const Limit &limit : d.limits) told.push_back(limit.parameter);
    EXPECT_EQ(told, limits);
    if (d.model_fit) {
        EXPECT_NEAR(overall_error(*d.model_fit), overall_error(anew), 1e-9);
    }
}

} // namespace traction::lab
