#include "sim_bench_wheel.h"

#include <ode/ode.h>

#include <array>
#include <cmath>
#include <ctime>

namespace traction::bench {

namespace {

struct Scene {
    dWorldID world;
    dSpaceID space;
    dJointGroupID contacts;
};

void touch(void *data, dGeomID a, dGeomID b) {
    auto *scene = static_cast<Scene *>(data);
    dContact contact{};
    if (dCollide(a, b, 1, &contact.geom, sizeof(dContact)) == 0) return;
    contact.surface.mode = dContactApprox1;
    contact.surface.mu = 0.73; // sand of table III
    dJointAttach(dJointCreateContact(scene->world, scene->contacts, &contact), dGeomGetBody(a), dGeomGetBody(b));
}

} // namespace

RivalResult ode_contacts(double seconds) {
    Scene scene{dWorldCreate(), dSimpleSpaceCreate(nullptr), dJointGroupCreate(0)};
    dWorldSetGravity(scene.world, 0, 0, -gravity_m_s2);
    dWorldSetCFM(scene.world, 1e-5);
    dCreatePlane(scene.space, 0, 0, 1, 0);
    const double radius = 0.057;
    std::array<dBodyID, 2> half{};
    std::array<dJointID, 4> axle{};
    std::array<sim::DriveState, 4> drive{};
    for (int h = 0; h < 2; ++h) {
        const double side = h == 0 ? 1 : -1;
        dMass mass;
        dMassSetBoxTotal(&mass, 1.14, 0.30, 0.135, 0.185);
        half[static_cast<std::size_t>(h)] = dBodyCreate(scene.world);
        dBodySetMass(half[static_cast<std::size_t>(h)], &mass);
        dBodySetPosition(half[static_cast<std::size_t>(h)], 0, side * 0.0675, radius);
        for (int f = 0; f < 2; ++f) {
            const std::size_t i = static_cast<std::size_t>(2 * f + h);
            const dBodyID wheel = dBodyCreate(scene.world);
            dMassSetSphereTotal(&mass, 0.15, radius);
            dBodySetMass(wheel, &mass);
            dBodySetPosition(wheel, f == 0 ? -0.083 : 0.083, side * 0.12, radius);
            const dGeomID geom = dCreateSphere(scene.space, radius);
            dGeomSetBody(geom, wheel);
            axle[i] = dJointCreateHinge(scene.world, nullptr);
            dJointAttach(axle[i], wheel, half[static_cast<std::size_t>(h)]);
            dJointSetHingeAnchor(axle[i], f == 0 ? -0.083 : 0.083, side * 0.12, radius);
            dJointSetHingeAxis(axle[i], 0, 1, 0);
        }
    }
    const dJointID joint = dJointCreateHinge(scene.world, nullptr);
    dJointAttach(joint, half[0], half[1]);
    dJointSetHingeAnchor(joint, 0, 0, radius);
    dJointSetHingeAxis(joint, 0, 1, 0);

    const sim::DriveParameters motor;
    const std::clock_t start = std::clock();
    const long steps = std::lround(seconds / rival_dt_s);
    for (long k = 0; k < steps; ++k) {
        for (std::size_t i = 0; i < 4; ++i) {
            drive[i].motor_speed_rad_s = dJointGetHingeAngleRate(axle[i]);
            drive[i].current_A = sim::drive_current(motor, {}, drive[i], rival_duty, 7.2, rival_dt_s);
            const double w = drive[i].motor_speed_rad_s;
            dJointAddHingeTorque(axle[i], motor.torque_constant_Nm_A * drive[i].current_A - motor.viscous_Nms * w -
                                              motor.coulomb_Nm * (w > 0 ? 1 : 0));
        }
        dSpaceCollide(scene.space, &scene, touch);
        dWorldStep(scene.world, rival_dt_s);
        dJointGroupEmpty(scene.contacts);
    }
    RivalResult out{static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, dBodyGetPosition(half[0])[0]};
    dJointGroupDestroy(scene.contacts);
    dSpaceDestroy(scene.space);
    dWorldDestroy(scene.world);
    return out;
}

// The baseline of the factors: two bodies on ODE's hinge, dWorldStep, our wheels and our law, and nothing else - no sensors, no
// firmware, no log, no effects. Made as the plant was at 246f08e; it is not to be made quicker.
RivalResult ode_forces(double seconds, sim::ContactLaw law) {
    const dWorldID world = dWorldCreate();
    dWorldSetGravity(world, 0, 0, -gravity_m_s2);
    const sim::Soil &soil = *sim::find_soil("dry_sand_literature");
    const sim::SoilConstants constants = sim::soil_constants(*soil.bekker, 0.042);
    std::array<dBodyID, 2> half{};
    for (std::size_t h = 0; h < 2; ++h) {
        dMass mass;
        dMassSetBoxTotal(&mass, 1.44, 0.30, 0.135, 0.185);
        half[h] = dBodyCreate(world);
        dBodySetMass(half[h], &mass);
        dBodySetPosition(half[h], 0, h == 0 ? 0.0675 : -0.0675, 0);
    }
    const dJointID joint = dJointCreateHinge(world, nullptr);
    dJointAttach(joint, half[0], half[1]);
    dJointSetHingeAnchor(joint, 0, 0, 0);
    dJointSetHingeAxis(joint, 0, 1, 0);
    std::array<Wheel, 4> wheels;
    const std::clock_t start = std::clock();
    const long steps = std::lround(seconds / rival_dt_s);
    for (long k = 0; k < steps; ++k) {
        for (std::size_t i = 0; i < 4; ++i) {
            const dBodyID body = half[i % 2];
            const double ahead = i < 2 ? -0.083 : 0.083, aside = i % 2 == 0 ? 0.0525 : -0.0525;
            dVector3 point, velocity;
            dBodyGetRelPointPos(body, ahead, aside, 0, point);
            dBodyGetRelPointVel(body, ahead, aside, 0, velocity);
            const Push p = push(wheels[i], soil, constants, law, -point[2], velocity);
            dBodyAddForceAtRelPos(body, p.along, p.across, p.up, ahead, aside, 0);
        }
        dWorldStep(world, rival_dt_s);
    }
    RivalResult out{static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, dBodyGetPosition(half[0])[0]};
    dWorldDestroy(world);
    return out;
}

} // namespace traction::bench
