// terramechanics.h - a rigid wheel in deformable soil: load, traction and resistance from its sinkage and slip.
//
//   p = k z^n, k = kc/r + kphi, r = min(ww, l)                 Bekker; (4) Lhomme-Desages                        (1)
//   N = n (1 + e |s|): the wheel sinks deeper when it slips     slip-sinkage; form of Ding et al. (2010), n = n0 + n1 |s|   (2)
//   Fn = ww k sqrt(2R) z^(N+1/2) (3 - N)/3                     Bekker, rigid wheel, for N <= 1.3                  (3)
//   Ft = Fm f(s), Fm = l ww c + Fn tan phi, sc = K/l           (5) Lhomme-Desages, l = sqrt(2Rz - z^2)            (4)
//   Rr = Rc + Rb + Rh (3): Rc = ww k z^(N+1)/(N+1)             (4) Lhomme-Desages
//        Rb = ww z^2 weight/2 tan^2(45 deg + phi/2)            Rankine passive pressure of loosened soil, cohesion lost: assumed
//        Rh = h Fn                                             hysteresis of the tyre
//   A place rolled before has depth z_r and surface z_r - z_e, z_e = k z_r^n/k_u, k_u = max(reload*z_r, 2 k z_r^(n-1)). Up to z_r
//   p = k_u (z - surface), above in closed form Fn(z_r) (d/z_e)^(3/2), d = z - surface, l = 2 sqrt(2Rd)
//                                                              repeated loading: Wong, Terramechanics and Off-Road Vehicles   (5)
//   arc: with theta_m = (c1 + c2 |s|) theta_1 the normal stress is (1) at the node's depth in front, mirrored behind;
//   tau = (c + sigma tan phi)(1 - exp(-|j|/K)) sgn j, j(theta) = R[(theta_1 - theta) - (v/Rw)(sin theta_1 - sin theta)]
//   Fn, Ft, Rr, torque = integrals over the arc, midpoint rule on 16 nodes  Wong and Reece, J. Terramechanics 4 (1967) 81, 7   (6)
//   Rolling bends the soil also at s = 0: Ft(0) > 0. `free_*` give that part, which follows the direction of rolling.
// Valid for z < R and a wheel on fresh or once-rolled soil; unloading on the spot follows the loading curve.
#pragma once

#include "soil.h"

namespace traction::sim {

struct SoilWheel {
    double radius_m, width_m, hysteresis;
    double strength = 1; // factor of all stresses that carry traction (Fm)
    double shear = 1;    // factor of K (sc)
};

struct SoilContact {
    double sinkage_m, slip;
    double rut_m; // depth reached here before, 0: fresh
};

struct SoilForce {
    double normal_N = 0;
    double largest_N = 0;                           // Fm
    double shear_slip = 1;                          // sc
    double traction_N = 0;                          // Ft
    double resistance_N = 0;                        // Rr >= 0
    double torque_Nm = 0;                           // about the axle
    double free_traction_N = 0, free_torque_Nm = 0; // the same at s = 0 and equal sinkage: 0 in closed form
};

// Numbers of one soil and wheel that do not change while rolling.
struct SoilConstants {
    double k_wide = 0;               // kc/ww + kphi
    double tan_phi = 0, passive = 1; // tan^2(45 deg + phi/2)
};
SoilConstants soil_constants(const Bekker &soil, double wheel_width_m);

// (1)-(5). Sinkage <= 0 gives no force.
SoilForce bekker_force(const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel, const SoilContact &contact);

// (1)-(5) of four wheels of one soil, size and width, a number of each in a place of its own: the same bits.
struct FourSoilContacts { // four each
    const double *strength, *sinkage_m, *slip, *rut_m;
};
struct FourSoilForces {
    alignas(32) double normal_N[4]{}, largest_N[4]{}, shear_slip[4]{}, traction_N[4]{}, resistance_N[4]{}, torque_Nm[4]{};
};
void bekker_forces(const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel, const FourSoilContacts &contacts,
                   FourSoilForces &out); // wheel.strength is not read

// (6).
inline constexpr int arc_nodes = 16;
SoilForce arc_force(const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel, const SoilContact &contact);

// How many nodes the arc law takes at once: 2, 4, 8. arc_force takes the most that the processor has; every choice gives the same bits.
enum class Vectors { narrow, avx2, avx512 };
bool has(Vectors vectors);
void bekker_forces_in(Vectors vectors, const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel,
                      const FourSoilContacts &contacts, FourSoilForces &out); // the same
SoilForce arc_force_in(Vectors vectors, const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel,
                       const SoilContact &contact); // one that the processor has

// The sinkage that carries `load_N`, by bisection on either law.
using SoilLawFunction = SoilForce (*)(const Bekker &, const SoilConstants &, const SoilWheel &, const SoilContact &);
double sinkage_under(SoilLawFunction law, const Bekker &soil, const SoilWheel &wheel, double load_N, double slip, double rut_m = 0);

// Depth of the surface left behind in a rut: what springs back is gone from it.
double rut_surface_m(const Bekker &soil, const SoilConstants &constants, double rut_m);

} // namespace traction::sim
