// hand_made.h - trials, data sets and fitted problems whose every number a test states itself.
#pragma once

#include "host_tools/lab/decision/trial.h"
#include "host_tools/lab/fit/problem.h"

#include <string>
#include <vector>

namespace traction::lab::hand_made {

// A candidate of one strength between 0 and 1, worth knowing from 0.1 on, that moves the body.
inline Candidate candidate(const std::string &effect, int wheel = -1) {
    Candidate c;
    c.effect = effect;
    c.wheel = wheel;
    FreeParameter p;
    p.owner = effect;
    p.key = "size";
    p.unit = "N";
    p.wheel = wheel;
    p.minimum = 0, p.maximum = 1;
    c.strengths = {p};
    c.of_interest = {0.1};
    c.minimum = {0}, c.maximum = {1};
    return c;
}

// Balances of `rows` rows each, one every `row_s` from start_s on, one after the other without gaps; noise 1; a grid of 0.1 s.
inline Dataset data_of(std::size_t balances, std::size_t rows, double row_s, double start_s = 0) {
    Dataset data;
    data.start_s = start_s;
    data.step_s = 0.1;
    data.duration_s = static_cast<double>(rows) * row_s;
    data.count = static_cast<std::size_t>(data.duration_s / data.step_s + 0.5) + 1;
    for (std::size_t b = 0; b < balances; ++b) {
        Balance balance;
        balance.kind = BalanceKind::radar;
        balance.name = "balance" + std::to_string(b);
        balance.noise = 1;
        for (std::size_t r = 0; r < rows; ++r) {
            balance.t0_s.push_back(start_s + static_cast<double>(r) * row_s);
            balance.t1_s.push_back(start_s + static_cast<double>(r + 1) * row_s);
            balance.measured.push_back(0);
        }
        data.balance.push_back(balance);
    }
    return data;
}

inline FreeParameter parameter(const std::string &owner, const std::string &key, double base, double prior, double minimum = -1e9,
                               double maximum = 1e9) {
    FreeParameter p;
    p.owner = owner, p.key = key, p.unit = "N";
    p.base = base, p.prior = prior;
    p.minimum = minimum, p.maximum = maximum;
    return p;
}

// As a fit has left it: residual and sensitivities as given, every row of scale 1, increments 0.
inline Problem problem_of(const Dataset &data, std::vector<FreeParameter> parameters, const Eigen::MatrixXd &jacobian,
                          const Eigen::VectorXd &residual) {
    Problem problem(data, Physics(), std::move(parameters));
    problem.jacobian = jacobian;
    problem.residual = residual;
    problem.row_scale = Eigen::VectorXd::Ones(residual.size());
    return problem;
}

} // namespace traction::lab::hand_made
