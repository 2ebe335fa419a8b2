// Writes a model as TOML: shared [motor] and [soil] tables from the first wheel, overrides where a wheel differs.
#include "model.h"

#include "host_tools/log/write_file.h"
#include "model_keys.h"

#include <charconv>
#include <cmath>

namespace traction::lab {

namespace {

std::string number(double value) {
    char buffer[40];
    const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
    std::string text(buffer, result.ptr);
    if (text.find_first_of(".en") == std::string::npos) text += ".0"; // TOML tells integers from floats
    return text;
}

std::string quoted(const std::string &text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        if (c == '\n')
            out += "\\n";
        else
            out += c;
    }
    return out + "\"";
}

std::string parameter_text(const Parameter &p, bool with_prior, const std::string &key) {
    std::string out = "{ value = " + number(p.value);
    if (!p.unit.empty()) out += ", unit = " + quoted(p.unit);
    if (std::isfinite(p.minimum)) out += ", min = " + number(p.minimum);
    if (std::isfinite(p.maximum)) out += ", max = " + number(p.maximum);
    if (with_prior) out += ", prior = " + number(p.prior);
    if (with_prior && (p.each_wheel > 0 || (p.prior > 0 && default_each_wheel(key) > 0))) out += ", each_wheel = " + number(p.each_wheel);
    if (p.fixed) out += ", fixed = true";
    if (std::isfinite(p.low) && std::isfinite(p.high)) out += ", low = " + number(p.low) + ", high = " + number(p.high);
    if (!p.source.empty()) out += ", source = " + quoted(p.source);
    return out + " }";
}

bool same(const Parameter &a, const Parameter &b) {
    return a.value == b.value && a.prior == b.prior && a.each_wheel == b.each_wheel && a.fixed == b.fixed;
}

void write_table(std::string &out, const Parameters &table) {
    for (const auto &[key, p] : table)
        if (p.given || std::isfinite(p.low)) out += key + " = " + parameter_text(p, true, key) + "\n";
}

void write_overrides(std::string &out, const std::string &heading, const Parameters &table, const Parameters &shared) {
    std::string body;
    for (const auto &[key, p] : table)
        if ((p.given || std::isfinite(p.low)) && !same(p, shared.at(key))) body += key + " = " + parameter_text(p, true, key) + "\n";
    if (!body.empty()) out += heading + "\n" + body;
}

// [[0, 2], [1, 3]]: of each motor the wheels that it turns, its own first.
std::string drives_text(const Model &model) {
    std::string out = "[";
    for (std::size_t i = 0; i < model.wheel.size(); ++i) {
        const std::vector<std::size_t> turned = wheels_of_motor(model, i);
        if (turned.empty() || !model.wheel[i].driven) continue;
        out += out.size() > 1 ? ", [" : "[";
        for (std::size_t j = 0; j < turned.size(); ++j) out += (j > 0 ? ", " : "") + std::to_string(turned[j]);
        out += "]";
    }
    return out + "]";
}

void write_runs(std::string &out, const Model &model) {
    for (const RunSpec &run : model.runs) {
        if (run.soil.empty() && run.sensors.empty()) continue;
        out += "\n[[run]]\nlog = " + quoted(run.log) + "\n";
        if (!run.soil.empty()) out += "[run.soil]\n";
        for (const auto &[key, p] : run.soil) out += key + " = " + parameter_text(p, true, key) + "\n";
        for (const auto &[key, p] : run.sensors) {
            const std::size_t dot = key.find('.');
            out += "[run.sensors." + key.substr(0, dot) + "]\n" + key.substr(dot + 1) + " = " + parameter_text(p, true, key) + "\n";
        }
    }
}

void write_lineage(std::string &out, const Model &model) {
    for (const LineageEntry &entry : model.lineage) {
        out += "\n[[lineage]]\nlabel = " + quoted(entry.label) + "\nlog = " + quoted(entry.log) + "\n";
        if (!entry.date.empty()) out += "date = " + quoted(entry.date) + "\n";
        if (!entry.despite.empty()) out += "despite = " + quoted(entry.despite) + "\n";
        if (std::isfinite(entry.train)) out += "train = " + number(entry.train) + "\n";
        if (std::isfinite(entry.heldout)) out += "heldout = " + number(entry.heldout) + "\n";
        if (std::isfinite(entry.floor)) out += "floor = " + number(entry.floor) + "\n";
    }
}

} // namespace

std::string model_text(const Model &model) {
    static const char *motions[] = {"longitudinal", "planar", "imposed", "none"};
    std::string out = "format = \"traction.model/1\"\nname = " + quoted(model.name) + "\n\n[rover]\nmotion = ";
    out += quoted(motions[static_cast<int>(model.motion)]) + "\n";
    if (model.halves) out += "halves = true\n";
    if (model.couples()) out += "drives = " + drives_text(model) + "\n";
    write_table(out, model.rover);
    const WheelSpec &first = model.wheel.front();
    out += "\n[motor]\n";
    const Parameters &motor = model.wheel[model.motor_of(0)].motor;
    write_table(out, motor);
    out += "\n[soil]\nlaw = " + quoted(model.soil_law == SoilLaw::janosi ? "janosi" : "burckhardt") + "\n";
    write_table(out, first.soil);
    for (const WheelSpec &wheel : model.wheel) {
        out += "\n[[wheel]]\nname = " + quoted(wheel.name) + "\n";
        if (!wheel.driven) out += "driven = false\n";
        if (!wheel.grips_sideways) out += "grips_sideways = false\n";
        write_table(out, wheel.geometry);
        if (wheel.drive < 0) write_overrides(out, "[wheel.motor]", wheel.motor, motor);
        write_overrides(out, "[wheel.soil]", wheel.soil, first.soil);
    }
    std::string sensor;
    for (const auto &[key, p] : model.sensors) {
        const std::string name = key.substr(0, key.find('.'));
        const bool with_flag = name == "current" && model.unsigned_current;
        if (!p.given && !std::isfinite(p.low) && !with_flag) continue;
        if (name != sensor) {
            out += "\n[sensors." + name + "]\n";
            if (with_flag) out += "unsigned = true\n";
        }
        sensor = name;
        out += key.substr(key.find('.') + 1) + " = " + parameter_text(p, true, key) + "\n";
    }
    for (const EffectUse &use : model.effects) {
        out += "\n[[effect]]\nname = " + quoted(use.name) + "\n";
        if (use.wheel >= 0) out += "wheel = " + std::to_string(use.wheel) + "\n";
        if (!use.expression.empty()) out += "acts_on = " + quoted(use.acts_on) + "\nexpression = " + quoted(use.expression) + "\n";
        for (const auto &[key, p] : use.parameters) out += key + " = " + parameter_text(p, false, key) + "\n";
    }
    write_runs(out, model);
    write_lineage(out, model);
    return out;
}

void write_model(const Model &model, const std::string &path) { log::write_file(model_text(model), path); }

} // namespace traction::lab
