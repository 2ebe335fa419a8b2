// rival.h - a name against the structure-free shapes that would stand in its place, each fitted in full: does one do better, or as well?
//
// find_unknown() (shapes.h) compares by linear steps, which say too little of what bends: a grip that fades by a third in time was told as
// a soil that changes along the way, and a resistance to turning as wheels that dig in.
#pragma once

#include "candidate.h"
#include "shape_rules.h"

#include <optional>
#include <string>
#include <vector>

namespace traction::lab {

struct Rival {
    ShapeScore shape;
    bool better = false; // surely; else it does as well
    double error = 0;    // held-out squares without either, of which the shape explains its part
};

// True where the law is a function of what the shape is drawn over: then the shape is how the law looks, and no other cause.
bool is_own_axis(const std::string &effect, Axis axis);
std::vector<std::string> laws_with_axes(); // the others depend on none

// The shape's target is what the law changes by a constant: along any axis, a shape may be no more than that constant.
bool is_constant_of(const std::string &effect, TermTarget target);

// `last`: the fitted model with the name in it; `less`: the fitted model without it, which stands in for no other name. Of the shapes
// over what the law does not depend on, those that explain most by a linear step are fitted; one that is not needed beside the name, nor
// the name beside it, is a rival. `alternatives`: effects that the log cannot tell from the name; what they look like is none.
std::optional<Rival> rival_of(const Candidate &named, const std::vector<std::string> &alternatives, const Problem &last, Problem less,
                              const DiagnoseOptions &options);

// Of a shape that by its linear step explains what was named, and leaves nothing to the name: does the name predict blocks left out surely
// better than the shape fitted in its place? `last` and `less` as above.
bool outdoes(const Candidate &named, const Problem &last, const Problem &less, const ShapeScore &shape);

// Shapes are compared with names on the scales of the model without them. Where names explain most, those are blown up by what they
// explain, and a shape that explains half of it looks as good: does `last`, the model with names, leave three fifths or less of the
// held-out error, in units of noise, that the shape leaves, fitted in full in `less`, the model without them?
bool predicts_surely_better(const Problem &last, const Problem &less, const ShapeScore &shape);

} // namespace traction::lab
