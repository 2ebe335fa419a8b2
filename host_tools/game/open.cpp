// open.cpp - the end of a game: the only place that reads its seal.
#include "game.h"

#include "host_tools/check/check.h"
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/result/words.h"
#include "host_tools/lab/session.h"
#include "host_tools/report/report.h"
#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace traction::game {

using nlohmann::json;

namespace {

json read_envelope(const std::string &path) {
    std::ifstream file(path);
    if (!file.is_open())
        throw GameError(path + ": cannot be read; a game without it cannot be scored, start again with --new SEED --replace");
    try {
        return json::parse(file);
    } catch (const json::exception &) {
        throw GameError(path + ": is no JSON any more; a game without it cannot be scored, start again with --new SEED --replace");
    }
}

// What the seal says as an effect of a model: its strengths free, its shapes as they are.
lab::EffectUse use_of(const json &hidden, const std::string &file) {
    lab::EffectUse use;
    try {
        use.name = hidden.at("name").get<std::string>();
        use.wheel = hidden.value("wheel", -1);
        const sim::Effect *effect = sim::find_effect(use.name);
        if (effect == nullptr)
            throw GameError(file + ": hides \"" + use.name + "\", which is no effect; start again with --new SEED --replace");
        for (const sim::EffectParameter &spec : effect->parameters) {
            lab::Parameter p;
            p.value = hidden.at("parameters").at(std::string(spec.name)).at("value").get<double>();
            p.unit = spec.unit;
            p.fixed = !spec.strength;
            p.minimum = spec.minimum < 0 ? 1.5 * spec.minimum : 0;
            p.maximum = 1.5 * spec.maximum;
            if (p.fixed) p.minimum = -1e300, p.maximum = 1e300;
            use.parameters[std::string(spec.name)] = p;
        }
    } catch (const json::exception &error) {
        throw GameError(file + ": is no seal (" + error.what() + "); start again with --new SEED --replace");
    }
    return use;
}

std::string described(const lab::EffectUse &use) {
    std::string text = use.name + (use.wheel >= 0 ? " on wheel " + std::to_string(use.wheel) : "");
    for (const auto &[key, p] : use.parameters) {
        char number[80];
        std::snprintf(number, sizeof number, ", %s = %.3g %s", key.c_str(), p.value, p.unit == "1" ? "" : p.unit.c_str());
        text += number;
    }
    return text;
}

} // namespace

Turn open(const std::string &folder) {
    const auto path = [&](const char *name) { return (std::filesystem::path(folder) / name).string(); };
    json state = look(folder).json; // checks the state
    if (state["opened"].get<bool>())
        throw GameError(folder + ": the seal is open already: " + state.value("hidden", "") + ", " +
                        std::to_string(state.value("points", 0)) + " points");
    const json seal = read_envelope(path("sealed.json"));
    if (!seal.contains("effects") || seal["effects"].empty())
        throw GameError(path("sealed.json") + ": is no seal; start again with --new SEED --replace");
    const lab::EffectUse truth = use_of(seal["effects"].at(0), path("sealed.json"));
    const lab::Session session = lab::open_session({.model = path("baseline.toml"),
                                                    .log = path("run.csv"),
                                                    .map = "",
                                                    .repeat = "",
                                                    .despite = check::error_ids()}); // the rows of every guess
    lab::Model told = session.model;
    const lab::Model kept = lab::read_model(path("model.toml"));
    told.effects.push_back(truth);
    Played played;
    played.error_before = state["ladder"].front()["heldout"].get<double>();
    played.error_after = state["ladder"].back()["heldout"].get<double>();
    const lab::Problem truthful = lab::fitted_problem(told, session.data);
    const lab::Remainder left = lab::remainder_of(truthful);
    played.floor = lab::store_fit(told, truthful, "truth").heldout;
    for (const lab::EffectUse &use : kept.effects)
        if (use.name == truth.name) played.named = true, played.wheel_right = played.wheel_right || use.wheel == truth.wheel;
    std::vector<std::string> wrong;
    for (const json &g : state["guesses"])
        if (const std::string name = g["effect"]; name != truth.name && std::find(wrong.begin(), wrong.end(), name) == wrong.end())
            wrong.push_back(name);
    played.wrong_guesses = static_cast<int>(wrong.size());
    const int score = points(played);
    state["opened"] = true, state["hidden"] = described(truth), state["seal"] = seal, state["points"] = score,
    state["wrong_guesses"] = played.wrong_guesses;
    state["error_before"] = played.error_before, state["error_after"] = played.error_after, state["floor"] = played.floor;
    state["error_over_floor"] = played.error_after / played.floor, state["named"] = played.named, state["wheel_right"] = played.wheel_right;
    report::write_text(state.dump(1) + "\n", path("game.json"));
    char line[300];
    std::snprintf(
        line, sizeof line,
        "Error on what was not fitted: %.3f -> %.3f x noise. Told the truth, the model\nleaves %.3f: you stand at %.3f of that.\n",
        played.error_before, played.error_after, played.floor, played.error_after / played.floor);
    std::string score_text = line + lab::wrapped("No model can do better on this log: " + lab::left_words(left, true) + ".");
    std::snprintf(line, sizeof line, "wrong guesses: %d\n%d points of 100\n", played.wrong_guesses, score);
    score_text += line;
    std::string text = "The seal: " + described(truth) + ".\n";
    if (played.named)
        text += played.wheel_right ? "Your model has it.\n" : "Your model has it, on other wheels.\n";
    else if (played.error_after <= 1.02 * played.floor && played.error_before > 1.01 * played.floor)
        text += "Your model has another effect that leaves as little: this log hardly tells them apart.\n";
    else
        text += "Your model does not have it.\n";
    return {text + score_text, state};
}

} // namespace traction::game
