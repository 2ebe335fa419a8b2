#include "doubt.h"

#include "host_tools/lab/fit/heldout.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/fit/rounding.h"

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

// What a data sheet, a ruler or a scale says, and how a mistake in it is looked for.
struct Datum {
    const char *table, *key, *name;
    double gross = 1.4; // times, or one over: a data sheet, a scale is not wrong by that much, and no effect of the catalogue is as large
    bool more_is_an_effect = false; // of the catalogue: whether it is the cause has been decided there, only less is a matter of the model
};
constexpr Datum data_of_a_model[] = {
    {"rover", "mass_kg", "the mass"},
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

// The datum from `start` times what is stated; where it ends at the edge of what it may be, once more from there.
Suspect gross_error(const Model &stated, const Dataset &data, const Datum &datum, double start) {
    Suspect out;
    Model as_is = stated;
    for (int round = 0; round < 4; ++round) {
        Model model = stated;
        if (!set_free(model, datum, start)) return {};
        const Physics physics = make_physics(model);
        Problem problem(data, physics, free_parameters(model, physics));
        problem.fit({.iterations = 3});
        const double error = overall_error(problem), value = values_of(as_is, datum).front()->value;
        double moved = 0, ratio = 1;
        std::string unit;
        for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
            const FreeParameter &p = problem.parameters[i];
            if (p.owner != datum.table || p.key != datum.key) continue;
            moved = p.base + problem.theta[static_cast<Eigen::Index>(i)], ratio = moved / p.base, unit = p.unit;
            break;
        }
        if (unit.empty() || !std::isfinite(error)) return out;
        if (out.quantity.empty() || error < out.error) out = {datum.name, value, moved, unit, error, datum.gross, datum.more_is_an_effect};
        if (ratio > 0.03 && ratio < 5.5) return out;
        start *= ratio < 1 ? 0.05 : 5;
    }
    return out;
}

bool is_gross(const Suspect &s) { return s.fitted < s.stated / s.gross || (!s.more_is_an_effect && s.fitted > s.stated * s.gross); }

} // namespace

std::vector<Suspect> gross_errors(const Model &stated, const Dataset &data) {
    std::vector<std::pair<Suspect, const Datum *>> found;
    for (const Datum &datum : data_of_a_model)
        if (Suspect s = gross_error(stated, data, datum, 1); !s.quantity.empty()) found.emplace_back(std::move(s), &datum);
    const auto less = [](const auto &a, const auto &b) { return a.first.error < b.first.error; };
    std::stable_sort(found.begin(), found.end(), less);
    for (std::size_t i = 0; i < found.size() && i < 3; ++i) // a valley that a search from where it stands does not see
        for (const double start : {0.25, 4.0})
            if (Suspect s = gross_error(stated, data, *found[i].second, start); !s.quantity.empty() && s.error < found[i].first.error)
                found[i].first = std::move(s);
    std::stable_sort(found.begin(), found.end(), less);
    std::vector<Suspect> out;
    for (auto &[suspect, datum] : found) out.push_back(std::move(suspect));
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
    if (!at_bound && worst_of(first) < suspicious && !(accepted >= 2 && before > 1.3 * after)) return std::nullopt;
    Doubt out;
    const Scatter scatter(last); // a softer soil, too, only smooths what the encoders scatter
    const double by_scatter = scatter.part.cwiseProduct(rounding_squares(data, last.physics())).dot(noise_weight(last));
    const double left = std::sqrt(std::max(0.0, after * after - by_scatter)) * (1 - shape_gain);
    for (Suspect &s : gross_errors(stated, data)) {
        const double needed = accepted >= 2 ? several_names : one_name;
        if (is_gross(s) && s.error < needed * left && s.error < much_better * before) out.suspects.push_back(std::move(s));
    }
    const bool far_off = accepted == 0 && !(shape_gain > 0) && after > never_nothing;
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
