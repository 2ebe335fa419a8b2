// abreast.h - the four wheels of a plain rover on a plane side by side: a number of each in a place of its own, so that the compiler does
// one operation for all of them at once. The laws are those of contact.h, drive.h and ground.h, in the same order, with the same bits.
//
// Every other rover, and every step in which a wheel is held or a motor open, goes wheel by wheel (wheels.cpp), which is the definition;
// abreast_test holds both to one hash.
#pragma once

#include "contact.h"
#include "drive.h"

#include "sim/physics/terramechanics.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace traction::sim {

struct alignas(32) Four {
    std::array<double, 4> of{};
    Four() = default;
    explicit Four(double all) : of{all, all, all, all} {}
    double &operator[](std::size_t i) { return of[i]; }
    const double &operator[](std::size_t i) const { return of[i]; }
};

// What does not change while it drives.
struct FourKnown {
    std::array<Four, 3> bottom_m; // the contact points in their halves' frames
    Four radius_m;
    double soil_radius_m = 0; // as the soil's law has it
    WheelEffectsOf<Four> wheel;
    BodyEffects body;
    DriveParameters drive;
    TractionLaw law = TractionLaw::janosi;
    double adhesion_N = 0, fm_per_fn = 0, shear_slip = 1, lateral_coefficient = 0, rolling_coefficient = 0; // of the soil
    double stiffness_N_m = 0, damping_Ns_m = 0, relaxation_m = 0, load_kg = 0, wheel_mass_kg = 0, dt_s = 0;
    double grip_noise = 0, grip_length_m = 1;
    bool nods = false; // the wheels' spin-up turns the halves
};

// How a half moves: a rotation in rows of four, the others of three; its heading of two.
struct HalfNow {
    const double *turn, *at_m, *velocity_m_s, *spin_rad_s, *heading;
};

// How the halves move, each number as wheels 0 to 3 have it: of the left, the right, the left, the right one.
struct FourCarriers {
    std::array<Four, 9> turn; // rows
    std::array<Four, 3> at_m, velocity_m_s, spin_rad_s;
    std::array<Four, 2> heading;
};

// What ground that sinks gives, at a wheel's sinkage and slip; traction and torque: the part of them that is due to slip.
struct FourGiven {
    FourSoilForces soil;
    Four free_N, free_Nm, side_ratio{1};
};

struct FourWheels {
    // what is kept: of ContactState, DriveState (without play motor and wheel move as one) and GripCell
    Four slip, side_slip, speed_m_s, rolling;
    Four angle_rad, speed_rad_s, current_A, heat_K, since_s;
    Four cell_i, cell_j;
    std::array<Four, 4> corner;
    // of this step
    std::array<Four, 3> arm_m, point_m;
    Four along_m_s, across_m_s, depth_m, sink_m_s, rim_m_s;
    Four now_i, now_j, in_u, in_v, factor; // of the grip
    Four slid, slid_aside;                 // change of the slip: SlipChange
    Four law_slip, still;                  // as the soil's law counts slip; on_soft
    Four pull_N, resistance_N, resistance_share, sideways_N, load_N, sinkage_m;
    std::array<Four, 3> force_N, moment_Nm, nod_Nm; // on the half; nod: of the spin-up
};

struct FourOrders {
    Four duty;
    double supply_V = 0;
    bool enabled = true;
};

// One step is `ride`, `stand`, then the cells that changed, then `firm`, or `slide`, the soil's law and `soft`.
struct FourSteps {
    void (*ride)(const HalfNow &left, const HalfNow &right, FourCarriers &);
    void (*stand)(const FourKnown &, const FourCarriers &, FourWheels &); // where they touch, how fast they slide
    void (*firm)(const FourKnown &, const FourCarriers &, const FourOrders &, FourWheels &);
    void (*slide)(const FourKnown &, FourWheels &);
    void (*soft)(const FourKnown &, const FourCarriers &, const FourOrders &, const FourGiven &, FourWheels &);
};
const FourSteps &four_steps();                   // in the widest vectors that this processor has
const FourSteps &four_steps_in(Vectors vectors); // one that it has (terramechanics.h); all give the same bits

} // namespace traction::sim
