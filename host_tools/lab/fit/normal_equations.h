// normal_equations.h - least squares by the normal equations, in one place: Eigen's factorisation is a second of compiler time per file.
#pragma once

#include <Eigen/Core>

namespace traction::lab {

// x of normal x = moment; normal (n x n) symmetric positive definite, by its LDL^T factors.
Eigen::VectorXd solve_normal(const Eigen::MatrixXd &normal, const Eigen::VectorXd &moment);

// The diagonal of normal^-1: variances of white residuals of unit scale, never below 0.
Eigen::VectorXd inverse_diagonal(const Eigen::MatrixXd &normal);

} // namespace traction::lab
