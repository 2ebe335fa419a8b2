// Words to values. CLI11 splits the words of one verb into options and arguments; what is allowed, and what is told when it is not,
// comes from the verb's table. The only file that includes CLI11: it costs 8 s of compiling.
#include "parse.h"

#include "help.h"

#include "host_tools/suggest/suggest.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <deque>

namespace traction::cli {

namespace {

using Words = std::vector<std::string>;

std::string told_as(const Option &option) { return option.name.empty() ? option.argument : option.name; }

void in_range(const Option &option, const std::string &word, double value) {
    if (!option.range || (value >= option.range->low && value <= option.range->high)) return;
    const Range &r = *option.range;
    const std::string allowed = std::isinf(r.high)  ? "at least " + number_text(r.low)
                                : std::isinf(r.low) ? "at most " + number_text(r.high)
                                                    : number_text(r.low) + " to " + number_text(r.high);
    throw UsageError(told_as(option) + " " + word + ": give " + allowed);
}

template <typename Number> Number number_of(const Option &option, const std::string &word) {
    Number value = 0;
    const char *first = word.data() + (word.rfind('+', 0) == 0 ? 1 : 0), *last = word.data() + word.size();
    const auto [end, error] = std::from_chars(first, last, value);
    const bool whole = std::is_integral_v<Number>;
    if (error == std::errc::result_out_of_range) throw UsageError(told_as(option) + " " + word + ": is too large a number");
    if (error != std::errc() || end != last || first == last || std::isnan(static_cast<double>(value)))
        throw UsageError(told_as(option) + " '" + word + "': give " + (whole ? "a whole number" : "a number") +
                         (std::is_unsigned_v<Number> ? ", 0 or more" : ""));
    in_range(option, word, static_cast<double>(value));
    return value;
}

void allowed(const Option &option, const std::string &word) {
    if (!option.one_of.empty() && std::find(option.one_of.begin(), option.one_of.end(), word) == option.one_of.end()) {
        std::string all;
        for (const std::string &one : option.one_of) all += (all.empty() ? "" : ", ") + one;
        throw UsageError(told_as(option) + " '" + word + "': give one of " + all + did_you_mean(word, option.one_of));
    }
    if (option.check == nullptr) return;
    if (const std::string wrong = option.check(word); !wrong.empty()) throw UsageError(told_as(option) + " '" + word + "': " + wrong);
}

// Puts the words of one option where its table says.
struct Put {
    const Option &option;
    const Words &words;
    void operator()(std::monostate) const {}
    void operator()(bool *flag) const { *flag = true; }
    void operator()(std::string *text) const {
        if (words.front().empty()) throw UsageError(told_as(option) + " is given without a value: write " + option_words(option));
        allowed(option, words.front());
        *text = words.front();
    }
    void operator()(Words *list) const {
        list->clear();
        for (const std::string &word : words) {
            if (word.empty()) continue; // --profile alone
            allowed(option, word);
            list->push_back(word);
        }
    }
    template <typename Number> void operator()(Number *number) const { *number = number_of<Number>(option, words.front()); }
};

struct Taken {
    const Option *option;
    CLI::Option *parser;
    Words words;
};

void add(CLI::App &app, Taken &taken) {
    const Option &option = *taken.option;
    if (std::holds_alternative<bool *>(option.into)) {
        taken.parser = app.add_flag(option.name);
        return;
    }
    const std::string names = option.name.empty() || option.argument.empty() ? told_as(option) : option.argument + ',' + option.name;
    taken.parser = app.add_option(names, taken.words);
    if (!std::holds_alternative<Words *>(option.into) || option.at_most == 1)
        taken.parser->expected(1)->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    else if (option.at_most > 0)
        taken.parser->expected(0, option.at_most);
    if (option.delimiter != '\0') taken.parser->delimiter(option.delimiter);
    taken.parser->required(option.required);
}

const Taken *find(const std::deque<Taken> &all, const std::string &name) {
    for (const Taken &one : all)
        if (told_as(*one.option) == name) return &one;
    return nullptr;
}

bool used(const Taken *taken) { return taken != nullptr && taken->parser->count() > 0; }

void check_partners(const std::deque<Taken> &all) {
    for (const Taken &one : all) {
        const Option &option = *one.option;
        if (option.required && !used(&one)) throw UsageError("needs " + option_words(option) + ": " + option.help);
        if (!used(&one)) continue;
        for (const std::string &name : option.needs)
            if (!used(find(all, name))) throw UsageError(told_as(option) + " needs " + name + " beside it");
        for (const std::string &name : option.excludes)
            if (used(find(all, name))) throw UsageError(told_as(option) + " and " + name + " exclude each other");
        const bool scalar = !std::holds_alternative<bool *>(option.into) && !std::holds_alternative<Words *>(option.into);
        if (scalar && one.words.size() > 1)
            throw UsageError(told_as(option) + " is given twice: '" + one.words[0] + "' and '" + one.words[1] + "'");
    }
}

// An option that the verb does not have is named, with the one that was most likely meant.
void check_names(const Verb &verb, const std::vector<Option> &options, const Words &words) {
    Words known = {"--help"};
    for (const Option &option : options)
        if (!option.name.empty()) known.push_back(option.name);
    for (const std::string &word : words) {
        if (word == "--") return;
        if (word.size() < 2 || word[0] != '-' || word[1] == '.' || (word[1] >= '0' && word[1] <= '9')) continue;
        const std::string name = word.substr(0, word.find('='));
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw UsageError("there is no option " + name + did_you_mean(name, known, "traction " + verb.name + " --help"));
    }
}

void take(const Verb &verb, const std::vector<Option> &options, Words words) {
    check_names(verb, options, words);
    CLI::App app;
    app.set_help_flag();
    std::deque<Taken> all; // the parser keeps the addresses
    for (const Option &option : options) add(app, all.emplace_back(Taken{&option, nullptr, {}}));
    std::reverse(words.begin(), words.end()); // as CLI11 wants them
    try {
        app.parse(words);
    } catch (const CLI::RequiredError &) { // told by check_partners
    } catch (const CLI::ExtrasError &) {
        Words extras = app.remaining();
        throw UsageError("'" + (extras.empty() ? std::string() : extras.front()) + "' is one argument too many; `traction " + verb.name +
                         " --help` shows what it takes");
    } catch (const CLI::ParseError &error) {
        throw UsageError(error.what());
    }
    for (Taken &one : all)
        if (!std::holds_alternative<bool *>(one.option->into)) one.words = one.parser->results();
    check_partners(all);
    for (const Taken &one : all) {
        if (!used(&one)) continue;
        std::visit(Put{*one.option, one.words}, one.option->into);
        if (one.option->given != nullptr) *one.option->given = true;
    }
}

Parsed usage(const std::string &message) {
    Parsed parsed;
    parsed.exit_code = exit_usage;
    parsed.text = "traction" + message + "\n";
    return parsed;
}

Parsed shown(std::string text) {
    Parsed parsed;
    parsed.text = std::move(text);
    return parsed;
}

bool asks_help(const Words &words) {
    for (const std::string &word : words) {
        if (word == "--") return false;
        if (word == "--help" || word == "-h") return true;
    }
    return false;
}

Parsed parse_verb(const Verb &verb, const Words &words) {
    if (asks_help(words)) return shown(help_text(verb));
    Parsed parsed;
    std::vector<Option> options = verb.options;
    for (Option &option : common_options(parsed.json_file, parsed.quiet)) options.push_back(std::move(option));
    try {
        take(verb, options, words);
    } catch (const UsageError &error) {
        return usage(" " + verb.name + ": " + error.what());
    }
    parsed.verb = &verb;
    return parsed;
}

Words names_in(const std::string &group) {
    Words names;
    for (const Verb &verb : all_verbs()) {
        const std::size_t space = verb.name.find(' ');
        if (group.empty())
            names.push_back(verb.name.substr(0, space));
        else if (space != std::string::npos && verb.name.substr(0, space) == group)
            names.push_back(verb.name.substr(space + 1));
    }
    return names;
}

Parsed parse_group(const Group &group, Words words) {
    if (!words.empty() && words.front().rfind('-', 0) != 0) {
        for (const Verb &verb : all_verbs())
            if (verb.name == group.name + ' ' + words.front()) return parse_verb(verb, Words(words.begin() + 1, words.end()));
        return usage(" " + group.name + ": there is no '" + words.front() + "'" +
                     did_you_mean(words.front(), names_in(group.name), "traction " + group.name + " --help"));
    }
    if (asks_help(words)) return shown(help_text(group));
    Parsed parsed = usage(" " + group.name + ": say which");
    parsed.text += help_text(group);
    return parsed;
}

} // namespace

Parsed parse(int argc, const char *const *argv) {
    Words words(argv + std::min(argc, 1), argv + argc);
    if (!words.empty() && words.front() == "help") { // help VERB is VERB --help
        words.erase(words.begin());
        words.push_back("--help");
    }
    if (words.empty()) {
        Parsed parsed = usage(": give a verb");
        parsed.text += help_text();
        return parsed;
    }
    const std::string word = words.front();
    if (word == "--help" || word == "-h") return shown(help_text());
    if (word == "--version") return shown(version_text());
    const Words rest(words.begin() + 1, words.end());
    for (const Group &group : all_groups())
        if (group.name == word) return parse_group(group, rest);
    for (const Verb &verb : all_verbs())
        if (verb.name == word) return parse_verb(verb, rest);
    if (word.rfind('-', 0) == 0)
        return usage(": there is no option " + word + did_you_mean(word, {"--help", "--version"}, "traction --help"));
    return usage(": there is no verb '" + word + "'" + did_you_mean(word, names_in(""), "traction --help"));
}

} // namespace traction::cli
