#include "order.h"

#include "token.h"

#include "host_tools/check/check.h"
#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>

namespace traction::serve {

namespace fs = std::filesystem;
using nlohmann::json;
using Words = std::vector<std::string>;

namespace {

const std::map<std::string, Words> &keys_of_verbs() {
    static const std::map<std::string, Words> keys = {
        {"check", {"log", "model", "map"}},
        {"look", {"log", "model", "map"}},
        {"compare", {"log", "model", "map"}},
        {"diagnose", {"log", "model", "map"}},
        {"next", {"log", "model", "map"}},
        {"add", {"log", "model", "map", "effect", "wheel"}},
        {"drop", {"log", "model", "map", "effect", "wheel"}},
        {"simulate", {"scenario", "seed", "seconds", "realtime", "hidden", "effect"}},
        {"game_new", {"seed", "soil", "hard"}},
        {"game_look", {}},
        {"game_guess", {"effect", "wheel"}},
        {"game_add", {"effect", "wheel"}},
        {"game_open", {}},
        {"watch", {}},
        {"rover_logs", {}},
        {"rover_fetch", {"number"}},
    };
    return keys;
}

std::string shown(const json &value) {
    std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    return text.size() > 80 ? text.substr(0, 80) + "..." : text;
}

// One request, read key by key.
class Asked {
  public:
    Asked(const json &request, const Folder &folder) : request_(request), folder_(folder) {
        if (!request.is_object()) throw BadRequest("the request is no JSON object");
        verb = text("verb");
        const auto known = keys_of_verbs().find(verb);
        if (known == keys_of_verbs().end()) throw BadRequest("verb: " + shown(verb) + " is none that this page can run");
        for (const auto &[key, value] : request.items())
            if (key != "verb" && std::find(known->second.begin(), known->second.end(), key) == known->second.end())
                throw BadRequest(shown(key) + ": is no key of " + verb);
    }

    std::string verb;

    bool has(const char *key) const { return request_.contains(key) && !request_.at(key).is_null() && request_.at(key) != ""; }

    std::string text(const char *key) const {
        if (!has(key)) throw BadRequest(std::string(key) + ": is missing; choose one");
        if (!request_.at(key).is_string()) throw BadRequest(std::string(key) + ": " + shown(request_.at(key)) + ": must be text");
        return request_.at(key).get<std::string>();
    }

    bool flag(const char *key) const {
        if (!has(key)) return false;
        if (!request_.at(key).is_boolean()) throw BadRequest(std::string(key) + ": " + shown(request_.at(key)) + ": must be true or false");
        return request_.at(key).get<bool>();
    }

    std::int64_t whole(const char *key, std::int64_t low, std::int64_t high) const {
        const json &value = request_.at(key);
        if (!value.is_number_integer() || value.get<double>() < static_cast<double>(low) || value.get<double>() > static_cast<double>(high))
            throw BadRequest(std::string(key) + ": " + shown(value) + ": must be a whole number from " + std::to_string(low) + " to " +
                             std::to_string(high));
        return value.get<std::int64_t>();
    }

    const File &file(const char *key, Kind kind) const {
        const std::string name = text(key);
        const File *found = folder_.find(name, kind);
        if (found == nullptr && kind == Kind::log) found = folder_.find(name, Kind::foreign);
        if (found == nullptr) throw BadRequest(std::string(key) + ": " + shown(name) + ": there is no such " + key + " in the folder");
        return *found;
    }

    std::string effect() const {
        const std::string name = text("effect");
        if (sim::find_effect(name) == nullptr) throw BadRequest("effect: " + shown(name) + ": is none of the catalogue");
        return name;
    }

    int wheel() const { return has("wheel") ? static_cast<int>(whole("wheel", -1, 3)) : -1; }

  private:
    const json &request_;
    const Folder &folder_;
};

std::string stem_of(const std::string &name) { return fs::path(name).stem().string(); }

// A seed that nobody knows, so that a game is none of memory.
std::uint64_t any_seed() {
    std::uint64_t seed = 0;
    for (const char c : make_token()) seed = seed * 31 + static_cast<unsigned char>(c);
    return seed % 1000000000;
}

// The effect at the size that the simulator usually gives it: "slip_sinkage:coefficient=0.2".
std::string usual(const std::string &name) {
    std::string text = name;
    char before = ':';
    for (const sim::EffectParameter &p : sim::find_effect(name)->parameters) {
        text += before + std::string(p.name) + '=' + json(p.typical).dump();
        before = ',';
    }
    return text;
}

void simulate_order(const Asked &asked, const Folder &folder, const std::string &result, const std::string &seal, Order &order) {
    const File &scenario = asked.file("scenario", Kind::scenario);
    Words words = {"simulate", scenario.path.string(), "--live", "-", "--json", result};
    std::string stem = stem_of(scenario.name);
    if (asked.has("seed")) {
        const std::string seed = std::to_string(asked.whole("seed", 0, std::int64_t{1} << 53));
        words.insert(words.end(), {"--seed", seed});
        stem += "_" + seed;
    }
    if (asked.has("seconds")) words.insert(words.end(), {"--for", std::to_string(asked.whole("seconds", 1, 3600))});
    if (asked.flag("realtime")) words.emplace_back("--realtime");
    if (asked.has("effect")) {
        words.insert(words.end(), {"--effect", usual(asked.effect())});
        order.entry["effect"] = asked.effect();
    }
    if (asked.flag("hidden")) {
        words.insert(words.end(), {"--hide", std::to_string(any_seed()), "--seal", seal});
        order.entry["sealed"] = true;
    }
    const std::string log = folder.free_name(stem, ".csv");
    words.insert(words.end(), {"--out", (folder.root() / log).string()});
    order.entry["scenario"] = scenario.name;
    order.entry["log"] = log;
    order.commands = {words};
    order.live = true;
}

void game_order(const Asked &asked, const Folder &folder, const std::string &result, Order &order) {
    const fs::path game = folder.root() / "game";
    std::error_code error;
    const fs::file_type type = fs::symlink_status(game, error).type();
    if (type != fs::file_type::directory && type != fs::file_type::not_found)
        throw BadRequest("game: is a file or a link in this folder; take it away, the game is kept in a folder of that name");
    order.game = true;
    Words words = {"game", "--folder", game.string()};
    if (asked.verb == "game_new") {
        const std::int64_t seed = asked.has("seed") ? asked.whole("seed", 0, std::int64_t{1} << 53) : static_cast<std::int64_t>(any_seed());
        words.insert(words.end(), {"--new", std::to_string(seed), "--replace"});
        if (asked.has("soil")) {
            const std::string soil = asked.text("soil");
            if (soil != "sand" && soil != "gravel" && soil != "concrete")
                throw BadRequest("soil: " + shown(soil) + ": sand, gravel or concrete");
            words.insert(words.end(), {"--soil", soil});
        }
        if (asked.flag("hard")) words.emplace_back("--hard");
    } else if (asked.verb == "game_look") { // the page of the present model, as for any log
        words = {"compare", (game / "run.csv").string(), "--model", (game / "model.toml").string()};
        for (const std::string &id : check::error_ids()) words.insert(words.end(), {"--despite", id}); // the game's own log: as game.cpp
    } else if (asked.verb == "game_open") {
        words.emplace_back("--open");
    } else {
        order.entry["effect"] = asked.effect();
        words.insert(words.end(), {asked.verb == "game_add" ? "--add" : "--guess", asked.effect()});
        if (asked.wheel() >= 0) words.insert(words.end(), {"--wheel", std::to_string(asked.wheel())}), order.entry["wheel"] = asked.wheel();
    }
    words.insert(words.end(), {"--json", result});
    order.commands = {words};
}

// What `traction drive` is asked: to watch, to list, to fetch. Never a command.
void rover_order(const Asked &asked, const Folder &folder, const Rover *rover, const std::string &result, Order &order) {
    if (rover == nullptr) throw BadRequest("verb: no rover was named: start traction serve with --host ADDR");
    Words words = {"drive", "--host", rover->host, "--system", std::to_string(rover->system)};
    if (!rover->key.empty()) words.insert(words.end(), {"--key", rover->key});
    words.insert(words.end(), {"--json", result});
    if (asked.verb == "watch") {
        const std::string log = folder.free_name("telemetry", ".csv");
        words.insert(words.end(), {"--live", "-", "--record", (folder.root() / log).string()});
        order.entry["log"] = log;
        order.live = true;
    } else if (asked.verb == "rover_logs") {
        words.emplace_back("--logs");
    } else {
        if (!asked.has("number")) throw BadRequest("number: is missing; list the rover's logs and choose one");
        const std::string number = std::to_string(asked.whole("number", 0, 65535)), stem = "rover_log_" + number;
        const std::string made = folder.free_name(stem, ".ulg"), log = folder.free_name(stem, ".csv");
        words.insert(words.end(), {"--fetch", number, "--out", (folder.root() / made).string()});
        order.entry["made"] = made;
        order.entry["log"] = log;
        order.commands = {words, {"convert", (folder.root() / made).string(), "--out", (folder.root() / log).string()}};
        return;
    }
    order.commands = {words};
}

void lab_order(const Asked &asked, const Folder &folder, const std::string &result, Order &order) {
    const std::string &verb = asked.verb;
    const File &log = asked.file("log", Kind::log);
    order.entry["log"] = log.name;
    Words input = {log.path.string()};
    std::string model;
    if ((verb != "look" && verb != "check") || asked.has("model")) {
        const File &file = asked.file("model", Kind::model);
        model = file.path.string();
        order.entry["model"] = file.name;
    }
    if (asked.has("map")) {
        const File &map = asked.file("map", Kind::map);
        input.insert(input.end(), {"--map", map.path.string()});
        order.entry["map"] = map.name;
    }
    if (verb == "look") { // what its page would show
        input.insert(input.begin(), "report");
        if (!model.empty()) input.insert(input.end(), {"--model", model}); // its wheels are drawn
        input.insert(input.end(), {"--out", result});
        order.commands = {input};
        return;
    }
    const auto with_model = [&](const std::string &of) {
        Words words = input;
        if (!of.empty()) words.insert(words.end(), {"--model", of});
        words.insert(words.end(), {"--json", result});
        return words;
    };
    Words words = with_model(model);
    if (verb == "add" || verb == "drop") {
        const std::string effect = asked.effect();
        const int wheel = asked.wheel();
        const std::string name = stem_of(order.entry["model"].get<std::string>()) + (verb == "add" ? "_" : "_without_") + effect;
        const std::string made = folder.free_name(wheel < 0 ? name : name + "_wheel" + std::to_string(wheel), ".toml");
        const std::string path = (folder.root() / made).string();
        order.entry["effect"] = effect;
        order.entry["made"] = made;
        const Words on = wheel < 0 ? Words{} : Words{"--wheel", std::to_string(wheel)};
        if (wheel >= 0) order.entry["wheel"] = wheel;
        if (verb == "add") {
            words.insert(words.begin(), effect);
            words.insert(words.end(), {"--out", path});
            words.insert(words.end(), on.begin(), on.end());
        } else { // what the smaller model leaves is seen by comparing it
            order.commands.push_back({"drop", effect, "--model", model, "--out", path});
            order.commands.back().insert(order.commands.back().end(), on.begin(), on.end());
            order.commands.push_back(with_model(path));
            order.commands.back().insert(order.commands.back().begin(), "compare");
            return;
        }
    }
    if (verb == "next") {
        const std::string made = folder.free_name("next_" + stem_of(log.name), ".toml");
        order.entry["made"] = made;
        words.insert(words.end(), {"--out", (folder.root() / made).string()});
    }
    words.insert(words.begin(), verb);
    order.commands = {words};
}

} // namespace

Order make_order(const json &request, const Folder &folder, const std::string &result, const std::string &seal, const Rover *rover) {
    const Asked asked(request, folder);
    Order order;
    order.entry = {{"verb", asked.verb}};
    if (asked.verb == "simulate")
        simulate_order(asked, folder, result, seal, order);
    else if (asked.verb.rfind("game", 0) == 0)
        game_order(asked, folder, result, order);
    else if (asked.verb == "watch" || asked.verb.rfind("rover_", 0) == 0)
        rover_order(asked, folder, rover, result, order);
    else
        lab_order(asked, folder, result, order);
    return order;
}

} // namespace traction::serve
