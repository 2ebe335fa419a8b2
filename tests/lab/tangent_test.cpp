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

#include <cmath>
#include <vector>

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
    const Eigen::VectorXd ahead = forward.predict(moved), behind = forward.predict(back);
    Eigen::VectorXd whole = (ahead - behind) / (2 * step);
    if (what.find("_patch") != std::string::npos) { // one of the two may meet an edge a step before the other: then it has no slope there
        const Eigen::VectorXd to = (ahead - forward.base()) / step, from = (forward.base() - behind) / step;
        whole = (tangent - to).norm() < (tangent - from).norm() ? to : from;
    }
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

// Where leads are shared, what changes one wheel's current changes the voltage balance of the others.
TEST(Tangent, one_wheels_parameter_reaches_the_others_through_a_shared_lead) {
    generator::GeneratorConfig config;
    config.seed = 7, config.duration_s = 40;
    const Model model = read_model("models/rover_sand.toml");
    const Dataset data = make_dataset(model, generator::generate(config));
    Physics physics = make_physics(model);
    for (WheelPhysics &w : physics.wheel) w.shared_ohm = 0.8;
    Forward forward(data);
    forward.set_base(physics);
    std::size_t own = 0;
    for (const FreeParameter &p : free_parameters(model, physics)) {
        if (p.owner == "sensors") continue; // delays of a voltage that jumps have no slope
        const int wheel = p.slots.size() == 1 && p.slots[0].in_wheel != nullptr ? p.slots[0].wheel : -1;
        own += wheel >= 0;
        const double step = 20 * p.step;
        Physics small = physics, moved = physics, back = physics;
        p.add(small, 1e-3 * step), p.add(moved, step), p.add(back, -step);
        const Eigen::VectorXd tangent = (forward.predict_from_base(small, p.touched, wheel) - forward.base()) / (1e-3 * step);
        const Eigen::VectorXd whole = (forward.predict(moved) - forward.predict(back)) / (2 * step);
        Eigen::Index row = 0;
        for (const Balance &b : data.balance) {
            const auto n = static_cast<Eigen::Index>(b.measured.size());
            // 3 %: curvature over the larger step; of the largest balance's: what hardly changes need not agree so well
            EXPECT_LT((tangent - whole).segment(row, n).norm(), 0.03 * whole.segment(row, n).norm() + 1e-4 * whole.norm())
                << p.owner << "." << p.key << " in " << b.name;
            row += n;
        }
    }
    EXPECT_GT(own, 4U); // of single wheels, the case in question
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

// One pass over the known motion serves several of them.
TEST(Tangent, neighbours_side_by_side_are_to_the_bit_what_each_is_alone) {
    const auto [model, data, stated] = sand(20);
    for (const double relaxation_m : {0.0, 0.02}) {
        Physics physics = stated;
        for (WheelPhysics &w : physics.wheel) w.relaxation = relaxation_m;
        Forward forward(data);
        forward.set_base(physics);
        std::vector<Physics> moved;
        std::vector<unsigned> touched;
        std::vector<int> wheel;
        for (const FreeParameter &p : free_parameters(model, physics)) {
            Physics one = physics;
            p.add(one, p.step);
            if (!forward.is_neighbour(one, p.touched)) continue;
            moved.push_back(one), touched.push_back(p.touched), wheel.push_back(p.own ? p.slots[0].wheel : -1);
        }
        ASSERT_GT(moved.size(), 6U); // every wheel's radius, the ground
        const Eigen::MatrixXd all = forward.predict_neighbours(moved, touched, wheel);
        for (std::size_t i = 0; i < moved.size(); ++i)
            EXPECT_EQ(all.col(static_cast<Eigen::Index>(i)), forward.predict_from_base(moved[i], touched[i], wheel[i])) << i;
    }
}

// Of a straight line, the value in the middle of the window, `delay` earlier (windows.h, (1)); whatever was asked for before.
TEST(Windows, take_the_mean_at_whatever_delay_and_remember_none_but_their_own) {
    const auto [model, data, physics] = sand(20);
    std::vector<double> line, other;
    for (std::size_t k = 0; k < data.count; ++k) line.push_back(3 + 0.5 * data.time(k)), other.push_back(std::sin(data.time(k)));
    for (const Balance &balance : data.balance) {
        const auto rows = static_cast<Eigen::Index>(balance.measured.size());
        Windows kept(data, balance);
        for (const double delay : {0.0, 0.013, 0.0, 0.021, 0.013, 0.013, 0.0}) {
            Windows anew(data, balance);
            Eigen::VectorXd by_kept = Eigen::VectorXd::Zero(rows), by_anew = by_kept, mean = by_kept;
            kept.mean(other, delay, false, by_kept);
            anew.mean(other, delay, false, by_anew);
            EXPECT_EQ(by_kept, by_anew) << balance.name << " " << delay;
            kept.mean(line, delay, false, mean);
            for (Eigen::Index r = 1; r + 1 < rows; ++r) { // the outermost windows are cut at the log's ends
                const auto i = static_cast<std::size_t>(r);
                EXPECT_NEAR(mean[r], 3 + 0.5 * (0.5 * (balance.t0_s[i] + balance.t1_s[i]) - delay), 1e-9) << balance.name; // rounding
            }
        }
    }
}

TEST(Fit, that_need_not_be_ready_ends_where_the_other_does_and_gets_ready_when_asked) {
    int put_off = 0; // where the last step is of a third of a deviation and more
    for (const auto &[duration_s, iterations] : {std::pair{22, 3}, {26, 3}, {28, 2}, {29, 4}, {33, 1}, {36, 3}, {45, 3}, {60, 4}}) {
        const auto [model, data, physics] = sand(duration_s);
        Problem whole(data, physics, free_parameters(model, physics)), bare = whole;
        whole.fit({.iterations = iterations});
        bare.fit({.iterations = iterations, .ready = false});
        EXPECT_EQ(whole.theta, bare.theta);
        EXPECT_EQ(whole.residual, bare.residual);
        EXPECT_EQ(whole.row_scale, bare.row_scale);
        put_off += whole.jacobian != bare.jacobian ? 1 : 0;
        bare.get_ready();
        EXPECT_EQ(whole.jacobian, bare.jacobian);
        Problem on = whole; // both go on alike, on other scales
        bare.row_scale *= 0.5, on.row_scale *= 0.5;
        bare.gauss_newton(2), on.gauss_newton(2);
        EXPECT_EQ(on.theta, bare.theta);
    }
    EXPECT_GT(put_off, 0); // or the test shows nothing
}

} // namespace
} // namespace traction::lab
