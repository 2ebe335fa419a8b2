// soft.h - what the ground gives one wheel whose soil sinks, by its contact law; and ground that does not, beside it.
#pragma once

#include "sim/physics/ground.h"
#include "sim/physics/terramechanics.h"

#include "plant.h"

#include <cmath>

namespace traction::sim {

// What the ground gives a wheel, at one sinkage and slip.
struct Given {
    SoilForce soil;
    double by_slip_N = 0, twist_Nm = 0; // the part of traction and torque that is due to slip, >= 0
    double side_ratio = 1;
};

// Ground that does not sink: (20) or (21) on the wheel's own spring.
inline Given on_firm(const Soil &soil, const RoverParameters &r, const SoilWheel &wheel, double sinkage_m, double total) {
    Given out;
    out.soil.normal_N = r.contact_stiffness_N_m * sinkage_m;
    out.soil.largest_N = wheel.strength * (soil.adhesion_N + soil.fm_per_fn * out.soil.normal_N);
    out.soil.shear_slip = wheel.shear * soil.shear_slip;
    out.soil.resistance_N = soil.rolling_coefficient * out.soil.normal_N;
    out.by_slip_N = out.soil.largest_N * traction_share(soil.law, total, out.soil.shear_slip);
    out.twist_Nm = wheel.radius_m * out.by_slip_N;
    out.side_ratio = out.soil.largest_N > 0 ? wheel.strength * soil.lateral_coefficient * out.soil.normal_N / out.soil.largest_N : 1;
    return out;
}

// `still`: 0 rolling .. 0.5 at rest, where the arc law's two directions are met halfway.
inline Given on_soft(const Soil &soil, const SoilConstants &constants, ContactLaw contact, const SoilWheel &wheel, const SoilContact &at,
                     double still) {
    const auto law = contact == ContactLaw::arc ? arc_force : bekker_force;
    Given out;
    SoilForce &soft = out.soil;
    soft = law(*soil.bekker, constants, wheel, at);
    out.by_slip_N = std::fabs(soft.traction_N - soft.free_traction_N), out.twist_Nm = std::fabs(soft.torque_Nm - soft.free_torque_Nm);
    if (still > 0 && contact == ContactLaw::arc) {
        const SoilForce other = law(*soil.bekker, constants, wheel, {at.sinkage_m, -at.slip, at.rut_m});
        out.by_slip_N += still * (std::fabs(other.traction_N - other.free_traction_N) - out.by_slip_N);
        out.twist_Nm += still * (std::fabs(other.torque_Nm - other.free_torque_Nm) - out.twist_Nm);
        soft.normal_N += still * (other.normal_N - soft.normal_N);
        soft.resistance_N += still * (other.resistance_N - soft.resistance_N);
    }
    return out;
}

inline void blend(Given &a, const Given &b, double share) {
    const auto blend = [share](double &x, double y) { x += share * (y - x); };
    blend(a.soil.normal_N, b.soil.normal_N), blend(a.soil.largest_N, b.soil.largest_N), blend(a.soil.shear_slip, b.soil.shear_slip);
    blend(a.soil.resistance_N, b.soil.resistance_N), blend(a.soil.free_traction_N, b.soil.free_traction_N);
    blend(a.soil.free_torque_Nm, b.soil.free_torque_Nm), blend(a.by_slip_N, b.by_slip_N), blend(a.twist_Nm, b.twist_Nm);
    blend(a.side_ratio, b.side_ratio);
}

} // namespace traction::sim
