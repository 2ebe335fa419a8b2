// verb_drop.cpp - traction drop EFFECT: the model without it, as a new file.
#include "rows.h"
#include "verbs.h"

#include "host_tools/lab/model/model.h"

#include <cstdio>
#include <limits>
#include <memory>

namespace traction::cli {

namespace {

struct DropRequest {
    std::string effect, model, out;
    int wheel = -2;
};

void drop(const DropRequest &request, Outcome &outcome) {
    lab::Model model = lab::read_model(request.model);
    const std::size_t dropped = std::erase_if(model.effects, [&](const lab::EffectUse &use) {
        return use.name == request.effect && (request.wheel < -1 || use.wheel == request.wheel);
    });
    if (dropped == 0)
        throw lab::ModelError(request.model, 0, "effect", "there is no \"" + request.effect + "\" in it",
                              "`traction history` lists what the model has");
    model.lineage.push_back({"- " + request.effect, "", "", {}, {}, {}});
    model.lineage.back().train = model.lineage.back().heldout = model.lineage.back().floor = std::numeric_limits<double>::quiet_NaN();
    lab::write_model(model, request.out);
    std::printf("wrote %s without %s; run `traction fit` to fit the rest again\n", request.out.c_str(), request.effect.c_str());
    outcome.json = {{"schema", "traction.lab/1"}, {"verb", "drop"}, {"dropped", dropped}};
}

} // namespace

Verb verb_drop() {
    const auto request = std::make_shared<DropRequest>();
    return {
        .name = "drop",
        .summary = "take an effect out of a model, write a new model file",
        .options = {{.argument = "EFFECT", .into = &request->effect, .help = "name of the effect", .kind = Kind::effect, .required = true},
                    model_row(request->model),
                    {.name = "--out",
                     .into = &request->out,
                     .help = "the new model file",
                     .value = "FILE",
                     .kind = Kind::output,
                     .required = true},
                    {.name = "--wheel", .into = &request->wheel, .help = "only the one on this wheel"}},
        .run = [request](Outcome &outcome) { drop(*request, outcome); }};
}

} // namespace traction::cli
