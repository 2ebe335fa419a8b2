#include "rounds.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <string_view>

namespace traction::lab {

namespace {

constexpr double part_of_range = 0.25;          // of the catalogue's: assumed
constexpr double by_far = 2, share_taken = 0.5; // times noise; of the squares beyond it (assumed)
constexpr double not_unlikely = 150;            // times the limit of the corrected p: below a half
constexpr double elsewhere = 0.5;               // of a size: a refit that ends so far from where it was sure is another one (assumed)
// Of the held-out error, by which a name must lower it at least: an hour of rows makes less than this significant, and the laws of no
// machine and the steps of no integration are known that well. What one sensor shows alone hardly moves the error of all: then of its
// own, less what it adds to another's. Assumed.
constexpr double least_fall = 0.002, least_fall_of_one = 0.02;
// From where on the rows speak for a name and not the data sheet, as the answer has it (result/story.cpp).
constexpr double fall_told = 0.01, fall_told_of_one = 0.03;
// The same of what wanders: 6 % of the squares, as of the ground's shapes over time and path. Of 70 clean logs four had such a name by 0.3
// to 2 %; of 115 with one hidden effect six such names fell by 14 % and more, all true.
constexpr double least_fall_of_ground = 0.03;

std::string figures(double value) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, "%.3g", value);
    return buffer;
}

bool larger_reduction(const Trial &a, const Trial &b) { return a.error_reduction > b.error_reduction; }

} // namespace

void BestVariants::add(Trial t) {
    const auto found = best_.find(t.candidate.label());
    if (found == best_.end()) {
        order_.push_back(t.candidate.label());
        best_.emplace(t.candidate.label(), std::move(t));
    } else if (t.error_reduction > found->second.error_reduction) {
        found->second = std::move(t);
    }
}

std::vector<Trial> BestVariants::take() {
    std::vector<Trial> trials;
    for (const std::string &key : order_) trials.push_back(std::move(best_.at(key)));
    best_.clear(), order_.clear();
    return trials;
}

void refit_likely(std::vector<Trial> &trials, int refits, const Refit &refit_and_judge) {
    double best = 0; // of the held-out gains that passed
    std::vector<Trial *> order;
    for (Trial &t : trials) order.push_back(&t);
    const auto refit_some = [&](int most, auto &&likely, auto &&before) {
        std::stable_sort(order.begin(), order.end(), [&](const Trial *a, const Trial *b) { return before(*a, *b); });
        for (Trial *t : order) {
            if (t->refitted || !likely(*t)) continue;
            if (most-- <= 0) return;
            if (refit_and_judge(*t)) best = std::max(best, t->gain);
        }
    };
    refit_some(
        refits, [&](const Trial &t) { return t.p_value < 0.2 && t.error_reduction > least_reduction && t.error_reduction > 0.5 * best; },
        [](const Trial &a, const Trial &b) { return a.assessment.p_value < b.assessment.p_value; });
    // what passed may be surer, but explain less; or the linear test was made where it cannot be trusted
    refit_some(
        3,
        [&](const Trial &t) {
            return t.error_reduction > std::max(3 * least_reduction, (t.leaves_active_set ? 0.5 : t.p_value < 0.2 ? 0.7 : 0.9) * best);
        },
        larger_reduction);
    refit_some(
        3,
        [&](const Trial &t) {
            return t.nonlinear_reduction > std::max(3 * least_reduction, 0.3 * t.error_reduction) && t.error_reduction > 0.5 * best;
        },
        larger_reduction);
}

bool refit_passing(std::vector<Trial> &trials, int refits, const Refit &refit_and_judge) {
    std::vector<Trial *> order;
    for (Trial &t : trials)
        if (t.verdict == "passes" && !t.refitted) order.push_back(&t);
    std::stable_sort(order.begin(), order.end(),
                     [](const Trial *a, const Trial *b) { return a->assessment.p_value < b->assessment.p_value; });
    bool any = false;
    for (std::size_t i = 0; i < order.size() && i < static_cast<std::size_t>(refits); ++i) any = refit_and_judge(*order[i]) || any;
    return any;
}

bool refit_from_afar(std::vector<Trial> &trials, const Refit &refit_and_judge) {
    bool any = false;
    for (Trial &t : trials) {
        const Candidate c = t.candidate;
        if (c.wheel >= 0 || c.strengths.size() != 1 || c.maximum.empty() || (c.touched & stage_motion) == 0) continue;
        for (const double end : {c.maximum[0], std::min(0.0, c.minimum[0])}) {
            if (end == 0) continue;
            Trial afar = t;
            afar.start = {part_of_range * end};
            afar.start_change.resize(0);
            if (refit_and_judge(afar) && (t.verdict != "passes" || afar.gain > t.gain)) t = std::move(afar), any = true;
        }
    }
    return any;
}

void judge_beyond_range(std::vector<Trial> &trials, double base_error, std::vector<std::string> &messages) {
    double most = 0;
    Trial *best = nullptr;
    for (Trial &t : trials) {
        if (t.verdict == "passes" && t.refitted) most = std::max(most, t.gain);
        if (t.verdict == "beyond_range" && !t.candidate.bounded && (best == nullptr || t.gain > best->gain)) best = &t;
    }
    if (best == nullptr || !(best->gain > most)) return;
    const bool much = best->gain > std::max(1.1 * most, 0.1 * base_error);
    if (much) best->at_least = true, best->verdict = "passes";
    const std::string told = best->candidate.label() + " explains ";
    if (std::any_of(messages.begin(), messages.end(), [&](const std::string &m) { return m.starts_with(told); }))
        return; // in an earlier round
    messages.push_back(told + figures(100 * best->gain / base_error) + " % of the held-out error, but only beyond its range (" +
                       best->candidate.strengths[0].key + " at " + figures(best->value[0]) +
                       (much ? "): read its size as at least that" : "): not named"));
}

const Trial *better_place(const std::vector<Trial> &trials) {
    const Trial *best = nullptr;
    for (const Trial &t : trials)
        if (t.refitted && t.verdict != "passes" && t.p_value > 0.2 && t.error_reduction > 3 * least_reduction &&
            (best == nullptr || t.error_reduction > best->error_reduction))
            best = &t;
    return best;
}

std::size_t most_beyond(const std::vector<Trial> &trials, double gain) {
    std::size_t best = trials.size();
    for (std::size_t i = 0; i < trials.size(); ++i)
        if (trials[i].verdict == "passes" && trials[i].refitted && trials[i].gain > (best < trials.size() ? trials[best].gain : gain))
            best = i;
    return best;
}

void take_increments(Problem &problem, const Problem &from) {
    for (std::size_t i = 0; i < problem.parameters.size(); ++i)
        for (std::size_t j = 0; j < from.parameters.size(); ++j) {
            const FreeParameter &a = problem.parameters[i], &b = from.parameters[j];
            if (is_same(a, b) && a.base == b.base) problem.theta[static_cast<Eigen::Index>(i)] = from.theta[static_cast<Eigen::Index>(j)];
        }
}

bool predicts_better(const Problem &before, const Problem &after) {
    const HeldOut left_before = held_out(before), left_after = held_out(after);
    return fall_between(left_before, left_after, noise_weight(before)).sure() &&
           fall_between(left_before, left_after, before.row_scale.cwiseAbs2()).sure();
}

bool stays(const std::string &verdict, bool solid, const std::function<bool()> &predicts, const std::function<bool()> &most) {
    return (solid && (verdict == "passes" || verdict == "beyond_range" || predicts())) || most();
}

bool lost(const Trial &now, const Earlier &earlier) {
    if (now.candidate.variant != earlier.variant || (now.candidate.touched & stage_motion) == 0) return false;
    for (std::size_t j = 0; j < now.value.size(); ++j)
        if (std::fabs(now.value[j] - earlier.value[j]) > elsewhere * std::fabs(earlier.value[j])) return true;
    return false;
}

double worst_error(const HeldOut &held, const Dataset &data, const Eigen::VectorXd &noise_rows) {
    const Eigen::VectorXd squares = held.residual.cwiseQuotient(noise_rows).cwiseAbs2();
    Eigen::Index row = 0;
    double most = 0;
    for (const Balance &b : data.balance) {
        const auto n = static_cast<Eigen::Index>(b.measured.size());
        if (n > 0) most = std::max(most, squares.segment(row, n).mean());
        row += n;
    }
    return std::sqrt(most);
}

namespace {

bool is_most(double before, double after) { // squares, in units of noise
    return before > by_far * by_far && after - 1 < (1 - share_taken) * (before - 1);
}

} // namespace

bool takes_most(const HeldOut &before, const HeldOut &after) { return is_most(before.error * before.error, after.error * after.error); }

bool takes_most_of_one(const HeldOut &before, const HeldOut &after, const Dataset &data, const Eigen::VectorXd &noise_rows) {
    const Eigen::VectorXd was = before.residual.cwiseQuotient(noise_rows).cwiseAbs2(),
                          is = after.residual.cwiseQuotient(noise_rows).cwiseAbs2();
    Eigen::Index row = 0;
    for (const Balance &b : data.balance) {
        const auto n = static_cast<Eigen::Index>(b.measured.size());
        if (n > 0 && is_most(was.segment(row, n).mean(), is.segment(row, n).mean())) return true;
        row += n;
    }
    return false;
}

double unlikely_from(double p_limit) { return not_unlikely * p_limit; }

constexpr double ground_wanders_by = 5; // times the noise: patches took most of 2.2 that uneven ground or two grounds had left

bool is_of_few_blocks(const Trial &trial, double p_limit) {
    return is_patch(trial.candidate.effect) && !(trial.p_value < unlikely_from(p_limit));
}

std::vector<std::size_t> worth_scales_of_its_own(const std::vector<Trial> &trials, double p_limit, double heldout_error) {
    std::vector<std::size_t> list;
    for (std::size_t i = 0; i < trials.size(); ++i) {
        const Trial &t = trials[i];
        const bool likely = t.p_value < unlikely_from(p_limit) || (is_of_few_blocks(t, p_limit) && heldout_error > ground_wanders_by);
        if (t.verdict == "not_significant" && t.refitted && likely && t.gain > 0 && plausible_sign(t.candidate, t.value) &&
            large_enough(t.candidate, t.value) && !beyond_range(t.candidate, t.value))
            list.push_back(i);
    }
    std::stable_sort(list.begin(), list.end(), [&](std::size_t a, std::size_t b) { return larger_reduction(trials[a], trials[b]); });
    if (list.size() > 3) list.resize(3);
    return list;
}

bool wanders(const Candidate &c) {
    static constexpr std::string_view laws[] = {"soil_patch", "resistance_patch", "soil_gradient", "relaxation_length"};
    return std::find(std::begin(laws), std::end(laws), c.effect) != std::end(laws);
}

bool of_another_sensor(const Candidate &c) {
    static constexpr std::string_view sensors[] = {"radar_", "camera_", "gyro_"};
    return std::any_of(std::begin(sensors), std::end(sensors), [&](std::string_view name) { return c.effect.starts_with(name); });
}

bool stands_beside_bent_sheet(const Candidate &candidate, double p_value, double error_left) {
    constexpr double sure_rows = 1e-8; // names for the sheet's sake that were not there had 1e-5 and more; one that is had 1e-19 (925021)
    return p_value < sure_rows || (of_another_sensor(candidate) && error_left < strange);
}

namespace {

bool falls_by(double of_all, double of_one, const HeldOut &before, const HeldOut &after, const Dataset &data) {
    Eigen::Index row = 0;
    double most = 0, rise = 0;
    for (const Balance &b : data.balance) {
        const auto n = static_cast<Eigen::Index>(b.measured.size());
        const double was = before.residual.segment(row, n).norm();
        const double fall = was > 0 ? 1 - after.residual.segment(row, n).norm() / was : 0;
        most = std::max(most, fall), rise = std::max(rise, -fall);
        row += n;
    }
    return after.error < (1 - of_all) * before.error || most - rise > of_one; // what one gains at another's cost is nothing
}

} // namespace

bool falls_notably(const HeldOut &before, const HeldOut &after, const Dataset &data, bool wanders) {
    if (wanders) return after.error < (1 - least_fall_of_ground) * before.error;
    return falls_by(least_fall, least_fall_of_one, before, after, data);
}

bool falls_without_the_sheet(const HeldOut &before, const HeldOut &after, const Dataset &data) {
    return falls_by(fall_told, fall_told_of_one, before, after, data);
}

} // namespace traction::lab
