#include "shapes.h"

#include "host_tools/lab/fit/scatter.h"
#include "host_tools/lab/fit/screen.h"
#include "shape_refit.h"
#include "shape_rules.h"
#include "shape_scores.h"

#include <memory>
#include <utility>

namespace traction::lab {

ShapeFindings find_unknown(const Problem &first, const Problem &last, const std::vector<Candidate> &named, const DiagnoseOptions &options,
                           ShapeScores &of_first) {
    const std::size_t named_count = named.size();
    ShapeFindings findings;
    Problem at_last = last, at_first = first; // their forward models are moved about
    const auto beside_first = [&](const Screen &screen) -> const std::vector<ShapeScore> & {
        if (!of_first) of_first = std::make_shared<const std::vector<ShapeScore>>(all_shapes(at_first, screen));
        return *of_first;
    };
    const Screen last_screen(at_last);
    const Scatter scatter(last); // slow on stiff ground (at a steady speed counts beat with samples): it stands in few blocks, like a law
    const bool alone = &first == &last && named_count == 0;
    std::vector<ShapeScore> of_last;
    if (!alone) of_last = all_shapes(at_last, last_screen, named_count > 0);
    const std::vector<ShapeScore> &scores = alone ? beside_first(last_screen) : of_last;
    const ShapeScore *best = worth_a_word(
        scores, [&](const ShapeScore &shape) { return smoothed_by(shape, last, scatter); }, named_count > 0, last_screen.heldout_error(),
        scatter.share, options);
    if (best != nullptr) findings.shape = describe(*best, last_screen.heldout_error());
    if (named_count == 0) return findings;
    for (std::size_t i = named_count; i-- > 0 && !findings.proxy;)
        if ((findings.cause = confounding_shape(last, named[i], scores, best, options))) findings.proxy = i;
    if (!findings.shape && !anything_left(scores, last_screen.heldout_error())) return findings; // no shape can do better
    // does one shape alone do better than all that was named?
    const Screen first_screen(at_first);
    at_last.keep_scales(first);
    at_last.linearise();
    const Screen named_screen(at_last);
    const double named_gain = first_screen.heldout_error() - named_screen.heldout_error();
    for (const ShapeScore &s : beside_first(first_screen)) {
        if (!may_replace(s, named_gain, options)) continue;
        const std::vector<std::size_t> replaced = explained_by_shape(last, named, s.candidate.effect, scores);
        if (replaced.empty()) continue;
        const double error = sum_error(s.assessment.block_gain - (first_screen.block_error() - named_screen.block_error()));
        if (!takes_their_place(replaced.size(), s.assessment.gain, named_gain, error, findings.shape.has_value(), options)) continue;
        findings.beside = std::exchange(findings.shape, describe(s, first_screen.heldout_error()));
        findings.replaced = replaced, findings.gain_squares = s.assessment.gain;
        return findings;
    }
    return findings;
}

std::optional<UnknownShape> told_alone(const Problem &first, const DiagnoseOptions &options) {
    ShapeScores of_first;
    const ShapeFindings findings = find_unknown(first, first, {}, options, of_first);
    if (!findings.shape) return std::nullopt;
    const std::optional<ShapeScore> fitted = as_refitted(*findings.shape->score, first);
    if (!fitted) return std::nullopt;
    UnknownShape told = describe(*fitted, 1);
    told.gain = findings.shape->gain;
    return told;
}

} // namespace traction::lab
