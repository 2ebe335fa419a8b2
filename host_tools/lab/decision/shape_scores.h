// shape_scores.h - the columns of all structure-free shapes, as many in a pass as go, and how each does beside a fitted model.
#pragma once

#include "candidate.h"
#include "host_tools/lab/fit/scatter.h"
#include "host_tools/lab/fit/screen.h"
#include "shape_rules.h"

#include <map>
#include <vector>

namespace traction::lab {

// Columns of shapes, scaled by the rows' weights, at a linearised problem: those that move the body share the response to a unit of their
// target.
class ShapeColumns {
  public:
    explicit ShapeColumns(Problem &problem);
    Eigen::MatrixXd of(const Candidate &shape);
    // Of a shape that moves the body, on each wheel alone; empty where that is not to be had in one pass.
    std::vector<Eigen::MatrixXd> of_each_wheel(const Candidate &shape);
    // Of waves, which come many and alike: as many as one pass holds.
    std::vector<Eigen::MatrixXd> of_waves(const std::vector<Candidate> &waves);
    // Of steps of one target, a column each.
    Eigen::MatrixXd of_steps(const std::vector<Candidate> &steps);

  private:
    const UnitResponse &unit(TermTarget target);
    const std::vector<Forward::ElectricSeries> &electric_unit(TermTarget target);

    Problem &problem_;
    Physics physics_;
    bool plain_ = true;
    std::map<TermTarget, UnitResponse> units_;
    std::map<TermTarget, std::vector<Forward::ElectricSeries>> electric_units_;
};

// Every shape on all wheels, and those that may act on some: on each wheel and axle; the largest gain first. keeps: the columns too.
std::vector<ShapeScore> all_shapes(Problem &problem, const Screen &screen, bool keeps = false);

// What a shape that moves the body gains by smoothing the encoders' scatter: no evidence (fit/scatter.h).
double smoothed_by(const ShapeScore &shape, const Problem &problem, const Scatter &scatter);

} // namespace traction::lab
