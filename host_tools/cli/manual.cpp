#include "shell_text.h"

#include "help.h"
#include "rows.h"

#include <algorithm>

namespace traction::cli {

namespace {

std::string roff(const std::string &text) {
    std::string out;
    bool first = true; // of a line: a dot or a quote there would be a request
    for (const char c : text) {
        if (first && (c == '.' || c == '\'')) out += "\\&";
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
        first = c == '\n';
    }
    return out;
}

std::string dashed(std::string name) {
    std::replace(name.begin(), name.end(), ' ', '-');
    return name;
}

std::string head(const std::string &page, const std::string &summary) {
    std::string version = version_text(), upper = page;
    version.pop_back();
    std::transform(upper.begin(), upper.end(), upper.begin(), [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; });
    return ".TH \"" + upper + "\" 1 \"\" \"" + version + "\" \"Traction\"\n.SH NAME\n" + roff(page) + " \\- " + roff(summary) + '\n';
}

std::string item(const std::string &words, const std::string &text) { return ".TP\n.B " + roff(words) + '\n' + roff(text) + '\n'; }

const char *exit_codes = ".SH EXIT STATUS\n0 done, 1 the answer is negative, 2 wrong command line, 3 bad input, 4 file error, 70 a bug.\n";

} // namespace

std::string manual() {
    std::string text = head("traction", "ground speed, slip and traction of a small wheeled rover, its simulator and its lab") +
                       ".SH SYNOPSIS\n.B traction\n.I VERB\n[options]\n.SH VERBS\n";
    for (const Verb &verb : all_verbs()) text += item(verb.name, verb.summary + ". See traction-" + dashed(verb.name) + "(1).");
    return text + exit_codes + ".SH ENVIRONMENT\n" +
           item("TRACTION_ROOT", "the folder that holds scenarios/ and models/; without it they are looked for in the source "
                                 "tree of the build, then in share/traction of the prefix");
}

std::string manual(const Verb &verb) {
    std::string text = head("traction-" + dashed(verb.name), verb.summary) + ".SH SYNOPSIS\n.B traction " + roff(verb.name) + "\n" +
                       roff(synopsis(verb)) + "\n.SH OPTIONS\n";
    std::string json_file;
    bool quiet = false;
    for (const Option &option : rows(verb.options, common_options(json_file, quiet)))
        text += item(option_words(option), option_help(option));
    if (!verb.details.empty()) text += ".SH DESCRIPTION\n" + roff(verb.details) + '\n';
    return text + exit_codes + ".SH SEE ALSO\ntraction(1)\n";
}

} // namespace traction::cli
