#include "begin_runs.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

namespace traction::lab {

namespace {

// "run2/log.csv" is the name of "/data/run2/log.csv".
bool is_named(const std::string &source, const std::string &name) {
    return source == name || (source.size() > name.size() && source.ends_with("/" + name));
}

// As much of its path, from the end, as no other has.
std::string own_name(const std::string &source, const std::vector<log::Log> &runs) {
    std::size_t slash = source.size();
    while (slash != std::string::npos && slash > 0) {
        slash = source.rfind('/', slash - 1);
        const std::string name = slash == std::string::npos ? source : source.substr(slash + 1);
        if (std::none_of(runs.begin(), runs.end(), [&](const log::Log &run) { return run.source != source && is_named(run.source, name); }))
            return name;
    }
    return source;
}

// The model's entry of a log; a new one where it has none. Throws ModelError where the entry's name is that of another log too.
RunSpec &run_of(Model &model, const log::Log &log, const std::vector<log::Log> &runs) {
    for (RunSpec &run : model.runs) {
        if (!is_named(log.source, run.log)) continue;
        if (std::any_of(runs.begin(), runs.end(),
                        [&](const log::Log &other) { return other.source != log.source && is_named(other.source, run.log); }))
            throw ModelError(model.file, 0, "run.log", "\"" + run.log + "\" is the name of two of the logs",
                             "write as much of the path there as tells them apart, such as \"" + own_name(log.source, runs) + "\"");
        return run;
    }
    RunSpec run;
    run.log = own_name(log.source, runs);
    model.runs.push_back(std::move(run));
    return model.runs.back();
}

void give_offset(const Model &model, const log::Log &log, const char *key, const char *signal, RunSpec &run) {
    const log::Signal *found = log.find(signal);
    const auto machine = model.sensors.find(key);
    if (run.sensors.count(key) != 0 || found == nullptr || found->value.empty() || machine == model.sensors.end()) return;
    if (machine->second.fixed || !(machine->second.prior > 0)) return;
    Parameter &own = run.sensors[key] = machine->second;
    own.given = true;
    own.source = "of this run";
    if (const auto stated = log.header.find(std::string("bias.") + signal); stated != log.header.end())
        if (const double deviation = std::atof(stated->second.c_str()); deviation > 0) own.prior = deviation;
}

} // namespace

void begin_runs(Model &model, const std::vector<log::Log> &runs, const std::vector<double> &start_s) {
    for (RunSpec &run : model.runs) run.start_s = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < runs.size() && i < start_s.size(); ++i) {
        const bool known =
            std::any_of(model.runs.begin(), model.runs.end(), [&](const RunSpec &run) { return is_named(runs[i].source, run.log); });
        if (runs.size() < 2 && !known) continue;
        RunSpec &run = run_of(model, runs[i], runs);
        if (!std::isnan(run.start_s)) continue; // the same file once more: as it was
        run.start_s = start_s[i];
        if (runs.size() < 2) continue;
        give_offset(model, runs[i], "accel.bias_m_s2", "imu.accel_x_m_s2", run);
        give_offset(model, runs[i], "gyro.bias_rad_s", "imu.gyro_z_rad_s", run);
    }
}

} // namespace traction::lab
