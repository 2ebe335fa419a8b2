// Two files of one drive on one clock.
#include "map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace traction::log {

namespace {

constexpr double step_s = 0.02;         // of the search
constexpr double least_agreement = 0.5; // of the correlation: below it the two signals do not see one motion

std::string folder_before(const std::string &path) {
    const auto slash = path.find_last_of('/');
    return slash == std::string::npos ? "" : path.substr(0, slash + 1);
}

// The signal on a grid; not-a-number outside and over gaps of more than a second.
std::vector<double> sampled(const Signal &s, double start_s, std::size_t count) {
    std::vector<double> out(count, std::numeric_limits<double>::quiet_NaN());
    std::size_t i = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double t = start_s + static_cast<double>(k) * step_s;
        while (i + 1 < s.t_s.size() && s.t_s[i + 1] <= t) ++i;
        if (i + 1 >= s.t_s.size() || s.t_s[i] > t || s.t_s[i + 1] - s.t_s[i] > 1) continue;
        out[k] = s.value[i] + (s.value[i + 1] - s.value[i]) * (t - s.t_s[i]) / (s.t_s[i + 1] - s.t_s[i]);
    }
    return out;
}

double correlation(const std::vector<double> &a, const std::vector<double> &b, std::ptrdiff_t shift) {
    double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        const auto j = static_cast<std::ptrdiff_t>(k) + shift;
        if (j < 0 || j >= static_cast<std::ptrdiff_t>(b.size())) continue;
        const double x = a[k], y = b[static_cast<std::size_t>(j)];
        if (!std::isfinite(x) || !std::isfinite(y)) continue;
        n += 1, sa += x, sb += y, saa += x * x, sbb += y * y, sab += x * y;
    }
    const double va = saa - sa * sa / n, vb = sbb - sb * sb / n;
    return n < 100 || !(va > 0) || !(vb > 0) ? 0 : (sab - sa * sb / n) / std::sqrt(va * vb);
}

// What to add to the second file's times.
double offset_of(const Log &first, const Log &second, const Map &map) {
    if (map.join.common.empty()) return map.join.offset_s;
    const auto comma = map.join.common.find(',');
    std::string a = map.join.common.substr(0, comma), b = comma == std::string::npos ? a : map.join.common.substr(comma + 1);
    b.erase(0, b.find_first_not_of(' '));
    const Signal *one = first.find(a), *other = second.find(b);
    if (one == nullptr || other == nullptr || one->t_s.empty() || other->t_s.empty())
        throw LogError(map.path, map.join.line, 0, "'correlate' of [join] names a signal that its file does not have",
                       "write \"signal of the first file, signal of the second\"");
    const double start = std::min(one->t_s.front(), other->t_s.front() + map.join.offset_s) - map.join.widest_s,
                 end = std::max(one->t_s.back(), other->t_s.back() + map.join.offset_s) + map.join.widest_s;
    const auto count = static_cast<std::size_t>((end - start) / step_s) + 1;
    const std::vector<double> x = sampled(*one, start, count), y = sampled(*other, start - map.join.offset_s, count);
    const auto widest = static_cast<std::ptrdiff_t>(map.join.widest_s / step_s);
    std::ptrdiff_t best = 0;
    double most = 0;
    for (std::ptrdiff_t shift = -widest; shift <= widest; ++shift)
        if (const double alike = correlation(x, y, shift); alike > most) most = alike, best = shift;
    if (most < least_agreement) {
        char text[120];
        std::snprintf(text, sizeof text, "the two signals of 'correlate' agree nowhere (correlation %.2f at best)", most);
        throw LogError(map.path, map.join.line, 0, text, "name two signals that see one motion with one sign, or give offset_s");
    }
    return map.join.offset_s - static_cast<double>(best) * step_s;
}

} // namespace

void join_second_file(Log &log, const Map &map, std::vector<Repair> &repairs, const ReadLimits &limits) {
    if (map.join.line == 0) return;
    const std::string folder = folder_before(log.source), name = log.source.substr(folder.size());
    const auto at = name.find(map.join.replace);
    if (at == std::string::npos)
        throw LogError(log.source, 0, 0, "its name has no '" + map.join.replace + "', which the map replaces to find the second file",
                       "correct 'replace' of [join] in " + map.path);
    std::string second_name = name;
    second_name.replace(at, map.join.replace.size(), map.join.with);
    const Map second_map = read_map(folder_before(map.path) + map.join.map);
    if (second_map.join.line != 0)
        throw LogError(second_map.path, second_map.join.line, 0, "the map of a second file joins a third", "take [join] out of it");
    const FileBytes bytes(folder + second_name, limits.bytes);
    Log second = read_through_map(bytes, folder + second_name, second_map, repairs, limits);
    const double offset = offset_of(log, second, map);
    for (Signal &s : second.signals) {
        for (double &t : s.t_s) t += offset;
        if (log.find(s.name) == nullptr) log.signals.push_back(std::move(s));
    }
    log.header.insert(second.header.begin(), second.header.end());
    char text[80];
    std::snprintf(text, sizeof text, "' is joined, its clock shifted by %.2f s", offset);
    repairs.push_back({"joined", "", second.signals.size(), 0, "'" + second_name + text});
}

} // namespace traction::log
