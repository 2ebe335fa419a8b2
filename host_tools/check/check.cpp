#include "check.h"
#include "series.h"

#include <algorithm>
#include <cstdlib>

namespace traction::check {

bool Report::passed() const {
    return std::none_of(findings.begin(), findings.end(), [](const Finding &finding) { return finding.severity == Severity::error; });
}

const Finding *Report::find(const std::string &id, const std::string &signal) const {
    for (const Finding &finding : findings) {
        if (finding.id == id && (signal.empty() || finding.signal == signal)) return &finding;
    }
    return nullptr;
}

const char *severity_name(Severity severity) {
    switch (severity) {
    case Severity::note:
        return "note";
    case Severity::warning:
        return "warning";
    case Severity::error:
        return "error";
    }
    return "";
}

const std::vector<std::string> &error_ids() {
    static const std::vector<std::string> ids = {"axis",
                                                 "clipped",
                                                 "clock_jump",
                                                 "copied",
                                                 "stamps",
                                                 "clock_rate",
                                                 "counter_jump",
                                                 "coupled",
                                                 "dead_sensor",
                                                 "drive_unexplained",
                                                 "heading",
                                                 "late",
                                                 "no_motion",
                                                 "magnitude",
                                                 "not_finite",
                                                 "nothing_to_use",
                                                 "samples_missing",
                                                 "scale",
                                                 "short",
                                                 "sign",
                                                 "stuck_sensor",
                                                 "swapped_wheels",
                                                 "time_unit",
                                                 "unit",
                                                 "unrelated",
                                                 "wheels",
                                                 "wrapped"};
    return ids;
}

namespace {

// What the log's maker says of its rover (header `rover.wheels`) against the model: wheels that push and were not logged would be missing
// from every balance.
void declared_wheels(const log::Log &log, const Machine &machine, std::vector<Finding> &findings) {
    const auto told = log.header.find("rover.wheels");
    if (told == log.header.end() || machine.wheel_y_m.empty() || !machine.on_ground) return;
    const int wheels = std::atoi(told->second.c_str());
    const std::size_t driven = machine.wheel_y_m.size() - machine.free_wheels;
    if (wheels == static_cast<int>(driven)) return;
    findings.push_back(
        {.id = "wheels",
         .severity = Severity::error,
         .signal = "",
         .text = "the log's rover drives " + told->second + " wheels (header rover.wheels), the model has " + std::to_string(driven),
         .mend = "use a model of that rover; traction rover --model makes one of four wheels, or of two and a caster",
         .value = static_cast<double>(wheels)});
}

// Its two motors (header `rover.drives`) against the model: the wheels of a side that have none would be taken to stand.
void declared_drives(const log::Log &log, const Machine &machine, std::vector<Finding> &findings) {
    const auto told = log.header.find("rover.drives");
    if (told == log.header.end() || machine.wheel_y_m.empty() || !machine.on_ground || !machine.motor_of_wheel.empty()) return;
    findings.push_back({.id = "wheels",
                        .severity = Severity::error,
                        .signal = "",
                        .text = "the log's rover has two motors, at the wheels " + told->second +
                                " (header rover.drives), in the model every wheel has its own",
                        .mend = "say so in the model: drives = [LEFT, RIGHT] under [rover]",
                        .value = 2});
}

// Its wheels that steer (header `rover.steering`): the models' wheels keep the body's heading, and a bend would look like slip.
void declared_steering(const log::Log &log, const Machine &machine, std::vector<Finding> &findings) {
    const auto told = log.header.find("rover.steering");
    if (told == log.header.end() || machine.wheel_y_m.empty() || !machine.on_ground) return;
    findings.push_back(
        {.id = "wheels",
         .severity = Severity::error,
         .signal = "",
         .text = "the log's rover steers its wheels (header rover.steering = " + told->second + "), the model's keep their heading",
         .mend = "none: the lab has no model of a rover that steers",
         .value = 0});
}

} // namespace

Report check(const log::Log &log, const std::vector<log::Repair> &repairs, const Machine &machine) {
    Report report;
    const Grid grid = make_grid(log, machine);
    check_quality(log, repairs, grid, report.findings, report.rates);
    declared_wheels(log, machine, report.findings);
    declared_drives(log, machine, report.findings);
    declared_steering(log, machine, report.findings);
    if (grid.count >= 50) { // 2.5 s
        check_magnitudes(grid, report.findings);
        check_drives(grid, machine, report.findings);
        check_motion(grid, machine, report.findings);
        check_scales(grid, machine, report.findings);
        check_clock(log, grid, machine, report.findings);
        check_misplaced(log, grid, machine, report.findings);
        report.excitation = measure_excitation(grid);
        judge_excitation(report.excitation, grid, report.findings);
    }
    std::stable_sort(report.findings.begin(), report.findings.end(),
                     [](const Finding &a, const Finding &b) { return a.severity > b.severity; });
    return report;
}

Report check_file(const std::string &path, const std::string &map_path, const Machine &machine) {
    std::vector<log::Repair> repairs;
    try {
        const log::Log log = log::read_csv(path, map_path, repairs);
        return check(log, repairs, machine);
    } catch (const log::ClockJump &jump) {
        Report report;
        report.findings.push_back({.id = "clock_jump",
                                   .severity = Severity::error,
                                   .signal = "",
                                   .text = jump.what(),
                                   .mend = "correct the times from that line on, or cut the file there",
                                   .value = static_cast<double>(jump.line)});
        return report;
    }
}

} // namespace traction::check
