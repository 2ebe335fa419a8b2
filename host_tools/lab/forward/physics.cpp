#include "physics.h"

#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace traction::lab {

namespace {

using W = WheelPhysics;
using B = BodyPhysics;

// Parameter keys that become slots, with the stages they touch. A key in several tables stands once per table.
struct Key {
    const char *table;
    const char *key;
    double W::*in_wheel;
    double B::*in_body;
    unsigned touched;
};
constexpr Key keys[] = {
    {"wheel", "radius_m", &W::radius, nullptr, stage_motion | stage_torque},
    {"motor", "torque_constant_Nm_A", &W::KG, nullptr, stage_torque | stage_voltage},
    {"motor", "back_emf_Vs_rad", &W::ke, nullptr, stage_voltage},
    {"motor", "resistance_ohm", &W::Ra, nullptr, stage_voltage},
    {"motor", "inertia_kg_m2", &W::J, nullptr, stage_torque},
    {"motor", "viscous_Nms", &W::b, nullptr, stage_torque},
    {"motor", "coulomb_Nm", &W::t0, nullptr, stage_torque},
    {"motor", "current_offset_A", &W::current_offset0, nullptr, stage_torque | stage_voltage},
    {"soil", "mu", &W::mu, nullptr, stage_motion},
    {"soil", "adhesion_N", &W::adhesion, nullptr, stage_motion},
    {"soil", "shear_slip", &W::sc, nullptr, stage_motion},
    {"soil", "shear_curve", &W::curve, nullptr, stage_motion},
    {"soil", "rolling_coefficient", &W::crr, nullptr, stage_motion},
    {"soil", "lateral_coefficient", &W::lateral, nullptr, stage_motion},
    {"soil", "lateral_grip", &W::grip, nullptr, stage_motion},
    {"soil", "relaxation_length_m", &W::relaxation, nullptr, stage_motion},
    {"soil", "reversal_speed_m_s", &W::reversal, nullptr, stage_motion},
    {"rover", "mass_kg", nullptr, &B::mass, stage_motion},
    {"rover", "yaw_inertia_kg_m2", nullptr, &B::yaw_inertia, stage_motion},
    {"rover", "centre_height_m", nullptr, &B::centre_height, stage_motion},
    {"rover", "track_scale", nullptr, &B::track_scale, stage_motion},
    {"sensors", "duty.delay_s", nullptr, &B::voltage_delay0, stage_voltage},
    {"sensors", "current.delay_s", nullptr, &B::current_delay, stage_torque | stage_voltage},
    {"sensors", "accel.bias_m_s2", nullptr, &B::accel_bias0, stage_sensors},
    {"sensors", "accel.delay_s", nullptr, &B::accel_delay0, stage_sensors},
    {"sensors", "accel.lag_s", nullptr, &B::accel_lag0, stage_sensors},
    {"sensors", "accel.ahead_m", nullptr, &B::accel_ahead0, stage_sensors},
    {"sensors", "accel.left_m", nullptr, &B::accel_left0, stage_sensors},
    {"sensors", "gyro.bias_rad_s", nullptr, &B::gyro_bias, stage_sensors},
    {"sensors", "gyro.scale", nullptr, &B::gyro_scale0, stage_sensors},
    {"sensors", "radar.scale", nullptr, &B::radar_scale0, stage_sensors},
    {"sensors", "radar.delay_s", nullptr, &B::radar_delay, stage_sensors},
    {"sensors", "radar.lead", nullptr, &B::radar_lead, stage_sensors},
    {"sensors", "camera.scale", nullptr, &B::camera_scale0, stage_sensors},
    {"sensors", "camera.delay_s", nullptr, &B::camera_delay0, stage_sensors},
};

// What a run may have of its own.
struct RunKey {
    const char *table;
    const char *key;
    double RunPhysics::*in_run;
};
constexpr RunKey run_keys[] = {
    {"soil", "mu", &RunPhysics::mu},
    {"soil", "adhesion_N", &RunPhysics::adhesion},
    {"soil", "shear_slip", &RunPhysics::sc},
    {"soil", "rolling_coefficient", &RunPhysics::crr},
    {"soil", "lateral_coefficient", &RunPhysics::lateral},
    {"sensors", "accel.bias_m_s2", &RunPhysics::accel_bias},
    {"sensors", "gyro.bias_rad_s", &RunPhysics::gyro_bias},
};

const Parameters &own_table(const RunSpec &run, const RunKey &key) {
    return std::string_view(key.table) == "soil" ? run.soil : run.sensors;
}

// The runs of the data set at hand, by their start: indices of Model::runs.
std::vector<std::size_t> begun(const Model &model) {
    std::vector<std::size_t> list;
    for (std::size_t i = 0; i < model.runs.size(); ++i)
        if (!std::isnan(model.runs[i].start_s)) list.push_back(i);
    std::stable_sort(list.begin(), list.end(), [&](std::size_t a, std::size_t b) { return model.runs[a].start_s < model.runs[b].start_s; });
    return list;
}

const Parameters &table_of(const WheelSpec &wheel, std::string_view table) {
    return table == "wheel" ? wheel.geometry : table == "motor" ? wheel.motor : wheel.soil;
}

double value_of(const Parameters &parameters, const std::string &key) {
    const auto found = parameters.find(key);
    return found == parameters.end() ? 0.0 : found->second.value;
}

Slot wheel_slot(double W::*member, int wheel) {
    Slot slot;
    slot.in_wheel = member;
    slot.wheel = wheel;
    return slot;
}

Slot body_slot(double B::*member) {
    Slot slot;
    slot.in_body = member;
    return slot;
}

std::vector<EffectHandle> make_handles() {
    std::vector<EffectHandle> handles;
    for (const sim::Effect &effect : sim::catalogue()) {
        EffectHandle handle;
        handle.name = effect.name;
        handle.touched = effect.needs & stage_all;
        handle.remembers = (effect.needs & sim::needs_memory) != 0;
        handle.of_motor = sim::of_motor(effect);
        for (const sim::EffectParameter &p : effect.parameters)
            (p.strength ? handle.strengths : handle.shapes).push_back({std::string(p.name), p.in_wheel, p.in_body});
        handles.push_back(std::move(handle));
    }
    return handles;
}

// As a scenario switches it on: strengths of one kind add up.
void set_effect(Physics &physics, const EffectHandle &handle, const EffectHandle::Strength &place, int wheel, double value, bool shape) {
    const auto put = [&](double &number) { number = shape ? value : number + value; };
    if (place.in_body != nullptr) {
        put(physics.body.*place.in_body);
        return;
    }
    for (std::size_t i = 0; i < physics.wheel.size(); ++i)
        if (handle.acts_at(physics, wheel, i)) put(physics.wheel[i].*place.in_wheel);
}

void add_user_effect(Physics &physics, const Model &model, const EffectUse &use) {
    ExtraTerm term;
    term.name = use.name;
    term.wheel = use.wheel;
    if (!parse_target(use.acts_on, term.target))
        throw ModelError(
            model.file, 0, "effect." + use.name + ".acts_on", "unknown place \"" + use.acts_on + "\"",
            "use wheel_torque, wheel_friction, wheel_force, rolling_resistance, body_force, voltage, soil_strength, shear_slip, "
            "motor_constant, resistance, sensor.accel, sensor.radar, sensor.camera or sensor.current");
    std::vector<std::string> names;
    for (const auto &[key, parameter] : use.parameters) {
        names.push_back(key);
        term.coefficients.push_back(parameter.value);
    }
    try {
        term.term = make_expression(use.expression, names);
    } catch (const std::runtime_error &error) {
        throw ModelError(model.file, 0, "effect." + use.name + ".expression", error.what(),
                         "use t w v s Fn theta x X a d I Io Ia Is u Ft V r, the effect's own parameters, and muparser's functions");
    }
    physics.terms.push_back(std::move(term));
}

std::vector<RunPhysics> runs_of(const Model &model) {
    std::vector<RunPhysics> list;
    for (const std::size_t i : begun(model)) {
        RunPhysics run;
        run.start_s = model.runs[i].start_s;
        for (const RunKey &key : run_keys)
            if (const auto found = own_table(model.runs[i], key).find(key.key); found != own_table(model.runs[i], key).end())
                run.*key.in_run = found->second.value;
        list.push_back(run);
    }
    return list;
}

} // namespace

bool RunPhysics::has_ground() const {
    return !(std::isnan(mu) && std::isnan(adhesion) && std::isnan(sc) && std::isnan(crr) && std::isnan(lateral));
}

const RunPhysics *run_at(const Physics &physics, double t_s) {
    const RunPhysics *found = physics.runs.empty() ? nullptr : &physics.runs.front();
    for (const RunPhysics &run : physics.runs)
        if (run.start_s <= t_s) found = &run;
    return found;
}

bool EffectHandle::acts_at(const Physics &physics, int wheel, std::size_t i) const {
    if (!of_motor) return wheel < 0 || static_cast<std::size_t>(wheel) == i;
    const std::size_t motor = motor_of(physics, i);
    return (wheel < 0 || static_cast<std::size_t>(wheel) == motor) && (motor == i || (touched & stage_motion) != 0);
}

double &Slot::of(Physics &physics) const {
    if (in_wheel != nullptr) return physics.wheel[static_cast<std::size_t>(wheel)].*in_wheel;
    if (in_body != nullptr) return physics.body.*in_body;
    if (in_run != nullptr) return physics.runs[run].*in_run;
    const std::size_t place =
        term <= last_term ? physics.terms.size() - static_cast<std::size_t>(last_term + 1 - term) : static_cast<std::size_t>(term);
    return physics.terms[place].coefficients[static_cast<std::size_t>(coefficient)];
}

void FreeParameter::add(Physics &physics, double increment) const {
    for (const Slot &slot : slots) slot.of(physics) += increment;
}

std::string name_of(const FreeParameter &p) {
    return p.owner + "." + p.key + (p.wheel >= 0 ? " on wheel " + std::to_string(p.wheel) : "") + (p.run >= 0 ? " in " + p.run_log : "");
}

bool is_same(const FreeParameter &a, const FreeParameter &b) {
    return a.owner == b.owner && a.key == b.key && a.wheel == b.wheel && a.run_log == b.run_log && a.own == b.own;
}

const std::vector<EffectHandle> &effect_handles() {
    static const std::vector<EffectHandle> handles = make_handles();
    return handles;
}

const EffectHandle *find_handle(const std::string &name) {
    for (const EffectHandle &handle : effect_handles())
        if (handle.name == name) return &handle;
    return nullptr;
}

Physics make_physics(const Model &model) {
    Physics physics;
    physics.soil_law = model.soil_law;
    physics.motion = model.motion;
    physics.unsigned_current = model.unsigned_current;
    physics.halves = model.halves;
    for (std::size_t i = 0; i < model.wheel.size(); ++i) {
        const WheelSpec &spec = model.wheel[i], &motors = model.wheel[model.motor_of(i)];
        WheelPhysics wheel;
        wheel.x = value_of(spec.geometry, "x_m");
        wheel.y = value_of(spec.geometry, "y_m");
        wheel.heading = value_of(spec.geometry, "heading_rad");
        wheel.load = value_of(spec.geometry, "load_N");
        for (const Key &key : keys)
            if (key.in_wheel != nullptr)
                wheel.*key.in_wheel = value_of(table_of(std::string_view(key.table) == "motor" ? motors : spec, key.table), key.key);
        if (!motors.motor.at("back_emf_Vs_rad").given) wheel.ke = wheel.KG;
        physics.wheel.push_back(wheel);
        physics.driven.push_back(spec.driven);
        if (model.couples()) physics.motor.push_back(model.motor_of(i));
        physics.grips_sideways.push_back(spec.grips_sideways);
    }
    for (const Key &key : keys)
        if (key.in_body != nullptr)
            physics.body.*key.in_body = value_of(std::string(key.table) == "rover" ? model.rover : model.sensors, key.key);
    if (!(physics.body.track_scale > 0)) physics.body.track_scale = 1; // a model made by hand
    if (!(physics.body.yaw_inertia > 0)) {                             // a plate under the wheels
        double largest_arm2 = 0;
        for (const WheelPhysics &w : physics.wheel) largest_arm2 = std::max(largest_arm2, w.x * w.x + w.y * w.y);
        physics.body.yaw_inertia = std::max(1e-6, physics.body.mass * largest_arm2 * 2 / 3);
    }
    physics.body.gravity = value_of(model.rover, "gravity_m_s2");
    physics.body.battery_V = value_of(model.rover, "battery_voltage_V");
    physics.runs = runs_of(model);
    for (const EffectUse &use : model.effects) {
        if (!use.expression.empty()) {
            add_user_effect(physics, model, use);
            continue;
        }
        const EffectHandle *handle = find_handle(use.name);
        if (handle == nullptr)
            throw ModelError(model.file, 0, "effect.name", "unknown effect \"" + use.name + "\"",
                             "`traction effects` lists the names; an effect of your own needs acts_on and expression");
        for (const auto *list : {&handle->strengths, &handle->shapes})
            for (const auto &place : *list)
                if (use.parameters.count(place.key) != 0)
                    set_effect(physics, *handle, place, use.wheel, use.parameters.at(place.key).value, list == &handle->shapes);
    }
    return physics;
}

namespace {

constexpr double most_of_value = 0.9; // of a wheel's own difference: what brakes does not drive

double difference_step(double value, double prior) {
    // so small that two parameters which do the same have parallel sensitivities: on concrete 1e-4 of a radius bends them by 5 %
    const double by_value = 1e-7 * std::fabs(value);
    const double by_prior = 1e-4 * prior;
    return std::max({by_value, by_prior, 1e-10});
}

// Of the table's number at one wheel; the back-EMF goes with the torque constant where it is not given.
std::vector<Slot> slots_at(const Model &model, const Key &key, std::size_t wheel) {
    std::vector<Slot> slots = {wheel_slot(key.in_wheel, static_cast<int>(wheel))};
    if (key.in_wheel == &W::KG && !model.wheel[wheel].motor.at("back_emf_Vs_rad").given)
        slots.push_back(wheel_slot(&W::ke, static_cast<int>(wheel)));
    return slots;
}

// What one wheel's number differs from the one that the wheels share.
FreeParameter own_parameter(const Model &model, const FreeParameter &shared, const Key &key, std::size_t wheel) {
    const Parameter &p = table_of(model.wheel[wheel], key.table).at(key.key);
    FreeParameter own = shared;
    own.wheel = static_cast<int>(wheel);
    own.own = true;
    own.slots = slots_at(model, key, wheel);
    own.base = 0;
    own.prior = p.each_wheel * std::fabs(p.value);
    own.maximum = most_of_value * std::fabs(p.value);
    own.minimum = -own.maximum;
    own.step = difference_step(p.value, own.prior);
    return own;
}

// Wheels that have a tolerance each, or whose numbers agree, move together; an overridden wheel moves alone.
void append_shared(std::vector<FreeParameter> &list, const Model &model, const Key &key) {
    std::vector<bool> done(model.wheel.size(), false);
    const bool of_motor = std::string_view(key.table) == "motor";
    for (std::size_t i = 0; i < model.wheel.size() && of_motor; ++i) done[i] = model.wheel[i].drive >= 0; // the motor's own wheel has it
    const auto left = static_cast<std::size_t>(std::count(done.begin(), done.end(), false));
    for (std::size_t i = 0; i < model.wheel.size(); ++i) {
        const Parameters &table = table_of(model.wheel[i], key.table);
        const auto found = table.find(key.key);
        if (done[i] || found == table.end() || found->second.fixed || !(found->second.prior > 0 || found->second.each_wheel > 0)) continue;
        const Parameter &p = found->second;
        FreeParameter free;
        free.owner = key.table;
        free.key = key.key;
        free.unit = p.unit;
        free.base = p.value;
        free.prior = p.prior;
        free.minimum = p.minimum;
        free.maximum = p.maximum;
        free.touched = key.touched;
        std::vector<std::size_t> together;
        for (std::size_t j = i; j < model.wheel.size(); ++j) {
            const Parameter &q = table_of(model.wheel[j], key.table).at(key.key);
            if (done[j] || q.fixed || q.prior != p.prior || q.each_wheel != p.each_wheel) continue;
            if (q.value != p.value && !(p.each_wheel > 0)) continue;
            done[j] = true;
            together.push_back(j);
            for (const Slot &slot : slots_at(model, key, j)) free.slots.push_back(slot);
        }
        free.wheel = together.size() < left ? static_cast<int>(i) : -1;
        free.step = difference_step(p.value, std::max(p.prior, p.each_wheel * std::fabs(p.value)));
        if (p.prior > 0) list.push_back(free);
        for (const std::size_t j : together)
            if (p.each_wheel > 0 && p.value != 0 && together.size() > 1) list.push_back(own_parameter(model, free, key, j));
    }
}

// Every run has its own: nothing is left that the machine's could move.
bool is_every_runs_own(const Model &model, const Key &key) {
    const std::vector<std::size_t> list = begun(model);
    const auto own = std::find_if(std::begin(run_keys), std::end(run_keys), [&](const RunKey &k) {
        return std::string_view(k.table) == key.table && std::string_view(k.key) == key.key;
    });
    return !list.empty() && own != std::end(run_keys) &&
           std::all_of(list.begin(), list.end(), [&](std::size_t i) { return own_table(model.runs[i], *own).count(key.key) != 0; });
}

void append_runs(std::vector<FreeParameter> &list, const Model &model) {
    const std::vector<std::size_t> runs = begun(model);
    for (std::size_t place = 0; place < runs.size(); ++place)
        for (const RunKey &key : run_keys) {
            const Parameters &table = own_table(model.runs[runs[place]], key);
            const auto found = table.find(key.key);
            if (found == table.end() || found->second.fixed || !(found->second.prior > 0)) continue;
            const Parameter &p = found->second;
            FreeParameter free;
            free.owner = key.table, free.key = key.key, free.unit = p.unit, free.run = static_cast<int>(runs[place]),
            free.run_log = model.runs[runs[place]].log;
            Slot slot;
            slot.in_run = key.in_run, slot.run = place;
            free.slots = {slot};
            free.base = p.value, free.prior = p.prior, free.minimum = p.minimum, free.maximum = p.maximum;
            free.step = difference_step(p.value, p.prior);
            free.touched = std::string_view(key.table) == "soil" ? stage_motion : stage_sensors;
            list.push_back(std::move(free));
        }
}

bool is_shape(const EffectHandle &handle, const std::string &key) {
    return std::any_of(handle.shapes.begin(), handle.shapes.end(), [&](const auto &place) { return place.key == key; });
}

// A place along the path moves whole rows from one side of an edge to the other: its step is as long as a row (50 ms at 1 m/s).
double shape_step(const Parameter &p) { return p.unit == "m" ? 0.05 : 1e-4 * std::max(std::fabs(p.value), 0.1); }

void append_effects(std::vector<FreeParameter> &list, const Model &model, const Physics &physics) {
    int term = 0;
    for (const EffectUse &use : model.effects) {
        const EffectHandle *handle = use.expression.empty() ? find_handle(use.name) : nullptr;
        int coefficient = 0;
        for (const auto &[key, p] : use.parameters) {
            FreeParameter free;
            free.owner = use.name;
            free.key = key;
            free.unit = p.unit;
            free.wheel = use.wheel;
            free.base = p.value;
            free.minimum = p.minimum;
            free.maximum = p.maximum;
            if (handle == nullptr) {
                Slot slot;
                slot.term = term;
                slot.coefficient = coefficient++;
                free.slots = {slot};
                TermTarget target = TermTarget::wheel_torque;
                parse_target(use.acts_on, target);
                free.touched = target_stages(target);
            } else {
                free.touched = handle->touched;
                for (const auto *places : {&handle->strengths, &handle->shapes})
                    for (const auto &place : *places) {
                        if (place.key != key) continue;
                        if (place.in_body != nullptr)
                            free.slots = {body_slot(place.in_body)};
                        else
                            for (std::size_t i = 0; i < model.wheel.size(); ++i)
                                if (handle->acts_at(physics, use.wheel, i))
                                    free.slots.push_back(wheel_slot(place.in_wheel, static_cast<int>(i)));
                    }
            }
            const double span = std::isfinite(p.maximum - p.minimum) ? p.maximum - p.minimum : std::fabs(p.value) + 1.0;
            free.step = std::max((handle != nullptr && handle->remembers ? 1e-3 : 1e-7) * span, 1e-10);
            if (handle != nullptr && is_shape(*handle, key)) free.step = shape_step(p);
            if (!p.fixed && !free.slots.empty()) list.push_back(std::move(free));
        }
        if (handle == nullptr) ++term;
    }
}

} // namespace

std::vector<FreeParameter> free_parameters(const Model &model, const Physics &physics) {
    std::vector<FreeParameter> list;
    for (const Key &key : keys) {
        if (is_every_runs_own(model, key)) continue;
        if (key.in_wheel != nullptr) {
            append_shared(list, model, key);
            continue;
        }
        const Parameters &table = std::string(key.table) == "rover" ? model.rover : model.sensors;
        const auto found = table.find(key.key);
        if (found == table.end() || found->second.fixed || !(found->second.prior > 0)) continue;
        const Parameter &p = found->second;
        FreeParameter free;
        free.owner = key.table;
        free.key = key.key;
        free.unit = p.unit;
        free.slots = {body_slot(key.in_body)};
        free.base = p.value;
        free.prior = p.prior;
        free.minimum = p.minimum;
        free.maximum = p.maximum;
        free.step = difference_step(p.value, p.prior);
        free.touched = key.touched;
        list.push_back(std::move(free));
    }
    append_runs(list, model);
    append_effects(list, model, physics);
    return list;
}

void store(Model &model, const FreeParameter &parameter, double increment, double half_width) {
    const auto put = [&](Parameter &p) {
        p.value += increment;
        if (half_width > 0) {
            p.low = p.value - half_width;
            p.high = p.value + half_width;
        }
    };
    if (parameter.run >= 0) {
        RunSpec &run = model.runs[static_cast<std::size_t>(parameter.run)];
        return put((parameter.owner == "soil" ? run.soil : run.sensors).at(parameter.key));
    }
    for (EffectUse &use : model.effects)
        if (use.name == parameter.owner && use.wheel == parameter.wheel && use.parameters.count(parameter.key) != 0)
            return put(use.parameters.at(parameter.key));
    if (parameter.owner == "rover") return put(model.rover.at(parameter.key));
    if (parameter.owner == "sensors") return put(model.sensors.at(parameter.key));
    for (const Slot &slot : parameter.slots) {
        if (slot.in_wheel == nullptr) continue;
        if (slot.in_wheel == &W::ke && parameter.key != "back_emf_Vs_rad") continue;
        WheelSpec &wheel = model.wheel[static_cast<std::size_t>(slot.wheel)];
        Parameters &table = parameter.owner == "wheel" ? wheel.geometry : parameter.owner == "motor" ? wheel.motor : wheel.soil;
        put(table.at(parameter.key));
    }
}

} // namespace traction::lab
