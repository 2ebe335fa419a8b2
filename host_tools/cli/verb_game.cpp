// verb_game.cpp - traction game: guess the hidden effect of a sealed log, watch the error, open the seal, be scored.
#include "data_files.h"
#include "verbs.h"

#include "host_tools/game/game.h"

#include <cstdio>
#include <memory>

namespace traction::cli {

namespace {

struct GameRequest {
    game::NewGame fresh;
    std::string folder = "out/game", guess, add;
    int wheel = -1;
    bool starts = false, open = false;
};

game::Turn play(const GameRequest &request) {
    if (request.starts) {
        game::NewGame fresh = request.fresh;
        fresh.root = need_data_root().string();
        fresh.folder = request.folder;
        return game::start(fresh);
    }
    if (!request.guess.empty()) return game::guess(request.folder, request.guess, request.wheel, false);
    if (!request.add.empty()) return game::guess(request.folder, request.add, request.wheel, true);
    if (request.open) return game::open(request.folder);
    return game::look(request.folder);
}

} // namespace

Verb verb_game() {
    const auto request = std::make_shared<GameRequest>();
    return {
        .name = "game",
        .summary = "a sealed log to learn on: look, guess an effect, add it, watch the ladder, open the seal",
        .options =
            {{.name = "--new",
              .into = &request->fresh.seed,
              .help = "start a game; the seed hides the effect",
              .value = "SEED",
              .excludes = {"--guess", "--add", "--open"},
              .given = &request->starts},
             {.name = "--guess",
              .into = &request->guess,
              .help = "fit the model with this effect, without keeping it",
              .value = "EFFECT",
              .kind = Kind::effect,
              .excludes = {"--add", "--open"}},
             {.name = "--add",
              .into = &request->add,
              .help = "the same, and keep it",
              .value = "EFFECT",
              .kind = Kind::effect,
              .excludes = {"--open"}},
             {.name = "--open", .into = &request->open, .help = "open the seal and be scored: the end"},
             {.name = "--folder",
              .into = &request->folder,
              .help = "the game: its log, model, state and seal",
              .value = "FOLDER",
              .kind = Kind::folder,
              .shows_default = true},
             {.name = "--wheel", .into = &request->wheel, .help = "only this wheel (with --guess or --add)", .range = Range{0, 3}},
             {.name = "--soil",
              .into = &request->fresh.soil,
              .help = "the ground",
              .shows_default = true,
              .one_of = {"sand", "gravel", "concrete"},
              .needs = {"--new"}},
             {.name = "--hard", .into = &request->fresh.hard, .help = "hide any effect of the catalogue", .needs = {"--new"}},
             {.name = "--replace", .into = &request->fresh.replace, .help = "give up the game that is in the folder", .needs = {"--new"}}},
        .run = [request](Outcome &outcome) {
            const game::Turn turn = play(*request);
            std::fputs(turn.text.c_str(), stdout);
            outcome.json = turn.json;
            if (turn.json.contains("helps") && !turn.json["helps"].get<bool>()) outcome.exit_code = exit_negative;
        }};
}

} // namespace traction::cli
