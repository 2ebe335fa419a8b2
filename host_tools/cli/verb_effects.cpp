// traction effects [NAME]: the catalogue of physical effects: what each is, its law, its source, and what reveals it.
#include "rows.h"
#include "verbs.h"

#include "host_tools/lab/result/effects_json.h"
#include "host_tools/report/effect_drawing.h"
#include "host_tools/report/report.h"
#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace traction::cli {

namespace {

void wrap(const char *label, std::string_view text) {
    constexpr std::size_t width = 84;
    std::string line;
    std::printf("  %-10s ", label);
    bool first = true;
    while (!text.empty()) {
        const std::size_t space = std::min(text.find(' '), text.size());
        const std::string_view word = text.substr(0, space);
        text.remove_prefix(std::min(space + 1, text.size()));
        if (!line.empty() && line.size() + 1 + word.size() > width) {
            std::printf("%s%s\n", first ? "" : "             ", line.c_str());
            first = false;
            line.clear();
        }
        line += (line.empty() ? "" : " ") + std::string(word);
    }
    std::printf("%s%s\n", first ? "" : "             ", line.c_str());
}

void explain(const sim::Effect &effect) {
    std::printf("%s: %s\n\n", std::string(effect.name).c_str(), std::string(effect.title).c_str());
    wrap("law", effect.equation);
    wrap("acts on", lab::place_of(effect.acts_on) + std::string(effect.per_wheel ? ", of all wheels or of one (wheel = i)" : ""));
    wrap("source", effect.source);
    wrap("looks like", effect.signature);
    wrap("shown by", effect.reveals);
    std::printf("\n");
    for (const sim::EffectParameter &p : effect.parameters) {
        std::printf("  %s [%s]: %s\n", std::string(p.name).c_str(), std::string(p.unit).c_str(), std::string(p.meaning).c_str());
        if (p.strength) {
            std::printf("      fitted, 0 = absent; %g to %g, worth knowing from %g, the simulator's usual %g\n", p.minimum, p.maximum,
                        p.of_interest, p.typical);
        } else {
            std::string variants;
            for (const double value : p.variants) variants += (variants.empty() ? "" : ", ") + nlohmann::json(value).dump();
            std::printf("      shape; the lab tries %s; the simulator's usual %g\n",
                        variants.empty() ? "values that the log suggests" : variants.c_str(), p.typical);
        }
    }
    std::string strength = "value";
    for (const sim::EffectParameter &p : effect.parameters) {
        if (p.strength) strength = std::string(p.name) + " = " + nlohmann::json(p.typical).dump();
    }
    std::printf(
        "\n  in a scenario or a model:   [[effect]]\n                              name = \"%s\"\n                              %s\n",
        std::string(effect.name).c_str(), strength.c_str());
}

// A file of its own for each.
void draw(const std::string &folder) {
    if (!std::filesystem::is_directory(folder)) throw UsageError("--drawings " + folder + ": is no folder; make it first");
    for (const sim::Effect &effect : sim::catalogue())
        report::write_text(report::effect_svg(effect, true) + "\n",
                           (std::filesystem::path(folder) / (std::string(effect.name) + ".svg")).string());
    std::printf("%zu drawings in %s\n", sim::catalogue().size(), folder.c_str());
}

void effects(const std::string &name, const std::string &drawings, Outcome &outcome) {
    if (!drawings.empty()) draw(drawings);
    nlohmann::json list = nlohmann::json::array();
    if (!name.empty()) {
        need_effect("NAME", name, "");
        const sim::Effect &effect = *sim::find_effect(name);
        explain(effect);
        list.push_back(lab::effect_json(effect));
    } else {
        for (const sim::Effect &effect : sim::catalogue()) {
            std::printf("%-22s %-14s %s\n", std::string(effect.name).c_str(), lab::place_of(effect.acts_on),
                        std::string(effect.title).c_str());
            list.push_back(lab::effect_json(effect));
        }
        std::printf("\n%zu effects. `traction effects NAME` explains one.\n", sim::catalogue().size());
    }
    outcome.json = {{"schema", "traction.effects/1"}, {"effects", list}};
}

} // namespace

Verb verb_effects() {
    const auto name = std::make_shared<std::string>(), drawings = std::make_shared<std::string>();
    return {.name = "effects",
            .summary = "list the physical effects that can be simulated and found, or explain one",
            .options = {{.argument = "NAME", .into = name.get(), .help = "the effect to explain", .kind = Kind::effect},
                        {.name = "--drawings",
                         .into = drawings.get(),
                         .help = "draw every effect, where it acts and what it adds, as FOLDER/NAME.svg",
                         .value = "FOLDER",
                         .kind = Kind::folder}},
            .run = [name, drawings](Outcome &outcome) { effects(*name, *drawings, outcome); }};
}

} // namespace traction::cli
