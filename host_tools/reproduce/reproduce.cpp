#include "reproduce.h"

#include "measure.h"

#include <algorithm>

namespace traction {

bool Experiment::agrees() const {
    return std::all_of(checks.begin(), checks.end(), [](const Check &check) { return check.pass(); });
}

nlohmann::json reproduce(const ReproduceSettings &settings) {
    SoilTable soil;
    std::vector<Experiment> all{bench_curve(settings)};
    if (!settings.bench_data.empty()) all.push_back(measured_bench(settings));
    all.push_back(radar_spectrum(settings));
    all.push_back(fused_speed(settings));
    all.push_back(sweep_in_time(settings));
    all.push_back(soil_identification(settings, soil));
    all.push_back(blocked_wheels(settings));
    all.push_back(slip_servo(settings));

    nlohmann::json page{{"schema", "traction.figures/1"},
                        {"title", "The paper's experiments, made again"},
                        {"intro", "Lhomme-Desages, Grand, Ben Amar, Guinot: Doppler-based ground speed sensor fusion and slip control for a wheeled rover. Our firmware on our simulator, "
                                  "figure by figure, the paper's number beside ours. Section VII of the paper, control and path tracking at speed, is its future work and is not made here."},
                        {"figures", nlohmann::json::array()},
                        {"tables", nlohmann::json::array()},
                        {"checks", nlohmann::json::array()}};
    bool pass = true;
    nlohmann::json closing = nlohmann::json::array();
    for (const Experiment &e : all) {
        page["figures"].push_back({{"id", e.id}, {"title", e.title}, {"paper", e.paper}, {"ours", e.ours}, {"verdict", e.agrees() ? "agrees" : "differs"}, {"svg", e.svg}, {"notes", e.notes}});
        for (const Check &check : e.checks) {
            page["checks"].push_back({{"id", e.id}, {"what", check.what}, {"paper", check.paper}, {"value", check.value}, {"low", check.low}, {"high", check.high}, {"unit", check.unit}, {"pass", check.pass()}});
            closing.push_back({e.id, check.what, check.paper, check.value, check.low, check.high, check.unit, check.pass() ? "within" : "outside", check.why});
        }
        pass = pass && e.agrees();
    }
    page["tables"].push_back({{"title", "Table III from noisy logs, mean and standard deviation over " + std::to_string(settings.seeds) + " seeds"},
                              {"columns", {"ground", "estimator", "Fm, paper [N]", "Fm, mean [N]", "std [N]", "sc, paper", "sc, mean", "std"}},
                              {"rows", soil.rows}});
    page["tables"].push_back({{"title", "Every figure of merit against its bound"},
                              {"columns", {"figure", "what", "paper", "ours", "low", "high", "unit", "verdict", "where the bound comes from"}},
                              {"rows", closing}});
    page["pass"] = pass;
    return page;
}

} // namespace traction
