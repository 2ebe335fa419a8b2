// compare.h - how far a model is from a log, balance by balance: size against the noise, and where it is worst.
#pragma once

#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/fit/identify.h"
#include "host_tools/lab/fit/problem.h"
#include "host_tools/lab/fit/remainder.h"
#include "host_tools/lab/inputs/dataset.h"

#include <string>
#include <vector>

namespace traction::lab {

struct Worst {
    double t0_s = 0, t1_s = 0, rmse = 0; // within the log
};

// A stretch in which a balance has no rows: left out (standstill, a sensor that was silent), never to be drawn across.
struct Gap {
    double t0_s = 0, t1_s = 0; // from the end of the last row to the begin of the next
    int rows = 0;              // that would stand there at the balance's usual spacing
};

struct Correlation {
    std::string with;
    std::vector<double> lag_s, value;
    double band = 0; // 99 %
};

struct BalanceComparison {
    std::string name, title, unit, noise_source;
    double noise = 0, rmse = 0, nrmse = 0, bias = 0, r2 = 0; // nrmse: in units of noise
    std::vector<double> t_s, measured, model;                // every row, in time
    std::vector<double> after;                               // a better model's, where show_after() was asked; else empty
    double rmse_after = 0, nrmse_after = 0;
    std::vector<Gap> gaps;
    std::vector<Worst> worst;     // 5 s windows, worst first
    std::vector<double> strip;    // residual over the log in 24 equal parts: RMS in units of noise; NaN: no rows there
    std::vector<double> in_noise; // noise of each row
    Correlation acf;
    std::vector<Correlation> ccf;
};

struct Regime {
    std::string quantity, unit; // "slip", "speed [m/s]": for a sentence
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
    Remainder left;       // of the adjusted model
    Remainder left_after; // of show_after()'s
    std::string verdict;  // one sentence, with what to do next
    std::vector<std::string> messages;
    std::vector<Limit> limits; // of the adjusted fit
};

// `error` and `adjusted` always; balances and regimes show the model as it stands (as_is), else after its parameters moved within their
// priors. known: fitted_problem() of this model and these data, where it is at hand; else it is made.
Comparison compare(const Model &model, const Dataset &data, bool as_is, const Problem *known = nullptr);

// Puts a better model's prediction of the same rows beside what is shown: `after`, its errors, `left_after`. The rows are those of `data`.
// known: as above, of the better model.
void show_after(Comparison &comparison, const Model &better, const Dataset &data, const Problem *known = nullptr);

// Stretches without rows, from `start_s` to `end_s`: where two rows are more than one and a half usual spacings apart and do not touch.
std::vector<Gap> gaps_of(const Balance &balance, double start_s, double end_s);

// "The model misses by 22 times the sensor noise; retuning it within its tolerances leaves 18", without a full stop.
std::string misses_words(const Comparison &comparison);

// "Farthest off is the current of wheel 2, torque balance: typically by 0.12 A, 24 times its noise.", in its unit.
std::string farthest_words(const Comparison &comparison);

// The worst cell of the heat maps that has at least 20 rows: "worst at slip 0.5 to 0.67 (wheel2.current_A): 31 times the noise"; empty
// where nothing is worse than 1.5 times what is left in all.
std::string worst_regime_words(const Comparison &comparison);

} // namespace traction::lab
