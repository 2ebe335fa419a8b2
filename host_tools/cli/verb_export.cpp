// verb_export.cpp - traction export: every residual as CSV, the firmware's parameters, or the regressors of every candidate.
#include "rows.h"
#include "verbs.h"

#include "host_tools/bench_lab/regressors.h"
#include "host_tools/lab/result/compare.h"
#include "host_tools/lab/result/result.h"
#include "host_tools/lab/session.h"
#include "host_tools/report/report.h"

#include <cmath>
#include <cstdio>
#include <memory>

namespace traction::cli {

namespace {

struct ExportRequest {
    lab::Request input;
    std::string residuals, firmware, regressors;
};

std::string line(const char *name, double value, const char *comment) {
    char buffer[160];
    std::snprintf(buffer, sizeof buffer, "%s = %.7g # %s\n", name, value, comment);
    return buffer;
}

// The numbers of rover_config_t that a model knows, with the effects that change them folded in.
std::string firmware_text(const lab::Model &model) {
    const lab::WheelSpec &wheel = model.wheel[model.motor_of(0)];
    unsigned motors = 0, mask = 0; // of the firmware's four wheels
    for (std::size_t i = 0; i < model.wheel.size(); ++i)
        if (model.couples() && model.wheel[i].driven && model.motor_of(i) == i) ++motors, mask |= i < 4 ? 1u << i : 0u;
    double KG = wheel.motor.at("torque_constant_Nm_A").value, b = wheel.motor.at("viscous_Nms").value,
           t0 = wheel.motor.at("coulomb_Nm").value;
    double radius = wheel.geometry.at("radius_m").value;
    for (const lab::EffectUse &use : model.effects) {
        if (use.wheel >= 0) continue; // the firmware has one set for all wheels
        const auto value = [&](const char *key) { return use.parameters.count(key) != 0 ? use.parameters.at(key).value : 0.0; };
        if (use.name == "torque_constant") KG *= 1 + value("change");
        if (use.name == "viscous_friction") b += value("coefficient_Nms");
        if (use.name == "coulomb_friction") t0 += value("torque_Nm");
        if (use.name == "wheel_radius") radius *= 1 + value("change");
    }
    return "# parameters for the firmware, from the model \"" + model.name + "\"\nformat = \"traction.firmware/1\"\n" +
           line("wheel_radius_m", radius, "m, under load") + line("torque_constant_Nm_A", KG, "N m/A at the wheel, (17)") +
           line("viscous_Nms", b, "N m s, (18)") + line("coulomb_Nm", t0, "N m, (18)") +
           line("inertia_kg_m2", wheel.motor.at("inertia_kg_m2").value, "kg m^2, (17)") +
           line("resistance_ohm", wheel.motor.at("resistance_ohm").value, "ohm") +
           (motors > 0 ? line("mass_kg", 4 * model.rover.at("mass_kg").value / motors, "kg, four times what a motor's wheels bear") +
                             line("wheel_mask", mask, "the wheels that have a motor")
                       : line("mass_kg", model.rover.at("mass_kg").value, "kg"));
}

void export_all(const ExportRequest &request, Outcome &outcome) {
    outcome.json = {{"schema", "traction.lab/1"}, {"verb", "export"}};
    if (!request.firmware.empty()) {
        const std::string text = firmware_text(lab::read_model(request.input.model));
        report::write_text(text, request.firmware);
        std::printf("wrote %s\n", request.firmware.c_str());
        outcome.json["firmware"] = text;
    }
    if (request.residuals.empty() && request.regressors.empty()) return;
    if (request.input.log.empty()) throw UsageError("--residuals and --regressors need --log LOG");
    const lab::Session session = lab::open_session(request.input);
    if (!request.regressors.empty()) {
        bench_lab::write_regressors(session.model, session.data, request.regressors);
        std::printf("wrote %s\n", request.regressors.c_str());
    }
    if (request.residuals.empty()) return;
    const lab::Comparison comparison = lab::compare(session.model, session.data, true);
    std::string text = "balance,t_s,measured,model,residual,noise,unit\n";
    for (const lab::BalanceComparison &b : comparison.balances)
        for (std::size_t i = 0; i < b.t_s.size(); ++i) {
            char buffer[200];
            std::snprintf(buffer, sizeof buffer, "%s,%.6f,%.9g,%.9g,%.9g,%.9g,%s\n", b.name.c_str(), b.t_s[i], b.measured[i], b.model[i],
                          b.measured[i] - b.model[i], b.noise, b.unit.c_str());
            text += buffer;
        }
    report::write_text(text, request.residuals);
    std::printf("wrote %s\n", request.residuals.c_str());
    const nlohmann::json firmware = outcome.json.value("firmware", nlohmann::json());
    outcome.json = lab::head_json("export", session.model, session.data);
    lab::put_comparison(outcome.json, comparison);
    if (!firmware.is_null()) outcome.json["firmware"] = firmware;
}

} // namespace

Verb verb_export() {
    const auto request = std::make_shared<ExportRequest>();
    return {.name = "export",
            .summary = "residuals as CSV or JSON, a model's numbers for the firmware",
            .options = {log_row(request->input.log, "log (CSV), for residuals and regressors", false),
                        model_row(request->input.model),
                        map_row(request->input.map),
                        {.name = "--residuals",
                         .into = &request->residuals,
                         .help = "write every residual to this CSV",
                         .value = "FILE",
                         .kind = Kind::output},
                        {.name = "--firmware",
                         .into = &request->firmware,
                         .help = "write the firmware's parameters to this file",
                         .value = "FILE",
                         .kind = Kind::output},
                        {.name = "--regressors",
                         .into = &request->regressors,
                         .help = "fit, then write what every candidate effect would change (host_tools/bench_lab/regressors.h)",
                         .value = "FILE",
                         .kind = Kind::output}},
            .run = [request](Outcome &outcome) {
                if (request->residuals.empty() && request->firmware.empty() && request->regressors.empty())
                    throw UsageError("give --residuals FILE, --firmware FILE or --regressors FILE");
                export_all(*request, outcome);
            }};
}

} // namespace traction::cli
