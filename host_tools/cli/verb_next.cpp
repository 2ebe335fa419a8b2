// verb_next.cpp - traction next: the manoeuvre that best separates what a log left open, as a scenario file.
#include "verbs.h"

#include "host_tools/lab/next.h"
#include "host_tools/lab/session.h"
#include "host_tools/report/report.h"

#include <cstdio>
#include <memory>

namespace traction::cli {

void add_next(CLI::App &app, Outcome &outcome) {
    CLI::App *verb = app.add_subcommand("next", "the manoeuvre that separates what a log left open, as a scenario");
    struct NextRequest {
        lab::Request input;
        std::string out;
        std::vector<std::string> effects;
    };
    auto request = std::make_shared<NextRequest>();
    verb->add_option("--model", request->input.model, "model file (TOML)")->required()->type_name("FILE");
    CLI::Option *log = verb->add_option("--log", request->input.log, "log (CSV) that was not enough")->type_name("FILE");
    verb->add_option("--map", request->input.map, "map for a foreign CSV (TOML)")->type_name("FILE");
    verb->add_option("--effects", request->effects, "separate these, instead of what the log left open")->excludes(log);
    verb->add_option("--out", request->out, "write the scenario to this file")->type_name("FILE");
    add_json_option(verb, outcome);
    verb->callback([=, &outcome] {
        nlohmann::json next;
        if (!request->effects.empty()) {
            std::string title;
            const std::string scenario = lab::next_scenario(request->effects, lab::read_model(request->input.model), title);
            next = {{"title", title}, {"scenario_toml", scenario}, {"separates", request->effects}};
        } else {
            if (request->input.log.empty()) throw CLI::ValidationError("next", "give --log LOG or --effects NAME...");
            const lab::Session session = lab::open_session(request->input);
            next = lab::next_json(lab::diagnose(session.model, session.data, {}), session.model);
        }
        outcome.json = {{"schema", "traction.lab/1"}, {"verb", "next"}, {"next", next}};
        if (next.is_null()) {
            std::printf("nothing is left open: no manoeuvre is needed\n");
            return;
        }
        std::printf("next: %s\nseparates:", next["title"].get<std::string>().c_str());
        for (const auto &effect : next["separates"]) std::printf(" %s", effect.get<std::string>().c_str());
        std::printf("\n");
        if (request->out.empty()) std::fputs(next["scenario_toml"].get<std::string>().c_str(), stdout);
        else report::write_text(next["scenario_toml"].get<std::string>(), request->out);
    });
}

} // namespace traction::cli
