// shapes.h - what no effect of the catalogue explains: structure-free shapes f(X), tested like any candidate.
#pragma once

#include "diagnose.h"

#include <optional>

namespace traction::lab {

struct Beyond {
    std::optional<UnknownShape> shape;
    bool alone = false;      // the shape in the stead of all that was named does better than they
    double gain_squares = 0; // what it explains of the first problem's held-out error, where alone
};

// `first`: the baseline; `last`: with all that was named.
Beyond find_unknown(const Problem &first, const Problem &last, std::size_t named_count, const DiagnoseOptions &options);

} // namespace traction::lab
