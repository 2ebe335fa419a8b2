#include "sim_bench_wheel.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <stdexcept>

namespace traction::bench {

namespace {

struct Freed {
    void operator()(mjModel *m) const { mj_deleteModel(m); }
    void operator()(mjData *d) const { mj_deleteData(d); }
};
using Model = std::unique_ptr<mjModel, Freed>;
using Data = std::unique_ptr<mjData, Freed>;

Model load(const std::string &text) {
    mjVFS files; // MuJoCo reads a model from a file of its virtual file system
    mj_defaultVFS(&files);
    mj_makeEmptyFileVFS(&files, "rover.xml", static_cast<int>(text.size()));
    std::copy(text.begin(), text.end(), static_cast<char *>(files.filedata[0]));
    char error[500] = "";
    Model model(mj_loadXML("rover.xml", &files, error, sizeof error));
    mj_deleteVFS(&files);
    if (!model) throw std::runtime_error(std::string("MuJoCo: ") + error);
    return model;
}

const std::string halves_only = R"(<mujoco><option timestep="0.001" gravity="0 0 -9.81"><flag contact="disable"/></option><worldbody>
<body pos="0 0.0675 0"><freejoint/><inertial pos="0 0 0" mass="1.44" diaginertia="0.0062937 0.0149070 0.012987"/>
<body pos="0 -0.135 0"><joint type="hinge" axis="0 1 0" pos="0 0.0675 0"/>
<inertial pos="0 0 0" mass="1.44" diaginertia="0.0062937 0.0149070 0.012987"/></body></body></worldbody></mujoco>)";

std::string wheel(const char *x, const char *y) {
    return std::string("<body pos=\"") + x + " " + y +
           " 0\"><joint type=\"hinge\" axis=\"0 1 0\" armature=\"0.0048\"/>"
           "<geom type=\"sphere\" size=\"0.057\" mass=\"0.15\" friction=\"0.73 0.005 0.0001\"/></body>";
}

std::string with_wheels() {
    const std::string body = R"(<inertial pos="0 0 0" mass="1.14" diaginertia="0.0050 0.0118 0.0103"/>)";
    return R"(<mujoco><option timestep="0.001" gravity="0 0 -9.81"/><worldbody><geom type="plane" size="0 0 1"/>
<body pos="0 0.0675 0.057"><freejoint/>)" +
           body + wheel("-0.083", "0.0525") + wheel("0.083", "0.0525") +
           R"(<body pos="0 -0.135 0"><joint type="hinge" axis="0 1 0" pos="0 0.0675 0"/>)" + body + wheel("-0.083", "-0.0525") +
           wheel("0.083", "-0.0525") + "</body></body></worldbody></mujoco>";
}

} // namespace

std::string mujoco_version() { return mj_versionString(); }

RivalResult mujoco_forces(double seconds, sim::ContactLaw law) {
    const Model model = load(halves_only);
    const Data data(mj_makeData(model.get()));
    const sim::Soil &soil = *sim::find_soil("dry_sand_literature");
    const sim::SoilConstants constants = sim::soil_constants(*soil.bekker, 0.042);
    std::array<Wheel, 4> wheels;
    const std::clock_t start = std::clock();
    const long steps = std::lround(seconds / rival_dt_s);
    for (long k = 0; k < steps; ++k) {
        mj_step1(model.get(), data.get());
        for (int h = 0; h < 2; ++h) {
            const int body = h + 1;
            const mjtNum *at = data->xpos + 3 * body, *turn = data->xmat + 9 * body;
            mjtNum motion[6];
            mj_objectVelocity(model.get(), data.get(), mjOBJ_BODY, body, motion, 0); // rotation, then translation, world axes
            mjtNum *applied = data->xfrc_applied + 6 * body;
            for (int a = 0; a < 6; ++a) applied[a] = 0;
            for (int f = 0; f < 2; ++f) {
                const mjtNum local[3] = {f == 0 ? -0.083 : 0.083, h == 0 ? 0.0525 : -0.0525, 0};
                mjtNum arm[3], side[3];
                mju_rotVecMat(arm, local, turn);
                mju_cross(side, motion, arm);
                const double v[3] = {motion[3] + side[0], motion[4] + side[1], motion[5] + side[2]};
                const Push p = push(wheels[static_cast<std::size_t>(2 * f + h)], soil, constants, law, -(at[2] + arm[2]), v);
                const mjtNum force[3] = {p.along, p.across, p.up};
                mjtNum torque[3];
                mju_cross(torque, arm, force);
                mju_addTo3(applied, force);
                mju_addTo3(applied + 3, torque);
            }
        }
        mj_step2(model.get(), data.get());
    }
    return {static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, data->qpos[0]};
}

RivalResult mujoco_contacts(double seconds) {
    const Model model = load(with_wheels());
    const Data data(mj_makeData(model.get()));
    const sim::DriveParameters motor;
    std::array<int, 4> wheel_dof{};
    std::size_t found = 0;
    for (int joint = 0; joint < model->njnt && found < 4; ++joint) // the wheels are the hinges with a rotor
        if (model->dof_armature[model->jnt_dofadr[joint]] > 0) wheel_dof[found++] = model->jnt_dofadr[joint];
    if (found != 4) throw std::runtime_error("MuJoCo: the rover's wheels were not found");
    const std::clock_t start = std::clock();
    const long steps = std::lround(seconds / rival_dt_s);
    for (long k = 0; k < steps; ++k) {
        for (const int dof : wheel_dof) {
            sim::DriveState drive;
            drive.motor_speed_rad_s = data->qvel[dof];
            const double current = sim::drive_current(motor, {}, drive, rival_duty, 7.2, rival_dt_s);
            data->qfrc_applied[dof] = motor.torque_constant_Nm_A * current - motor.viscous_Nms * data->qvel[dof] -
                                      motor.coulomb_Nm * (data->qvel[dof] > 0 ? 1 : 0);
        }
        mj_step(model.get(), data.get());
    }
    return {static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, data->qpos[0]};
}

} // namespace traction::bench
