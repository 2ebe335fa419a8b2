// verb_history.cpp - traction history: what a model has been through, and its ladder.
#include "rows.h"
#include "verbs.h"

#include "host_tools/lab/result/result.h"

#include <cstdio>
#include <memory>

namespace traction::cli {

namespace {

void history(const std::string &path, Outcome &outcome) {
    const lab::Model model = lab::read_model(path);
    std::printf("%s\n", model.name.c_str());
    for (const lab::EffectUse &use : model.effects) {
        std::printf("effect %s%s:", use.name.c_str(), use.wheel >= 0 ? (" on wheel " + std::to_string(use.wheel)).c_str() : "");
        for (const auto &[key, p] : use.parameters) std::printf(" %s = %.5g %s", key.c_str(), p.value, p.unit.c_str());
        std::printf("\n");
    }
    std::vector<lab::LadderStep> ladder;
    for (const lab::LineageEntry &entry : model.lineage) {
        std::printf("%-36s log %-30s %s\n", entry.label.c_str(), entry.log.c_str(), entry.date.c_str());
        ladder.push_back({entry.label, entry.train, entry.heldout, entry.floor});
    }
    if (ladder.empty())
        std::printf("no history: the model is as it was written\n");
    else
        std::fputs(lab::ladder_text(ladder).c_str(), stdout);
    outcome.json = lab::head_json("history", model, lab::Dataset{});
    outcome.json["ladder"] = lab::ladder_json(ladder);
}

} // namespace

Verb verb_history() {
    const auto path = std::make_shared<std::string>();
    return {.name = "history",
            .summary = "a model's effects, lineage and ladder",
            .options = {model_row(*path)},
            .run = [path](Outcome &outcome) { history(*path, outcome); }};
}

} // namespace traction::cli
