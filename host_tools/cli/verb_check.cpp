// traction check LOG: is this log fit to learn from? Data quality, signs and units, and what the drive did not excite.
#include "rows.h"
#include "verbs.h"

#include "host_tools/check/check.h"
#include "host_tools/lab/gate.h"
#include "host_tools/lab/model/model.h"

#include <cmath>
#include <cstdio>
#include <memory>

namespace traction::cli {

namespace {

struct CheckOptions {
    std::string log, map, model;
};

nlohmann::json excitation_json(const check::Excitation &e) {
    nlohmann::json wheels = nlohmann::json::array();
    for (const check::WheelExcitation &w : e.wheel) {
        wheels.push_back({{"wheel", w.wheel},
                          {"speed_min_rad_s", w.speed_min_rad_s},
                          {"speed_max_rad_s", w.speed_max_rad_s},
                          {"slip_low", w.slip_low},
                          {"slip_high", w.slip_high},
                          {"accel_rms_rad_s2", w.accel_rms_rad_s2},
                          {"current_low_A", w.current_low_A},
                          {"current_high_A", w.current_high_A}});
    }
    return {{"duration_s", e.duration_s},         {"speed_min_m_s", e.speed_min_m_s},
            {"speed_max_m_s", e.speed_max_m_s},   {"reverse_s", e.reverse_s},
            {"accel_rms_m_s2", e.accel_rms_m_s2}, {"starts", e.starts},
            {"standstill_s", e.standstill_s},     {"moving_s", e.moving_s},
            {"turning_s", e.turning_s},           {"yaw_rate_max_rad_s", e.yaw_rate_max_rad_s},
            {"revisited", e.revisited},           {"path_m", e.path_m},
            {"wheels_apart", e.wheels_apart},     {"slip_low", e.slip_low},
            {"slip_high", e.slip_high},           {"constant_input", e.constant_input},
            {"duty_saturated", e.duty_saturated}, {"wheels", wheels}};
}

nlohmann::json report_json(const CheckOptions &options, const check::Report &report) {
    nlohmann::json findings = nlohmann::json::array(), rates = nlohmann::json::array();
    for (const check::Finding &f : report.findings) {
        findings.push_back({{"id", f.id},
                            {"severity", check::severity_name(f.severity)},
                            {"signal", f.signal},
                            {"text", f.text},
                            {"mend", f.mend},
                            {"value", f.value},
                            {"t0_s", f.t0_s},
                            {"t1_s", f.t1_s}});
    }
    for (const check::Rate &r : report.rates) {
        rates.push_back({{"signal", r.signal},
                         {"samples", r.samples},
                         {"median_s", r.median_s},
                         {"jitter", r.jitter},
                         {"missing", r.missing},
                         {"largest_gap_s", r.largest_gap_s}});
    }
    return {
        {"schema", "traction.check/1"}, {"log", options.log},   {"map", options.map}, {"model", options.model},
        {"passed", report.passed()},    {"findings", findings}, {"rates", rates},     {"excitation", excitation_json(report.excitation)}};
}

void print_report(const CheckOptions &options, const check::Report &report) {
    int count[3] = {};
    for (const check::Finding &finding : report.findings) {
        ++count[static_cast<int>(finding.severity)];
        std::printf("%-7s  %-16s  %s\n%27s-> %s\n", check::severity_name(finding.severity), finding.id.c_str(), finding.text.c_str(), "",
                    finding.mend.c_str());
    }
    const check::Excitation &e = report.excitation;
    if (e.duration_s > 0) {
        std::printf("drive: %.1f s, %.1f s moving, %.1f s in reverse, %d starts, longest standstill %.1f s\n", e.duration_s, e.moving_s,
                    e.reverse_s, e.starts, e.standstill_s);
        if (std::isfinite(e.speed_max_m_s))
            std::printf("       speed %.2f to %.2f m/s, slip %.2f to %.2f, acceleration %.2f m/s^2 rms\n", e.speed_min_m_s, e.speed_max_m_s,
                        e.slip_low, e.slip_high, e.accel_rms_m_s2);
    }
    std::printf("%s: %d errors, %d warnings, %d notes: %s\n", options.log.c_str(), count[2], count[1], count[0],
                report.passed() ? "fit to learn from" : "NOT fit to learn from until the errors are mended");
}

void run_check(const CheckOptions &options, Outcome &outcome) {
    const check::Machine machine = options.model.empty() ? check::Machine{} : lab::machine_of(lab::read_model(options.model));
    const check::Report report = check::check_file(options.log, options.map, machine);
    print_report(options, report);
    outcome.json = report_json(options, report);
    outcome.exit_code = report.passed() ? exit_done : exit_negative;
}

} // namespace

Verb verb_check() {
    const auto options = std::make_shared<CheckOptions>();
    return {.name = "check",
            .summary = "judge a log before anything is learnt from it: samples, signs, units, excitation",
            .options = {log_row(options->log, "the log"),
                        map_row(options->map),
                        {.name = "--model",
                         .into = &options->model,
                         .help = "what is known of the machine: units are then told by their factor",
                         .value = "FILE",
                         .kind = Kind::model}},
            .run = [options](Outcome &outcome) { run_check(*options, outcome); }};
}

} // namespace traction::cli
