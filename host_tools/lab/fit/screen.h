// screen.h - the statistics of one candidate against one baseline fit, from Gram matrices kept per time block.
//
// One linear step from the baseline: the candidate's columns, orthogonal to the nuisance parameters (the model's own, with their priors).
// Cross-validation over 5 s blocks gives the held-out error; the delete-one-block jackknife over 2.5 s blocks the covariance
// (cluster-robust, leverage included), to which the priors' own variance and the bias of the smoothing are added; the F test's denominator
// has the effective number of blocks that inform the candidate. A log shorter than ten blocks is cut finer; rows of a table of trials are
// blocks each.
#pragma once

#include "problem.h"
#include "sparse_jacobian.h"

#include <Eigen/Dense>

#include <algorithm>
#include <vector>

namespace traction::lab {

// Standard error of the sum of the blocks' values, by their scatter.
double sum_error(const Eigen::VectorXd &of_blocks);

struct Assessment {
    Eigen::VectorXd strength; // estimate, what is present included
    Eigen::VectorXd standard_error;
    Eigen::VectorXd change;     // of the baseline's parameters, with the candidate in
    double error_reduction = 0; // of all rows, in squared units of scale
    double gain = 0;            // fall of the held-out error incl. priors, in squared units of scale
    double gain_error = 0;      // its standard error over blocks
    double prior_reduction = 0; // part of the gain that is fall of the priors' penalty
    double spared = 0;          // the same in squared stated deviations
    double p_value = 1;         // of the robust F test, not corrected
    double column_norm = 0;     // size of the first column alone: what one unit changes, in standard deviations
    double freedom = 1;         // degrees of freedom of the test's denominator
    double information = 0;     // share of the candidate's columns orthogonal to the nuisance parameters
    Eigen::VectorXd block_gain; // held-out fall per 5 s block
    Eigen::VectorXd projected;  // column (first strength) after projection, for cosines
};

struct ParameterError {
    double standard = 0;   // standard error
    double half_width = 0; // half of the 95 % interval: Student's t with the parameter's own degrees of freedom
};

class Screen {
  public:
    // The problem must be linearised at its optimum. Its first `leading` parameters are the baseline (-1: all); the others stay
    // at their values.
    explicit Screen(const Problem &problem, Eigen::Index leading = -1);

    // `columns`: scaled sensitivities of the candidate, one per strength, of which `present` is in the residual already.
    // full: also fills `projected`.
    Assessment assess(const Eigen::MatrixXd &columns, const Eigen::VectorXd &present, bool full) const;

    // The column orthogonal to the nuisance parameters, the priors' rows below it: for cosines.
    Eigen::VectorXd projected(const Eigen::VectorXd &column) const;

    // Error on all rows with this scaled residual, minimised over the nuisance parameters (profiled): for a candidate moved alone.
    // `change`: theirs.
    double profiled_error(const Eigen::VectorXd &scaled_residual, Eigen::VectorXd &change) const;
    // Does this change of the baseline's parameters take one out of the active set (off its bound) by more than its prior's deviation?
    bool leaves_active_set(const Eigen::VectorXd &change) const;
    // Largest relative fall of one balance's error on all rows, by the linear step.
    double best_balance_fall(const Eigen::MatrixXd &columns, const Assessment &step) const;
    double error() const { return error_; }                // on all rows, priors included, at the baseline's optimum
    double penalty() const { return base_penalty_; }       // of the priors, at the baseline's optimum
    double deviations() const { return base_deviations_; } // the same in squared stated deviations
    double heldout_error() const { return base_error_; }   // sum of squares over held-out blocks, priors included
    // The part of heldout_error() that is not the sensors' noise, which no model takes off; never below 0.
    double explainable() const { return std::max(0.0, base_error_ - noise_squares_); }
    const Eigen::VectorXd &block_error() const { return block_error_; }
    const std::vector<std::pair<double, double>> &blocks() const { return block_times_; } // 5 s blocks
    // Held-out sum of squares per balance; in_noise: in units of each row's measurement noise, which no model changes.
    std::vector<double> heldout_by_balance(bool in_noise = false) const;
    // Of the problem's own parameters, robust like a candidate's.
    std::vector<ParameterError> parameter_errors() const;
    // Of sums of them: one sum per row of `weights`.
    std::vector<ParameterError> errors_of(const Eigen::MatrixXd &weights) const;
    std::vector<Eigen::VectorXd> heldout_changes() const; // parameters without block b, relative to the optimum

  private:
    struct Blocks {
        std::vector<Eigen::MatrixXd> gram;
        std::vector<Eigen::VectorXd> moment; // N' r
        std::vector<double> squares;         // r' r
        std::vector<Eigen::LLT<Eigen::MatrixXd>> without;
        std::vector<Eigen::VectorXd> half; // of the step without the block: L^-1 (moment of the others)
        Eigen::Index count() const { return static_cast<Eigen::Index>(gram.size()); }
    };
    // Rows of one balance that lie in one block of either length.
    struct Segment {
        Eigen::Index first = 0, size = 0;
        std::size_t balance = 0, fine = 0, coarse = 0;
    };
    // N' C, C' C and C' r of a candidate, per block.
    struct Part {
        std::vector<Eigen::MatrixXd> nc, cc;
        std::vector<Eigen::VectorXd> mc;
        Part(std::size_t blocks, Eigen::Index n, Eigen::Index k)
            : nc(blocks, Eigen::MatrixXd::Zero(n, k)), cc(blocks, Eigen::MatrixXd::Zero(k, k)), mc(blocks, Eigen::VectorXd::Zero(k)) {}
    };
    // The candidate's strengths where one block is left out, and with `delta` the change of the baseline's parameters.
    class LeaveOut;
    void cut();
    void factor(Blocks &blocks) const;
    void parts(const Eigen::MatrixXd &columns, Part &fine, Part &coarse) const;
    Eigen::VectorXd projected(const Eigen::VectorXd &column, const Eigen::VectorXd &projection) const;
    std::vector<ParameterError> errors_by(const Blocks &blocks, const Eigen::MatrixXd &weights) const;

    const Problem &problem_;
    std::vector<Segment> segments_;
    Eigen::MatrixXd nuisance_;
    SparseJacobian sparse_;              // the same
    Eigen::VectorXd residual_;           // scaled
    Eigen::VectorXd moment_;             // N' r + pull
    Eigen::VectorXd bias_, bias_moment_; // of the smoothing, scaled; N' bias
    Eigen::VectorXd precision_;          // of the priors, as the rows are counted
    Eigen::VectorXd alike_;              // over what is stated
    Eigen::VectorXd pull_;               // -precision * theta
    Eigen::MatrixXd total_;
    Eigen::LLT<Eigen::MatrixXd> total_factor_;
    Blocks fine_, coarse_;
    std::vector<std::pair<double, double>> block_times_;
    Eigen::VectorXd block_error_;
    mutable std::vector<double> heldout_of_balance_; // once it was asked for
    double base_error_ = 0, base_penalty_ = 0, base_deviations_ = 0, error_ = 0, noise_squares_ = 0;
};

} // namespace traction::lab
