// shapes.h - what no effect of the catalogue explains: structure-free shapes f(X), tested like any candidate; and which of the named
// effects were only proxies of such a shape.
#pragma once

#include "diagnose.h"

#include <memory>
#include <optional>
#include <vector>

namespace traction::lab {

struct ShapeFindings {
    std::optional<UnknownShape> shape, beside; // beside: of one that replaces, what is worth a word beside the names if they stay
    std::vector<std::size_t> replaced;         // of the named: the shape alone does better than they together
    double gain_squares = 0;                   // what it explains of the first problem's held-out error, where it replaces any
    std::optional<std::size_t> proxy;          // of the named: not needed beside a shape that is needed beside it
    std::optional<UnknownShape> cause;         // that shape
};

struct ShapeScore;
using ShapeScores = std::shared_ptr<const std::vector<ShapeScore>>;

// `first`: the baseline; `last`: with all that was named. `of_first`: all shapes beside the baseline, found when first asked for.
ShapeFindings find_unknown(const Problem &first, const Problem &last, const std::vector<Candidate> &named, const DiagnoseOptions &options,
                           ShapeScores &of_first);

// What is told of a model with no name, fitted in full; nothing where no shape is worth a word. Where the last name has gone to a rival it
// is told instead: a rival is no step.
std::optional<UnknownShape> told_alone(const Problem &first, const DiagnoseOptions &options);

} // namespace traction::lab
