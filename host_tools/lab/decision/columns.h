// columns.h - sensitivities of all candidates at a baseline: a wheel's is computed once, "all wheels" is the sum.
#pragma once

#include "candidate.h"
#include "host_tools/lab/fit/problem.h"
#include "host_tools/lab/fit/sparse_jacobian.h"

#include <map>
#include <string>
#include <vector>

namespace traction::lab {

class Columns {
  public:
    // Unscaled, by effect, wheel and shape: good for later rounds too, whose refits are exact anyway.
    using Cache = std::map<std::string, SparseJacobian>;

    Columns(Problem &problem, Cache &cache) : problem_(problem), physics_(problem.physics()), cache_(cache) {}

    // Scaled, one column per strength.
    Eigen::MatrixXd of(const Candidate &candidate);

  private:
    Eigen::VectorXd column(const Candidate &candidate, std::size_t strength);
    Eigen::VectorXd single(const Candidate &candidate, std::size_t strength, const FreeParameter &parameter);
    Eigen::VectorXd patch(const Candidate &candidate, const FreeParameter &parameter);
    UnitResponse response(bool strength);
    void fill_cells(const Candidate &candidate, const FreeParameter &parameter, std::size_t first);

    Problem &problem_;
    Physics physics_;
    Cache &cache_;
    struct Ground {
        std::vector<Eigen::VectorXd> cells; // of the path
        UnitResponse unit;
    };
    std::map<std::string, Ground> ground_; // per effect that is a patch
    double cell_start_ = 0, cell_length_ = 1;
};

} // namespace traction::lab
