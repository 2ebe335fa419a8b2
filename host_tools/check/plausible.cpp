// Scales that no effect of the catalogue reaches, magnitudes that are taken for signed values, signs without a voltage.
//
//   U = ke*w + Ra*I        with a known machine: a factor in both is the voltage's, in ke alone the wheel speed's, in Ra alone the
//   current's I*w > 0 on the whole   dry friction and rolling only consume
#include "series.h"

#include "host_tools/log/vocabulary.h"

#include <algorithm>
#include <cmath>

namespace traction::check {

namespace {

// The widest scale of the catalogue is 0.4 (current_gain), of radii and voltages 0.3; beyond 1.6 it is a mistake.
constexpr double widest_scale = 1.6;
constexpr double widest_back_emf = 1.4; // of the back-EMF alone, downwards: voltage_gain takes the winding with it, lost counts raise it
constexpr double widest_winding = 4;    // wiring_resistance may nearly double Ra, noise of the current may halve what a fit finds of it
constexpr double most_slip = 0.5;       // [1] through a whole drive, where slip is least: beyond, the radius is wrong

bool beyond(double ratio, double limit) { return std::isfinite(ratio) && (ratio > limit || ratio < 1 / limit); }

double middle(const std::vector<double> &values) { return quantile(values, 0.5); }

// Voltage, speed and current against the model's motor, by the median of the wheels.
void motor_scale(const Grid &grid, const Machine &machine, Findings &findings) {
    if (!std::isfinite(machine.back_emf_Vs) || has_error(findings, "battery")) return;
    std::vector<double> ke, Ra;
    std::string speed, current;
    for (const Wheel &wheel : grid.wheel) {
        const std::string name = "wheel" + std::to_string(wheel.index) + ".";
        if (wheel.unsigned_current || !wheel.in_volts || wheel.voltage.empty() || wheel.speed.empty() || wheel.current.empty() ||
            grid.speed_is_guessed || has_error(findings, name))
            continue;
        const Fit law = fit(wheel.voltage, wheel.speed, wheel.current);
        if (!law.good || law.rms * law.rms > 0.1 * law.y_rms * law.y_rms || !(law.a > 8 * law.error_a)) continue;
        ke.push_back(law.a / machine.back_emf_Vs);
        if (law.b > 8 * law.error_b && std::isfinite(machine.resistance_ohm)) Ra.push_back(law.b / machine.resistance_ohm);
        if (speed.empty()) speed = wheel.speed_column, current = name + "current_A";
    }
    if (ke.empty()) return;
    const double a = middle(ke), b = Ra.empty() ? not_known : middle(Ra);
    const bool both = std::isfinite(b) && !beyond(a / b, 1.25);
    if (beyond(a, widest_scale) || (a < 1 / widest_back_emf && std::isfinite(b) && !both && b > 0.8)) {
        if (both) {
            add_error(findings, "scale", grid.battery.empty() ? "wheel.duty" : "battery.voltage_V",
                      say("the motors' voltage is %.3g times what their back-EMF and winding together need (medians of %zu wheels)", a,
                          ke.size()),
                      say("find the factor %.3g in battery voltage or duty; or mend back-EMF and resistance in the model", a), a);
        } else {
            add_error(findings, "scale", speed,
                      say("the wheels turn %.3g times as fast as their motors' back-EMF allows (median of %zu wheels)", 1 / a, ke.size()),
                      "check encoder.counts_per_turn, the gear ratio and the unit of the wheel speed; or the model's back-EMF", 1 / a);
        }
    } else if (beyond(b, widest_winding)) {
        add_error(findings, "scale", current,
                  say("the currents are %.3g times what the motors' winding lets through (median of the wheels)", 1 / b),
                  "check the gain of the current sensors; or the model's resistance", 1 / b);
    }
}

// One motor against the others of the machine, whatever they are: no effect makes one this different.
void odd_motor(const Grid &grid, Findings &findings) {
    struct One {
        const Wheel *wheel;
        Fit law;
    };
    std::vector<One> all;
    for (const Wheel &wheel : grid.wheel) {
        if (wheel.unsigned_current || wheel.voltage.empty() || wheel.speed.empty() || wheel.current.empty()) continue;
        const Fit law = fit(wheel.voltage, wheel.speed, wheel.current);
        if (law.good && law.rms * law.rms < 0.1 * law.y_rms * law.y_rms && law.a > 8 * law.error_a && law.b > 8 * law.error_b)
            all.push_back({&wheel, law});
    }
    for (const One &one : all) {
        std::vector<double> ke, Ra;
        for (const One &other : all)
            if (other.wheel != one.wheel) ke.push_back(other.law.a), Ra.push_back(other.law.b);
        const std::string current = "wheel" + std::to_string(one.wheel->index) + ".current_A";
        if (ke.size() < 2 || has_error(findings, "wheel" + std::to_string(one.wheel->index) + ".")) continue;
        const double a = middle(ke) / one.law.a, b = middle(Ra) / one.law.b;
        if (beyond(a, 1.8)) // a wheel that a sweep drags was seen at 1.64; every second count is 2
            add_error(findings, "scale", one.wheel->speed_column,
                      say("'%s' is %.3g times as large as its motor's back-EMF allows beside those of the other wheels",
                          one.wheel->speed_column.c_str(), a),
                      "check this encoder's counts per turn, its unit and its gear", a);
        else if (beyond(b, 2.5)) // wiring_resistance and heat reach 2
            add_error(findings, "scale", current,
                      say("'%s' is %.3g times as large as its winding lets through beside those of the other wheels", current.c_str(), b),
                      "check the gain and the unit of this current sensor", b);
    }
}

// A current, or a speed, that has nothing to do with its motor: the winding, or the back-EMF, that is left is far below the known one.
void stray_current(const Grid &grid, const Machine &machine, Findings &findings) {
    if (!std::isfinite(machine.resistance_ohm) || grid.speed_is_guessed) return;
    if (std::any_of(findings.begin(), findings.end(), [](const Finding &f) { return f.id == "swapped_wheels"; })) return;
    for (const Wheel &wheel : grid.wheel) {
        const std::string start = "wheel" + std::to_string(wheel.index) + ".", name = start + "current_A";
        if (wheel.unsigned_current || !wheel.in_volts || wheel.voltage.empty() || wheel.speed.empty() || wheel.current.empty()) continue;
        if (has_error(findings, start) || has_error(findings, "battery")) continue;
        const Fit law = fit(wheel.voltage, wheel.speed, wheel.current);
        if (law.good && std::isfinite(machine.back_emf_Vs) && law.a + 4 * law.error_a < machine.back_emf_Vs / widest_winding) {
            add_error(findings, "unrelated", wheel.speed_column,
                      say("'%s' does not go with the voltage of its motor: a back-EMF of %.3g V s is left of %.3g",
                          wheel.speed_column.c_str(), law.a, machine.back_emf_Vs),
                      "check that it is this wheel's speed, of this run and this time; or the model's back-EMF", law.a);
            continue;
        }
        if (!law.good || is_steady(wheel) || !(law.b + 4 * law.error_b < machine.resistance_ohm / widest_winding)) continue;
        add_error(findings, "unrelated", name,
                  say("'%s' does not go with the voltage of its motor: a winding of %.3g ohm is left of %.3g", name.c_str(), law.b,
                      machine.resistance_ohm),
                  "check that it is this wheel's current, of this run and this time; or the model's resistance", law.b);
    }
}

// One wheel that turns against all the others of a machine that drives straight: its motor is mounted the other way round.
void odd_wheel(const Grid &grid, const Machine &machine, Findings &findings) {
    // without a model three wheels may be an omni robot's
    std::vector<const Wheel *> turning; // those whose speed was logged
    for (const Wheel &wheel : grid.wheel)
        if (!wheel.speed.empty()) turning.push_back(&wheel);
    if (!machine.wheels_point_forward || turning.size() < (machine.wheel_y_m.empty() ? 4U : 3U) || has_error(findings, "wheel")) return;
    const double turns = 0.3 * std::fmax(std::fabs(quantile(grid.gyro, 0.98)), std::fabs(quantile(grid.gyro, 0.02)));
    const auto straight = [&](std::vector<double> speed) {
        for (std::size_t k = 0; k < speed.size() && !grid.gyro.empty(); ++k)
            if (std::fabs(grid.gyro[k]) > turns) speed[k] = not_known;
        return speed;
    };
    for (const Wheel *odd : turning) {
        const std::vector<double> own = straight(odd->speed);
        bool against = true, together = true;
        for (const Wheel *other : turning) {
            if (other == odd) continue;
            const Fit line = fit(straight(other->speed), own);
            against = against && line.good && line.a < 0 && line.rms < 0.7 * line.y_rms;
            for (const Wheel *third : turning) {
                if (third == odd || third == other) continue;
                const Fit both = fit(straight(other->speed), straight(third->speed));
                together = together && both.good && both.a > 0 && both.rms < 0.7 * both.y_rms;
            }
        }
        if (!against || !together) continue;
        add_error(findings, "sign", odd->speed_column,
                  say("'%s' turns against all other wheels while the machine drives straight", odd->speed_column.c_str()),
                  "its motor is mounted the other way round: turn the signs of its speed, current and duty round (map: sign = -1)", -1);
        return;
    }
}

// The left and right of the model's wheels, or too few of them.
void wheels_of_model(const Grid &grid, const Machine &machine, Findings &findings) {
    if (machine.wheel_y_m.empty() || !machine.rolls_freely || !machine.on_ground) return;
    const auto drives = [&](int index) {
        return std::any_of(grid.wheel.begin(), grid.wheel.end(),
                           [&](const Wheel &w) { return w.index == index && !w.speed.empty() && !w.current.empty(); });
    };
    for (const Wheel &wheel : grid.wheel) {
        if (wheel.index < static_cast<int>(machine.wheel_y_m.size()) || !drives(wheel.index)) continue;
        add_error(findings, "wheels", wheel.speed_column,
                  say("the log has a driven wheel %d, the model has %zu wheels from 0", wheel.index, machine.wheel_y_m.size()),
                  "give the model all wheels that push, or map the log's wheels to the model's", wheel.index);
        return;
    }
}

// Speed over ground against wheel speed and the known radius.
void radius_scale(const Grid &grid, const Machine &machine, Findings &findings) {
    const double ratio = grid.effective_radius_m / machine.wheel_radius_m;
    if (!std::isfinite(ratio) || !machine.wheels_point_forward || !machine.rolls_freely || grid.speed_is_guessed) return;
    if (has_error(findings, "wheel") || has_error(findings, grid.ground_source)) return;
    // wheels that are locked now and then are left behind: then half of the drive does not see it
    const bool too_far = ratio > widest_scale && grid.middle_radius_m > 1.3 * machine.wheel_radius_m;
    if (!too_far && ratio > most_slip) return;
    add_error(findings, "scale", grid.wheel.front().speed_column,
              say("over ground the machine moves %.3g times as far as its wheels roll with the known radius of %.4g m ('%s')", ratio,
                  machine.wheel_radius_m, grid.ground_source.c_str()),
              say("check encoder.counts_per_turn and gear ratio (a factor %.3g), the radius in the model, and the unit of '%s'", 1 / ratio,
                  grid.ground_source.c_str()),
              ratio);
}

// The accelerometer against the wheels' acceleration times the known radius, where nothing else sees the ground.
void accel_scale(const Grid &grid, const Machine &machine, Findings &findings) {
    if (grid.accel.empty() || !grid.ground_speed.empty() || !std::isfinite(machine.wheel_radius_m) || grid.speed_is_guessed) return;
    if (!machine.wheels_point_forward || !machine.rolls_freely || has_error(findings, "wheel") || has_error(findings, "imu.accel")) return;
    std::vector<double> reference = slope(smooth(grid.mean_speed, 5), 5), measured = smooth(smooth(grid.accel, 5), 5);
    const double offset = quantile(measured, 0.5);
    for (double &v : reference) v *= machine.wheel_radius_m;
    for (double &v : measured) v -= offset;
    const Fit line = fit(measured, reference);
    if (!line.good || correlation(measured, reference) < 0.9 || (line.a > 0.4 && line.a < 2)) return;
    add_error(
        findings, "scale", "imu.accel_x_m_s2",
        say("the accelerometer reads %.3g of the acceleration of the wheels' rims (known radius %.4g m)", line.a, machine.wheel_radius_m),
        "check the accelerometer's scale, encoder.counts_per_turn, and the radius in the model", line.a);
}

// A current that never is negative although the motor pushes both ways.
void magnitude(const Wheel &wheel, Findings &findings) {
    if (wheel.current.empty() || wheel.speed.empty()) return;
    const std::string name = "wheel" + std::to_string(wheel.index) + ".current_A";
    std::vector<double> size = wheel.current, turn = wheel.speed;
    for (double &v : size) v = std::fabs(v);
    for (double &v : turn) v = std::fabs(v);
    const double largest = quantile(size, 0.98), least = quantile(wheel.current, 0.005), fastest = quantile(turn, 0.98);
    if (wheel.unsigned_current && largest > 0 && least < -0.2 * largest) // noise about zero may fall below it, no more
        add_error(findings, "magnitude", name, say("'%s' is declared a magnitude, but reaches %.3g A", name.c_str(), least),
                  "take unsigned out of the map, the header or [sensors.current] of the model: this current has its sign", least);
    if (wheel.unsigned_current || !(largest > 0) || least < -0.05 * largest) return;
    const auto tell = [&](const char *evidence, double value) {
        add_error(findings, "magnitude", name, say("'%s' is never negative, but %s", name.c_str(), evidence),
                  "declare it a magnitude: unsigned = true in the map or in [sensors.current] of the model, or '# unsigned." + name +
                      ": 1' in the header",
                  value);
    };
    double back = 0, backwards = 0, forward = 0, forwards = 0;
    for (std::size_t k = 0; k < wheel.speed.size(); ++k) {
        if (!std::isfinite(wheel.current[k])) continue;
        if (wheel.speed[k] < -0.1 * fastest) back += wheel.current[k], backwards += 1;
        if (wheel.speed[k] > 0.1 * fastest) forward += wheel.current[k], forwards += 1;
    }
    if (backwards * step_s > 2 && forwards > 0 && back / backwards > 0.3 * forward / forwards && forward > 0) {
        tell("the motor drives in reverse as well", back / backwards);
        return;
    }
    if (wheel.voltage.empty()) return;
    const Fit as_is = fit(wheel.voltage, wheel.speed, wheel.current);
    std::vector<double> folded = wheel.current;
    double negative = 0, all = 0;
    for (std::size_t k = 0; k < folded.size(); ++k) {
        const bool is_negative = wheel.voltage[k] - std::max(0.0, as_is.a) * wheel.speed[k] < 0;
        folded[k] *= is_negative ? -1 : 1;
        if (std::isfinite(folded[k])) all += 1, negative += is_negative;
    }
    const Fit turned = fit(wheel.voltage, wheel.speed, folded);
    if (!as_is.good || !turned.good || negative < 0.05 * all) return;
    if (turned.a > 0 && turned.b > 0 && turned.rms * turned.rms < 0.25 * as_is.rms * as_is.rms)
        tell("the motor's voltage asks for negative currents too", turned.rms / as_is.rms);
}

// Without a voltage: I = c1*dw/dt + c2*sign(w), inertia and friction, both above 0.
void sign_without_voltage(const Wheel &wheel, Findings &findings) {
    if (!wheel.voltage.empty() || wheel.current.empty() || wheel.speed.empty() || wheel.unsigned_current) return;
    const std::string start = "wheel" + std::to_string(wheel.index) + ".";
    if (has_error(findings, start)) return;
    std::vector<double> turn = wheel.speed;
    for (double &v : turn) v = std::fabs(v);
    const double still = 0.05 * quantile(turn, 0.98);
    std::vector<double> way(wheel.speed.size(), not_known);
    for (std::size_t k = 0; k < way.size(); ++k)
        if (std::isfinite(wheel.speed[k])) way[k] = wheel.speed[k] > still ? 1 : wheel.speed[k] < -still ? -1 : 0;
    const Fit law = fit(wheel.current, slope(smooth(wheel.speed, 2), 2), way);
    if (!law.good || !(law.a < -4 * law.error_a) || !(law.b < -4 * law.error_b)) return;
    add_error(findings, "sign", start + "current_A",
              say("'%scurrent_A' is negative when the wheel drives forward and when it speeds up", start.c_str()),
              "turn the sign of current or speed round (map: sign = -1)", law.b);
}

bool is_constant(const std::vector<double> &x, double tolerance) {
    const double low = quantile(x, 0), high = quantile(x, 1);
    return !std::isfinite(low) || high - low <= tolerance * std::fmax(std::fabs(low), std::fabs(high));
}

// A wheel that turns at one and the same speed, to the last digit, while its motor's current comes and goes: its encoder says nothing.
// Where all wheels do so and nothing else sees the machine move (voltage, camera, radar, carriage), a coarse sensor in a steady drive looks
// the same.
void frozen_speed(const Wheel &wheel, const Grid &grid, Findings &findings) {
    if (wheel.speed.empty() || wheel.current.empty() || has_error(findings, wheel.speed_column)) return;
    const double value = quantile(wheel.speed, 0.5);
    const auto samples = std::count_if(wheel.speed.begin(), wheel.speed.end(), [](double w) { return std::isfinite(w); });
    const double spread = quantile(wheel.current, 0.95) - quantile(wheel.current, 0.05), largest = quantile(wheel.current, 0.99);
    if (static_cast<double>(samples) * step_s < 5 || value == 0 || !is_constant(wheel.speed, 1e-9) || !(spread > 0.3 * std::fabs(largest)))
        return;
    bool witness = !is_constant(grid.ground_speed, 0.3);
    for (const Wheel &other : grid.wheel) witness = witness || !is_constant(other.speed, 1e-9) || !is_constant(other.voltage, 0.3);
    findings.push_back(
        {"dead_sensor", witness ? Severity::error : Severity::warning, wheel.speed_column,
         say("'%s' stands at %.5g through the whole drive while the current varies over %.3g A%s", wheel.speed_column.c_str(), value,
             spread, witness ? "" : "; so do all wheels, and no other sensor tells whether that is true"),
         witness ? "check its wiring; or take the column out of the log"
                 : "check the wiring of the encoders; from such a drive neither friction over speed nor inertia can be learnt",
         value});
}

void negated_radar(const Grid &grid, Findings &findings) {
    if (grid.radar.empty() || has_error(findings, "radar")) return;
    if (!(quantile(grid.radar, 0.98) <= 0) || !(quantile(grid.radar, 0.02) < -0.02)) return;
    double forward = 0, turning = 0;
    for (const double w : grid.mean_speed) {
        if (!(std::fabs(w) > 0.5)) continue;
        turning += 1, forward += w > 0;
    }
    if (!(forward > 0.2 * turning) || turning < 40) return;
    add_error(findings, "sign", "radar.speed_m_s", "'radar.speed_m_s' is never positive, but the wheels drive forward",
              "turn its sign round (map: sign = -1)", quantile(grid.radar, 0.02));
}

} // namespace

void check_scales(const Grid &grid, const Machine &machine, Findings &findings) {
    wheels_of_model(grid, machine, findings);
    motor_scale(grid, machine, findings);
    odd_motor(grid, findings);
    stray_current(grid, machine, findings);
    odd_wheel(grid, machine, findings);
    radius_scale(grid, machine, findings);
    accel_scale(grid, machine, findings);
    for (const Wheel &wheel : grid.wheel) sign_without_voltage(wheel, findings), frozen_speed(wheel, grid, findings);
    negated_radar(grid, findings);
}

void check_magnitudes(const Grid &grid, Findings &findings) {
    for (const Wheel &wheel : grid.wheel) magnitude(wheel, findings);
}

} // namespace traction::check
