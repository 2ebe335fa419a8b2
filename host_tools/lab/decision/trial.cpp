#include "trial.h"

#include "host_tools/lab/fit/distribution.h"
#include "host_tools/lab/fit/ladder.h"

#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace traction::lab {

namespace {

constexpr double share_that_matters = 0.5; // of what is not noise, assumed
constexpr double least_gain_squares = 9;   // three deviations of white noise, where nearly all that the baseline leaves is noise
constexpr double clearly_worse = 1.02;     // of the baseline's error: beyond such a size no better one is sought (assumed)
constexpr double classes_tried = 26;       // catalogue effects that are not near copies of one another: about half of the catalogue

// Of the coefficient's own test and, four to one, the ranks of the held-out error's falls over blocks (as of shapes): an effect that acts
// in few blocks has a coefficient that scatters though it helps in all of them.
void test(Trial &t) {
    const double tried = t.candidate.variants * classes_tried, ranks = signed_rank_tail({t.block_gain.begin(), t.block_gain.end()});
    t.own_p_value = std::min(1.0, 1.25 * t.assessment.p_value * tried);
    t.p_value = std::min(t.own_p_value, 5 * ranks * tried);
}

void take(Trial &t, const Assessment &a) {
    t.assessment = a;
    t.error.clear(), t.half_width.clear();
    const double quantile = t_quantile(0.05, std::max(1.0, a.freedom));
    for (Eigen::Index j = 0; j < a.strength.size(); ++j) {
        t.error.push_back(a.standard_error[j]);
        t.half_width.push_back(quantile * a.standard_error[j]);
    }
}

// Baseline and candidate as one problem, on the baseline's scales.
double clamped(const Candidate &c, std::size_t j, double value) {
    const FreeParameter &p = c.strengths[j];
    if (c.maximum.empty()) return std::clamp(value, p.minimum, p.maximum);
    return std::clamp(value, std::max(p.minimum, c.minimum[j]), c.maximum[j]);
}

// A step from where the baseline lies at its bounds may go much too far: the best of a few parts of it.
void shorten(Problem &problem, Eigen::Index first) {
    const Eigen::VectorXd whole = problem.theta;
    double least = problem.cost();
    Eigen::VectorXd best = whole;
    for (const double part : {0.5, 0.2, 0.05}) {
        problem.theta.tail(whole.size() - first) = part * whole.tail(whole.size() - first);
        if (const double cost = problem.cost(); cost < least) least = cost, best = problem.theta;
    }
    problem.theta = best;
}

} // namespace

Problem beside(const Problem &base, const Candidate &candidate) {
    Physics physics = base.physics_at(Eigen::VectorXd::Zero(base.theta.size()));
    candidate.prepare(physics);
    std::vector<FreeParameter> parameters = base.parameters;
    parameters.insert(parameters.end(), candidate.strengths.begin(), candidate.strengths.end());
    Problem problem(base.data(), physics, parameters);
    problem.keep_scales(base);
    problem.start_near(base);
    problem.theta.head(base.theta.size()) = base.theta;
    return problem;
}

bool plausible_sign(const Candidate &c, const std::vector<double> &value) {
    for (std::size_t j = 0; j < value.size(); ++j)
        if (j < c.minimum.size() && c.minimum[j] >= 0 && value[j] < 0) return false;
    return true;
}

bool strongly_nonlinear(const std::string &effect) { return effect == "backlash" || effect == "relaxation_length"; }

bool is_delay(const Candidate &c) { return c.strengths.size() == 1 && c.strengths[0].unit == "s"; }

bool large_enough(const Candidate &c, const std::vector<double> &value) {
    double size = 0, least = 0;
    for (std::size_t j = 0; j < value.size(); ++j)
        size += value[j] * value[j], least = std::max(least, j < c.of_interest.size() ? c.of_interest[j] : 0.0);
    return std::sqrt(size) >= least;
}

bool is_solid(const CandidateResult &r) {
    bool sure = false;
    for (std::size_t j = 0; j < r.value.size(); ++j) sure = sure || r.low[j] * r.high[j] > 0;
    return sure && (r.matters || large_enough(r.candidate, r.value));
}

Problem held_ground(const Problem &with, const Problem &before) {
    Problem held = with;
    for (std::size_t i = 0; i < before.parameters.size(); ++i) {
        if (before.parameters[i].owner != "soil") continue;
        const double stays = before.theta[static_cast<Eigen::Index>(i)];
        held.parameters[i].minimum = held.parameters[i].maximum = before.parameters[i].base + stays;
        held.theta[static_cast<Eigen::Index>(i)] = stays;
    }
    held.jacobian.resize(0, 0);
    held.gauss_newton(2);
    return held;
}

// The ends of the 95 % intervals that lie nearer to zero.
std::vector<double> near_ends(const Trial &t) {
    std::vector<double> near;
    for (std::size_t j = 0; j < t.value.size(); ++j) near.push_back(std::max(0.0, std::fabs(t.value[j]) - t.half_width[j]));
    return near;
}

bool beyond_range(const Candidate &c, const std::vector<double> &value) {
    for (std::size_t j = 0; j < value.size(); ++j) {
        const FreeParameter &p = c.strengths[j];
        const double slack = 1e-6 * (p.maximum - p.minimum);
        if (value[j] > p.maximum - slack || (p.minimum < 0 && value[j] < p.minimum + slack)) return true;
    }
    return false;
}

Trial screen_candidate(const Candidate &c, const Screen &screen, Columns &columns) {
    Trial t;
    t.candidate = c;
    const Eigen::MatrixXd C = columns.of(c);
    take(t, screen.assess(C, Eigen::VectorXd::Zero(C.cols()), false));
    t.gain = t.assessment.gain;
    t.gain_error = t.assessment.gain_error;
    t.block_gain = t.assessment.block_gain;
    test(t);
    for (Eigen::Index j = 0; j < C.cols(); ++j) t.value.push_back(t.assessment.strength[j]);
    if (t.p_value < 0.01) t.best_balance_gain = screen.best_balance_fall(C, t.assessment);
    if (!plausible_sign(c, t.value)) return t; // its bound stops it
    t.error_reduction = t.assessment.error_reduction;
    t.leaves_active_set = screen.leaves_active_set(t.assessment.change);
    return t;
}

void scan(Trial &t, Problem &base, const Screen &screen) {
    const Candidate &c = t.candidate;
    if (((c.touched & stage_motion) == 0 && !is_delay(c)) || c.strengths.size() != 1 || c.maximum.empty()) return;
    Physics at = base.physics();
    c.prepare(at);
    const double linear = t.value[0], largest = linear < 0 && c.minimum[0] < 0 ? c.minimum[0] : c.maximum[0];
    std::vector<double> sizes = {linear, 2 * linear, 0.5 * largest};
    if (std::fabs(linear) < 0.1 * std::fabs(largest))
        sizes = {linear, 0.1 * largest, 0.25 * largest, 0.5 * largest}; // a poor baseline hides large ones
    if (strongly_nonlinear(c.effect)) sizes = {c.of_interest[0], 0.1 * largest, 0.25 * largest, 0.5 * largest, 0.8 * largest};
    double best = screen.error();
    const double before = best;
    double too_large = std::numeric_limits<double>::infinity(); // from where on the error only rises
    std::vector<double> seen;                                   // where sizes end at the same bound
    for (const double wanted : sizes) {
        const double size = clamped(c, 0, wanted);
        if (std::fabs(size) < 0.1 * c.of_interest[0] || std::fabs(size) > too_large) continue;
        if (std::find(seen.begin(), seen.end(), size) != seen.end()) continue;
        seen.push_back(size);
        Physics moved = at;
        c.strengths[0].add(moved, size);
        Eigen::VectorXd change;
        const double error = screen.profiled_error(base.scaled_residual(moved, c.touched), change);
        if (error > clearly_worse * before && !strongly_nonlinear(c.effect)) too_large = std::min(too_large, std::fabs(size));
        if (!(error < best)) continue;
        best = error;
        t.start = {size};
        t.start_change = change;
    }
    const double by_step = plausible_sign(c, t.value) && !strongly_nonlinear(c.effect) ? t.error_reduction : 0;
    t.error_reduction = std::max(by_step, before - best);
    t.nonlinear_reduction = t.error_reduction - by_step;
}

void refit(Trial &t, const Problem &base, const Screen &base_screen) {
    const bool scanned = is_delay(t.candidate) && !t.start.empty() && t.start[0] != clamped(t.candidate, 0, t.value[0]);
    const bool linear = !scanned && (t.candidate.touched == stage_sensors || t.candidate.touched == stage_torque);
    if (linear && !t.leaves_active_set) { // the step is the fit
        t.refitted = true;
        t.baseline = base.theta + t.assessment.change;
        return;
    }
    Problem problem = beside(base, t.candidate);
    const Eigen::Index n = base.theta.size();
    const auto k = static_cast<Eigen::Index>(t.candidate.strengths.size());
    for (Eigen::Index j = 0; j < k; ++j) {
        const auto i = static_cast<std::size_t>(j);
        const FreeParameter &p = t.candidate.strengths[i];
        double start = clamped(t.candidate, i, i < t.start.size() ? t.start[i] : t.value[i]);
        if (!t.candidate.of_interest.empty() && std::fabs(start) < 1e-3 * (p.maximum - p.minimum)) start = t.candidate.of_interest[i];
        problem.theta[n + j] = start;
    }
    if ((t.candidate.touched & stage_motion) != 0 || t.leaves_active_set || scanned) {
        if (linear)
            t.start_change = t.assessment.change;
        else if (t.start.empty())
            shorten(problem, n);
        if (t.start_change.size() == n) problem.theta.head(n) += t.start_change, problem.within_bounds();
        const bool remembers = strongly_nonlinear(t.candidate.effect);
        problem.gauss_newton(remembers || t.leaves_active_set ? 8 : 3); // the soil's curve is strongly nonlinear: fresh sensitivities
        if (remembers && k == 1) { // from the baseline's place too, for a linear step of its numbers goes astray
            Problem there = problem;
            there.theta.head(n) = base.theta;
            if (std::optional<Problem> other = from_afar(there, static_cast<std::size_t>(n), problem.cost())) problem = std::move(*other);
        }
    } else {
        problem.quick_fit(base, 3);
    }
    const Screen screen(problem, n);
    take(t, screen.assess(problem.jacobian.rightCols(k), problem.theta.tail(k), true));
    t.refitted = true;
    t.baseline = problem.theta.head(n);
    t.value.clear();
    for (Eigen::Index j = 0; j < k; ++j) t.value.push_back(problem.theta[n + j]);
    t.gain = base_screen.heldout_error() - (screen.heldout_error() - t.assessment.gain);
    t.assessment.prior_reduction += base_screen.penalty() - screen.penalty();
    t.assessment.spared += base_screen.deviations() - screen.deviations();
    t.block_gain = base_screen.block_error() - (screen.block_error() - t.assessment.block_gain);
    test(t);
    t.gain_error = sum_error(t.block_gain);
    const Screen with(problem);
    t.error_reduction = base_screen.error() - with.error();
    t.best_balance_gain = 0;
    const std::vector<double> before = base_screen.heldout_by_balance(), after = with.heldout_by_balance();
    for (std::size_t b = 0; b < before.size(); ++b)
        if (before[b] > 0) t.best_balance_gain = std::max(t.best_balance_gain, 1 - after[b] / before[b]);
}

std::vector<double> sizes_of(const Trial &t, const Problem &fit) {
    std::vector<double> size;
    for (std::size_t i = fit.parameters.size() - t.value.size(); i < fit.parameters.size(); ++i)
        size.push_back(fit.parameters[i].base + fit.theta[static_cast<Eigen::Index>(i)]);
    return size;
}

void fit_from_the_sheet(const Trial &t, const Model &model, const Dataset &data, Problem &problem) {
    const auto from = [&](const std::vector<double> &size) {
        Model with = model;
        with.effects.push_back(effect_of(t.candidate, size));
        return fitted_problem(with, data);
    };
    for (const double by : {1.0, 2.0}) {
        std::vector<double> size;
        for (std::size_t j = 0; j < t.value.size(); ++j)
            size.push_back(std::clamp(by * t.value[j], t.candidate.strengths[j].minimum, t.candidate.strengths[j].maximum));
        const Problem first = from(size);
        if (!(overall_error(first) < overall_error(problem))) continue;
        if (Problem again = from(sizes_of(t, first)); overall_error(again) < overall_error(problem)) problem = std::move(again);
    }
}

namespace {

// Of its size: such a law's own fit does.
bool linear_step_says_nothing(const Trial &t) { return !t.refitted && strongly_nonlinear(t.candidate.effect); }

} // namespace

void judge(Trial &t, double explainable, const DiagnoseOptions &options) {
    t.by_rows = t.gain > std::max(options.least_gain * explainable, least_gain_squares) ||
                t.best_balance_gain > options.least_gain_one; // ranks know nothing of the priors' penalty
    t.matters = t.by_rows && t.gain > share_that_matters * explainable;
    const bool gains = t.gain > 0 && (t.by_rows || t.assessment.spared > options.least_prior_reduction);
    if (!((t.by_rows ? t.p_value : t.own_p_value) < options.p_limit) || !gains)
        t.verdict = "not_significant";
    else if (!plausible_sign(t.candidate, t.value))
        t.verdict = "wrong_sign";
    else if (!t.matters && !linear_step_says_nothing(t) && !large_enough(t.candidate, t.refitted ? near_ends(t) : t.value))
        t.verdict = "too_small";
    else if (t.refitted && beyond_range(t.candidate, t.value))
        t.verdict = "beyond_range";
    else
        t.verdict = "passes";
}

CandidateResult result_of(const Trial &t, double base_error, const Screen &screen) {
    CandidateResult r;
    r.candidate = t.candidate;
    r.value = t.value;
    for (std::size_t j = 0; j < t.value.size(); ++j) {
        r.low.push_back(t.value[j] - t.half_width[j]);
        r.high.push_back(t.value[j] + t.half_width[j]);
        if (t.error[j] > 0 && std::isfinite(t.error[j])) r.detectability = std::max(r.detectability, std::fabs(t.value[j]) / t.error[j]);
    }
    const double unit = base_error > 0 ? 1 / base_error : 0;
    r.gain_squares = t.gain;
    r.heldout_gain = t.gain * unit;
    r.gain_low = (t.gain - 1.96 * t.gain_error) * unit;
    r.gain_high = (t.gain + 1.96 * t.gain_error) * unit;
    r.p_value = t.p_value;
    r.verdict = t.verdict;
    r.sheet_alone = t.sheet_alone;
    r.matters = t.matters;
    if (const sim::Effect *effect = sim::find_effect(t.candidate.effect)) r.explains = std::string(effect->signature);
    std::vector<std::pair<double, std::size_t>> order;
    double positive = 0;
    for (Eigen::Index b = 0; b < t.block_gain.size(); ++b) {
        order.emplace_back(t.block_gain[b], static_cast<std::size_t>(b));
        positive += std::max(0.0, t.block_gain[b]);
    }
    std::stable_sort(order.begin(), order.end(), [](const auto &a, const auto &b) { return a.first > b.first; });
    for (std::size_t i = 0; i < std::min<std::size_t>(3, order.size()) && positive > 0; ++i)
        if (order[i].first > 0) r.evidence.push_back({screen.blocks()[order[i].second], order[i].first / positive});
    return r;
}

} // namespace traction::lab
