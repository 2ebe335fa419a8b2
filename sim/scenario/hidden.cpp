#include "hidden.h"

#include "sim/sensors/random.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace traction::sim {

namespace {

// Size of a strength: large enough to matter, small enough to be plausible.
double draw_strength(const EffectParameter &parameter, Random &random) {
    const bool both_signs = parameter.minimum < 0 && parameter.maximum > 0;
    const bool negative = parameter.maximum <= 0 || (both_signs && random.uniform() < 0.5);
    return (negative ? parameter.minimum : parameter.maximum) * random.uniform(0.25, 0.75);
}

ActiveEffect draw_one(const Effect &effect, Random &random) {
    ActiveEffect active{.effect = &effect, .wheel = -1, .values = {}};
    if (effect.per_wheel && random.uniform() < 0.5) active.wheel = random.below(4);
    for (const EffectParameter &parameter : effect.parameters) {
        if (parameter.strength)
            active.values.push_back(draw_strength(parameter, random));
        else if (!parameter.variants.empty())
            active.values.push_back(
                parameter.variants[static_cast<std::size_t>(random.below(static_cast<int>(parameter.variants.size())))]);
        else
            active.values.push_back(random.uniform(parameter.minimum, parameter.maximum));
    }
    return active;
}

} // namespace

std::vector<ActiveEffect> draw_effects(const HiddenDraw &draw) {
    std::vector<const Effect *> choices;
    for (const Effect &effect : catalogue())
        if (draw.among.empty() || std::find(draw.among.begin(), draw.among.end(), effect.name) != draw.among.end())
            choices.push_back(&effect);
    Random random(draw.seed, "hidden");
    std::vector<ActiveEffect> drawn;
    while (static_cast<int>(drawn.size()) < draw.count && !choices.empty()) {
        const auto place = choices.begin() + random.below(static_cast<int>(choices.size()));
        drawn.push_back(draw_one(**place, random));
        choices.erase(place);
    }
    return drawn;
}

std::string seal_text(const std::vector<ActiveEffect> &effects, const std::string &scenario, std::uint64_t hide_seed) {
    nlohmann::ordered_json seal;
    seal["schema"] = "traction.seal/1";
    seal["scenario"] = scenario;
    seal["hide_seed"] = hide_seed;
    seal["effects"] = nlohmann::ordered_json::array();
    for (const ActiveEffect &active : effects) {
        nlohmann::ordered_json entry;
        entry["name"] = active.effect->name;
        if (active.wheel >= 0) entry["wheel"] = active.wheel;
        entry["parameters"] = nlohmann::ordered_json::object();
        for (std::size_t i = 0; i < active.values.size(); i++) {
            const EffectParameter &parameter = active.effect->parameters[i];
            entry["parameters"][std::string(parameter.name)] = {{"value", active.values[i]}, {"unit", parameter.unit}};
        }
        seal["effects"].push_back(entry);
    }
    return seal.dump(2) + '\n';
}

} // namespace traction::sim
