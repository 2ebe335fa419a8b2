#include "table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace traction::log {

namespace {

// A clock set back while logging records the same span twice: at least `span` samples before and after lie in it.
bool is_clock_jump(const Signal &signal, std::size_t back) {
    constexpr std::size_t span = 10; // [samples] assumed; a late row or two is a matter of order, not of the clock
    const double start = signal.t_s[back],
                 top = *std::max_element(signal.t_s.begin(), signal.t_s.begin() + static_cast<std::ptrdiff_t>(back));
    std::size_t before = 0, after = 0;
    double last = start;
    for (std::size_t i = back; i < signal.t_s.size() && signal.t_s[i] < top; ++i) {
        if (i > back && signal.t_s[i] <= last) break;
        last = signal.t_s[i];
        ++after;
    }
    for (std::size_t i = 0; i < back; ++i) before += signal.t_s[i] >= start && signal.t_s[i] <= last;
    return before >= span && after >= span;
}

} // namespace

void put_in_order(Column &column, const std::string &file, std::vector<Repair> &repairs) {
    Signal &signal = column.signal;
    if (column.back_steps == 0) return;
    char number[64];
    const std::string at = "line " + std::to_string(column.back_line) + ", column " + std::to_string(column.number) + ": ";
    for (const auto &[index, line] : column.backs) {
        if (!is_clock_jump(signal, index)) continue;
        std::snprintf(number, sizeof number, "%.6g s to %.6g s", signal.t_s[index - 1], signal.t_s[index]);
        throw ClockJump(file, line, column.number,
                        std::string("the time of '") + signal.name + "' jumps back from " + number +
                            " and runs over the same span again: the clock was set",
                        "correct the times from this line on, or cut the file here");
    }
    std::vector<std::size_t> order(signal.t_s.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return signal.t_s[a] < signal.t_s[b]; });
    Signal sorted{signal.name, {}, {}};
    std::size_t duplicates = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const double t_s = signal.t_s[order[i]];
        if (!sorted.t_s.empty() && t_s <= sorted.t_s.back()) {
            ++duplicates;
            continue;
        }
        sorted.t_s.push_back(t_s);
        sorted.value.push_back(signal.value[order[i]]);
    }
    if (duplicates != 0) {
        repairs.push_back(
            {"duplicate_time", signal.name, duplicates, column.back_line,
             at + std::to_string(duplicates) + " samples of '" + signal.name + "' have a time already taken, the first of each is kept"});
    }
    if (!column.backs.empty()) {
        repairs.push_back({"unsorted", signal.name, column.backs.size(), column.back_line,
                           at + "the times of '" + signal.name + "' run back " + std::to_string(column.backs.size()) +
                               (column.backs.size() >= 64 ? " times or more" : " times") + ", sorted"});
    }
    signal = std::move(sorted);
    column.back_steps = 0;
}

void keep_what_is_a_number(Signal &signal, std::vector<Repair> &repairs) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < signal.t_s.size(); ++i) {
        if (!std::isfinite(signal.t_s[i]) || !std::isfinite(signal.value[i]) || (kept != 0 && signal.t_s[i] <= signal.t_s[kept - 1]))
            continue;
        signal.t_s[kept] = signal.t_s[i];
        signal.value[kept++] = signal.value[i];
    }
    const std::size_t lost = signal.t_s.size() - kept;
    if (lost == 0) return;
    signal.t_s.resize(kept);
    signal.value.resize(kept);
    repairs.push_back({"out_of_range", signal.name, lost, 0,
                       std::to_string(lost) + " samples of '" + signal.name + "' overflow or fall on one time when converted, left out"});
}

} // namespace traction::log
