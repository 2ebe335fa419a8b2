#include "addition.h"

#include "host_tools/lab/decision/patch_edges.h"
#include "host_tools/lab/fit/heldout.h"
#include "host_tools/lab/fit/identify.h"
#include "host_tools/lab/fit/screen.h"
#include "result.h"
#include "words.h"

#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace traction::lab {

void append_lineage(Model &model, const Dataset &data, const std::vector<LadderStep> &ladder, const LadderStep &final_step) {
    for (std::size_t i = 0; i < ladder.size(); ++i) {
        if (i == 0 && !model.lineage.empty()) continue; // the baseline is the last entry already
        const bool last = i + 1 == ladder.size();
        const LadderStep &r = last && std::isfinite(final_step.train) ? final_step : ladder[i];
        std::string despite;
        for (const std::string &id : data.despite) despite += (despite.empty() ? "" : " ") + id;
        model.lineage.push_back({ladder[i].label, data.log_file, data.date, r.train, r.heldout, ladder[i].floor, despite});
    }
}

namespace {

std::string on_wheel(int wheel) { return wheel >= 0 ? " on wheel " + std::to_string(wheel) : ""; }

void refuse_turned(const Model &model, const EffectUse &use) {
    const int motor = use.wheel < 0 ? -1 : model.wheel[static_cast<std::size_t>(use.wheel)].drive;
    if (motor < 0 || !acts_on_motor(use)) return;
    throw ModelError(model.file, 0, "--wheel",
                     "is " + std::to_string(use.wheel) + ", which turns with wheel " + std::to_string(motor) + ", and " + use.name +
                         " is on a motor",
                     "give --wheel " + std::to_string(motor));
}

// Whose own size, and it is away from zero, changes nothing that the log holds: its interval would be that of no datum at all.
void refuse_dead(const Model &model, const EffectUse &use, const Problem &fitted) {
    bool any = false;
    for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
        const FreeParameter &p = fitted.parameters[i];
        if (p.owner != use.name || p.wheel != use.wheel) continue;
        any = true;
        if (!is_dead(fitted, i) || p.base + fitted.theta[static_cast<Eigen::Index>(i)] == 0) return;
    }
    if (any)
        throw ModelError(model.file, 0, use.name, "changes nothing that this log holds" + on_wheel(use.wheel),
                         "add it where a motor or a sensor of the log feels it, or drive so that it matters");
}

} // namespace

Added add_effect(const Model &model, const Dataset &data, const std::string &effect, int wheel, const std::string &file) {
    Added added;
    added.model = model;
    if (wheel < -1 || wheel >= static_cast<int>(model.wheel.size()))
        throw ModelError(model.file, 0, "--wheel", "is " + std::to_string(wheel),
                         "wheels are 0 to " + std::to_string(model.wheel.size() - 1));
    if (model.find_effect(effect, wheel) != nullptr)
        throw ModelError(model.file, 0, effect, "is in the model already", "use `traction fit` to fit it, `traction drop` to take it out");
    if (!file.empty()) {
        std::ifstream stream(file, std::ios::binary);
        if (!stream.is_open())
            throw std::ios_base::failure("cannot open " + file, std::make_error_code(std::errc::no_such_file_or_directory));
        std::ostringstream text;
        text << stream.rdbuf();
        Model bare = model;
        bare.effects.clear();
        bare.lineage.clear();
        const Model with = parse_model(model_text(bare) + "\n" + text.str(), file);
        const auto found = std::find_if(with.effects.begin(), with.effects.end(), [&](const EffectUse &use) { return use.name == effect; });
        if (found == with.effects.end())
            throw ModelError(file, 0, "effect.name", "there is no effect \"" + effect + "\" in it",
                             "give the name of one of its [[effect]] tables");
        added.model.effects.push_back(*found);
        added.model.effects.back().wheel = wheel >= 0 ? wheel : found->wheel;
        refuse_turned(model, added.model.effects.back());
    } else {
        const sim::Effect *known = sim::find_effect(effect);
        if (known == nullptr)
            throw ModelError(model.file, 0, effect, "is no effect of the catalogue",
                             "`traction effects` lists them; for your own use --effect-file");
        refuse_turned(model, {effect, wheel, {}, "", ""});
        if (wheel >= 0 && !known->per_wheel) throw ModelError(model.file, 0, effect, "cannot be confined to a wheel", "leave --wheel out");
        Problem problem = fitted_problem(model, data);
        const Screen screen(problem);
        double best = -1e300;
        EffectUse use;
        for (const Candidate &c : catalogue_candidates(model, data, problem.forward().motion())) {
            if (c.effect != effect || c.wheel != wheel) continue;
            Physics at = problem.physics();
            c.prepare(at);
            Eigen::MatrixXd columns(problem.row_scale.size(), static_cast<Eigen::Index>(c.strengths.size()));
            for (std::size_t j = 0; j < c.strengths.size(); ++j)
                columns.col(static_cast<Eigen::Index>(j)) = problem.column(at, c.strengths[j], c.step[j]);
            const Assessment a = screen.assess(columns, Eigen::VectorXd::Zero(columns.cols()), false);
            const double gain = is_patch(effect) ? a.error_reduction : a.gain; // passed once it predicts no block that is left out
            if (gain <= best) continue;
            best = gain;
            std::vector<double> start;
            for (std::size_t j = 0; j < c.strengths.size(); ++j) {
                double v = std::clamp(a.strength[static_cast<Eigen::Index>(j)], c.minimum[j], c.maximum[j]);
                if (std::fabs(v) < 1e-3 * (c.maximum[j] - c.minimum[j])) v = c.of_interest[j];
                start.push_back(v);
            }
            use = effect_of(c, start);
        }
        if (use.name.empty())
            throw ModelError(model.file, 0, effect, "has no variant that this log can carry",
                             "drive further, or give its parameters in the model file");
        added.model.effects.push_back(use);
    }
    const std::string label = "+ " + effect + on_wheel(wheel);
    const Problem before = fitted_problem(model, data);
    Problem after = fitted_problem(added.model, data);
    if (is_patch(effect) && file.empty() && place_patch(added.model, data, effect, after)) after = fitted_problem(added.model, data);
    refuse_dead(model, added.model.effects.back(), after);
    const HeldOut left_before = held_out(before), left_after = held_out(after);
    const Fall fall = fall_between(left_before, left_after, noise_weight(before));
    Model baseline = model;
    added.ladder.push_back(store_fit(baseline, before, "baseline"));
    added.ladder.push_back(store_fit(added.model, after, label));
    added.limits = limits_of(after);
    added.helps = fall.sure() && added.ladder[1].train < added.ladder[0].train;
    const char *words = added.helps    ? "it helps"
                        : fall.sum > 0 ? "it does not help: the fall is less than its own standard error over 5 s blocks"
                                       : "it does not help";
    char buffer[300];
    std::snprintf(buffer, sizeof buffer, "held-out error %.3f -> %.3f x noise (5 s blocks, each predicted by a refit to the others): %s",
                  added.ladder[0].heldout, added.ladder[1].heldout, words);
    added.text = buffer;
    append_lineage(added.model, data, added.ladder, {label, std::nan(""), std::nan(""), 1});
    added.model.name = model.name;
    return added;
}

std::string added_text(const Added &added) {
    std::string text;
    const EffectUse &use = added.model.effects.back();
    for (const auto &[key, p] : use.parameters) {
        char buffer[200];
        std::snprintf(buffer, sizeof buffer, "%s.%s = %.5g [%.5g, %.5g] %s%s\n", use.name.c_str(), key.c_str(), p.value, p.low, p.high,
                      p.unit.c_str(), p.fixed ? " (shape)" : "");
        text += buffer;
    }
    return text + limits_text(added.limits) + ladder_text(added.ladder) + wrapped(added.text);
}

} // namespace traction::lab
