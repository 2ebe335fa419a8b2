#include "model.h"

#include "host_tools/log/log.h"
#include "model_keys.h"
#include "model_reader.h"
#include "read_drives.h"
#include "read_runs.h"
#include "sim/physics/effects/catalogue.h"
#include "terms.h"

#include <span>
#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace traction::lab {

namespace {

std::string complete_message(const std::string &file, std::size_t line, const std::string &key, const std::string &wrong,
                             const std::string &mend) {
    std::string text = file;
    if (line > 0) text += ":" + std::to_string(line);
    if (!key.empty()) text += ": " + key;
    return text + ": " + wrong + "; " + mend;
}

void fill_defaults(std::span<const ModelKey> known, Parameters &into) {
    for (const ModelKey &k : known) {
        if (into.count(std::string(k.key)) != 0) continue;
        Parameter p;
        p.value = k.value;
        p.unit = k.unit;
        p.minimum = k.minimum;
        p.maximum = k.maximum;
        p.prior = std::max(k.relative_prior * std::fabs(k.value), k.absolute_prior);
        p.each_wheel = k.each_wheel;
        p.source = "default of the program";
        into[std::string(k.key)] = p;
    }
}

const std::vector<std::string> motor_extra = {"motor_constant_Nm_A", "motor_back_emf_Vs_rad", "gear_ratio", "gear_efficiency",
                                              "motor_inertia_kg_m2"};
const std::vector<std::string> soil_extra = {
    "law", "strength_N", "cohesion_Pa", "friction_angle_rad", "shear_length_m", "contact_length_m"};

void put(Parameters &into, const ModelReader &reader, const toml::table &source, const std::string &where, std::span<const ModelKey> known,
         const std::string &key, double value, const char *how) {
    const auto found = std::find_if(known.begin(), known.end(), [&](const ModelKey &k) { return k.key == key; });
    Parameter p;
    p.unit = found->unit;
    p.minimum = found->minimum;
    p.maximum = found->maximum;
    p.value = value;
    p.given = true;
    p.prior = std::max(found->relative_prior * std::fabs(value), found->absolute_prior);
    p.each_wheel = found->each_wheel;
    p.source = how;
    if (!(value >= p.minimum && value <= p.maximum))
        reader.fail(source, where + "." + key, "comes out as " + number_text(value), "check the values it is computed from");
    into[key] = p;
}

void read_motor(const ModelReader &reader, const toml::table &source, const std::string &where, Parameters &into) {
    reader.table(source, where, motor_keys(), into, motor_extra);
    const auto get = [&](const char *key) -> double {
        const toml::node *node = source.get(key);
        if (node == nullptr) return std::nan("");
        Parameter p;
        reader.parameter(*node, where + "." + key, p);
        return p.value;
    };
    const double gear = std::isnan(get("gear_ratio")) ? 1.0 : get("gear_ratio");
    const double efficiency = std::isnan(get("gear_efficiency")) ? 1.0 : get("gear_efficiency");
    // A number of the wheel's side and the motor's that it is made of: one of them would be left out in silence.
    for (const auto &[motor_side, wheel_side] :
         {std::pair("motor_constant_Nm_A", "torque_constant_Nm_A"), std::pair("motor_back_emf_Vs_rad", "back_emf_Vs_rad"),
          std::pair("motor_inertia_kg_m2", "inertia_kg_m2")})
        if (source.contains(motor_side) && source.contains(wheel_side))
            reader.fail(*source.get(motor_side), where + "." + motor_side, "stands beside " + std::string(wheel_side) + ", which it makes",
                        "give one of the two: of the motor, with gear_ratio, or at the wheel");
    const double kt = get("motor_constant_Nm_A"), ke = get("motor_back_emf_Vs_rad"), rotor = get("motor_inertia_kg_m2");
    if (!std::isnan(kt))
        put(into, reader, source, where, motor_keys(), "torque_constant_Nm_A", kt * gear * efficiency, "motor constant times gear ratio");
    if (!std::isnan(ke)) put(into, reader, source, where, motor_keys(), "back_emf_Vs_rad", ke * gear, "motor back-EMF times gear ratio");
    if (!std::isnan(rotor))
        put(into, reader, source, where, motor_keys(), "inertia_kg_m2", rotor * gear * gear, "rotor inertia times gear ratio squared");
}

void read_soil(const ModelReader &reader, const toml::table &source, const std::string &where, Parameters &into, Model &model,
               double load_N, double width_m) {
    reader.table(source, where, soil_keys(), into, soil_extra);
    const std::string law = reader.text(source, where, "law", model.soil_law == SoilLaw::janosi ? "janosi" : "burckhardt");
    if (law == "burckhardt")
        model.soil_law = SoilLaw::burckhardt;
    else if (law == "janosi" || law == "bekker")
        model.soil_law = SoilLaw::janosi;
    else
        reader.fail(*source.get("law"), where + ".law", "is \"" + law + "\"",
                    "use \"janosi\" (soft soil), \"burckhardt\" (hard ground) or \"bekker\"");
    const auto get = [&](const char *key) -> double {
        const toml::node *node = source.get(key);
        if (node == nullptr) return std::nan("");
        Parameter p;
        reader.parameter(*node, where + "." + key, p);
        return p.value;
    };
    // The same of a ground: what makes mu, the adhesion and the slip of half strength, and these themselves.
    const auto alone = [&](const char *whole, const char *key) {
        if (source.contains(whole) && source.contains(key))
            reader.fail(*source.get(key), where + "." + key, "stands beside " + std::string(whole) + ", which makes it",
                        "give one of the two");
    };
    alone("strength_N", "mu");
    if (law == "bekker")
        for (const auto &[whole, key] :
             {std::pair("friction_angle_rad", "mu"), std::pair("cohesion_Pa", "adhesion_N"), std::pair("shear_length_m", "shear_slip")})
            alone(whole, key);
    const double strength = get("strength_N");
    if (!std::isnan(strength)) {
        if (!(load_N > 0))
            reader.fail(source, where + ".strength_N", "needs a wheel load", "give load_N per wheel or rover.mass_kg, or use mu");
        put(into, reader, source, where, soil_keys(), "mu", strength / load_N, "strength_N over the wheel's static load");
    }
    if (law != "bekker") return;
    const double c = get("cohesion_Pa"), phi = get("friction_angle_rad"), K = get("shear_length_m"), l = get("contact_length_m");
    if (std::isnan(c) || std::isnan(phi) || !(K > 0) || !(l > 0))
        reader.fail(source, where, "law \"bekker\" is incomplete",
                    "give cohesion_Pa, friction_angle_rad, shear_length_m and contact_length_m");
    put(into, reader, source, where, soil_keys(), "adhesion_N", l * width_m * c, "l * width * c, (5) Lhomme-Desages");
    put(into, reader, source, where, soil_keys(), "mu", std::tan(phi), "tan(phi), (5) Lhomme-Desages");
    put(into, reader, source, where, soil_keys(), "shear_slip", K / l, "K / l, (20) Lhomme-Desages");
}

void read_rover(const ModelReader &reader, const toml::table &root, Model &model) {
    if (const toml::table *rover = root["rover"].as_table()) {
        reader.table(*rover, "rover", rover_keys(), model.rover, {"motion", "halves", "drives"});
        const std::string motion = reader.text(*rover, "rover", "motion", "longitudinal");
        static const char *names[] = {"longitudinal", "planar", "imposed", "none"}; // as BodyMotion has them
        const auto found = std::find(std::begin(names), std::end(names), motion);
        if (found == std::end(names))
            reader.fail(*rover->get("motion"), "rover.motion", "is \"" + motion + "\"",
                        "use \"longitudinal\", \"planar\", \"imposed\" or \"none\"");
        model.motion = static_cast<BodyMotion>(found - names);
        model.halves = reader.flag(*rover, "rover", "halves", false);
    }
    fill_defaults(rover_keys(), model.rover);
    const bool moves = model.motion == BodyMotion::longitudinal || model.motion == BodyMotion::planar;
    if (moves && !(model.rover.at("mass_kg").value > 0))
        reader.fail(root, "rover.mass_kg", "is missing or zero",
                    "give the mass, or rover.motion = \"imposed\" (bench) or \"none\" (wheels in the air)");
}

void read_wheels(const ModelReader &reader, const toml::table &root, Model &model) {
    const toml::array *wheels = root["wheel"].as_array();
    if (wheels == nullptr || wheels->empty()) reader.fail(root, "wheel", "there is none", "add a [[wheel]] table per wheel");
    const double share_N = model.rover.at("mass_kg").value * model.rover.at("gravity_m_s2").value / static_cast<double>(wheels->size());
    for (std::size_t i = 0; i < wheels->size(); ++i) {
        const std::string where = "wheel[" + std::to_string(i) + "]";
        const toml::table *table = (*wheels)[i].as_table();
        if (table == nullptr) reader.fail((*wheels)[i], where, "is not a table", "write [[wheel]] and its keys below");
        WheelSpec spec;
        spec.name = reader.text(*table, where, "name", "wheel " + std::to_string(i));
        spec.driven = reader.flag(*table, where, "driven", true);
        spec.grips_sideways = reader.flag(*table, where, "grips_sideways", true);
        if (const toml::table *shared = root["wheels"].as_table()) reader.table(*shared, "wheels", wheel_keys(), spec.geometry, {});
        reader.table(*table, where, wheel_keys(), spec.geometry, {"name", "driven", "grips_sideways", "motor", "soil"});
        fill_defaults(wheel_keys(), spec.geometry);
        if (!(spec.geometry.at("radius_m").value > 0))
            reader.fail(*table, where + ".radius_m", "is missing", "give the radius under load, here or for all in [wheels]");
        const double load_N = spec.geometry.at("load_N").value > 0 ? spec.geometry.at("load_N").value : share_N;
        const double width_m = spec.geometry.at("width_m").value;
        if (const toml::table *motor = root["motor"].as_table()) read_motor(reader, *motor, "motor", spec.motor);
        if (const toml::table *motor = (*table)["motor"].as_table()) read_motor(reader, *motor, where + ".motor", spec.motor);
        if (const toml::table *soil = root["soil"].as_table()) read_soil(reader, *soil, "soil", spec.soil, model, load_N, width_m);
        if (const toml::table *soil = (*table)["soil"].as_table())
            read_soil(reader, *soil, where + ".soil", spec.soil, model, load_N, width_m);
        fill_defaults(motor_keys(), spec.motor);
        fill_defaults(soil_keys(), spec.soil);
        model.wheel.push_back(std::move(spec));
    }
}

void read_sensors(const ModelReader &reader, const toml::table &root, Model &model) {
    if (const toml::table *sensors = root["sensors"].as_table()) {
        for (const auto &[name_key, node] : *sensors) {
            const std::string name(name_key.str());
            const toml::table *table = node.as_table();
            if (table == nullptr) reader.fail(node, "sensors." + name, "is not a table", "write [sensors." + name + "]");
            const bool current = name == "current";
            reader.table(*table, "sensors." + name, sensor_keys(), model.sensors,
                         current ? std::vector<std::string>{"unsigned"} : std::vector<std::string>{}, name + ".");
            if (current) model.unsigned_current = reader.flag(*table, "sensors." + name, "unsigned", false);
        }
    }
    fill_defaults(sensor_keys(), model.sensors);
}

void read_effect_parameter(const ModelReader &reader, const toml::node &node, const std::string &where, const std::string &key,
                           const sim::Effect *effect, EffectUse &use) {
    Parameter p;
    if (effect != nullptr) {
        const auto found = std::find_if(effect->parameters.begin(), effect->parameters.end(),
                                        [&](const sim::EffectParameter &e) { return e.name == key; });
        if (found == effect->parameters.end()) {
            std::string names;
            for (const sim::EffectParameter &e : effect->parameters) names += (names.empty() ? "" : ", ") + std::string(e.name);
            reader.fail(node, where + "." + key, "is not a parameter of " + use.name, "it has " + names);
        }
        p.unit = found->unit;
        p.fixed = !found->strength;
        if (found->strength) {
            // a fit may step a little past the plausible range: the report then says so
            const double span = found->maximum - found->minimum;
            p.minimum = found->minimum < 0 ? found->minimum - 0.5 * span : found->minimum;
            p.maximum = found->maximum + 0.5 * span;
        }
    }
    reader.parameter(node, where + "." + key, p);
    use.parameters[key] = p;
}

void read_effects(const ModelReader &reader, const toml::table &root, Model &model) {
    const toml::array *effects = root["effect"].as_array();
    for (std::size_t i = 0; effects != nullptr && i < effects->size(); ++i) {
        const std::string where = "effect[" + std::to_string(i) + "]";
        const toml::table *table = (*effects)[i].as_table();
        if (table == nullptr) reader.fail((*effects)[i], where, "is not a table", "write [[effect]] and its keys below");
        EffectUse use;
        use.name = reader.text(*table, where, "name", "");
        if (use.name.empty()) reader.fail(*table, where + ".name", "is missing", "name an effect of `traction effects`, or your own");
        if (const toml::node *wheel = table->get("wheel")) {
            if (!wheel->is_integer()) reader.fail(*wheel, where + ".wheel", "is not a whole number", "give the wheel's number, from 0");
            use.wheel = wheel->value_or(-1);
        }
        if (use.wheel < -1 || use.wheel >= static_cast<int>(model.wheel.size()))
            reader.fail(*table, where + ".wheel", "is " + std::to_string(use.wheel),
                        "wheels are 0 to " + std::to_string(model.wheel.size() - 1));
        use.acts_on = reader.text(*table, where, "acts_on", "");
        use.expression = reader.text(*table, where, "expression", "");
        check_effect_wheel(*table, where, model, use);
        const sim::Effect *effect = use.expression.empty() ? sim::find_effect(use.name) : nullptr;
        if (effect == nullptr && use.expression.empty())
            reader.fail(*table, where + ".name", "unknown effect \"" + use.name + "\"",
                        "`traction effects` lists the names; an effect of your own needs acts_on and expression");
        for (const auto &[key, node] : *table) {
            const std::string name(key.str());
            if (name == "name" || name == "wheel" || name == "acts_on" || name == "expression" || name == "note") continue;
            if (name == "parameter" && node.is_table()) {
                for (const auto &[inner, item] : *node.as_table())
                    read_effect_parameter(reader, item, where, std::string(inner.str()), effect, use);
            } else {
                read_effect_parameter(reader, node, where, name, effect, use);
            }
        }
        TermTarget target = TermTarget::wheel_torque;
        if (!use.expression.empty() && !parse_target(use.acts_on, target))
            reader.fail(*table, where + ".acts_on", "is \"" + use.acts_on + "\"",
                        "use wheel_torque, wheel_force, rolling_resistance, body_force, voltage, soil_strength, shear_slip, "
                        "motor_constant, resistance, sensor.accel, sensor.radar, sensor.camera or sensor.current");
        if (!use.expression.empty()) {
            std::vector<std::string> names;
            for (const auto &[key, parameter] : use.parameters) names.push_back(key);
            try {
                make_expression(use.expression, names);
            } catch (const std::runtime_error &error) {
                reader.fail(*table, where + ".expression", error.what(),
                            "use t w v s Fn theta x X a d I Io Ia Is u Ft V r, the effect's own parameters, and muparser's functions");
            }
        }
        model.effects.push_back(std::move(use));
    }
}

void read_lineage(const toml::table &root, Model &model) {
    const toml::array *entries = root["lineage"].as_array();
    for (std::size_t i = 0; entries != nullptr && i < entries->size(); ++i) {
        const toml::table *table = (*entries)[i].as_table();
        if (table == nullptr) continue;
        LineageEntry entry;
        entry.label = (*table)["label"].value_or(std::string());
        entry.log = (*table)["log"].value_or(std::string());
        entry.date = (*table)["date"].value_or(std::string());
        entry.train = (*table)["train"].value_or(std::nan(""));
        entry.heldout = (*table)["heldout"].value_or(std::nan(""));
        entry.floor = (*table)["floor"].value_or(std::nan(""));
        entry.despite = (*table)["despite"].value_or(std::string());
        model.lineage.push_back(std::move(entry));
    }
}

} // namespace

ModelError::ModelError(const std::string &file_, std::size_t line_, const std::string &key_, const std::string &what_is_wrong,
                       const std::string &mend_)
    : std::runtime_error(complete_message(file_, line_, key_, what_is_wrong, mend_)), file(file_), line(line_), key(key_), mend(mend_) {}

bool Model::couples() const {
    return std::any_of(wheel.begin(), wheel.end(), [](const WheelSpec &w) { return w.drive >= 0; });
}

std::vector<std::size_t> wheels_of_motor(const Model &model, std::size_t index) {
    std::vector<std::size_t> out;
    if (model.motor_of(index) != index) return out;
    out.push_back(index);
    for (std::size_t i = 0; i < model.wheel.size(); ++i)
        if (i != index && model.motor_of(i) == index) out.push_back(i);
    return out;
}

const EffectUse *Model::find_effect(const std::string &effect, int wheel_index) const {
    for (const EffectUse &use : effects)
        if (use.name == effect && use.wheel == wheel_index) return &use;
    return nullptr;
}

Model parse_model(const std::string &text, const std::string &file) {
    toml::table root;
    try {
        root = toml::parse(text, file);
    } catch (const toml::parse_error &error) {
        throw ModelError(file, error.source().begin.line, "", std::string(error.description()), "mend the TOML there");
    }
    const ModelReader reader{file};
    Model model;
    model.file = file;
    model.name = reader.text(root, "", "name", file);
    for (const auto &[key, node] : root) {
        static const std::vector<std::string> known = {"format", "name",    "rover",  "wheels", "wheel",   "motor",
                                                       "soil",   "sensors", "effect", "run",    "lineage", "note"};
        if (std::find(known.begin(), known.end(), key.str()) == known.end())
            reader.fail(node, std::string(key.str()), "is not a known table",
                        "use rover, wheels, wheel, motor, soil, sensors, effect, run, lineage");
    }
    if (const std::string format = reader.text(root, "", "format", "traction.model/1"); format != "traction.model/1")
        reader.fail(*root.get("format"), "format", "is \"" + format + "\"", "this program reads \"traction.model/1\"");
    read_rover(reader, root, model);
    read_wheels(reader, root, model);
    read_drives(root, model);
    read_sensors(reader, root, model);
    read_effects(reader, root, model);
    read_runs(reader, root, model);
    read_lineage(root, model);
    return model;
}

Model read_model(const std::string &path) {
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    if (stream.is_open() && stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
    if (!stream.is_open() || stream.bad() || std::filesystem::is_directory(path))
        throw log::FileError(
            path, 0, 0, std::string("cannot read this model: ") + (errno != 0 ? std::strerror(errno) : "it is no file that can be read"),
            "check its name; models/*.toml are examples");
    return parse_model(text.str(), path);
}

} // namespace traction::lab
