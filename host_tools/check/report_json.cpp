#include "report_json.h"

namespace traction::check {

namespace {

nlohmann::json excitation_json(const Excitation &e) {
    nlohmann::json wheels = nlohmann::json::array();
    for (const WheelExcitation &w : e.wheel) {
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

} // namespace

nlohmann::json report_json(const Report &report, const std::string &log, const std::string &map, const std::string &model) {
    nlohmann::json findings = nlohmann::json::array(), rates = nlohmann::json::array();
    for (const Finding &f : report.findings) {
        findings.push_back({{"id", f.id},
                            {"severity", severity_name(f.severity)},
                            {"signal", f.signal},
                            {"text", f.text},
                            {"mend", f.mend},
                            {"value", f.value},
                            {"t0_s", f.t0_s},
                            {"t1_s", f.t1_s}});
    }
    for (const Rate &r : report.rates) {
        rates.push_back({{"signal", r.signal},
                         {"samples", r.samples},
                         {"median_s", r.median_s},
                         {"jitter", r.jitter},
                         {"missing", r.missing},
                         {"largest_gap_s", r.largest_gap_s}});
    }
    return {{"schema", "traction.check/1"}, {"log", log},           {"map", map},     {"model", model},
            {"passed", report.passed()},    {"findings", findings}, {"rates", rates}, {"excitation", excitation_json(report.excitation)}};
}

} // namespace traction::check
