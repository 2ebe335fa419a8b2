// sim_bench_wheel.h - one wheel by our law on another's body: what MuJoCo's halves and those of the plain ODE loop are given. No effects,
// no terrain, no ruts; the drive is straight along x.
#pragma once

#include "sim_bench_rival.h"

#include "sim/physics/terramechanics.h"
#include "sim/plant/contact.h"
#include "sim/plant/drive.h"

#include <algorithm>
#include <cmath>

namespace traction::bench {

struct Wheel {
    sim::DriveState drive;
    sim::ContactState contact;
};

struct Push {
    double along = 0, across = 0, up = 0;
};

// Force on the rover, world axes; v: of the contact point.
inline Push push(Wheel &w, const sim::Soil &soil, const sim::SoilConstants &constants, sim::ContactLaw law, double depth_m,
                 const double v[3]) {
    const sim::DriveParameters motor;
    const double radius = 0.057;
    sim::ContactInput in{.law = soil.law,
                         .shear_slip = soil.shear_slip,
                         .rim_m_s = radius * w.drive.wheel_speed_rad_s,
                         .along_m_s = v[0],
                         .across_m_s = v[1],
                         .load_kg = 0.72};
    Push out;
    double resist = 0;
    sim::ContactForce force;
    if (law == sim::ContactLaw::aggregated) {
        out.up = std::max(0.0, 6000 * depth_m - 60 * v[2]);
        in.grip_N = soil.adhesion_N + soil.fm_per_fn * out.up;
        force = sim::contact_step(in, w.contact, rival_dt_s);
        resist = soil.rolling_coefficient * out.up;
    } else {
        const sim::SlipChange change = sim::slip_step(in, w.contact, rival_dt_s);
        const auto function = law == sim::ContactLaw::arc ? sim::arc_force : sim::bekker_force;
        const sim::SoilForce soft =
            function(*soil.bekker, constants, {radius, 0.042, 0.005}, {depth_m, std::clamp(w.contact.slip, -1.0, 1.0), 0});
        out.up = std::max(0.0, soft.normal_N - 60 * v[2]);
        in.grip_N = soft.largest_N;
        in.shear_slip = soft.shear_slip;
        force = sim::contact_force(in, w.contact, change, std::fabs(soft.traction_N - soft.free_traction_N), rival_dt_s);
        resist = soft.resistance_N - soft.free_traction_N;
    }
    w.drive.current_A = sim::drive_current(motor, {}, w.drive, rival_duty, 7.2, rival_dt_s);
    sim::drive_step(motor, {}, w.drive, radius * force.along_N, rival_dt_s);
    out.along = force.along_N - resist * std::clamp(v[0] / 0.005, -1.0, 1.0);
    out.across = force.across_N;
    return out;
}

} // namespace traction::bench
