#include "game.h"

#include "host_tools/check/check.h"
#include "host_tools/lab/result/addition.h"
#include "host_tools/lab/result/compare.h"
#include "host_tools/lab/result/result.h"
#include "host_tools/lab/session.h"
#include "host_tools/report/report.h"
#include "host_tools/simulate/simulate.h"
#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace traction::game {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr const char *schema = "traction.game/1";

// Effects that the identification drive shows at the sizes that are hidden, and that no parameter of the model can take the place of.
const std::vector<std::string> plain_effects = {
    "slip_sinkage", "viscous_friction", "coulomb_friction", "wiring_resistance", "mass_offset_x",    "mass_offset_y",
    "grade",        "current_gain",     "mesh_loss",        "multi_pass",        "bridge_dead_time", "load_transfer",
    "accel_scale",  "lateral_scrub",    "body_drag"};

std::string path_in(const std::string &folder, const char *name) { return (fs::path(folder) / name).string(); }

json read_json(const std::string &path, const std::string &mend) {
    std::ifstream file(path);
    if (!file.is_open()) throw GameError(path + ": cannot be read; " + mend);
    try {
        return json::parse(file);
    } catch (const json::exception &) {
        throw GameError(path + ": is no JSON any more; " + mend);
    }
}

json read_state(const std::string &folder) {
    const std::string path = path_in(folder, "game.json");
    if (!fs::exists(path))
        throw GameError(folder + ": there is no game in it; start one with  traction game --new SEED --folder " + folder);
    json state = read_json(path, "start again with --new SEED --replace");
    for (const char *key : {"schema", "seed", "guesses", "ladder", "opened"})
        if (!state.contains(key) || state["schema"] != schema)
            throw GameError(path + ": is not the state of a game (" + schema + "); start again with --new SEED --replace");
    return state;
}

void write_state(const std::string &folder, const json &state) { report::write_text(state.dump(1) + "\n", path_in(folder, "game.json")); }

// The log is the game's own: what the check takes for an error of it (a sensor that is late) is what was hidden.
lab::Session session_of(const std::string &folder, const std::string &model) {
    return lab::open_session({.model = model, .log = path_in(folder, "run.csv"), .map = "", .repeat = "", .despite = check::error_ids()});
}

// The rows are those that the baseline makes of the log, whatever the model has grown to: errors on other rows would not compare.
lab::Session session_of(const std::string &folder) {
    lab::Session session = session_of(folder, path_in(folder, "baseline.toml"));
    session.model = lab::read_model(path_in(folder, "model.toml"));
    return session;
}

std::string label_of(const std::string &effect, int wheel) { return wheel < 0 ? effect : effect + " on wheel " + std::to_string(wheel); }

json step_json(const lab::LadderStep &step) { return {{"label", step.label}, {"train", step.train}, {"heldout", step.heldout}}; }

std::string ladder_text(const json &state) {
    std::string text = "ladder (held-out error, x noise):\n";
    for (const json &step : state["ladder"]) {
        char line[160];
        std::snprintf(line, sizeof line, "  %-36s %8.3f\n", step.value("label", "").c_str(), step.value("heldout", 0.0));
        text += line;
    }
    return text;
}

std::string guesses_text(const json &state) {
    if (state["guesses"].empty()) return "no guess yet: traction game --guess EFFECT tries one, traction effects lists them\n";
    std::string text = "guesses:\n";
    for (const json &g : state["guesses"]) {
        char line[200];
        std::snprintf(line, sizeof line, "  %-36s %8.3f -> %.3f%s\n", g.value("label", "").c_str(), g.value("before", 0.0),
                      g.value("after", 0.0), g.value("added", false) ? ", added" : "");
        text += line;
    }
    return text;
}

void need_running(const json &state, const std::string &folder) {
    if (state["opened"].get<bool>())
        throw GameError(folder + ": this game is over, its seal is open; start another with  traction game --new SEED --replace");
}

} // namespace

Turn start(const NewGame &request) {
    if (fs::exists(path_in(request.folder, "game.json")) && !request.replace)
        throw GameError(request.folder + ": holds a game already; go on with it, or give --replace or another --folder");
    const sim::Soil *soil = sim::find_soil(request.soil);
    const std::string model_file = (fs::path(request.root) / "models" / ("rover_" + request.soil + ".toml")).string();
    if (soil == nullptr || !fs::exists(model_file))
        throw GameError("--soil " + request.soil + ": there is no model of the rover on it; use sand, gravel or concrete");
    sim::Scenario scenario = sim::read_scenario((fs::path(request.root) / "scenarios" / "identification.toml").string());
    scenario.duration_s = std::min(scenario.duration_s, request.duration_s);
    scenario.plant.ground.soil = *soil;
    scenario.plant.ground.grip_noise = request.soil == "concrete" ? 0.02 : 0.06; // docs/scenario_format.md
    SimulateOptions options;
    options.seed = request.seed;
    options.hide = sim::HiddenDraw{.seed = request.seed, .count = 1, .among = request.hard ? std::vector<std::string>{} : plain_effects};
    const SimulationResult run = simulate(scenario, options);
    fs::create_directories(request.folder);
    fs::remove(path_in(request.folder, "game.json")); // no game until everything stands
    log::write_csv(run.log, path_in(request.folder, "run.csv"));
    const lab::Session session = session_of(request.folder, model_file);
    // with what opening it found of the log (a rover that drifts in its bends), so that every turn has the same rows and the same motion
    for (const char *name : {"baseline.toml", "model.toml"}) lab::write_model(session.model, path_in(request.folder, name));
    lab::Model fitted = session.model;
    const lab::LadderStep baseline = lab::fit_model(fitted, session.data, "baseline");
    report::write_text(sim::seal_text(run.hidden, scenario.name, request.seed), path_in(request.folder, "sealed.json"));
    const json state = {{"schema", schema},
                        {"verb", "game"},
                        {"seed", request.seed},
                        {"soil", request.soil},
                        {"level", request.hard ? "hard" : "plain"},
                        {"guesses", json::array()},
                        {"ladder", json::array({step_json(baseline)})},
                        {"opened", false}};
    write_state(request.folder, state);
    Turn turn{"A rover drove for " + std::to_string(static_cast<int>(scenario.duration_s)) + " s on " + request.soil +
                  ". One thing about it is not in the model; the truth is sealed in " + path_in(request.folder, "sealed.json") + ".\n" +
                  (request.hard ? "It may be any of the catalogue's effects, seen or unseen.\n" : "It is one of:"),
              state};
    if (!request.hard)
        for (std::size_t i = 0; i < plain_effects.size(); ++i) turn.text += (i % 6 == 0 ? "\n  " : " ") + plain_effects[i];
    turn.text += std::string(request.hard ? "" : "\n") + "(traction effects NAME tells what each does and how its residual looks)\n" +
                 ladder_text(state) + "\nNext: traction game (look), --guess EFFECT (try it), --add EFFECT (keep it), --open (end)\n";
    return turn;
}

Turn look(const std::string &folder) {
    const json state = read_state(folder);
    const lab::Session session = session_of(folder);
    const lab::Comparison comparison = lab::compare(session.model, session.data, false);
    Turn turn{lab::comparison_text(comparison) + guesses_text(state) + ladder_text(state), state};
    turn.json["score"] = {
        {"error", comparison.error}, {"adjusted", comparison.adjusted}, {"floor", comparison.floor}, {"verdict", comparison.verdict}};
    return turn;
}

Turn guess(const std::string &folder, const std::string &effect, int wheel, bool keep) {
    json state = read_state(folder);
    need_running(state, folder);
    if (sim::find_effect(effect) == nullptr) throw GameError("\"" + effect + "\" is no effect; `traction effects` lists them");
    const lab::Session session = session_of(folder);
    lab::Added added = [&] {
        try {
            return lab::add_effect(session.model, session.data, effect, wheel, "");
        } catch (const lab::ModelError &error) {
            throw GameError(std::string("it cannot be tried: ") + error.what());
        }
    }();
    const lab::LadderStep &before = added.ladder.front(), &after = added.ladder.back();
    const std::string label = label_of(effect, wheel);
    const auto same = [&](const json &g) { return g["label"] == label; };
    auto place = std::find_if(state["guesses"].begin(), state["guesses"].end(), same);
    if (place == state["guesses"].end()) {
        state["guesses"].push_back({{"label", label}, {"effect", effect}, {"wheel", wheel}});
        place = std::prev(state["guesses"].end());
    }
    (*place)["before"] = before.heldout, (*place)["after"] = after.heldout, (*place)["added"] = keep;
    if (keep) {
        state["ladder"].push_back(step_json(after));
        lab::write_model(added.model, path_in(folder, "model.toml"));
    }
    write_state(folder, state);
    Turn turn{lab::added_text(added), state};
    turn.json["helps"] = added.helps;
    turn.text += keep ? label + " is in the model now\n"
                      : "not kept: --add " + effect + (wheel >= 0 ? " --wheel " + std::to_string(wheel) : "") + " keeps it\n";
    return turn;
}

int points(const Played &p) {
    const double to_fall = p.error_before - p.floor;
    const double share = to_fall > 0.01 * p.floor ? std::clamp((p.error_before - p.error_after) / to_fall, 0.0, 1.0)
                         : p.named                ? 1.0
                                                  : 0.0; // an error that hides it tells nothing
    const bool as_good = to_fall > 0.01 * p.floor && p.error_after <= 1.02 * p.floor;
    const double name = p.named ? (p.wheel_right ? 60 : 30) : as_good ? 30 : 0;
    return static_cast<int>(std::lround(std::max(0.0, name + 40 * share - 10 * p.wrong_guesses)));
}

} // namespace traction::game
