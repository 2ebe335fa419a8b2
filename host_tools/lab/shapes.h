// shapes.h - what no effect of the catalogue explains: structure-free shapes f(X), tested like any candidate.
#pragma once

#include "diagnose.h"

#include <optional>

namespace traction::lab {

struct Beyond {
    std::optional<UnknownShape> shape;
    bool alone = false;      // the shape in the stead of all that was named does better than they
    bool left_behind = false; // and what was named leaves a shape behind: none of it stands
};

// `first`: the baseline; `last`: with all that was named.
Beyond find_unknown(const Problem &first, const Problem &last, std::size_t named_count, const DiagnoseOptions &options);

} // namespace traction::lab
