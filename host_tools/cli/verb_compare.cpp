// verb_compare.cpp - traction compare: how far a model is from a log, balance by balance.
#include "verbs.h"

#include "host_tools/lab/result/compare.h"
#include "host_tools/lab/result/result.h"
#include "host_tools/lab/session.h"
#include "host_tools/report/report.h"

#include <cstdio>
#include <memory>

namespace traction::cli {

void add_compare(CLI::App &app, Outcome &outcome) {
    CLI::App *verb = app.add_subcommand("compare", "how far a model is from a log, and where it is worst");
    auto request = std::make_shared<lab::Request>();
    auto report = std::make_shared<std::string>();
    auto fitted = std::make_shared<bool>(false);
    verb->add_option("--model", request->model, "model file (TOML)")->required()->type_name("FILE");
    verb->add_option("--log", request->log, "log (CSV)")->required()->type_name("FILE");
    verb->add_option("--map", request->map, "map for a foreign CSV (TOML)")->type_name("FILE");
    verb->add_option("--repeat", request->repeat, "a second run of the same drive: its difference is the noise")->type_name("FILE");
    verb->add_option("--from", request->from_s, "use the log from this time [s]");
    verb->add_option("--to", request->to_s, "use the log up to this time [s]");
    verb->add_flag("--fitted", *fitted, "show the residual after the parameters moved within their priors");
    verb->add_option("--report", *report, "write a report page (HTML)")->type_name("FILE");
    add_json_option(verb, outcome);
    verb->callback([=, &outcome] {
        const lab::Session session = lab::open_session(*request);
        const lab::Comparison comparison = lab::compare(session.model, session.data, !*fitted);
        std::fputs(lab::comparison_text(comparison).c_str(), stdout);
        outcome.json = lab::head_json("compare", session.model, session.data);
        lab::put_comparison(outcome.json, comparison);
        if (!report->empty()) report::write_html(outcome.json, *report);
        if (comparison.balances.empty()) outcome.exit_code = exit_negative;
    });
}

} // namespace traction::cli
