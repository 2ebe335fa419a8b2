// sparse_jacobian.h - a block-sparse Jacobian: per balance a dense block of the columns that are not zero in all of its rows.
//
// Most of a wheel's parameters leave the rows of the other wheels and of the body's sensors alone, so that more than half of a Jacobian is
// zero. Products skip it; they are those of the whole matrix but for the order of the sums. Rows: all balances in the data's order; units:
// the Jacobian's.
#pragma once

#include "host_tools/lab/inputs/dataset.h"

#include <Eigen/Core>

#include <vector>

namespace traction::lab {

class SparseJacobian {
  public:
    SparseJacobian() = default;
    SparseJacobian(const Dataset &data, const Eigen::MatrixXd &jacobian);

    struct Part { // the rows of one balance
        Eigen::Index first = 0;
        std::vector<Eigen::Index> column;
        Eigen::MatrixXd value;
    };
    const std::vector<Part> &parts() const { return parts_; }  // in the order of data.balance
    Eigen::MatrixXd gram() const;                              // J' J
    Eigen::MatrixXd gram(const Eigen::VectorXd &weight) const; // J' diag(weight of each row) J
    Eigen::MatrixXd whole() const;                             // J, zeros and all: to keep J is to keep its parts
    Eigen::Index cols() const { return columns_; }
    Eigen::VectorXd moment(const Eigen::VectorXd &rows) const; // J' rows

  private:
    Eigen::Index columns_ = 0;
    std::vector<Part> parts_;
};

} // namespace traction::lab
