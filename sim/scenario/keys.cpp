#include "keys.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace traction::sim {

namespace {

std::string build_message(const std::string &file, std::size_t line, const std::string &key, const std::string &value,
                          const std::string &what_is_wrong, const std::string &mend) {
    std::string text = file;
    if (line > 0) text += ':' + std::to_string(line);
    text += ": ";
    if (!key.empty()) text += key;
    if (!value.empty()) text += (key.empty() ? "" : " = ") + value;
    if (!key.empty() || !value.empty()) text += ": ";
    return text + what_is_wrong + "; " + mend;
}

std::string written(const toml::node &node) {
    std::ostringstream out;
    node.visit([&](const auto &value) {
        if constexpr (toml::is_table<decltype(value)>)
            out << "{...}";
        else
            out << value;
    });
    std::string text = out.str();
    if (text.size() > 60) text = text.substr(0, 57) + "...";
    for (char &c : text)
        if (static_cast<unsigned char>(c) < 32) c = ' ';
    return text;
}

std::string plain(double value) {
    std::ostringstream out;
    out << value;
    return out.str();
}

// Edit distance, for "did you mean".
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); j++) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); i++) {
        std::size_t corner = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); j++) {
            const std::size_t swap = corner + (a[i - 1] == b[j - 1] ? 0 : 1);
            corner = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, swap});
        }
    }
    return row[b.size()];
}

} // namespace

ScenarioError::ScenarioError(const std::string &file_, std::size_t line_, const std::string &key_, const std::string &value_,
                             const std::string &what_is_wrong, const std::string &mend_)
    : std::runtime_error(build_message(file_, line_, key_, value_, what_is_wrong, mend_)), file(file_), line(line_), key(key_),
      value(value_), mend(mend_) {}

Keys::Keys(const toml::table &table, std::string file, std::string path) : table_(table), file_(std::move(file)), path_(std::move(path)) {}

std::string Keys::full_name(std::string_view key) const { return path_.empty() ? std::string(key) : path_ + '.' + std::string(key); }

void Keys::fail_at(const toml::node &node, std::string_view key, const std::string &what_is_wrong, const std::string &mend) const {
    throw ScenarioError(file_, node.source().begin.line, full_name(key), written(node), what_is_wrong, mend);
}

void Keys::fail(std::string_view key, const std::string &what_is_wrong, const std::string &mend) const {
    if (const toml::node *node = table_.get(key)) fail_at(*node, key, what_is_wrong, mend);
    throw ScenarioError(file_, table_.source().begin.line, full_name(key), "", what_is_wrong, mend);
}

const toml::node *Keys::node(std::string_view key) {
    known_.emplace(key);
    return table_.get(key);
}

bool Keys::has(std::string_view key) { return node(key) != nullptr; }

double Keys::number_of(const toml::node &node, std::string_view key, Range range) const {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const double value = node.is_number() ? node.value<double>().value_or(none) : none;
    const std::string between = "give a number from " + plain(range.low) + " to " + plain(range.high);
    if (!std::isfinite(value)) fail_at(node, key, "not a finite number", between);
    if (value < range.low || value > range.high) fail_at(node, key, "out of range", between);
    return value;
}

double Keys::number(std::string_view key, double fallback, Range range) {
    const toml::node *found = node(key);
    return found != nullptr ? number_of(*found, key, range) : fallback;
}

double Keys::need_number(std::string_view key, Range range) {
    if (!has(key)) fail(key, "missing", "give a number from " + plain(range.low) + " to " + plain(range.high));
    return number(key, 0, range);
}

long Keys::integer(std::string_view key, long fallback, long low, long high) {
    const toml::node *found = node(key);
    if (found == nullptr) return fallback;
    const auto value = found->is_integer() ? found->value<std::int64_t>() : std::nullopt;
    if (!value || *value < low || *value > high)
        fail_at(*found, key, value ? "out of range" : "not a whole number",
                "give a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    return *value;
}

bool Keys::flag(std::string_view key, bool fallback) {
    const toml::node *found = node(key);
    if (found == nullptr) return fallback;
    if (!found->is_boolean()) fail_at(*found, key, "neither true nor false", "write true or false");
    return *found->value<bool>();
}

std::string Keys::text(std::string_view key, std::string_view fallback) {
    const toml::node *found = node(key);
    if (found == nullptr) return std::string(fallback);
    if (!found->is_string()) fail_at(*found, key, "not a text", "put it between double quotes");
    return *found->value<std::string>();
}

std::size_t Keys::word(std::string_view key, std::string_view fallback, std::span<const std::string_view> words) {
    const std::string value = text(key, fallback);
    std::string list;
    for (std::size_t i = 0; i < words.size(); i++) {
        if (words[i] == value) return i;
        list += (i > 0 ? ", " : "") + std::string(words[i]);
    }
    fail(key, value.empty() ? "missing" : "not known here", "use one of: " + list);
}

const toml::table *Keys::table(std::string_view key) {
    const toml::node *found = node(key);
    if (found != nullptr && !found->is_table()) fail_at(*found, key, "not a table", "write [" + full_name(key) + "] on a line of its own");
    return found != nullptr ? found->as_table() : nullptr;
}

const toml::array *Keys::array(std::string_view key) {
    const toml::node *found = node(key);
    if (found != nullptr && !found->is_array()) fail_at(*found, key, "not a list", "write it as [a, b, ...]");
    return found != nullptr ? found->as_array() : nullptr;
}

const toml::array *Keys::tables(std::string_view key) {
    const toml::node *found = node(key);
    if (found == nullptr) return nullptr;
    const toml::array *list = found->as_array();
    const std::string mend = "write [[" + full_name(key) + "]] on a line of its own, once for each";
    if (list == nullptr) fail_at(*found, key, "not a list of tables", mend);
    for (const toml::node &item : *list)
        if (!item.is_table()) fail_at(item, key, "not a table", mend);
    return list;
}

void Keys::finish() const {
    for (const auto &[key, value] : table_) {
        const std::string_view name = key.str();
        if (known_.contains(name)) continue;
        std::string nearest, list;
        std::size_t best = 4; // farther names are not what was meant
        for (const std::string &candidate : known_) {
            list += (list.empty() ? "" : ", ") + candidate;
            if (const std::size_t d = distance(candidate, name); d < best) {
                best = d;
                nearest = candidate;
            }
        }
        throw ScenarioError(file_, key.source().begin.line, full_name(name), value.is_table() || value.is_array() ? "" : written(value),
                            "unknown key", nearest.empty() ? "known here: " + list : "did you mean " + nearest + "?");
    }
}

} // namespace traction::sim
