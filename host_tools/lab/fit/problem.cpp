#include "problem.h"

#include "checkpoint.h"

#include "host_tools/lab/inputs/smooth.h"
#include "normal_equations.h"
#include "sparse_jacobian.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace {

constexpr double huber = 3.0;                                   // in units of the balance's scale
constexpr double correlated_s = 2.5, fewest_design_blocks = 20; // blocks of the design effect, as those of the tests (screen.cpp)
constexpr double most_alike = 4;                                // no stated deviation counts for less than half of itself
constexpr std::size_t passes_at_once = 4; // neighbours of the motion side by side: their own series must stay near too

// The wheel that all slots are of; -1: several, or the body.
int wheel_of(const FreeParameter &p) {
    int wheel = -1;
    for (const Slot &slot : p.slots) {
        if (slot.in_wheel == nullptr || (wheel >= 0 && slot.wheel != wheel)) return -1;
        wheel = slot.wheel;
    }
    return wheel;
}

// What one wheel's differs from what the wheels share, wheel by wheel, where together they move the same slots: the shared one's derivative
// is their sum. Empty where there is no such.
std::vector<Eigen::Index> own_of(const std::vector<FreeParameter> &parameters, std::size_t shared) {
    const FreeParameter &p = parameters[shared];
    const auto has = [](const FreeParameter &q, const Slot &slot) {
        return std::any_of(q.slots.begin(), q.slots.end(),
                           [&](const Slot &s) { return s.in_wheel == slot.in_wheel && s.wheel == slot.wheel; });
    };
    std::vector<Eigen::Index> own;
    std::size_t slots = 0;
    for (std::size_t j = shared + 1; j < parameters.size() && parameters[j].own; ++j) { // they follow what they share
        const FreeParameter &q = parameters[j];
        if (q.owner != p.owner || q.key != p.key || q.touched != p.touched || wheel_of(q) < 0) return {};
        if (!std::all_of(q.slots.begin(), q.slots.end(), [&](const Slot &slot) { return has(p, slot); })) return {};
        own.push_back(static_cast<Eigen::Index>(j)), slots += q.slots.size();
    }
    return !p.own && slots == p.slots.size() ? own : std::vector<Eigen::Index>();
}

} // namespace

Problem::Problem(const Dataset &data, const Physics &physics, std::vector<FreeParameter> free)
    : parameters(std::move(free)), data_(&data), base_(physics), forward_(data) {
    theta = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parameters.size()));
    measured_.resize(static_cast<Eigen::Index>(forward_.rows()));
    for (std::size_t b = 0; b < data.balance.size(); ++b)
        for (std::size_t r = 0; r < data.balance[b].measured.size(); ++r)
            measured_[static_cast<Eigen::Index>(forward_.first_row(b) + r)] = data.balance[b].measured[r];
    for (FreeParameter &p : parameters)
        if (p.owner == "sensors" && p.key == "accel.bias_m_s2" && p.run < 0 && data.accel_bias_prior_m_s2 > 0)
            p.prior = data.accel_bias_prior_m_s2;
    for (const Balance &balance : data.balance) sigma.push_back(balance.noise);
    row_scale = noise_rows().cwiseInverse();
}

Eigen::VectorXd Problem::noise_rows() const {
    Eigen::VectorXd rows(measured_.size());
    for (std::size_t b = 0; b < data_->balance.size(); ++b) {
        const Balance &balance = data_->balance[b];
        for (std::size_t r = 0; r < balance.measured.size(); ++r)
            rows[static_cast<Eigen::Index>(forward_.first_row(b) + r)] =
                balance.noise * (balance.noise_factor.empty() ? 1.0 : balance.noise_factor[r]);
    }
    return rows;
}

Eigen::VectorXd Problem::smoothing_bias_rows() const {
    Eigen::VectorXd rows = Eigen::VectorXd::Zero(measured_.size());
    for (std::size_t b = 0; b < data_->balance.size(); ++b)
        for (std::size_t r = 0; r < data_->balance[b].smoothing_bias.size(); ++r)
            rows[static_cast<Eigen::Index>(forward_.first_row(b) + r)] = data_->balance[b].smoothing_bias[r];
    return rows;
}

Physics Problem::physics_at(const Eigen::VectorXd &increments) const {
    Physics physics = base_;
    for (std::size_t i = 0; i < parameters.size(); ++i) parameters[i].add(physics, increments[static_cast<Eigen::Index>(i)]);
    return physics;
}

Eigen::VectorXd Problem::alike() const {
    Eigen::VectorXd rows(static_cast<Eigen::Index>(parameters.size()));
    for (std::size_t i = 0; i < parameters.size(); ++i) rows[static_cast<Eigen::Index>(i)] = parameters[i].alike;
    return rows;
}

Eigen::VectorXd Problem::prior_precision() const { return stated_precision().cwiseProduct(alike()); }

Eigen::VectorXd Problem::stated_precision() const {
    Eigen::VectorXd precision(static_cast<Eigen::Index>(parameters.size()));
    for (std::size_t i = 0; i < parameters.size(); ++i)
        precision[static_cast<Eigen::Index>(i)] = parameters[i].prior > 0 ? 1 / (parameters[i].prior * parameters[i].prior) : 0;
    return precision;
}

Eigen::VectorXd Problem::column(const Physics &at, const FreeParameter &parameter, double step) {
    Physics moved = at;
    parameter.add(moved, step);
    return (forward_.predict_from_base(moved, parameter.touched, wheel_of(parameter)) - forward_.base()).cwiseProduct(row_scale) / step;
}

void Problem::bounds(std::size_t i, double &low, double &high) const {
    const FreeParameter &p = parameters[i];
    low = p.minimum - p.base;
    high = p.maximum - p.base;
    if (p.prior > 0) low = std::max(low, -6 * p.prior), high = std::min(high, 6 * p.prior);
}

bool Problem::at_bound(std::size_t i) const {
    double low = 0, high = 0;
    bounds(i, low, high);
    const double x = theta[static_cast<Eigen::Index>(i)], slack = 1e-6 * (high - low);
    return x < low + slack || x > high - slack;
}

// As it stands, by the present scales. Who changes a parameter's bounds or the Jacobian itself resizes it.
bool Problem::is_linearised() const {
    return jacobian.rows() == measured_.size() && jacobian.cols() == theta.size() && linear_at_.size() == theta.size() &&
           linear_at_ == theta && linear_scale_ == row_scale;
}

void Problem::linearise() {
    const Physics at = physics();
    put_off_ = false;
    update_residual();
    if (is_linearised()) return;
    jacobian.resize(measured_.size(), theta.size());
    linear_at_ = theta, linear_scale_ = row_scale;
    std::vector<std::size_t> beside, shared; // of the motion, to be had in one pass; sums of what is each wheel's own
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        if (forward_.has_linear_base() && !own_of(parameters, i).empty())
            shared.push_back(i);
        else if (forward_.is_neighbour(moved(at, i), parameters[i].touched))
            beside.push_back(i);
        else
            jacobian.col(static_cast<Eigen::Index>(i)) = column(at, parameters[i], difference(i));
    }
    for (std::size_t first = 0; first < beside.size(); first += passes_at_once)
        columns_beside(at, {beside.begin() + static_cast<std::ptrdiff_t>(first),
                            beside.begin() + static_cast<std::ptrdiff_t>(std::min(beside.size(), first + passes_at_once))});
    for (const std::size_t i : shared)
        jacobian.col(static_cast<Eigen::Index>(i)) = jacobian(Eigen::all, own_of(parameters, i)).rowwise().sum();
}

// The step of the difference by parameter i, away from its upper bound.
double Problem::difference(std::size_t i) const {
    double low = 0, high = 0;
    bounds(i, low, high);
    // whole integrations need a step that is large against the 1e-9 m/s of their search
    const double size =
        (parameters[i].touched & stage_motion) != 0 && !forward_.has_linear_base() ? 100 * parameters[i].step : parameters[i].step;
    return theta[static_cast<Eigen::Index>(i)] + size > high ? -size : size;
}

Physics Problem::moved(const Physics &at, std::size_t i) const {
    Physics physics = at;
    parameters[i].add(physics, difference(i));
    return physics;
}

// As column() has them, into the Jacobian.
void Problem::columns_beside(const Physics &at, const std::vector<std::size_t> &list) {
    std::vector<Physics> physics;
    std::vector<unsigned> touched;
    std::vector<int> wheel;
    for (const std::size_t i : list) {
        physics.push_back(moved(at, i));
        touched.push_back(parameters[i].touched);
        wheel.push_back(wheel_of(parameters[i]));
    }
    const Eigen::MatrixXd rows = forward_.predict_neighbours(physics, touched, wheel);
    for (std::size_t j = 0; j < list.size(); ++j)
        jacobian.col(static_cast<Eigen::Index>(list[j])) =
            (rows.col(static_cast<Eigen::Index>(j)) - forward_.base()).cwiseProduct(row_scale) / difference(list[j]);
}

// All rows as one residual block, the priors as further residuals.
class RowsCost : public ceres::CostFunction {
  public:
    explicit RowsCost(Problem *problem) : problem_(problem) {
        const auto n = static_cast<int>(problem->parameters.size());
        set_num_residuals(static_cast<int>(problem->measured_.size()) + n);
        mutable_parameter_block_sizes()->push_back(n);
    }

    bool Evaluate(double const *const *values, double *residuals, double **jacobians) const override {
        Problem &p = *problem_;
        const auto n = static_cast<Eigen::Index>(p.parameters.size()), rows = p.measured_.size();
        p.theta = Eigen::Map<const Eigen::VectorXd>(values[0], n);
        const bool derivatives = jacobians != nullptr && jacobians[0] != nullptr;
        Eigen::VectorXd predicted;
        if (derivatives) {
            p.linearise();
            predicted = p.forward_.base();
        } else {
            predicted = p.forward_.predict(p.physics());
        }
        if (!predicted.allFinite()) return false;
        Eigen::Map<Eigen::VectorXd> out(residuals, rows + n);
        out.head(rows) = (predicted - p.measured_).cwiseProduct(p.row_scale);
        const Eigen::VectorXd weight = p.prior_precision().cwiseSqrt();
        out.tail(n) = p.theta.cwiseProduct(weight);
        if (!derivatives) return true;
        Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> J(jacobians[0], rows + n, n);
        J.topRows(rows) = p.jacobian;
        J.bottomRows(n) = weight.asDiagonal().toDenseMatrix();
        return J.allFinite();
    }

  private:
    Problem *problem_;
};

void Problem::solve(int iterations) {
    checkpoint();
    if (parameters.empty() || measured_.size() == 0) {
        linearise();
        return;
    }
    std::vector<double> x(theta.data(), theta.data() + theta.size());
    ceres::Problem problem;
    problem.AddResidualBlock(new RowsCost(this), nullptr, x.data());
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        double low = 0, high = 0;
        bounds(i, low, high);
        x[i] = std::clamp(x[i], low, high);
        if (std::isfinite(low)) problem.SetParameterLowerBound(x.data(), static_cast<int>(i), low);
        if (std::isfinite(high)) problem.SetParameterUpperBound(x.data(), static_cast<int>(i), high);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.max_num_iterations = iterations;
    options.function_tolerance = 1e-4;
    options.parameter_tolerance = 1e-6;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    options.max_num_consecutive_invalid_steps = 10;
    options.initial_trust_region_radius = 1e6;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    theta = Eigen::Map<const Eigen::VectorXd>(x.data(), theta.size());
    linearise();
}

double Problem::speed_range(double t0, double t1) const {
    const std::vector<double> &v = forward_.motion().v_m_s;
    const auto at = [&](double t) {
        return std::min(data_->count - 1, static_cast<std::size_t>(std::max(0.0, (t - data_->start_s) / data_->step_s)));
    };
    const auto [low, high] =
        std::minmax_element(v.begin() + static_cast<std::ptrdiff_t>(at(t0)), v.begin() + static_cast<std::ptrdiff_t>(at(t1)) + 1);
    return *high - *low;
}

// Variance of each row of a balance as a sum of non-negative parts: constant, traction squared (ground that is not even), jerk
// squared, slip sensitivity squared (encoder noise through a stiff soil), speed squared (vibration), squared range of the speed within
// the row's window (a Doppler radar reads one of its speeds). Multiplicative updates of a weighted least squares.
Eigen::VectorXd Problem::row_variance(std::size_t b, const Eigen::VectorXd &squares, double floor_variance,
                                      Eigen::VectorXd *part_means) const {
    const Balance &balance = data_->balance[b];
    const auto n = static_cast<Eigen::Index>(balance.measured.size());
    const Motion &m = forward_.motion();
    constexpr Eigen::Index parts = 6;
    Eigen::MatrixXd F = Eigen::MatrixXd::Zero(n, parts);
    for (Eigen::Index r = 0; r < n; ++r) {
        const double t0 = balance.t0_s[static_cast<std::size_t>(r)], t1 = balance.t1_s[static_cast<std::size_t>(r)];
        const auto k =
            std::min(data_->count - 1, static_cast<std::size_t>(std::max(0.0, (0.5 * (t0 + t1) - data_->start_s) / data_->step_s)));
        F(r, 0) = 1;
        F(r, 4) = m.v_m_s[k] * m.v_m_s[k];
        F(r, 5) = speed_range(t0, t1) * speed_range(t0, t1);
        for (std::size_t i = 0; i < m.wheel.size(); ++i) {
            if (balance.wheel >= 0 && static_cast<std::size_t>(balance.wheel) != data_->motor_of(i)) continue;
            if (data_->wheel[i].rolls_freely) continue; // without traction and slip
            const double traction = m.wheel[i].traction_N[k], slip = m.wheel[i].slip[k];
            F(r, 1) += traction * traction;
            F(r, 2) += data_->wheel[i].accel_rad_s2[k] * data_->wheel[i].accel_rad_s2[k];
            const double speed = std::max(0.2, std::fabs(data_->wheel[i].speed_rad_s[k])), sc = 0.1;
            const double steep = std::exp(-std::fabs(slip) / sc) / speed; // where the soil's curve is steep, and the wheel slow
            F(r, 3) += steep * steep;
        }
    }
    Eigen::VectorXd variance = Eigen::VectorXd::Constant(n, std::max(floor_variance, squares.mean()));
    for (Eigen::Index c = 0; c < parts; ++c)
        if (const double mean = F.col(c).mean(); mean > 0) F.col(c) /= mean;
    Eigen::VectorXd x = Eigen::VectorXd::Constant(parts, squares.mean() / parts);
    for (int pass = 0; pass < 3; ++pass) {
        const Eigen::VectorXd weight = variance.array().square().inverse();
        const Eigen::VectorXd target = F.transpose() * weight.cwiseProduct(squares);
        const Eigen::MatrixXd gram = F.transpose() * weight.asDiagonal() * F;
        for (int i = 0; i < 200; ++i) x = x.cwiseProduct(target.cwiseQuotient((gram * x).cwiseMax(1e-300)));
        variance = (F * x).cwiseMax(floor_variance);
    }
    if (part_means != nullptr)
        for (Eigen::Index c = 0; c < parts; ++c) (*part_means)[c] = x[c] * F.col(c).mean();
    return variance;
}

Eigen::VectorXd Problem::clipped_squares(const Eigen::VectorXd &e) const {
    std::vector<double> size(static_cast<std::size_t>(e.size()));
    for (Eigen::Index r = 0; r < e.size(); ++r) size[static_cast<std::size_t>(r)] = std::fabs(e[r]);
    const double cut = 4 * std::max(1.0, 1.4826 * median(size)); // the largest residuals count as four robust deviations
    return e.cwiseAbs().cwiseMin(cut).cwiseAbs2();
}

Eigen::VectorXd Problem::variance_parts(std::size_t b) const {
    Eigen::VectorXd parts = Eigen::VectorXd::Zero(6);
    const auto first = static_cast<Eigen::Index>(forward_.first_row(b)), n = static_cast<Eigen::Index>(data_->balance[b].measured.size());
    if (n > 0) row_variance(b, clipped_squares(residual.segment(first, n).cwiseQuotient(noise_rows().segment(first, n))), 1.0, &parts);
    return parts;
}

void Problem::set_scales() {
    const Eigen::VectorXd noise = noise_rows(), before = row_scale;
    for (std::size_t b = 0; b < data_->balance.size(); ++b) {
        const auto first = static_cast<Eigen::Index>(forward_.first_row(b)),
                   n = static_cast<Eigen::Index>(data_->balance[b].measured.size());
        const Eigen::VectorXd e = residual.segment(first, n).cwiseQuotient(noise.segment(first, n)); // in units of the row's noise
        const Eigen::VectorXd variance = row_variance(b, clipped_squares(e), 1.0);
        sigma[b] = std::sqrt(variance.mean()) * data_->balance[b].noise;
        for (Eigen::Index r = 0; r < n; ++r) {
            const double scale = std::sqrt(variance[r]), ratio = std::fabs(e[r]) / scale;
            row_scale[first + r] = std::sqrt(ratio > huber ? huber / ratio : 1.0) / (scale * noise[first + r]);
        }
    }
    if (jacobian.rows() == row_scale.size()) jacobian = row_scale.cwiseQuotient(before).asDiagonal() * jacobian;
    weigh_stated();
}

// Rows that err alike tell a parameter less than their number: the variance of its score's sums over blocks, their mean taken off, beside
// that of independent rows (Kish 1965, the design effect). Counted one by one they would draw it from what the model states, so that counts
// as often: the adjustment of a composite likelihood (Ribatet, Cooley and Davison 2012), parameter by parameter, up to a limit: what a
// missing law leaves is alike too. A soil's numbers are a table's and another's at the next place, so theirs stay as stated. Weights of the
// rows themselves would take them from what a missing law disturbs the most, and the law would not be seen.
void Problem::weigh_stated() {
    for (FreeParameter &p : parameters) p.alike = 1;
    if (data_->independent_rows || jacobian.rows() != row_scale.size() || jacobian.cols() != theta.size()) return;
    const double length = std::min(correlated_s, data_->duration_s / fewest_design_blocks);
    const auto blocks = static_cast<Eigen::Index>(std::floor(data_->duration_s / length)) + 1;
    const Eigen::VectorXd e = residual.cwiseProduct(row_scale);
    Eigen::MatrixXd score = Eigen::MatrixXd::Zero(theta.size(), blocks);
    Eigen::Index row = 0;
    for (const Balance &b : data_->balance)
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) {
            const double at = std::floor((0.5 * (b.t0_s[r] + b.t1_s[r]) - data_->start_s) / length);
            score.col(std::clamp(static_cast<Eigen::Index>(at), Eigen::Index(0), blocks - 1)) += e[row] * jacobian.row(row).transpose();
        }
    const Eigen::VectorXd information = jacobian.colwise().squaredNorm();
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
        const double variance = (score.row(i).array() - score.row(i).mean()).square().sum();
        FreeParameter &p = parameters[static_cast<std::size_t>(i)];
        if (p.owner != "soil" && variance > information[i]) p.alike = std::min(most_alike, variance / information[i]);
    }
}

void Problem::start_near(const Problem &other) { forward_.start_near(other.forward_); }

void Problem::keep_scales(const Problem &other) {
    row_scale = other.row_scale;
    sigma = other.sigma;
    for (FreeParameter &p : parameters) {
        const auto its =
            std::find_if(other.parameters.begin(), other.parameters.end(), [&](const FreeParameter &q) { return is_same(p, q); });
        p.alike = its != other.parameters.end() ? its->alike : 1;
    }
}

double Problem::cost() {
    residual = measured_ - forward_.predict(physics());
    return residual.cwiseProduct(row_scale).squaredNorm() + theta.cwiseAbs2().dot(prior_precision());
}

Eigen::VectorXd Problem::scaled_residual(const Physics &at, unsigned touched) {
    return (measured_ - forward_.predict(at, touched)).cwiseProduct(row_scale);
}

void Problem::within_bounds() {
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
        double low = 0, high = 0;
        bounds(static_cast<std::size_t>(i), low, high);
        theta[i] = std::clamp(theta[i], low, high);
    }
}

void Problem::quick_fit(const Problem &base, int iterations) {
    checkpoint();
    keep_scales(base);
    const Eigen::Index n = base.theta.size(), all = theta.size(), rows = measured_.size();
    jacobian.resize(rows, all);
    linear_at_.resize(0); // in part alone
    jacobian.leftCols(n) = base.jacobian;
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(all, all);
    normal.topLeftCorner(n, n) = base.jacobian.transpose() * base.jacobian;
    const Eigen::VectorXd precision = prior_precision();
    double cost_before = 1e300;
    Eigen::VectorXd theta_before = theta, residual_before;
    Eigen::MatrixXd columns_before;
    for (int i = 0; i <= iterations; ++i) {
        const Physics at = physics();
        update_residual();
        const double cost = residual.cwiseProduct(row_scale).squaredNorm() + theta.cwiseAbs2().dot(precision);
        if (i > 0 && !(cost < cost_before)) { // too far: half way back, at most a few times
            if (cost > 1.0001 * cost_before && i < iterations) {
                theta = 0.5 * (theta + theta_before);
                continue;
            }
            theta = theta_before;
            residual = residual_before;
            jacobian.rightCols(all - n) = columns_before;
            return;
        }
        for (Eigen::Index c = n; c < all; ++c) {
            const FreeParameter &p = parameters[static_cast<std::size_t>(c)];
            double low = 0, high = 0;
            bounds(static_cast<std::size_t>(c), low, high);
            jacobian.col(c) = column(at, p, theta[c] + p.step > high ? -p.step : p.step);
        }
        if (i == iterations || cost > 0.9998 * cost_before) return;
        cost_before = cost;
        theta_before = theta, residual_before = residual;
        columns_before = jacobian.rightCols(all - n);
        const Eigen::MatrixXd cross = jacobian.transpose() * columns_before;
        normal.rightCols(all - n) = cross;
        normal.bottomRows(all - n) = cross.transpose();
        Eigen::MatrixXd system = normal;
        system.diagonal() += precision + 1e-9 * normal.diagonal() + Eigen::VectorXd::Constant(all, 1e-12);
        const Eigen::VectorXd moment = jacobian.transpose() * residual.cwiseProduct(row_scale) - precision.cwiseProduct(theta);
        theta += step_within_bounds(system, moment);
    }
}

Eigen::VectorXd Problem::step_within_bounds(const Eigen::MatrixXd &normal, const Eigen::VectorXd &moment) const {
    const Eigen::Index n = theta.size();
    Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
    std::vector<Eigen::Index> open;
    for (Eigen::Index i = 0; i < n; ++i) open.push_back(i);
    while (!open.empty()) {
        const auto k = static_cast<Eigen::Index>(open.size());
        Eigen::MatrixXd part(k, k);
        Eigen::VectorXd right(k);
        const Eigen::VectorXd rest = moment - normal * step;
        for (Eigen::Index i = 0; i < k; ++i) {
            right[i] = rest[open[static_cast<std::size_t>(i)]];
            for (Eigen::Index j = 0; j < k; ++j) part(i, j) = normal(open[static_cast<std::size_t>(i)], open[static_cast<std::size_t>(j)]);
        }
        const Eigen::VectorXd change = solve_normal(part, right);
        std::vector<Eigen::Index> kept;
        Eigen::VectorXd found = step;
        for (Eigen::Index i = 0; i < k; ++i) {
            const Eigen::Index at = open[static_cast<std::size_t>(i)];
            double low = 0, high = 0;
            bounds(static_cast<std::size_t>(at), low, high);
            found[at] = change[i];
            if (theta[at] + change[i] < low - 1e-12)
                step[at] = low - theta[at];
            else if (theta[at] + change[i] > high + 1e-12)
                step[at] = high - theta[at];
            else
                kept.push_back(at);
        }
        if (kept.size() == open.size()) return found;
        open = std::move(kept);
    }
    return step;
}

void Problem::update_residual() {
    if (!has_base_ || base_theta_ != theta) forward_.set_base(physics());
    has_base_ = true;
    base_theta_ = theta;
    residual = measured_ - forward_.base();
}

void Problem::gauss_newton(int fresh, bool ready) {
    checkpoint();
    constexpr int steps = 5;      // with the same sensitivities
    constexpr double worth = 0.3; // fall of the cost below which a step is the last: well below one squared standard deviation
    const Eigen::VectorXd precision = prior_precision();
    if (jacobian.rows() != measured_.size() || jacobian.cols() != theta.size()) linearise(), --fresh;
    get_ready();
    for (;; --fresh) {
        const SparseJacobian sparse(*data_, jacobian);
        Eigen::MatrixXd normal = sparse.gram();
        normal.diagonal() += precision + 1e-9 * normal.diagonal() + Eigen::VectorXd::Constant(theta.size(), 1e-12);
        const Eigen::VectorXd start = theta;
        const double first = residual.cwiseProduct(row_scale).squaredNorm() + theta.cwiseAbs2().dot(precision);
        double best = first;
        for (int i = 0; i < steps; ++i) {
            const Eigen::VectorXd before = theta, residual_before = residual;
            theta += step_within_bounds(normal, sparse.moment(residual.cwiseProduct(row_scale)) - precision.cwiseProduct(theta));
            double now = cost();
            for (int halving = 0; halving < 3 && !(now < best); ++halving) theta = 0.5 * (theta + before), now = cost();
            if (!(now < best)) {
                theta = before, residual = residual_before;
                break;
            }
            const double fall = best - now;
            best = now;
            if (fall < worth) break;
        }
        const Eigen::VectorXd moved = theta - start;
        if (fresh <= 0 || moved.dot(normal * moved) < 0.1)
            return update_residual(); // a third of a standard deviation: the sensitivities serve there too
        const bool last = first - best < worth;
        put_off_ = last && !ready;
        if (put_off_) return update_residual();
        linearise();
        if (last) return;
    }
}

void Problem::fit(const FitOptions &options) {
    if (data_->count < 3 || measured_.size() == 0) return;
    jacobian.resize(0, 0);
    if (options.reweight) {
        update_residual();
        set_scales();
        gauss_newton(options.thorough ? 2 : 1); // Ceres then starts where the quick steps end: from far away it may end at a bound
        set_scales();
    }
    if (options.thorough)
        solve(options.iterations);
    else
        gauss_newton(options.iterations, options.ready);
}

void Problem::settle() {
    fit({.iterations = 3});
    settle_from_here();
}

void Problem::settle_from_here() {
    constexpr int most = 4;
    constexpr double still = 1e-3; // of the error
    if (data_->count < 3 || measured_.size() == 0) return;
    update_residual();
    const auto error = [&] { return residual.cwiseQuotient(noise_rows()).norm(); };
    for (int i = 0; i < most; ++i) {
        const double before = error();
        set_scales();
        gauss_newton(2);
        if (std::fabs(error() - before) < still * before) break;
    }
    linearise();
}

double Problem::balance_rms(std::size_t b, bool in_noise) const {
    const std::size_t first = forward_.first_row(b), n = data_->balance[b].measured.size();
    const Eigen::VectorXd noise = noise_rows();
    double sum = 0;
    for (std::size_t r = 0; r < n; ++r) {
        const auto row = static_cast<Eigen::Index>(first + r);
        const double e = residual[row] / (in_noise ? noise[row] : 1.0);
        sum += e * e;
    }
    return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : 0;
}

} // namespace traction::lab
