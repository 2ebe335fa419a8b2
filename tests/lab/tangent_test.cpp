// Sensitivities by the linear recursion beside a known motion (tangent.cpp) against whole integrations.
#include "host_tools/lab/candidate.h"
#include "host_tools/lab/forward.h"
#include "tests/lab/generator/generator.h"

#include <gtest/gtest.h>

namespace traction::lab {
namespace {

// Central differences of the whole integration, whose search for a step's speed ends at 1e-9 m/s, need the larger step.
void compare(Forward &forward, const Physics &base, const FreeParameter &parameter, double step, const std::string &what) {
    if ((parameter.touched & stage_motion) == 0) return; // no recursion there
    Physics small = base, moved = base, back = base;
    parameter.add(small, 1e-3 * step);
    parameter.add(moved, step);
    parameter.add(back, -step);
    const int wheel = parameter.slots.size() == 1 && parameter.slots[0].in_wheel != nullptr ? parameter.slots[0].wheel : -1;
    const Eigen::VectorXd tangent = (forward.predict_from_base(small, parameter.touched, wheel) - forward.base()) / (1e-3 * step);
    const Eigen::VectorXd whole = (forward.predict(moved) - forward.predict(back)) / (2 * step);
    // 3 %: curvature over the larger step, on concrete most
    EXPECT_LT((tangent - whole).norm(), 0.03 * whole.norm() + 1e-9) << what << ": " << tangent.norm() << " against " << whole.norm();
}

TEST(Tangent, agrees_with_whole_integrations_for_every_parameter_and_effect) {
    for (const generator::Soil soil : {generator::Soil::sand, generator::Soil::concrete}) {
        generator::GeneratorConfig config;
        config.soil = soil;
        config.seed = 7;
        config.duration_s = 40;
        const log::Log log = generator::generate(config);
        const Model model = read_model("models/rover_" + generator::name_of(soil) + ".toml");
        const Dataset data = make_dataset(model, log);
        Physics physics = make_physics(model);
        if (soil == generator::Soil::sand)
            for (WheelPhysics &w : physics.wheel) w.relaxation = 0.02; // [m] so that slip lags
        Forward forward(data);
        forward.set_base(physics);
        for (const FreeParameter &p : free_parameters(model, physics)) compare(forward, physics, p, 20 * p.step, p.key);
        for (const Candidate &c : catalogue_candidates(model, data, forward.motion())) {
            if (c.effect == "backlash" || c.effect == "relaxation_length" || c.wheel > 0) continue; // wheels with a memory: integrated whole
            if (c.effect == "soil_patch" && c.variant[1].second != 1.0) continue;
            Physics base = physics;
            c.prepare(base);
            for (std::size_t j = 0; j < c.strengths.size(); ++j) compare(forward, base, c.strengths[j], 1e-3 * c.of_interest[j], c.label() + " " + c.strengths[j].key);
        }
    }
}

} // namespace
} // namespace traction::lab
