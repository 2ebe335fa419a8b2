// motion.h - the body's speed from the model's forces, the wheels' speeds being given: (1) of forward.h.
//
//   q_k = 4/3 q_{k-1} - 1/3 q_{k-2} + 2/3 h rate(q_k)     second-order backward differences (Gear 1971), L-stable: the soil is stiff  (1)
//   rate = (Fx/M + r vy, Fy/M - r vx, Mz/Izz)             Euler's equations in the body's frame; vy = 0 for skid steer             (2)
// Neighbours of a known motion by one linear recursion, tangent.cpp:
//   dq_k = (I - 2/3 h A_k)^-1 (4/3 dq_{k-1} - 1/3 dq_{k-2} + 2/3 h (d rate + rate_a da_{k-1} + rate_x dx_{k-1})),  A = d rate/dq      (3)
// where d rate is what the moved parameters change at the known motion.
#pragma once

#include "dataset.h"
#include "physics.h"

#include <Eigen/Core>

#include <vector>

namespace traction::lab {

// Derivatives of one step at a known motion, for (3). By path: of the path travelled; by accel: of the acceleration a step before.
struct StepTangent {
    Eigen::Matrix3d inverse;               // of I - 2/3 h A (h for the first step)
    Eigen::Vector3d rate_by_accel, rate_by_path;
};

// Trajectory of one pass, on the grid.
struct Motion {
    std::vector<double> v_m_s, vy_m_s, yaw_rate_rad_s, path_m;
    std::vector<double> accel_m_s2; // specific force along x: what an accelerometer feels
    std::vector<Eigen::Vector3d> rate; // of (vx, vy, yaw rate)
    struct Wheel {
        std::vector<double> traction_N, rolling_N, slip, load_N, ground_speed_m_s;
        std::vector<Eigen::Vector3d> force;             // contribution to (Fx, Fy, Mz); with the tangents only
        std::vector<Eigen::Vector3d> traction_by_speed; // with the tangents only, as are the next
        std::vector<double> traction_by_accel, traction_by_path;
    };
    std::vector<Wheel> wheel;
    std::vector<StepTangent> tangent; // where asked for
};

// Integrates over the whole grid. `guess`: a nearby trajectory that starts the root search, or nullptr; with its tangents the search
// is a chord iteration, two evaluations a step. `keep`: store the tangents.
void integrate(const Dataset &data, const Physics &physics, Motion &motion, const Motion *guess, bool keep);

// True where neighbour() holds: free motion, nothing carried by the wheels from step to step.
bool has_neighbours(const Dataset &data, const Physics &physics);

// Motion of `moved`, to first order, beside a known motion with its tangents. `wheel`: the only wheel whose numbers differ; -1: any.
// whole: slip, wheel speed and load too, else the body and the tractions alone.
void neighbour(const Dataset &data, const Physics &moved, const Motion &known, int wheel, bool whole, Motion &motion);

namespace detail {

// What is sought in a step: which of (vx, vy, yaw rate) follow from the forces.
struct Freedom {
    bool vy = false, yaw = false;
};
Freedom freedom_of(const Dataset &data, const Physics &physics);

// (2) from the sum of forces.
inline Eigen::Vector3d rate_of(const Eigen::Vector3d &force, const Eigen::Vector3d &q, double grade, const Physics &p, Freedom freedom) {
    Eigen::Vector3d rate(force[0] / p.body.mass + grade, 0, freedom.yaw ? force[2] / p.body.yaw_inertia : 0);
    if (freedom.vy) rate[0] += q[2] * q[1], rate[1] = force[1] / p.body.mass - q[2] * q[0];
    return rate;
}

void resize(Motion &motion, std::size_t count, std::size_t wheels, bool keep);

} // namespace detail
} // namespace traction::lab
