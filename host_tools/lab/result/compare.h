// compare.h - how far a model is from a log, balance by balance: size against the noise, and where it is worst.
#pragma once

#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/fit/identify.h"
#include "host_tools/lab/fit/problem.h"
#include "host_tools/lab/inputs/dataset.h"

#include <string>
#include <vector>

namespace traction::lab {

struct Worst {
    double t0_s = 0, t1_s = 0, rmse = 0;
};

struct Correlation {
    std::string with;
    std::vector<double> lag_s, value;
    double band = 0; // 99 %
};

struct BalanceComparison {
    std::string name, title, unit, noise_source;
    double noise = 0, rmse = 0, nrmse = 0, bias = 0, r2 = 0; // nrmse: in units of noise
    std::vector<double> t_s, measured, model;
    std::vector<Worst> worst; // 5 s windows, worst first
    Correlation acf;
    std::vector<Correlation> ccf;
};

struct Regime {
    std::string title, x_label;
    std::vector<double> x_edges;
    std::vector<std::string> y_labels;
    std::vector<std::vector<double>> value, count; // RMS residual in units of noise; rows = y_labels
};

struct Comparison {
    std::vector<BalanceComparison> balances;
    std::vector<Regime> regimes;
    double error = 0;    // as the model stands
    double adjusted = 0; // after its parameters moved within their priors
    double floor = 1;
    std::string verdict;
    std::vector<std::string> messages;
    std::vector<Limit> limits; // of the adjusted fit
};

// `error` and `adjusted` always; balances and regimes show the model as it stands (as_is), else after its parameters moved within their
// priors.
Comparison compare(const Model &model, const Dataset &data, bool as_is);

} // namespace traction::lab
