#include "effect_drawing.h"

#include "sim/physics/effects/acting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string_view>

namespace traction::report {

namespace {

using sim::ActsOn;

// ---- the curve
constexpr int points = 41;
constexpr double usual_speed_rad_s = 5, usual_v_m_s = 0.3, usual_slip = 0.2, knee_slip = 0.1; // assumed
constexpr double run_in_s = 1e9;                                                              // long after the start

struct Probe {
    const char *what, *over;
    double low, high; // of what it is over
    std::function<double(const sim::WheelEffects &, const sim::BodyEffects &, double)> value;
};

double friction_Nm(const sim::WheelEffects &e, double speed_rad_s, double load_Nm, double since_s) {
    const double side = speed_rad_s < 0 ? -1 : speed_rad_s > 0 ? 1 : 0;
    return sim::dry_friction_Nm(0, e, speed_rad_s, load_Nm, since_s) * side + sim::viscous_friction_Nm(0, e, speed_rad_s);
}

double resistance(const sim::WheelEffects &e, const sim::BodyEffects &b, double slip, double v_m_s) {
    double sum = 0;
    sim::each_resistance(e, b, slip, v_m_s, [&](double one) { sum += one; });
    return sum;
}

const std::vector<Probe> &probes() {
    using W = sim::WheelEffects;
    using B = sim::BodyEffects;
    static const std::vector<Probe> all = {
        {"friction [N m]", "wheel speed [rad/s]", -10, 10, [](const W &e, const B &, double x) { return friction_Nm(e, x, 0, run_in_s); }},
        {"friction [N m]", "tooth torque [N m]", 0, 1,
         [](const W &e, const B &, double x) { return friction_Nm(e, usual_speed_rad_s, x, run_in_s); }},
        {"friction [N m]", "time [s]", 0, 120, [](const W &e, const B &, double x) { return friction_Nm(e, usual_speed_rad_s, 0, x); }},
        {"torque [N m]", "wheel angle [rad]", 0, 6.3,
         [](const W &e, const B &, double x) { return sim::periodic_Nm(e, x, false) + sim::periodic_Nm(e, x, true); }},
        {"torque constant [1]", "heat of the winding [K]", 0, 60,
         [](const W &e, const B &, double x) { return sim::motor_constant(1, e, x) - sim::motor_constant(1, W{}, x); }},
        {"circuit [ohm]", "winding [ohm]", 0, 4, [](const W &e, const B &, double x) { return sim::circuit_ohm(x, e) - x; }},
        {"winding heats to [K]", "current [A]", 0, 1, [](const W &e, const B &, double x) { return sim::heating_gap_K(e, x, 3, 0); }},
        {"resistance/load [1]", "slip [1]", -0.8, 0.8, [](const W &e, const B &b, double x) { return resistance(e, b, x, usual_v_m_s); }},
        {"resistance/load [1]", "speed [m/s]", 0, 1, [](const W &e, const B &b, double x) { return resistance(e, b, usual_slip, x); }},
        {"resistance/load [1]", "way [m]", 0, 4, [](const W &, const B &b, double x) { return sim::resistance_here(b, x); }},
        {"grip [1]", "way [m]", 0, 4, [](const W &, const B &b, double x) { return sim::strength_here(1, b, x, x, 0) - 1; }},
        {"grip [1]", "in a track [0, 1]", 0, 1, [](const W &, const B &b, double x) { return sim::strength_here(1, b, -1e9, 0, x) - 1; }},
        {"grip [1]", "sliding [m/s]", 0, 1, [](const W &, const B &b, double x) { return sim::strength_sliding(1.0, b, x) - 1; }},
        {"grip [1]", "slip [1]", -0.8, 0.8,
         [](const W &, const B &b, double x) { return sim::strength_slipping(1.0, b, x, knee_slip) - 1; }},
        {"force [N]", "speed [m/s]", -1, 1,
         [](const W &, const B &b, double x) {
             return sim::dragged_N(b, x, x < 0 ? -1 : x > 0 ? 1 : 0);
         }},
    };
    return all;
}

// ---- the scene: the rover from its left side, front to the right; 120 wide, ground at 70
constexpr double ground = 70, rear = 26, front = 90, axle = 58, radius = 12;

std::string format(const char *pattern, std::initializer_list<double> values) { // each % becomes a number
    std::string out;
    auto value = values.begin();
    for (const char *c = pattern; *c != '\0'; ++c) {
        if (*c != '%') {
            out += *c;
            continue;
        }
        char text[24];
        std::snprintf(text, sizeof text, "%.1f", *value++);
        out += text;
    }
    return out;
}

std::string path(const char *kind, const char *pattern, std::initializer_list<double> values) {
    return std::string("<path class=\"") + kind + "\" d=\"" + format(pattern, values) + "\"/>";
}
std::string circle(const char *kind, double x, double y, double r) {
    return std::string("<circle class=\"") + kind + format("\" cx=\"%\" cy=\"%\" r=\"%\"/>", {x, y, r});
}
std::string box(const char *kind, double x, double y, double width, double height) {
    return std::string("<rect class=\"") + kind + format("\" x=\"%\" y=\"%\" width=\"%\" height=\"%\"/>", {x, y, width, height});
}

// From (x, y) by (dx, dy), with a head.
std::string arrow(double x, double y, double dx, double dy) {
    const double length = std::hypot(dx, dy), ux = dx / length, uy = dy / length, tx = x + dx, ty = y + dy;
    return path("force", "M%,%L%,%", {x, y, tx, ty}) +
           path("force", "M%,%L%,%L%,%",
                {tx - 5 * ux - 3.5 * uy, ty - 5 * uy + 3.5 * ux, tx, ty, tx - 5 * ux + 3.5 * uy, ty - 5 * uy - 3.5 * ux});
}

std::string rover() {
    return path("soil", "M2,%H118", {ground}) + box("body", rear - 6, 32, front - rear + 12, 16) + circle("body", rear, axle, radius) +
           circle("body", front, axle, radius) + circle("body", rear, axle, 2) + circle("body", front, axle, 2);
}

// Wheels on which it acts: one, and the other in dashes where it may be confined to one.
std::string marked_wheels(const sim::Effect &effect) {
    return circle("mark", front, axle, radius) + circle(effect.per_wheel ? "mark maybe" : "mark", rear, axle, radius);
}

std::string torque(double x) { // against the wheel's turning, which is clockwise as it drives to the right
    return path("force", "M%,%A9,9 0 1 0 %,%", {x + 6.4, axle + 6.4, x - 3, axle + 8.5}) +
           path("force", "M%,%L%,%L%,%", {x - 1.5, axle + 3.5, x - 3, axle + 8.5, x + 2.5, axle + 9.5});
}

std::string motor_circuit() { // battery, resistance, motor at the wheel
    return path("mark", "M30,44V36 M26,36H34 M28,33H32 M30,33V24H46", {}) + box("mark", 46, 20.5, 18, 7) +
           path("mark", "M64,24H%V%", {front, axle - 6}) + circle("mark", front, axle, 6) + path("mark", "M%,%H30V44", {front - 6, axle});
}

// A sensor by the first word of the row's name; one that is new stands on the body.
std::string sensor(std::string_view name) {
    const std::string_view word = name.substr(0, name.find('_'));
    if (word == "radar")
        return path("mark", "M%,34h9l-3,8h-6z", {front + 3}) +
               path("ray", "M%,42L%,% M%,42L%,%", {front + 8, front + 26, ground, front + 6, front + 15, ground});
    if (word == "encoder") {
        std::string teeth = circle("mark", front, axle, 7);
        for (int i = 0; i < 8; ++i) {
            const double a = i * 0.785398163;
            teeth += path("mark", "M%,%L%,%",
                          {front + 7 * std::cos(a), axle + 7 * std::sin(a), front + 10 * std::cos(a), axle + 10 * std::sin(a)});
        }
        return teeth;
    }
    if (word == "current")
        return path("mark", "M40,40H%V%", {front, axle - 6}) + circle("mark", front, axle, 6) + circle("mark", 62, 40, 6) +
               path("mark", "M59.5,42.5L62,37L64.5,42.5", {});
    if (word == "voltage") return box("mark", 26, 35, 22, 10) + path("mark", "M48,38h2v4h-2 M31,40h4 M40,40h4 M42,38v4", {});
    if (word == "camera") return box("mark", 50, 2, 16, 9) + path("ray", "M52,11L%,% M64,11L%,%", {rear, 31, front, 31});
    if (word == "gyro")
        return path("mark", "M50,41A9,4 0 1 1 66,41", {}) + path("mark", "M63,44.5L66,41L61,39.5", {}) + circle("mark", 58, 40, 1.5);
    return box("mark", 51, 35, 14, 10) + arrow(58, 40, 18, 0);
}

std::string acting(const sim::Effect &effect) {
    switch (effect.acts_on) {
    case ActsOn::wheel_torque:
        return marked_wheels(effect) + torque(front) + (effect.per_wheel ? "" : torque(rear));
    case ActsOn::wheel_force:
        return marked_wheels(effect) + arrow(front + 8, ground + 4, -24, 0) + (effect.per_wheel ? "" : arrow(rear + 8, ground + 4, -24, 0));
    case ActsOn::body_force:
        return box("mark", rear - 6, 32, front - rear + 12, 16) + arrow(58, 40, -30, 0);
    case ActsOn::motor_voltage:
        return motor_circuit();
    case ActsOn::kinematics:
        return marked_wheels(effect) + arrow(front, axle, 8.5, -8.5);
    case ActsOn::load:
        return circle("mark", 58, 24, 4) + arrow(rear, 8, 0, 20) + arrow(front, 16, 0, 12);
    case ActsOn::sensor:
        return sensor(effect.name);
    }
    return "";
}

const char *acting_words(const sim::Effect &effect) {
    switch (effect.acts_on) {
    case ActsOn::wheel_torque:
        return "a torque about the wheel's axle, against its turning";
    case ActsOn::wheel_force:
        return "a force between wheel and soil";
    case ActsOn::body_force:
        return "a force on the body";
    case ActsOn::motor_voltage:
        return "in the motor's circuit, from the battery to the winding";
    case ActsOn::kinematics:
        return "the size of the wheel, between its turning and its way";
    case ActsOn::load:
        return "how the weight stands on the wheels";
    case ActsOn::sensor:
        return "what a sensor tells";
    }
    return "";
}

std::string curve_number(double value) {
    char text[24];
    std::snprintf(text, sizeof text, "%.2g", value);
    return text;
}

// Between (132, 8) and (214, 60).
std::string plotted(const EffectCurve &curve) {
    constexpr double left = 134, right = 214, top = 8, bottom = 58;
    const auto [low_at, high_at] = std::minmax_element(curve.y.begin(), curve.y.end());
    const double low = std::min(0.0, *low_at), high = std::max(0.0, *high_at), span = high - low;
    const double begin = curve.x.front(), wide = curve.x.back() - begin;
    const auto px = [&](double x) { return left + (x - begin) / wide * (right - left); };
    const auto py = [&](double y) { return bottom - (y - low) / span * (bottom - top); };
    std::string line;
    for (std::size_t i = 0; i < curve.x.size(); ++i) line += format(i == 0 ? "M%,%" : "L%,%", {px(curve.x[i]), py(curve.y[i])});
    std::string out = path("axis", "M%,%H% M%,%V%", {left, py(0), right, px(std::max(begin, std::min(0.0, curve.x.back()))), top, bottom});
    out += "<path class=\"curve\" d=\"" + line + "\"/>";
    const auto words = [&](double x, double y, const char *anchor, const std::string &text) {
        return format("<text x=\"%\" y=\"%\" text-anchor=\"", {x, y}) + anchor + "\">" + text + "</text>";
    };
    return out + words((left + right) / 2, 68, "middle", curve.over) +
           words((left + right) / 2, 78, "middle",
                 curve.what + " to " + curve_number(*high_at >= -*low_at * (1 - 1e-9) ? *high_at : *low_at));
}

constexpr const char *own_colours = "<style>svg{color:#1a1d21}.force{stroke:#c44e00}.mark,.curve{stroke:#0067a3}.soil{stroke:#8a5a00}.body,"
                                    ".axis,.ray{stroke:#59626d}text{fill:#59626d}"
                                    "path,circle,rect{fill:none;stroke-width:1.4}.force,.mark,.curve{stroke-width:2}.maybe,.ray{stroke-"
                                    "dasharray:3 2}text{font:6.3px sans-serif}"
                                    "@media(prefers-color-scheme:dark){.force{stroke:#ff9d5c}.mark,.curve{stroke:#6cbcf0}.soil{stroke:#"
                                    "e6b450}.body,.axis,.ray{stroke:#a3adb8}text{fill:#a3adb8}}</style>";

void collect(const nlohmann::json &value, nlohmann::json &found) {
    if (value.is_array() && !value.empty() && value.front().is_primitive()) return; // numbers, by the thousand
    for (const auto &[key, one] : value.items()) {
        if (one.is_structured()) {
            collect(one, found);
        } else if (one.is_string() && (key == "effect" || key == "name")) {
            const auto name = one.get<std::string>();
            if (const sim::Effect *effect = sim::find_effect(name); effect != nullptr && !found.contains(name))
                found[name] = effect_svg(*effect, false);
        }
    }
}

} // namespace

std::optional<EffectCurve> curve_of(const sim::Effect &effect) {
    sim::ActiveEffect active{.effect = &effect, .wheel = -1, .values = {}};
    for (const sim::EffectParameter &p : effect.parameters) active.values.push_back(p.typical);
    const sim::RoverEffects acts = sim::act_together({&active, 1});
    std::optional<EffectCurve> best;
    double most = 0;
    for (const Probe &probe : probes()) {
        EffectCurve curve{.what = probe.what, .over = probe.over, .x = {}, .y = {}};
        for (int i = 0; i < points; ++i) {
            curve.x.push_back(probe.low + (probe.high - probe.low) * i / (points - 1));
            curve.y.push_back(probe.value(acts.wheel[0], acts.body, curve.x.back()));
        }
        const auto [low, high] = std::minmax_element(curve.y.begin(), curve.y.end());
        const double size = std::max(std::fabs(*low), std::fabs(*high));
        if (!(size > 1e-9)) continue;                      // what has faded away adds nothing
        const double bends = (*high - *low) / size + 1e-6; // how far it follows, over what it adds; a constant is better than nothing
        if (bends > most + 1e-9) best = std::move(curve), most = bends;
    }
    return best;
}

std::string drawing_words(const sim::Effect &effect) {
    std::string words = std::string(effect.name) + " acts: " + acting_words(effect) + (effect.per_wheel ? ", on all wheels or one" : "");
    if (const std::optional<EffectCurve> curve = curve_of(effect))
        words += ". Curve: " + curve->what + " that it adds, over " + curve->over;
    return words;
}

std::string effect_svg(const sim::Effect &effect, bool alone) {
    const std::string words = drawing_words(effect);
    std::string out =
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"effect\" viewBox=\"0 0 220 84\" role=\"img\" aria-label=\"" + words + "\">";
    if (alone) out += "<title>" + words + "</title>" + own_colours;
    out += rover() + acting(effect);
    if (const std::optional<EffectCurve> curve = curve_of(effect)) out += plotted(*curve);
    return out + "</svg>";
}

nlohmann::json drawings_of(const nlohmann::json &result) {
    nlohmann::json found = nlohmann::json::object();
    if (result.is_structured()) collect(result, found);
    return found;
}

} // namespace traction::report
