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

namespace {

// Where one of the model's numbers and what was named describe the log about as well, what is named is told for who has checked the number.
constexpr double as_well = 1.1;

std::string if_the_numbers_are_right(const Diagnosis &d, const Doubt &doubt) {
    if (d.accepted.empty() || d.ladder.empty() || doubt.suspects.empty() ||
        !(d.ladder.back().train < as_well * doubt.suspects.front().error))
        return "";
    std::string text = " Where " + doubt.suspects.front().quantity + " is right as it stands, ";
    char size[60];
    for (std::size_t i = 0; i < d.accepted.size(); ++i) {
        const CandidateResult &a = d.accepted[i];
        std::snprintf(size, sizeof size, " (%.3g)", a.value.empty() ? 0.0 : a.value.front());
        text += (i == 0 ? "" : " and ") + a.candidate.label() + size;
    }
    std::snprintf(size, sizeof size, " would describe it too (%.3g x noise).", d.ladder.back().train);
    return text + size;
}

} // namespace

void name_nothing(Diagnosis &d, const Model &stated, const Doubt &doubt) {
    const std::string otherwise = if_the_numbers_are_right(d, doubt);
    std::vector<std::string> nearest;
    if (!otherwise.empty())
        for (const CandidateResult &a : d.accepted) nearest.push_back(a.candidate.label());
    for (CandidateResult &r : d.ranking)
        if (r.verdict == "named" || r.verdict == "class" || r.verdict == "nearest") r.verdict = "wrong_model", r.class_index.reset();
    if (d.ladder.size() > 1) d.ladder.resize(1);
    d.accepted.clear(), d.classes.clear(), d.effects.clear(), d.nearest.clear(), d.not_excited.clear();
    d.unknown.reset();
    d.model = stated;
    d.model_fit = d.stated_fit;
    d.kind = "wrong_model";
    d.nearest = std::move(nearest);
    char buffer[200];
    std::snprintf(buffer, sizeof buffer, "This model does not describe this log: its error is %.3g x noise, and no effect is named. ",
                  doubt.error);
    d.text = buffer + doubt.text + "." + otherwise;
}

} // namespace traction::lab
