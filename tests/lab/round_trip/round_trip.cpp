#include "round_trip.h"

#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/next/manoeuvre.h"
#include "host_tools/simulate/simulate.h"
#include "sim/physics/effects/catalogue.h"
#include "tests/lab/generator/generator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace traction::round_trip {

namespace {

constexpr const char *soils[] = {"sand", "gravel", "concrete"};

// Effects that the fit can hold apart in the identification drive, of every part of the machine.
constexpr const char *effects[] = {"slip_sinkage", "viscous_friction", "coulomb_friction", "wiring_resistance", "mass_offset_x",
                                   "grade",        "multi_pass",       "mesh_loss",        "body_drag",         "load_transfer"};

struct Hidden {
    std::string name, key;
    double size = 0;
};

Hidden draw_effect(std::uint64_t seed, generator::Random &random) {
    const sim::Effect *effect = sim::find_effect(effects[seed % std::size(effects)]);
    return {std::string(effect->name), std::string(effect->parameters[0].name), effect->parameters[0].typical * random.uniform(0.5, 1.5)};
}

lab::EffectUse use_of(const Hidden &hidden, double size) {
    const sim::Effect *effect = sim::find_effect(hidden.name);
    lab::EffectUse use;
    use.name = hidden.name;
    for (const sim::EffectParameter &spec : effect->parameters) {
        lab::Parameter p;
        p.value = &spec == &effect->parameters[0] ? size : spec.typical;
        p.fixed = !spec.strength;
        p.unit = spec.unit;
        p.minimum = spec.minimum < 0 ? 2 * spec.minimum : 0;
        p.maximum = 2 * spec.maximum;
        use.parameters[std::string(spec.name)] = p;
    }
    return use;
}

using Truth = std::map<std::string, double>;

// What the independent machine really is: its first wheel, where they differ.
Truth truth_of(const generator::Machine &m) {
    return {{"motor.torque_constant_Nm_A", m.KG * m.KG_each[0]},
            {"motor.resistance_ohm", m.Ra * m.Ra_each[0]},
            {"motor.inertia_kg_m2", m.J},
            {"motor.viscous_Nms", m.viscous * m.viscous_each[0]},
            {"motor.coulomb_Nm", m.coulomb * m.coulomb_each[0]},
            {"wheel.radius_m", m.radius * m.radius_each[0]},
            {"soil.mu", m.mu},
            {"soil.shear_slip", m.sc},
            {"soil.rolling_coefficient", m.rolling},
            {"rover.mass_kg", m.mass}};
}

// Moves what the plant can be given by its prior, and says where to.
Truth move_by_prior(lab::Model &model, generator::Random &random) {
    Truth truth;
    const auto move = [&](const std::string &name, auto &&table_of, const char *key) {
        const lab::Parameter &p = table_of(model.wheel[0]).at(key);
        const double value = std::max(p.minimum, p.value + p.prior * random.normal());
        for (lab::WheelSpec &w : model.wheel) table_of(w).at(key).value = value;
        truth[name + "." + key] = value;
    };
    const auto motor = [](lab::WheelSpec &w) -> lab::Parameters & { return w.motor; };
    const auto soil = [](lab::WheelSpec &w) -> lab::Parameters & { return w.soil; };
    const auto wheel = [](lab::WheelSpec &w) -> lab::Parameters & { return w.geometry; };
    for (const char *key : {"torque_constant_Nm_A", "resistance_ohm", "inertia_kg_m2", "viscous_Nms", "coulomb_Nm"})
        move("motor", motor, key);
    for (const char *key : {"mu", "shear_slip", "rolling_coefficient"}) move("soil", soil, key);
    move("wheel", wheel, "radius_m");
    return truth;
}

const lab::Parameter &fitted(const lab::Model &model, const std::string &name) {
    const std::string table = name.substr(0, name.find('.')), key = name.substr(name.find('.') + 1);
    const lab::WheelSpec &w = model.wheel.front();
    return table == "motor"   ? w.motor.at(key)
           : table == "soil"  ? w.soil.at(key)
           : table == "wheel" ? w.geometry.at(key)
                              : model.rover.at(key);
}

std::string drive_of(const std::string &file) {
    std::ifstream stream(file);
    if (!stream.is_open()) throw std::runtime_error("cannot open " + file + ": run this in the project's folder");
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str().substr(text.str().find("[[drive]]"));
}

} // namespace

std::vector<Estimate> run(Source source, std::uint64_t seed, double duration_s) {
    generator::Random random(seed, 77);
    const std::string soil = soils[(seed / std::size(effects)) % std::size(soils)];
    const Hidden hidden = draw_effect(seed, random);
    lab::Model model =
        lab::read_model(source == Source::plant ? "models/rover_" + soil + ".toml" : "tests/lab/campaign/machine_" + soil + ".toml");
    Truth truth;
    log::Log log;
    if (source != Source::plant) {
        generator::GeneratorConfig config;
        config.apart = source == Source::apart;
        config.soil = generator::soil_of(soil);
        config.seed = seed;
        config.duration_s = duration_s;
        config.hidden.push_back({hidden.name, -1, {{hidden.key, hidden.size}}});
        if (config.apart) model = lab::parse_model(generator::data_sheet(config), "data sheet");
        log = generator::generate(config);
        truth = truth_of(generator::machine_of(config));
    } else {
        lab::Model machine = model;
        truth = move_by_prior(machine, random);
        machine.effects.push_back(use_of(hidden, hidden.size));
        std::vector<std::string> notes;
        SimulateOptions options;
        options.seed = seed;
        sim::Scenario scenario = sim::parse_scenario(
            lab::scenario_of(machine, "round trip", drive_of("scenarios/identification.toml"), duration_s, notes), "round trip");
        scenario.firmware.believes = sim::RoverDescription(); // nobody has told the firmware how far this machine is off its data sheet
        log = simulate(scenario, options).log;
    }
    model.effects.push_back(use_of(hidden, 0.5 * hidden.size));
    fit_model(model, lab::make_dataset(model, log), "fitted");
    std::vector<Estimate> out;
    for (const auto &[name, value] : truth) {
        const lab::Parameter &p = fitted(model, name);
        if (std::isfinite(p.low) && p.high > p.low) out.push_back({name, value, p.value, p.low, p.high, seed});
    }
    const lab::Parameter &p = model.effects.back().parameters.at(hidden.key);
    out.push_back({"effect: " + hidden.name, hidden.size, p.value, p.low, p.high, seed});
    return out;
}

nlohmann::json estimate_json(const Estimate &e) {
    const auto number = [](double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(std::to_string(value)); };
    return {{"log", e.log},         {"key", e.key},           {"truth", number(e.truth)}, {"value", number(e.value)},
            {"low", number(e.low)}, {"high", number(e.high)}, {"inside", e.inside()}};
}

Estimate read_estimate(const nlohmann::json &from) {
    const auto number = [&](const char *key) {
        const nlohmann::json &value = from.at(key);
        return value.is_string() ? std::strtod(value.get<std::string>().c_str(), nullptr) : value.get<double>();
    };
    return {from.at("key").get<std::string>(),  number("truth"), number("value"), number("low"), number("high"),
            from.at("log").get<std::uint64_t>()};
}

double Tally::share_error() const {
    const double logs = static_cast<double>(of_log.size());
    double squares_of_logs = 0;
    for (const auto &[log, one] : of_log) squares_of_logs += std::pow(one.first - share() * one.second, 2);
    const double by_logs = logs > 1 ? std::sqrt(squares_of_logs * logs / (logs - 1)) / count : 0;
    return std::max(by_logs, std::sqrt(0.92 * 0.08 / count));
}

bool Tally::as_claimed(double least) const {
    constexpr double one_in_200 = 2.58;
    return share() + one_in_200 * share_error() >= least && share() - one_in_200 * share_error() <= 0.98;
}

std::map<std::string, Tally> tally(const std::vector<Estimate> &estimates) {
    std::map<std::string, Tally> out;
    for (const Estimate &e : estimates)
        for (const std::string &key : {e.key, std::string(e.key.rfind("effect", 0) == 0 ? "all effects" : "all parameters")}) {
            Tally &t = out[key];
            t.inside += e.inside();
            t.count += 1;
            t.of_log[e.log].first += e.inside();
            t.of_log[e.log].second += 1;
            t.sum += e.standard_errors();
            t.squares += e.standard_errors() * e.standard_errors();
        }
    return out;
}

std::string table(const std::map<std::string, Tally> &tallies) {
    std::string text = "| | inside 95 % | n | distance in standard errors: mean | rms | 0.92 to 0.98 |\n|---|---|---|---|---|---|\n";
    for (const auto &[key, t] : tallies) {
        char line[160];
        std::snprintf(line, sizeof line, "| %s | %.2f | %d | %+.1f | %.1f | %s |\n", key.c_str(), static_cast<double>(t.inside) / t.count,
                      t.count, t.sum / t.count, std::sqrt(t.squares / t.count), t.as_claimed() ? "yes" : "no");
        text += line;
    }
    return text;
}

} // namespace traction::round_trip
