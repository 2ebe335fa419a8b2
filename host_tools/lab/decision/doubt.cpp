#include "doubt.h"

#include "host_tools/lab/fit/distribution.h"
#include "host_tools/lab/fit/heldout.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/forward/rounding.h"
#include "rounds.h"
#include "suspects.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace {

constexpr double beyond_a_sheet = 3; // stated deviations: a datum that the fit itself takes beyond these and its gross ratio is wrong
constexpr double most_chance = 0.01; // that so many blocks left out gain by it as do: ten that all gain have 0.001

} // namespace

std::vector<double> misfits(const Problem &problem) {
    std::vector<double> out;
    const Eigen::VectorXd noise = problem.noise_rows();
    Eigen::Index row = 0;
    for (const Balance &balance : problem.data().balance) {
        double left = 0, signal = 0;
        for (const double y : balance.measured) {
            left += std::pow(problem.residual[row], 2) - std::pow(noise[row], 2);
            signal += y * y;
            ++row;
        }
        out.push_back(signal > 0 ? std::sqrt(std::max(0.0, left) / signal) : 0);
    }
    return out;
}

double worst_misfit(const Problem &problem) {
    const std::vector<double> m = misfits(problem);
    double worst = 0;
    for (std::size_t b = 0; b < m.size(); ++b) {
        const BalanceKind kind = problem.data().balance[b].kind;
        if (kind == BalanceKind::current_torque || kind == BalanceKind::current_voltage || kind == BalanceKind::radar ||
            kind == BalanceKind::camera_x || kind == BalanceKind::force || kind == BalanceKind::torque)
            worst = std::max(worst, m[b]);
    }
    return worst;
}

namespace {

// A datum set free, with the problem that its value comes from.
struct Freed {
    Suspect suspect;
    const Datum *datum = nullptr;
    std::optional<Problem> problem;
};

// The datum from `start` times what is stated; where it ends at the edge of what it may be, once more from there.
Freed gross_error(const Model &stated, const Dataset &data, const Datum &datum, double start, const Problem *near = nullptr) {
    Freed out;
    out.datum = &datum;
    for (int round = 0; round < 4; ++round) {
        Model model = stated;
        const std::vector<Parameter *> values = values_of(model, datum);
        const double value = values.empty() ? 0 : values.front()->value;
        if (!set_free(model, datum, start)) return {};
        const Physics physics = make_physics(model);
        Problem problem(data, physics, free_parameters(model, physics));
        if (near != nullptr) take_increments(problem, *near);
        problem.fit({.iterations = 3, .ready = false});
        const double error = overall_error(problem);
        double moved = 0, ratio = 1;
        std::string unit;
        for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
            const FreeParameter &p = problem.parameters[i];
            if (p.owner != datum.table || p.key != datum.key || p.run >= 0) continue;
            moved = p.base + problem.theta[static_cast<Eigen::Index>(i)], ratio = moved / p.base, unit = p.unit;
            break;
        }
        if (unit.empty() || !std::isfinite(error)) return out;
        if (out.suspect.quantity.empty() || error < out.suspect.error) {
            out.suspect = {datum.name, value, moved, unit, error, datum.gross, datum.more_is_an_effect};
            out.problem = std::move(problem);
        }
        const std::optional<double> next = from_the_edge(start, ratio);
        if (!next) return out;
        start = *next;
    }
    return out;
}

// A search for the track ends in a valley of its own where it begins far from it: on the stretch where the model fails most it is found
// from either side, on the whole log from there.
Freed best_track(const Model &stated, const Problem &first) {
    const auto best_from = [&](const Dataset &data, std::initializer_list<double> starts, const Problem *near) {
        Freed best;
        for (const double start : starts)
            if (Freed f = gross_error(stated, data, track(), start, near);
                !f.suspect.quantity.empty() && (best.suspect.quantity.empty() || f.suspect.error < best.suspect.error))
                best = std::move(f);
        return best;
    };
    const Freed there = best_from(worst_stretch(first), {1.0, 0.9, 1.1}, nullptr);
    return there.suspect.quantity.empty() ? Freed() : best_from(first.data(), {there.suspect.fitted / there.suspect.stated}, &first);
}

std::vector<Freed> freed(const Model &stated, const Dataset &data, const std::vector<const Datum *> &asked) {
    std::vector<Freed> found;
    const auto less = [](const Freed &a, const Freed &b) { return a.suspect.error < b.suspect.error; };
    const auto from = [&](Freed &f, double start) {
        if (Freed other = gross_error(stated, data, *f.datum, start); !other.suspect.quantity.empty() && less(other, f))
            f = std::move(other);
    };
    for (const Datum *datum : asked)
        if (Freed f = gross_error(stated, data, *datum, 1); !f.suspect.quantity.empty()) found.push_back(std::move(f));
    std::stable_sort(found.begin(), found.end(), less);
    for (std::size_t i = 0; i < found.size(); ++i) { // a valley that a search from where it stands does not see
        if (i < 3)
            for (const double start : {0.25, 4.0}) from(found[i], start);
        if (std::string(found[i].datum->key) == "mu") from(found[i], 15); // where nothing grips nothing tells the grip
    }
    std::stable_sort(found.begin(), found.end(), less);
    return found;
}

// Those that may bring the error below `need` times what it is, on the whole log: a datum that does not go half of that way where the model
// fails most does not go all of it on the whole log.
std::vector<const Datum *> promising_data(const Model &stated, const Problem &first, double need) {
    const Dataset part = worst_stretch(first);
    if (part.count == first.data().count) return all_data();
    const double before = error_within(first, part);
    std::vector<const Datum *> list;
    for (const Freed &f : freed(stated, part, all_data()))
        if (f.suspect.error < 0.5 * (1 + need) * before) list.push_back(f.datum);
    return list;
}

// The model with the numbers of its fit.
Model stored(const Model &stated, const Problem &fitted) {
    Model model = stated;
    for (std::size_t i = 0; i < fitted.parameters.size(); ++i)
        store(model, fitted.parameters[i], fitted.theta[static_cast<Eigen::Index>(i)], 0);
    return model;
}

// A datum that the fit within the priors has itself taken beyond its sheet, in the mean over the wheels.
std::optional<Suspect> moved_by_the_fit(Model &before, Model &after, const Datum &datum) {
    const std::vector<Parameter *> was = values_of(before, datum), is = values_of(after, datum);
    double value = 0, fitted = 0, prior = 0;
    for (std::size_t i = 0; i < was.size() && i < is.size(); ++i) value += was[i]->value, fitted += is[i]->value, prior += was[i]->prior;
    if (!(value > 0) || !(std::fabs(fitted - value) > beyond_a_sheet * prior)) return std::nullopt;
    const auto n = static_cast<double>(was.size());
    return Suspect{datum.name, value / n, fitted / n, was.front()->unit, 0, datum.gross, datum.more_is_an_effect};
}

// Data that the fit within the priors has itself moved grossly (the sheet's deviation was too wide to hold them), and without which it
// describes the log notably worse, and blocks left out by their ranks: what uneven ground does to a soil's stiffness is less, and a few
// turns in which wheels spin are not the log. A soil that is too soft also predicts better because it does not follow the encoders'
// scatter ((1) of forward/rounding.h): what that may be is no evidence.
std::vector<Suspect> moved_grossly(const Model &stated, const Problem &first, double &held_error) {
    Model before = stated, after = stored(stated, first), held = stated;
    std::vector<Suspect> out;
    for (const Datum *one : all_data()) {
        const std::optional<Suspect> s = moved_by_the_fit(before, after, *one);
        if (!s || !is_gross(*s) || std::fabs(s->fitted - s->stated) < one->little) continue;
        out.push_back(*s);
        out.back().error = overall_error(first);
        for (Parameter *stays : values_of(held, *one)) stays->fixed = true;
    }
    if (out.empty()) return out;
    const Physics physics = make_physics(held);
    Problem as_stated(first.data(), physics, free_parameters(held, physics));
    as_stated.fit({.iterations = 3, .ready = false});
    const Eigen::VectorXd smoothed = rounding_squares(first.data(), as_stated.physics()) - rounding_squares(first.data(), first.physics());
    const double error = overall_error(as_stated);
    if (!(overall_error(first) < notable * error_less(as_stated, smoothed))) return {}; // the log hardly asks for them: they wander
    as_stated.keep_scales(first);
    as_stated.get_ready();
    as_stated.gauss_newton(2);
    const Fall fall = fall_between(held_out(as_stated), held_out(first), first.row_scale.cwiseAbs2());
    if (!(signed_rank_tail({fall.of_block.begin(), fall.of_block.end()}) < most_chance)) return {};
    held_error = error;
    return out;
}

// By how many standard errors the freed datum predicts blocks left out better than the model with what was named.
double lead_of(const Problem &last, Problem &datum) {
    datum.get_ready();
    datum.keep_scales(last);
    datum.gauss_newton(2);
    const Fall fall = fall_between(held_out(last), held_out(datum), noise_weight(last));
    return fall.error > 0 ? fall.sum / fall.error : fall.sum;
}

} // namespace

std::optional<double> taken_by_the_fit(const Model &stated, const Problem &fitted, std::string_view effect) {
    const Datum *datum = number_of(effect);
    if (datum == nullptr) return std::nullopt;
    Model before = stated, after = stored(stated, fitted);
    const std::optional<Suspect> s = moved_by_the_fit(before, after, *datum);
    return s && is_gross(*s) ? std::optional<double>(s->fitted / s->stated - 1) : std::nullopt;
}

std::vector<Suspect> gross_errors(const Model &stated, const Dataset &data) {
    std::vector<Suspect> out;
    for (Freed &f : freed(stated, data, all_data())) out.push_back(std::move(f.suspect));
    return out;
}

std::optional<Doubt> doubt(const Model &stated, const Dataset &data, Problem &first, const Problem &last, std::size_t accepted,
                           double shape_gain) {
    const double before = overall_error(first), after = overall_error(last), worst = worst_misfit(last);
    bool at_bound = false;
    for (std::size_t i = 0; i < first.parameters.size(); ++i) at_bound = at_bound || first.at_bound(i);
    const bool nothing_found = accepted == 0 && !(shape_gain > 0), far_off = nothing_found && is_no_ground(after);
    Doubt out;
    out.error = before;
    if (nothing_found) out.suspects = moved_grossly(stated, first, out.error);
    const bool scales = names_several_scales(last),
               suspicious = at_bound || far_off || !out.suspects.empty() || is_suspicious(worst_misfit(first), accepted, before, after);
    if (!suspicious && !scales) return std::nullopt;
    const double left = after * (1 - shape_gain);
    const double need = largest_share(accepted, before, left);
    std::vector<Freed> found; // looked for where that is cheap; everywhere where nothing is known of so large an error
    if (suspicious && is_no_ground(before))
        found = freed(stated, data, all_data());
    else if (suspicious && (data.independent_rows || fit_scatter(first) < need * before))
        found = freed(stated, data, promising_data(stated, first, need));
    if (scales || (suspicious && first.data().yaw_free)) found.push_back(best_track(stated, first));
    for (Freed &f : found) {
        if (f.suspect.quantity.empty()) continue;
        const auto lead = [&] { return lead_of(last, *f.problem); };
        const auto relieves = [&] { return strained(last) && !strained(*f.problem); };
        if (scales && f.datum == &track() && does_as_much(f.suspect, before, left))
            out.suspects.push_back(f.suspect);
        else if (is_suspect(f.suspect, accepted, before, left, relieves, lead, [&] { return kin_of(last, *f.datum); }))
            out.suspects.push_back(std::move(f.suspect));
    }
    out.suspects = told_once(std::move(out.suspects));
    if (out.suspects.empty() && !describes_nothing(worst) && !far_off) return std::nullopt;
    out.text = what_to_look_at(out.suspects, worst);
    return out;
}

} // namespace traction::lab
