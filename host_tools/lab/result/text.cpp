// Results as tables for a terminal of 80 columns: what matters first, the statistics on request.
#include "append.h"
#include "result.h"
#include "words.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace {

constexpr std::size_t bar_columns = 24, shown_candidates = 8;

std::string bar(double value, double most) {
    std::string text;
    const int n = most > 0 && std::isfinite(value) ? std::max(1, static_cast<int>(std::lround(value / most * bar_columns))) : 0;
    for (int i = 0; i < n; ++i) text += "█";
    return text;
}

std::string sizes(const CandidateResult &r) {
    std::string text;
    for (std::size_t j = 0; j < r.value.size(); ++j)
        text += (j > 0 ? ", " : "") + r.candidate.strengths[j].key + " = " +
                sized_text(r.value[j], r.low[j], r.high[j], r.candidate.strengths[j].unit);
    for (const auto &variant : r.candidate.variant) {
        const auto &[key, value] = variant;
        const auto refined = std::find_if(r.shapes.begin(), r.shapes.end(), [&](const ShapeEstimate &s) { return s.key == variant.first; });
        text += (text.empty() ? "" : ", ") + key + " = ";
        if (refined == r.shapes.end())
            append(text, "%g", value);
        else
            text += sized_text(value, refined->low, refined->high, refined->unit);
    }
    return text;
}

// One gain may be anything below all there is; an interval beyond it says nothing.
double at_most_all(double gain) { return 100 * std::clamp(gain, -1.0, 1.0); }

std::string statistics(const Diagnosis &d) {
    std::string text = "statistics of the candidates (gain: squares of the held-out error by linear steps on the fit's own scales,\n"
                       "which only ranks; p: corrected for the number tried; d': size over its standard error)\n";
    append(text, "  %-36s %8s %18s %9s %7s  %s\n", "candidate", "gain", "95 %", "p", "d'", "verdict");
    for (std::size_t i = 0; i < std::min<std::size_t>(20, d.ranking.size()); ++i) {
        const CandidateResult &r = d.ranking[i];
        append(text, "  %-36s %6.1f %% %6.1f to %5.1f %% %9.1e %7.1f  %s\n", r.candidate.label().c_str(), at_most_all(r.heldout_gain),
               at_most_all(r.gain_low), at_most_all(r.gain_high), r.p_value, r.detectability, candidate_words(r, d).c_str());
    }
    return text;
}

} // namespace

std::string messages_text(const std::vector<std::string> &messages) {
    std::string text;
    for (const std::string &m : messages) text += wrapped("note: " + m, 6);
    return text;
}

std::string comparison_text(const Comparison &c, bool details) {
    std::string text = messages_text(c.messages);
    if (!c.balances.empty()) append(text, "%-26s %17s %9s  %s\n", "", "off by", "x noise", "over the log");
    for (const BalanceComparison &b : c.balances) {
        std::string off;
        append(off, "%.3g %s", b.rmse, b.unit.c_str());
        append(text, "%-26s %17s %9s  ", b.name.c_str(), off.c_str(), times(b.nrmse).c_str());
        text += strip_text(b.strip) + "\n";
    }
    if (details && !c.balances.empty()) {
        append(text, "%-26s %12s %12s %9s  %-18s %s\n", "statistics", "noise", "bias", "R2", "worst 5 s", "left out");
        for (const BalanceComparison &b : c.balances) {
            int rows = 0;
            for (const Gap &g : b.gaps) rows += g.rows;
            std::string noise, bias, worst;
            append(noise, "%.3g %s", b.noise, b.unit.c_str()), append(bias, "%.3g %s", b.bias, b.unit.c_str());
            if (!b.worst.empty()) append(worst, "%.1f to %.1f s", b.worst[0].t0_s, b.worst[0].t1_s);
            append(text, "%-26s %12s %12s %9.4f  %-18s %d rows in %zu gaps\n", b.name.c_str(), noise.c_str(), bias.c_str(), b.r2,
                   worst.c_str(), rows, b.gaps.size());
        }
    }
    text += limits_text(c.limits);
    if (!c.balances.empty()) text += wrapped(farthest_words(c) + " " + worst_regime_words(c));
    return text + wrapped(c.verdict);
}

std::string ladder_text(const std::vector<LadderStep> &ladder) {
    if (ladder.empty()) return "";
    double most = 0;
    for (const LadderStep &r : ladder) most = std::max(most, r.heldout);
    std::string text;
    append(text, "%-36s %8s   %s\n", "error, x noise", "fitted", "held out");
    for (const LadderStep &r : ladder)
        append(text, "%-36s %8.3f %8.3f  %s\n", r.label.c_str(), r.train, r.heldout, bar(r.heldout, most).c_str());
    append(text, "%-36s %8.3f %8.3f  %s\n", "noise of the sensors", ladder.back().floor, ladder.back().floor,
           bar(ladder.back().floor, most).c_str());
    return text;
}

std::string diagnosis_text(const Diagnosis &d, bool details) {
    std::string text = messages_text(d.messages);
    if (!d.ranking.empty()) text += "what was tried, best first:\n";
    for (std::size_t i = 0; i < std::min(shown_candidates, d.ranking.size()); ++i) {
        const CandidateResult &r = d.ranking[i];
        text += "  " + padded(r.candidate.label(), 32) + " " + candidate_words(r, d) + "\n";
        if (r.verdict == "named" || r.verdict == "class") text += wrapped("      " + sizes(r), 6);
    }
    for (const ConfoundedClass &c : d.classes) {
        std::string members;
        for (const std::string &m : c.members) members += " " + m;
        text += wrapped("cannot be told apart in this log:" + members, 2);
        text += wrapped("  to separate them: " + c.separate_by, 2);
    }
    if (d.unknown && !d.unknown->instead_of.empty())
        text += wrapped("or, in no catalogue, instead of " + d.unknown->instead_of + ": " + d.unknown->target + " depends on " +
                            d.unknown->variable + ": " + d.unknown->expression,
                        2);
    else if (d.unknown)
        text += wrapped(d.unknown->expression == "0"
                            ? "unexplained: " + d.unknown->balance + "; it depends on " + d.unknown->variable
                            : "unexplained: " + d.unknown->target + " depends on " + d.unknown->variable + ": " + d.unknown->expression,
                        2);
    if (!d.not_excited.empty()) {
        std::string list;
        for (const auto &[effect, why] : d.not_excited) list += " " + effect;
        text += wrapped("this log cannot show:" + list, 2);
    }
    for (const CandidateResult &r : d.accepted) text += wrapped("found: " + r.candidate.label() + ": " + sizes(r), 2);
    text += limits_text(d.limits);
    if (details) text += statistics(d);
    text += ladder_text(d.ladder);
    return text + wrapped(d.text);
}

} // namespace traction::lab
