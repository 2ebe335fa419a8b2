// A log's row: the seal is opened after the answer, and the table made of rows is the table made of the logs.
#include "host_tools/bench_lab/row.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

using namespace traction::bench_lab;
using nlohmann::json;

namespace {

Judged judged(const std::string &category, const std::string &hidden, const std::string &named, double seconds) {
    Judged one;
    one.log = "log_" + hidden + ".csv";
    one.seal = {{"category", category}, {"soil", "gravel"},   {"seed", 7},
                {"size", "large"},      {"duration_s", 60.0}, {"effects", json::array()}};
    if (!hidden.empty()) one.seal["effects"].push_back({{"name", hidden}, {"wheel", 2}, {"parameters", {{"size", 2.0}}}});
    one.result = {{"verdict", {{"kind", "named"}, {"text", "said"}, {"effects", json::array()}}}, {"candidates", json::array()}};
    if (!named.empty()) {
        one.result["verdict"]["effects"].push_back(named);
        one.result["candidates"].push_back({{"effect", named}, {"wheel", 2}, {"detectability", 9.0}});
        one.result["accepted"] = {
            {{"effect", named}, {"wheel", 2}, {"parameters", {{"size", {{"value", 2.1}, {"low", 1.9}, {"high", 2.3}}}}}}};
    }
    one.result["ladder"] = {{{"train", 3.0}, {"heldout", 3.25}}, {{"train", 1.1}, {"heldout", 1.3}}};
    one.result["floor_with_truth"] = 1.0;
    one.result["detectability_with_truth"] = 4.0 / 3;
    one.seconds = seconds;
    return one;
}

std::vector<Judged> sample() {
    std::vector<Judged> logs = {judged("one", "backlash", "backlash", 0.7), judged("one", "mesh_loss", "grade", 1.0 / 3),
                                judged("clean", "", "", 0.1), judged("two", "mesh_loss", "mesh_loss", 2)};
    logs[1].result["detectability_with_truth"] = 5.0;
    logs.push_back(logs[0]);
    logs.back().result = {{"error", "no wheel speed"}};
    return logs;
}

} // namespace

TEST(Row, makes_the_table_that_the_logs_make) {
    const std::vector<Judged> logs = sample();
    std::stringstream lines;
    for (const Judged &one : logs) lines << row_json(one).dump() << '\n';
    const Score direct = judge(logs), rows = score_of(read_rows(lines));
    EXPECT_EQ(table_text(rows), table_text(direct));
    EXPECT_EQ(table_json(rows), table_json(direct));
    EXPECT_EQ(rows.failures, 1);
    for (const Line &line : rows.lines)
        if (line.key == "error_lag_p95") {
            EXPECT_DOUBLE_EQ(line.value, 1.1); // backlash's: 1.1 left, 1.0 with the truth
        }
}

TEST(Row, tells_what_was_hidden_and_what_was_said) {
    const json row = row_json(sample()[0]);
    EXPECT_EQ(row["hidden"][0]["name"], "backlash");
    EXPECT_EQ(row["verdict"], "named");
    EXPECT_EQ(row["intervals"][0]["parameters"]["size"]["high"], 2.3);
    EXPECT_EQ(row["error_before"], 3.25);
    EXPECT_EQ(row["error_after"], 1.3);
    EXPECT_EQ(row["error"], nullptr);
    EXPECT_FALSE(row["judged"].contains("seconds")); // the one thing that is another each time
    EXPECT_EQ(row_json(sample()[4])["error"], "no wheel speed");
}

TEST(Row, is_refused_by_its_line_where_it_is_none) {
    std::stringstream lines;
    lines << row_json(sample()[0]).dump() << "\n{\"judged\": 1}\n";
    try {
        read_rows(lines);
        FAIL() << "it was read";
    } catch (const std::runtime_error &error) {
        EXPECT_EQ(std::string(error.what()).find("line 2 is no row of this bench"), 0U) << error.what();
    }
}

// Between the last answer and the opening of the first seal, every seal is exchanged for one that hides something else: the judge must
// read the new one, and the answers must be those of a run whose seals were left alone.
TEST(Row, opens_the_seal_after_the_answer) {
    const auto run = [](bool exchange) {
        CampaignOptions options;
        options.logs = options.jobs = 1;
        options.seed = 1000;
        options.duration_s = 20;
        options.lab_generate = TRACTION_LAB_GENERATE;
        options.folder = (std::filesystem::temp_directory_path() / ("traction_row_" + std::to_string(getpid()))).string();
        std::vector<Judged> logs =
            run_blind(options,
                      [&](const std::vector<SealedLog> &sealed) {
                          ASSERT_FALSE(sealed[0].result.at("candidates").empty());
                          if (!exchange) return;
                          std::ofstream(sealed[0].seal)
                              << R"({"category": "one", "seed": 1, "effects": [{"name": "soil_patch", "wheel": -1, "parameters": {}}]})";
                      });
        std::filesystem::remove_all(options.folder);
        return logs.front();
    };
    Judged plain = run(false), exchanged = run(true);
    EXPECT_NE(plain.seal["effects"][0]["name"], "soil_patch");
    EXPECT_EQ(exchanged.seal["effects"][0]["name"], "soil_patch");
    for (const char *judges : {"seconds", "floor_with_truth", "detectability_with_truth"}) // these are the judge's and the clock's
        plain.result.erase(judges), exchanged.result.erase(judges);
    EXPECT_EQ(plain.result, exchanged.result);
}
