// candidate.h - what the lab can try: every catalogue effect on all wheels or one, each shape, and structure-free shapes f(X).
#pragma once

#include "host_tools/lab/forward/physics.h"

#include <string>
#include <utility>
#include <vector>

namespace traction::lab {

struct Dataset;
struct Motion;

struct Candidate {
    std::string effect; // catalogue name, the user's own, or "shape: torque(speed)"
    int wheel = -1;
    std::vector<std::pair<std::string, double>> variant; // shape parameters
    std::vector<FreeParameter> strengths;
    std::vector<double> of_interest, minimum, maximum; // per strength
    std::vector<double> step;                          // for the linear screening
    bool bounded = false;                              // no size beyond its range is believed, whatever it explains
    int variants = 1;                                  // how many like it are tried: shapes x wheels
    unsigned touched = stage_all;
    // structure-free only
    bool free_shape = false;
    Axis axis = Axis::time;
    TermTarget target = TermTarget::wheel_torque;
    std::vector<double> knots;
    double order = 0;                   // periodic in the wheel angle
    bool some_wheels = false;           // a shape of one wheel or one axle
    std::vector<int> on;                // these; empty: all
    bool varies_between_wheels = false; // X differs between the wheels more than within one: f(X) may stand for the wheels

    std::string label() const; // "slip_sinkage", "wiring_resistance on wheel 2"
    // Puts the shape parameters (and for structure-free ones the term) into a physics so that the strengths can move.
    void prepare(Physics &physics) const;
};

// An effect of one stretch of the path: its variants are windows along it.
inline bool is_patch(const std::string &effect) { return effect == "soil_patch" || effect == "resistance_patch"; }

// Every catalogue effect that is not in the model yet. Patches begin on cells of the path that `motion` drove.
std::vector<Candidate> catalogue_candidates(const Model &model, const Dataset &data, const Motion &motion);

// Structure-free shapes that this log can carry: axis x target, knots at quantiles of the axis.
std::vector<Candidate> shape_candidates(const Dataset &data, const Motion &motion, const Physics &physics,
                                        const std::vector<std::vector<double>> &current_A);

// The candidate as an effect of a model, with fitted strengths.
EffectUse effect_of(const Candidate &candidate, const std::vector<double> &strengths);

// A shape as a muparser expression in x-axis signal names, piecewise linear, numbers rounded.
std::string shape_expression(const Candidate &candidate, const std::vector<double> &coefficients);

} // namespace traction::lab
