// information.h - what a log, made or planned, tells of a model's parameters and of effects that it lacks; and how far two of these
// stay apart when everything else may give way.
//
//   G = sum over rows of x x' / s^2 (Fisher information),  x = [sensitivities to the model's free parameters | to the candidates' strengths
//   | residual] (1) d'^2 = g' (G_AA - G_AR (G_RR + P)^-1 G_RA) g,  A the true effect of size g, R all free parameters and the rival, P
//   priors     (2)
// (2) is the squared difference between what A does and the nearest that the rival and the parameters can do (T-optimality, Atkinson
// and Fedorov 1975, linearised). Gram matrices of several drives add: what a log told tightens what the next may give way.
// s of a row: noise times the balance's residual over noise times the root of its design effect 1 + 2 sum rho_k (rows that err alike
// count once). A candidate's column is a secant over its size, so laws that bend count as they are.
#pragma once

#include "host_tools/lab/decision/candidate.h"
#include "host_tools/lab/fit/problem.h"

#include <Eigen/Dense>

#include <map>
#include <string>
#include <vector>

namespace traction::lab {

// A candidate at the sizes in question, one per strength.
struct SizedCandidate {
    Candidate candidate;
    std::vector<double> size;
};

// Per balance: scale of a row over its measurement noise, at least 1, of what is left when the parameters have taken their part (one
// linear step). The problem must be linearised.
std::map<std::string, double> scale_over_noise(const Problem &problem);

// (1), with row scales of noise times `scale` (1 where a balance is not listed), which it gives to the problem. The problem must be
// linearised.
Eigen::MatrixXd fisher_information(Problem &problem, const std::map<std::string, double> &scale,
                                   const std::vector<SizedCandidate> &candidates);

// (2) as d', the sum of G over drives given. `truth` and `rival` index the candidates, in the order given to fisher_information(); rival
// -1: none. precision: of the parameters' priors.
double detectability(const Eigen::MatrixXd &gram, const Eigen::VectorXd &precision, const std::vector<SizedCandidate> &candidates,
                     int truth, int rival);

// What the residual shows of A, beside R, in standard deviations: about 1 where it is noise.
double score_statistic(const Eigen::MatrixXd &gram, const Eigen::VectorXd &precision, const std::vector<SizedCandidate> &candidates,
                       int truth, int rival);

} // namespace traction::lab
