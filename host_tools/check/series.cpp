#include "series.h"

#include "host_tools/log/vocabulary.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <set>

namespace traction::check {

std::string say(const char *format, ...) {
    char text[512];
    std::va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return text;
}

double quantile(std::vector<double> values, double q) {
    std::erase_if(values, [](double v) { return !std::isfinite(v); });
    if (values.empty()) return not_known;
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

Fit fit(const std::vector<double> &y, const std::vector<double> &x1, const std::vector<double> &x2) {
    Fit out;
    const bool two = !x2.empty();
    double s11 = 0, s12 = 0, s22 = 0, s1y = 0, s2y = 0, syy = 0;
    for (std::size_t k = 0; k < y.size(); ++k) {
        const double a = x1[k], b = two ? x2[k] : 0.0;
        if (!std::isfinite(y[k]) || !std::isfinite(a) || !std::isfinite(b)) continue;
        s11 += a * a, s12 += a * b, s22 += b * b, s1y += a * y[k], s2y += b * y[k], syy += y[k] * y[k];
        ++out.rows;
    }
    const double n = static_cast<double>(out.rows);
    if (out.rows < 40 || !(s11 > 0) || (two && !(s22 > 0))) return out;
    const double determinant = two ? s11 * s22 - s12 * s12 : s11;
    if (two && determinant < 1e-6 * s11 * s22) return out; // x1 and x2 are alike
    out.a = two ? (s1y * s22 - s2y * s12) / determinant : s1y / s11;
    out.b = two ? (s2y * s11 - s1y * s12) / determinant : 0;
    const double left = std::max(0.0, syy - out.a * s1y - out.b * s2y);
    out.rms = std::sqrt(left / n);
    out.y_rms = std::sqrt(syy / n);
    const double variance = design_effect * left / n;
    out.error_a = std::sqrt(variance * (two ? s22 / determinant : 1 / s11));
    out.error_b = two ? std::sqrt(variance * s11 / determinant) : 0;
    out.good = std::isfinite(out.a) && std::isfinite(out.b);
    return out;
}

double correlation(const std::vector<double> &a, const std::vector<double> &b) {
    double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        if (!std::isfinite(a[k]) || !std::isfinite(b[k])) continue;
        n += 1, sa += a[k], sb += b[k], saa += a[k] * a[k], sbb += b[k] * b[k], sab += a[k] * b[k];
    }
    const double va = saa - sa * sa / n, vb = sbb - sb * sb / n;
    return n < 40 || !(va > 0) || !(vb > 0) ? 0.0 : (sab - sa * sb / n) / std::sqrt(va * vb);
}

std::vector<double> slope(const std::vector<double> &x, std::size_t half_span) {
    std::vector<double> out(x.size(), not_known);
    for (std::size_t k = half_span; k + half_span < x.size(); ++k)
        out[k] = (x[k + half_span] - x[k - half_span]) / (2 * static_cast<double>(half_span) * step_s);
    return out;
}

std::vector<double> smooth(const std::vector<double> &x, std::size_t half_span) {
    std::vector<double> out(x.size(), not_known);
    for (std::size_t k = half_span; k + half_span < x.size(); ++k) {
        double sum = 0;
        for (std::size_t i = k - half_span; i <= k + half_span; ++i) sum += x[i];
        out[k] = sum / static_cast<double>(2 * half_span + 1);
    }
    return out;
}

std::vector<double> tame(std::vector<double> x) {
    const double low = quantile(x, 0.005), high = quantile(x, 0.995), width = high - low;
    if (!(width > 0)) return x;
    for (double &v : x)
        if (std::isfinite(v)) v = std::clamp(v, low - width, high + width);
    return x;
}

const UnitSlip *unit_slip(char kind, double factor) {
    static constexpr UnitSlip angular[] = {
        {60 / 6.283185307179586, "rpm"}, {57.29577951308232, "deg/s"}, {1 / 6.283185307179586, "turns/s"}, {1000, "mrad/s"}};
    static constexpr UnitSlip current[] = {{1000, "mA"}, {0.001, "kA"}};
    static constexpr UnitSlip linear[] = {{1000, "mm"}, {100, "cm"}, {3.6, "km/h"}, {0.001, "km"}};
    static constexpr UnitSlip accel[] = {{1 / 9.80665, "g"}, {101.97, "mg"}, {1000, "mm/s^2"}};
    const auto search = [&](const auto &table) -> const UnitSlip * {
        for (const UnitSlip &slip : table) {
            if (factor > slip.factor / 1.35 && factor < slip.factor * 1.35) return &slip;
        }
        return nullptr;
    };
    switch (kind) {
    case 'w':
        return search(angular);
    case 'I':
        return search(current);
    case 'v':
        return search(linear);
    default:
        return search(accel);
    }
}

std::string looks_like(const UnitSlip &slip, std::string_view column) {
    const std::string rate = slip.written;
    if (column.find(".encoder_count") != column.npos) return "a turn of another number of counts";
    if (column.find(".angle_rad") == column.npos) return rate;
    return rate == "deg/s" ? "degrees" : rate == "rpm" ? "another unit" : rate.substr(0, rate.find('/'));
}

// At least three jumps of about a turn, within a range of a turn: an angle that should be continuous and is not.
bool wraps(const log::Signal &angle) {
    constexpr double turn = 6.283185307179586;
    if (angle.value.empty()) return false;
    const auto [low, high] = std::minmax_element(angle.value.begin(), angle.value.end());
    std::size_t jumps = 0;
    for (std::size_t i = 1; i < angle.value.size(); ++i) jumps += std::fabs(angle.value[i] - angle.value[i - 1]) > 0.7 * turn;
    return jumps >= 3 && *high - *low < 1.01 * turn;
}

namespace {

// A fast signal: the mean of the samples in each cell. A slow one: the straight line between neighbours that are not far apart.
std::vector<double> resample(const log::Signal *signal, double start_s, std::size_t count) {
    if (signal == nullptr || signal->t_s.size() < 2) return {};
    const std::vector<double> &t = signal->t_s, &v = signal->value;
    std::vector<double> gaps(t.size() - 1);
    for (std::size_t i = 0; i + 1 < t.size(); ++i) gaps[i] = t[i + 1] - t[i];
    const double typical = quantile(gaps, 0.5), reach = std::max(3.5 * typical, 2 * step_s);
    std::vector<double> out(count, not_known);
    std::size_t i = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double centre = start_s + static_cast<double>(k) * step_s, low = centre - step_s / 2, high = centre + step_s / 2;
        while (i < t.size() && t[i] < low) ++i;
        double sum = 0;
        std::size_t n = 0;
        for (std::size_t j = i; j < t.size() && t[j] < high; ++j, ++n) sum += v[j];
        if (n != 0 && typical < 0.7 * step_s) {
            out[k] = sum / static_cast<double>(n);
            continue;
        }
        const auto next = std::lower_bound(t.begin(), t.end(), centre);
        if (next == t.end() || next == t.begin() || *next - *(next - 1) > reach) continue;
        const std::size_t j = static_cast<std::size_t>(next - t.begin());
        out[k] = v[j - 1] + (v[j] - v[j - 1]) * (centre - t[j - 1]) / (t[j] - t[j - 1]);
    }
    return out;
}

log::Signal continuous(const log::Signal &angle) {
    log::Signal out = angle;
    double turns = 0;
    constexpr double turn = 6.283185307179586;
    for (std::size_t i = 1; i < out.value.size(); ++i) {
        turns -= turn * std::round((angle.value[i] - angle.value[i - 1]) / turn);
        out.value[i] += turns;
    }
    return out;
}

void add_camera(const log::Log &log, Grid &grid) {
    grid.camera_x = resample(log.find("camera.x_m"), grid.start_s, grid.count);
    grid.camera_y = resample(log.find("camera.y_m"), grid.start_s, grid.count);
    if (const log::Signal *yaw = log.find("camera.yaw_rad")) {
        double widest = 0; // an angle in radians that wraps stays within a turn; one in degrees does not, and must not be unwrapped
        for (const double v : yaw->value) widest = std::max(widest, std::fabs(v));
        const log::Signal unwrapped = widest < 6.5 ? continuous(*yaw) : *yaw;
        grid.camera_yaw = resample(&unwrapped, grid.start_s, grid.count);
    }
    constexpr std::size_t half = 5; // +-0.25 s: 1 mm of noise becomes 3 mm/s
    if (!grid.camera_yaw.empty()) grid.camera_yaw_rate = slope(grid.camera_yaw, half);
    if (grid.camera_x.empty() || grid.camera_y.empty()) return;
    const std::vector<double> vx = slope(grid.camera_x, half), vy = slope(grid.camera_y, half);
    grid.camera_speed.assign(grid.count, not_known);
    for (std::size_t k = 0; k < grid.count; ++k) grid.camera_speed[k] = std::hypot(vx[k], vy[k]);
    if (grid.camera_yaw.empty()) return;
    grid.camera_forward.assign(grid.count, not_known);
    for (std::size_t k = 0; k < grid.count; ++k)
        grid.camera_forward[k] = vx[k] * std::cos(grid.camera_yaw[k]) + vy[k] * std::sin(grid.camera_yaw[k]);
}

// Wheel speeds of a log that has only angles or counts. Counts of unknown size get the speed of a small rover, 6 rad/s assumed.
void derive_speeds(Grid &grid) {
    double largest = 0;
    for (Wheel &wheel : grid.wheel) {
        const std::string name = "wheel" + std::to_string(wheel.index);
        wheel.speed_column = name + ".speed_rad_s";
        if (!wheel.speed.empty()) continue;
        if (!wheel.angle_rate.empty()) {
            wheel.speed_column = name + ".angle_rad";
            wheel.speed = std::move(wheel.angle_rate), wheel.angle_rate.clear();
        } else if (!wheel.count_rate.empty()) {
            wheel.speed_column = name + ".encoder_count";
            wheel.speed = std::move(wheel.count_rate), wheel.count_rate.clear();
            if (std::isfinite(grid.rad_per_count))
                for (double &w : wheel.speed) w *= grid.rad_per_count;
            std::vector<double> size = wheel.speed;
            for (double &w : size) w = std::fabs(w);
            largest = std::fmax(largest, quantile(size, 0.98));
        }
    }
    if (std::isfinite(grid.rad_per_count) || !(largest > 0)) return;
    grid.speed_is_guessed = true;
    for (Wheel &wheel : grid.wheel)
        if (wheel.speed_column.find(".encoder_count") != std::string::npos)
            for (double &w : wheel.speed) w *= 6 / largest;
}

void add_wheels(const log::Log &log, const Machine &machine, Grid &grid) {
    std::set<int> indices;
    const auto told = log.header.find("encoder.rad_per_count");
    if (machine.counts_per_turn > 0)
        grid.rad_per_count = 6.283185307179586 / machine.counts_per_turn;
    else if (told != log.header.end())
        grid.rad_per_count = std::atof(told->second.c_str());
    for (const log::Signal &signal : log.signals) {
        if (log::find_quantity(signal.name) != nullptr && log::wheel_of(signal.name) >= 0) indices.insert(log::wheel_of(signal.name));
    }
    for (const int index : indices) {
        const std::string name = "wheel" + std::to_string(index) + ".";
        const auto get = [&](const char *quantity) { return resample(log.find(name + quantity), grid.start_s, grid.count); };
        Wheel wheel;
        wheel.index = index;
        wheel.speed = get("speed_rad_s");
        wheel.set_speed = get("set_speed_rad_s");
        wheel.current = get("current_A");
        wheel.duty = get("duty");
        wheel.voltage = get("voltage_V");
        const auto flag = log.header.find("unsigned." + name + "current_A");
        wheel.unsigned_current = machine.unsigned_current || (flag != log.header.end() && flag->second != "0");
        const std::vector<double> count = get("encoder_count");
        std::vector<double> angle;
        if (const log::Signal *turned = log.find(name + "angle_rad")) {
            const log::Signal unwrapped = wraps(*turned) ? continuous(*turned) : *turned;
            angle = resample(&unwrapped, grid.start_s, grid.count);
        }
        if (!count.empty()) wheel.count_rate = slope(count, 2);
        const auto sign = log.header.find("firmware.encoder_sign_" + std::to_string(wheel.index)); // an encoder that counts the other way
        if (sign != log.header.end() && sign->second == "-1")
            for (double &rate : wheel.count_rate) rate = -rate;
        if (!angle.empty()) wheel.angle_rate = slope(angle, 2);
        if (wheel.voltage.empty() && grid.battery.empty()) {
            wheel.voltage = wheel.duty;
            wheel.in_volts = std::isfinite(machine.battery_V);
            for (double &u : wheel.voltage) u *= wheel.in_volts ? machine.battery_V : 1.0;
        } else if (wheel.voltage.empty() && !wheel.duty.empty()) {
            wheel.voltage.assign(grid.count, not_known);
            for (std::size_t k = 0; k < grid.count; ++k) wheel.voltage[k] = wheel.duty[k] * grid.battery[k];
        }
        grid.wheel.push_back(std::move(wheel));
    }
    derive_speeds(grid);
}

void add_ground_speed(Grid &grid, const Machine &machine) {
    grid.mean_speed.assign(grid.count, not_known);
    grid.active.assign(grid.count, 0);
    for (std::size_t k = 0; k < grid.count; ++k) {
        double sum = 0, n = 0;
        for (const Wheel &wheel : grid.wheel) {
            if (!wheel.speed.empty() && std::isfinite(wheel.speed[k])) sum += wheel.speed[k], n += 1;
            const bool turns = !wheel.speed.empty() && std::fabs(wheel.speed[k]) > 0.3;
            if (turns || (!wheel.duty.empty() && std::fabs(wheel.duty[k]) > 0.05)) grid.active[k] = 1;
        }
        if (n > 0) grid.mean_speed[k] = sum / n;
    }
    if (!grid.carriage.empty()) {
        grid.ground_speed = grid.carriage, grid.ground_source = "carriage.speed_m_s";
    } else if (!grid.camera_forward.empty()) {
        grid.ground_speed = grid.camera_forward, grid.ground_source = "camera.x_m";
    } else if (!grid.radar.empty()) {
        grid.ground_speed = grid.radar, grid.ground_source = "radar.speed_m_s";
        for (std::size_t k = 0; k < grid.count; ++k) { // the radar may not know the direction
            if (grid.mean_speed[k] < 0) grid.ground_speed[k] = -std::fabs(grid.ground_speed[k]);
        }
    }
    if (grid.ground_speed.empty() || !machine.wheels_point_forward) return;
    std::vector<double> ratio; // where the wheels agree and turn, straight ahead
    for (std::size_t k = 0; k < grid.count; ++k) {
        double size = 0, n = 0;
        for (const Wheel &wheel : grid.wheel) {
            if (!wheel.speed.empty()) size += std::fabs(wheel.speed[k]), n += 1;
        }
        if (!(size / n > 0.5) || std::fabs(grid.mean_speed[k]) < 0.7 * size / n) continue;
        if (!grid.gyro.empty() && std::fabs(grid.gyro[k]) > 0.3) continue;
        ratio.push_back(std::fabs(grid.ground_speed[k]) * n / size);
    }
    if (ratio.size() >= 40) grid.effective_radius_m = quantile(ratio, 0.9), grid.middle_radius_m = quantile(ratio, 0.5);
}

} // namespace

namespace {

// Wheels are told by their number where some may have no speed in the log; else by their order.
bool by_number(const Machine &machine) { return !machine.motor_of_wheel.empty() || machine.free_wheels > 0; }

} // namespace

bool knows_sides(const Grid &grid, const Machine &machine) {
    if (!by_number(machine)) return machine.wheel_y_m.size() == grid.wheel.size();
    return std::all_of(grid.wheel.begin(), grid.wheel.end(),
                       [&](const Wheel &wheel) { return wheel.index < static_cast<int>(machine.wheel_y_m.size()); });
}

double left_of(const Grid &grid, const Machine &machine, std::size_t i) {
    return machine.wheel_y_m[by_number(machine) ? static_cast<std::size_t>(grid.wheel[i].index) : i];
}

bool is_steady(const Wheel &wheel) {
    constexpr double within = 0.1; // of the median: assumed
    std::vector<double> size, moving;
    for (const double w : wheel.speed)
        if (std::isfinite(w)) size.push_back(std::fabs(w));
    const double still = 0.2 * quantile(size, 0.9); // standstill and its noise
    for (const double w : wheel.speed)
        if (std::fabs(w) > still) moving.push_back(w);
    const double middle = quantile(moving, 0.5), room = within * std::fabs(middle);
    return moving.size() > 2 && quantile(moving, 0.975) < middle + room && quantile(moving, 0.025) > middle - room;
}

Grid make_grid(const log::Log &log, const Machine &machine) {
    Grid grid;
    double first = 0, last = 0;
    bool any = false;
    for (const log::Signal &signal : log.signals) {
        if (signal.t_s.empty() || log::find_quantity(signal.name) == nullptr || signal.name.rfind("truth.", 0) == 0) continue;
        first = any ? std::min(first, signal.t_s.front()) : signal.t_s.front();
        last = any ? std::max(last, signal.t_s.back()) : signal.t_s.back();
        any = true;
    }
    const auto rows = log.header.find("rows");
    constexpr double longest_s = 50000; // [s] a million cells; beyond, the unit of time is wrong
    if (!any || last - first > longest_s || (rows != log.header.end() && rows->second == "trials")) return grid;
    grid.start_s = first;
    grid.count = static_cast<std::size_t>((last - first) / step_s) + 1;
    const auto get = [&](const char *name) { return resample(log.find(name), grid.start_s, grid.count); };
    grid.battery = get("battery.voltage_V");
    grid.accel = get("imu.accel_x_m_s2");
    grid.gyro = get("imu.gyro_z_rad_s");
    grid.radar = get("radar.speed_m_s");
    grid.carriage = get("carriage.speed_m_s");
    add_camera(log, grid);
    add_wheels(log, machine, grid);
    add_ground_speed(grid, machine);
    return grid;
}

void add_error(Findings &findings, const char *id, const std::string &signal, std::string text, std::string mend, double value) {
    findings.push_back({id, Severity::error, signal, std::move(text), std::move(mend), value});
}

bool has_error(const Findings &findings, const std::string &start) {
    return std::any_of(findings.begin(), findings.end(),
                       [&](const Finding &f) { return f.severity == Severity::error && f.signal.rfind(start, 0) == 0; });
}

} // namespace traction::check
