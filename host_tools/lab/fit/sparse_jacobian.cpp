#include "sparse_jacobian.h"

namespace traction::lab {

SparseJacobian::SparseJacobian(const Dataset &data, const Eigen::MatrixXd &jacobian) : columns_(jacobian.cols()) {
    Eigen::Index first = 0;
    for (const Balance &balance : data.balance) {
        const auto rows = static_cast<Eigen::Index>(balance.measured.size());
        Part part;
        part.first = first;
        for (Eigen::Index j = 0; j < columns_; ++j)
            if ((jacobian.col(j).segment(first, rows).array() != 0).any()) part.column.push_back(j);
        part.value = jacobian.middleRows(first, rows)(Eigen::all, part.column);
        parts_.push_back(std::move(part));
        first += rows;
    }
}

Eigen::MatrixXd SparseJacobian::gram() const {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(columns_, columns_), own;
    for (const Part &part : parts_) {
        own.noalias() = part.value.transpose() * part.value;
        sum(part.column, part.column) += own;
    }
    return sum;
}

Eigen::MatrixXd SparseJacobian::gram(const Eigen::VectorXd &weight) const {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(columns_, columns_), own;
    for (const Part &part : parts_) {
        const auto w = weight.segment(part.first, part.value.rows());
        if ((w.array() == 0).all()) continue;
        own.noalias() = part.value.transpose() * w.asDiagonal() * part.value;
        sum(part.column, part.column) += own;
    }
    return sum;
}

Eigen::MatrixXd SparseJacobian::whole() const {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(parts_.empty() ? 0 : parts_.back().first + parts_.back().value.rows(), columns_);
    for (const Part &part : parts_)
        for (std::size_t j = 0; j < part.column.size(); ++j)
            J.col(part.column[j]).segment(part.first, part.value.rows()) = part.value.col(static_cast<Eigen::Index>(j));
    return J;
}

Eigen::VectorXd SparseJacobian::moment(const Eigen::VectorXd &rows) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(columns_), own;
    for (const Part &part : parts_) {
        own.noalias() = part.value.transpose() * rows.segment(part.first, part.value.rows());
        sum(part.column) += own;
    }
    return sum;
}

} // namespace traction::lab
