// The clock: does it run at the rate that the sensors see, and do all signals tell of the same moment?
//
// A clock that runs c times too fast divides every rate by c: the gyro then reads c times the camera's yaw rate, the radar c times the
// camera's speed, a speed column c times the rate of its own encoder, and the motors' back-EMF per logged encoder rate is c times the known
// one. One of these alone may be a scale of its sensor; two that agree are the clock.
#include "series.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace traction::check {

namespace {

constexpr double least_rate_error = 0.05; // of the clock: scales of two sensors agree by chance below it
constexpr double agreement = 0.04;        // of two witnesses
constexpr double header_tolerance = 0.02; // of a rate that the header states

struct Witness {
    const char *what;
    double factor; // c
};

double number_of(const log::Log &log, const std::string &key) {
    const auto found = log.header.find(key);
    return found == log.header.end() ? not_known : std::atof(found->second.c_str());
}

// Header rate.<signal> in Hz, and radar.sample_rate_Hz of the radar's samples. True where something was said.
bool header_rates(const log::Log &log, Findings &findings) {
    for (const log::Signal &signal : log.signals) {
        double rate = number_of(log, "rate." + signal.name);
        if (signal.name == "radar.adc_count" && !std::isfinite(rate)) rate = number_of(log, "radar.sample_rate_Hz");
        if (!(rate > 0) || signal.t_s.size() < 50) continue;
        std::vector<double> steps;
        for (std::size_t i = 0; i + 1 < signal.t_s.size(); ++i) steps.push_back(signal.t_s[i + 1] - signal.t_s[i]);
        const double factor = quantile(steps, 0.5) * rate;
        if (std::fabs(factor - std::round(factor)) < header_tolerance && factor > 0.5)
            continue;               // as it says, or every second, third ... kept
        if (factor > 1.5) continue; // thinned
        add_error(findings, "clock_rate", "t_s",
                  say("'%s' comes every %.6g s, but the header states %.6g Hz: the clock runs %.4g times as fast as it should",
                      signal.name.c_str(), quantile(steps, 0.5), rate, factor),
                  say("divide all times by %.4g (map: time.scale)", factor), factor);
        return true;
    }
    return false;
}

void speed_beside_encoder(const Grid &grid, std::vector<Witness> &witnesses) {
    std::vector<double> ratio;
    for (const Wheel &wheel : grid.wheel) {
        for (const bool count : {true, false}) {
            const std::vector<double> &rate = count ? wheel.count_rate : wheel.angle_rate;
            if (rate.empty() || wheel.speed.empty() || (count && !std::isfinite(grid.rad_per_count))) continue;
            const Fit line = fit(smooth(wheel.speed, 2), rate);
            if (line.good && line.a > 0 && line.rms < 0.1 * line.y_rms) ratio.push_back(line.a / (count ? grid.rad_per_count : 1));
        }
    }
    if (!ratio.empty()) witnesses.push_back({"wheel speed over the encoder's rate", quantile(ratio, 0.5)});
}

std::vector<Witness> witnesses_of(const Grid &grid, const Machine &machine) {
    std::vector<Witness> out;
    if (!grid.gyro.empty() && !grid.camera_yaw_rate.empty()) {
        const std::vector<double> gyro = smooth(smooth(grid.gyro, 5), 5), camera = smooth(grid.camera_yaw_rate, 5);
        const Fit line = fit(gyro, camera);
        if (line.good && line.a > 0 && correlation(gyro, camera) > 0.95 && line.error_a < 0.02 * line.a)
            out.push_back({"gyro over the camera's yaw rate", line.a});
    }
    if (!grid.radar.empty() && !grid.camera_speed.empty()) {
        const double fast = 0.5 * quantile(grid.camera_speed, 0.95);
        std::vector<double> ratio;
        for (std::size_t k = 0; k < grid.count; ++k)
            if (grid.camera_speed[k] > fast && fast > 0) ratio.push_back(std::fabs(grid.radar[k]) / grid.camera_speed[k]);
        if (ratio.size() > 200 && quantile(ratio, 0.75) - quantile(ratio, 0.25) < 0.2)
            out.push_back({"radar over the camera's speed", quantile(ratio, 0.5)});
    }
    speed_beside_encoder(grid, out);
    std::vector<double> back_emf;
    for (const Wheel &wheel : grid.wheel) { // of the encoder's own rate: a speed column knows nothing of the log's clock
        if (wheel.unsigned_current || !wheel.in_volts || wheel.voltage.empty() || wheel.current.empty()) continue;
        const bool from_angle = wheel.speed_column.find(".speed") == std::string::npos;
        if (!from_angle || grid.speed_is_guessed || !std::isfinite(machine.back_emf_Vs)) continue;
        const Fit law = fit(wheel.voltage, wheel.speed, wheel.current);
        if (law.good && law.rms * law.rms < 0.1 * law.y_rms * law.y_rms && law.error_a < 0.02 * law.a)
            back_emf.push_back(law.a / machine.back_emf_Vs);
    }
    if (back_emf.size() >= 2) out.push_back({"the motors' back-EMF over the known one", quantile(back_emf, 0.5)});
    return out;
}

void rate_of_clock(const Grid &grid, const Machine &machine, Findings &findings) {
    const std::vector<Witness> witnesses = witnesses_of(grid, machine);
    for (std::size_t i = 0; i < witnesses.size(); ++i) {
        for (std::size_t j = i + 1; j < witnesses.size(); ++j) {
            const double a = std::log(witnesses[i].factor), b = std::log(witnesses[j].factor);
            if (!(std::fabs(a) > least_rate_error) || !(std::fabs(b) > least_rate_error) || !(std::fabs(a - b) < agreement)) continue;
            const double factor = std::exp(0.5 * (a + b));
            if (std::any_of(witnesses.begin(), witnesses.end(), [&](const Witness &w) { return std::fabs(std::log(w.factor)) < 0.02; }))
                continue; // another sees the clock run as it should: two sensors off alike
            add_error(findings, "clock_rate", "t_s",
                      say("the clock runs %.3g times as fast as the sensors see: %s is %.3g, %s %.3g", factor, witnesses[i].what,
                          witnesses[i].factor, witnesses[j].what, witnesses[j].factor),
                      say("divide all times by %.4g (map: time.scale), or find out which clock stamped them", factor), factor);
            return;
        }
    }
    for (const Witness &w : witnesses) { // one wheel, measured twice in one log: whatever the machine, these agree
        if (std::string(w.what) != "wheel speed over the encoder's rate" || std::fabs(std::log(w.factor)) < 0.06) continue;
        if (has_error(findings, "wheel")) continue;
        add_error(findings, "scale", "wheel.speed_rad_s",
                  say("the wheel speeds are %.3g times the rate of the wheels' own encoders", w.factor),
                  "check the unit of the speed, encoder.counts_per_turn, and the clock", w.factor);
    }
}

std::vector<double> shifted(const std::vector<double> &x, int cells) {
    std::vector<double> out(x.size(), not_known);
    for (std::size_t k = 0; k < x.size(); ++k) {
        const auto from = static_cast<std::ptrdiff_t>(k) + cells;
        if (from >= 0 && from < static_cast<std::ptrdiff_t>(x.size())) out[k] = x[static_cast<std::size_t>(from)];
    }
    return out;
}

constexpr int farthest = 40; // [cells] 2 s

// Where `late`, read that much later, matches `reference` best.
struct Lag {
    int cells = 0;
    double best = 0, now = 0; // correlation there, and at the nominal lag
};
Lag lag_of(const std::vector<double> &reference, const std::vector<double> &late, int nominal) {
    Lag out{nominal, 0, correlation(reference, shifted(late, nominal))};
    out.best = out.now;
    for (int cells = -farthest; cells <= farthest; ++cells) {
        const double alike = correlation(reference, shifted(late, cells));
        if (alike > out.best) out.best = alike, out.cells = cells;
    }
    return out;
}

void tell_late(const std::string &column, double seconds, const char *beside, double gain, Findings &findings) {
    add_error(findings, "late", column,
              say("'%s' tells of what was %.2f s %s (beside %s, which it then fits %.1f times better)", column.c_str(), std::fabs(seconds),
                  seconds > 0 ? "before" : "after", beside, gain),
              say("shift it (map: delay_s = %.2f), or stamp it where it is measured", seconds), seconds);
}

// Signals that see one motion; `early_s`, `late_s`: what windows, filters and delays of the catalogue account for.
void one_moment(const std::string &column, const std::vector<double> &reference, const std::vector<double> &signal, const char *beside,
                double nominal_s, double early_s, double late_s, Findings &findings) {
    if (reference.empty() || signal.empty() || has_error(findings, column)) return;
    const int nominal = static_cast<int>(std::lround(nominal_s / step_s));
    const Lag lag = lag_of(reference, signal, nominal);
    const double off_s = (lag.cells - nominal) * step_s;
    if ((off_s < late_s && off_s > -early_s) || std::abs(lag.cells) == farthest || lag.best < 0.85 || 1 - lag.now < 3 * (1 - lag.best))
        return;
    tell_late(column, lag.cells * step_s, beside, std::sqrt((1 - lag.now) / (1 - lag.best)), findings);
}

// Current, speed or duty of one motor against the other two.
void one_motor(const Wheel &wheel, Findings &findings) {
    const std::string name = "wheel" + std::to_string(wheel.index) + ".";
    if (wheel.voltage.empty() || wheel.speed.empty() || wheel.current.empty() || wheel.unsigned_current || has_error(findings, name))
        return;
    const Fit now = fit(wheel.voltage, wheel.speed, wheel.current);
    if (!now.good || now.rms * now.rms < 0.01 * now.y_rms * now.y_rms) return; // nothing to gain
    double best = 1, left = 0, size = 0; // best: of the power that is left without the shift, over the same rows
    int cells = 0;
    std::string column;
    for (int c = -farthest; c <= farthest; ++c) {
        const std::vector<double> speed = shifted(wheel.speed, c), current = shifted(wheel.current, c), voltage = shifted(wheel.voltage, c);
        std::vector<double> overlap = wheel.voltage; // the start, which a short drive's misfit is, must not drop out on one side alone
        for (std::size_t k = 0; k < overlap.size(); ++k)
            if (!std::isfinite(speed[k]) || !std::isfinite(current[k]) || !std::isfinite(voltage[k])) overlap[k] = not_known;
        const Fit same = fit(overlap, wheel.speed, wheel.current);
        if (!same.good || same.rms == 0) continue;
        for (const auto &[which, law] : {std::pair{name + "duty", fit(voltage, wheel.speed, wheel.current)},
                                         std::pair{wheel.speed_column, fit(wheel.voltage, speed, wheel.current)},
                                         std::pair{name + "current_A", fit(wheel.voltage, wheel.speed, current)}}) {
            const double share = law.rms * law.rms / (same.rms * same.rms);
            if (!law.good || !(law.a > 0) || !(law.b > 0) || share >= best) continue;
            best = share, left = law.rms * law.rms, size = law.y_rms * law.y_rms, cells = c, column = which;
        }
    }
    constexpr double widest_s = 0.25; // [s] the catalogue's actuation_delay goes to 0.2
    if (std::abs(cells) * step_s < widest_s || std::abs(cells) == farthest) return;
    if (best > 0.25 || left > 0.1 * size) return;
    tell_late(column, cells * step_s, "the rest of its motor", 1 / std::sqrt(best), findings);
}

// Two sensors of the ground's speed, or of its change, that have nothing in common although it changes.
void unrelated(const Grid &grid, const Machine &machine, Findings &findings) {
    const auto tell = [&](const char *column, const char *beside, double alike) {
        add_error(findings, "unrelated", column, say("'%s' has nothing to do with %s (correlation %.2f)", column, beside, alike),
                  "check that it is of this run and of this time", alike);
    };
    const auto spread = [](const std::vector<double> &x) { return quantile(x, 0.95) - quantile(x, 0.05); };
    if (!grid.radar.empty() && !grid.camera_speed.empty() && !has_error(findings, "radar") && !has_error(findings, "camera")) {
        std::vector<double> radar = grid.radar;
        for (double &v : radar) v = std::fabs(v);
        const std::vector<double> camera = smooth(grid.camera_speed, 5);
        double best = -1; // a window of a second is half a second late
        for (int cells = -5; cells <= 15; ++cells) best = std::max(best, correlation(camera, shifted(radar, cells)));
        if (best < 0.4 && spread(camera) > 0.5 * quantile(camera, 0.95) && quantile(camera, 0.95) > 0.05)
            tell("radar.speed_m_s", "the camera's speed", best);
    }
    const double radius =
        std::isfinite(machine.wheel_radius_m) && !grid.speed_is_guessed ? machine.wheel_radius_m : grid.effective_radius_m;
    if (grid.accel.empty() || has_error(findings, "imu.accel") || has_error(findings, "wheel") || !std::isfinite(radius)) return;
    if (!machine.wheels_point_forward || !machine.rolls_freely || !machine.on_ground) return;
    std::vector<double> rim = slope(smooth(grid.mean_speed, 5), 5), felt = smooth(smooth(grid.accel, 5), 5);
    if (grid.camera_forward.size() == rim.size() && !has_error(findings, "camera"))
        rim = slope(grid.camera_forward, 5);
    else
        for (double &v : rim) v *= radius;
    double squares = 0, n = 0;
    for (const double a : rim)
        if (std::isfinite(a)) squares += a * a, n += 1;
    double best = -1;
    for (int cells = -6; cells <= 6; ++cells) best = std::max(best, correlation(rim, shifted(felt, cells)));
    if (n > 200 && std::sqrt(squares / n) > 0.2 && best < 0.2) tell("imu.accel_x_m_s2", "the machine's starts and stops", best);
}

} // namespace

void check_clock(const log::Log &log, const Grid &grid, const Machine &machine, Findings &findings) {
    if (!header_rates(log, findings)) rate_of_clock(grid, machine, findings);
    for (const Wheel &wheel : grid.wheel) one_motor(wheel, findings);
    std::vector<double> size = grid.mean_speed;
    for (double &v : size) v = std::fabs(v);
    const bool rolls = machine.wheels_point_forward && machine.rolls_freely && !has_error(findings, "wheel");
    unrelated(grid, machine, findings);
    const std::vector<double> nothing;
    // the catalogue's camera_delay goes to 0.4 s, its radar_delay to 1 s; a radar's window of a second is a quarter late and a half long
    one_moment("camera.x_m", rolls ? smooth(size, 5) : nothing, grid.camera_speed, "the wheels", 0, 0.6, 0.6, findings);
    std::vector<double> radar = grid.radar;
    for (double &v : radar) v = std::fabs(v);
    one_moment("radar.speed_m_s", rolls ? smooth(size, 5) : nothing, radar, "the wheels", 0.25, 0.6, 1.0, findings);
    one_moment("imu.gyro_z_rad_s", grid.camera_yaw_rate, grid.gyro.empty() ? nothing : smooth(grid.gyro, 5), "the camera's heading", 0, 0.6,
               0.6, findings);
    one_moment("imu.accel_x_m_s2", rolls ? slope(smooth(grid.mean_speed, 2), 3) : nothing,
               grid.accel.empty() ? nothing : smooth(grid.accel, 3), "the wheels", 0, 0.3, 0.3, findings);
}

} // namespace traction::check
