// verb_game.cpp - traction game: guess the hidden effect of a sealed log, watch the error, open the seal, be scored.
#include "verbs.h"

#include "host_tools/game/game.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
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
        const char *root = std::getenv("TRACTION_ROOT");
        game::NewGame fresh = request.fresh;
        fresh.root = root != nullptr && *root != '\0' ? std::string(root) : std::filesystem::current_path().string();
        fresh.folder = request.folder;
        return game::start(fresh);
    }
    if (!request.guess.empty()) return game::guess(request.folder, request.guess, request.wheel, false);
    if (!request.add.empty()) return game::guess(request.folder, request.add, request.wheel, true);
    if (request.open) return game::open(request.folder);
    return game::look(request.folder);
}

} // namespace

void add_game(CLI::App &app, Outcome &outcome) {
    auto request = std::make_shared<GameRequest>();
    CLI::App *verb = app.add_subcommand("game", "a sealed log to learn on: look, guess an effect, add it, watch the ladder, open the seal");
    CLI::Option *fresh = verb->add_option("--new", request->fresh.seed, "start a game; the seed hides the effect")->type_name("SEED");
    CLI::Option *guess =
        verb->add_option("--guess", request->guess, "fit the model with this effect, without keeping it")->type_name("EFFECT");
    CLI::Option *add = verb->add_option("--add", request->add, "the same, and keep it")->type_name("EFFECT");
    CLI::Option *open = verb->add_flag("--open", request->open, "open the seal and be scored: the end");
    const std::vector<CLI::Option *> actions = {fresh, guess, add, open};
    for (std::size_t i = 0; i < actions.size(); ++i)
        for (std::size_t j = i + 1; j < actions.size(); ++j) actions[i]->excludes(actions[j]);
    verb->add_option("--folder", request->folder, "the game: its log, model, state and seal")->capture_default_str();
    verb->add_option("--wheel", request->wheel, "only this wheel (with --guess or --add)")->check(CLI::Range(0, 3));
    verb->add_option("--soil", request->fresh.soil, "sand, gravel or concrete")->capture_default_str()->needs(fresh);
    verb->add_flag("--hard", request->fresh.hard, "hide any effect of the catalogue")->needs(fresh);
    verb->add_flag("--replace", request->fresh.replace, "give up the game that is in the folder")->needs(fresh);
    add_json_option(verb, outcome);
    verb->callback([=, &outcome] {
        request->starts = fresh->count() > 0;
        const game::Turn turn = play(*request);
        std::fputs(turn.text.c_str(), stdout);
        outcome.json = turn.json;
        if (turn.json.contains("helps") && !turn.json["helps"].get<bool>()) outcome.exit_code = exit_negative;
    });
}

} // namespace traction::cli
