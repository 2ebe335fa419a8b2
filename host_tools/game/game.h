// game.h - the sealed-envelope game: a log with a hidden effect, a player who guesses, fits and watches the error, and a seal at the end.
//
// A game is a folder: run.csv (the log), baseline.toml and model.toml (what the player knew and knows), sealed.json (what was hidden),
// game.json (the state, schema "traction.game/1", written last: a folder without it is no game). Every action reads the folder, does one
// thing and writes the state anew, so a game can be left and taken up again. The seal is read by open() and by nothing else; the lab never
// sees it.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace traction::game {

// A mistake told once: file or option, what is wrong, the mend.
struct GameError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct NewGame {
    std::string root; // where scenarios/ and models/ lie
    std::string folder;
    std::string soil = "sand"; // sand, gravel, concrete
    std::uint64_t seed = 1;
    double duration_s = 120; // of the identification drive, from its beginning
    bool hard = false;       // any effect of the catalogue; otherwise one of those that such a drive shows
    bool replace = false;    // an earlier game in the folder is given up
};

// What an action did: words for the player, the state (and more) for a program.
struct Turn {
    std::string text;
    nlohmann::json json;
};

Turn start(const NewGame &request);

// The present model against the log: compare's table, the guesses and the ladder so far.
Turn look(const std::string &folder);

// Fits the present model with this effect; keep: the model goes on with it. wheel -1: all. An effect that is in the model already, or is
// none of the catalogue, is a GameError and costs nothing.
Turn guess(const std::string &folder, const std::string &effect, int wheel, bool keep);

// Ends the game: what was hidden, and the score.
Turn open(const std::string &folder);

// Points of 100: 60 for having the hidden effect in the model (30 on the wrong wheel, or for another that leaves no more error than the
// truth does), 40 for how far the held-out error fell towards what the truth leaves, less 10 for every wrong guess.
struct Played {
    bool named = false, wheel_right = false;
    double error_before = 0, error_after = 0, floor = 0; // held out; floor: of the model that is told the truth
    int wrong_guesses = 0;
};
int points(const Played &played);

} // namespace traction::game
