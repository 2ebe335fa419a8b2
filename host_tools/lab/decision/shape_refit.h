// shape_refit.h - a structure-free shape fitted in full, beside what the model has: is it still worth a word on blocks left out?
//
// A linear step ranks shapes. Of a ground that bends, of coefficients that a part of the log alone holds, and of a shape whose places are
// the encoders' scatter it says too much: of eleven clean logs that were told one, seven fell by
// less than is asked here, or rose, once it was fitted.
#pragma once

#include "host_tools/lab/fit/heldout.h"
#include "host_tools/lab/fit/scatter.h"
#include "shape_rules.h"

#include <optional>

namespace traction::lab {

// Both models fitted, on the scales of the one without the shape: fall of the squares of blocks left out, less what the shape gains by
// smoothing the encoders' scatter; and of the balance that gains most.
struct ShapeFall {
    Fall whole, balance;
    double share = 0, balance_share = 0; // of the squares that were left
};

// The model with the shape: its coefficients are the last parameters, fitted with the others from the best part of the linear step.
Problem with_shape(const Problem &without, const ShapeScore &shape);

// `with`: of with_shape(); `left`: of the model without it.
ShapeFall fall_by(const ShapeScore &shape, const Problem &with, const Problem &without, const HeldOut &left, const Scatter &scatter);

// Surely (twice its error over blocks, and not by two blocks alone), and by enough: of all squares, or of one balance's.
bool is_worth_a_word(const ShapeFall &fall, double scatter_share);

// The shape with the coefficients and standard errors of the model that with_shape() fitted.
ShapeScore as_fitted(const ShapeScore &shape, Problem with);

// A number that a shape multiplies by one and its value stays positive: no soil pushes back, no winding resists less than not at all.
bool is_possible(const ShapeScore &shape);

// A shape that would be told beside what was named, as_fitted(); nothing where that is not worth a word, or not possible.
std::optional<ShapeScore> as_refitted(const ShapeScore &shape, const Problem &without);

} // namespace traction::lab
