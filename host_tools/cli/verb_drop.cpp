// verb_drop.cpp - traction drop EFFECT: the model without it, as a new file.
#include "verbs.h"

#include "host_tools/lab/model/model.h"

#include <cstdio>
#include <limits>
#include <memory>

namespace traction::cli {

void add_drop(CLI::App &app, Outcome &outcome) {
    CLI::App *verb = app.add_subcommand("drop", "take an effect out of a model, write a new model file");
    struct DropRequest {
        std::string effect, model, out;
        int wheel = -2;
    };
    auto request = std::make_shared<DropRequest>();
    verb->add_option("effect", request->effect, "name of the effect")->required();
    verb->add_option("--model", request->model, "model file (TOML)")->required()->type_name("FILE");
    verb->add_option("--out", request->out, "the new model file")->required()->type_name("FILE");
    verb->add_option("--wheel", request->wheel, "only the one on this wheel");
    add_json_option(verb, outcome);
    verb->callback([=, &outcome] {
        lab::Model model = lab::read_model(request->model);
        const std::size_t dropped = std::erase_if(model.effects, [&](const lab::EffectUse &use) {
            return use.name == request->effect && (request->wheel < -1 || use.wheel == request->wheel);
        });
        if (dropped == 0)
            throw lab::ModelError(request->model, 0, "effect", "there is no \"" + request->effect + "\" in it",
                                  "`traction history` lists what the model has");
        model.lineage.push_back({"- " + request->effect, "", "", {}, {}, {}});
        model.lineage.back().train = model.lineage.back().heldout = model.lineage.back().floor = std::numeric_limits<double>::quiet_NaN();
        lab::write_model(model, request->out);
        std::printf("wrote %s without %s; run `traction fit` to fit the rest again\n", request->out.c_str(), request->effect.c_str());
        outcome.json = {{"schema", "traction.lab/1"}, {"verb", "drop"}, {"dropped", dropped}};
    });
}

} // namespace traction::cli
