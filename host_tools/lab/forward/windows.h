// windows.h - the mean of a grid series over each row's window, as weights of the series' samples: the same for every candidate.
//
//   mean = (S(x1) - S(x0)) / (x1 - x0),  S the integral of the series, which is linear between samples                     (1)
// A window of no width takes the value there; windows end where the grid ends.
#pragma once

#include "host_tools/lab/inputs/dataset.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace traction::lab {

class Windows {
  public:
    Windows(const Dataset &data, const Balance &balance) : data_(&data), balance_(&balance) {}

    // out = (or, adding, +=) the mean over each row's window, all windows `delay_s` earlier. The weights of the last two delays are kept:
    // that of a fit's base, and the one that is tried beside it.
    void mean(const std::vector<double> &series, double delay_s, bool adding, Eigen::Ref<Eigen::VectorXd> out);

  private:
    struct Row {
        std::size_t first = 0, weight = 0, count = 0; // samples from `first`, weights from `weight`
    };
    struct Weights {
        std::vector<Row> row;
        std::vector<double> weight;
        double delay_s = 0;
    };
    std::shared_ptr<const Weights> build(double delay_s) const;
    void add_row(double x0, double x1, Weights &to) const;

    const Dataset *data_;
    const Balance *balance_;
    std::shared_ptr<const Weights> now_, before_; // the one asked for last, and the other; of all copies
};

} // namespace traction::lab
