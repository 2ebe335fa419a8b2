// rows.h - rows of the verbs' tables that several verbs share.
#pragma once

#include "verbs.h"

namespace traction::lab {
struct Request;
}

namespace traction::cli {

Option log_row(std::string &log, const char *help = "log (CSV)", bool required = true); // as an argument and as --log
Option map_row(std::string &map);
Option model_row(std::string &model);
Option despite_row(std::vector<std::string> &despite); // --despite ID, may be given again
Option validate_row(std::vector<std::string> &logs);
Option report_row(std::string &report);
Option details_row(bool &details); // --details: the statistics too

// LOG, --model, --map, --repeat, --from, --to: what the lab's verbs read.
std::vector<Option> lab_rows(lab::Request &request);

// Every effect of the catalogue.
std::vector<std::string> effect_names();

// Throws UsageError when the part of `text` before `end` is no effect, with the one most likely meant.
void need_effect(const std::string &option, const std::string &text, const char *end);

// The rows of `first`, then those of `then`.
std::vector<Option> rows(std::vector<Option> first, std::vector<Option> then);

} // namespace traction::cli
