// Progress in words, and what a mistyped word is taken for.
#include "host_tools/cli/progress.h"
#include "host_tools/suggest/suggest.h"

#include <gtest/gtest.h>

#include <string>

namespace traction::cli {
namespace {

TEST(Progress, never_says_more_than_all_nor_a_time_below_zero) {
    for (const long total : {1L, 10L, 400L})
        for (long done = 0; done <= 2 * total; ++done) {
            const std::string text = Progress::text("x", done, total, 7.0);
            EXPECT_EQ(text.find('-'), std::string::npos) << text;                         // "-2 s left"
            EXPECT_TRUE(done <= total || text.find(" of ") == std::string::npos) << text; // "527 of 400"
        }
    EXPECT_EQ(Progress::text("drive", 3, 10, 3.0), "drive: 3 of 10, about 7 s left");
    EXPECT_EQ(Progress::text("drive", 12, 10, 5.0), "drive: 12 done, 5 s so far");
    EXPECT_EQ(Progress::text("drive", 0, 10, 0.0), "drive: 0 of 10");
}

TEST(Suggest, nearest_word_is_offered_and_a_far_one_is_not) {
    const std::vector<std::string> verbs = {"simulate", "diagnose", "compare", "fit"};
    EXPECT_EQ(did_you_mean("simulte", verbs), "; did you mean 'simulate'?");
    EXPECT_EQ(did_you_mean("sim", verbs), "; did you mean 'simulate'?"); // cut short
    EXPECT_EQ(did_you_mean("fti", verbs), "; did you mean 'fit'?");
    EXPECT_EQ(did_you_mean("zzzzzz", verbs), "");
    EXPECT_EQ(did_you_mean("x", verbs), "");
    EXPECT_EQ(did_you_mean("", verbs), "");
    EXPECT_EQ(did_you_mean("fti", verbs, "traction --help"), "; did you mean 'fit'? `traction --help` lists all");
    EXPECT_EQ(did_you_mean("zzzzzz", verbs, "traction --help"), "; `traction --help` lists all");
    EXPECT_EQ(distance("ab", "ba"), 1U);
    EXPECT_EQ(distance("kitten", "sitting"), 3U);
}

} // namespace
} // namespace traction::cli
