// traction check LOG: is this log fit to learn from? Data quality, signs and units, and what the drive did not excite.
#include "rows.h"
#include "verbs.h"

#include "host_tools/check/report_json.h"
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
    outcome.json = check::report_json(report, options.log, options.map, options.model);
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
