// Where a signal stands at one end of what it ever reads: the end of the sensor's range, or only a coarse or held value?
//
// A sensor's range ends at an extreme when values pile up there (many equal ones, hardly any just inside), and
//   - where the drive says what the current should be, U = ke*w + Ra*I fitted to the samples that are not at the extreme asks for more
//   there;
//   - where nothing says so, the signal comes to that extreme again and again. One single stay is a value that the logger held.
#include "series.h"

#include "host_tools/log/vocabulary.h"

#include <algorithm>
#include <cmath>

namespace traction::check {

namespace {

constexpr std::size_t least_samples = 10;  // at the extreme
constexpr double least_share = 0.003;      // of all samples
constexpr std::size_t least_levels = 20;   // fewer values than these tell no pile from a step
constexpr double just_inside = 0.03;       // [1] of the range; on a coarse signal the two steps next to the extreme
constexpr std::size_t least_stays = 3;     // "again and again"
constexpr std::size_t least_cells = 5;     // of the grid, wholly at the extreme, before the drive's own equation is asked
constexpr double least_explained = 0.9;    // of the voltage, before it is believed
constexpr double clearly_beyond = 0.05;    // [1] of the range: enough for a single stay
constexpr double not_beyond_at_all = 0.01; // [1] of the range, or half a step

struct Range {
    double low = 0, high = 0, step = 0; // step: the smallest distance of two values
    std::size_t levels = 0;
    double width() const { return high - low; }
};

Range range_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    Range out{values.front(), values.back(), values.back() - values.front(), values.size()};
    for (std::size_t i = 1; i < values.size(); ++i) out.step = std::min(out.step, values[i] - values[i - 1]);
    return out;
}

// How far beyond the extreme the motor's equation puts the current, mean over the cells that stand there. NaN: not known.
double asked_beyond(const Wheel &wheel, double edge, const Range &range) {
    if (wheel.unsigned_current || wheel.current.empty() || wheel.voltage.empty() || wheel.speed.empty()) return not_known;
    const double same = 1e-9 * range.width();
    std::vector<double> voltage = wheel.voltage;
    std::vector<std::size_t> there;
    for (std::size_t k = 0; k < voltage.size(); ++k) {
        if (!(std::fabs(wheel.current[k] - edge) <= same)) continue;
        there.push_back(k);
        voltage[k] = not_known; // not part of the fit
    }
    const Fit motor = fit(voltage, wheel.speed, wheel.current);
    if (!motor.good || !(motor.b > 0) || motor.rms * motor.rms > (1 - least_explained) * motor.y_rms * motor.y_rms) return not_known;
    double sum = 0;
    std::size_t cells = 0;
    for (const std::size_t k : there) {
        const double asked = (wheel.voltage[k] - motor.a * wheel.speed[k]) / motor.b;
        if (!std::isfinite(asked)) continue;
        sum += edge == range.high ? asked - edge : edge - asked;
        ++cells;
    }
    return cells < least_cells ? not_known : sum / static_cast<double>(cells);
}

bool range_ends_at(double edge, const log::Signal &signal, const Range &range, const Grid &grid) {
    if (edge == 0) return false; // the lower end of a magnitude
    std::size_t at = 0, near = 0, stays = 0;
    const double inside = std::max(just_inside * range.width(), 2.5 * range.step);
    for (std::size_t i = 0; i < signal.value.size(); ++i) {
        const double value = signal.value[i];
        at += value == edge;
        stays += value == edge && (i == 0 || signal.value[i - 1] != edge);
        near += value != edge && std::fabs(value - edge) < inside;
    }
    if (at < least_samples || static_cast<double>(at) < least_share * static_cast<double>(signal.value.size()) || at < 3 * near)
        return false;
    if (signal.name.find(".current_A") != std::string::npos) {
        for (const Wheel &wheel : grid.wheel) {
            if (wheel.index != log::wheel_of(signal.name)) continue;
            const double beyond = asked_beyond(wheel, edge, range);
            if (beyond < std::max(not_beyond_at_all * range.width(), 0.5 * range.step)) return false;
            if (beyond > std::max(clearly_beyond * range.width(), range.step)) return true;
        }
    }
    return stays >= least_stays;
}

} // namespace

void check_clipping(const log::Signal &signal, const Grid &grid, Findings &findings) {
    const Range range = range_of(signal.value);
    if (!(range.width() > 0) || range.levels < least_levels) return;
    for (const double edge : {range.low, range.high}) {
        if (!range_ends_at(edge, signal, range, grid)) continue;
        const double share =
            static_cast<double>(std::count(signal.value.begin(), signal.value.end(), edge)) / static_cast<double>(signal.value.size());
        findings.push_back({"clipped", Severity::error, signal.name,
                            say("'%s' stands at its %s value %.5g in %.1f %% of the samples: the sensor's range ends there",
                                signal.name.c_str(), edge == range.low ? "smallest" : "largest", edge, 100 * share),
                            "use a wider range of the sensor, or a gentler drive", share, not_known, not_known});
    }
}

} // namespace traction::check
