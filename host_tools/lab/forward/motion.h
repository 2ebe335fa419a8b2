// motion.h - the body's speed from the model's forces, the wheels' speeds being given: (1) of forward.h.
//
//   q_k = 4/3 q_{k-1} - 1/3 q_{k-2} + 2/3 h rate(q_k)     second-order backward differences (Gear 1971), L-stable: the soil is stiff  (1)
//   rate = (Fx/M + r vy, Fy/M - r vx, Mz/Izz)             Euler's equations in the body's frame; vy = 0 for longitudinal motion     (2)
// With a gyro: Mz/Izz + observer_1_s * (gyro - yaw rate), both of Dataset::yaw_late steps ago. Where all wheels slide nothing else holds
// the heading, and uneven ground would carry the model's yaw rate away; where they grip the soil is a hundred times stiffer, and the pull
// has no effect. Neighbours of a known motion by one linear recursion, tangent.cpp:
//   dq_k = (I - 2/3 h A_k)^-1 (4/3 dq_{k-1} - 1/3 dq_{k-2} + 2/3 h (d rate + rate_a da_{k-1} + rate_x dx_{k-1} + rate_s ds_{k-1}))      (3)
// where A = d rate/dq, d rate is what the moved parameters change at the known motion, a acceleration, x path, s lagging slips (along and
// across).
#pragma once

#include "host_tools/lab/inputs/dataset.h"
#include "physics.h"

#include <Eigen/Core>

#include <vector>

namespace traction::lab {

// Derivatives of one step at a known motion, for (3). By path: of the path travelled; by accel: of the acceleration a step before.
struct StepTangent {
    Eigen::Matrix3d inverse; // of I - 2/3 h A (h for the first step)
    Eigen::Vector3d rate_by_accel, rate_by_path;
};

// Trajectory of one pass, on the grid.
struct Motion {
    std::vector<double> v_m_s, vy_m_s, yaw_rate_rad_s, path_m;
    std::vector<double>
        away_m; // of the way from the start, the part along the heading (omni wheels: the path); with the tangents or a tether only
    std::vector<double> accel_m_s2;    // specific force along x: what an accelerometer feels
    std::vector<double> twist_N;       // half of what the left wheels pull more than the right ones
    std::vector<Eigen::Vector3d> rate; // of (vx, vy, yaw rate)
    struct Wheel {
        std::vector<double> traction_N, rolling_N, slip, side_slip, load_N, ground_speed_m_s;
        std::vector<Eigen::Vector3d> force;             // contribution to (Fx, Fy, Mz); with the tangents only
        std::vector<Eigen::Vector3d> traction_by_speed; // with the tangents only, as are the next
        std::vector<double> traction_by_accel, traction_by_path;
        std::vector<Eigen::Vector3d> force_by_slip, slip_by_speed; // by the slip a step before, where it lags
        std::vector<double> traction_by_slip, slip_by_slip;
        std::vector<Eigen::Vector3d> force_by_side, side_by_speed; // the same of the slip across
        std::vector<double> traction_by_side, side_by_side;
    };
    std::vector<Wheel> wheel;
    std::vector<StepTangent> tangent; // where asked for
};

// Integrates over the whole grid. `guess`: a nearby trajectory that starts the root search, or nullptr; with its tangents the search
// is a chord iteration, one or two evaluations a step. `keep`: store the tangents.
void integrate(const Dataset &data, const Physics &physics, Motion &motion, const Motion *guess, bool keep);

// True where neighbour() holds: free motion, no play in the gears, and slip lags at the same wheels.
bool has_neighbours(const Physics &base, const Physics &moved);

// Motion of `moved`, to first order, beside a known motion with its tangents. `wheel`: the only wheel whose numbers differ; -1: any.
// whole: slip, wheel speed and load too, else the body and the tractions alone.
void neighbour(const Dataset &data, const Physics &moved, const Motion &known, int wheel, bool whole, Motion &motion);
// Several at once: the known motion, megabytes of it, is read once for all.
struct Beside {
    const Physics *moved = nullptr;
    int wheel = -1;
    bool whole = false;
    Motion *motion = nullptr; // where it goes
};
void neighbours(const Dataset &data, const Motion &known, const std::vector<Beside> &list);

// What one unit of a term does at each step of a known motion, per wheel: shapes f(X) share it, each with its own f.
struct UnitResponse {
    std::vector<std::vector<Eigen::Vector3d>> force; // (Fx, Fy, Mz)
    std::vector<std::vector<double>> traction;
};
UnitResponse unit_response(const Dataset &data, const Physics &base, const Motion &known, TermTarget target);
// Several shapes at once. share: of shape j at wheel i and step k, at (k * wheels + i) * motions.size() + j.
inline constexpr std::size_t most_shapes = 8;
void neighbours_shaped(const Dataset &data, const Physics &base, const Motion &known, const UnitResponse &unit,
                       const std::vector<double> &share, std::vector<Motion> &motions);

namespace detail {

// What is sought in a step: which of (vx, vy, yaw rate) follow from the forces.
struct Freedom {
    bool vy = false, yaw = false;
    bool omni = false;     // rollers: the body goes any way, its path has no sign
    bool observed = false; // a gyro holds the yaw rate
};
Freedom freedom_of(const Dataset &data, const Physics &physics);

inline constexpr double observer_1_s = 4; // forgets in 0.25 s, three times what it is late by: assumed

// By which the gyro draws the yaw rate at step k [rad/s^2]; `yaw_rate_rad_s`: this motion's, as far as it is known.
inline double pull_of(const Dataset &data, const std::vector<double> &yaw_rate_rad_s, std::size_t k, Freedom freedom) {
    if (!freedom.observed || k < data.yaw_late || data.yaw_rate_rad_s.empty()) return 0;
    const std::size_t at = k - data.yaw_late;
    return observer_1_s * (data.yaw_rate_rad_s[at] - yaw_rate_rad_s[at]);
}

// (2) from the sum of forces; grade: gravity along the slope, forward and left; pull: pull_of().
inline Eigen::Vector3d rate_of(const Eigen::Vector3d &force, const Eigen::Vector3d &q, const Eigen::Vector2d &grade, double pull,
                               const Physics &p, Freedom freedom) {
    Eigen::Vector3d rate(force[0] / p.body.mass + grade[0], 0, freedom.yaw ? force[2] / p.body.yaw_inertia : 0);
    if (freedom.observed) rate[2] += pull;
    if (freedom.vy) rate[0] += q[2] * q[1], rate[1] = force[1] / p.body.mass + grade[1] - q[2] * q[0];
    return rate;
}

void resize(Motion &motion, std::size_t count, std::size_t wheels, bool keep, bool lags);

} // namespace detail
} // namespace traction::lab
