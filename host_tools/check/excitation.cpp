// What the drive did, and what it therefore cannot show.
#include "series.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace traction::check {

namespace {

double rms(const std::vector<double> &x) {
    double sum = 0, n = 0;
    for (const double v : x) {
        if (std::isfinite(v)) sum += v * v, n += 1;
    }
    return n > 0 ? std::sqrt(sum / n) : not_known;
}

// Share of the path that comes within 5 cm of a place passed more than 5 s before.
void measure_path(const Grid &grid, Excitation &out) {
    out.revisited = not_known;
    out.path_m = not_known;
    if (grid.camera_x.empty() || grid.camera_y.empty()) return;
    struct Place {
        double x, y, t;
    };
    std::vector<Place> places; // one every 2 cm
    int again = 0;
    for (std::size_t k = 0; k < grid.count; ++k) {
        const double x = grid.camera_x[k], y = grid.camera_y[k];
        if (!std::isfinite(x + y)) continue;
        if (!places.empty() && std::hypot(x - places.back().x, y - places.back().y) < 0.02) continue;
        if (places.size() < 4000) {
            again += std::any_of(places.begin(), places.end(), [&](const Place &place) {
                return grid.time(k) - place.t > 5 && std::hypot(x - place.x, y - place.y) < 0.05;
            });
        }
        places.push_back({x, y, grid.time(k)});
    }
    out.path_m = 0.02 * static_cast<double>(places.size());
    out.revisited = places.empty() ? 0 : again / static_cast<double>(std::min<std::size_t>(places.size(), 4000));
}

void measure_wheels(const Grid &grid, Excitation &out) {
    std::vector<double> all_slips;
    double saturated = 0, cells = 0;
    for (const Wheel &wheel : grid.wheel) {
        WheelExcitation one;
        one.wheel = wheel.index;
        one.speed_min_rad_s = quantile(wheel.speed, 0.005);
        one.speed_max_rad_s = quantile(wheel.speed, 0.995);
        one.current_low_A = quantile(wheel.current, 0.02);
        one.current_high_A = quantile(wheel.current, 0.98);
        one.accel_rms_rad_s2 = wheel.speed.empty() ? not_known : rms(slope(smooth(wheel.speed, 2), 2));
        std::vector<double> slips;
        for (std::size_t k = 0;
             k < grid.count && !wheel.speed.empty() && !grid.ground_speed.empty() && std::isfinite(grid.effective_radius_m); ++k) {
            const double rim = grid.effective_radius_m * wheel.speed[k], v = grid.ground_speed[k];
            if (!(std::max(std::fabs(rim), std::fabs(v)) > 0.05) || (!grid.gyro.empty() && std::fabs(grid.gyro[k]) > 0.3)) continue;
            slips.push_back(std::clamp((rim - v) / std::max(std::fabs(rim), std::fabs(v)), -1.0, 1.0) *
                            (v < 0 || (v == 0 && rim < 0) ? -1 : 1));
        }
        one.slip_low = quantile(slips, 0.02);
        one.slip_high = quantile(slips, 0.98);
        all_slips.insert(all_slips.end(), slips.begin(), slips.end());
        for (const double duty : wheel.duty) {
            if (std::isfinite(duty)) cells += 1, saturated += std::fabs(duty) > 0.98;
        }
        out.wheel.push_back(one);
    }
    out.slip_low = quantile(all_slips, 0.02);
    out.slip_high = quantile(all_slips, 0.98);
    out.duty_saturated = cells > 0 ? saturated / cells : not_known;
}

} // namespace

Excitation measure_excitation(const Grid &grid) {
    Excitation out;
    out.duration_s = static_cast<double>(grid.count) * step_s;
    measure_wheels(grid, out);
    measure_path(grid, out);
    std::vector<double> body = grid.ground_speed;
    if (body.empty() && std::isfinite(grid.effective_radius_m)) {
        body = grid.mean_speed;
        for (double &v : body) v *= grid.effective_radius_m;
    }
    out.speed_min_m_s = quantile(body, 0.005);
    out.speed_max_m_s = quantile(body, 0.995);
    out.accel_rms_m_s2 = body.empty() ? not_known : rms(slope(smooth(body, 5), 5));
    double still = 0, apart = 0, size = 0, constant = 0;
    bool moved = false;
    std::vector<double> changes(grid.count, 0);
    for (const Wheel &wheel : grid.wheel) {
        const std::vector<double> change = slope(smooth(wheel.speed, 5), 5);
        for (std::size_t k = 0; k < change.size(); ++k)
            changes[k] = std::max(changes[k], std::isfinite(change[k]) ? std::fabs(change[k]) : 0.0);
    }
    const std::vector<double> &yaw_rate = !grid.gyro.empty() ? grid.gyro : grid.camera_yaw_rate;
    const double wheel_top = quantile(
        [&] {
            std::vector<double> v = grid.mean_speed;
            for (double &x : v) x = std::fabs(x);
            return v;
        }(),
        0.98);
    for (std::size_t k = 0; k < grid.count; ++k) {
        double turning = not_known; // the fastest wheel
        for (const Wheel &wheel : grid.wheel) {
            if (!wheel.speed.empty() && std::isfinite(wheel.speed[k])) turning = std::fmax(turning, std::fabs(wheel.speed[k]));
        }
        if (std::isfinite(turning) ? turning < 0.02 * wheel_top + 0.05 : grid.active[k] == 0) {
            still += step_s;
            out.standstill_s = std::max(out.standstill_s, still);
        } else {
            if (still > 0.5 && moved) ++out.starts;
            if (!moved) out.starts = 1;
            moved = true;
            still = 0;
            out.moving_s += step_s;
            if (changes[k] < 0.02 * wheel_top) constant += step_s; // [rad/s^2 per rad/s]
        }
        if (grid.mean_speed[k] < -0.3) out.reverse_s += step_s;
        if (!yaw_rate.empty() && std::fabs(yaw_rate[k]) > 0.1) out.turning_s += step_s;
        double mean_square = 0, square_mean = 0, n = 0;
        for (const Wheel &wheel : grid.wheel) {
            if (!wheel.speed.empty() && std::isfinite(wheel.speed[k]))
                mean_square += wheel.speed[k] * wheel.speed[k], square_mean += wheel.speed[k], n += 1;
        }
        if (n > 1) size += mean_square / n, apart += mean_square / n - square_mean * square_mean / (n * n);
    }
    if (yaw_rate.empty()) out.turning_s = not_known;
    out.yaw_rate_max_rad_s = std::max(std::fabs(quantile(yaw_rate, 0.005)), std::fabs(quantile(yaw_rate, 0.995)));
    out.wheels_apart = size > 0 ? std::sqrt(std::max(0.0, apart) / size) : not_known;
    out.constant_input = out.moving_s > 0 ? constant / out.moving_s : not_known;
    return out;
}

void judge_excitation(const Excitation &out, const Grid &grid, Findings &findings) {
    const auto note = [&](const char *id, std::string text, const char *mend, double value, Severity severity = Severity::note) {
        findings.push_back({id, severity, "", std::move(text), mend, value});
    };
    if (grid.wheel.empty()) return;
    if (out.moving_s < 5) {
        note("no_motion", say("the wheels are driven for %.3g s only", out.moving_s), "drive", out.moving_s,
             out.moving_s < 1 ? Severity::error : Severity::warning); // [s] less is no drive
        return;
    }
    if (out.constant_input > 0.8)
        note("constant_input",
             say("no wheel changes its speed in %.0f %% of the moving time: parameters cannot be told apart", 100 * out.constant_input),
             "add steps, sweeps, starts and stops", out.constant_input, Severity::warning);
    double slow = std::numeric_limits<double>::infinity(), fast = -slow;
    for (const WheelExcitation &wheel : out.wheel) {
        slow = std::min(slow, wheel.speed_min_rad_s);
        fast = std::max(fast, wheel.speed_max_rad_s);
    }
    if (out.reverse_s < 2)
        note("no_reverse", say("%.2g s in reverse: a slope, a tether and rolling resistance look alike", out.reverse_s),
             "drive the same way back in reverse", out.reverse_s);
    if (out.standstill_s < 2)
        note("no_standstill", say("the longest standstill is %.2g s: sensor offsets are not seen alone", out.standstill_s),
             "stand still for 3 s at the beginning", out.standstill_s);
    if (out.starts < 3)
        note("few_starts", say("%d start(s) from standstill: dry friction and inertia are hardly told apart", out.starts),
             "stop and start a few times", out.starts);
    if (out.slip_high - out.slip_low < 0.15)
        note("narrow_slip", say("slip stays within %.2f..%.2f: the soil law's shape is not seen", out.slip_low, out.slip_high),
             "brake hard, or sweep the slip of two wheels (soil sweep)", out.slip_high - out.slip_low);
    if (grid.ground_speed.empty())
        note("no_ground_speed", "there is no ground speed (camera, radar, carriage): slip cannot be known", "log a camera or a radar", 0);
    if (std::isfinite(out.turning_s) && out.turning_s < 2)
        note("no_turns", say("%.2g s of turning: lateral scrub and left-right differences are not seen", out.turning_s),
             "turn to both sides", out.turning_s);
    if (out.accel_rms_m_s2 < 0.02)
        note("low_accel", say("the body's acceleration is %.2g m/s^2 rms: load transfer and inertia are not seen", out.accel_rms_m_s2),
             "start and brake harder", out.accel_rms_m_s2);
    if (std::isfinite(out.revisited) && out.revisited < 0.05)
        note("no_place_twice",
             say("%.0f %% of the path is driven twice: a change of soil with place and one with time look alike", 100 * out.revisited),
             "drive the same track twice", out.revisited);
    if (out.duty_saturated > 0.3)
        note("duty_saturated",
             say("the motors are at full duty in %.0f %% of the time: the controller does not steer there", 100 * out.duty_saturated),
             "drive slower, or charge the battery", out.duty_saturated);
    for (const Wheel &wheel : grid.wheel) {
        if (wheel.current.empty())
            note("no_current", say("wheel %d has no current: its torque is unknown", wheel.index), "log the motor current", wheel.index);
    }
}

} // namespace traction::check
