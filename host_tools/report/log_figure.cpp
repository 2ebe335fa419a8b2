#include "log_figure.h"

#include "axis.h"

#include "host_tools/suggest/suggest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>

namespace traction::report {

namespace {

constexpr std::size_t most_in_a_panel = 8; // as many as there are styles

// Suffix of a name and how a reader writes the unit; longer suffixes first, so that m_s2 is not taken for s2.
constexpr std::array<std::pair<std::string_view, std::string_view>, 24> units{
    {{"rad_s2", "rad/s²"}, {"rad_s", "rad/s"}, {"deg_s", "deg/s"}, {"m_s3", "m/s³"},   {"m_s2", "m/s²"}, {"mm_s", "mm/s"},
     {"m_s", "m/s"},       {"Nms", "N m s"},   {"Nm", "N m"},      {"count", "count"}, {"rad", "rad"},   {"deg", "deg"},
     {"degC", "°C"},       {"ohm", "ohm"},     {"rpm", "rpm"},     {"mA", "mA"},       {"mm", "mm"},     {"Hz", "Hz"},
     {"Pa", "Pa"},         {"N", "N"},         {"A", "A"},         {"V", "V"},         {"m", "m"},       {"s", "s"}}};

std::string_view suffix_of(const std::string &signal) {
    for (const auto &[suffix, unit] : units)
        if (signal.size() > suffix.size() + 1 && signal.ends_with(suffix) && signal[signal.size() - suffix.size() - 1] == '_')
            return suffix;
    return "";
}

// What follows the object: "speed_rad_s" of "wheel0.speed_rad_s".
std::string quantity_of(const std::string &signal) {
    return signal.substr(signal.find('.') == std::string::npos ? 0 : signal.find('.') + 1);
}

std::string panel_key(const std::string &signal) {
    const std::string unit = unit_of(signal);
    return unit.empty() || unit == "count" ? quantity_of(signal) : "[" + unit + "]";
}

// "speed [rad/s]" where every signal of the panel is a speed, "[rad/s]" otherwise.
std::string panel_label(const std::string &key, const std::vector<Series> &series) {
    if (key.front() != '[') return key;
    const auto stem = [](const std::string &signal) {
        const std::string quantity = quantity_of(signal);
        return quantity.substr(0, quantity.size() - suffix_of(signal).size() - 1);
    };
    const std::string first = stem(series.front().name);
    for (const Series &other : series)
        if (stem(other.name) != first) return key;
    return first + " " + key;
}

bool matches(std::string_view pattern, std::string_view name) {
    if (pattern.empty()) return name.empty();
    if (pattern.front() == '*') return matches(pattern.substr(1), name) || (!name.empty() && matches(pattern, name.substr(1)));
    return !name.empty() && pattern.front() == name.front() && matches(pattern.substr(1), name.substr(1));
}

log::LogError no_such_signal(const log::Log &log, const std::string &name) {
    std::vector<std::pair<std::size_t, std::string>> near;
    for (const log::Signal &signal : log.signals) near.emplace_back(distance(name, signal.name), signal.name);
    std::sort(near.begin(), near.end());
    std::string mend = near.empty() ? "the log holds no signal at all" : "the nearest are";
    for (std::size_t i = 0; i < std::min<std::size_t>(4, near.size()); ++i) mend += (i == 0 ? " " : ", ") + near[i].second;
    return {log.source, 0, 0, "signal \"" + name + "\" is not in this log", mend};
}

std::vector<const log::Signal *> chosen_signals(const log::Log &log, const std::vector<std::string> &patterns) {
    std::vector<const log::Signal *> chosen;
    if (patterns.empty())
        for (const log::Signal &signal : log.signals) chosen.push_back(&signal);
    for (const std::string &pattern : patterns) {
        bool found = false;
        for (const log::Signal &signal : log.signals) {
            if (!matches(pattern, signal.name)) continue;
            found = true;
            if (std::find(chosen.begin(), chosen.end(), &signal) == chosen.end()) chosen.push_back(&signal);
        }
        if (!found) throw no_such_signal(log, pattern);
    }
    return chosen;
}

// A silence of the sensor: longer than five spacings of the signal, of which 19 in 20 are shorter than what is taken for one.
double longest_spacing(const log::Signal &signal) {
    std::vector<double> apart;
    for (std::size_t i = 1; i < signal.t_s.size(); ++i) apart.push_back(signal.t_s[i] - signal.t_s[i - 1]);
    if (apart.size() < 20) return std::numeric_limits<double>::infinity();
    const auto at = apart.begin() + static_cast<std::ptrdiff_t>(apart.size() * 19 / 20);
    std::nth_element(apart.begin(), at, apart.end());
    return *at > 0 ? 5 * *at : std::numeric_limits<double>::infinity();
}

// Whether a slip means something at each sample: the log's own `slip_valid` of that wheel, held until its next sample. nullptr: no word.
const log::Signal *validity_of(const log::Log &log, const std::string &name) {
    if (!name.ends_with(".slip")) return nullptr;
    const std::string wanted = name + "_valid";
    for (const log::Signal &signal : log.signals)
        if (signal.name == wanted && !signal.t_s.empty()) return &signal;
    return nullptr;
}

// What is invalid, and the silences, are gaps of the line (NaN); nothing is drawn across them.
Series series_of(const log::Log &log, const log::Signal &signal, const LogFigureOptions &options) {
    Series series{.name = signal.name};
    const log::Signal *valid = validity_of(log, signal.name);
    const double longest = longest_spacing(signal);
    const auto gap = [&](double t_s) { series.x.push_back(t_s), series.y.push_back(std::nan("")); };
    std::size_t told = 0;
    double last = std::nan("");
    for (std::size_t i = 0; i < signal.t_s.size(); ++i) {
        const double t_s = signal.t_s[i];
        if (t_s < options.from_s || t_s > options.to_s) continue;
        if (t_s - last > longest) gap(0.5 * (last + t_s));
        last = t_s;
        if (valid != nullptr) {
            while (told + 1 < valid->t_s.size() && valid->t_s[told + 1] <= t_s) ++told;
            if (valid->t_s[told] <= t_s && valid->value[told] < 0.5) {
                gap(t_s);
                continue;
            }
        }
        series.x.push_back(t_s), series.y.push_back(signal.value[i]);
    }
    return series;
}

} // namespace

std::string unit_of(const std::string &signal) {
    const std::string_view suffix = suffix_of(signal);
    for (const auto &[name, unit] : units)
        if (name == suffix) return std::string(unit);
    return "";
}

Figure log_figure(const log::Log &log, const LogFigureOptions &options) {
    Figure figure{.title = std::filesystem::path(log.source).filename().string(), .x_label = "time [s]"};
    const auto scenario = log.header.find("scenario");
    if (scenario != log.header.end()) figure.title += " - " + scenario->second;
    std::vector<std::string> keys; // of the panels, in the same order
    for (const log::Signal *signal : chosen_signals(log, options.signals)) {
        const std::string key = panel_key(signal->name);
        std::size_t at = figure.panels.size();
        for (std::size_t i = 0; i < keys.size(); ++i)
            if (keys[i] == key && figure.panels[i].series.size() < most_in_a_panel) at = i;
        if (at == figure.panels.size()) {
            keys.push_back(key);
            figure.panels.emplace_back();
        }
        figure.panels[at].series.push_back(series_of(log, *signal, options));
    }
    for (std::size_t i = 0; i < keys.size(); ++i) figure.panels[i].y_label = panel_label(keys[i], figure.panels[i].series);
    return figure;
}

} // namespace traction::report
