#include "model_reader.h"

#include "host_tools/suggest/suggest.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace traction::lab {

std::string number_text(double value) {
    std::ostringstream stream;
    stream << std::setprecision(10) << value;
    return stream.str();
}

void ModelReader::fail(const toml::node &node, const std::string &key, const std::string &wrong, const std::string &mend) const {
    throw ModelError(file, node.source().begin.line, key, wrong, mend);
}

double ModelReader::number(const toml::node &node, const std::string &key) const {
    const auto value = node.value<double>();
    if (!value || node.is_boolean()) fail(node, key, "is not a number", "give a number in SI units, or a table { value = ... }");
    if (!std::isfinite(*value)) fail(node, key, "is " + number_text(*value), "give a finite number");
    return *value;
}

std::string ModelReader::text_of(const toml::node &node, const std::string &path) const {
    if (!node.is_string()) fail(node, path, "is not a text", "write it in quotes");
    return node.value_or(std::string());
}

bool ModelReader::flag_of(const toml::node &node, const std::string &path) const {
    if (!node.is_boolean()) fail(node, path, "is neither true nor false", "write true or false, without quotes");
    return node.value_or(false);
}

std::string ModelReader::text(const toml::table &source, const std::string &where, const char *key, const std::string &fallback) const {
    const toml::node *node = source.get(key);
    return node == nullptr ? fallback : text_of(*node, where.empty() ? key : where + "." + key);
}

bool ModelReader::flag(const toml::table &source, const std::string &where, const char *key, bool fallback) const {
    const toml::node *node = source.get(key);
    return node == nullptr ? fallback : flag_of(*node, where + "." + key);
}

void ModelReader::parameter(const toml::node &node, const std::string &key, Parameter &p) const {
    p.given = true;
    const toml::table *table = node.as_table();
    if (table == nullptr) {
        p.value = number(node, key);
    } else {
        bool has_value = false;
        for (const auto &[name_key, item] : *table) {
            const std::string name(name_key.str());
            const std::string path = key + "." + name;
            if (name == "value")
                p.value = number(item, path), has_value = true;
            else if (name == "min")
                p.minimum = number(item, path);
            else if (name == "max")
                p.maximum = number(item, path);
            else if (name == "prior")
                p.prior = number(item, path);
            else if (name == "each_wheel")
                p.each_wheel = number(item, path);
            else if (name == "low")
                p.low = number(item, path);
            else if (name == "high")
                p.high = number(item, path);
            else if (name == "fixed")
                p.fixed = flag_of(item, path);
            else if (name == "source")
                p.source = text_of(item, path);
            else if (name == "unit")
                check_unit(item, path, p);
            else
                fail(item, path, "is not known", "a parameter may have value, unit, min, max, prior, each_wheel, fixed, source, low, high");
        }
        if (!has_value) fail(node, key, "has no value", "add value = NUMBER to the table");
    }
    if (p.prior < 0) fail(node, key, "has a negative prior", "prior is a standard deviation: give 0 or more");
    if (!(p.each_wheel >= 0 && p.each_wheel < 1))
        fail(node, key, "has each_wheel = " + number_text(p.each_wheel),
             "give the standard deviation of one wheel's value as a share of the value, such as 0.01");
    if (p.minimum > p.maximum) fail(node, key, "has min > max", "exchange the two");
    if (p.value < p.minimum || p.value > p.maximum)
        fail(node, key, number_text(p.value) + " is outside " + number_text(p.minimum) + " to " + number_text(p.maximum),
             "check the unit (" + p.unit + "), or widen min and max");
}

void ModelReader::check_unit(const toml::node &item, const std::string &path, Parameter &p) const {
    const std::string unit = text_of(item, path);
    const auto plain = [](std::string text) {
        for (char &c : text)
            if (c == '*') c = ' ';
        std::erase(text, ' ');
        return text == "-" || text.empty() ? std::string("1") : text;
    };
    if (p.unit.empty())
        p.unit = unit;
    else if (plain(unit) != plain(p.unit))
        fail(item, path, "is \"" + unit + "\"", "this key is in " + p.unit + ": convert the value");
}

namespace {

// What a key that nobody knows was to be: the nearest that may stand there, else all of them.
std::string known_keys(const std::string &name, std::span<const ModelKey> known, const std::vector<std::string> &also,
                       const std::string &prefix) {
    std::vector<std::string> keys = also, whole;
    for (const ModelKey &k : known) {
        if (k.key.starts_with(prefix)) keys.emplace_back(k.key.substr(prefix.size()));
        whole.emplace_back(k.key);
    }
    const auto meant = [](const std::string &word, const std::vector<std::string> &among) {
        const std::string *found = nearest(word, among, std::max<std::size_t>(2, word.size() / 3));
        return found == nullptr ? std::string() : "did you mean " + *found + "?";
    };
    if (const std::string text = meant(name, keys); !text.empty()) return text;
    if (const std::string text = keys.empty() ? meant(prefix + name, whole) : ""; !text.empty()) return text;
    std::string all;
    for (const std::string &key : keys.empty() ? whole : keys) all += (all.empty() ? "known here: " : ", ") + key;
    return all;
}

} // namespace

void ModelReader::table(const toml::table &source, const std::string &where, std::span<const ModelKey> known, Parameters &into,
                        const std::vector<std::string> &also, const std::string &prefix) const {
    for (const auto &[name_key, node] : source) {
        const std::string name(name_key.str());
        if (std::find(also.begin(), also.end(), name) != also.end()) continue;
        const auto found = std::find_if(known.begin(), known.end(), [&](const ModelKey &k) { return k.key == prefix + name; });
        if (found == known.end()) fail(node, where + "." + name, "is not a known key", known_keys(name, known, also, prefix));
        Parameter p = into.count(prefix + name) != 0 ? into.at(prefix + name) : Parameter{};
        p.unit = found->unit;
        p.minimum = found->minimum;
        p.maximum = found->maximum;
        p.prior = -1;
        const bool own_prior = node.is_table() && node.as_table()->contains("prior");
        const bool own_each = node.is_table() && node.as_table()->contains("each_wheel");
        if (own_each && (known.data() == rover_keys().data() || known.data() == sensor_keys().data()))
            fail(node, where + "." + name, "has each_wheel, but there is one for all wheels", "leave each_wheel out here");
        p.prior = 0;
        p.each_wheel = found->each_wheel;
        parameter(node, where + "." + name, p);
        if (!own_prior) p.prior = std::max(found->relative_prior * std::fabs(p.value), found->absolute_prior);
        if (!own_each && own_prior && p.prior == 0) p.each_wheel = 0;
        if (p.fixed) p.prior = p.each_wheel = 0;
        into[prefix + name] = p;
    }
}

} // namespace traction::lab
