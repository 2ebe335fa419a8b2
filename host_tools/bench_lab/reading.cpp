#include "reading.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <sstream>

namespace traction::bench_lab {

namespace {

using nlohmann::json;

const json &list_of(const json &from, const char *key) {
    static const json none = json::array();
    const auto found = from.find(key);
    return found != from.end() && found->is_array() ? *found : none;
}

double number(const json &from, const char *key, double otherwise = 0) {
    const auto found = from.find(key);
    return found != from.end() && found->is_number() ? found->get<double>() : otherwise;
}

std::string text(const json &from, const char *key) {
    const auto found = from.find(key);
    return found != from.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// "wiring_resistance on wheel 2" -> "wiring_resistance"
std::string plain(const std::string &label) { return label.substr(0, label.find(' ')); }

int wheel_of(const std::string &label) {
    const std::size_t at = label.find(" on wheel ");
    return at == std::string::npos ? -1 : std::atoi(label.c_str() + at + 10);
}

// Effects that the lab says cannot be told apart from `name` in this log, itself included.
std::set<std::string> class_of(const std::string &name, const json &result) {
    std::set<std::string> members = {name};
    for (const json &one : list_of(result, "classes")) {
        const json &names = list_of(one, "members");
        const bool inside =
            std::any_of(names.begin(), names.end(), [&](const json &n) { return n.is_string() && plain(n.get<std::string>()) == name; });
        if (!inside) continue;
        for (const json &n : names)
            if (n.is_string()) members.insert(plain(n.get<std::string>()));
    }
    return members;
}

bool listed(const std::string &word, const std::string &list) { // in "a|b|c"
    return !word.empty() && ("|" + list + "|").find("|" + word + "|") != std::string::npos;
}

// What is true of the sensors though nobody hid it: an accelerometer that is late may be told so.
bool true_of_the_chain(const std::string &name, const json &seal) {
    const json chain = seal.value("chain", json::object());
    const bool late = number(chain, "accel_late_s") > 0 || number(chain, "accel_cutoff_Hz") > 0;
    return late && (name == "accel_delay" || name == "accel_lag");
}

constexpr double not_given = std::numeric_limits<double>::quiet_NaN();

void coverage(const json &effect, const json &result, Reading &reading) {
    const std::string name = text(effect, "name");
    for (const json &candidate : list_of(result, "accepted")) { // the joint fit's values, which the user is shown
        if (plain(text(candidate, "effect")) != name || static_cast<int>(number(candidate, "wheel", -1)) != effect.value("wheel", -1))
            continue;
        const auto parameters = candidate.find("parameters");
        if (parameters == candidate.end() || !parameters->is_object()) continue;
        for (const auto &[key, value] : effect.at("parameters").items()) {
            const auto fitted = parameters->find(key);
            if (fitted == parameters->end() || !fitted->is_object()) continue;
            const double low = number(*fitted, "low", not_given), high = number(*fitted, "high", not_given), truth = value.get<double>();
            if (std::isfinite(low) && std::isfinite(high)) reading.covered.push_back(truth >= low && truth <= high);
        }
        return;
    }
}

// Where no fit with the truth was made: the lab's d' of its own estimate, scaled by hidden size / estimate (so hidden size / standard
// error).
double detectability(const json &effect, const json &result) {
    double best = 0;
    for (const json &candidate : list_of(result, "candidates")) {
        if (plain(text(candidate, "effect")) != text(effect, "name")) continue;
        if (static_cast<int>(number(candidate, "wheel", -1)) != effect.value("wheel", -1)) continue;
        const auto parameters = candidate.find("parameters");
        if (parameters == candidate.end() || !parameters->is_object()) continue;
        for (const auto &[key, value] : effect.at("parameters").items()) {
            const auto fitted = parameters->find(key);
            if (fitted == parameters->end() || !fitted->is_object() || !fitted->contains("low")) continue; // a shape parameter
            const double size = std::fabs(number(*fitted, "value"));
            if (size > 0) best = std::max(best, number(candidate, "detectability") * std::fabs(value.get<double>()) / size);
        }
    }
    return best;
}

bool variable_right(const std::string &accepted, const json &result) {
    const auto unknown = result.find("unknown");
    if (unknown == result.end() || !unknown->is_object()) return false;
    const std::string said = text(*unknown, "variable") + " " + text(*unknown, "balance");
    std::istringstream list(accepted);
    std::string word;
    while (std::getline(list, word, '|'))
        if (said.find(word) != std::string::npos) return true;
    return false;
}

} // namespace

Reading read_case(const json &seal, const json &result) {
    Reading r;
    r.category = text(seal, "category");
    const json &hidden = list_of(seal, "effects");
    std::set<std::string> truths;
    for (const json &effect : hidden) truths.insert(text(effect, "name"));
    r.has_lag = truths.count("backlash") + truths.count("relaxation_length") > 0;
    if (!hidden.empty()) r.truth = text(hidden[0], "name"), r.truth_wheel = hidden[0].value("wheel", -1);

    const json verdict = result.value("verdict", json::object());
    const std::string kind = text(verdict, "kind");
    const auto unknown = result.find("unknown");
    r.flagged_unknown = kind == "unknown" || kind == "partial" || kind == "wrong_model" ||
                        (unknown != result.end() && unknown->is_object() && !unknown->empty());
    std::set<std::string> found;
    int wheel_said = -1;
    const std::string law = hidden.empty() ? "" : text(hidden[0], "law"); // outside: the catalogue's own name, where it has learnt it
    bool law_named = false;
    for (const json &name : list_of(verdict, "effects")) {
        const std::string label = name.get<std::string>();
        if (label.rfind("shape:", 0) == 0) continue;
        if (truths.count(plain(label)) == 0 && true_of_the_chain(plain(label), seal)) continue; // right, and no answer to the question
        if (r.named.empty()) wheel_said = wheel_of(label);
        r.named.push_back(plain(label));
        bool right = false;
        for (const std::string &member : class_of(plain(label), result))
            if (truths.count(member) != 0)
                right = true, found.insert(member);
            else if (listed(member, law))
                right = law_named = true;
        r.named_right.push_back(right);
    }
    // one class among several names of a "class" verdict counts once
    if (kind == "class" && std::find(r.named_right.begin(), r.named_right.end(), true) != r.named_right.end())
        r.named_right.assign(1, true);
    else if (kind == "class" && !r.named_right.empty())
        r.named_right.assign(1, false);
    r.truths_named = static_cast<int>(found.size());
    r.first_named_right = !r.named_right.empty() && r.named_right.front();
    const json &candidates = list_of(result, "candidates");
    if (!candidates.empty() && !r.truth.empty()) {
        const std::string first = text(candidates[0], "effect");
        r.first_right = class_of(plain(first), result).count(r.truth) != 0;
        if (r.named.empty()) wheel_said = static_cast<int>(number(candidates[0], "wheel", -1));
    }
    if (r.first_named_right) r.first_right = true;
    for (const json &candidate : candidates) // the ranking carries the wheel as a number
        if (!r.named.empty() && plain(text(candidate, "effect")) == r.named.front() && wheel_said < 0) {
            wheel_said = static_cast<int>(number(candidate, "wheel", -1));
            break;
        }
    r.wheel_right = wheel_said == r.truth_wheel;
    for (const json &effect : hidden)
        if (found.count(text(effect, "name")) != 0) coverage(effect, result, r);
    if (!hidden.empty()) r.detectability = number(result, "detectability_with_truth", detectability(hidden[0], result));
    r.visible = r.detectability >= 2;
    if (r.category == "outside" && law_named) r.flagged_unknown = r.variable_right = true; // it told what it is
    if (r.category == "outside" && r.flagged_unknown && !law_named) r.variable_right = variable_right(text(hidden[0], "variable"), result);

    r.silent = r.named.empty() && !r.flagged_unknown;
    r.said =
        r.named.empty()
            ? (r.flagged_unknown
                   ? "(unknown: " + (unknown != result.end() && unknown->is_object() ? text(*unknown, "variable") : std::string("?")) + ")"
                   : "(nothing)")
            : (r.first_named_right && !r.truth.empty() ? r.truth : r.named.front());
    const json &ladder = list_of(result, "ladder");
    const double floor = number(result, "floor_with_truth");
    if (!ladder.empty() && floor > 0) r.error_over_floor = number(ladder.back(), "train") / floor;
    return r;
}

json reading_json(const Reading &r) {
    return {{"category", r.category},
            {"truth", r.truth},
            {"truth_wheel", r.truth_wheel},
            {"detectability", r.detectability},
            {"visible", r.visible},
            {"said", r.said},
            {"named", r.named},
            {"named_right", r.named_right},
            {"covered", r.covered},
            {"silent", r.silent},
            {"first_right", r.first_right},
            {"first_named_right", r.first_named_right},
            {"wheel_right", r.wheel_right},
            {"truths_named", r.truths_named},
            {"flagged_unknown", r.flagged_unknown},
            {"variable_right", r.variable_right},
            {"has_lag", r.has_lag},
            {"error_over_floor", r.error_over_floor}};
}

Reading read_reading(const json &entry) {
    Reading r;
    r.category = entry.at("category").get<std::string>();
    r.truth = entry.at("truth").get<std::string>();
    r.truth_wheel = entry.at("truth_wheel").get<int>();
    r.detectability = number(entry, "detectability");
    r.visible = entry.at("visible").get<bool>();
    r.said = entry.at("said").get<std::string>();
    r.named = entry.at("named").get<std::vector<std::string>>();
    r.named_right = entry.at("named_right").get<std::vector<bool>>();
    r.covered = entry.at("covered").get<std::vector<bool>>();
    r.silent = entry.at("silent").get<bool>();
    r.first_right = entry.at("first_right").get<bool>();
    r.first_named_right = entry.at("first_named_right").get<bool>();
    r.wheel_right = entry.at("wheel_right").get<bool>();
    r.truths_named = entry.at("truths_named").get<int>();
    r.flagged_unknown = entry.at("flagged_unknown").get<bool>();
    r.variable_right = entry.at("variable_right").get<bool>();
    r.has_lag = entry.at("has_lag").get<bool>();
    r.error_over_floor = number(entry, "error_over_floor");
    return r;
}

} // namespace traction::bench_lab
