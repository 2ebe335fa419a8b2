// profile.h - profile likelihood: how much worse the fit becomes when one parameter is held at a value and all others may move.
//
//   rise(x) = (C(x) - C(best)) / phi,  C = squares of all scaled rows and priors, least over the other parameters            (1)
//   interval = { x : rise(x) <= 3.84 }, the 95 % point of chi^2 with one degree of freedom                                    (2)
//   phi = (robust standard error of the screening / the white-noise one)^2, the parameter's own design effect                 (3)
// Rows that err together count once through (3); where C is a parabola, (2) is then the robust Wald interval exactly, and any
// difference between the two is curvature. Row scales and Huber weights stay those of the best fit.
#pragma once

#include "host_tools/lab/inputs/dataset.h"
#include "host_tools/lab/model/model.h"
#include "problem.h"

#include <string>
#include <vector>

namespace traction::lab {

struct Profile {
    std::string parameter; // "slip_sinkage.coefficient", "coulomb_friction.torque_Nm on wheel 2", "motor.resistance_ohm"
    std::string unit;
    double value = 0, standard_error = 0; // of the best fit; robust
    double wald_low = 0, wald_high = 0;
    double low = 0, high = 0;                         // of (2); the end of what was tried where that side is open or at a bound
    bool low_open = false, high_open = false;         // the rise stays below 3.84 as far as it was tried: the data do not limit it
    bool low_at_bound = false, high_at_bound = false; // reached the parameter's own bound first
    double dispersion = 1;                            // phi
    std::vector<double> x, rise;                      // ascending
    std::string verdict;                              // identifiable, asymmetric, at_bound, one_sided, not_identifiable
};

// Per parameter of a fitted problem: its variance were the scaled rows white, beside the priors; the denominator of (3).
Eigen::VectorXd white_variances(const Problem &fitted);

// Fits the model and profiles the wanted parameters: "slip_sinkage", "slip_sinkage.coefficient", "motor.resistance_ohm"; none: every
// strength of the model's effects. Throws ModelError for a name that is not free in this model, or when there is none.
std::vector<Profile> profile_likelihood(const Model &model, const Dataset &data, const std::vector<std::string> &wanted);

} // namespace traction::lab
