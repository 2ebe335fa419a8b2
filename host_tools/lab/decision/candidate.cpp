#include "candidate.h"

#include "host_tools/lab/forward/forward.h"
#include "host_tools/lab/inputs/dataset.h"
#include "host_tools/lab/inputs/smooth.h"
#include "knots.h"

#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

namespace traction::lab {

namespace {

std::vector<int> wheel_choices(const sim::Effect &effect, const Model &model) {
    std::vector<int> wheels = {-1};
    if (effect.per_wheel && model.wheel.size() > 1)
        for (std::size_t i = 0; i < model.wheel.size(); ++i)
            if (!sim::of_motor(effect) || model.wheel[i].drive < 0) wheels.push_back(static_cast<int>(i));
    return wheels;
}

// Windows along the path that the log covers: starts every half length. Beyond the last of the lengths, others, each longer by as much as
// the last one is than the one before, as long as the way is.
std::vector<std::vector<std::pair<std::string, double>>> patch_choices(const Motion &motion, std::vector<double> lengths) {
    std::vector<std::vector<std::pair<std::string, double>>> list;
    if (motion.path_m.empty()) return {};
    const auto [low, high] = std::minmax_element(motion.path_m.begin(), motion.path_m.end());
    const double span = *high - *low;
    if (!(span > 0.3)) return {};
    for (const double ratio = lengths.back() / lengths[lengths.size() - 2]; lengths.back() * ratio <= 0.6 * span;)
        lengths.push_back(lengths.back() * ratio);
    for (const double length : lengths) {
        if (length > 0.6 * span) continue;
        const double step = std::max(length / 2, span / 24);
        for (double start = *low; start + 0.5 * length < *high; start += step)
            list.push_back({{"start_m", std::round(start * 100) / 100}, {"length_m", length}});
    }
    return list;
}

// How much larger than the rover of table I (docs/sources.md), whose sizes the catalogue's ranges are, a machine is: plausible and
// interesting sizes go with it. Within a third it is that rover.
class MachineScale {
  public:
    MachineScale(const Model &model, const Physics &physics, const Dataset &data) {
        double KG = 0, Ra = 0, n = 0, arm = 0, radius = 0;
        for (const WheelPhysics &w : physics.wheel)
            KG += w.KG, Ra += w.Ra, radius += w.radius, arm = std::max(arm, std::hypot(w.x, w.y)), ++n;
        KG /= n, Ra /= n, radius /= n;
        double volt = data.supply_V.empty() ? 0 : median(data.supply_V);
        if (!(volt > 0)) volt = physics.body.battery_V;
        const double weight = physics.body.mass * physics.body.gravity;
        if (KG > 0 && Ra > 0 && volt > 0 && model.motion != BodyMotion::imposed) {
            by_unit_["N m"] = KG * volt / Ra / (0.265 * 7.2 / 3.24);
            by_unit_["N m s"] = KG * KG / Ra / (0.265 * 0.265 / 3.24);
            by_unit_["A"] = volt / Ra / (7.2 / 3.24);
            by_unit_["K/W"] = 7.2 * 7.2 / 3.24 / (volt * volt / Ra); // as warm by its own stall power
            const double slower = 7.2 / 0.265 * 0.057 / (volt / KG * radius);
            by_unit_["s/m"] = slower;
            by_unit_["s^2/m^2"] = slower * slower;
            by_unit_["rad/s"] = volt / KG / (7.2 / 0.265);
            by_unit_["s/rad"] = 7.2 / 0.265 / (volt / KG);
            by_unit_["N m s^2"] = KG * KG * KG / Ra / volt / (0.265 * 0.265 * 0.265 / 3.24 / 7.2);
            if (weight > 0) by_unit_["N s^2/m^2"] = weight / (2.88 * 9.81) * slower * slower;
            // a strong motor on a light machine: what matters is what the machine's weight asks of it
            const double load = weight * radius / (2.88 * 9.81 * 0.057), faster = by_unit_["rad/s"];
            if (load > 0) of_interest_ = {{"N m", load}, {"N m s", load / faster}, {"N m s^2", load / (faster * faster)}};
        }
        if (Ra > 0) by_unit_["ohm"] = Ra / 3.24;
        if (volt > 0) by_unit_["V"] = volt / 7.2;
        if (weight > 0) by_unit_["N"] = by_unit_["N/m"] = weight / (2.88 * 9.81);
        if (weight > 0 && arm > 0) by_unit_["m"] = arm / std::hypot(0.083, 0.12);
    }
    void apply(sim::EffectParameter &p) const {
        const auto found = by_unit_.find(std::string(p.unit));
        if (found == by_unit_.end() || (found->second > 0.67 && found->second < 1.5)) return;
        const double factor = std::clamp(found->second, 0.01, 1000.0);
        for (double *x : {&p.minimum, &p.maximum}) *x *= factor;
        for (double &x : p.variants) x *= factor;
        const auto asked = of_interest_.find(std::string(p.unit));
        p.of_interest *= asked == of_interest_.end() ? factor : std::clamp(asked->second, 0.01, factor);
    }

  private:
    std::map<std::string, double> by_unit_, of_interest_; // the latter: where it is less than by the motor
};

// Combinations of the shape parameters' variants, those of a speed in the machine's own.
std::vector<std::vector<std::pair<std::string, double>>> shape_choices(const sim::Effect &effect, const MachineScale &scale) {
    std::vector<std::vector<std::pair<std::string, double>>> list = {{}};
    for (sim::EffectParameter p : effect.parameters) {
        if (p.strength || p.variants.empty()) continue;
        if (p.unit == "rad/s") scale.apply(p);
        std::vector<std::vector<std::pair<std::string, double>>> next;
        for (const auto &base : list)
            for (const double sign : {1.0, -1.0})
                for (const double value : p.variants) {
                    if (sign < 0 && !p.both_signs) continue;
                    next.push_back(base);
                    next.back().emplace_back(std::string(p.name), sign * value);
                }
        list = std::move(next);
    }
    return list;
}

// The most turns that a wheel makes.
double turns_of(const Dataset &data) {
    double turns = 0;
    for (const WheelInput &w : data.wheel) {
        const auto [low, high] = std::minmax_element(w.angle_rad.begin(), w.angle_rad.end());
        if (low != high) turns = std::max(turns, (*high - *low) / (2 * std::numbers::pi));
    }
    return turns;
}

// A ripple needs turns to show, what lags changes that come late.
bool can_show(const std::string &effect, const std::vector<std::pair<std::string, double>> &shape, const Dataset &data) {
    if (data.count < 3) return true; // no log: a drive is planned
    if (effect == "torque_ripple") {
        const double order = shape.empty() ? 1 : std::fabs(shape[0].second);
        return turns_of(data) > std::max(1.0, 3 / order);
    }
    if (!effect.ends_with("_delay") && effect != "accel_lag" && effect != "relaxation_length") return true;
    std::size_t most = 0;
    for (const WheelInput &w : data.wheel) { // changes of the wheel's speed by a tenth of its largest within a fifth of a second
        double largest = 0;
        for (const double speed : w.speed_rad_s) largest = std::max(largest, std::fabs(speed));
        const auto lag = std::max<std::size_t>(1, static_cast<std::size_t>(0.2 / data.step_s));
        std::size_t changes = 0;
        for (std::size_t k = lag; k < w.speed_rad_s.size(); k += lag)
            changes += std::fabs(w.speed_rad_s[k] - w.speed_rad_s[k - lag]) > 0.1 * largest;
        most = std::max(most, changes);
    }
    return most >= 4;
}

// Nothing else than its parameter: a radius or a motor beyond such a range is another machine.
bool is_change_of_sheet(const std::string &effect) { return effect == "wheel_radius" || effect == "torque_constant"; }

FreeParameter strength_parameter(const Candidate &candidate, const EffectHandle &handle, const EffectHandle::Strength &place,
                                 const sim::EffectParameter &spec, const Physics &physics) {
    FreeParameter free;
    free.owner = candidate.effect;
    free.key = place.key;
    free.unit = spec.unit;
    free.wheel = candidate.wheel;
    free.touched = handle.touched;
    const double span = spec.maximum - spec.minimum;
    const double slack = candidate.bounded ? 0 : 0.5 * span;
    free.minimum = spec.minimum < 0 ? spec.minimum - slack : 0;
    free.maximum = spec.maximum + slack;
    if (place.in_body != nullptr) {
        Slot slot;
        slot.in_body = place.in_body;
        free.slots.push_back(slot);
    } else {
        for (std::size_t i = 0; i < physics.wheel.size(); ++i) {
            if (!handle.acts_at(physics, candidate.wheel, i)) continue;
            Slot slot;
            slot.in_wheel = place.in_wheel;
            slot.wheel = static_cast<int>(i);
            free.slots.push_back(slot);
        }
    }
    free.step = handle.remembers ? std::max(1e-3 * span, 0.2 * spec.of_interest) : 1e-7 * span;
    return free;
}

struct ShapeKind {
    TermTarget target;
    Axis axis;
    const char *name;
    bool straight = false; // a straight line too: a free curve spends its certainty on its coefficients
};
// docs/evidence.md section 4. Never measured current or PWM as an axis; "current" is the model's own.
constexpr ShapeKind shape_kinds[] = {
    {TermTarget::wheel_torque, Axis::wheel_speed, "torque(wheel speed)"},
    {TermTarget::wheel_torque, Axis::slip, "torque(slip)"},
    {TermTarget::wheel_friction, Axis::load, "friction(wheel load)"},
    {TermTarget::wheel_friction, Axis::time, "friction(time)", true},
    {TermTarget::wheel_friction, Axis::direction, "friction(direction of travel)"},
    {TermTarget::wheel_torque, Axis::accel, "torque(acceleration)"},
    {TermTarget::rolling, Axis::speed, "resistance(ground speed)"},
    {TermTarget::rolling, Axis::abs_speed, "resistance(speed)", true},
    {TermTarget::rolling, Axis::slip, "resistance(slip)"},
    {TermTarget::rolling, Axis::time, "resistance(time)", true},
    {TermTarget::rolling, Axis::path, "resistance(path)"},
    {TermTarget::voltage, Axis::current, "voltage(motor current)"},
    {TermTarget::voltage, Axis::wheel_speed, "voltage(wheel speed)"},
    {TermTarget::voltage, Axis::time, "voltage(time)"},
    {TermTarget::soil_strength, Axis::time, "soil strength(time)", true},
    {TermTarget::soil_strength, Axis::path, "soil strength(path)"},
    {TermTarget::soil_strength, Axis::abs_speed, "soil strength(speed)", true},
    {TermTarget::soil_strength, Axis::slip, "soil strength(slip)"},
    {TermTarget::motor_constant, Axis::time, "motor constant(time)", true},
    {TermTarget::motor_constant, Axis::current, "motor constant(motor current)"},
    {TermTarget::resistance, Axis::time, "winding resistance(time)"},
    {TermTarget::accel, Axis::time, "accelerometer(time)"},
    {TermTarget::accel, Axis::accel, "accelerometer(acceleration)"},
    {TermTarget::radar, Axis::abs_speed, "radar(speed)"},
    {TermTarget::rolling, Axis::yaw_rate, "resistance(yaw rate)"},
    {TermTarget::wheel_friction, Axis::yaw_rate, "friction(yaw rate)"},
    {TermTarget::wheel_torque, Axis::reversal, "torque(wheel angle since reversal)"},
    {TermTarget::voltage, Axis::other_current, "voltage(current of the other motors)"},
    {TermTarget::voltage, Axis::axle_current, "voltage(current of the motors of its axle)"},
    {TermTarget::voltage, Axis::side_current, "voltage(current of the motors of its side)"},
    {TermTarget::wheel_torque, Axis::current, "torque(motor current)"},
    {TermTarget::wheel_friction, Axis::abs_wheel_speed, "friction(wheel speed)"},
    {TermTarget::voltage, Axis::voltage, "voltage(motor voltage)"},
    {TermTarget::wheel_friction, Axis::turn, "friction(wheel angle)"},
    {TermTarget::wheel_torque, Axis::turn, "torque(wheel angle)"},
};

// Waves of the ground's strength along the path, at each wheel's place or the body's: half a cycle over the path apart.
std::vector<Candidate> wave_candidates(const Motion &motion) {
    std::vector<Candidate> list;
    const auto [low, high] = std::minmax_element(motion.path_m.begin(), motion.path_m.end());
    if (motion.path_m.empty() || !(*high - *low > 1)) return list;
    const double step = std::max(0.65 / (*high - *low), 0.08); // [1/m]
    for (double cycles = 0.8; cycles < 3.4; cycles += step)
        for (const Axis axis : {Axis::path, Axis::place}) {
            Candidate c;
            char name[80];
            std::snprintf(name, sizeof name, "soil strength(path), a wave of %.2f m", 1 / cycles);
            c.effect = name;
            c.free_shape = true;
            c.axis = axis;
            c.target = TermTarget::soil_strength;
            c.touched = target_stages(c.target);
            c.order = 2 * std::numbers::pi * cycles;
            c.strengths.resize(2);
            list.push_back(std::move(c));
        }
    return list;
}

} // namespace

std::string Candidate::label() const { return wheel < 0 ? effect : effect + " on wheel " + std::to_string(wheel); }

void Candidate::prepare(Physics &physics) const {
    if (free_shape) {
        ExtraTerm term;
        term.name = effect;
        term.target = target;
        term.term = order > 0 ? make_periodic(axis, order) : make_piecewise(axis, knots);
        term.coefficients.assign(order > 0 ? strengths.size() : knots.size(), 0); // a bump has one strength, in the middle of three
        for (const int i : on.empty() ? std::vector<int>{wheel} : on) {
            term.wheel = i;
            physics.terms.push_back(term);
        }
        return;
    }
    const EffectHandle *handle = find_handle(effect);
    if (handle == nullptr) return;
    for (const auto &[key, value] : variant)
        for (const auto &place : handle->shapes) {
            if (place.key != key) continue;
            if (place.in_body != nullptr)
                physics.body.*place.in_body = value;
            else
                for (std::size_t i = 0; i < physics.wheel.size(); ++i)
                    if (wheel < 0 || static_cast<std::size_t>(wheel) == i) physics.wheel[i].*place.in_wheel = value;
        }
}

std::vector<Candidate> catalogue_candidates(const Model &model, const Dataset &data, const Motion &motion) {
    const Physics physics = make_physics(model);
    const MachineScale scale(model, physics, data);
    std::vector<Candidate> list;
    for (const EffectHandle &handle : effect_handles()) {
        const sim::Effect *effect = sim::find_effect(handle.name);
        if (effect == nullptr || model.find_effect(handle.name, -1) != nullptr) continue;
        auto shapes = handle.name == "soil_patch"         ? patch_choices(motion, {0.25, 0.5, 1.0, 1.5, 2.5})
                      : handle.name == "resistance_patch" ? patch_choices(motion, {0.5, 1.0, 2.0})
                                                          : shape_choices(*effect, scale);
        const auto wheels = wheel_choices(*effect, model);
        for (const auto &shape : shapes)
            for (const int wheel : wheels) {
                if (!can_show(handle.name, shape, data)) continue;
                if (model.find_effect(handle.name, wheel) != nullptr) continue;
                // on one wheel already: another wheel may join, all wheels would be a second copy
                const bool elsewhere =
                    std::any_of(model.effects.begin(), model.effects.end(), [&](const EffectUse &use) { return use.name == handle.name; });
                if (wheel < 0 && elsewhere) continue;
                Candidate c;
                c.effect = handle.name;
                c.wheel = wheel;
                c.variant = shape;
                c.variants = static_cast<int>(shapes.size() * wheels.size());
                c.touched = handle.touched;
                c.bounded = is_change_of_sheet(handle.name);
                for (const auto &place : handle.strengths) {
                    const auto found = std::find_if(effect->parameters.begin(), effect->parameters.end(),
                                                    [&](const sim::EffectParameter &p) { return p.name == place.key; });
                    if (found == effect->parameters.end()) continue;
                    sim::EffectParameter spec = *found;
                    scale.apply(spec);
                    c.strengths.push_back(strength_parameter(c, handle, place, spec, physics));
                    c.of_interest.push_back(spec.of_interest);
                    c.minimum.push_back(spec.minimum);
                    c.maximum.push_back(spec.maximum);
                    // of what remembers nothing at zero tells
                    c.step.push_back(handle.remembers ? std::max(spec.of_interest, 0.05 * spec.maximum) : 1e-6 * spec.of_interest);
                }
                if (!c.strengths.empty()) list.push_back(std::move(c));
            }
    }
    return list;
}

std::vector<Candidate> shape_candidates(const Dataset &data, const Motion &motion, const Physics &physics,
                                        const std::vector<std::vector<double>> &current_A) {
    std::vector<Candidate> list;
    for (const ShapeKind &kind : shape_kinds) {
        if (kind.axis == Axis::turn && !(turns_of(data) > 3)) continue;
        Candidate c;
        c.effect = kind.name;
        c.free_shape = true;
        c.axis = kind.axis;
        c.target = kind.target;
        c.touched = target_stages(kind.target);
        const AxisValues x = values_on(kind.axis, data, motion, physics, current_A, acts_on_motor(kind.target));
        if (x.values.empty()) continue;
        c.varies_between_wheels = x.varies_between_wheels;
        c.knots = knots_on(kind.axis, x.values, kind.target == TermTarget::wheel_torque);
        if (c.knots.size() < 3) continue;
        for (std::size_t j = 0; j < c.knots.size(); ++j) c.strengths.emplace_back();
        list.push_back(c);
        if (!kind.straight) continue;
        c.effect += ", a straight line";
        c.knots = {c.knots.front(), c.knots.back()};
        c.strengths.resize(2);
        list.push_back(std::move(c));
    }
    for (const int order : {5, 7, 9, 10, 12}) { // the others are torque_ripple
        Candidate c;
        c.effect = "torque(wheel angle), " + std::to_string(order) + " per turn";
        c.free_shape = true;
        c.axis = Axis::angle;
        c.target = TermTarget::wheel_torque;
        c.touched = stage_torque;
        c.order = order;
        c.strengths.resize(2);
        list.push_back(std::move(c));
    }
    for (Candidate &c : wave_candidates(motion)) list.push_back(std::move(c));
    for (Candidate &c : list)
        for (std::size_t j = 0; j < c.strengths.size(); ++j) {
            FreeParameter &free = c.strengths[j];
            free.owner = c.effect;
            free.key = "f" + std::to_string(j);
            free.touched = c.touched;
            Slot slot;
            slot.term = Slot::last_term; // resolved when the candidate is prepared
            slot.coefficient = static_cast<int>(j);
            free.slots = {slot};
            free.minimum = -1e9;
            free.maximum = 1e9;
            const bool multiplier = c.target == TermTarget::soil_strength || c.target == TermTarget::motor_constant ||
                                    c.target == TermTarget::resistance || c.target == TermTarget::radar;
            free.step = multiplier || c.target == TermTarget::rolling ? 2e-6 : 5e-7;
            c.step.push_back(free.step);
        }
    return list;
}

EffectUse effect_of(const Candidate &candidate, const std::vector<double> &strengths) {
    EffectUse use;
    use.name = candidate.effect;
    use.wheel = candidate.wheel;
    const sim::Effect *effect = sim::find_effect(candidate.effect);
    for (std::size_t i = 0; i < candidate.strengths.size(); ++i) {
        Parameter p;
        p.value = strengths[i];
        p.unit = candidate.strengths[i].unit;
        p.minimum = candidate.strengths[i].minimum;
        p.maximum = candidate.strengths[i].maximum;
        p.given = true;
        use.parameters[candidate.strengths[i].key] = p;
    }
    for (const auto &[key, value] : candidate.variant) {
        Parameter p;
        p.value = value;
        p.fixed = true;
        p.given = true;
        if (effect != nullptr)
            for (const sim::EffectParameter &spec : effect->parameters)
                if (spec.name == key) p.unit = spec.unit;
        use.parameters[key] = p;
    }
    return use;
}

std::string shape_expression(const Candidate &c, const std::vector<double> &y) {
    static const char *names[] = {"t",      "w", "v", "s", "Fn", "theta", "x",  "a",      "I", "v/sqrt(v*v+1e-4)",
                                  "abs(v)", "r", "X", "d", "Io", "Ia",    "Is", "abs(w)", "u", "atan2(sin(theta),cos(theta))"};
    const std::string x = names[static_cast<int>(c.axis)];
    char buffer[160];
    if (c.order > 0) {
        std::snprintf(buffer, sizeof buffer, "%.4g*cos(%g*%s) + %.4g*sin(%g*%s)", y[0], c.order, x.c_str(), y[1], c.order, x.c_str());
        return buffer;
    }
    std::snprintf(buffer, sizeof buffer, "%.4g", y[0]);
    std::string text = buffer;
    for (std::size_t i = 1; i < c.knots.size(); ++i) { // a ramp per piece
        const double width = c.knots[i] - c.knots[i - 1];
        std::snprintf(buffer, sizeof buffer, " + (%.4g)*min(1, max(0, (%s - (%.4g))/%.4g))", y[i] - y[i - 1], x.c_str(), c.knots[i - 1],
                      width);
        text += buffer;
    }
    return text;
}

} // namespace traction::lab
