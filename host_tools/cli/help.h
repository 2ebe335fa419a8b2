// help.h - what the verbs' tables say to people: --help and its pieces, which the manual pages use as well.
#pragma once

#include "verbs.h"

#include <string>
#include <vector>

namespace traction::cli {

std::string help_text();              // traction --help
std::string help_text(const Verb &);  // traction VERB --help
std::string help_text(const Group &); // traction GROUP --help
std::string version_text();           // traction --version: version, commit, licence

// The shortest text that reads back to the same double.
std::string number_text(double value);

// The options that every verb has beside its own, with their targets.
std::vector<Option> common_options(std::string &json_file, bool &quiet);

// "--out FILE", "LOG or --log LOG", "--quiet": how an option is written.
std::string option_words(const Option &option);

// "SCENARIO [--out LOG] [--seed N]": a verb's usage, its arguments first.
std::string synopsis(const Verb &verb);

// The help of an option with what its table adds: allowed values, range, default, partners.
std::string option_help(const Option &option);

// The text behind the list of verbs: exit codes and environment.
const char *closing_text();

} // namespace traction::cli
