#include "doubt.h"

#include "host_tools/lab/fit/ladder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace traction::lab {

namespace {

// What a data sheet, a ruler or a scale says, and how a mistake in it is looked for.
struct Datum {
    const char *table, *key, *name;
};
constexpr Datum data_of_a_model[] = {
    {"rover", "mass_kg", "the mass"},
    {"wheel", "radius_m", "the wheels' radius"},
    {"motor", "torque_constant_Nm_A", "the torque constant (of the wheel's side of the gear)"},
    {"motor", "back_emf_Vs_rad", "the back-EMF (of the wheel's side of the gear)"},
    {"motor", "resistance_ohm", "the motors' resistance"},
    {"motor", "inertia_kg_m2", "the inertia at the wheel"},
    {"motor", "coulomb_Nm", "the dry friction of the drives"},
    {"motor", "viscous_Nms", "the viscous friction of the drives"},
    {"soil", "mu", "the ground's grip"},
    {"soil", "rolling_coefficient", "the rolling resistance"},
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

std::vector<Suspect> gross_errors(const Model &stated, const Dataset &data) {
    std::vector<Suspect> out;
    for (const Datum &datum : data_of_a_model) {
        Suspect best;
        for (const double start : {1.0, 0.2, 5.0, 0.01}) {
            Model model = stated;
            if (!set_free(model, datum, start)) break;
            const Physics physics = make_physics(model);
            Problem problem(data, physics, free_parameters(model, physics));
            problem.fit({.iterations = 4});
            const double error = overall_error(problem);
            if (!best.quantity.empty() && !(error < best.error)) continue;
            for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
                const FreeParameter &p = problem.parameters[i];
                if (p.owner != datum.table || p.key != datum.key) continue;
                Model as_is = stated;
                best = {datum.name, values_of(as_is, datum).front()->value, p.base + problem.theta[static_cast<Eigen::Index>(i)], p.unit,
                        error};
                break;
            }
        }
        if (!best.quantity.empty()) out.push_back(best);
    }
    std::stable_sort(out.begin(), out.end(), [](const Suspect &a, const Suspect &b) { return a.error < b.error; });
    return out;
}

std::optional<Doubt> doubt(const Model &, const Dataset &, const Problem &) { return {}; }

} // namespace traction::lab
