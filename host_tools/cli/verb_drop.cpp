// verb_drop.cpp - traction drop EFFECT: the model without it, as a new file.
#include "rows.h"
#include "verbs.h"

#include "host_tools/lab/answer.h"

#include <cstdio>
#include <memory>

namespace traction::cli {

namespace {

struct DropRequest {
    std::string effect, model, out;
    int wheel = -2;
};

void drop(const DropRequest &request, Outcome &outcome) {
    std::size_t dropped = 0;
    lab::write_model(lab::without_effect(lab::read_model(request.model), request.effect, request.wheel, dropped), request.out);
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
