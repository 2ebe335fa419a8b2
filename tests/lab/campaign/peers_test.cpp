// Peers beside the lab: judged by the same measures, and handed a regression that is the lab's own linear step.
#include "host_tools/bench_lab/answer.h"
#include "host_tools/bench_lab/peers.h"
#include "host_tools/bench_lab/regressors.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/log/log.h"
#include "tests/lab/generator/generator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

using namespace traction;
using nlohmann::json;

namespace {

bench_lab::Judged one(const std::string &category, const std::string &hidden, const std::vector<std::string> &said, double seconds) {
    bench_lab::Judged judged;
    judged.seal = {{"category", category}, {"effects", json::array()}};
    if (!hidden.empty()) judged.seal["effects"].push_back({{"name", hidden}, {"wheel", -1}, {"parameters", json::object()}});
    judged.result = {{"verdict", {{"kind", said.empty() ? "nothing" : "named"}, {"effects", said}}}};
    judged.seconds = seconds;
    return judged;
}

} // namespace

TEST(Peers, stand_beside_the_lab_with_its_seconds_and_are_judged_alike) {
    const std::vector<bench_lab::Judged> logs = {one("one", "grade", {"grade"}, 2), one("clean", "", {}, 3),
                                                 one("one", "mesh_loss", {"grade"}, 4)};
    const json answers = {
        {"peers", {{"P", {{"answers", {{"grade", "mesh_loss"}, {"grade"}, {"mesh_loss"}}}, {"seconds", {5, 7, 6}}, {"use", "as it is"}}}}}};
    const json rows = bench_lab::judge_peers(answers, logs);
    EXPECT_EQ(rows["P"]["right_first"]["value"], 1.0);
    EXPECT_EQ(rows["P"]["exact_model"]["value"], 0.5); // a term too many on the first
    EXPECT_EQ(rows["P"]["clean_named"]["value"], 1.0);
    EXPECT_EQ(rows["P"]["seconds_median"], 6.0);
    EXPECT_EQ(rows["lab"]["right_first"]["value"], 0.5);
    EXPECT_EQ(rows["lab"]["exact_model"]["value"], 0.5);
    EXPECT_EQ(rows["lab"]["clean_named"]["value"], 0.0);
    EXPECT_EQ(rows["lab"]["seconds_median"], 3.0);
    const std::string text = bench_lab::peers_text(rows);
    EXPECT_NE(text.find("6.00"), std::string::npos);
    EXPECT_NE(text.find("3.00"), std::string::npos);
}

// Half an ohm in one wheel's lead, ten times the size of interest: of all four leads, that wheel's column must fit the residual best.
TEST(Peers, are_handed_a_regression_in_which_the_hidden_effect_shows) {
    const std::string file = (std::filesystem::temp_directory_path() / ("traction_regressors_" + std::to_string(getpid()))).string();
    generator::GeneratorConfig config;
    config.seed = 78;
    config.duration_s = 40;
    config.hidden = {generator::parse_setting("wiring_resistance:resistance_ohm=0.5,wheel=2")};
    const lab::Model model = lab::read_model(bench_lab::campaign_model("independent", "sand"));
    bench_lab::write_regressors(model, lab::make_dataset(model, generator::generate(config)), file);

    std::ifstream in(file, std::ios::binary);
    std::string line;
    std::getline(in, line);
    const json head = json::parse(line);
    const std::size_t rows = head.at("rows");
    const auto column = [&](std::size_t index) {
        std::vector<float> values(rows);
        in.seekg(static_cast<std::streamoff>(line.size() + 1 + index * rows * sizeof(float)));
        in.read(reinterpret_cast<char *>(values.data()), static_cast<std::streamsize>(rows * sizeof(float)));
        EXPECT_TRUE(in.good());
        return std::vector<double>(values.begin(), values.end());
    };
    const auto cosine = [&](const std::vector<double> &a, const std::vector<double> &b) {
        double ab = 0, aa = 0, bb = 0;
        for (std::size_t i = 0; i < rows; ++i) ab += a[i] * b[i], aa += a[i] * a[i], bb += b[i] * b[i];
        return ab / std::sqrt(aa * bb);
    };
    const std::vector<double> residual = column(2);
    int best_wheel = -1;
    double best = 0;
    for (std::size_t k = 0; k < head.at("columns").size(); ++k) {
        const json &about = head.at("columns").at(k);
        if (about.value("effect", "") != "wiring_resistance" || about.at("wheel") == -1) continue;
        const double fits = cosine(residual, column(3 + k));
        if (std::fabs(fits) > std::fabs(best)) best = fits, best_wheel = about.at("wheel");
    }
    EXPECT_EQ(best_wheel, 2);
    EXPECT_GT(best, 0); // more resistance, not less
    std::filesystem::remove(file);
}
