#include "map.h"
#include "vocabulary.h"

#include "host_tools/suggest/suggest.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <muParser.h>
#include <numbers>
#include <set>
#include <toml++/toml.h>

namespace traction::log {

namespace {

std::size_t line_of(const toml::node &node) { return node.source().begin.line; }

// One table of the map: typed keys, and an error for a key nobody knows.
class Keys {
  public:
    Keys(const std::string &path, const toml::table &table, std::string where) : path_(path), table_(table), where_(std::move(where)) {}

    bool has(const char *key) { return look(key) != nullptr; }
    std::string text(const char *key, const std::string &fallback) { return get<std::string>(key, "a text in quotes").value_or(fallback); }
    std::optional<double> number(const char *key) {
        const toml::node *node = look(key);
        if (node == nullptr) return std::nullopt;
        const std::optional<double> value = node->value<double>();
        if (!node->is_number() || !value || !std::isfinite(*value)) fail(*node, key, "a finite number");
        return value;
    }
    double number(const char *key, double fallback) { return number(key).value_or(fallback); }
    bool flag(const char *key) { return get<bool>(key, "true or false").value_or(false); }
    std::vector<double> numbers(const char *key) {
        std::vector<double> values;
        const toml::node *node = look(key);
        if (node == nullptr) return values;
        if (!node->is_array()) fail(*node, key, "a list of numbers, such as [-1, 999]");
        for (const toml::node &item : *node->as_array()) {
            if (!item.is_number()) fail(item, key, "a list of numbers, such as [-1, 999]");
            values.push_back(*item.value<double>());
        }
        return values;
    }
    // A column by name, or by number from 1.
    std::string column(const char *key) {
        const toml::node *node = look(key);
        if (node == nullptr) return "";
        const std::string name = column_of(*node);
        if (name.empty()) fail(*node, key, "the name of a column, or its number from 1");
        return name;
    }
    // Exactly so many of them; none where the key is not there.
    std::vector<std::string> columns(const char *key, std::size_t count, const std::string &wanted) {
        const toml::node *node = look(key);
        if (node == nullptr) return {};
        std::vector<std::string> names;
        if (const toml::array *list = node->as_array())
            for (const toml::node &item : *list) names.push_back(column_of(item));
        if (names.size() != count || std::find(names.begin(), names.end(), "") != names.end()) fail(*node, key, wanted);
        return names;
    }
    // Names of columns by short names, as the variables of an expression; none where the key is not there.
    std::vector<std::pair<std::string, std::string>> named_columns(const char *key) {
        const toml::node *node = look(key);
        std::vector<std::pair<std::string, std::string>> named;
        if (node == nullptr) return named;
        const toml::table *table = node->as_table();
        const char *wanted = "short names of columns, such as { p = \"pwm_left\", d = \"dir_left\" }";
        if (table == nullptr || table->empty()) fail(*node, key, wanted);
        for (const auto &[name, column] : *table) {
            named.emplace_back(std::string(name.str()), column_of(column));
            if (named.back().second.empty()) fail(column, key, wanted);
        }
        return named;
    }
    const toml::node *look(const char *key) {
        known_.insert(key);
        return table_.get(key);
    }
    // To call when every key has been looked at.
    void none_unknown() const {
        for (const auto &[key, node] : table_) {
            if (known_.count(std::string(key.str())) != 0) continue;
            std::string list;
            for (const std::string &name : known_) list += (list.empty() ? "" : ", ") + name;
            throw LogError(path_, line_of(node), 0, "unknown key '" + std::string(key.str()) + "' in " + where_, "use one of: " + list);
        }
    }
    [[noreturn]] void fail(const toml::node &node, const char *key, const std::string &wanted) const {
        throw LogError(path_, line_of(node), 0, "'" + std::string(key) + "' in " + where_ + " has the wrong value", "write " + wanted);
    }
    std::size_t line() const { return line_of(table_); }
    [[noreturn]] void fail(const std::string &what, const std::string &mend) const { throw LogError(path_, line(), 0, what, mend); }

  private:
    // Empty: it is neither a name nor a number.
    static std::string column_of(const toml::node &node) {
        if (const auto number = node.value_exact<std::int64_t>()) return std::to_string(*number);
        return node.value_exact<std::string>().value_or("");
    }
    template <class T> std::optional<T> get(const char *key, const char *wanted) {
        const toml::node *node = look(key);
        if (node == nullptr) return std::nullopt;
        const std::optional<T> value = node->value_exact<T>();
        if (!value) fail(*node, key, wanted);
        return value;
    }
    const std::string &path_;
    const toml::table &table_;
    std::string where_;
    std::set<std::string> known_;
};

const toml::table &as_table(const std::string &path, const toml::node &node, const char *key) {
    if (!node.is_table())
        throw LogError(path, line_of(node), 0, std::string("'") + key + "' is not a table",
                       std::string("write [") + key + "] or [[" + key + "]] on a line of its own");
    return *node.as_table();
}

// Variables in the order of signal.columns. Throws mu::Parser::exception_type.
class Formula {
  public:
    explicit Formula(const MapSignal &signal) : values_(signal.columns.size()) {
        for (std::size_t i = 0; i < values_.size(); ++i) parser_.DefineVar(signal.columns[i].first, &values_[i]);
        parser_.DefineConst("pi", std::numbers::pi);
        parser_.SetExpr(signal.expression);
        parser_.Eval(); // finds syntax errors and unknown names now
    }
    double &variable(std::size_t i) { return values_[i]; }
    double value() const { return parser_.Eval(); }

  private:
    std::vector<double> values_;
    mu::Parser parser_;
};

void compile(const MapSignal &signal, const Keys &keys) {
    try {
        Formula{signal};
    } catch (const mu::Parser::exception_type &error) {
        keys.fail("the expression of '" + signal.name + "' is not understood: " + error.GetMsg(),
                  "use the names in 'columns', pi and muparser's functions");
    }
}

MapSignal read_signal(const std::string &path, const toml::table &table, std::size_t index) {
    Keys keys(path, table, "[[signal]] number " + std::to_string(index));
    MapSignal signal;
    signal.line = keys.line();
    signal.name = keys.text("name", "");
    if (signal.name.empty())
        keys.fail("[[signal]] number " + std::to_string(index) + " has no name",
                  "write name = \"wheel0.speed_rad_s\" or another name of docs/log_format.md");
    if (find_quantity(signal.name) == nullptr) {
        std::string si_name;
        double factor = 1;
        if (convert_unit(signal.name, si_name, factor)) {
            keys.fail("signal '" + signal.name + "' is not in SI",
                      "write name = \"" + si_name + "\" and scale = " + std::to_string(factor));
        }
        keys.fail("signal '" + signal.name + "' is not in the vocabulary", "use a name of docs/log_format.md");
    }
    signal.column = keys.column("column");
    signal.value = keys.number("value");
    signal.expression = keys.text("expression", "");
    signal.columns = keys.named_columns("columns");
    if (signal.expression.empty() != signal.columns.empty())
        keys.fail("signal '" + signal.name + "' needs 'expression' and 'columns' together",
                  "write expression = \"p/255*(2*d - 1)\" and columns = { p = \"its column\", d = \"its column\" }");
    if (!signal.expression.empty()) compile(signal, keys);
    signal.quaternion = keys.columns("quaternion", 4, "the columns of w, x, y and z, such as [\"qw\", \"qx\", \"qy\", \"qz\"]");
    if ((signal.column.empty() ? 0 : 1) + (signal.value ? 1 : 0) + (signal.quaternion.empty() ? 0 : 1) +
            (signal.expression.empty() ? 0 : 1) !=
        1) {
        keys.fail("signal '" + signal.name + "' needs either 'column' or 'value'",
                  "write column = \"its column\", or value = 24.0 for a constant, or 'expression', or 'quaternion'");
    }
    signal.scale = keys.number("scale", 1);
    const double sign = keys.number("sign", 1);
    if (sign != 1 && sign != -1)
        keys.fail("sign of '" + signal.name + "' is neither 1 nor -1", "write sign = -1, and put the size in 'scale'");
    if (signal.scale == 0) keys.fail("scale of '" + signal.name + "' is 0", "write the unit's size, e.g. 0.001 for millimetres");
    signal.scale *= sign;
    signal.offset = keys.number("offset", 0);
    signal.delay_s = keys.number("delay_s", 0);
    signal.is_unsigned = keys.flag("unsigned");
    signal.unwrap = keys.flag("unwrap");
    signal.period = keys.number("period", 2 * std::numbers::pi);
    if (!(signal.period > 0))
        keys.fail("period of '" + signal.name + "' is not above 0", "write the size of one turn in the signal's unit");
    signal.differentiate = keys.flag("differentiate");
    signal.window_s = keys.number("window_s", 0.1);
    if (!(signal.window_s > 0))
        keys.fail("window_s of '" + signal.name + "' is not above 0", "write the span of time to fit the slope over, e.g. 0.1");
    signal.drop_repeats = keys.flag("drop_repeats");
    signal.noise = keys.number("noise");
    if (signal.noise && !(*signal.noise > 0))
        keys.fail("noise of '" + signal.name + "' is not above 0", "write its standard deviation in the signal's unit, or leave it out");
    signal.quantum = keys.number("quantum");
    if (signal.quantum && !(*signal.quantum > 0))
        keys.fail("quantum of '" + signal.name + "' is not above 0", "write the sensor's step in the signal's unit, or leave it out");
    signal.missing = keys.numbers("missing");
    keys.none_unknown();
    return signal;
}

void read_time(const std::string &path, const toml::table &table, Map &map) {
    Keys keys(path, table, "[time]");
    map.dialect.time_column = keys.column("column");
    map.time_scale = keys.number("scale", 1);
    map.time_offset_s = keys.number("offset_s", 0);
    map.from_zero = keys.flag("from_zero");
    map.row_period_s = keys.number("row_period_s", 0);
    map.dialect.fine_column = keys.column("nanoseconds");
    if (!map.dialect.fine_column.empty() && map.dialect.time_column.empty())
        keys.fail("'nanoseconds' of [time] stands without 'column'", "write column = \"the column of seconds\"");
    const bool trials = keys.flag("rows_are_trials");
    keys.none_unknown();
    if (!(map.time_scale > 0))
        keys.fail("scale of the time is not above 0", "write seconds per unit of the column, e.g. 0.001 for milliseconds");
    if ((map.dialect.time_column.empty() ? 0 : 1) + (map.row_period_s > 0 ? 1 : 0) + (trials ? 1 : 0) != 1) {
        keys.fail("[time] needs one of 'column', 'row_period_s', 'rows_are_trials'", "write column = \"the column of time\"");
    }
    map.dialect.fine_scale = 1e-9 / map.time_scale;
    if (map.row_period_s <= 0 && map.dialect.time_column.empty()) map.header["rows"] = "trials";
}

void read_filters(const std::string &path, const toml::node &node, Map &map) {
    if (!node.is_array()) throw LogError(path, line_of(node), 0, "'where' is not a list of tables", "write [[where]] on a line of its own");
    for (const toml::node &item : *node.as_array()) {
        Keys keys(path, as_table(path, item, "where"), "[[where]]");
        RowFilter filter;
        filter.column = keys.column("column");
        if (filter.column.empty()) keys.fail("[[where]] names no column", "write column = \"...\"");
        if (const auto equals = keys.number("equals")) filter.minimum = filter.maximum = *equals;
        filter.minimum = keys.number("min", filter.minimum);
        filter.maximum = keys.number("max", filter.maximum);
        keys.none_unknown();
        map.dialect.filters.push_back(filter);
    }
}

// What a header entry "<what>.<signal>" says of a signal (docs/log_format.md): an amount in its unit, or a mark.
const std::vector<std::string> amounts = {"noise", "quantum", "window", "bias"}, marks = {"unsigned", "constant"};

bool is_one_of(const std::vector<std::string> &list, const std::string &word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

// An amount is a number above 0, and the first word of an entry is not mistyped.
void check_entry(const std::string &path, std::size_t line, const std::string &key, const std::string &value) {
    const std::size_t dot = key.find('.');
    if (dot == std::string::npos) return;
    const std::string what = key.substr(0, dot);
    if (is_one_of(amounts, what)) {
        double number = 0;
        const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
        if (error != std::errc() || end != value.data() + value.size() || !(number > 0) || !std::isfinite(number))
            throw LogError(path, line, 0, "header entry '" + key + "' is '" + value + "', no number above 0",
                           "write it in the signal's unit");
        return;
    }
    std::vector<std::string> known = {"firmware", "rover"};
    known.insert(known.end(), amounts.begin(), amounts.end()), known.insert(known.end(), marks.begin(), marks.end());
    if (is_one_of(known, what)) return;
    if (const std::string *meant = nearest(what, known, 2); meant != nullptr)
        throw LogError(path, line, 0, "header entry '" + key + "' means nothing here", "write '" + *meant + key.substr(dot) + "'");
}

// What is said of a wheel that this map does not make, or of what is no signal at all, would count for nothing.
void check_signals(const std::string &path, const Map &map) {
    for (const auto &[key, value] : map.header) {
        const std::size_t dot = key.find('.');
        if (dot == std::string::npos || (!is_one_of(amounts, key.substr(0, dot)) && !is_one_of(marks, key.substr(0, dot)))) continue;
        std::string of = key.substr(dot + 1);
        if (of.ends_with(".relative")) of.resize(of.rfind('.'));
        const bool any_wheel = of.starts_with("wheel."), one_wheel = !any_wheel && of.starts_with("wheel");
        const auto is_meant = [&](const MapSignal &signal) { return signal.name == of; };
        if (find_quantity(any_wheel ? "wheel0" + of.substr(5) : of) == nullptr ||
            (one_wheel && std::none_of(map.signals.begin(), map.signals.end(), is_meant)))
            throw LogError(path, 0, 0, "header entry '" + key + "' speaks of a signal that there is not",
                           "take it out, or correct its name");
    }
}

void read_header(const std::string &path, const toml::table &table, Map &map) {
    for (const auto &[key, node] : table) {
        std::string value;
        if (const auto text = node.value_exact<std::string>()) {
            value = *text;
        } else if (const auto number = node.value<double>()) {
            char buffer[32];
            value.assign(buffer, std::to_chars(buffer, buffer + sizeof buffer, *number).ptr);
        } else {
            throw LogError(path, line_of(node), 0, "header entry '" + std::string(key.str()) + "' is neither text nor number",
                           "write a text in quotes or a number");
        }
        check_entry(path, line_of(node), std::string(key.str()), value);
        map.header[std::string(key.str())] = value;
    }
}

void read_join(const std::string &path, const toml::table &table, Map &map) {
    Keys keys(path, table, "[join]");
    map.join.line = keys.line();
    map.join.replace = keys.text("replace", "");
    map.join.with = keys.text("with", "");
    map.join.map = keys.text("map", "");
    map.join.offset_s = keys.number("offset_s", 0);
    map.join.common = keys.text("correlate", "");
    map.join.widest_s = keys.number("widest_s", 5);
    if (map.join.replace.empty() || map.join.map.empty())
        keys.fail(
            "[join] needs 'replace', 'with' and 'map'",
            "write replace = \"_wheels_\", with = \"_imu_\" (parts of the two files' names) and map = \"imu.toml\" (beside this map)");
    if (!(map.join.widest_s > 0)) keys.fail("widest_s of [join] is not above 0", "write how far apart the two clocks may be, in seconds");
    keys.none_unknown();
}

} // namespace

Map read_map(const std::string &path) {
    const FileBytes bytes(path, std::size_t{1} << 20);
    toml::table root;
    try {
        root = toml::parse(bytes.view(), path);
    } catch (const toml::parse_error &error) {
        throw LogError(path, error.source().begin.line, error.source().begin.column,
                       "this is not TOML: " + std::string(error.description()), "correct the line");
    }
    Map map;
    map.path = path;
    map.dialect.native = false;
    Keys keys(path, root, "the map");
    const std::string format = keys.text("format", "");
    if (format != "traction-map 1")
        keys.fail("the map's format is '" + format + "'", "write format = \"traction-map 1\" on its first line");
    const std::string separator = keys.text("separator", "");
    if (separator.size() > 1)
        keys.fail("separator '" + separator + "' is longer than one character",
                  "write separator = \";\" or leave it out to have it guessed");
    if (!separator.empty()) map.dialect.separator = separator[0];
    const double skip = keys.number("skip_rows", 0);
    if (skip < 0 || skip > 1e6 || skip != std::floor(skip))
        keys.fail("skip_rows is not a small whole number", "write how many lines stand above the row of names");
    map.dialect.skip_rows = static_cast<std::size_t>(skip);
    if (keys.has("row_of_names")) map.dialect.row_of_names = keys.flag("row_of_names");
    const toml::node *time = keys.look("time");
    if (time == nullptr) keys.fail("the map has no [time]", "write [time] and column = \"the column of time\"");
    read_time(path, as_table(path, *time, "time"), map);
    if (const toml::node *header = keys.look("header")) read_header(path, as_table(path, *header, "header"), map);
    if (const toml::node *where = keys.look("where")) read_filters(path, *where, map);
    if (const toml::node *join = keys.look("join")) read_join(path, as_table(path, *join, "join"), map);
    const toml::node *signals = keys.look("signal");
    if (signals == nullptr || !signals->is_array() || signals->as_array()->empty())
        keys.fail("the map has no [[signal]]", "write [[signal]] with name and column for each signal");
    keys.none_unknown();
    std::set<std::string> names;
    for (const toml::node &node : *signals->as_array()) {
        map.signals.push_back(read_signal(path, as_table(path, node, "signal"), map.signals.size() + 1));
        const MapSignal &signal = map.signals.back();
        if (!names.insert(signal.name).second)
            throw LogError(path, signal.line, 0, "signal '" + signal.name + "' stands twice", "keep one of them");
        const std::string &key = signal.name;
        const auto put = [&](const std::string &prefix, const std::optional<double> &value) {
            if (!value) return;
            char buffer[32];
            map.header[prefix + key] = std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, *value).ptr);
        };
        put("noise.", signal.noise);
        put("quantum.", signal.quantum);
        if (signal.is_unsigned) map.header["unsigned." + key] = "1";
        if (signal.value) map.header["constant." + key] = "1";
    }
    if (map.join.line == 0) check_signals(path, map); // another file of the drive may bring more
    return map;
}

namespace {

void unwrap(std::vector<double> &value, double period) {
    double turns = 0;
    for (std::size_t i = 1; i < value.size(); ++i) {
        const double step = value[i] + turns - value[i - 1];
        turns -= period * std::round(step / period);
        value[i] += turns;
    }
}

// Slope of the straight line through the samples within window/2 on either side; a sample without a neighbour there has none.
Signal differentiate(const Signal &signal, double window_s) {
    Signal rate{signal.name, {}, {}};
    const std::size_t count = signal.t_s.size();
    std::size_t first = 0, end = 0;
    for (std::size_t i = 0; i < count; ++i) {
        while (first < i && signal.t_s[first] < signal.t_s[i] - window_s / 2) ++first;
        while (end < count && signal.t_s[end] <= signal.t_s[i] + window_s / 2) ++end;
        double st = 0, sv = 0, stt = 0, stv = 0;
        const double n = static_cast<double>(end - first);
        for (std::size_t k = first; k < end; ++k) {
            const double t = signal.t_s[k] - signal.t_s[i], v = signal.value[k] - signal.value[i];
            st += t, sv += v, stt += t * t, stv += t * v;
        }
        const double denominator = n * stt - st * st;
        if (end - first < 2 || !(denominator > 0)) continue;
        rate.t_s.push_back(signal.t_s[i]);
        rate.value.push_back((n * stv - st * sv) / denominator);
    }
    return rate;
}

void drop_repeats(Signal &signal) {
    Signal kept{signal.name, {}, {}};
    for (std::size_t i = 0; i < signal.value.size(); ++i) {
        if (i != 0 && signal.value[i] == signal.value[i - 1]) continue;
        kept.t_s.push_back(signal.t_s[i]);
        kept.value.push_back(signal.value[i]);
    }
    signal = std::move(kept);
}

const Column &find_column(const Table &table, const std::string &name, const MapSignal &rule, const Map &map, const std::string &path) {
    const auto found = std::find_if(table.columns.begin(), table.columns.end(), [&](const Column &c) { return c.signal.name == name; });
    if (found == table.columns.end())
        throw LogError(map.path, rule.line, 0, "signal '" + rule.name + "' wants column '" + name + "', which " + path + " does not have",
                       "correct the name (columns there: " + table.names.front() + " ... " + table.names.back() + ")");
    return *found;
}

// The columns of a signal that is made of several: they have the same rows.
std::vector<const Column *> columns_together(const Table &table, const std::vector<std::string> &names, const MapSignal &rule,
                                             const Map &map, const std::string &path) {
    std::vector<const Column *> columns;
    for (const std::string &name : names) columns.push_back(&find_column(table, name, rule, map, path));
    for (const Column *column : columns)
        if (column->signal.t_s != columns[0]->signal.t_s)
            throw LogError(map.path, rule.line, 0,
                           "signal '" + rule.name + "' has rows in which a number of '" + column->signal.name + "' or '" +
                               columns[0]->signal.name + "' is missing",
                           "leave those rows out by [[where]]");
    return columns;
}

Column column_by_expression(const std::vector<const Column *> &columns, const MapSignal &rule) {
    Column made = *columns[0];
    Formula formula(rule);
    for (std::size_t i = 0; i < made.signal.value.size(); ++i) {
        for (std::size_t n = 0; n < columns.size(); ++n) formula.variable(n) = columns[n]->signal.value[i];
        made.signal.value[i] = formula.value(); // what is no number is left out later, and told
    }
    return made;
}

// The heading about z (up, to the left positive) of a rotation from the body to the world, in radians, without jumps.
Column heading_of(const std::vector<const Column *> &wxyz, const MapSignal &rule, const Map &map) {
    Column heading = *wxyz[0];
    std::vector<double> &angle = heading.signal.value;
    for (std::size_t i = 0; i < angle.size(); ++i) {
        const auto at = [&](std::size_t part) { return wxyz[part]->signal.value[i]; };
        const double w = at(0), x = at(1), y = at(2), z = at(3), size = w * w + x * x + y * y + z * z;
        constexpr double off = 0.1; // of 1: rounded numbers are within, angles and other orders are not
        if (!(std::fabs(size - 1) < off))
            throw LogError(map.path, rule.line, 0,
                           "the quaternion of '" + rule.name + "' is none at row " + std::to_string(i + 1) +
                               " of its numbers: its length squared is " + std::to_string(size) + ", not 1",
                           "name the columns of w, x, y and z, in this order");
        angle[i] = std::atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z);
    }
    unwrap(angle, 2 * std::numbers::pi);
    return heading;
}

Signal make_signal(const MapSignal &rule, Column column, const std::string &path, std::vector<Repair> &repairs) {
    if (!rule.missing.empty()) {
        Column kept = column;
        kept.signal.t_s.clear(), kept.signal.value.clear();
        for (std::size_t i = 0; i < column.signal.value.size(); ++i) {
            if (std::find(rule.missing.begin(), rule.missing.end(), column.signal.value[i]) != rule.missing.end()) continue;
            kept.signal.t_s.push_back(column.signal.t_s[i]);
            kept.signal.value.push_back(column.signal.value[i]);
        }
        kept.backs.clear(); // their indices are of the full column; order is mended all the same
        column = std::move(kept);
    }
    put_in_order(column, path, repairs);
    Signal signal = std::move(column.signal);
    signal.name = rule.name;
    for (double &value : signal.value) value = rule.scale * value + rule.offset;
    if (rule.unwrap) unwrap(signal.value, rule.period);
    if (rule.drop_repeats) drop_repeats(signal);
    if (rule.differentiate) signal = differentiate(signal, rule.window_s);
    if (rule.is_unsigned) {
        for (double &value : signal.value) value = std::fabs(value);
    }
    return signal;
}

} // namespace

Log read_through_map(const FileBytes &bytes, const std::string &path, const Map &map, std::vector<Repair> &repairs,
                     const ReadLimits &limits) {
    Dialect dialect = map.dialect;
    std::set<std::string> wanted;
    for (const MapSignal &signal : map.signals) {
        if (!signal.column.empty()) wanted.insert(signal.column);
        wanted.insert(signal.quaternion.begin(), signal.quaternion.end());
        for (const auto &[variable, column] : signal.columns) wanted.insert(column);
    }
    dialect.wanted = [&](const std::string &name) { return wanted.count(name) != 0; };
    Table table = read_table(bytes.view(), path, dialect, limits, repairs);
    const double start = map.from_zero && !table.row_time.empty() ? table.row_time.front() : 0;
    const double scale = map.row_period_s > 0 ? map.row_period_s : map.time_scale;
    Log log;
    log.source = path;
    log.header = std::move(table.header);
    for (const auto &[key, value] : map.header) log.header[key] = value;
    for (const MapSignal &rule : map.signals) {
        Column column;
        if (rule.value) {
            column.signal.t_s = table.row_time;
            column.signal.value.assign(table.row_time.size(), 0.0);
            std::sort(column.signal.t_s.begin(), column.signal.t_s.end());
            column.signal.t_s.erase(std::unique(column.signal.t_s.begin(), column.signal.t_s.end()), column.signal.t_s.end());
            column.signal.value.assign(column.signal.t_s.size(), *rule.value);
        } else if (!rule.quaternion.empty()) {
            column = heading_of(columns_together(table, rule.quaternion, rule, map, path), rule, map);
        } else if (!rule.expression.empty()) {
            std::vector<std::string> names;
            for (const auto &[variable, name] : rule.columns) names.push_back(name);
            column = column_by_expression(columns_together(table, names, rule, map, path), rule);
        } else {
            column = find_column(table, rule.column, rule, map, path);
        }
        Signal signal =
            rule.value ? Signal{rule.name, column.signal.t_s, column.signal.value} : make_signal(rule, std::move(column), path, repairs);
        for (double &t : signal.t_s) t = (t - start) * scale + map.time_offset_s - rule.delay_s;
        keep_what_is_a_number(signal, repairs);
        log.signals.push_back(std::move(signal));
    }
    return log;
}

} // namespace traction::log
