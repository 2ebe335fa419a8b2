#include "between_runs.h"

#include "host_tools/lab/fit/distribution.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/inputs/begin_runs.h"
#include "host_tools/lab/inputs/join_runs.h"
#include "host_tools/lab/inputs/smooth.h"
#include "host_tools/lab/result/append.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace traction::lab {

namespace {

constexpr double by_chance = 0.05; // of one that differs, for all parameters together
constexpr double many = 1000;      // degrees of freedom of what is known: a chi-squared
constexpr double normal_95 = 1.96;

void judge(BetweenRuns &one) {
    double weights = 0, mean = 0, sum = 0;
    const auto precision = [&](std::size_t i) { return std::pow(normal_95 / one.half_width[i], 2); };
    for (std::size_t i = 0; i < one.value.size(); ++i) weights += precision(i), mean += precision(i) * one.value[i];
    mean /= weights;
    for (std::size_t i = 0; i < one.value.size(); ++i) sum += precision(i) * std::pow(one.value[i] - mean, 2);
    one.times = std::sqrt(sum / static_cast<double>(one.value.size() - 1));
}

} // namespace

std::vector<FittedValue> fitted_values(const Model &model) {
    std::vector<FittedValue> list;
    const auto put_table = [&](const std::string &owner, const Parameters &table, const std::string &tail = "", bool of_run = false) {
        for (const auto &[key, p] : table)
            if (std::isfinite(p.low)) list.push_back({owner + "." + key + tail, p, of_run});
    };
    const WheelSpec &first = model.wheel.front();
    put_table("rover", model.rover), put_table("wheel", first.geometry), put_table("motor", first.motor);
    put_table("soil", first.soil), put_table("sensors", model.sensors);
    for (std::size_t i = 1; i < model.wheel.size(); ++i) {
        const WheelSpec &wheel = model.wheel[i];
        for (const auto &[owner, table, shared] :
             {std::tuple{"wheel.", &wheel.geometry, &first.geometry}, std::tuple{"motor.", &wheel.motor, &first.motor},
              std::tuple{"soil.", &wheel.soil, &first.soil}})
            for (const auto &[key, p] : *table)
                if (std::isfinite(p.low) && p.value != shared->at(key).value)
                    list.push_back({owner + key + " on wheel " + std::to_string(i), p});
    }
    for (const RunSpec &run : model.runs)
        put_table("soil", run.soil, " in " + run.log, true), put_table("sensors", run.sensors, " in " + run.log, true);
    for (const EffectUse &use : model.effects)
        put_table(use.name, use.parameters, use.wheel >= 0 ? " on wheel " + std::to_string(use.wheel) : "");
    return list;
}

std::vector<BetweenRuns> between_runs(const Session &session) {
    std::vector<BetweenRuns> list;
    if (session.runs.size() < 2) return list;
    std::size_t runs = 0;
    for (const log::Log &run : session.runs) {
        Model model = session.model;
        begin_runs(model, {run}, {first_time(run)});
        const Dataset data = make_dataset(model, run);
        if (data.balance.empty() || data.count < 3) continue;
        fit_model(model, data, "alone");
        ++runs;
        for (const FittedValue &fitted : fitted_values(model)) {
            const double half_width = 0.5 * (fitted.parameter.high - fitted.parameter.low);
            if (fitted.of_run || !(half_width > 0)) continue;
            auto one = std::find_if(list.begin(), list.end(), [&](const BetweenRuns &b) { return b.parameter == fitted.name; });
            if (one == list.end()) one = list.insert(list.end(), BetweenRuns{fitted.name, fitted.parameter.unit, {}, {}});
            one->value.push_back(fitted.parameter.value), one->half_width.push_back(half_width);
        }
    }
    std::erase_if(list, [&](const BetweenRuns &one) { return one.value.size() < std::max<std::size_t>(2, runs); });
    for (BetweenRuns &one : list) {
        judge(one);
        one.differs = f_tail(one.times * one.times, static_cast<double>(runs - 1), many) * static_cast<double>(list.size()) < by_chance;
    }
    return list;
}

std::string between_runs_text(const std::vector<BetweenRuns> &list) {
    if (list.empty()) return "";
    std::string text;
    std::vector<double> times;
    std::size_t apart = 0;
    bool ground = false;
    for (const BetweenRuns &one : list) times.push_back(one.times), apart += one.differs ? 1 : 0;
    append(text, "between runs: each fitted by itself, their numbers scatter %.2g times what their\nintervals allow (median of %zu)%s\n",
           median(times), list.size(), apart == 0 ? "; none differs beyond chance" : "; beyond chance differ");
    for (const BetweenRuns &one : list) {
        if (!one.differs) continue;
        ground = ground || one.parameter.rfind("soil.", 0) == 0;
        append(text, "  %-34s %4.1f times:", one.parameter.c_str(), one.times);
        for (std::size_t i = 0; i < one.value.size(); ++i) append(text, "%s %.4g", i == 0 ? "" : ",", one.value[i]);
        append(text, "%s%s\n", one.unit == "1" ? "" : " ", one.unit == "1" ? "" : one.unit.c_str());
    }
    if (ground) text += "a soil's number that differs: state each run's ground ([[run]] in the model file)\n";
    return text;
}

nlohmann::json between_runs_json(const std::vector<BetweenRuns> &list) {
    nlohmann::json out = nlohmann::json::array();
    for (const BetweenRuns &one : list)
        out.push_back({{"parameter", one.parameter},
                       {"unit", one.unit},
                       {"value", one.value},
                       {"half_width", one.half_width},
                       {"times", one.times},
                       {"differs", one.differs}});
    return out;
}

} // namespace traction::lab
