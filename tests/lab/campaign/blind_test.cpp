// The lab answers from the log alone: with the seal absent it gives the same answer as with the seal beside the log.
#include "host_tools/bench_lab/answer.h"
#include "host_tools/log/log.h"
#include "tests/lab/generator/generator.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

using namespace traction;

TEST(Lab, answers_the_same_with_the_seal_absent) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("traction_blind_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder / "seals");
    generator::GeneratorConfig config;
    config.seed = 77;
    config.duration_s = 40;
    config.hidden = {generator::parse_setting("current_gain:change=0.25")};
    const std::string file = (folder / "log_77.csv").string(), seal = (folder / "seals" / "seal_77.json").string();
    log::write_csv(generator::generate(config), file);
    const std::string model = bench_lab::campaign_model("independent", "sand");
    std::ofstream(seal) << R"({"effects": [{"name": "backlash"}]})"; // a seal that lies: who reads it is found out
    nlohmann::json with = bench_lab::ask_lab(file, model);
    std::filesystem::remove_all(folder / "seals");
    nlohmann::json without = bench_lab::ask_lab(file, model);
    with.erase("seconds");
    without.erase("seconds");
    EXPECT_EQ(with, without);
    ASSERT_FALSE(without["candidates"].empty());
    EXPECT_EQ(without["candidates"][0]["effect"], "current_gain"); // and it answers: 25 % is ten times the size of interest
    std::filesystem::remove_all(folder);
}
