// The plant against MuJoCo on every contact law: the same laws and drive trains, the two halves and their hinge integrated by MuJoCo
// instead of ODE (forces by xfrc_applied between mj_step1 and mj_step2, contacts off), round bends, back, and to rest.
//
// Both integrators are of first order in the step h, so that each is off the solution by e(h) = 2 |p(h) - p(h/2)| + O(h^2), and
//   |plant(h) - MuJoCo(h)| <= 2 |plant(h) - plant(h/2)| + 2 |MuJoCo(h) - MuJoCo(h/2)|                          (1)
// which is the first bound; half as much again and a micrometre stand for the second order and for rounding. It is wide, for both share the
// splitting (drives and contacts, then bodies) whose error it counts. The second is sharp: two integrators of one law differ by D(h) = a h
// + O(h^2), of two laws by D(h) = D(0) + O(h), so that
//   |2 D(h/2) - D(h)| = |D(0)| + O(h^2) <= |D(h)|/2 + 20 um                                                     (2)
// where 20 um, 1e-5 of the path, stand for the second order.
#include <gtest/gtest.h>

#if !TRACTION_HAVE_MUJOCO
TEST(mujoco, agrees_on_every_contact_law) { GTEST_SKIP() << "MuJoCo is not installed (libmujoco-dev): the plant was not compared with it"; }
#else

#include "sim/physics/terramechanics.h"
#include "sim/plant/contact.h"
#include "sim/plant/drive.h"
#include "sim/plant/plant.h"
#include "sim/plant/rut.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

using namespace traction::sim;

namespace {

struct Freed {
    void operator()(mjModel *m) const { mj_deleteModel(m); }
    void operator()(mjData *d) const { mj_deleteData(d); }
};

// Table I: two boxes of 0.30 x 0.135 x 0.185 m and 1.44 kg, hinged about y.
std::unique_ptr<mjModel, Freed> halves(double dt_s) {
    char text[1200];
    std::snprintf(text, sizeof text,
                  R"(<mujoco><option timestep="%.9g" gravity="0 0 -9.81"><flag contact="disable"/></option><worldbody>
<body pos="0 0.0675 0"><freejoint/><inertial pos="0 0 0" mass="1.44" diaginertia="%.12g %.12g %.12g"/>
<body pos="0 -0.135 0"><joint type="hinge" axis="0 1 0" pos="0 0.0675 0"/>
<inertial pos="0 0 0" mass="1.44" diaginertia="%.12g %.12g %.12g"/></body></body></worldbody></mujoco>)",
                  dt_s, 0.12 * (0.135 * 0.135 + 0.185 * 0.185), 0.12 * (0.09 + 0.185 * 0.185), 0.12 * (0.09 + 0.135 * 0.135),
                  0.12 * (0.135 * 0.135 + 0.185 * 0.185), 0.12 * (0.09 + 0.185 * 0.185), 0.12 * (0.09 + 0.135 * 0.135));
    mjVFS files;
    mj_defaultVFS(&files);
    const std::string xml(text);
    mj_makeEmptyFileVFS(&files, "rover.xml", static_cast<int>(xml.size()));
    std::copy(xml.begin(), xml.end(), static_cast<char *>(files.filedata[0]));
    char error[500] = "";
    std::unique_ptr<mjModel, Freed> model(mj_loadXML("rover.xml", &files, error, sizeof error));
    mj_deleteVFS(&files);
    if (!model) throw std::runtime_error(std::string("MuJoCo: ") + error);
    return model;
}

struct Leg {
    double for_s, left, right; // duty
};
const std::vector<Leg> legs = {{2, 0.6, 0.6}, {2, 0.5, 0.7}, {1, 0, 0}, {2, -0.6, -0.5}, {1, 0.7, 0.7}};

struct End {
    double x_m = 0, y_m = 0, yaw_rad = 0, sinkage_m = 0;
};

// The laws of sim/physics and sim/plant/contact.h on one wheel of table I, put together by the equations of docs/physics.md.
class Rover {
  public:
    Rover(const PlantConfig &config) : config_(config), ruts_(config.rover.wheel_width_m) {
        if (config.ground.soil.bekker) constants_ = soil_constants(*config.ground.soil.bekker, config.rover.wheel_width_m);
    }
    double start_depth_m() const {
        const RoverParameters &r = config_.rover;
        const double load_N = r.mass_kg * r.gravity_m_s2 / 4;
        if (config_.ground.contact == ContactLaw::aggregated) return load_N / r.contact_stiffness_N_m;
        return sinkage_under(config_.ground.contact == ContactLaw::arc ? arc_force : bekker_force, *config_.ground.soil.bekker,
                             {r.wheel_radius_m, r.wheel_width_m, r.tyre_hysteresis}, load_N, 0);
    }
    void supply(const std::array<double, 4> &duty) {
        double current_A = 0;
        for (std::size_t i = 0; i < 4; ++i) current_A += duty[i] * drive_[i].current_A;
        supply_V_ = config_.rover.battery_voltage_V - config_.rover.battery_resistance_ohm * current_A;
    }
    // Along the heading, to the left, up, on the rover.
    std::array<double, 3> push(std::size_t i, double duty, double x_m, double y_m, double depth_m, double along, double across,
                               double up_m_s) {
        const RoverParameters &r = config_.rover;
        const Soil &soil = config_.ground.soil;
        const double h = config_.dt_s;
        ContactInput in{.law = soil.law,
                        .shear_slip = soil.shear_slip,
                        .relaxation_m = r.relaxation_length_m,
                        .rim_m_s = r.wheel_radius_m * drive_[i].wheel_speed_rad_s,
                        .along_m_s = along,
                        .across_m_s = across,
                        .load_kg = r.mass_kg / 4};
        double load = 0, rolling = 0, free_N = 0, free_Nm = 0, arm = 0;
        ContactForce force;
        if (config_.ground.contact == ContactLaw::aggregated) {
            load = std::max(0.0, r.contact_stiffness_N_m * depth_m - r.contact_damping_Ns_m * up_m_s);
            in.grip_N = load > 0 ? soil.adhesion_N + soil.fm_per_fn * load : 0;
            in.side_ratio = in.grip_N > 0 ? soil.lateral_coefficient * load / in.grip_N : 1;
            force = contact_step(in, contact_[i], h);
            rolling = soil.rolling_coefficient * load;
        } else {
            const double z = std::max(0.0, depth_m), rut = trace_[i].follow(ruts_, x_m, y_m, z);
            sinkage_[i] = z;
            const SlipChange change = slip_step(in, contact_[i], h);
            const double size = std::min(total_slip(contact_[i]), 1.0);
            const double slip = std::copysign(size, along < 0 ? -contact_[i].slip : contact_[i].slip);
            const bool arc = config_.ground.contact == ContactLaw::arc;
            const auto law = arc ? arc_force : bekker_force;
            const SoilWheel wheel{r.wheel_radius_m, r.wheel_width_m, r.tyre_hysteresis};
            const auto at = [&](double s) { return law(*soil.bekker, constants_, wheel, {z, s, rut}); };
            SoilForce ground = at(slip);
            double by_slip = std::fabs(ground.traction_N - ground.free_traction_N),
                   twist = std::fabs(ground.torque_Nm - ground.free_torque_Nm);
            if (const double still = 0.5 * (1 - std::fabs(along) / 0.005); still > 0 && arc) { // at rest, the mean of both directions
                const SoilForce other = at(-slip);
                by_slip += still * (std::fabs(other.traction_N - other.free_traction_N) - by_slip);
                twist += still * (std::fabs(other.torque_Nm - other.free_torque_Nm) - twist);
                ground.normal_N += still * (other.normal_N - ground.normal_N);
                ground.resistance_N += still * (other.resistance_N - ground.resistance_N);
            }
            const double belly = std::max(0.0, z - 0.9 * r.wheel_radius_m) * r.contact_stiffness_N_m;
            load = std::max(0.0, ground.normal_N + belly - (ground.normal_N > 0 ? r.contact_damping_Ns_m * up_m_s : 0));
            if (load > 0) {
                in.grip_N = ground.largest_N, in.shear_slip = ground.shear_slip, in.law = TractionLaw::janosi;
                force = contact_force(in, contact_[i], change, by_slip, h);
                free_N = ground.free_traction_N, free_Nm = ground.free_torque_Nm, rolling = ground.resistance_N;
                arm = by_slip > 1e-6 ? twist / by_slip : 0;
            }
        }
        const double turned = rolling_step(contact_[i], along, rolling - free_N, r.mass_kg / 4, h);
        const double torque = (arm > 0 ? arm : r.wheel_radius_m) * force.along_N + free_Nm * std::clamp(in.rim_m_s / 0.005, -1.0, 1.0);
        drive_[i].current_A = drive_current(r.drive, {}, drive_[i], duty, supply_V_, h);
        drive_step(r.drive, {}, drive_[i], torque, h);
        return {force.along_N + free_N * turned - rolling * turned, force.across_N, load};
    }
    double sinkage_m() const { return sinkage_[2]; }

  private:
    PlantConfig config_;
    SoilConstants constants_{};
    RutMemory ruts_;
    std::array<RutTrace, 4> trace_;
    std::array<DriveState, 4> drive_{};
    std::array<ContactState, 4> contact_{};
    std::array<double, 4> sinkage_{};
    double supply_V_ = 0;
};

End by_mujoco(const PlantConfig &config) {
    const auto model = halves(config.dt_s);
    const std::unique_ptr<mjData, Freed> data(mj_makeData(model.get()));
    Rover rover(config);
    data->qpos[2] = -rover.start_depth_m();
    double yaw = 0;
    for (const Leg &leg : legs)
        for (long k = std::lround(leg.for_s / config.dt_s); k > 0; --k) {
            mj_step1(model.get(), data.get());
            rover.supply({leg.left, leg.right, leg.left, leg.right});
            std::fill(data->xfrc_applied, data->xfrc_applied + 6 * model->nbody, 0.0);
            for (std::size_t i = 0; i < 4; ++i) {
                const int body = i % 2 == 0 ? 1 : 2;
                const mjtNum *at = data->xpos + 3 * body, *turn = data->xmat + 9 * body;
                mjtNum motion[6], arm[3], swing[3];
                mj_objectVelocity(model.get(), data.get(), mjOBJ_BODY, body, motion, 0); // rotation, translation, world axes
                const mjtNum local[3] = {i < 2 ? -0.083 : 0.083, body == 1 ? 0.0525 : -0.0525, 0};
                mju_rotVecMat(arm, local, turn);
                mju_cross(swing, motion, arm);
                const double v[3] = {motion[3] + swing[0], motion[4] + swing[1], motion[5] + swing[2]};
                const double flat = std::hypot(turn[0], turn[3]), c = turn[0] / flat, s = turn[3] / flat;
                const auto p = rover.push(i, i % 2 == 0 ? leg.left : leg.right, at[0] + arm[0], at[1] + arm[1], -(at[2] + arm[2]),
                                          c * v[0] + s * v[1], -s * v[0] + c * v[1], v[2]);
                const mjtNum force[3] = {p[0] * c - p[1] * s, p[0] * s + p[1] * c, p[2]};
                mjtNum torque[3];
                mju_cross(torque, arm, force);
                mju_addTo3(data->xfrc_applied + 6 * body, force);
                mju_addTo3(data->xfrc_applied + 6 * body + 3, torque);
                if (i == 3) yaw = std::atan2(s, c);
            }
            mj_step2(model.get(), data.get());
        }
    mj_kinematics(model.get(), data.get());
    return {0.5 * (data->xpos[3] + data->xpos[6]), 0.5 * (data->xpos[4] + data->xpos[7]), yaw, rover.sinkage_m()};
}

End by_plant(const PlantConfig &config) {
    Plant plant(config);
    for (const Leg &leg : legs) {
        for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, i % 2 == 0 ? leg.left : leg.right);
        for (long k = std::lround(leg.for_s / config.dt_s); k > 0; --k) plant.step();
    }
    const Truth &t = plant.truth();
    return {t.position_m[0], t.position_m[1], t.yaw_rad, t.wheel[2].sinkage_m};
}

TEST(mujoco, agrees_on_every_contact_law) {
    double worst_m = 0, worst_bound_m = 0;
    for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc})
        for (const Soil &soil : soil_library()) {
            if (!soil.bekker && contact != ContactLaw::aggregated) continue;
            PlantConfig config;
            config.ground.soil = soil, config.ground.contact = contact, config.ground.grip_noise = 0;
            const End plant = by_plant(config), mujoco = by_mujoco(config);
            config.dt_s = 0.0005;
            const End plant_fine = by_plant(config), mujoco_fine = by_mujoco(config);
            const std::string what = soil.name + ", contact " + std::to_string(static_cast<int>(contact));
            const auto judge = [&](double End::*value, double least) {
                const double bound =
                    1.5 * 2 * (std::fabs(plant.*value - plant_fine.*value) + std::fabs(mujoco.*value - mujoco_fine.*value));
                EXPECT_NEAR(plant.*value, mujoco.*value, bound + least) << what; // (1)
                const double apart = plant.*value - mujoco.*value, fine = plant_fine.*value - mujoco_fine.*value;
                EXPECT_LE(std::fabs(2 * fine - apart), 0.5 * std::fabs(apart) + 20 * least) << what; // (2)
                return std::pair{std::fabs(apart), bound};
            };
            for (double End::*value : {&End::x_m, &End::y_m}) {
                const auto [off, bound] = judge(value, 1e-6);
                worst_m = std::max(worst_m, off), worst_bound_m = std::max(worst_bound_m, bound);
            }
            judge(&End::yaw_rad, 1e-5);
            judge(&End::sinkage_m, 1e-6);
            // and the bound is no blank cheque: a path of 2 m is known to a centimetre
            EXPECT_NEAR(plant.x_m, plant_fine.x_m, 0.005) << what;
        }
    std::printf("worst place after 8 s: %.3f mm apart, bound %.3f mm\n", 1000 * worst_m, 1000 * worst_bound_m);
}

} // namespace
#endif
