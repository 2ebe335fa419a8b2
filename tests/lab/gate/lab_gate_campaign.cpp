// lab_gate_campaign - the corpus of spoilt logs and wrong models, and the gate's false alarms on sound ones (docs/lab_benchmark.md).
//
//   lab_gate_campaign sound [FIRST COUNT]     refusals among COUNT sound logs
//   lab_gate_campaign spoilt [check] [BASE]   every spoilt log: refused, or its verdict
//   lab_gate_campaign wrong [check] [BASE]    every wrong model
#include "spoil.h"

#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/decision/doubt.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/gate.h"

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <map>
#include <string>

namespace {

using namespace traction;
using namespace traction::gate;

int sound(std::uint64_t first, std::uint64_t count) {
    std::uint64_t refused = 0;
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        const Sound log = sound_log(seed, 120);
        for (const bool known : {false, true}) {
            const check::Report report = check::check(log.log, {}, known ? lab::machine_of(log.model) : check::Machine{});
            if (report.passed()) continue;
            ++refused;
            std::printf("%s%s\n", log.about.c_str(), known ? " (machine known)" : "");
            for (const check::Finding &f : report.findings)
                if (f.severity == check::Severity::error) std::printf("    %s [%s] %s\n", f.id.c_str(), f.signal.c_str(), f.text.c_str());
        }
        std::fflush(stdout);
    }
    std::printf("%llu sound logs, each with the machine known and not: %llu refused\n", static_cast<unsigned long long>(count),
                static_cast<unsigned long long>(refused));
    return refused == 0 ? 0 : 1;
}

int spoilt(const std::vector<Row> &rows, bool check_only, const std::string &only) {
    std::map<std::string, int> count;
    int bad = 0;
    for (const std::string &name : base_names()) {
        if (!only.empty() && name != only) continue;
        const Base b = base(name, 120);
        for (const Row &row : rows) {
            const Outcome end = judge(b, row, check_only);
            ++count[end.end];
            bad += end.good() || end.end == "passed" ? 0 : 1;
            std::printf("%-8s %-48s %-12s %s\n", name.c_str(), row.name.c_str(), end.end.c_str(), end.text.substr(0, 150).c_str());
            std::fflush(stdout);
        }
    }
    for (const auto &[end, n] : count) std::printf("%s %d  ", end.c_str(), n);
    std::printf("\n");
    return bad == 0 ? 0 : 1;
}

void metric(const std::string &about, const lab::Model &model, const log::Log &log) {
    const lab::Dataset data = lab::make_dataset(model, log);
    const lab::Diagnosis d = lab::diagnose(model, data, {});
    const lab::Physics physics = lab::make_physics(d.model);
    lab::Problem problem(data, physics, lab::free_parameters(d.model, physics));
    problem.fit({});
    std::printf("%-60s %s:", about.c_str(), d.kind.c_str());
    for (const std::string &e : d.effects) std::printf(" %s", e.c_str());
    std::printf(" | base %.2f final %.2f now %.2f |", d.ladder.front().train, d.ladder.back().train, lab::overall_error(problem));
    const std::vector<double> m = lab::misfits(problem);
    for (std::size_t b = 0; b < m.size(); ++b) std::printf(" %.2f", m[b]);
    std::printf(" |");
    const std::vector<lab::Suspect> s = lab::gross_errors(model, data);
    for (std::size_t i = 0; i < s.size() && i < 3; ++i)
        std::printf(" %s x %.3g: %.2f;", s[i].quantity.c_str(), s[i].fitted / s[i].stated, s[i].error);
    std::printf("\n");
    std::fflush(stdout);
}

} // namespace

int main(int argc, char **argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    try {
        if (what == "sound") return sound(argc > 2 ? std::stoull(argv[2]) : 1, argc > 3 ? std::stoull(argv[3]) : 300);
        const bool check_only = argc > 2 && std::strcmp(argv[2], "check") == 0;
        const std::string only = argc > (check_only ? 3 : 2) ? argv[check_only ? 3 : 2] : "";
        if (what == "metric") {
            for (std::uint64_t seed = 1; seed <= 40; ++seed) {
                const Sound log = sound_log(seed, 120);
                metric(log.about, log.model, log.log);
            }
            return 0;
        }
        if (what == "metric_wrong") {
            for (const std::string name : {"plant", "counts"}) {
                const Base b = base(name, 120);
                for (const auto *rows : {&wrong_models(), &spoilt_logs()})
                    for (const Row &row : *rows) {
                        if (judge(b, row, true).end != "passed") continue;
                        log::Log log = b.log;
                        lab::Model model = b.model;
                        if (row.spoil) row.spoil(log);
                        if (row.mistake) row.mistake(model);
                        metric(name + " " + row.name, model, log);
                    }
            }
            return 0;
        }
        if (what == "spoilt") return spoilt(spoilt_logs(), check_only, only);
        if (what == "wrong") return spoilt(wrong_models(), check_only, only);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "lab_gate_campaign: %s\n", error.what());
        return 3;
    }
    std::fprintf(stderr, "lab_gate_campaign sound [FIRST COUNT] | spoilt [check] [BASE] | wrong [check] [BASE]\n");
    return 2;
}
