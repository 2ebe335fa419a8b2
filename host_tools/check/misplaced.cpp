// Columns that are not what their name says: a copy of another wheel's, a rate of another axis or without its sign, one side of the machine
// turned round, stamps of a buffer.
#include "series.h"

#include "host_tools/log/vocabulary.h"

#include <algorithm>
#include <cmath>

namespace traction::check {

namespace {

// Share of the samples of two columns that are the same number, where enough of them change.
bool same(const log::Signal *a, const log::Signal *b) {
    constexpr std::size_t least_changes = 200; // of a coarse speed held by two equal loops some dozen may coincide
    if (a == nullptr || b == nullptr || a->value.size() != b->value.size() || a->value.size() < least_changes) return false;
    std::size_t equal = 0, changes = 0;
    for (std::size_t i = 0; i < a->value.size(); ++i) {
        equal += a->value[i] == b->value[i];
        changes += i > 0 && a->value[i] != a->value[i - 1];
    }
    return changes >= least_changes && 1000 * equal >= 995 * a->value.size();
}

// Nothing but two sensors' noise between two series: the difference has no memory.
bool differ_by_noise_alone(const std::vector<double> &a, const std::vector<double> &b) {
    constexpr std::size_t lag = 2;     // [cells] no sample is in both
    constexpr double remembered = 0.2; // assumed; of white noise beside 200 cells 0.07
    if (a.size() != b.size() || a.size() <= lag) return false;
    std::vector<double> now, before;
    for (std::size_t k = lag; k < a.size(); ++k) now.push_back(a[k] - b[k]), before.push_back(a[k - lag] - b[k - lag]);
    return std::fabs(correlation(now, before)) < remembered;
}

// Two sensors never read the same noise. Two wheels whose loops read no noise may turn alike to the last digit, as in a simulation on even
// ground: then their currents differ by their sensors' noise alone, and nothing is copied. Where current and speed are both the same, one
// motor drives both wheels; where one of them is and the other is not, a column stands twice.
void copies(const log::Log &log, const Grid &grid, Findings &findings) {
    const auto column = [](const Wheel &wheel, const char *tail) { return "wheel" + std::to_string(wheel.index) + "." + tail; };
    for (std::size_t i = 0; i < grid.wheel.size(); ++i) {
        for (std::size_t j = i + 1; j < grid.wheel.size(); ++j) {
            const Wheel &a = grid.wheel[i], &b = grid.wheel[j];
            const auto both = [&](const char *tail) { return same(log.find(column(a, tail)), log.find(column(b, tail))); };
            const std::string current = column(b, "current_A");
            const bool currents = both("current_A"), have_currents = !a.current.empty() && !b.current.empty();
            const bool motion = both("speed_rad_s") || both("angle_rad") || both("encoder_count");
            if (!have_currents || currents == motion || a.speed.empty() || b.speed.empty()) continue;
            const std::string &name = currents ? current : b.speed_column, &other = currents ? column(a, "current_A") : a.speed_column;
            if (has_error(findings, name) || (motion && differ_by_noise_alone(a.current, b.current))) continue;
            add_error(findings, "copied", name,
                      say("'%s' is '%s' to the last digit, while the %s of the two wheels differ", name.c_str(), other.c_str(),
                          currents ? "speeds" : "currents"),
                      "give the column of this wheel's own sensor; or take it out of the log", 1);
        }
    }
}

// Samples whose stamps lie close together, then none for a while: the logger stamped what its buffer held when it wrote it. Slopes of
// wheel angles over 0.1 s, and which current belongs to which speed, are lost.
void buffers(const log::Log &log, Findings &findings) {
    constexpr double pause_s = 0.1;          // what the lab smooths over
    constexpr std::size_t least_burst = 5;   // samples; two or three are a bus that sends in groups
    constexpr std::size_t least_pauses = 10; // otherwise they are gaps
    for (const log::Signal &signal : log.signals) {
        if (log::wheel_of(signal.name) < 0 || log::find_quantity(signal.name) == nullptr || signal.t_s.size() < 50) continue;
        std::vector<double> steps;
        for (std::size_t i = 1; i < signal.t_s.size(); ++i) steps.push_back(signal.t_s[i] - signal.t_s[i - 1]);
        const double usual = quantile(steps, 0.5), mean = (signal.t_s.back() - signal.t_s.front()) / static_cast<double>(steps.size());
        const auto pauses = static_cast<std::size_t>(
            std::count_if(steps.begin(), steps.end(), [&](double step) { return step > std::fmax(pause_s, 20 * usual); }));
        if (pauses < least_pauses || steps.size() < least_burst * pauses || 5 * usual > mean) continue;
        add_error(
            findings, "stamps", signal.name,
            say("the samples of '%s' come in %zu bursts, %.3g s apart within and %.3g s on the mean: they carry the time at which a buffer "
                "was written",
                signal.name.c_str(), pauses + 1, usual, mean),
            "stamp every sample where it is measured; or spread each buffer evenly over the time since the one before", mean);
        return;
    }
}

// A gyro beside the camera's heading, both over half a second.
void gyro(const Grid &grid, Findings &findings) {
    if (grid.gyro.empty() || grid.camera_yaw_rate.empty() || has_error(findings, "imu.gyro") || has_error(findings, "camera")) return;
    const std::vector<double> rate = smooth(tame(grid.gyro), 5), seen = smooth(tame(grid.camera_yaw_rate), 5);
    std::vector<double> before(seen.size(), not_known), size = seen;
    constexpr std::size_t lag = 16; // [cells] 0.8 s: no sample of the camera is in both
    for (std::size_t k = lag; k < seen.size(); ++k) before[k] = seen[k - lag];
    for (double &v : size) v = std::fabs(v);
    if (!(quantile(size, 0.95) > 0.1) || correlation(seen, before) < 0.3) return; // too little turning, or the camera's own noise
    const double alike = correlation(rate, seen), folded = correlation(rate, size), widest = quantile(rate, 0.995);
    const double fast = quantile(size, 0.98);
    double back_s = 0;
    for (const double v : seen) back_s += v < -0.3 * fast ? step_s : 0;
    if (quantile(rate, 0.005) > -0.05 * widest && back_s > 1 && folded > alike + 0.2) {
        add_error(findings, "magnitude", "imu.gyro_z_rad_s", "the gyro never reads a turn to the right, but the camera sees them",
                  "log the rate with its sign: a turn to the left is positive", alike);
        return;
    }
    double best = 0;
    for (int shift = -15; shift <= 15; ++shift) { // what is later is told as that
        std::vector<double> moved(rate.size(), not_known);
        for (std::size_t k = 0; k < rate.size(); ++k)
            if (const auto from = static_cast<std::ptrdiff_t>(k) + shift; from >= 0 && from < static_cast<std::ptrdiff_t>(rate.size()))
                moved[k] = rate[static_cast<std::size_t>(from)];
        best = std::max(best, std::fabs(correlation(moved, seen)));
    }
    if (best < 0.75)
        add_error(findings, "unrelated", "imu.gyro_z_rad_s",
                  say("the gyro has nothing to do with the turns that the camera sees (correlation %.2f at best)", best),
                  "check that it is the rate about the vertical axis, of this run and of this time", best);
}

// Left wheels against right wheels: the ground, or the gyro, tells whether the machine drives straight or spins.
void sides(const Grid &grid, const Machine &machine, Findings &findings) {
    if (!machine.wheels_point_forward || !machine.rolls_freely || !knows_sides(grid, machine)) return;
    if (has_error(findings, "wheel") || grid.ground_speed.empty()) return;
    std::vector<double> sum(grid.count, 0), difference(grid.count, 0), ground = grid.ground_speed;
    int left = 0, right = 0;
    for (std::size_t i = 0; i < grid.wheel.size(); ++i) {
        if (grid.wheel[i].speed.empty()) return;
        const double y = left_of(grid, machine, i);
        const bool is_left = y > 0;
        left += is_left, right += y < 0;
        if (y == 0) continue;
        for (std::size_t k = 0; k < grid.count; ++k)
            sum[k] += grid.wheel[i].speed[k], difference[k] += (is_left ? -1 : 1) * grid.wheel[i].speed[k];
    }
    if (left == 0 || left != right) return;
    for (std::size_t k = 0; k < grid.count; ++k)
        sum[k] = std::fabs(sum[k]), difference[k] = std::fabs(difference[k]), ground[k] = std::fabs(ground[k]);
    sum = smooth(sum, 5), difference = smooth(difference, 5), ground = smooth(ground, 5);
    const double straight = correlation(ground, sum), spinning = correlation(ground, difference);
    if (!(spinning > 0.8) || straight > spinning - 0.5) return;
    add_error(findings, "sign", grid.wheel.front().speed_column,
              say("the ground passes as fast as left and right wheels turn against each other (correlation %.2f; with their sum %.2f): the "
                  "motors of one "
                  "side are mounted the other way round",
                  spinning, straight),
              "turn the signs of that side's speeds, currents and duties round (map: sign = -1)", spinning);
}

double size_of(const std::vector<double> &x) {
    double sum = 0, n = 0;
    for (const double v : x)
        if (std::isfinite(v)) sum += v * v, ++n;
    return n > 0 ? std::sqrt(sum / n) : 0;
}

// Wheels that the machine says one motor turns: they turn alike, or the machine is another.
void coupled(const Grid &grid, const Machine &machine, Findings &findings) {
    constexpr double most_apart = 0.1; // of the speed, root mean square over half a second: assumed, beyond any encoder's rounding
    for (const Wheel &wheel : grid.wheel) {
        const auto index = static_cast<std::size_t>(wheel.index);
        if (index >= machine.motor_of_wheel.size() || machine.motor_of_wheel[index] == wheel.index) continue;
        const int motor = machine.motor_of_wheel[index];
        if (!wheel.current.empty())
            findings.push_back(
                {"coupled", Severity::warning, "wheel" + std::to_string(wheel.index) + ".current_A",
                 say("wheel %d has a current, and in the model it turns with the motor of wheel %d: it is not read", wheel.index, motor),
                 "give the motor's current as that of its own wheel alone; or give this wheel a drive in the model",
                 static_cast<double>(motor)});
        const auto own = std::find_if(grid.wheel.begin(), grid.wheel.end(), [&](const Wheel &w) { return w.index == motor; });
        if (wheel.speed.empty() || own == grid.wheel.end() || own->speed.empty() || has_error(findings, wheel.speed_column)) continue;
        std::vector<double> apart(grid.count, not_known);
        for (std::size_t k = 0; k < grid.count; ++k) apart[k] = wheel.speed[k] - own->speed[k];
        const double share = size_of(smooth(apart, 5)) / std::max(size_of(smooth(own->speed, 5)), 1e-9);
        if (!(share > most_apart)) continue;
        add_error(findings, "coupled", wheel.speed_column,
                  say("'%s' and '%s' differ by %.0f %% of the speed (root mean square), and in the model one motor turns both",
                      wheel.speed_column.c_str(), own->speed_column.c_str(), 100 * share),
                  "mend drives in the model's [rover], or the wheels' order, sign or counts per turn in the log's map", share);
    }
}

} // namespace

void check_misplaced(const log::Log &log, const Grid &grid, const Machine &machine, Findings &findings) {
    copies(log, grid, findings);
    buffers(log, findings);
    gyro(grid, findings);
    sides(grid, machine, findings);
    coupled(grid, machine, findings);
}

} // namespace traction::check
