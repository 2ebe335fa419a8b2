#include "read_parts.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

namespace traction::sim {

namespace {

std::string known_effects() {
    std::string list;
    for (const Effect &effect : catalogue()) list += (list.empty() ? "" : ", ") + std::string(effect.name);
    return list;
}

ActiveEffect typical(const Effect &effect) {
    ActiveEffect active{.effect = &effect, .wheel = -1, .values = {}};
    for (const EffectParameter &parameter : effect.parameters) active.values.push_back(parameter.typical);
    return active;
}

// A value may also be a lab's { value = , unit = , ... }.
const toml::node &value_of(const toml::node &node) {
    if (const toml::table *table = node.as_table())
        if (const toml::node *value = table->get("value")) return *value;
    return node;
}

} // namespace

ActiveEffect read_effect(const toml::table &table, const std::string &file, const std::string &path) {
    Keys keys(table, file, path);
    const std::string name = keys.text("name", "");
    const Effect *effect = find_effect(name);
    if (effect == nullptr) keys.fail("name", name.empty() ? "missing" : "no such effect", "use one of: " + known_effects());
    ActiveEffect active = typical(*effect);
    if (keys.has("wheel")) {
        if (!effect->per_wheel) keys.fail("wheel", "this effect is not confined to a wheel", "leave the key out");
        active.wheel = static_cast<int>(keys.integer("wheel", -1, 0, wheel_count - 1));
    }
    for (std::size_t i = 0; i < effect->parameters.size(); i++) {
        const EffectParameter &parameter = effect->parameters[i];
        const toml::node *node = keys.node(parameter.name);
        if (node == nullptr) continue;
        const double low = parameter.both_signs ? -parameter.maximum : parameter.minimum;
        active.values[i] = keys.number_of(value_of(*node), parameter.name, {low, parameter.maximum});
        if (!parameter.takes(active.values[i])) keys.fail_at(*node, parameter.name, "out of range", "give " + parameter.range());
    }
    keys.finish();
    return active;
}

ActiveEffect parse_effect(const std::string &text) {
    const auto fail = [&text](const std::string &wrong, const std::string &mend) {
        throw ScenarioError("--effect", 0, "", text, wrong, mend);
    };
    const std::size_t colon = text.find(':');
    const Effect *effect = find_effect(text.substr(0, colon));
    if (effect == nullptr) fail("no such effect", "use one of: " + known_effects());
    ActiveEffect active = typical(*effect);
    std::size_t at = colon == std::string::npos ? text.size() : colon + 1;
    while (at < text.size()) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        const std::string part = text.substr(at, comma - at);
        at = comma + 1;
        const std::size_t equals = part.find('=');
        double value = 0;
        const char *end = part.data() + part.size();
        if (equals == std::string::npos || std::from_chars(part.data() + equals + 1, end, value).ptr != end || equals + 1 == part.size())
            fail("'" + part + "' is not parameter=number",
                 "write --effect '" + std::string(effect->name) + ":" + std::string(effect->parameters.front().name) + "=VALUE'");
        const std::string key = part.substr(0, equals);
        if (key == "wheel") {
            if (!effect->per_wheel || value < 0 || value >= wheel_count || value != static_cast<int>(value))
                fail("wheel does not fit", effect->per_wheel ? "give 0, 1, 2 or 3" : "this effect is not confined to a wheel");
            active.wheel = static_cast<int>(value);
            continue;
        }
        const auto found =
            std::find_if(effect->parameters.begin(), effect->parameters.end(), [&](const EffectParameter &p) { return p.name == key; });
        if (found == effect->parameters.end()) fail("no parameter " + key, "traction effects " + std::string(effect->name) + " lists them");
        if (!found->takes(value)) fail(key + " out of range", "give " + found->range());
        active.values[static_cast<std::size_t>(found - effect->parameters.begin())] = value;
    }
    return active;
}

HiddenDraw read_hidden(const toml::table &table, const std::string &file) {
    Keys keys(table, file, "hidden");
    HiddenDraw draw;
    if (!keys.has("draw_from_seed")) keys.fail("draw_from_seed", "missing", "give a whole number");
    draw.seed = static_cast<std::uint64_t>(keys.integer("draw_from_seed", 0, 0, INT64_MAX));
    draw.count = static_cast<int>(keys.integer("count", 1, 1, 5));
    if (const toml::array *among = keys.array("among"))
        for (const toml::node &item : *among) {
            const auto name = item.value<std::string>();
            if (!name || find_effect(*name) == nullptr) keys.fail_at(item, "among", "no such effect", "use some of: " + known_effects());
            draw.among.push_back(*name);
        }
    keys.finish();
    return draw;
}

} // namespace traction::sim
