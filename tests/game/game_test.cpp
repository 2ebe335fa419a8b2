// The game from the first look to the seal: what is told when, what is scored, what happens to a folder that is not as it was left.
#include "host_tools/check/check.h"
#include "host_tools/game/game.h"
#include "host_tools/log/log.h"
#include "host_tools/log/read.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include <unistd.h>

namespace traction::game {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path &path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

// One game for all tests: each plays a copy.
class Game : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        fs::remove_all(home());
        first_ = new Turn(start({.root = ".", .folder = home().string(), .seed = 4, .duration_s = 45}));
        seal_ = new nlohmann::json(nlohmann::json::parse(content(home() / "sealed.json")));
    }
    static void TearDownTestSuite() {
        fs::remove_all(home());
        delete first_;
        delete seal_;
    }
    static fs::path home() { return fs::temp_directory_path() / ("traction_game_" + std::to_string(::getpid())); }
    // A copy that a test may play.
    static std::string copy(const std::string &name) {
        const fs::path to = home() / name;
        fs::create_directories(to);
        for (const char *file : {"run.csv", "baseline.toml", "model.toml", "sealed.json", "game.json"})
            fs::copy_file(home() / file, to / file, fs::copy_options::overwrite_existing);
        return to.string();
    }
    static nlohmann::json state(const std::string &folder) { return nlohmann::json::parse(content(fs::path(folder) / "game.json")); }
    static std::string hidden() { return (*seal_)["effects"][0]["name"]; }
    static int wheel() { return (*seal_)["effects"][0].value("wheel", -1); }
    static Turn *first_;
    static nlohmann::json *seal_;
};
Turn *Game::first_ = nullptr;
nlohmann::json *Game::seal_ = nullptr;

void expect_error(const std::function<void()> &act, const std::string &part) {
    try {
        act();
        FAIL() << "no error about " << part;
    } catch (const GameError &error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST_F(Game, the_right_guess_at_once_scores_full_and_the_seal_tells_it) {
    const std::string folder = copy("right");
    const Turn kept = guess(folder, hidden(), wheel(), true);
    EXPECT_TRUE(kept.json["helps"]) << kept.text;
    ASSERT_EQ(kept.json["ladder"].size(), 2U);
    EXPECT_LT(kept.json["ladder"][1]["heldout"], kept.json["ladder"][0]["heldout"]);
    const Turn end = open(folder);
    EXPECT_EQ(end.json["wrong_guesses"], 0);
    EXPECT_TRUE(end.json["named"]);
    EXPECT_NEAR(end.json["error_over_floor"].get<double>(), 1, 0.02);
    EXPECT_GE(end.json["points"].get<int>(), 98);
    EXPECT_NE(end.text.find(hidden()), std::string::npos);
    expect_error([&] { guess(folder, "grade", -1, false); }, "over");
    expect_error([&] { open(folder); }, "open already");
}

TEST_F(Game, nothing_tells_the_effect_before_the_seal_is_open) {
    const std::string folder = copy("silent");
    const Turn tried = guess(folder, hidden() == "grade" ? "body_drag" : "grade", -1, false);
    const std::string listed = hidden(); // the list of what may be hidden names every effect alike
    for (const std::string &text : {tried.text, tried.json.dump(), look(folder).text, content(fs::path(folder) / "game.json")})
        EXPECT_EQ(text.find(listed), std::string::npos) << text;
    EXPECT_EQ(content(fs::path(folder) / "model.toml"), content(fs::path(folder) / "baseline.toml"));
    EXPECT_EQ(first_->json.dump().find(listed), std::string::npos);
    std::string header = content(fs::path(folder) / "run.csv").substr(0, 4000);
    EXPECT_EQ(header.find(listed), std::string::npos);
}

TEST_F(Game, wrong_guesses_cost_and_leave_the_model_alone_unless_they_are_kept) {
    const std::string folder = copy("wrong"), before = content(fs::path(folder) / "model.toml");
    const std::string other = hidden() == "body_drag" ? "grade" : "body_drag";
    guess(folder, other, -1, false);
    guess(folder, other, -1, false); // the same twice is one guess
    EXPECT_EQ(content(fs::path(folder) / "model.toml"), before);
    EXPECT_EQ(look(folder).json["guesses"].size(), 1U); // a game that was left is taken up
    expect_error([&] { guess(folder, "gremlin", -1, false); }, "no effect");
    EXPECT_EQ(state(folder)["guesses"].size(), 1U); // a slip of the pen costs nothing
    const Turn end = open(folder);
    EXPECT_EQ(end.json["wrong_guesses"], 1);
    EXPECT_FALSE(end.json["named"]);
    EXPECT_LE(end.json["points"].get<int>(), 0);
}

TEST_F(Game, the_same_seed_hides_the_same_thing) {
    const fs::path again = home() / "again";
    start({.root = ".", .folder = again.string(), .seed = 4, .duration_s = 45});
    EXPECT_EQ(content(again / "sealed.json"), content(home() / "sealed.json"));
    EXPECT_EQ(content(again / "run.csv"), content(home() / "run.csv"));
    expect_error([&] { start({.root = ".", .folder = again.string(), .seed = 5, .duration_s = 45}); }, "--replace");
    expect_error([&] { start({.root = ".", .folder = (home() / "moon").string(), .soil = "moon", .seed = 4, .duration_s = 45}); },
                 "sand, gravel or concrete");
    EXPECT_FALSE(fs::exists(home() / "moon")); // nothing half made
}

// A rover that drifts in its bends is followed sideways, from the first turn to the last: of a turn that was not, its own answer was
// refused as changing nothing. What a sideways grip alone turns is not followed.
TEST_F(Game, of_a_rover_that_drifts_takes_the_law_of_its_bends) {
    for (const auto &[seed, effect, motion, share] :
         {std::tuple(15U, "mass_offset_y", "planar", 0.9), std::tuple(617373473U, "lateral_scrub", "longitudinal", 0.5)}) {
        const std::string folder = (home() / effect).string();
        const Turn begun = start({.root = ".", .folder = folder, .seed = seed, .duration_s = 120});
        ASSERT_EQ(nlohmann::json::parse(content(fs::path(folder) / "sealed.json"))["effects"][0]["name"], effect);
        EXPECT_NE(content(fs::path(folder) / "baseline.toml").find(std::string("motion = \"") + motion + '"'), std::string::npos) << effect;
        const Turn tried = guess(folder, effect, -1, false);
        EXPECT_TRUE(tried.json["helps"]) << tried.text;
        const double before = begun.json["ladder"][0]["heldout"];
        EXPECT_NEAR(tried.json["guesses"][0]["before"], before, 0.005 * before); // one optimum
        EXPECT_LT(tried.json["guesses"][0]["after"], share * before);
    }
}

// What the check refuses in a game's log may be what was hidden: a radar that tells of what was long ago.
TEST_F(Game, a_log_that_the_check_refuses_is_played_to_its_end) {
    const std::string folder = copy("late"), run = folder + "/run.csv";
    log::Log log = log::read_csv(run);
    for (log::Signal &s : log.signals)
        if (s.name == "radar.speed_m_s")
            for (double &t : s.t_s) t += 0.9;
    log::write_csv(log, run);
    const check::Report report = check::check(log, {}, {});
    ASSERT_FALSE(report.passed());
    EXPECT_NO_THROW(guess(folder, hidden(), wheel(), true));
    EXPECT_NO_THROW(open(folder));
}

TEST_F(Game, a_folder_that_was_tampered_with_is_told) {
    expect_error([] { look("/nonexistent/game"); }, "no game");
    const std::string folder = copy("torn");
    std::ofstream(fs::path(folder) / "game.json") << "{\"schema\": ";
    expect_error([&] { look(folder); }, "game.json");
    std::ofstream(fs::path(folder) / "game.json") << "{}";
    expect_error([&] { look(folder); }, "is not the state of a game");
    const std::string opened = copy("opened");
    std::ofstream(fs::path(opened) / "sealed.json") << "{}";
    expect_error([&] { open(opened); }, "sealed.json");
    fs::remove(fs::path(opened) / "sealed.json");
    EXPECT_NO_THROW(look(opened)); // playing needs no seal
    expect_error([&] { open(opened); }, "sealed.json");
    EXPECT_FALSE(state(opened)["opened"]); // and the game goes on
}

TEST(Points, are_those_of_the_rules) {
    const Played perfect{.named = true, .wheel_right = true, .error_before = 4, .error_after = 2, .floor = 2, .wrong_guesses = 0};
    EXPECT_EQ(points(perfect), 100);
    Played p = perfect;
    p.wrong_guesses = 3;
    EXPECT_EQ(points(p), 70);
    p = perfect, p.wheel_right = false;
    EXPECT_EQ(points(p), 70);
    p = perfect, p.named = false; // as good as the truth by another name
    EXPECT_EQ(points(p), 70);
    p = perfect, p.error_after = 3; // half the way
    EXPECT_EQ(points(p), 80);
    p = {.named = false, .wheel_right = false, .error_before = 4, .error_after = 4, .floor = 2, .wrong_guesses = 9};
    EXPECT_EQ(points(p), 0);
    p = {.named = true,
         .wheel_right = true,
         .error_before = 2,
         .error_after = 2,
         .floor = 2,
         .wrong_guesses = 0}; // nothing to gain in this log
    EXPECT_EQ(points(p), 100);
    p.named = false;
    EXPECT_EQ(points(p), 0);
}

} // namespace
} // namespace traction::game
