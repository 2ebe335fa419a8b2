// Holds the joint of sim/plant/hinge.h to ODE's own hinge: the same two bodies, forces and step, in two worlds.
#include "sim/plant/hinge.h"

#include <array>
#include <gtest/gtest.h>
#include <ode/ode.h>

#include <cmath>
#include <random>

using traction::sim::Hinge;
using traction::sim::HingeMotion;

namespace {

using Vector = std::array<double, 3>;

struct Pair {
    dWorldID world = nullptr;
    std::array<dBodyID, 2> half{};
    dJointID joint = nullptr;
};

constexpr double mass_kg = 1.44, dt_s = 0.001;

// Two boxes on a hinge about y, somewhere in the world and turned. `apart`: how far the anchors and axes have drifted.
Pair make(std::mt19937_64 &draw, double apart, bool by_ode) {
    std::normal_distribution<double> some(0, 1);
    Pair p;
    p.world = dWorldCreate();
    dWorldSetGravity(p.world, 0.3, -0.2, -9.81);
    dWorldSetAutoDisableFlag(p.world, 0);
    dMatrix3 turn;
    dRFromEulerAngles(turn, 0.4 * some(draw), 0.4 * some(draw), 2 * some(draw));
    const double x = some(draw), y = some(draw), z = some(draw);
    for (std::size_t n = 0; n < 2; ++n) {
        const double aside = n == 0 ? 0.0675 : -0.0675;
        p.half[n] = dBodyCreate(p.world);
        dMass mass;
        dMassSetBoxTotal(&mass, mass_kg, 0.30, 0.135, 0.185);
        dBodySetMass(p.half[n], &mass);
        dBodySetRotation(p.half[n], turn);
        dBodySetPosition(p.half[n], x + aside * turn[1], y + aside * turn[5], z + aside * turn[9]);
    }
    p.joint = dJointCreateHinge(p.world, nullptr);
    dJointAttach(p.joint, p.half[0], p.half[1]);
    dJointSetHingeAnchor(p.joint, x, y, z);
    dJointSetHingeAxis(p.joint, turn[1], turn[5], turn[9]);
    for (const dBodyID body : p.half) {
        const dReal *at = dBodyGetPosition(body);
        dBodySetPosition(body, at[0] + apart * some(draw), at[1] + apart * some(draw), at[2] + apart * some(draw));
        dMatrix3 drift, both;
        dRFromEulerAngles(drift, apart * some(draw), 0.3 * some(draw), apart * some(draw)); // about y freely
        dMultiply0_333(both, turn, drift);
        dBodySetRotation(body, both);
        dBodySetLinearVel(body, some(draw), some(draw), some(draw));
        dBodySetAngularVel(body, 3 * some(draw), 3 * some(draw), 3 * some(draw));
        dBodyAddForce(body, 20 * some(draw), 20 * some(draw), 20 * some(draw));
        dBodyAddTorque(body, some(draw), some(draw), some(draw));
        dBodySetGyroscopicMode(body, by_ode ? 1 : 0);
    }
    return p;
}

Vector vector_of(const dReal *v) { return {v[0], v[1], v[2]}; }

void step_beside_ode(const Pair &p) {
    Hinge hinge;
    hinge.erp = dWorldGetERP(p.world), hinge.cfm = dWorldGetCFM(p.world);
    std::array<HingeMotion, 2> now{};
    dVector3 gravity;
    dWorldGetGravity(p.world, gravity);
    for (std::size_t n = 0; n < 2; ++n) {
        dMass mass;
        dBodyGetMass(p.half[n], &mass);
        hinge.body[n] = {.mass_kg = mass.mass,
                         .inertia_kg_m2 = {mass.I[0], mass.I[5], mass.I[10]},
                         .anchor_m = {0, n == 0 ? -0.0675 : 0.0675, 0},
                         .axis = {0, 1, 0},
                         .normal_1 = {1, 0, 0},
                         .normal_2 = {0, 0, 1}};
        now[n] = {dBodyGetRotation(p.half[n]),   dBodyGetPosition(p.half[n]),         dBodyGetLinearVel(p.half[n]),
                  dBodyGetAngularVel(p.half[n]), vector_of(dBodyGetForce(p.half[n])), vector_of(dBodyGetTorque(p.half[n]))};
        for (std::size_t k = 0; k < 3; ++k) now[n].force_N[k] += mass.mass * gravity[k];
    }
    dJointDisable(p.joint);
    const auto loads = hinge.loads(now, dt_s);
    for (std::size_t n = 0; n < 2; ++n) {
        dBodyAddForce(p.half[n], loads[n].force_N[0], loads[n].force_N[1], loads[n].force_N[2]);
        dBodyAddTorque(p.half[n], loads[n].torque_Nm[0], loads[n].torque_Nm[1], loads[n].torque_Nm[2]);
    }
    dWorldStep(p.world, dt_s);
}

void expect_same(const Pair &ours, const Pair &theirs) {
    for (std::size_t n = 0; n < 2; ++n)
        for (int k = 0; k < 3; ++k) { // velocities of some m/s and rad/s: rounding of both solvers, 1e4 ulp
            EXPECT_NEAR(dBodyGetLinearVel(ours.half[n])[k], dBodyGetLinearVel(theirs.half[n])[k], 1e-11);
            EXPECT_NEAR(dBodyGetAngularVel(ours.half[n])[k], dBodyGetAngularVel(theirs.half[n])[k], 1e-11);
            EXPECT_NEAR(dBodyGetPosition(ours.half[n])[k], dBodyGetPosition(theirs.half[n])[k], 1e-13);
        }
}

void compare(double apart) {
    dInitODE2(0);
    dAllocateODEDataForThread(static_cast<unsigned>(dAllocateMaskAll));
    for (unsigned seed = 1; seed <= 200; ++seed) {
        std::mt19937_64 first(seed), second(seed);
        const Pair ours = make(first, apart, false), theirs = make(second, apart, true);
        step_beside_ode(ours);
        dWorldStep(theirs.world, dt_s);
        expect_same(ours, theirs);
        dWorldDestroy(ours.world), dWorldDestroy(theirs.world);
    }
}

} // namespace

TEST(Hinge, MovesThePairAsOdesOwnHinge) { compare(0); }

TEST(Hinge, DrawsDriftedAnchorsAndAxesTogetherAsOdesOwnHinge) { compare(1e-4); }
