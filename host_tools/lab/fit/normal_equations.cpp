#include "normal_equations.h"

#include <Eigen/Cholesky>

namespace traction::lab {

Eigen::VectorXd solve_normal(const Eigen::MatrixXd &normal, const Eigen::VectorXd &moment) { return normal.ldlt().solve(moment); }

Eigen::VectorXd inverse_diagonal(const Eigen::MatrixXd &normal) {
    return normal.ldlt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols())).diagonal().cwiseMax(0);
}

} // namespace traction::lab
