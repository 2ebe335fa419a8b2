#include "gate.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace {

double positive_value(const Parameters &parameters, const char *key) {
    const auto found = parameters.find(key);
    return found != parameters.end() && found->second.value > 0 ? found->second.value : std::nan("");
}

bool is_in(const std::vector<std::string> &list, const std::string &id) { return std::find(list.begin(), list.end(), id) != list.end(); }

} // namespace

check::Machine machine_of(const Model &model) {
    check::Machine machine;
    if (model.wheel.empty()) return machine;
    machine.wheel_radius_m = positive_value(model.wheel[0].geometry, "radius_m");
    machine.back_emf_Vs = positive_value(model.wheel[0].motor, "back_emf_Vs_rad");
    if (std::isnan(machine.back_emf_Vs)) machine.back_emf_Vs = positive_value(model.wheel[0].motor, "torque_constant_Nm_A");
    machine.resistance_ohm = positive_value(model.wheel[0].motor, "resistance_ohm");
    machine.battery_V = positive_value(model.rover, "battery_voltage_V");
    if (const auto counts = model.sensors.find("encoder.counts_per_turn"); counts != model.sensors.end() && counts->second.given)
        machine.counts_per_turn = counts->second.value;
    machine.wheels_point_forward = model.motion != BodyMotion::none;
    machine.on_ground = model.motion != BodyMotion::none;
    machine.unsigned_current = model.unsigned_current;
    machine.rolls_freely = model.motion != BodyMotion::imposed;
    for (const WheelSpec &wheel : model.wheel) {
        const auto heading = wheel.geometry.find("heading_rad");
        const bool askew = heading != wheel.geometry.end() && std::fabs(heading->second.value) > 0.01;
        if (wheel.driven && (!wheel.grips_sideways || askew)) machine.wheels_point_forward = false;
        machine.free_wheels += wheel.driven ? 0 : 1;
        const auto y = wheel.geometry.find("y_m");
        machine.wheel_y_m.push_back(y != wheel.geometry.end() ? y->second.value : 0);
    }
    for (std::size_t i = 0; i < model.wheel.size() && model.couples(); ++i)
        machine.motor_of_wheel.push_back(static_cast<int>(model.motor_of(i)));
    return machine;
}

std::vector<std::string> pass_gate(const check::Report &report, const std::string &log_file, const std::vector<std::string> &despite,
                                   std::vector<std::string> &overridden) {
    for (const std::string &id : despite)
        if (!is_in(check::error_ids(), id))
            throw ModelError(log_file, 0, "--despite", "names \"" + id + "\", which is no finding of the check",
                             "give the id that `traction check` prints, such as sign or unit");
    std::string errors, ids;
    std::size_t count = 0;
    std::vector<std::string> told;
    for (const check::Finding &f : report.findings) {
        if (f.severity == check::Severity::warning) told.push_back("check: " + f.id + ": " + f.text);
        if (f.severity != check::Severity::error) continue;
        if (is_in(despite, f.id)) {
            told.push_back("DESPITE the check's error \"" + f.id + "\": " + f.text);
            if (!is_in(overridden, f.id)) overridden.push_back(f.id);
            continue;
        }
        ++count;
        errors += "\n  error " + f.id + (f.signal.empty() ? "" : " [" + f.signal + "]") + ": " + f.text + "\n    mend: " + f.mend;
        if (ids.find("--despite " + f.id + " ") == std::string::npos) ids += "--despite " + f.id + " ";
    }
    if (count == 0) return told;
    ids.pop_back();
    throw Refused(log_file + ": is not fit to learn from (" + std::to_string(count) + (count == 1 ? " error" : " errors") +
                  " of the check)" + errors + "\n  nothing was learnt; mend the log or its map (docs/log_format.md), or go on aloud with " +
                  ids);
}

} // namespace traction::lab
