// The sentence that ends a diagnosis.
#include "diagnose.h"

#include <algorithm>
#include <cstdio>

namespace traction::lab {

std::string verdict_text(const Diagnosis &d) {
    char buffer[400];
    const double before = d.ladder.empty() ? 0 : d.ladder.front().heldout, after = d.ladder.empty() ? 0 : d.ladder.back().heldout;
    std::string names;
    for (const CandidateResult &a : d.accepted) names += (names.empty() ? "" : " and ") + a.candidate.label();
    if (d.kind == "nothing") {
        std::snprintf(
            buffer, sizeof buffer,
            "Nothing found that the log supports; the error stands at %.2f x noise on what was not fitted (%.2f in the fit). %zu effects "
            "could not have been seen in it%s.",
            before, d.ladder.empty() ? 0 : d.ladder.front().train, d.not_excited.size(),
            d.not_excited.empty() ? "" : ": traction next --all proposes the drive for them");
        return buffer;
    }
    std::string text;
    if (!names.empty()) {
        std::snprintf(
            buffer, sizeof buffer,
            "The model lacks %s: on what was not fitted the error falls by %.0f %%, from %.3f to %.3f x noise (5 s blocks, each predicted "
            "by a refit to the others).",
            names.c_str(), before > 0 ? std::max(0.0, 100 * (1 - after / before)) : 0.0, before, after);
        text = buffer;
    }
    for (const ConfoundedClass &c : d.classes) {
        text += " This log cannot tell";
        for (std::size_t i = 0; i < c.members.size(); ++i)
            text += (i == 0 ? " " : i + 1 == c.members.size() ? " from " : ", ") + c.members[i];
        text += '.';
    }
    if (d.unknown && d.unknown->instead_of.empty()) {
        if (!text.empty())
            text += " That explains it only partly:";
        else
            text += "Unknown: no effect of the catalogue explains it:";
        text += " what is left depends on " + d.unknown->variable + ": " + d.unknown->balance + '.';
        for (std::size_t i = 0; i < d.nearest.size(); ++i)
            text += (i == 0 ? " Nearest in the catalogue, and not named: " : ", ") + d.nearest[i] + (i + 1 == d.nearest.size() ? "." : "");
    }
    return text;
}

void name_nothing(Diagnosis &d, const Model &stated, const Doubt &doubt) {
    for (CandidateResult &r : d.ranking)
        if (r.verdict == "named" || r.verdict == "class" || r.verdict == "nearest") r.verdict = "wrong_model", r.class_index.reset();
    if (d.ladder.size() > 1) d.ladder.resize(1);
    d.accepted.clear(), d.classes.clear(), d.effects.clear(), d.nearest.clear(), d.not_excited.clear();
    d.unknown.reset();
    d.model = stated;
    d.model_fit = d.stated_fit;
    d.kind = "wrong_model";
    char buffer[200];
    std::snprintf(buffer, sizeof buffer, "This model does not describe this log: its error is %.3g x noise, and no effect is named. ",
                  doubt.error);
    d.text = buffer + doubt.text + ".";
}

} // namespace traction::lab
