// shell_text.h - the verbs' tables as shell completion and as manual pages.
#pragma once

#include "verbs.h"

#include <string>

namespace traction::cli {

std::string bash_completion(); // for `source`, or share/bash-completion/completions/traction
std::string zsh_completion();  // for `source`, or a file _traction in $fpath

std::string manual();             // traction(1), roff
std::string manual(const Verb &); // traction-<verb>(1); "bench lab" is traction-bench-lab(1)

} // namespace traction::cli
