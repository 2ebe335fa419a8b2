#include "map.h"
#include "part.h"
#include "read.h"
#include "table.h"
#include "ulog.h"
#include "vocabulary.h"

#include "host_tools/suggest/suggest.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

namespace traction::log {

namespace {

// "wheel0.speed_rpm" becomes "wheel0.speed_rad_s"; a name outside the vocabulary is kept.
void name_in_vocabulary(Column &column, const std::vector<std::string> &names, std::vector<Repair> &repairs,
                        std::vector<std::string> &unknown) {
    Signal &signal = column.signal;
    if (find_quantity(signal.name) != nullptr || signal.name.rfind("truth.", 0) == 0) return;
    const std::string at = "column " + std::to_string(column.number) + ": '" + signal.name + "' ";
    std::string si_name;
    double factor = 1;
    if (convert_unit(signal.name, si_name, factor) && std::find(names.begin(), names.end(), si_name) == names.end()) {
        char text[40];
        std::snprintf(text, sizeof text, "%.7g", factor);
        repairs.push_back(
            {"unit_converted", si_name, signal.value.size(), 0, at + "is converted to '" + si_name + "' by the factor " + text});
        for (double &value : signal.value) value *= factor;
        signal.name = si_name;
        keep_what_is_a_number(signal, repairs);
        return;
    }
    unknown.push_back(signal.name);
}

// " (did you mean 'wheel0.current_A'?)" of a column one or two letters away from a name that the file lacks; letters of the other case
// count as none.
std::string meant_by(const std::string &name, const std::vector<std::string> &names) {
    const std::string object = name.substr(0, name.find('.'));
    const std::size_t digit = object.find_first_of("0123456789");
    const auto lower = [](std::string text) {
        for (char &c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        return text;
    };
    std::string best;
    std::size_t least = 3;
    for (const Quantity &q : vocabulary()) {
        const bool of_wheel = q.object == "wheel<i>";
        if (of_wheel && digit == object.npos) continue;
        std::string known = of_wheel ? "wheel" + object.substr(digit) : std::string(q.object);
        known += "." + std::string(q.quantity) + (q.unit.empty() ? "" : "_" + std::string(q.unit));
        if (find_quantity(known) == nullptr || std::find(names.begin(), names.end(), known) != names.end()) continue;
        if (const std::size_t d = distance(lower(name), lower(known)); d < least) least = d, best = std::move(known);
    }
    return best.empty() ? "" : " (did you mean '" + best + "'?)";
}

void say_unknown(const std::vector<std::string> &unknown, const std::vector<std::string> &names, std::size_t columns,
                 std::vector<Repair> &repairs) {
    if (unknown.empty()) return;
    std::string text = unknown.size() == columns
                           ? "no column is"
                           : std::to_string(unknown.size()) + (unknown.size() == 1 ? " column is not" : " columns are not");
    text += " in the vocabulary (";
    for (std::size_t i = 0; i < unknown.size() && i < 4; ++i)
        text += (i == 0 ? "'" : ", '") + unknown[i] + "'" + meant_by(unknown[i], names);
    text += unknown.size() > 4 ? ", ...): " : "): ";
    text += unknown.size() == columns ? "a foreign file wants a map (--map)" : "kept under their own names, used by no balance";
    repairs.push_back({"unknown_name", unknown.front(), unknown.size(), 0, text});
}

// Ordered, named in the vocabulary, into the log.
void take_columns(Log &log, std::vector<Column> &columns, std::vector<std::string> names, std::vector<Repair> &repairs) {
    std::vector<std::string> unknown;
    for (Column &column : columns) {
        put_in_order(column, log.source, repairs);
        const std::string before = column.signal.name;
        name_in_vocabulary(column, names, repairs, unknown);
        if (column.signal.name != before) names.push_back(column.signal.name); // rpm and deg_s of one quantity: the first wins
        log.signals.push_back(std::move(column.signal));
    }
    say_unknown(unknown, names, columns.size(), repairs);
}

// A column in memory as the reader of a file leaves one.
Column column_of(Signal &&given, std::size_t number, const std::string &file, std::vector<Repair> &repairs) {
    if (given.t_s.size() != given.value.size())
        throw LogError(file, 0, number,
                       "'" + given.name + "' has " + std::to_string(given.t_s.size()) + " times and " + std::to_string(given.value.size()) +
                           " values",
                       "give one time for each value");
    Column column;
    column.number = number;
    column.signal.name = std::move(given.name);
    column.signal.t_s.reserve(given.t_s.size());
    column.signal.value.reserve(given.value.size());
    for (std::size_t i = 0; i < given.t_s.size(); ++i) {
        if (std::isnan(given.value[i]) || std::isnan(given.t_s[i])) continue;
        if (!std::isfinite(given.value[i]) || !std::isfinite(given.t_s[i])) {
            if (column.not_finite++ == 0) column.not_finite_line = i + 1;
            continue;
        }
        if (!column.signal.t_s.empty() && given.t_s[i] <= column.signal.t_s.back()) {
            if (column.back_steps++ == 0) column.back_line = i + 1;
            if (given.t_s[i] < column.signal.t_s.back() && column.backs.size() < 64)
                column.backs.emplace_back(column.signal.t_s.size(), i + 1);
        }
        column.signal.t_s.push_back(given.t_s[i]);
        column.signal.value.push_back(given.value[i]);
    }
    if (column.not_finite != 0)
        repairs.push_back({"not_finite", column.signal.name, column.not_finite, column.not_finite_line,
                           std::to_string(column.not_finite) + " values of '" + column.signal.name + "' are infinite, left out"});
    return column;
}

Log read_native(const FileBytes &bytes, const std::string &path, std::vector<Repair> &repairs, const ReadLimits &limits) {
    Table table = read_table(bytes.view(), path, Dialect{}, limits, repairs);
    Log log;
    log.header = std::move(table.header);
    log.source = path;
    take_columns(log, table.columns, table.names, repairs);
    return log;
}

} // namespace

Log read_csv(const std::string &path, const std::string &map_path, std::vector<Repair> &repairs, const ReadLimits &limits) {
    const std::size_t before = repairs.size();
    const FileBytes bytes(path, limits.bytes);
    Log log;
    if (part::begins_as_part(bytes.view()))
        throw LogError(path, 0, 0, "is no log yet: it is what a run has written, or had when it was ended, before its log was made",
                       "where that run is over: traction recover " + path + " --out LOG.csv");
    if (begins_as_ulog(bytes.view())) {
        if (!map_path.empty()) throw LogError(path, 0, 0, "is a ULog: a map is for a foreign CSV", "leave --map out");
        return read_ulog(bytes.view(), path, limits, repairs);
    }
    if (map_path.empty()) {
        log = read_native(bytes, path, repairs, limits);
    } else {
        const Map map = read_map(map_path);
        log = read_through_map(bytes, path, map, repairs, limits);
        join_second_file(log, map, repairs, limits);
    }
    for (std::size_t i = before; i < repairs.size(); ++i) log.repairs.push_back(repairs[i].text);
    return log;
}

Log log_of_columns(std::vector<Signal> columns, const std::map<std::string, std::string> &header, const std::string &name,
                   std::vector<Repair> &repairs) {
    const std::size_t before = repairs.size();
    Log log;
    log.header = header;
    log.source = name;
    std::vector<Column> taken;
    std::vector<std::string> names;
    for (Signal &column : columns) {
        if (std::find(names.begin(), names.end(), column.name) != names.end())
            throw LogError(name, 0, taken.size() + 1, "there are two columns '" + column.name + "'", "give each column a name of its own");
        names.push_back(column.name);
        taken.push_back(column_of(std::move(column), taken.size() + 1, name, repairs));
    }
    take_columns(log, taken, names, repairs);
    for (std::size_t i = before; i < repairs.size(); ++i) log.repairs.push_back(repairs[i].text);
    return log;
}

Log read_csv(const std::string &path, const std::string &map_path) {
    std::vector<Repair> repairs;
    return read_csv(path, map_path, repairs);
}

} // namespace traction::log
