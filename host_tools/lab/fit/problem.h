// problem.h - a model fitted to a data set: residuals, sensitivities, weights, and the fit itself (Ceres).
//
// Sensitivities are structured finite differences of the stages that a parameter touches only (forward.h); those of the motion come
// from a linear recursion beside it (tangent.cpp).
// Scales: the variance of a row is a non-negative sum of its constant part and of five that follow the drive (row_variance in problem.cpp),
// fitted to its balance's residual and never below the row's measurement noise: what the model cannot explain in a channel must not drown
// the others. Huber weights beyond three scales.
#pragma once

#include "host_tools/lab/forward/forward.h"

#include <Eigen/Dense>

#include <vector>

namespace traction::lab {

struct FitOptions {
    int iterations = 2;    // linearisations (Ceres: iterations) after the last reweighting
    bool reweight = true;  // set the scale of each balance from its residual and Huber weights, then fit again
    bool thorough = false; // Ceres to its own convergence; else Gauss-Newton that keeps its sensitivities while they serve
    bool ready = true;     // leave the problem linearised; without, get_ready() does what is left of that
};

class Problem {
  public:
    Problem(const Dataset &data, const Physics &physics, std::vector<FreeParameter> parameters);

    void fit(const FitOptions &options);
    void settle();           // fit() until its scales no longer move the error: the optimum of `fit`, `add`, `compare` and `diagnose` alike
    void settle_from_here(); // the same without the first steps
    void linearise();        // prediction, residual and Jacobian at the present increments
    void get_ready() {       // what a fit that was not asked for it has put off; before the scales change
        if (put_off_) linearise();
    }

    const Dataset &data() const { return *data_; }
    Forward &forward() { return forward_; }
    Physics physics_at(const Eigen::VectorXd &increments) const;
    Physics physics() const { return physics_at(theta); }

    // Column of the Jacobian of `parameter` at the present state, scaled by the rows' weights. Needs linearise() before.
    Eigen::VectorXd column(const Physics &at, const FreeParameter &parameter, double step);

    std::vector<FreeParameter> parameters;
    Eigen::VectorXd theta;                    // increments
    Eigen::VectorXd residual;                 // measured - predicted, unscaled
    Eigen::MatrixXd jacobian;                 // scaled: d predicted / d theta * row_scale
    Eigen::VectorXd row_scale;                // sqrt(Huber weight) / sigma of the row
    std::vector<double> sigma;                // per balance: scale in use
    Eigen::VectorXd stated_precision() const; // per parameter: 1 / prior^2; 0: nothing is stated
    Eigen::VectorXd prior_precision() const;  // the same beside rows that are counted one by one: times alike()
    Eigen::VectorXd alike() const;            // per parameter

    Eigen::VectorXd noise_rows() const;          // measurement noise of each row
    Eigen::VectorXd smoothing_bias_rows() const; // Balance::smoothing_bias of each row
    double balance_rms(std::size_t balance, bool in_noise) const;

    // What the six parts of a balance's variance (above) come to at the present residual, mean over its rows, in squares of the noise:
    // constant, traction, wheel acceleration, slip sensitivity, speed, range of the speed. Residuals beyond four robust deviations count as
    // four.
    Eigen::VectorXd variance_parts(std::size_t balance) const;

    Eigen::VectorXd scaled_residual(const Physics &at,
                                    unsigned touched); // of a physics that differs in these stages, on the present scales
    bool at_bound(std::size_t parameter) const;
    void within_bounds(); // moves increments that left their bounds back to them
    double cost();        // squares of all rows and priors at the present increments, where `residual` is then

    // Gauss-Newton on baseline plus a candidate that leaves the motion alone, where the baseline's sensitivities are kept from `base` (the
    // first columns here, same scales): a candidate moves them little, and a pass for each is saved. Leaves the problem linearised.
    void quick_fit(const Problem &base, int iterations);

    // Gauss-Newton with the scales as they are: sensitivities are computed afresh at most `fresh` times, and serve for several steps
    // each. Leaves the problem linearised at its optimum, or, not `ready`, at its optimum alone.
    void gauss_newton(int fresh, bool ready = true);

    // Gauss-Newton step by an active set: what would leave its bound is held there, the others solve without it.
    Eigen::VectorXd step_within_bounds(const Eigen::MatrixXd &normal, const Eigen::VectorXd &moment) const;

    // Keeps the scales of another problem on the same data, so that their errors compare.
    void keep_scales(const Problem &other);

    // The first search for the body's motion starts from another problem's, on the same data.
    void start_near(const Problem &other);

  private:
    friend class RowsCost;
    void weigh_stated();                                // FreeParameter::alike, from residual, scales and Jacobian
    void set_scales();                                  // the Jacobian, if there is one, is scaled anew
    void update_residual();                             // prediction and residual at the present increments; the Jacobian stays
    double speed_range(double t0_s, double t1_s) const; // of the predicted body speed [m/s]
    Eigen::VectorXd clipped_squares(const Eigen::VectorXd &in_noise) const; // of residuals in units of each row's noise
    Eigen::VectorXd row_variance(std::size_t balance, const Eigen::VectorXd &squares, double floor_variance,
                                 Eigen::VectorXd *part_means = nullptr) const;
    void solve(int iterations);
    void bounds(std::size_t i, double &low, double &high) const;
    double difference(std::size_t i) const;
    Physics moved(const Physics &at, std::size_t i) const;
    void columns_beside(const Physics &at, const std::vector<std::size_t> &list);

    const Dataset *data_;
    Physics base_;
    Forward forward_;
    Eigen::VectorXd measured_;
    bool is_linearised() const;
    bool put_off_ = false;                     // the last linearisation of a fit
    Eigen::VectorXd linear_at_, linear_scale_; // where the Jacobian was taken as a whole, and by which row_scale
    bool has_base_ = false;                    // the forward model has a base, at:
    Eigen::VectorXd base_theta_;
};

} // namespace traction::lab
