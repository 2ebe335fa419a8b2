// Each motor against its own electrics, U = ke*w + Ra*I: a sign, a unit or a swap of columns breaks it, whatever the ground does.
#include "series.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>

namespace traction::check {

namespace {

// Of the voltage's power, in means over half a second, the command up to 0.25 s late. Windings that grow by two thirds as they warm up, a
// bridge's dead time, blocked wheels and play leave 0.95 and more.
constexpr double well_explained = 0.93;
constexpr double current_tells = 0.7; // correlation of voltage and current, the speed's part taken out of both; sound logs stand above 0.95

struct Law {
    const Wheel *wheel = nullptr;
    Fit fit;
    bool tells = false; // the line explains the voltage
};

std::string name_of(const Wheel &wheel, const char *quantity) {
    if (std::string_view(quantity) == "speed_rad_s") return wheel.speed_column;
    return "wheel" + std::to_string(wheel.index) + "." + quantity;
}

void add(Findings &findings, const char *id, Severity severity, const std::string &signal, std::string text, std::string mend,
         double value) {
    findings.push_back({id, severity, signal, std::move(text), std::move(mend), value});
}

double share_explained(const Fit &fit) { return fit.good && fit.y_rms > 0 ? 1 - fit.rms * fit.rms / (fit.y_rms * fit.y_rms) : 0; }

void check_ranges(const Grid &grid, Findings &findings) {
    for (const Wheel &wheel : grid.wheel) {
        std::vector<double> size = wheel.duty;
        for (double &v : size) v = std::fabs(v);
        const double duty = quantile(size, 0.995);
        if (duty > 1.05) {
            const double scale = duty < 101 ? 100 : duty < 256 ? 255 : duty < 1025 ? 1023 : 32767;
            add(findings, "unit", Severity::error, name_of(wheel, "duty"),
                say("'%s' reaches %.4g, but a duty lies within -1..1", name_of(wheel, "duty").c_str(), duty),
                say("divide it by %.0f", scale), duty);
        }
        size = wheel.current;
        for (double &v : size) v = std::fabs(v);
        const double current = quantile(size, 0.99);
        if (current > 100) { // [A] assumed: no rover of this class draws it
            add(findings, "unit", Severity::error, name_of(wheel, "current_A"),
                say("'%s' reaches %.4g A: it looks like mA", name_of(wheel, "current_A").c_str(), current), "multiply it by 0.001",
                current);
        }
    }
    const double battery = quantile(grid.battery, 0.5), spread = quantile(grid.battery, 0.99) - quantile(grid.battery, 0.01);
    if (grid.battery.empty()) return;
    if (battery <= 0) {
        add(findings, "sign", Severity::error, "battery.voltage_V", say("the battery voltage is %.4g V", battery),
            "turn its sign round, or check the wiring", battery);
    } else if (battery > 100 || battery < 1.5) { // [V] assumed
        add(findings, "unit", Severity::error, "battery.voltage_V",
            say("the battery voltage is %.4g V: it looks like %s", battery, battery > 100 ? "mV" : "kV or a ratio"),
            battery > 100 ? "multiply it by 0.001" : "scale it to volts", battery);
    } else if (spread > 0.6 * battery) {
        add(findings, "battery_unsteady", Severity::warning, "battery.voltage_V",
            say("the battery voltage spreads over %.3g V around %.3g V", spread, battery), "charge the battery, or check the divider",
            spread);
    }
}

// Residual power of wheel i's equation with one quantity taken from wheel j; infinite where no motor has such signs.
using Powers = std::vector<std::vector<double>>;
Powers powers_of(const std::vector<Law> &laws, const char *quantity) {
    const std::string_view taken = quantity;
    Powers power(laws.size(), std::vector<double>(laws.size(), 0));
    for (std::size_t i = 0; i < laws.size(); ++i) {
        for (std::size_t j = 0; j < laws.size(); ++j) {
            const Wheel &own = *laws[i].wheel, &other = *laws[j].wheel;
            const Fit line = i == j ? laws[i].fit
                                    : fit(taken == "duty" ? other.voltage : own.voltage, taken == "speed_rad_s" ? other.speed : own.speed,
                                          taken == "current_A" ? other.current : own.current);
            const bool physical = i == j ? line.good : line.good && line.a > 0 && line.b > 0;
            power[i][j] = physical ? line.rms * line.rms : std::numeric_limits<double>::infinity();
        }
    }
    return power;
}

// Which wheels' columns were exchanged, in pairs or round a ring? The wheels concerned must be left with less than a quarter of their
// residual power. Each order of up to six wheels is tried.
void check_swaps(std::vector<Law> &laws, Findings &findings) {
    std::erase_if(laws, [](const Law &law) { return !law.fit.good; });
    if (laws.size() < 2 || laws.size() > 6) return;
    struct Best {
        const char *quantity = "";
        std::vector<std::size_t> order;
        double gain = 4, power = std::numeric_limits<double>::infinity();
    } best;
    for (const char *quantity : {"current_A", "speed_rad_s", "duty"}) {
        const Powers power = powers_of(laws, quantity);
        std::vector<std::size_t> order(laws.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        while (std::next_permutation(order.begin(), order.end())) {
            double as_is = 0, moved = 0, total = 0;
            bool each = true; // wheel that moves is the better for it
            for (std::size_t i = 0; i < order.size(); ++i) {
                total += power[i][order[i]];
                if (order[i] == i) continue;
                as_is += power[i][i], moved += power[i][order[i]];
                each = each && power[i][order[i]] < power[i][i];
            }
            if (each && moved * best.gain < as_is && total < best.power) best = {quantity, order, 4, total};
        }
    }
    for (std::size_t i = 0; i < best.order.size(); ++i) {
        if (best.order[i] == i) continue;
        laws[i].tells = false; // nothing more can be said of these
        const std::size_t j = best.order[i];
        const bool pair = best.order[j] == i;
        if (pair && j < i) continue;
        const std::string first = name_of(*laws[i].wheel, best.quantity), second = name_of(*laws[j].wheel, best.quantity);
        const double better = laws[i].fit.rms / std::sqrt(powers_of({laws[i], laws[j]}, best.quantity)[0][1]);
        add(findings, "swapped_wheels", Severity::error, first,
            pair ? say("'%s' and '%s' are exchanged: the motors' voltages fit %.1f times better with them swapped", first.c_str(),
                       second.c_str(), better)
                 : say("'%s' belongs to the wheel that now has '%s': that motor's voltage then fits %.1f times better", second.c_str(),
                       first.c_str(), better),
            pair ? "exchange the two columns" : "put the wheels' columns in their order", better);
    }
}

void check_signs(std::vector<Law> &laws, Findings &findings) {
    for (Law &law : laws) {
        if (!law.tells) continue;
        const bool back_emf = law.fit.a > 4 * law.fit.error_a, winding = law.fit.b > 4 * law.fit.error_b;
        const bool no_back_emf = law.fit.a < -4 * law.fit.error_a, no_winding = law.fit.b < -4 * law.fit.error_b;
        const char *wrong = no_back_emf && no_winding ? "duty"
                            : no_back_emf && winding  ? "speed_rad_s"
                            : back_emf && no_winding  ? "current_A"
                                                      : nullptr;
        if (wrong == nullptr) continue;
        law.tells = false;
        const std::string name = name_of(*law.wheel, wrong);
        add(findings, "sign", Severity::error, name,
            say("'%s' has the wrong sign: the motor's voltage is %.3g*speed %+.3g*current, both must be above 0", name.c_str(), law.fit.a,
                law.fit.b),
            "turn its sign round (map: sign = -1)", law.fit.a);
    }
}

void check_units(const std::vector<Law> &laws, const Grid &grid, const Machine &machine, Findings &findings) {
    const auto reported = [&](const std::string &name) {
        return std::any_of(findings.begin(), findings.end(), [&](const Finding &f) { return f.id == "unit" && f.signal == name; });
    };
    for (const Law &law : laws) {
        if (!law.tells) continue;
        std::vector<double> other_a, other_b;
        for (const Law &other : laws) {
            if (&other != &law && other.tells) other_a.push_back(other.fit.a), other_b.push_back(other.fit.b);
        }
        const bool in_volts = law.wheel->in_volts;
        const double ke = in_volts && !grid.speed_is_guessed && std::isfinite(machine.back_emf_Vs) ? machine.back_emf_Vs
                          : other_a.size() >= 2                                                    ? quantile(other_a, 0.5)
                                                                                                   : not_known;
        const double resistance = in_volts && std::isfinite(machine.resistance_ohm) ? machine.resistance_ohm
                                  : other_b.size() >= 2                             ? quantile(other_b, 0.5)
                                                                                    : not_known;
        const std::string speed = name_of(*law.wheel, "speed_rad_s"), current = name_of(*law.wheel, "current_A");
        if (const UnitSlip *slip = law.fit.a > 4 * law.fit.error_a ? unit_slip('w', ke / law.fit.a) : nullptr;
            slip != nullptr && !reported(speed)) {
            add(findings, "unit", Severity::error, speed,
                say("'%s' is %.3g times too large for its motor's back-EMF: it looks like %s", speed.c_str(), ke / law.fit.a,
                    looks_like(*slip, speed).c_str()),
                say("multiply it by %.6g", 1 / slip->factor), ke / law.fit.a);
        }
        if (const UnitSlip *slip = law.fit.b > 4 * law.fit.error_b ? unit_slip('I', resistance / law.fit.b) : nullptr;
            slip != nullptr && !reported(current)) {
            add(findings, "unit", Severity::error, current,
                say("'%s' is %.3g times too large for its winding: it looks like %s", current.c_str(), resistance / law.fit.b,
                    slip->written),
                say("multiply it by %.6g", 1 / slip->factor), resistance / law.fit.b);
        } else if (in_volts && law.fit.b > 4 * law.fit.error_b && law.fit.b < 0.02 &&
                   !reported(current)) { // [ohm] assumed: no small motor has less
            add(findings, "unit", Severity::error, current,
                say("'%s' would mean a winding of %.3g ohm: it looks like mA", current.c_str(), law.fit.b), "multiply it by 0.001",
                law.fit.b);
        }
    }
}

// The same over half a second, with the command up to 0.25 s late: a loop that swings quickly leaves no more to see in steps of 50 ms.
double best_share(const Wheel &wheel) {
    double best = 0;
    const std::vector<double> speed = smooth(wheel.speed, 5), current = smooth(wheel.current, 5);
    for (std::size_t late = 0; late <= 5; ++late) {
        std::vector<double> voltage(wheel.voltage.size(), not_known);
        for (std::size_t k = late; k < voltage.size(); ++k) voltage[k] = wheel.voltage[k - late];
        best = std::max(best, share_explained(fit(smooth(voltage, 5), speed, current)));
    }
    return best;
}

// Share of white noise in the power of means over half a second: that of the cells, less by their number.
double noise_share(const std::vector<double> &cells) {
    double bends = 0, n = 0, power = 0, m = 0;
    for (std::size_t k = 1; k + 1 < cells.size(); ++k) {
        const double bend = cells[k - 1] - 2 * cells[k] + cells[k + 1]; // of white noise: six times its variance
        if (std::isfinite(bend)) bends += bend * bend, n += 1;
    }
    for (const double v : smooth(cells, 5))
        if (std::isfinite(v)) power += v * v, m += 1;
    return n > 0 && power > 0 ? (bends / n / 6 / 11) / (power / m) : 1;
}

std::vector<double> less(const std::vector<double> &y, const std::vector<double> &x, double slope) {
    std::vector<double> out(y.size());
    for (std::size_t k = 0; k < y.size(); ++k) out[k] = y[k] - slope * x[k];
    return out;
}

// What white noise leaves of the voltage's power beside its law.
double unexplained_by_noise(const Wheel &wheel) {
    const Fit law = fit(smooth(wheel.voltage, 5), smooth(wheel.speed, 5), smooth(wheel.current, 5));
    const std::vector<double> left = less(less(wheel.voltage, wheel.speed, law.a), wheel.current, law.b);
    double power = 0, n = 0;
    for (const double v : smooth(left, 5))
        if (std::isfinite(v)) power += v * v, n += 1;
    return n > 0 && law.y_rms > 0 ? noise_share(left) * power / n / (law.y_rms * law.y_rms) : 0;
}

// The current with its sign's share added, in root mean squares: what a bridge asks of the voltage where its dead time costs that much more
// than the winding (bridge_dead_time). Through zero the sign goes smoothly, over a fifth of them.
std::vector<double> with_dead_time(const std::vector<double> &current, double times) {
    double power = 0, n = 0;
    for (const double i : current)
        if (std::isfinite(i)) power += i * i, n += 1;
    const double rms = n > 0 ? std::sqrt(power / n) : 0;
    std::vector<double> out = current;
    for (double &i : out) i += rms > 0 ? times * rms * i / std::sqrt(i * i + 0.04 * rms * rms) : 0;
    return out;
}

// Correlation of voltage and current, the speed's part taken out of both, over half a second and the best of 0 to 0.25 s of delay, and of
// a bridge without and with a dead time. 1 where either is mostly noise, or the drive is steady.
double current_beside_voltage(const Wheel &wheel) {
    if (is_steady(wheel)) return 1;
    double best = 0;
    const std::vector<double> speed = smooth(wheel.speed, 5);
    for (const double times : {0.0, 2.0, 6.0}) {
        const std::vector<double> asked = with_dead_time(wheel.current, times), current = smooth(asked, 5);
        for (std::size_t late = 0; late <= 5; ++late) {
            std::vector<double> voltage(wheel.voltage.size(), not_known);
            for (std::size_t k = late; k < voltage.size(); ++k) voltage[k] = wheel.voltage[k - late];
            const double u = fit(smooth(voltage, 5), speed).a, i = fit(current, speed).a;
            if (late == 0 && times == 0 &&
                (noise_share(less(voltage, wheel.speed, u)) > 0.2 || noise_share(less(wheel.current, wheel.speed, i)) > 0.2))
                return 1;
            best = std::max(best, correlation(less(smooth(voltage, 5), speed, u), less(current, speed, i)));
        }
    }
    return best;
}

} // namespace

void check_drives(const Grid &grid, const Machine &machine, Findings &findings) {
    check_ranges(grid, findings);
    std::vector<Law> laws;
    const bool no_volts = std::any_of(findings.begin(), findings.end(),
                                      [](const Finding &f) { return f.severity == Severity::error && f.signal == "battery.voltage_V"; });
    if (no_volts) return; // every law below would be off by the same factor
    for (const Wheel &wheel : grid.wheel) {
        if (wheel.voltage.empty() || wheel.speed.empty() || wheel.current.empty() || wheel.unsigned_current) continue;
        Law law{&wheel, fit(wheel.voltage, wheel.speed, wheel.current)};
        law.tells = share_explained(law.fit) > 0.8;
        laws.push_back(law);
    }
    check_swaps(laws, findings);
    check_signs(laws, findings);
    check_units(laws, grid, machine, findings);
    for (const Law &law : laws) {
        if (!law.fit.good || law.fit.y_rms == 0) continue;
        Wheel wheel = *law.wheel; // without wild samples: a spike is told as that
        wheel.voltage = tame(wheel.voltage), wheel.speed = tame(wheel.speed), wheel.current = tame(wheel.current);
        const double share = share_explained(law.fit), best = share > well_explained ? share : best_share(wheel);
        const double tells = current_beside_voltage(wheel);
        if (share > 0.8 && best > well_explained && tells > current_tells) continue;
        const bool explained = std::any_of(findings.begin(), findings.end(), [&](const Finding &f) {
            return f.severity == Severity::error && f.signal.rfind("wheel" + std::to_string(law.wheel->index) + ".", 0) == 0;
        });
        const bool swapped = std::any_of(findings.begin(), findings.end(), [](const Finding &f) { return f.id == "swapped_wheels"; });
        if (explained || swapped) continue;
        // a motor that moves obeys this equation whatever the ground does
        const bool noisy = best > 0.4 && 1 - best < 4 * unexplained_by_noise(wheel);
        const std::string current = name_of(*law.wheel, "current_A");
        if (tells < current_tells && best > 0.4) {
            add(findings, "unrelated", Severity::error, current,
                say("'%s' does not follow the voltage of its motor (correlation %.2f beside the speed)", current.c_str(), tells),
                "check that it is this wheel's current, of this run and this time, with its sign, and not filtered", tells);
            continue;
        }
        add(findings, "drive_unexplained", best < well_explained && !noisy ? Severity::error : Severity::warning, current,
            say("speed and current explain only %.0f %% of the voltage of wheel %d (%.0f %% of means over half a second)", 100 * share,
                law.wheel->index, 100 * best),
            "check that duty, speed and current are of the same wheel and the same time, with their signs, and not filtered", share);
    }
    // Without a voltage: the reference of the speed loop says which wheel, sign and unit.
    for (const Wheel &wheel : grid.wheel) {
        if (!wheel.voltage.empty() || wheel.speed.empty() || wheel.set_speed.empty()) continue;
        const Fit line = fit(wheel.speed, wheel.set_speed);
        const double alike = correlation(wheel.speed, wheel.set_speed);
        const std::string name = name_of(wheel, "speed_rad_s");
        if (line.good && share_explained(line) > 0.7 && line.a < 0) {
            add(findings, "sign", Severity::error, name, say("'%s' runs against its own reference (slope %.3g)", name.c_str(), line.a),
                "turn its sign round (map: sign = -1)", line.a);
        } else if (const UnitSlip *slip = line.good && (share_explained(line) > 0.7 || alike > 0.8) ? unit_slip('w', line.a) : nullptr) {
            add(findings, "unit", Severity::error, name,
                say("'%s' is %.3g times its reference: it looks like %s", name.c_str(), line.a, looks_like(*slip, name).c_str()),
                say("multiply it by %.6g", 1 / slip->factor), line.a);
        }
    }
    for (std::size_t i = 0; i < grid.wheel.size(); ++i) {
        for (std::size_t j = i + 1; j < grid.wheel.size(); ++j) {
            const Wheel &a = grid.wheel[i], &b = grid.wheel[j];
            if (!a.voltage.empty() || a.speed.empty() || b.speed.empty() || a.set_speed.empty() || b.set_speed.empty()) continue;
            const auto distance = [](const std::vector<double> &x, const std::vector<double> &y) {
                double sum = 0, n = 0;
                for (std::size_t k = 0; k < x.size(); ++k) {
                    if (std::isfinite(x[k] - y[k])) sum += (x[k] - y[k]) * (x[k] - y[k]), n += 1;
                }
                return n > 40 ? sum / n : not_known;
            };
            const double as_is = distance(a.speed, a.set_speed) + distance(b.speed, b.set_speed),
                         swapped = distance(a.speed, b.set_speed) + distance(b.speed, a.set_speed);
            if (!(swapped < 0.25 * as_is)) continue;
            add(findings, "swapped_wheels", Severity::error, name_of(a, "speed_rad_s"),
                say("'%s' and '%s' are exchanged: each follows the other's reference", name_of(a, "speed_rad_s").c_str(),
                    name_of(b, "speed_rad_s").c_str()),
                "exchange the two columns", std::sqrt(as_is / swapped));
        }
    }
}

} // namespace traction::check
