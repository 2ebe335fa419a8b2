#include "doubt.h"

#include "host_tools/lab/fit/heldout.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/forward/rounding.h"
#include "host_tools/lab/inputs/smooth.h"
#include "host_tools/lab/inputs/stretch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace traction::lab {

namespace {

constexpr double suspicious = 0.15;       // (1) of the worst balance, before effects
constexpr double describes_nothing = 0.9; // (1) of the worst balance, with all that was accepted
constexpr double never_nothing = 25;      // times noise: uneven ground leaves 3 to 6, what no effect or shape explains at 25 is no ground
constexpr double several_names = 1.1;     // one wrong number is simpler than two effects
constexpr double one_name = 0.9;          // it must explain more than one effect, or than a shape does
constexpr double much_better = 0.5;       // of the error as stated
constexpr double better = 0.75;           // the same, where an effect was named
constexpr double as_much = 1.02;          // of the error that what was named leaves
constexpr double notable = 0.95;          // of the error as stated: a mass that a log hardly tells wanders for less
constexpr double sure = 2;                // standard errors of the blocks' differences
constexpr double beyond_a_sheet = 3;      // stated deviations: a datum that the fit itself takes beyond these and its gross ratio is wrong

constexpr double looked_at_s = 20; // what is grossly wrong shows wherever the model fails: there each datum is tried first

// What a data sheet, a ruler or a scale says, and how a mistake in it is looked for.
struct Datum {
    const char *table, *key, *name;
    double gross = 1.4; // times, or one over: a data sheet, a scale is not wrong by that much, and no effect of the catalogue is as large
    bool more_is_an_effect = false; // of the catalogue: whether it is the cause has been decided there, only less is a matter of the model
};
constexpr Datum data_of_a_model[] = {
    {"rover", "mass_kg", "the mass", 1.3}, // on stiff ground a log was seen to tell it no better than 1.2
    {"wheel", "radius_m", "the wheels' radius", 1.25},
    {"motor", "torque_constant_Nm_A", "the torque constant (of the wheel's side of the gear)"},
    {"motor", "back_emf_Vs_rad", "the back-EMF (of the wheel's side of the gear)"},
    {"motor", "resistance_ohm", "the motors' resistance", 1.4, true},
    {"motor", "inertia_kg_m2", "the inertia at the wheel"},
    {"motor", "coulomb_Nm", "the dry friction of the drives", 1.4, true},
    {"motor", "viscous_Nms", "the viscous friction of the drives", 1.4, true},
    {"soil", "mu", "the ground's grip"},
    {"soil", "rolling_coefficient", "the rolling resistance", 1.4, true},
    {"soil", "shear_slip", "the soil law's stiffness"},
};

std::vector<Parameter *> values_of(Model &model, const Datum &datum) {
    std::vector<Parameter *> out;
    const std::string table = datum.table;
    const auto take = [&](Parameters &from) {
        if (const auto found = from.find(datum.key); found != from.end()) out.push_back(&found->second);
    };
    if (table == "rover") take(model.rover);
    for (WheelSpec &wheel : model.wheel)
        if (table != "rover") take(table == "wheel" ? wheel.geometry : table == "motor" ? wheel.motor : wheel.soil);
    return out;
}

// The datum times `start`, free from a hundredth to six times that.
bool set_free(Model &model, const Datum &datum, double start) {
    bool any = false;
    for (Parameter *p : values_of(model, datum)) {
        if (!(p->value > 0)) continue;
        p->value *= start;
        p->prior = p->value;
        p->fixed = false;
        p->minimum = 0.01 * p->value, p->maximum = 6 * p->value;
        any = true;
    }
    return any;
}

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

namespace {

// A datum set free, with the problem that its value comes from.
struct Freed {
    Suspect suspect;
    const Datum *datum = nullptr;
    std::optional<Problem> problem;
};

// The datum from `start` times what is stated; where it ends at the edge of what it may be, once more from there.
Freed gross_error(const Model &stated, const Dataset &data, const Datum &datum, double start) {
    Freed out;
    out.datum = &datum;
    for (int round = 0; round < 4; ++round) {
        Model model = stated;
        const std::vector<Parameter *> values = values_of(model, datum);
        const double value = values.empty() ? 0 : values.front()->value;
        if (!set_free(model, datum, start)) return {};
        const Physics physics = make_physics(model);
        Problem problem(data, physics, free_parameters(model, physics));
        problem.fit({.iterations = 3, .ready = false});
        const double error = overall_error(problem);
        double moved = 0, ratio = 1;
        std::string unit;
        for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
            const FreeParameter &p = problem.parameters[i];
            if (p.owner != datum.table || p.key != datum.key) continue;
            moved = p.base + problem.theta[static_cast<Eigen::Index>(i)], ratio = moved / p.base, unit = p.unit;
            break;
        }
        if (unit.empty() || !std::isfinite(error)) return out;
        if (out.suspect.quantity.empty() || error < out.suspect.error) {
            out.suspect = {datum.name, value, moved, unit, error, datum.gross, datum.more_is_an_effect};
            out.problem = std::move(problem);
        }
        if (ratio > 0.03 && ratio < 5.5) return out;
        start *= ratio < 1 ? 0.05 : 5;
    }
    return out;
}

bool is_gross(const Suspect &s) { return s.fitted < s.stated / s.gross || (!s.more_is_an_effect && s.fitted > s.stated * s.gross); }

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

std::vector<const Datum *> all_data() {
    std::vector<const Datum *> list;
    for (const Datum &datum : data_of_a_model) list.push_back(&datum);
    return list;
}

// The part of the log where the model leaves the most, balance by balance; a row counts as four times its balance's mean at most.
Dataset worst_stretch(const Problem &first) {
    const Dataset &data = first.data();
    const double end = data.time(data.count - 1), step = 0.25 * looked_at_s;
    if (data.independent_rows || end - data.start_s < 2 * looked_at_s) return data;
    const Eigen::VectorXd squares = first.residual.cwiseQuotient(first.noise_rows()).cwiseAbs2();
    std::vector<double> left(static_cast<std::size_t>((end - data.start_s) / step) + 1, 0); // of each quarter of a stretch
    Eigen::Index row = 0;
    for (const Balance &b : data.balance) {
        const auto n = static_cast<Eigen::Index>(b.measured.size());
        const double mean = squares.segment(row, n).mean();
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) {
            const double place =
                std::clamp((0.5 * (b.t0_s[r] + b.t1_s[r]) - data.start_s) / step, 0.0, static_cast<double>(left.size() - 1));
            left[static_cast<std::size_t>(place)] += std::min(4 * mean, squares[row]) / static_cast<double>(n);
        }
    }
    std::size_t best = 0;
    double most = 0;
    for (std::size_t i = 0; i + 4 <= left.size(); ++i)
        if (const double sum = left[i] + left[i + 1] + left[i + 2] + left[i + 3]; sum > most) most = sum, best = i;
    const double from = std::min(data.start_s + static_cast<double>(best) * step, end - looked_at_s);
    return stretch(data, from, from + looked_at_s);
}

// Of a fitted model on the rows of a part of its log, in units of noise, as overall_error() has it.
double error_within(const Problem &fitted, const Dataset &part) {
    const Eigen::VectorXd squares = fitted.residual.cwiseQuotient(fitted.noise_rows()).cwiseAbs2();
    const double from = part.start_s, to = part.time(part.count - 1);
    double sum = 0, balances = 0;
    Eigen::Index row = 0;
    for (const Balance &b : fitted.data().balance) {
        double own = 0, n = 0;
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row)
            if (b.t0_s[r] >= from && b.t1_s[r] <= to) own += squares[row], ++n;
        if (n > 0) sum += own / n, ++balances;
    }
    return balances > 0 ? std::sqrt(sum / balances) : 0;
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

// What no model goes below: the scatter of the residuals from row to row, which a prediction has no part in, for it follows the wheels.
double fit_scatter(const Problem &fitted) {
    const Eigen::VectorXd e = fitted.residual.cwiseQuotient(fitted.noise_rows());
    double sum = 0;
    Eigen::Index row = 0;
    for (const Balance &b : fitted.data().balance) {
        std::vector<double> bend; // second differences: of white noise, sqrt(6) times it
        for (std::size_t r = 2; r < b.measured.size(); ++r)
            bend.push_back(std::fabs(e[row + static_cast<Eigen::Index>(r)] - 2 * e[row + static_cast<Eigen::Index>(r) - 1] +
                                     e[row + static_cast<Eigen::Index>(r) - 2]));
        sum += bend.empty() ? 0 : std::pow(1.4826 * median(bend), 2) / 6;
        row += static_cast<Eigen::Index>(b.measured.size());
    }
    return fitted.data().balance.empty() ? 0 : std::sqrt(sum / static_cast<double>(fitted.data().balance.size()));
}

// The error as overall_error() has it, with `squares` of each row taken off.
double error_less(const Problem &fitted, const Eigen::VectorXd &squares) {
    const Eigen::VectorXd left = (fitted.residual.cwiseAbs2() - squares).cwiseQuotient(fitted.noise_rows().cwiseAbs2());
    double sum = 0;
    Eigen::Index row = 0;
    for (const Balance &b : fitted.data().balance) {
        const auto n = static_cast<Eigen::Index>(b.measured.size());
        if (n > 0) sum += left.segment(row, n).mean();
        row += n;
    }
    return fitted.data().balance.empty() ? 0 : std::sqrt(std::max(0.0, sum / static_cast<double>(fitted.data().balance.size())));
}

// Data that the fit within the priors has itself moved grossly (the sheet's deviation was too wide to hold them), and without which it
// describes the log notably worse: what uneven ground does to a soil's stiffness is less. A soil that is too soft also predicts better
// because it does not follow the encoders' scatter ((1) of forward/rounding.h): what that may be is no evidence.
std::vector<Suspect> moved_grossly(const Model &stated, const Problem &first, double &held_error) {
    Model before = stated, after = stated, held = stated;
    for (std::size_t i = 0; i < first.parameters.size(); ++i)
        store(after, first.parameters[i], first.theta[static_cast<Eigen::Index>(i)], 0);
    std::vector<Suspect> out;
    for (const Datum &datum : data_of_a_model) {
        const std::vector<Parameter *> was = values_of(before, datum), is = values_of(after, datum);
        double value = 0, fitted = 0, prior = 0;
        for (std::size_t i = 0; i < was.size() && i < is.size(); ++i)
            value += was[i]->value, fitted += is[i]->value, prior += was[i]->prior;
        if (!(value > 0) || !(std::fabs(fitted - value) > beyond_a_sheet * prior)) continue;
        const auto n = static_cast<double>(was.size());
        Suspect s{datum.name, value / n, fitted / n, was.front()->unit, overall_error(first), datum.gross, datum.more_is_an_effect};
        if (!is_gross(s)) continue;
        out.push_back(std::move(s));
        for (Parameter *stays : values_of(held, datum)) stays->fixed = true;
    }
    if (out.empty()) return out;
    const Physics physics = make_physics(held);
    Problem as_stated(first.data(), physics, free_parameters(held, physics));
    as_stated.fit({.iterations = 3, .ready = false});
    const Eigen::VectorXd smoothed = rounding_squares(first.data(), as_stated.physics()) - rounding_squares(first.data(), first.physics());
    if (!(overall_error(first) < notable * error_less(as_stated, smoothed))) out.clear(); // the log hardly asks for them: they wander
    if (!out.empty()) held_error = overall_error(as_stated);
    return out;
}

// Data of the sheet at their bounds.
bool strained(const Problem &problem) {
    for (std::size_t i = 0; i < problem.parameters.size(); ++i)
        for (const Datum &datum : data_of_a_model)
            if (problem.parameters[i].owner == datum.table && problem.parameters[i].key == datum.key && problem.at_bound(i)) return true;
    return false;
}

// By how many standard errors the freed datum predicts blocks left out better than the model with what was named.
double lead_of(const Problem &last, Problem &datum) {
    datum.get_ready();
    datum.keep_scales(last);
    datum.gauss_newton(2);
    const Fall fall = fall_between(held_out(last), held_out(datum), noise_weight(last));
    return fall.error > 0 ? fall.sum / fall.error : fall.sum;
}

// An effect of the catalogue that is the datum by another name: of the two the effect is told.
bool is_its_law(const Problem &last, const Datum &datum) {
    static constexpr const char *laws[][2] = {
        {"torque_constant", "torque_constant_Nm_A"}, {"current_gain", "torque_constant_Nm_A"}, {"wheel_radius", "radius_m"},
        {"shear_stiffness", "shear_slip"},           {"voltage_gain", "back_emf_Vs_rad"},      {"voltage_gain", "torque_constant_Nm_A"}};
    return std::any_of(last.parameters.begin(), last.parameters.end(), [&](const FreeParameter &p) {
        return std::any_of(std::begin(laws), std::end(laws),
                           [&](const auto &law) { return p.owner == law[0] && law[1] == std::string(datum.key); });
    });
}

} // namespace

std::vector<Suspect> gross_errors(const Model &stated, const Dataset &data) {
    std::vector<Suspect> out;
    for (Freed &f : freed(stated, data, all_data())) out.push_back(std::move(f.suspect));
    return out;
}

std::optional<Doubt> doubt(const Model &stated, const Dataset &data, Problem &first, const Problem &last, std::size_t accepted,
                           double shape_gain) {
    // Acceleration and yaw rate are near zero in a drive straight on at one speed, and what is left of them is ground: not asked.
    const auto worst_of = [](const Problem &problem) {
        const std::vector<double> m = misfits(problem);
        double worst = 0;
        for (std::size_t b = 0; b < m.size(); ++b) {
            const BalanceKind kind = problem.data().balance[b].kind;
            if (kind == BalanceKind::current_torque || kind == BalanceKind::radar || kind == BalanceKind::camera_x ||
                kind == BalanceKind::force || kind == BalanceKind::torque)
                worst = std::max(worst, m[b]);
        }
        return worst;
    };
    const double before = overall_error(first), after = overall_error(last), worst = worst_of(last);
    bool at_bound = false;
    for (std::size_t i = 0; i < first.parameters.size(); ++i) at_bound = at_bound || first.at_bound(i);
    const bool nothing_found = accepted == 0 && !(shape_gain > 0), far_off = nothing_found && after > never_nothing;
    Doubt out;
    out.error = before;
    if (nothing_found) out.suspects = moved_grossly(stated, first, out.error);
    if (!at_bound && worst_of(first) < suspicious && !far_off && out.suspects.empty() && !(accepted >= 2 && before > 1.3 * after))
        return std::nullopt;
    const double left = after * (1 - shape_gain);
    // the largest share of the error that a rule below lets a datum leave
    const double need = accepted == 0   ? std::min(much_better, one_name * left / before)
                        : accepted == 1 ? std::min(notable, as_much * left / before)
                                        : std::min(better, several_names * left / before);
    std::vector<Freed> found; // looked for where that is cheap; everywhere where nothing is known of so large an error
    if (before > never_nothing)
        found = freed(stated, data, all_data());
    else if (data.independent_rows || fit_scatter(first) < need * before)
        found = freed(stated, data, promising_data(stated, first, need));
    for (Freed &f : found) {
        const Suspect &s = f.suspect;
        // more of it is an effect, unless it alone does what took two names: then one of them is none
        if (accepted >= 2 && s.more_is_an_effect && s.fitted > s.stated * s.gross && s.error < better * before &&
            s.error < several_names * left && lead_of(last, *f.problem) > 0) {
            out.suspects.push_back(std::move(f.suspect));
            continue;
        }
        if (!is_gross(s)) continue;
        const bool helps = s.error < (accepted > 0 ? better : much_better) * before;
        const bool alone = s.error < (accepted >= 2 ? several_names : one_name) * left; // one number against all that was named
        // one number against one effect: what is named leaves the sheet contradicted and the datum does not, or it predicts at least as
        // well
        const bool rivals =
            accepted == 1 && s.error < as_much * left && s.error < notable * before &&
            ((strained(last) && !strained(*f.problem)) || lead_of(last, *f.problem) > (is_its_law(last, *f.datum) ? sure : 0));
        if ((helps && alone) || rivals) out.suspects.push_back(std::move(f.suspect));
    }
    std::stable_sort(out.suspects.begin(), out.suspects.end(), [](const Suspect &x, const Suspect &y) { return x.error < y.error; });
    std::vector<Suspect> once;
    for (Suspect &suspect : out.suspects)
        if (std::none_of(once.begin(), once.end(), [&](const Suspect &seen) { return seen.quantity == suspect.quantity; }))
            once.push_back(std::move(suspect));
    out.suspects = std::move(once);
    if (out.suspects.empty() && worst < describes_nothing && !far_off) return std::nullopt;
    char buffer[300];
    if (out.suspects.empty()) {
        std::snprintf(buffer, sizeof buffer,
                      "as fitted it leaves %.0f %% of a measured signal (but for noise). Look at the wheels' order and signs, radius, "
                      "mass, units and gear, and "
                      "the ground's law",
                      100 * worst);
        out.text = buffer;
    } else {
        for (std::size_t i = 0; i < out.suspects.size() && i < 3; ++i) {
            const Suspect &s = out.suspects[i];
            std::snprintf(buffer, sizeof buffer, "%s%s: %.4g %s would describe it (error %.3g x noise), the model has %.4g",
                          i == 0 ? "Look first at " : "; or ", s.quantity.c_str(), s.fitted, s.unit == "1" ? "" : s.unit.c_str(), s.error,
                          s.stated);
            out.text += buffer;
        }
        out.text += "; then at units, gear, the wheels' order, and the ground's law";
    }
    return out;
}

} // namespace traction::lab
