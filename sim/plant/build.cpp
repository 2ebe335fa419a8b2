#include "world.h"

#include "sim/physics/math.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace traction::sim {

void turn_of(double c, double s, double roll_rad, double pitch_rad, dMatrix3 turn) {
    const double cp = math::cos(pitch_rad), sp = math::sin(pitch_rad), cr = math::cos(roll_rad), sr = math::sin(roll_rad);
    turn[0] = c * cp - s * sr * sp, turn[1] = -s * cr, turn[2] = c * sp + s * sr * cp, turn[3] = 0;
    turn[4] = s * cp + c * sr * sp, turn[5] = c * cr, turn[6] = s * sp - c * sr * cp, turn[7] = 0;
    turn[8] = -cr * sp, turn[9] = sr, turn[10] = cr * cp, turn[11] = 0;
}

void Plant::World::build_bodies() {
    if (config.rover.layout.rocker) return build_rocker();
    const RoverParameters &r = config.rover;
    const double height = law::load_transfer_m(r.centre_height_m, effects.body.raised_m);
    const double load = r.mass_kg * std::fabs(gravity[2]) / 4;
    double sunk = load / r.contact_stiffness_N_m;
    if (config.ground.contact != ContactLaw::aggregated && config.ground.soil.bekker)
        sunk = sinkage_under(config.ground.contact == ContactLaw::arc ? arc_force : bekker_force, *config.ground.soil.bekker,
                             {r.wheel_radius_m, r.wheel_width_m, r.tyre_hysteresis}, load, 0);
    const double cos_yaw = math::cos(config.yaw_rad), sin_yaw = math::sin(config.yaw_rad);
    dMatrix3 turn;
    dRSetIdentity(turn);
    turn[0] = cos_yaw, turn[1] = -sin_yaw, turn[4] = sin_yaw, turn[5] = cos_yaw;
    for (int h = 0; h < 2; ++h) {
        const double side = h == 0 ? 1 : -1, aside = side * half_offset_share * r.width_m;
        const dBodyID body = half[static_cast<std::size_t>(h)] = dBodyCreate(world);
        dMass mass;
        dMassSetBoxTotal(&mass, r.mass_kg / 2, r.length_m, r.width_m / 2, r.height_m);
        dBodySetMass(body, &mass);
        dBodySetRotation(body, turn);
        dBodySetPosition(body, config.x_m - sin_yaw * aside, config.y_m + cos_yaw * aside, height - sunk);
        dBodySetLinearVel(body, config.speed_m_s * cos_yaw, config.speed_m_s * sin_yaw, 0);
        bodies.push_back(body);
        for (const int i : wheels)
            if (is_left(i) == (h == 0))
                carrier[static_cast<std::size_t>(i)] = body,
                contact_at[static_cast<std::size_t>(i)] = {law::mass_offset_m(place(i).ahead_m, effects.body.offset_x_m),
                                                           law::mass_offset_m(place(i).left_m - aside, effects.body.offset_y_m), -height};
    }
    build_joints({config.x_m, config.y_m, height - sunk});
    if (r.layout.kind != Layout::four) stand_up(height);
}

// The halves' joint, about y; a rigid rover's is locked. A carriage is held on its rail by velocities of 0, which never were another.
void Plant::World::build_joints(const Vec3 &anchor) {
    const double cos_yaw = math::cos(config.yaw_rad), sin_yaw = math::sin(config.yaw_rad);
    joint = dJointCreateHinge(world, nullptr);
    dJointAttach(joint, half[0], half[1]);
    dJointSetHingeAnchor(joint, anchor[0], anchor[1], anchor[2]);
    dJointSetHingeAxis(joint, -sin_yaw, cos_yaw, 0);
    if (config.rover.layout.rigid) {
        dJointSetHingeParam(joint, dParamLoStop, 0);
        dJointSetHingeParam(joint, dParamHiStop, 0);
    }
    if (config.rover.layout.kind != Layout::carriage) return;
    const Vec3 aside{-sin_yaw, cos_yaw, 0};
    rail = {dJointCreateLMotor(world, nullptr), dJointCreateAMotor(world, nullptr)};
    for (const dJointID held : rail) dJointAttach(held, half[0], nullptr);
    dJointSetLMotorNumAxes(rail[0], 1);
    dJointSetLMotorAxis(rail[0], 0, 0, aside[0], aside[1], aside[2]);
    dJointSetLMotorParam(rail[0], dParamVel, 0);
    dJointSetLMotorParam(rail[0], dParamFMax, dInfinity);
    dJointSetAMotorMode(rail[1], dAMotorUser);
    dJointSetAMotorNumAxes(rail[1], 3);
    for (int axis = 0; axis < 3; ++axis) {
        dJointSetAMotorAxis(rail[1], axis, 0, axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0);
        dJointSetAMotorParam(rail[1], dParamVel + dParamGroup * axis, 0);
        dJointSetAMotorParam(rail[1], dParamFMax + dParamGroup * axis, dInfinity);
    }
}

// How the rover stands on the plane: (1) of layout.h.
Stance Plant::World::stance() const {
    const RoverParameters &r = config.rover;
    const double weight_N = r.mass_kg * std::fabs(gravity[2]), share_N = weight_N / static_cast<double>(wheels.size());
    const bool soft = config.ground.contact != ContactLaw::aggregated && config.ground.soil.bekker;
    const auto law = config.ground.contact == ContactLaw::arc ? arc_force : bekker_force;
    std::vector<double> ahead_m;
    for (const int i : wheels) ahead_m.push_back(r.layout.kind == Layout::carriage ? 0 : contact_at[static_cast<std::size_t>(i)][0]);
    const auto load_N = [&](std::size_t k, double depth_m) {
        if (depth_m <= 0) return 0.0;
        if (!soft) return r.contact_stiffness_N_m * depth_m;
        const SoilWheel wheel{radius_m(wheels[k]), r.wheel_width_m, r.tyre_hysteresis};
        return law(*config.ground.soil.bekker, constants.front(), wheel, {depth_m, 0, 0}).normal_N;
    };
    const SoilWheel wheel{r.wheel_radius_m, r.wheel_width_m, r.tyre_hysteresis};
    const double start_m = soft ? sinkage_under(law, *config.ground.soil.bekker, wheel, share_N, 0) : share_N / r.contact_stiffness_N_m;
    return stand_on(ahead_m, load_N, weight_N, start_m);
}

// Both halves as one body: `middle` is where the centre of mass goes; yaw, then roll, then pitch (nose down).
void Plant::World::pose(const Vec3 &middle, double roll_rad, double pitch_rad) {
    const double c = math::cos(config.yaw_rad), s = math::sin(config.yaw_rad);
    const double cr = math::cos(roll_rad), sr = math::sin(roll_rad);
    dMatrix3 turn;
    turn_of(c, s, roll_rad, pitch_rad, turn);
    const Vec3 across{-s * cr, c * cr, sr};
    dJointAttach(joint, nullptr, nullptr);
    for (int h = 0; h < 2; ++h) {
        const double aside = (h == 0 ? 1 : -1) * half_offset_share * config.rover.width_m;
        const dBodyID body = half[static_cast<std::size_t>(h)];
        dBodySetPosition(body, middle[0] + across[0] * aside, middle[1] + across[1] * aside, middle[2] + across[2] * aside);
        dBodySetRotation(body, turn);
    }
    dJointAttach(joint, half[0], half[1]);
    dJointSetHingeAnchor(joint, middle[0], middle[1], middle[2]);
    dJointSetHingeAxis(joint, across[0], across[1], across[2]);
}

void Plant::World::stand_up(double height_m) {
    const Stance at = stance();
    pose({config.x_m, config.y_m, height_m * math::cos(at.pitch_rad) - at.depth_m}, 0, at.pitch_rad);
}

// The plane through the wheels' resting heights (least squares in pitch, and in roll where there are two sides), so high that none is
// pressed in further than where it stands.
void Plant::World::place_whole_on_terrain() {
    const RoverParameters &r = config.rover;
    const double c = math::cos(config.yaw_rad), s = math::sin(config.yaw_rad);
    std::vector<double> x, y, z;
    for (const int i : wheels) {
        x.push_back(place(i).ahead_m), y.push_back(place(i).left_m);
        z.push_back(relief
                        ->rest(config.x_m + c * x.back() - s * y.back(), config.y_m + s * x.back() + c * y.back(), c, s, radius_m(i),
                               r.wheel_width_m)
                        .height_m);
    }
    const double n = static_cast<double>(wheels.size());
    double mx = 0, mz = 0, xx = 0, xz = 0, yy = 0, yz = 0; // all layouts are symmetric: y has no mean and nothing in common with x
    for (std::size_t k = 0; k < x.size(); ++k) mx += x[k] / n, mz += z[k] / n;
    for (std::size_t k = 0; k < x.size(); ++k)
        xx += (x[k] - mx) * (x[k] - mx), xz += (x[k] - mx) * (z[k] - mz), yy += y[k] * y[k], yz += y[k] * (z[k] - mz);
    const double rise = xx > 0 ? xz / xx : 0, bank = yy > 0 ? yz / yy : 0; // ahead, to the left
    double lift_m = -1e9;
    for (std::size_t k = 0; k < x.size(); ++k) lift_m = std::max(lift_m, z[k] - rise * x[k] - bank * y[k]);
    const Stance at = stance();
    const double height = law::load_transfer_m(r.centre_height_m, effects.body.raised_m), pitch = at.pitch_rad - math::atan2(rise, 1);
    pose({config.x_m, config.y_m, lift_m + height * math::cos(pitch) - at.depth_m}, math::atan2(bank, 1), pitch);
}

// Each wheel's lowest point at the height that carries it there: the halves pitch, both roll. The joint's anchor follows them.
void Plant::World::place_on_terrain() {
    const RoverParameters &r = config.rover;
    if (r.layout.kind != Layout::four || r.layout.rigid) return place_whole_on_terrain();
    const double c = math::cos(config.yaw_rad), s = math::sin(config.yaw_rad);
    std::array<double, wheel_count> height{};
    for (int i = 0; i < wheel_count; ++i) {
        const double forward = is_front(i) ? r.half_wheelbase_m : -r.half_wheelbase_m,
                     aside = is_left(i) ? r.half_track_m : -r.half_track_m;
        height[static_cast<std::size_t>(i)] =
            relief
                ->rest(config.x_m + c * forward - s * aside, config.y_m + s * forward + c * aside, c, s, r.wheel_radius_m, r.wheel_width_m)
                .height_m;
    }
    const double left = 0.5 * (height[0] + height[2]), right = 0.5 * (height[1] + height[3]), middle = 0.5 * (left + right);
    const double roll = math::atan2(left - right, 2 * r.half_track_m); // right side down
    dJointAttach(joint, nullptr, nullptr);
    Vec3 across{};
    for (int h = 0; h < 2; ++h) {
        const auto n = static_cast<std::size_t>(h);
        const double pitch = math::atan2(height[n] - height[n + 2], 2 * r.half_wheelbase_m); // nose down
        const double cr = math::cos(roll), sr = math::sin(roll);
        dMatrix3 turn;
        turn_of(c, s, roll, pitch, turn);
        across = {-s * cr, c * cr, sr};
        const dReal *was = dBodyGetPosition(half[n]);
        const double aside = (h == 0 ? 1 : -1) * half_offset_share * r.width_m;
        const double x = config.x_m + across[0] * aside, y = config.y_m + across[1] * aside, z = was[2] + middle + across[2] * aside;
        dBodySetPosition(half[n], x, y, z);
        dBodySetRotation(half[n], turn);
    }
    const dReal *a = dBodyGetPosition(half[0]), *b = dBodyGetPosition(half[1]);
    dJointAttach(joint, half[0], half[1]);
    dJointSetHingeAnchor(joint, 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2]));
    dJointSetHingeAxis(joint, across[0], across[1], across[2]);
}

} // namespace traction::sim
