#include "validate.h"

#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/fit/problem.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/inputs/begin_runs.h"
#include "host_tools/lab/inputs/join_runs.h"

#include <cmath>
#include <cstdio>

namespace traction::lab {

namespace {

constexpr double least_better = 0.01; // of the error of a run that was left out: assumed

void fix(Parameters &table) {
    for (auto &[key, p] : table) p.fixed = key != "accel.bias_m_s2" && key != "gyro.bias_rad_s";
}

// Error of a model on a run, its values as they stand but for what is the run's own: `stated` of it, and found.
double error_on(const Model &model, const Model &stated, const log::Log &run) {
    Model judged = model;
    judged.runs = stated.runs;
    begin_runs(judged, {run}, {first_time(run)});
    fix(judged.rover), fix(judged.sensors);
    for (WheelSpec &wheel : judged.wheel) fix(wheel.geometry), fix(wheel.motor), fix(wheel.soil);
    for (EffectUse &use : judged.effects) fix(use.parameters);
    const Dataset data = make_dataset(judged, run);
    if (data.balance.empty() || data.count < 3) return std::nan("");
    const Physics physics = make_physics(judged);
    Problem problem(data, physics, free_parameters(judged, physics));
    problem.fit({.iterations = 2});
    return overall_error(problem);
}

std::string base_name(const std::string &path) { return path.substr(path.find_last_of('/') + 1); }

} // namespace

std::vector<Validation> validate(const Session &session, const Request &request, const Model &result) {
    std::vector<Validation> out;
    for (std::size_t i = 0; i < session.runs.size() && session.runs.size() > 1; ++i) {
        std::vector<log::Log> others;
        for (std::size_t j = 0; j < session.runs.size(); ++j)
            if (j != i) others.push_back(session.runs[j]);
        const JoinedRuns joined = join_runs(others);
        Model plain = session.model, full = result;
        begin_runs(plain, others, joined.start_s), begin_runs(full, others, joined.start_s);
        const Dataset data = make_dataset(plain, joined.log);
        fit_model(plain, data, "fitted"), fit_model(full, data, "result");
        const log::Log &run = session.runs[i];
        out.push_back({base_name(run.source), error_on(session.model, session.model, run), error_on(plain, session.model, run),
                       error_on(full, session.model, run), true});
    }
    if (request.validate.empty()) return out;
    Model plain = session.model, full = result;
    fit_model(plain, session.data, "fitted"), fit_model(full, session.data, "result");
    for (const std::string &file : request.validate) {
        std::vector<std::string> told, despite;
        const log::Log run = checked_log(request, file, request.map_of_validation(), session.model, told, despite);
        out.push_back({base_name(file), error_on(session.model, session.model, run), error_on(plain, session.model, run),
                       error_on(full, session.model, run), false});
    }
    return out;
}

bool predicts_no_run(const std::vector<Validation> &list) {
    std::size_t left_out = 0, better = 0;
    for (const Validation &v : list)
        left_out += v.left_out ? 1 : 0, better += v.left_out && v.result < (1 - least_better) * v.fitted ? 1 : 0;
    return left_out > 0 && better == 0;
}

std::string validation_text(const std::vector<Validation> &list) {
    if (list.empty()) return "";
    char buffer[300];
    std::snprintf(buffer, sizeof buffer, "%-30s %9s %9s %9s\n", "validation, error x noise", "stated", "fitted", "result");
    std::string text = buffer;
    for (const Validation &v : list) {
        std::snprintf(buffer, sizeof buffer, "%-30s %9.3f %9.3f %9.3f  %s\n", v.log.c_str(), v.stated, v.fitted, v.result,
                      v.left_out ? "left out in turn" : "never fitted");
        text += buffer;
    }
    return text;
}

nlohmann::json validation_json(const std::vector<Validation> &list) {
    const auto finite = [](double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr); };
    nlohmann::json out = nlohmann::json::array();
    for (const Validation &v : list)
        out.push_back({{"log", v.log},
                       {"stated", finite(v.stated)},
                       {"fitted", finite(v.fitted)},
                       {"result", finite(v.result)},
                       {"left_out", v.left_out}});
    return out;
}

} // namespace traction::lab
