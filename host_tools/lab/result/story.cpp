#include "story.h"

#include "append.h"
#include "words.h"

#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace {

constexpr double close_to_noise = 1.6;  // as compare() has it: little can be left to find
constexpr double least_gain_one = 0.03; // DiagnoseOptions::least_gain_one
constexpr double most_of_it = 0.5;      // of the way from the error before to the noise: below it an effect is said to explain a part

std::string joined(const std::vector<std::string> &names, const char *last) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) text += (i == 0 ? "" : i + 1 == names.size() ? last : ", ") + names[i];
    return text;
}

// What was accepted; where the log cannot tell one from others, all of them: "mesh_loss or slip_sinkage".
std::vector<std::string> names_of(const Diagnosis &d) {
    std::vector<std::string> names;
    for (const CandidateResult &a : d.accepted) {
        names.push_back(a.candidate.label());
        for (const ConfoundedClass &c : d.classes)
            if (!c.members.empty() && c.members.front() == names.back()) names.back() = joined(c.members, " or ");
    }
    return names;
}

// "slip_sinkage (resistance grows with slip)"
std::string titled(const Candidate &c) {
    const sim::Effect *effect = sim::find_effect(c.effect);
    return c.label() + (effect != nullptr && !effect->title.empty() ? " (" + std::string(effect->title) + ")" : "");
}

std::string size_of(const CandidateResult &r) {
    std::string text;
    for (std::size_t j = 0; j < r.value.size(); ++j)
        text += (j > 0 ? ", " : "") + r.candidate.strengths[j].key + " = " +
                sized_text(r.value[j], r.low[j], r.high[j], r.candidate.strengths[j].unit);
    return text;
}

double left_after(const Comparison &c, const Diagnosis &d) { return d.accepted.empty() ? c.left.error : c.left_after.error; }

const Remainder &remainder(const Comparison &c, const Diagnosis &d) { return d.accepted.empty() ? c.left : c.left_after; }

bool settled(const Diagnosis &d) { return d.kind == "named" || d.kind == "class"; }

std::string class_words(const Diagnosis &d) {
    std::string text;
    for (const ConfoundedClass &c : d.classes) text += " This log cannot tell " + joined(c.members, " from ") + ".";
    return text;
}

// Of the way that the held-out error could fall, to the noise, the part that it does.
double explained(const Diagnosis &d) {
    if (d.ladder.size() < 2) return 0;
    const double before = d.ladder.front().heldout, after = d.ladder.back().heldout;
    return before > 1 ? (before - after) / (before - 1) : 0;
}

std::string good_enough(const Comparison &c, const Diagnosis &d) {
    if (d.kind == "wrong_model")
        return (d.nearest.empty() ? "No, and no effect is missing that would mend it: a number of the model itself is wrong. "
                                  : "No: a number of the model itself is wrong, or an effect is missing that acts as it does. ") +
               farthest_words(c);
    if (!d.accepted.empty())
        return "No. " + farthest_words(c) + " With what was found, " + times(c.left_after.error) + " times the sensor noise is left" +
               (c.left_after.error < close_to_noise ? ": close to the noise, good enough for this log." : ".");
    if (d.unknown) return "No. " + farthest_words(c);
    if (c.adjusted < close_to_noise && !d.moved.empty())
        return "Only with " + joined(d.moved, " and ") +
               " far from what is stated (notes): so fitted, what is left is close to the noise of the sensors.";
    if (c.adjusted < close_to_noise) return "Yes, for this log: what is left is close to the noise of the sensors.";
    return "Not known: the error is more than noise, and nothing that was tried explains it. " + farthest_words(c);
}

// Something acts on the body, and on what it depends is not known.
bool guessed_body(const Diagnosis &d) { return d.unknown && d.unknown->of_body && d.unknown->at_a_guess; }

// Numbers of the sheet that the fit takes to their limits or far from what is stated.
std::vector<std::string> far_from_stated(const Diagnosis &d) {
    std::vector<std::string> list;
    for (const Limit &limit : d.limits)
        if (limit.of_prior && !limit.parameter.starts_with("sensors.")) list.push_back(limit.parameter);
    list.insert(list.end(), d.moved.begin(), d.moved.end());
    return list;
}

std::string missing(const Comparison &c, const Diagnosis &d) {
    if (d.kind == "wrong_model") return d.text;
    std::string text;
    for (const CandidateResult &a : d.accepted) text += (text.empty() ? "" : " And ") + titled(a.candidate) + ": " + size_of(a) + ".";
    text += class_words(d);
    if (d.unknown && d.unknown->instead_of.empty())
        text +=
            (text.empty() ? "" : " ") + std::string("Something that is in no catalogue: ") + d.unknown->balance +
            (guessed_body(d) ? "; nothing that was tried tells what it depends on." : ", which depends on " + d.unknown->variable + ".");
    if (!d.nearest.empty()) text += " Nearest in the catalogue, and not named: " + joined(d.nearest, ", ") + ".";
    if (!text.empty()) return text;
    return c.adjusted < close_to_noise ? "Nothing that this log can show." : "Nothing that was tried: what is left has another cause.";
}

// Where the error of all signals together hardly falls, what speaks for the effect: the signal that gains most, or the data sheet.
std::string evidence_words(const Comparison &c) {
    const BalanceComparison *most = nullptr;
    double best = least_gain_one;
    for (const BalanceComparison &b : c.balances)
        if (!b.after.empty() && b.nrmse > 0 && 1 - b.nrmse_after / b.nrmse > best) best = 1 - b.nrmse_after / b.nrmse, most = &b;
    if (most == nullptr) return "The data sheet decides: without it, numbers of the model would have to stand far from theirs. ";
    return "What gains is the " + (most->title.empty() ? most->name : most->title) + ": from " + times(most->nrmse) + " to " +
           times(most->nrmse_after) + " times its noise. ";
}

std::string how_sure(const Comparison &c, const Diagnosis &d) {
    std::string text;
    if (d.kind == "wrong_model") return "No effect is named: the numbers of the model come first.";
    if (!d.accepted.empty()) {
        text = d.classes.empty() ? "Sure of the effect, as far as a log can be: " : "Sure that something is there, not which of them: ";
        const double fall = fall_percent(d.ladder);
        append(text, "on parts of the log that took no part in the fit, the error falls by %.0f %% (%s to %s times the noise). ", fall,
               times(d.ladder.front().heldout).c_str(), times(d.ladder.back().heldout).c_str());
        if (fall < 1) text += evidence_words(c);
        return text + (d.classes.empty() ? "The brackets hold" : "If it is the first that is named, the brackets hold") +
               " the true size in 95 of 100 cases.";
    }
    if (d.unknown && d.unknown->of_body)
        return std::string("Sure that something acts on the rover as a whole (notes); ") +
               (guessed_body(d) ? "nothing that was tried tells what it depends on."
                                : "that it depends on " + d.unknown->variable + " is the best of what was tried.");
    if (d.unknown && d.unknown->at_a_guess)
        return "Sure that one wheel is unlike the others (notes); that it depends on " + d.unknown->variable +
               " is the best of what was tried.";
    if (d.unknown) return "Sure that it depends on " + d.unknown->variable + "; the curve is a description, not a law.";
    if (!d.not_excited.empty())
        append(text, "%zu effects could not have been seen in this log, even at three times the size that matters. ", d.not_excited.size());
    return text + (d.not_excited.empty() ? "Every effect was tried: none " : "The others were tried: none ") +
           "helps to predict the parts of the log that took no part in the fit.";
}

std::string what_next(const Comparison &c, const Diagnosis &d, const NextExperiment *next) {
    if (d.kind == "wrong_model")
        return std::string("Check the data sheet's number that is named above, then compare again") +
               (d.nearest.empty() ? "." : "; where it is right, traction add what would describe the log too.");
    std::string text;
    if (next != nullptr && !next->title.empty()) {
        append(text, "Drive this, it tells them apart: %s", next->title.c_str());
        if (next->duration_s > 0) append(text, " (%.0f s)", next->duration_s);
        return text + ".";
    }
    if (!d.classes.empty()) return "To separate them: " + d.classes.front().separate_by + " (traction next works out the drive).";
    if (d.unknown && d.unknown->of_body)
        return "Look for what acts on the rover itself: a slope or waves of the floor, a cable, wind, something that swings on it, a load "
               "that "
               "came or went. Then drive it again without.";
    if (d.unknown && d.unknown->at_a_guess)
        return "Look at that wheel first: its motor and bridge, its gear and hub, its encoder and current sensor. Then drive it again.";
    if (d.unknown)
        return "Write the law as an effect of your own, from the expression below, and add it: traction add --effect-file. Then judge it "
               "on another log (--validate).";
    if (!d.accepted.empty()) {
        text = "Keep the better model and judge it on another log (--validate).";
        if (left_after(c, d) >= close_to_noise && d.not_excited.empty()) text += " What is left may be the ground or the sensors.";
        if (left_after(c, d) >= close_to_noise && !d.not_excited.empty())
            append(text,
                   " What is left may be the ground, the sensors, or one of the %zu effects that this log cannot show: traction next --all "
                   "proposes the drive for those.",
                   d.not_excited.size());
        return text;
    }
    if (c.adjusted < close_to_noise && !d.moved.empty())
        return "Check " + joined(d.moved, " and ") + " on the machine: where it is as stated, something that acts alike is missing.";
    if (c.adjusted < close_to_noise) return "Nothing: use the model.";
    if (const std::vector<std::string> off = far_from_stated(d); !off.empty())
        return "Check " + joined(off, " and ") + " on the machine: the model file is wrong there, or something that acts alike is missing.";
    if (d.not_excited.empty()) return "Look at where the model fails, and try a law of your own: traction add --effect-file.";
    return "Drive what this log lacks: traction next --all proposes the drive for what it could not show.";
}

} // namespace

Story tell(const Comparison &c, const Diagnosis &d, const NextExperiment *next) {
    Story story;
    story.good_enough = good_enough(c, d), story.missing = missing(c, d), story.sure = how_sure(c, d);
    story.where = worst_regime_words(c);
    story.left = d.kind == "wrong_model" ? "" : left_words(remainder(c, d), settled(d)) + ".";
    story.next = what_next(c, d, next);
    story.headline = misses_words(c);
    if (d.kind == "wrong_model")
        story.headline += ". " + d.text;
    else if (!d.accepted.empty())
        story.headline += ". " + joined(names_of(d), " and ") + (d.accepted.size() > 1 ? " explain " : " explains ") +
                          ((d.unknown && d.unknown->instead_of.empty()) || explained(d) < most_of_it ? "a part of it. " : "it. ") +
                          story.left;
    else if (d.unknown)
        story.headline += guessed_body(d) ? ". No effect of the catalogue explains it: " + d.unknown->balance + "."
                                          : ". No effect of the catalogue explains it: it depends on " + d.unknown->variable +
                                                (d.unknown->at_a_guess ? ", at a guess." : ".");
    else
        story.headline += c.adjusted < close_to_noise && !d.moved.empty()
                              ? ". That is close to the noise, with " + joined(d.moved, " and ") + " far from what is stated."
                          : c.adjusted < close_to_noise ? ". That is close to the noise: nothing is missing that this log could show."
                                                        : ". Nothing found that explains it. " + story.next;
    return story;
}

Story tell(const Comparison &c) {
    Story story;
    story.headline = c.verdict;
    if (c.balances.empty()) return story;
    story.good_enough = farthest_words(c);
    story.where = worst_regime_words(c);
    if (c.adjusted >= 1.15) story.left = left_words(c.left, false) + ".";
    return story;
}

nlohmann::json story_json(const Story &s) {
    nlohmann::json out = nlohmann::json::object();
    const auto put = [&](const char *key, const std::string &text) {
        if (!text.empty()) out[key] = text;
    };
    put("headline", s.headline), put("good_enough", s.good_enough), put("missing", s.missing), put("sure", s.sure);
    put("left", s.left), put("next", s.next), put("where", s.where);
    return out;
}

std::string story_text(const Story &s) {
    std::string text = wrapped(s.headline);
    const auto answer = [&](const char *question, const std::string &words) {
        if (!words.empty()) text += wrapped(std::string(question) + words, 2);
    };
    text += "\n";
    answer("Is the model good enough? ", s.good_enough);
    answer("What is missing? ", s.missing);
    answer("How sure is that? ", s.sure);
    answer("What is left, and why? ", s.left);
    answer("Where does it fail? ", s.where);
    answer("What next? ", s.next);
    return text;
}

} // namespace traction::lab
