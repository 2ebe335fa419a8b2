#include "classes.h"

#include "rounds.h"

#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

std::vector<std::size_t> confounded(const std::vector<Trial> &trials, std::size_t winner, double base_error, double explainable,
                                    const DiagnoseOptions &options) {
    std::vector<std::size_t> members;
    const Trial &w = trials[winner];
    const bool by_priors =
        w.gain - w.assessment.prior_reduction < options.least_gain * base_error && w.best_balance_gain < options.least_gain_one;
    // a winner by scales of its own: on the old ones the others of its class are no surer than it was
    const bool unsure = w.by_rows && !(w.p_value < options.p_limit);
    DiagnoseOptions nearly = options;
    nearly.p_limit = unsure ? unlikely_from(options.p_limit) : 0.05;
    for (std::size_t i = 0; i < trials.size(); ++i) {
        if (i == winner || !trials[i].refitted || trials[i].smooths) continue;
        Trial t = trials[i];
        const double norm = w.assessment.projected.norm() * t.assessment.projected.norm();
        const bool same = norm > 0 && std::fabs(w.assessment.projected.dot(t.assessment.projected)) > options.same_cosine * norm;
        const bool explains_more = t.error_reduction > w.error_reduction;
        judge(t, explainable, by_priors || explains_more || same || unsure ? nearly : options);
        if (t.verdict != "passes") continue;
        // the same effect on two wheels is a question, on all of them or on one of them it is one answer
        if (t.candidate.effect == w.candidate.effect && (t.candidate.wheel < 0 || w.candidate.wheel < 0)) continue;
        const double error = sum_error(w.block_gain - t.block_gain), less = w.gain - t.gain;
        const bool alike = less < 2 * error || same;
        // where the rows say little, a share of a gain that is mostly scatter tells nobody apart
        if (explains_more || (by_priors && less < 2 * error) || (less < (by_priors ? 0.5 : 0.1) * w.gain && alike)) members.push_back(i);
    }
    return members;
}

void remove_class(Diagnosis &d, const std::string &label) {
    const auto found =
        std::find_if(d.classes.begin(), d.classes.end(), [&](const ConfoundedClass &c) { return c.members.front() == label; });
    if (found == d.classes.end()) return;
    const auto gone = static_cast<int>(found - d.classes.begin());
    d.classes.erase(found);
    for (std::vector<CandidateResult> *list : {&d.ranking, &d.accepted})
        for (CandidateResult &r : *list) {
            if (!r.class_index) continue;
            if (*r.class_index == gone)
                r.class_index.reset();
            else if (*r.class_index > gone)
                --*r.class_index;
        }
}

std::vector<std::string> members_of(const Diagnosis &d, const CandidateResult &accepted) {
    std::vector<std::string> list;
    for (const ConfoundedClass &c : d.classes)
        if (c.members.front() == accepted.candidate.label())
            for (const std::string &member : c.members) list.push_back(member.substr(0, member.find(" on wheel")));
    return list;
}

void join_class(Diagnosis &d, std::size_t i, const std::string &member) {
    CandidateResult &a = d.accepted[i];
    const std::string label = a.candidate.label();
    auto found = std::find_if(d.classes.begin(), d.classes.end(), [&](const ConfoundedClass &c) { return c.members.front() == label; });
    if (found == d.classes.end()) {
        ConfoundedClass c;
        c.members.push_back(label);
        if (const sim::Effect *effect = sim::find_effect(a.candidate.effect)) c.separate_by = effect->reveals;
        found = d.classes.insert(found, std::move(c));
    }
    found->members.push_back(member);
    a.verdict = "class", a.class_index = static_cast<int>(found - d.classes.begin());
    for (CandidateResult &r : d.ranking)
        if (r.candidate.label() == label) r.verdict = a.verdict, r.class_index = a.class_index;
}

void separate_accepted(Diagnosis &d) {
    const auto accepted = [&](const std::string &label) {
        return std::any_of(d.accepted.begin(), d.accepted.end(), [&](const CandidateResult &a) { return a.candidate.label() == label; });
    };
    std::vector<std::string> alone;
    for (ConfoundedClass &c : d.classes) {
        const std::string front = c.members.front();
        std::erase_if(c.members, [&](const std::string &member) { return member != front && accepted(member); });
        if (c.members.size() == 1) alone.push_back(front);
    }
    for (const std::string &label : alone) remove_class(d, label);
    for (std::vector<CandidateResult> *list : {&d.ranking, &d.accepted})
        for (CandidateResult &r : *list) {
            const std::string label = r.candidate.label();
            const bool stands =
                std::any_of(d.classes.begin(), d.classes.end(), [&](const ConfoundedClass &c) { return c.members.front() == label; });
            if (r.verdict != "class" || stands) continue;
            if (accepted(label))
                r.class_index.reset(), r.verdict = "named";
            else if (!r.class_index)
                r.verdict = "not_needed";
        }
}

} // namespace traction::lab
