// sim_bench_rival.h - the peers of the plant in `traction bench sim`: the same rover on other engines.
#pragma once

#include "sim/physics/ground.h"

#include <string>

namespace traction::bench {

struct RivalResult {
    double cpu_s = 0, x_m = 0; // CPU time spent, place reached
};

inline constexpr double rival_dt_s = 0.001, rival_duty = 0.5, gravity_m_s2 = 9.81;

// Straight drive at constant duty on dry sand from the literature, for `seconds` simulated.
RivalResult ode_forces(double seconds, sim::ContactLaw contact);    // two ODE bodies on its hinge, our wheels and our law: the baseline
RivalResult ode_contacts(double seconds);                           // six ODE bodies, Coulomb contacts, dWorldStep
RivalResult mujoco_forces(double seconds, sim::ContactLaw contact); // two MuJoCo bodies, our wheels and our law
RivalResult mujoco_contacts(double seconds);                        // MuJoCo's own contacts, four wheel bodies
std::string mujoco_version();

} // namespace traction::bench
