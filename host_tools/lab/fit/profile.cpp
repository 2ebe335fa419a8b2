#include "profile.h"

#include "identify.h"
#include "normal_equations.h"
#include "problem.h"
#include "screen.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace traction::lab {

namespace {

constexpr double limit = 3.841459; // chi^2, one degree of freedom, 95 %
constexpr int most_steps = 24;     // a side
constexpr int chords = 8;

// The best fit without one of its parameters, which is held where it is put.
class Held {
  public:
    Held(Problem &best, const Model &model, Eigen::Index which)
        : best_(best), physics_(make_physics(model)), which_(which), precision_(without(best.prior_precision())) {
        for (Eigen::Index i = 0; i < best.theta.size(); ++i)
            if (i != which) others_.push_back(best.parameters[static_cast<std::size_t>(i)]);
        measured_ = best.residual + best.forward().base();
        use(without_column(best.jacobian));
        slope_ = jacobian_.transpose() * best.residual.cwiseProduct(best.row_scale) - precision_.cwiseProduct(start());
        own_ = best.prior_precision()[which];
    }

    // Least cost with the parameter at `increment`; theta: the others, in and out. fresh: with sensitivities of that place.
    double cost(double increment, Eigen::VectorXd &theta, bool fresh) {
        Physics physics = physics_;
        best_.parameters[static_cast<std::size_t>(which_)].add(physics, increment);
        Problem rest(best_.data(), physics, others_);
        rest.keep_scales(best_);
        rest.theta = theta;
        double least = value(rest, increment);
        least = descend(rest, increment, least);
        if (fresh) {
            rest.linearise();
            use(rest.jacobian);
            least = descend(rest, increment, least);
            use(without_column(best_.jacobian));
        }
        theta = rest.theta;
        return least;
    }

    Eigen::VectorXd start() const { return without(best_.theta); }

  private:
    Eigen::VectorXd without(const Eigen::VectorXd &all) const {
        Eigen::VectorXd out(all.size() - 1);
        out << all.head(which_), all.tail(all.size() - which_ - 1);
        return out;
    }
    Eigen::MatrixXd without_column(const Eigen::MatrixXd &all) const {
        Eigen::MatrixXd out(all.rows(), all.cols() - 1);
        out << all.leftCols(which_), all.rightCols(all.cols() - which_ - 1);
        return out;
    }

    void use(Eigen::MatrixXd jacobian) {
        jacobian_ = std::move(jacobian);
        Eigen::MatrixXd normal = jacobian_.transpose() * jacobian_;
        normal.diagonal() += precision_;
        const Eigen::VectorXd diagonal = normal.diagonal().cwiseMax(1e-300);
        unit_ = diagonal.cwiseSqrt().cwiseInverse();
        normal_ = unit_.asDiagonal() * normal * unit_.asDiagonal();
        normal_.diagonal().array() += 1e-9; // what nothing sees stays where it is
    }

    // The Gauss-Newton step within the bounds: whoever would pass its bound goes there, and the others step for that.
    Eigen::VectorXd step_from(const Eigen::VectorXd &theta) const {
        const Eigen::VectorXd moment = unit_.cwiseProduct(jacobian_.transpose() * residual_ - precision_.cwiseProduct(theta) - slope_);
        Eigen::VectorXd step = Eigen::VectorXd::Zero(theta.size()); // in units of unit_
        std::vector<Eigen::Index> free, stopped;
        for (Eigen::Index i = 0; i < theta.size(); ++i) free.push_back(i);
        while (!free.empty()) {
            const Eigen::VectorXd rest = moment(free) - normal_(free, stopped) * step(stopped);
            step(free) = solve_normal(normal_(free, free), rest);
            std::vector<Eigen::Index> still;
            for (const Eigen::Index i : free) {
                const FreeParameter &p = others_[static_cast<std::size_t>(i)];
                const double low = (p.minimum - p.base - theta[i]) / unit_[i], high = (p.maximum - p.base - theta[i]) / unit_[i];
                if (step[i] >= low && step[i] <= high)
                    still.push_back(i);
                else
                    step[i] = std::clamp(step[i], std::min(low, high), std::max(low, high)), stopped.push_back(i);
            }
            if (still.size() == free.size()) break;
            free = std::move(still);
        }
        return unit_.cwiseProduct(step);
    }

    double value(Problem &rest, double increment) {
        residual_ = (measured_ - rest.forward().predict(rest.physics())).cwiseProduct(rest.row_scale);
        return residual_.squaredNorm() + rest.theta.cwiseAbs2().dot(precision_) + own_ * increment * increment;
    }

    // Gauss-Newton with the sensitivities in use, half way back where it overshoots.
    double descend(Problem &rest, double increment, double least) {
        for (int i = 0; i < chords; ++i) {
            const Eigen::VectorXd before = rest.theta;
            const Eigen::VectorXd step = step_from(before);
            double now = least, share = 1;
            for (int halving = 0; halving < 4; ++halving, share *= 0.5) {
                rest.theta = before + share * step;
                now = value(rest, increment);
                if (now < least) break;
            }
            if (!(now < least)) {
                rest.theta = before;
                return value(rest, increment);
            }
            const double fall = least - now;
            least = now;
            if (fall < 1e-3) break; // of a limit of 3.84
        }
        return least;
    }

    Problem &best_;
    Physics physics_;
    Eigen::Index which_;
    Eigen::VectorXd precision_;
    std::vector<FreeParameter> others_;
    Eigen::MatrixXd jacobian_, normal_; // normal_ in units of unit_
    Eigen::VectorXd unit_, residual_, measured_;
    Eigen::VectorXd slope_; // what is left of the gradient at the best fit (bounds, steps of a held voltage): no news of the held parameter
    double own_ = 0;        // precision of the held parameter's prior
};

struct Side {
    double end = 0;
    bool open = false, at_bound = false;
};

// Where the rise passes the limit between `inside` and `outside`: secants of its square root (a parabola's is a line), bisection
// where they creep.
double crossing(const std::function<double(double, Eigen::VectorXd &, bool)> &rise_at, const FreeParameter &p, Profile &out, double inside,
                double rise_inside, const Eigen::VectorXd &theta_inside, double outside, double rise_outside) {
    const double goal = std::sqrt(limit);
    Eigen::VectorXd theta = theta_inside;
    for (int i = 0; i < 12; ++i) {
        double share = (goal - std::sqrt(rise_inside)) / (std::sqrt(rise_outside) - std::sqrt(rise_inside));
        if (rise_outside > 9 * limit || i > 3) share = 0.5;
        const double x = inside + share * (outside - inside);
        Eigen::VectorXd here = theta;
        const double rise = rise_at(x, here, true);
        out.x.push_back(p.base + x), out.rise.push_back(rise);
        if (std::fabs(std::sqrt(rise) - goal) < 0.01 * goal) return x;
        if (rise <= limit)
            inside = x, rise_inside = rise, theta = here;
        else
            outside = x, rise_outside = rise;
    }
    return 0.5 * (inside + outside);
}

// Walks from the best value outwards until the rise passes the limit, a bound stops it, or it has gone as far as is sensible.
Side walk(Held &held, double best_cost, const FreeParameter &p, double increment, double error, double search_range, int sign,
          Profile &out) {
    const auto rise_at = [&](double x, Eigen::VectorXd &theta, bool fresh) {
        return std::max(0.0, (held.cost(x, theta, fresh) - best_cost) / out.dispersion);
    };
    const double bound = sign > 0 ? p.maximum - p.base : p.minimum - p.base;
    const bool bounded = std::isfinite(bound);
    const double far = bounded ? bound : increment + sign * search_range;
    if (sign * (far - increment) <= 1e-12 * std::fabs(far)) return {p.base + far, false, bounded}; // stands at its bound
    double step = std::min(0.5 * error, std::fabs(far - increment) / 8), x = increment, rise = 0;
    Eigen::VectorXd theta = held.start();
    for (int i = 0; i < most_steps; ++i) {
        const double last_x = x, last_rise = rise;
        const Eigen::VectorXd last_theta = theta;
        x = sign > 0 ? std::min(far, x + step) : std::max(far, x - step);
        rise = rise_at(x, theta, false);
        out.x.push_back(p.base + x), out.rise.push_back(rise);
        if (rise > limit) return {p.base + crossing(rise_at, p, out, last_x, last_rise, last_theta, x, rise), false, false};
        if (x == far) break;
        if (i >= 5) step *= 1.6;
    }
    return {p.base + x, !bounded || x != far, bounded && x == far};
}

std::string profile_verdict(const Profile &p) {
    const bool low_free = p.low_open || p.low_at_bound, high_free = p.high_open || p.high_at_bound;
    if (low_free && high_free) return "not_identifiable";
    if (p.low_open || p.high_open) return "one_sided";
    if (low_free || high_free) return "at_bound";
    const double ratio = (p.high - p.value) / std::max(1e-300, p.value - p.low);
    return ratio > 1.5 || ratio < 1 / 1.5 ? "asymmetric" : "identifiable";
}

Profile profile_one(Problem &best, const Model &model, Eigen::Index i, double error, double white_error, double best_cost) {
    const FreeParameter &p = best.parameters[static_cast<std::size_t>(i)];
    Profile out;
    out.parameter = name_of(p);
    out.unit = p.unit;
    out.value = p.base + best.theta[i];
    out.standard_error = error;
    out.wald_low = out.value - 1.96 * error, out.wald_high = out.value + 1.96 * error;
    const double ratio = error / white_error;
    out.dispersion = std::isfinite(ratio) && ratio > 0 ? std::clamp(ratio * ratio, 0.25, 1e4) : 1;
    const double held_error = 1 / std::max(1e-12, best.jacobian.col(i).norm()); // were all the others known
    const double search_range = std::max({10 * std::fabs(out.value), 40 * held_error, 5 * std::min(error, 1e4 * held_error)});
    Held held(best, model, i);
    const Side low = walk(held, best_cost, p, best.theta[i], error, search_range, -1, out),
               high = walk(held, best_cost, p, best.theta[i], error, search_range, 1, out);
    out.low = low.end, out.low_open = low.open, out.low_at_bound = low.at_bound;
    out.high = high.end, out.high_open = high.open, out.high_at_bound = high.at_bound;
    out.x.push_back(out.value), out.rise.push_back(0);
    std::vector<std::pair<double, double>> points;
    for (std::size_t k = 0; k < out.x.size(); ++k) points.emplace_back(out.x[k], out.rise[k]);
    std::sort(points.begin(), points.end());
    for (std::size_t k = 0; k < points.size(); ++k) out.x[k] = points[k].first, out.rise[k] = points[k].second;
    out.verdict = profile_verdict(out);
    return out;
}

std::vector<Eigen::Index> find_wanted(const Problem &problem, const Model &model, const std::vector<std::string> &wanted) {
    const auto of_effect = [&](const FreeParameter &p) {
        return std::any_of(model.effects.begin(), model.effects.end(), [&](const EffectUse &use) { return use.name == p.owner; });
    };
    std::vector<Eigen::Index> list;
    std::string known;
    for (const FreeParameter &p : problem.parameters) known += (known.empty() ? "" : ", ") + name_of(p);
    for (const std::string &name : wanted) {
        bool found = false;
        for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
            const FreeParameter &p = problem.parameters[i];
            if ((p.own || (name != p.owner && name != p.owner + "." + p.key)) && name != name_of(p)) continue;
            found = true;
            if (std::find(list.begin(), list.end(), static_cast<Eigen::Index>(i)) == list.end())
                list.push_back(static_cast<Eigen::Index>(i));
        }
        if (!found) throw ModelError(model.file, 0, "--profile", "\"" + name + "\" is not free in this model", "name some of: " + known);
    }
    if (wanted.empty())
        for (std::size_t i = 0; i < problem.parameters.size(); ++i)
            if (of_effect(problem.parameters[i])) list.push_back(static_cast<Eigen::Index>(i));
    if (list.empty())
        throw ModelError(model.file, 0, "--profile", "the model has no effect whose strength could be profiled", "name some of: " + known);
    return list;
}

} // namespace

Eigen::VectorXd white_variances(const Problem &fitted) {
    Eigen::MatrixXd normal = fitted.jacobian.transpose() * fitted.jacobian;
    normal.diagonal() += fitted.prior_precision();
    for (Eigen::Index j = 0; j < normal.rows(); ++j) normal(j, j) += 1e-9 * (1 + normal(j, j)); // the screening's ridge
    return inverse_diagonal(normal);
}

std::vector<Profile> profile_likelihood(const Model &model, const Dataset &data, const std::vector<std::string> &wanted) {
    if (data.balance.empty() || data.count < 3)
        throw ModelError(model.file, 0, "--profile", "the log has nothing that this model predicts",
                         "see what `traction compare` says of the log");
    const Physics physics = make_physics(model);
    Problem best(data, physics, free_parameters(model, physics));
    const std::vector<Eigen::Index> list = find_wanted(best, model, wanted);
    for (int i = 0; i < 3; ++i) best.fit({.iterations = 10, .thorough = true}); // until the scales no longer depend on where the fit began
    best.fit({.iterations = 10, .reweight = false, .thorough = true});          // to the optimum of the scales that the profile keeps
    for (const Eigen::Index i : list)
        if (!wanted.empty() && is_dead(best, static_cast<std::size_t>(i)))
            throw ModelError(model.file, 0, "--profile",
                             name_of(best.parameters[static_cast<std::size_t>(i)]) + " changes nothing that this log holds",
                             "ask for another parameter, or drive so that it matters");
    const std::vector<ParameterError> errors = Screen(best).parameter_errors();
    const Eigen::VectorXd white = white_variances(best).cwiseSqrt();
    const double best_cost = best.cost();
    best.linearise(); // cost() has moved the prediction
    std::vector<Profile> out;
    for (const Eigen::Index i : list)
        out.push_back(profile_one(best, model, i, errors[static_cast<std::size_t>(i)].standard, white[i], best_cost));
    return out;
}

} // namespace traction::lab
