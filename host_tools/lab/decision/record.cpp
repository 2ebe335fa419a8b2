#include "record.h"

#include "classes.h"
#include "host_tools/lab/fit/identify.h"
#include "host_tools/lab/fit/ladder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace traction::lab {

namespace {

constexpr double reach = 4; // of a shape parameter from the station it was found at, on either side: assumed

std::string one_decimal(double value) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, "%.1f", value);
    return buffer;
}

} // namespace

void note_not_excited(Diagnosis &d, const std::vector<Trial> &trials) {
    for (const Trial &t : trials) {
        const Candidate &c = t.candidate;
        if (c.wheel >= 0 || c.of_interest.empty() || t.p_value < 0.05) continue;
        bool alone = false, beside = false;
        for (std::size_t j = 0; j < t.error.size(); ++j) {
            const double size = 3 * c.of_interest[j];
            alone = alone || size * t.assessment.column_norm > 2;
            beside = beside || size > 2 * t.error[j];
        }
        if (!alone)
            d.not_excited.emplace_back(c.effect, "a size three times that of interest changes the log by " +
                                                     one_decimal(3 * c.of_interest[0] * t.assessment.column_norm) + " standard deviations");
        else if (!beside)
            d.not_excited.emplace_back(
                c.effect, "it would hide behind the model's own uncertain parameters: a size three times that of interest is " +
                              one_decimal(3 * c.of_interest[0] / t.error[0]) + " standard errors");
    }
}

void record(Diagnosis &d, const std::vector<Trial> &trials, std::size_t winner, const std::vector<std::size_t> &members,
            const std::string &rival, double base_error, const Screen &screen, bool is_first) {
    const bool found = winner < trials.size();
    for (std::size_t i = 0; i < trials.size(); ++i) {
        CandidateResult r = result_of(trials[i], base_error, screen);
        const bool member = std::find(members.begin(), members.end(), i) != members.end();
        if (i == winner)
            r.verdict = members.empty() && rival.empty() ? "named" : "class";
        else if (member)
            r.verdict = "class";
        else if (r.verdict == "passes" || (found && r.verdict == "not_held_out"))
            r.verdict = found ? "not_needed" : "not_held_out";
        if ((i == winner || member) && r.verdict == "class") r.class_index = static_cast<int>(d.classes.size());
        for (const auto &[effect, why] : d.not_excited)
            if (effect == r.candidate.effect && r.verdict == "not_significant" && r.candidate.wheel < 0) r.verdict = "not_excited";
        if (is_first) d.ranking.push_back(r);
        if (i == winner) d.accepted.push_back(r);
    }
    if (!found) return;
    const Trial &w = trials[winner];
    if (!members.empty() || !rival.empty()) {
        ConfoundedClass c;
        c.members.push_back(w.candidate.label());
        for (const std::size_t i : members) c.members.push_back(trials[i].candidate.label());
        if (!rival.empty()) c.members.push_back(rival);
        if (const sim::Effect *effect = sim::find_effect(w.candidate.effect)) c.separate_by = effect->reveals;
        d.classes.push_back(std::move(c));
    }
    d.model.effects.push_back(effect_of(w.candidate, w.value));
}

void take_values(CandidateResult &a, const Problem &problem, const std::vector<ParameterError> &errors, double loss) {
    for (std::size_t i = 0; i < problem.parameters.size(); ++i)
        for (std::size_t j = 0; j < a.candidate.strengths.size(); ++j) {
            const FreeParameter &p = problem.parameters[i];
            if (p.owner != a.candidate.effect || p.wheel != a.candidate.wheel || p.key != a.candidate.strengths[j].key) continue;
            a.value[j] = p.base + problem.theta[static_cast<Eigen::Index>(i)];
            const double half_width = with_the_laws_own(errors[i].half_width + std::fabs(a.value[j]) * loss, a.value[j]);
            a.low[j] = a.value[j] - half_width;
            a.high[j] = a.value[j] + half_width;
        }
}

void take_back(Diagnosis &d, std::size_t i) {
    const std::string label = d.accepted[i].candidate.label();
    for (CandidateResult &r : d.ranking)
        if (r.candidate.label() == label && (r.verdict == "named" || r.verdict == "class")) r.verdict = "not_needed";
    std::erase_if(d.ladder, [&](const LadderStep &r) { return r.label == "+ " + label; });
    remove_class(d, label);
    d.accepted.erase(d.accepted.begin() + static_cast<std::ptrdiff_t>(i));
}

bool was_seen(const Diagnosis &d, const std::string &effect) {
    const auto is = [&](const std::string &label) { return label == effect || label.starts_with(effect + " on wheel"); };
    for (const ConfoundedClass &c : d.classes)
        if (std::any_of(c.members.begin(), c.members.end(), is)) return true;
    return std::any_of(d.nearest.begin(), d.nearest.end(), is) ||
           std::any_of(d.accepted.begin(), d.accepted.end(), [&](const CandidateResult &a) { return a.candidate.effect == effect; });
}

void conclude(Diagnosis &d) {
    separate_accepted(d);
    std::erase_if(d.not_excited, [&](const auto &one) { return was_seen(d, one.first); });
    if (d.accepted.empty() && !d.unknown)
        for (CandidateResult &r : d.ranking)
            if (r.verdict == "not_needed") r.verdict = "not_held_out";
    for (const CandidateResult &a : d.accepted) {
        d.effects.push_back(a.candidate.label());
        for (CandidateResult &r : d.ranking) // refused in an earlier round, and named in a later one
            if (r.candidate.label() == a.candidate.label() && r.verdict == "nearest") r.verdict = "named";
        std::erase(d.nearest, a.candidate.label());
    }
    if (d.accepted.empty())
        d.kind = d.unknown ? "unknown" : "nothing";
    else
        d.kind = d.unknown && d.unknown->instead_of.empty() ? "partial" : !d.classes.empty() ? "class" : "named";
    d.text = verdict_text(d);
}

void tell_moved(Diagnosis &d, const Problem &fitted) {
    for (Moved &one : moved_far(fitted)) d.messages.push_back(std::move(one.text)), d.moved.push_back(std::move(one.parameter));
}

Model model_without(const Model &model, const Candidate &one) {
    Model without = model;
    std::erase_if(without.effects, [&](const EffectUse &use) { return use.name == one.effect && use.wheel == one.wheel; });
    return without;
}

bool is_on_a_scale(const sim::EffectParameter &spec) { return !spec.strength && spec.unit != "1" && spec.unit != "1/turn"; }

void set_free(Parameter &p, const sim::EffectParameter &spec) {
    p.fixed = false;
    // a variant of the machine's own scale may lie beyond the catalogue's range, which is the reference rover's
    const double least = p.value > spec.minimum ? spec.minimum : p.value / 2, most = p.value < spec.maximum ? spec.maximum : p.value * 2;
    p.minimum = std::max(least, p.value / reach);
    p.maximum = std::min(most, p.value * reach);
    if (spec.unit == "rad") p.minimum = p.value - 1.6, p.maximum = p.value + 1.6;
}

bool free_shapes(Model &model, const Candidate &c, const sim::Effect &effect) {
    bool any = false;
    for (EffectUse &use : model.effects) {
        if (use.name != c.effect || use.wheel != c.wheel) continue;
        for (const sim::EffectParameter &spec : effect.parameters) {
            const auto found = use.parameters.find(std::string(spec.name));
            if (found == use.parameters.end() || !is_on_a_scale(spec)) continue;
            set_free(found->second, spec);
            any = true;
        }
    }
    return any;
}

void take_shape_values(CandidateResult &a, const Problem &problem, const std::vector<ParameterError> &errors) {
    a.shapes.clear();
    for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
        const FreeParameter &p = problem.parameters[i];
        if (p.owner != a.candidate.effect || p.wheel != a.candidate.wheel) continue;
        const double value = p.base + problem.theta[static_cast<Eigen::Index>(i)];
        for (auto &[key, variant] : a.candidate.variant) {
            if (key != p.key) continue;
            variant = value;
            const double half = p.unit == "rad" ? errors[i].half_width // an angle's zero is anybody's
                                                : with_the_laws_own(errors[i].half_width, value);
            a.shapes.push_back({p.key, p.unit, value, value - half, value + half});
        }
    }
}

void fix_shapes(Model &model, const CandidateResult &a) {
    for (EffectUse &use : model.effects)
        for (const ShapeEstimate &shape : a.shapes)
            if (use.name == a.candidate.effect && use.wheel == a.candidate.wheel) {
                Parameter &p = use.parameters.at(shape.key);
                p.value = shape.value, p.low = shape.low, p.high = shape.high, p.fixed = true;
                p.minimum = -std::numeric_limits<double>::infinity(), p.maximum = -p.minimum;
            }
}

void take_edges(CandidateResult &a, const Model &model) {
    const EffectUse *use = model.find_effect(a.candidate.effect, -1);
    a.shapes.clear();
    for (auto &[key, variant] : a.candidate.variant) {
        const Parameter &p = use->parameters.at(key);
        variant = p.value;
        a.shapes.push_back({key, p.unit, p.value, p.low, p.high});
    }
}

bool no_worse(double refined, double at_station) { return refined < 1.0005 * at_station; }

double smoothing_loss(const Candidate &c, const Dataset &data) {
    if (c.effect != "torque_ripple" || c.variant.empty()) return 0;
    double squares = 0, n = 0;
    for (const WheelInput &w : data.wheel)
        for (const double speed : w.speed_rad_s)
            if (std::fabs(speed) > 0.5) squares += speed * speed, ++n;
    return n > 0 ? data.acceleration_loss(std::fabs(c.variant[0].second) * std::sqrt(squares / n)) : 0;
}

} // namespace traction::lab
