#include "shell_text.h"

#include "data_files.h"
#include "help.h"
#include "rows.h"

#include <algorithm>

namespace traction::cli {

namespace {

std::vector<Option> all_options(const Verb &verb) {
    static std::string json_file;
    static bool quiet = false;
    return rows(verb.options, common_options(json_file, quiet));
}

std::string spaced(const std::vector<std::string> &words) {
    std::string text;
    for (const std::string &word : words) text += (text.empty() ? "" : " ") + word;
    return text;
}

std::vector<std::string> first_words() {
    std::vector<std::string> words;
    for (const Verb &verb : all_verbs())
        if (verb.name.find(' ') == std::string::npos) words.push_back(verb.name);
    for (const Group &group : all_groups()) words.push_back(group.name);
    return words;
}

std::vector<std::string> members(const Group &group) {
    std::vector<std::string> words;
    for (const Verb &verb : all_verbs())
        if (verb.name.rfind(group.name + ' ', 0) == 0) words.push_back(verb.name.substr(group.name.size() + 1));
    return words;
}

bool is_flag(const Option &option) { return std::holds_alternative<bool *>(option.into); }

// What bash offers for a value.
std::string bash_offer(const Option &option) {
    if (!option.one_of.empty()) return "_traction_words \"" + spaced(option.one_of) + '"';
    switch (option.kind) {
    case Kind::effect:
        return "_traction_words \"" + spaced(effect_names()) + '"';
    case Kind::verb:
        return "_traction_words \"" + spaced(first_words()) + '"';
    case Kind::scenario:
        return "_traction_files \"" + spaced(data_names("scenarios")) + '"';
    case Kind::model:
        return "_traction_files \"" + spaced(data_names("models")) + '"';
    case Kind::rover:
        return "_traction_files \"" + spaced(data_names("rovers")) + '"';
    case Kind::input:
    case Kind::log:
    case Kind::output:
        return "_traction_files";
    case Kind::folder:
        return "COMPREPLY=($(compgen -d -- \"$cur\"))";
    case Kind::text:
        break;
    }
    return ":";
}

std::string bash_verb(const Verb &verb) {
    std::string names, values, argument;
    for (const Option &option : all_options(verb)) {
        if (!option.name.empty()) names += ' ' + option.name;
        if (!option.name.empty() && !is_flag(option)) values += "        " + option.name + ") " + bash_offer(option) + "; return ;;\n";
        if (!option.argument.empty() && argument.empty()) argument = bash_offer(option);
        if (option.kind == Kind::log && !option.argument.empty() && argument != bash_offer(option))
            argument += "; _traction_files \"${COMPREPLY[*]}\""; // an effect, then a log
    }
    return "    '" + verb.name + "')\n        case $prev in\n" + values +
           "        esac\n        case $cur in\n        -*) _traction_words \"--help" + names + "\" ;;\n        *) " +
           (argument.empty() ? ":" : argument) + " ;;\n        esac ;;\n";
}

std::string escaped(const std::string &text) { // inside '...' of _arguments
    std::string out;
    for (const char c : text) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
        out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return out;
}

std::string zsh_action(const Option &option) {
    if (!option.one_of.empty()) return '(' + spaced(option.one_of) + ')';
    switch (option.kind) {
    case Kind::effect:
        return '(' + spaced(effect_names()) + ')';
    case Kind::verb:
        return '(' + spaced(first_words()) + ')';
    case Kind::folder:
        return "_files -/";
    case Kind::scenario:
    case Kind::model:
    case Kind::rover:
        return "_files -g \"*.toml\"";
    case Kind::input:
    case Kind::log:
    case Kind::output:
        return "_files";
    case Kind::text:
        break;
    }
    return " ";
}

std::string zsh_verb(const Verb &verb) {
    std::string text = "    '" + verb.name + "') _arguments";
    for (const Option &option : all_options(verb)) {
        const std::string many = std::holds_alternative<std::vector<std::string> *>(option.into) ? "*" : "";
        const std::string value = is_flag(option) ? "" : ":value:" + zsh_action(option);
        if (!option.name.empty()) text += " \\\n        '" + many + option.name + '[' + escaped(option.help) + ']' + value + '\'';
        if (!option.argument.empty()) text += " \\\n        ':" + escaped(option.argument) + ':' + zsh_action(option) + '\'';
    }
    return text + " ;;\n";
}

} // namespace

std::string bash_completion() {
    std::string text = "# bash completion of traction, written by `traction completion bash`\n"
                       "_traction_words() { COMPREPLY+=($(compgen -W \"$1\" -- \"$cur\")); }\n"
                       "_traction_files() { COMPREPLY=($(compgen -W \"${1-}\" -- \"$cur\") $(compgen -f -- \"$cur\")); }\n"
                       "_traction() {\n    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} verb=${COMP_WORDS[1]}\n"
                       "    COMPREPLY=()\n    compopt -o filenames 2>/dev/null\n"
                       "    if [ \"$COMP_CWORD\" -eq 1 ]; then _traction_words \"--help --version " +
                       spaced(first_words()) + "\"; return; fi\n";
    for (const Group &group : all_groups())
        text += "    if [ \"$verb\" = " + group.name + " ]; then\n        if [ \"$COMP_CWORD\" -eq 2 ]; then _traction_words \"" +
                spaced(members(group)) + "\"; return; fi\n        verb=\"" + group.name + " ${COMP_WORDS[2]}\"\n    fi\n";
    text += "    case $verb in\n";
    for (const Verb &verb : all_verbs()) text += bash_verb(verb);
    return text + "    esac\n}\ncomplete -F _traction traction ./traction\n";
}

std::string zsh_completion() {
    std::string text = "#compdef traction\n# zsh completion of traction, written by `traction completion zsh`\n_traction() {\n    local -a "
                       "verbs\n    verbs=(";
    for (const Verb &verb : all_verbs())
        if (verb.name.find(' ') == std::string::npos) text += "\n        '" + verb.name + ':' + escaped(verb.summary) + '\'';
    for (const Group &group : all_groups()) text += "\n        '" + group.name + ':' + escaped(group.summary) + '\'';
    text +=
        ")\n    if (( CURRENT == 2 )); then _describe verb verbs; return; fi\n    local verb=$words[2]\n    shift words; (( CURRENT-- ))\n";
    for (const Group &group : all_groups())
        text += "    if [[ $verb == " + group.name + " ]]; then\n        if (( CURRENT == 2 )); then compadd " + spaced(members(group)) +
                "; return; fi\n        verb=\"" + group.name + " $words[2]\"\n        shift words; (( CURRENT-- ))\n    fi\n";
    text += "    case $verb in\n";
    for (const Verb &verb : all_verbs()) text += zsh_verb(verb);
    return text + "    esac\n}\nif [[ $funcstack[1] == _traction ]]; then _traction \"$@\"; else compdef _traction traction; fi\n";
}

} // namespace traction::cli
