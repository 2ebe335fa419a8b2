// verb_completion.cpp - traction completion bash|zsh: the shell's completion, from the verbs' tables.
#include "shell_text.h"
#include "verbs.h"

#include <cstdio>
#include <memory>

namespace traction::cli {

Verb verb_completion() {
    const auto shell = std::make_shared<std::string>();
    return {.name = "completion",
            .summary = "print the completion of bash or zsh; use it with: source <(traction completion bash)",
            .options = {{.argument = "SHELL", .into = shell.get(), .help = "which shell", .required = true, .one_of = {"bash", "zsh"}}},
            .run = [shell](Outcome &outcome) {
                const std::string text = *shell == "zsh" ? zsh_completion() : bash_completion();
                std::fputs(text.c_str(), stdout);
                outcome.json = {{"schema", "traction.completion/1"}, {"shell", *shell}, {"text", text}};
            }};
}

} // namespace traction::cli
