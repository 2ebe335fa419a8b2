// hinge.h - the revolute joint between the chassis halves, solved beside ODE: of a pair on one hinge alone, its stepper spends more time
// on bookkeeping than on these five equations.
//
// Bodies a and b with rotation R, centre p, velocity v, spin w, force f and torque t (gravity among them); r = R anchor, n = R axis:
//   v_a + w_a x r_a - v_b - w_b x r_b = -(erp/h) (p_a + r_a - p_b - r_b)          three rows: the anchors stay together     (1)
//   u.(w_a - w_b) = (erp/h) u.(n_a x n_b), u each of two normals of n_a           two rows: so do the axes                  (2)
// hold at the end of a step of h when J^T lambda is added to forces and torques, J the rows of (1) and (2) and c their right hand side:
//   (J M^-1 J^T + cfm/h) lambda = c/h - J (v/h + M^-1 f)                                                                    (3)
// The same equations, erp and cfm as those of ODE's hinge (hinge_test holds one to the other). The gyroscopic torque is taken over too,
// implicit as ODE's (Lacoursiere 2006), and in the body's own axes, where the inertia is diagonal:
//   L x y with (I - h [L]x) y = L, L = I w;  y = (adj(I) L + h^2 L (L.L) + h (I L) x L)/det, det = |I| + h^2 L.(I L)        (4)
#pragma once

#include <array>

namespace traction::sim {

struct HingeBody {
    double mass_kg = 1;
    std::array<double, 3> inertia_kg_m2{1, 1, 1};        // about its own axes
    std::array<double, 3> anchor_m{}, axis{0, 1, 0};     // in its own frame; axis of length 1
    std::array<double, 3> normal_1{}, normal_2{0, 0, 1}; // of the axis: of the first body
};

// A body now. Matrix in rows of four, as ODE's.
struct HingeMotion {
    const double *turn, *at, *velocity, *spin;
    std::array<double, 3> force_N, torque_Nm;
};

// What joint and spin add to it.
struct HingeLoad {
    std::array<double, 3> force_N{}, torque_Nm{};
};

struct Hinge {
    std::array<HingeBody, 2> body;
    double erp = 0.2, cfm = 1e-10;
    std::array<HingeLoad, 2> loads(const std::array<HingeMotion, 2> &now, double dt_s) const;
};

} // namespace traction::sim
