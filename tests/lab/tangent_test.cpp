// Sensitivities by the linear recursion beside a known motion (tangent.cpp) against whole integrations.
#include "host_tools/lab/decision/candidate.h"
#include "host_tools/lab/fit/problem.h"
#include "host_tools/lab/fit/sparse_jacobian.h"
#include "host_tools/lab/forward/forward.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/forward/wheel_step.h"
#include "tests/lab/generator/generator.h"

#include <array>
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
            if (c.effect == "backlash" || c.effect == "relaxation_length" || c.wheel > 0)
                continue; // wheels with a memory: integrated whole
            if (c.effect == "soil_patch" && c.variant[1].second != 1.0) continue;
            Physics base = physics;
            c.prepare(base);
            for (std::size_t j = 0; j < c.strengths.size(); ++j)
                compare(forward, base, c.strengths[j], 1e-3 * c.of_interest[j], c.label() + " " + c.strengths[j].key);
        }
    }
}

struct Sand {
    Model model;
    Dataset data;
    Physics physics;
};

Sand sand(double duration_s) {
    generator::GeneratorConfig config;
    config.seed = 7;
    config.duration_s = duration_s;
    const Model model = read_model("models/rover_sand.toml");
    return {model, make_dataset(model, generator::generate(config)), make_physics(model)};
}

TEST(Tangent, all_coefficients_of_a_shape_at_once_are_the_same_one_by_one) {
    const auto [model, data, physics] = sand(30);
    Forward forward(data);
    forward.set_base(physics);
    for (const Candidate &c : shape_candidates(data, forward.motion(), physics, forward.winding_current_A())) {
        const std::size_t count = c.strengths.size();
        const bool moves = c.touched == stage_motion;
        if (!moves && (c.touched & stage_sensors) != 0) continue;
        Physics base = physics;
        c.prepare(base);
        const Term &term = *base.terms.back().term;
        const Eigen::MatrixXd all = moves ? forward.shaped(physics, unit_response(data, physics, forward.motion(), c.target), term, count)
                                          : forward.shaped_electric(physics, forward.electric_unit(physics, c.target), term, count);
        for (std::size_t j = 0; j < count; ++j) {
            Physics moved = base;
            c.strengths[j].add(moved, c.step[j]);
            const Eigen::VectorXd one = (forward.predict_from_base(moved, c.touched, -1) - forward.base()) / c.step[j];
            const auto col = static_cast<Eigen::Index>(j);
            // at once the body is moved by a whole unit, one by one by 1e-6 of it: the radar's |v| bends at standstill. Currents: rounding.
            EXPECT_LT((all.col(col) - one).norm(), (moves ? 0.02 : 1e-5) * one.norm() + 1e-5)
                << c.effect << " " << j << ": " << all.col(col).norm() << " against " << one.norm();
        }
    }
}

TEST(Tangent, a_far_candidate_beside_the_base_reads_as_its_whole_prediction) {
    const auto [model, data, physics] = sand(30);
    Forward forward(data);
    forward.set_base(physics);
    for (const Candidate &c : catalogue_candidates(model, data, forward.motion())) {
        if ((c.touched & stage_motion) == 0 || c.wheel >= 0) continue;
        Physics moved = physics;
        c.prepare(moved);
        c.strengths[0].add(moved, 0.5 * c.maximum[0]);
        const Eigen::VectorXd whole = forward.predict(moved), beside = forward.predict(moved, c.touched);
        EXPECT_LT((whole - beside).norm(), 1e-9 * whole.norm()) << c.label(); // rounding; the search for the speed is the same
    }
}

TEST(Tangent, products_that_skip_the_zeros_of_a_jacobian_are_those_of_all_its_entries) {
    const auto [model, data, physics] = sand(20);
    Problem problem(data, physics, free_parameters(model, physics));
    problem.linearise();
    const Eigen::MatrixXd &J = problem.jacobian, gram = J.transpose() * J;
    const Eigen::VectorXd moment = J.transpose() * problem.residual;
    const SparseJacobian sparse(data, J);
    EXPECT_LT((sparse.gram() - gram).norm(), 1e-12 * gram.norm()); // rounding
    EXPECT_LT((sparse.moment(problem.residual) - moment).norm(), 1e-12 * moment.norm());
    EXPECT_EQ(sparse.whole(), J); // not one entry is lost
}

TEST(Tangent, what_wheels_share_changes_the_rows_as_the_sum_of_what_each_wheel_does) {
    const auto [model, data, physics] = sand(20);
    Problem problem(data, physics, free_parameters(model, physics));
    problem.linearise();
    int shared = 0;
    for (std::size_t i = 0; i + 1 < problem.parameters.size(); ++i) {
        const FreeParameter &p = problem.parameters[i];
        const Eigen::VectorXd known = problem.jacobian.col(static_cast<Eigen::Index>(i));
        if (p.own) { // that wheel alone moved, against all wheels looked at
            Physics moved = physics;
            p.add(moved, p.step);
            const Eigen::VectorXd all =
                (problem.forward().predict_from_base(moved, p.touched, -1) - problem.forward().base()).cwiseProduct(problem.row_scale) /
                p.step;
            EXPECT_LT((known - all).norm(), 1e-5 * all.norm() + 1e-9) << name_of(p); // rounding over the step
        } else if (problem.parameters[i + 1].own) {
            ++shared;
            const Eigen::VectorXd at_once = problem.column(physics, p, p.step);
            EXPECT_LT((known - at_once).norm(), 1e-3 * at_once.norm() + 1e-9) << name_of(p); // curvature over the step
        }
    }
    EXPECT_GT(shared, 2); // motors, friction, radius: each wheel's may differ
}

TEST(Tangent, four_wheels_side_by_side_are_the_wheels_one_by_one) {
    generator::GeneratorConfig config;
    config.seed = 7;
    config.duration_s = 20;
    for (const auto &[relaxation_m, motion] :
         {std::pair{0.0, BodyMotion::planar}, {0.02, BodyMotion::planar}, {0.02, BodyMotion::longitudinal}}) {
        Model model = read_model("models/rover_gravel.toml");
        model.motion = motion;
        const Dataset data = make_dataset(model, generator::generate(config));
        Physics physics = make_physics(model);
        physics.body.slip_sinkage = 0.2, physics.body.sliding_loss_s_m = 0.5, physics.body.scrub = 0.1, physics.body.multi_pass = 0.1,
        physics.body.raised_m = 0.1, physics.body.offset_x_m = 0.01;
        for (WheelPhysics &w : physics.wheel) w.relaxation = relaxation_m, w.grip = 0.8;
        WheelStep four(data, physics), one(data, physics);
        std::array<Eigen::Vector3d, most_wheels> each{};
        for (std::size_t k = 0; k < data.count; k += 7) {
            const Eigen::Vector3d q(0.09 * data.wheel[0].speed_rad_s[k], motion == BodyMotion::planar ? 0.02 : 0, 0.05);
            four.prepare(k, q[0], 0.1, 0.5, 0.5);
            one.prepare(k, q[0], 0.1, 0.5, 0.5);
            const Eigen::Vector3d sum = four.forces(q, &each);
            Eigen::Vector3d expected = Eigen::Vector3d::Zero();
            for (std::size_t i = 0; i < one.wheels(); ++i) {
                const Eigen::Vector3d force = one.force(i, q);
                expected += force;
                EXPECT_LT((each[i] - force).norm(), 1e-12 * (1 + force.norm())); // rounding
                EXPECT_NEAR(four.state(i).slip, one.state(i).slip, 1e-14);
                EXPECT_NEAR(four.state(i).side_slip, one.state(i).side_slip, 1e-14);
                EXPECT_NEAR(four.state(i).traction, one.state(i).traction, 1e-12 * (1 + std::fabs(one.state(i).traction)));
            }
            EXPECT_LT((sum - expected).norm(), 1e-12 * (1 + expected.norm()));
            four.commit(), one.commit();
        }
    }
}

} // namespace
} // namespace traction::lab
