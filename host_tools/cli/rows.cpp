#include "rows.h"

#include "host_tools/lab/session.h"
#include "host_tools/suggest/suggest.h"
#include "sim/physics/effects/catalogue.h"

namespace traction::cli {

Option log_row(std::string &log, const char *help, bool required) {
    return {.name = "--log", .argument = "LOG", .into = &log, .help = help, .kind = Kind::log, .required = required};
}

Option map_row(std::string &map) {
    return {.name = "--map",
            .into = &map,
            .help = "read a foreign CSV through this map (TOML, docs/log_format.md)",
            .value = "FILE",
            .kind = Kind::input};
}

Option model_row(std::string &model) {
    return {.name = "--model", .into = &model, .help = "model file (TOML)", .value = "FILE", .kind = Kind::model, .required = true};
}

Option report_row(std::string &report) {
    return {.name = "--report", .into = &report, .help = "write a report page (HTML)", .value = "FILE", .kind = Kind::output};
}

Option details_row(bool &details) {
    return {.name = "--details", .into = &details, .help = "print the statistics too: p, d', bias, R2, intervals of the gains"};
}

Option despite_row(std::vector<std::string> &despite) {
    return {.name = "--despite",
            .into = &despite,
            .help = "learn although the check found this error (its id, such as sign); written into result and lineage",
            .value = "ID",
            .at_most = 1};
}

std::vector<Option> lab_rows(lab::Request &request) {
    return {{.name = "--log",
             .argument = "LOG",
             .into = &request.logs,
             .help = "log (CSV); given again: further runs of the same machine, fitted together",
             .kind = Kind::log,
             .required = true,
             .at_most = 1},
            model_row(request.model),
            {.name = "--map",
             .into = &request.maps,
             .help = "read a foreign CSV through this map (TOML, docs/log_format.md); one for all logs, or one for each",
             .value = "FILE",
             .kind = Kind::input,
             .at_most = 1},
            {.name = "--repeat",
             .into = &request.repeat,
             .help = "a second run of the same drive: its difference is the noise",
             .value = "FILE",
             .kind = Kind::log},
            {.name = "--from", .into = &request.from_s, .help = "use the log from this time [s]", .value = "S"},
            {.name = "--to", .into = &request.to_s, .help = "use the log up to this time [s]", .value = "S"},
            despite_row(request.despite)};
}

Option validate_row(std::vector<std::string> &logs) {
    return {.name = "--validate",
            .into = &logs,
            .help = "judge the result on these logs, which are never fitted (read through the first --map)",
            .value = "LOG...",
            .kind = Kind::log};
}

std::vector<std::string> effect_names() {
    std::vector<std::string> names;
    for (const sim::Effect &effect : sim::catalogue()) names.emplace_back(effect.name);
    return names;
}

void need_effect(const std::string &option, const std::string &text, const char *end) {
    const std::string name = text.substr(0, text.find_first_of(end));
    if (sim::find_effect(name) == nullptr)
        throw UsageError(option + ": there is no effect '" + name + "'" + did_you_mean(name, effect_names(), "traction effects"));
}

std::vector<Option> rows(std::vector<Option> first, std::vector<Option> then) {
    for (Option &option : then) first.push_back(std::move(option));
    return first;
}

} // namespace traction::cli
