#include "help.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace traction::cli {

namespace {

constexpr std::size_t indent = 30, width = 110;

// Text in lines of at most `width`, each later one indented.
std::string wrapped(std::string_view text, std::size_t used) {
    std::string out;
    while (!text.empty()) {
        const std::size_t space = std::min(text.find(' '), text.size());
        if (used > indent && used + 1 + space > width) {
            out += '\n' + std::string(indent, ' ');
            used = indent;
        } else if (!out.empty()) {
            out += ' ';
            ++used;
        }
        out += text.substr(0, space);
        used += space;
        text.remove_prefix(std::min(space + 1, text.size()));
    }
    return out + '\n';
}

std::string row(const std::string &words, const std::string &help) {
    std::string out = "  " + words;
    out += out.size() + 1 < indent ? std::string(indent - out.size(), ' ') : '\n' + std::string(indent, ' ');
    return out + wrapped(help, indent);
}

std::string joined(const std::vector<std::string> &words, const char *between) {
    std::string all;
    for (const std::string &word : words) all += (all.empty() ? "" : between) + word;
    return all;
}

struct DefaultText {
    std::string operator()(std::monostate) const { return ""; }
    std::string operator()(const bool *) const { return ""; }
    std::string operator()(const std::string *text) const { return *text; }
    std::string operator()(const std::vector<std::string> *list) const { return joined(*list, ","); }
    template <typename Number> std::string operator()(const Number *number) const { return number_text(static_cast<double>(*number)); }
};

std::string placeholder(const Option &option) {
    if (!option.value.empty()) return option.value;
    if (!option.argument.empty()) return option.argument;
    if (!option.one_of.empty()) return joined(option.one_of, "|");
    return std::holds_alternative<std::string *>(option.into) || std::holds_alternative<std::vector<std::string> *>(option.into) ? "TEXT"
                                                                                                                                 : "N";
}

std::vector<Option> with_common(const Verb &verb) {
    static std::string json_file;
    static bool quiet = false;
    std::vector<Option> options = verb.options;
    for (Option &option : common_options(json_file, quiet)) options.push_back(std::move(option));
    return options;
}

} // namespace

std::string number_text(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return std::string(text, end);
}

std::vector<Option> common_options(std::string &json_file, bool &quiet) {
    return {{.name = "--json",
             .into = &json_file,
             .help = "write the result as JSON to this file; - is standard output",
             .value = "FILE",
             .kind = Kind::output},
            {.name = "--quiet", .into = &quiet, .help = "no text on standard output and no progress; errors are still told"}};
}

std::string option_words(const Option &option) {
    if (std::holds_alternative<bool *>(option.into)) return option.name;
    const std::string value = placeholder(option);
    if (option.name.empty()) return value;
    return (option.argument.empty() ? "" : value + " or ") + option.name + ' ' + value;
}

std::string option_help(const Option &option) {
    std::string text = option.help;
    if (!option.one_of.empty()) text += ": " + joined(option.one_of, ", ");
    if (option.range && std::isfinite(option.range->low))
        text += " (" + number_text(option.range->low) +
                (std::isfinite(option.range->high) ? " to " + number_text(option.range->high) : " or more") + ')';
    if (option.shows_default) text += " [" + std::visit(DefaultText{}, option.into) + ']';
    if (!option.needs.empty()) text += "; with " + joined(option.needs, ", ");
    if (!option.excludes.empty()) text += "; not with " + joined(option.excludes, ", ");
    return text;
}

std::string synopsis(const Verb &verb) {
    std::string text;
    for (const Option &option : verb.options)
        if (!option.argument.empty()) text += (option.required ? " " : " [") + placeholder(option) + (option.required ? "" : "]");
    for (const Option &option : verb.options)
        if (option.argument.empty() && option.required) text += ' ' + option_words(option);
    return text.empty() ? "[options]" : text.substr(1) + " [options]";
}

std::string help_text(const Verb &verb) {
    std::string out = "traction " + verb.name + ": " + verb.summary + "\n\nUsage: traction " + verb.name + ' ' + synopsis(verb) + "\n\n";
    for (const Option &option : with_common(verb)) out += row(option_words(option), option_help(option));
    if (!verb.details.empty()) out += '\n' + verb.details + '\n';
    return out;
}

std::string help_text(const Group &group) {
    std::string out = "traction " + group.name + ": " + group.summary + "\n\n";
    for (const Verb &verb : all_verbs())
        if (verb.name.rfind(group.name + ' ', 0) == 0) out += row(verb.name, verb.summary);
    return out + "\n`traction " + group.name + " NAME --help` tells the options of one.\n";
}

std::string help_text() {
    std::string out = "Traction: ground speed, slip and traction of a small wheeled rover; its simulator; and the lab that finds\n"
                      "the physics its model lacks.\n\nUsage: traction VERB ...; `traction VERB --help` tells a verb's options\n\n";
    const Group *last = nullptr;
    for (const Verb &verb : all_verbs()) {
        const Group *group = nullptr;
        for (const Group &one : all_groups())
            if (verb.name.rfind(one.name + ' ', 0) == 0) group = &one;
        if (group == nullptr)
            out += row(verb.name, verb.summary);
        else if (group != last)
            out += row(group->name, group->summary);
        last = group;
    }
    out += row("--version", "version and commit");
    return out + '\n' + closing_text();
}

const char *closing_text() {
    return "Exit codes: 0 done, 1 the answer is negative, 2 wrong command line, 3 bad input, 4 file error, 70 a bug,\n128 + N stopped by "
           "signal N.\n"
           "The script ./traction of the sources also knows: test (build and run every test), build, prove, fuzz, mutate, help.\n";
}

} // namespace traction::cli
