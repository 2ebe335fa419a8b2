#include "abreast.h"

#include "sim/physics/ground.h"
#include "soft_sign.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace traction::sim {

namespace {

constexpr std::size_t four = 4;

// Written four at once: they are read so.
inline void ride_here(const HalfNow &left, const HalfNow &right, FourCarriers &__restrict on) {
    const auto of = [](Four &all, double l, double r) {
        using Wide = double __attribute__((vector_size(32)));
        const Wide wide{l, r, l, r};
        std::memcpy(all.of.data(), &wide, sizeof wide);
    };
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t c = 0; c < 3; ++c) of(on.turn[3 * k + c], left.turn[4 * k + c], right.turn[4 * k + c]);
        of(on.at_m[k], left.at_m[k], right.at_m[k]);
        of(on.velocity_m_s[k], left.velocity_m_s[k], right.velocity_m_s[k]);
        of(on.spin_rad_s[k], left.spin_rad_s[k], right.spin_rad_s[k]);
    }
    for (std::size_t k = 0; k < 2; ++k) of(on.heading[k], left.heading[k], right.heading[k]);
}

inline void stand_here(const FourKnown &known, const FourCarriers &on, FourWheels &__restrict w) {
    for (std::size_t i = 0; i < four; ++i) {
        const double x = known.bottom_m[0][i], y = known.bottom_m[1][i], z = known.bottom_m[2][i];
        const double arm_0 = on.turn[0][i] * x + on.turn[1][i] * y + on.turn[2][i] * z,
                     arm_1 = on.turn[3][i] * x + on.turn[4][i] * y + on.turn[5][i] * z,
                     arm_2 = on.turn[6][i] * x + on.turn[7][i] * y + on.turn[8][i] * z;
        const double v_0 = on.velocity_m_s[0][i] + (on.spin_rad_s[1][i] * arm_2 - on.spin_rad_s[2][i] * arm_1),
                     v_1 = on.velocity_m_s[1][i] + (on.spin_rad_s[2][i] * arm_0 - on.spin_rad_s[0][i] * arm_2),
                     v_2 = on.velocity_m_s[2][i] + (on.spin_rad_s[0][i] * arm_1 - on.spin_rad_s[1][i] * arm_0);
        const double point_0 = arm_0 + on.at_m[0][i], point_1 = arm_1 + on.at_m[1][i], point_2 = arm_2 + on.at_m[2][i];
        const double ahead_0 = on.heading[0][i], ahead_1 = on.heading[1][i];
        w.arm_m[0][i] = arm_0, w.arm_m[1][i] = arm_1, w.arm_m[2][i] = arm_2;
        w.point_m[0][i] = point_0, w.point_m[1][i] = point_1, w.point_m[2][i] = point_2;
        w.along_m_s[i] = v_0 * ahead_0 + v_1 * ahead_1 + v_2 * 0.0;
        w.across_m_s[i] = v_0 * -ahead_1 + v_1 * ahead_0 + v_2 * 0.0;
        w.depth_m[i] = -point_2;
        w.sink_m_s[i] = -v_2;
        w.rim_m_s[i] = known.radius_m[i] * w.speed_rad_s[i];
        const double u = point_0 / known.grip_length_m, v = point_1 / known.grip_length_m;
        const double cell_i = detail::floor(u), cell_j = detail::floor(v);
        w.now_i[i] = cell_i, w.now_j[i] = cell_j;
        w.in_u[i] = u - cell_i, w.in_v[i] = v - cell_j;
    }
}

inline void feel_grip(const FourKnown &known, FourWheels &__restrict w) {
    if (known.grip_noise <= 0) {
        for (std::size_t i = 0; i < four; ++i) w.factor[i] = 1;
        return;
    }
    for (std::size_t i = 0; i < four; ++i)
        w.factor[i] = 1 + detail::grip_between(w.in_u[i], w.in_v[i], w.corner[0][i], w.corner[1][i], w.corner[2][i], w.corner[3][i], 0,
                                               known.grip_noise);
}

inline ContactInput input_of(const FourKnown &known, const FourWheels &w, std::size_t i) {
    return {.law = known.law,
            .shear_slip = known.shear_slip,
            .relaxation_m = known.relaxation_m,
            .rim_m_s = w.rim_m_s[i],
            .along_m_s = w.along_m_s[i],
            .across_m_s = w.across_m_s[i],
            .load_kg = known.load_kg};
}

// What a contact gave: as Plant::World::Meeting has it.
struct FourMet {
    Four along_N, across_N, rolling_N, free_N, free_Nm, arm_m;
};

inline void meet_firm(const FourKnown &known, FourWheels &__restrict w, FourMet &__restrict met) {
    const double adhesion_N = known.adhesion_N, fm_per_fn = known.fm_per_fn, lateral = known.lateral_coefficient;
    for (std::size_t i = 0; i < four; ++i) {
        ContactInput in = input_of(known, w, i);
        ContactState state{.slip = w.slip[i], .side_slip = w.side_slip[i], .speed_m_s = w.speed_m_s[i]};
        const double factor = w.factor[i];
        const double load = std::max(0.0, known.stiffness_N_m * w.depth_m[i] + known.damping_Ns_m * w.sink_m_s[i]);
        in.grip_N = load > 0 ? (adhesion_N + fm_per_fn * load) * factor : 0;
        in.side_ratio = in.grip_N > 0 ? lateral * load * factor / in.grip_N : 1;
        const ContactForce force = contact_step(in, state, known.dt_s);
        w.slip[i] = state.slip, w.side_slip[i] = state.side_slip, w.speed_m_s[i] = state.speed_m_s;
        w.load_N[i] = load;
        w.sinkage_m[i] = 0;
        met.along_N[i] = force.along_N, met.across_N[i] = force.across_N;
        met.rolling_N[i] = known.rolling_coefficient * load;
        met.free_N[i] = met.free_Nm[i] = met.arm_m[i] = 0;
    }
}

inline void slide_here(const FourKnown &known, FourWheels &__restrict w) {
    feel_grip(known, w);
    for (std::size_t i = 0; i < four; ++i) {
        ContactState state{.slip = w.slip[i], .side_slip = w.side_slip[i], .speed_m_s = w.speed_m_s[i]};
        const SlipChange change = slip_step(input_of(known, w, i), state, known.dt_s);
        w.slip[i] = state.slip, w.side_slip[i] = state.side_slip, w.speed_m_s[i] = state.speed_m_s;
        w.slid[i] = change.along, w.slid_aside[i] = change.across;
        w.sinkage_m[i] = std::max(0.0, w.depth_m[i]);
        const double total = total_slip(state), along = w.along_m_s[i], turned = -state.slip;
        w.law_slip[i] = std::copysign(std::min(total, 1.0), along < 0 ? turned : state.slip);
        w.still[i] = 0.5 * (1 - std::fabs(along) / reversal_m_s);
    }
}

inline void meet_soft(const FourKnown &known, const FourGiven &given, FourWheels &__restrict w, FourMet &__restrict met) {
    for (std::size_t i = 0; i < four; ++i) {
        ContactInput in = input_of(known, w, i);
        const FourSoilForces &soil = given.soil;
        const double given_N = soil.normal_N[i], resistance = soil.resistance_N[i], free_N = given.free_N[i], free_Nm = given.free_Nm[i];
        const double by_slip = std::fabs(soil.traction_N[i]), twist = std::fabs(soil.torque_Nm[i]),
                     damping = known.damping_Ns_m * -w.sink_m_s[i];
        const double belly = std::max(0.0, w.sinkage_m[i] - 0.9 * known.soil_radius_m) * known.stiffness_N_m;
        const double load = std::max(0.0, given_N + belly - (given_N > 0 ? damping : 0));
        const double most = soil.largest_N[i];
        in.grip_N = load > 0 ? most : 0; // then there is no force either
        in.shear_slip = soil.shear_slip[i];
        in.side_ratio = given.side_ratio[i]; // one that is loaded: written here, the loop is no vector code
        in.law = TractionLaw::janosi;
        const ContactState state{.slip = w.slip[i], .side_slip = w.side_slip[i]};
        const ContactForce force = contact_force(in, state, {w.slid[i], w.slid_aside[i]}, by_slip, known.dt_s);
        w.load_N[i] = load;
        met.along_N[i] = force.along_N, met.across_N[i] = force.across_N;
        met.rolling_N[i] = load > 0 ? resistance : 0;
        met.free_N[i] = load > 0 ? free_N : 0, met.free_Nm[i] = load > 0 ? free_Nm : 0;
        met.arm_m[i] = by_slip > 1e-6 ? twist / by_slip : 0;
    }
}

inline WheelEffects effects_of(const WheelEffectsOf<Four> &all, std::size_t i) { // those that a run abreast may have
    WheelEffects one;
    one.coulomb_Nm = all.coulomb_Nm[i], one.viscous_Nms = all.viscous_Nms[i], one.mesh_fraction = all.mesh_fraction[i];
    one.heating_K_W = all.heating_K_W[i], one.heating_time_s = all.heating_time_s[i], one.wiring_ohm = all.wiring_ohm[i];
    one.dead_voltage_V = all.dead_voltage_V[i], one.constant_change = all.constant_change[i], one.rolling = all.rolling[i];
    return one;
}

// What the contact gave, on the halves; and the motors under it.
inline void push_and_turn(const FourKnown &known, const FourCarriers &on, const FourOrders &orders, const FourMet &__restrict met,
                          FourWheels &__restrict w) {
    Four torque_Nm;
    for (std::size_t i = 0; i < four; ++i) {
        const WheelEffects mine = effects_of(known.wheel, i);
        const double load = w.load_N[i], along = w.along_m_s[i];
        const double slip_size = std::min(1.0, std::fabs(w.slip[i]));
        double resistance = met.rolling_N[i];
        each_resistance(mine, known.body, slip_size, along, [&](double per_load) { resistance += per_load * load; });
        const double sideways = met.across_N[i] - law::lateral_scrub_N(known.body.scrub, load) * soft_sign(w.across_m_s[i], 0.02);
        ContactState state{.rolling = w.rolling[i]};
        const double turned = rolling_step(state, along, resistance - met.free_N[i], known.load_kg, known.dt_s);
        w.rolling[i] = state.rolling;
        const double pull = met.along_N[i] + met.free_N[i] * turned, ahead = pull - resistance * turned + 0.0;
        const double ahead_0 = on.heading[0][i], ahead_1 = on.heading[1][i];
        const double force_0 = ahead * ahead_0 + sideways * -ahead_1 + load * 0.0,
                     force_1 = ahead * ahead_1 + sideways * ahead_0 + load * 0.0, force_2 = ahead * 0.0 + sideways * 0.0 + load * 1.0;
        w.force_N[0][i] = force_0, w.force_N[1][i] = force_1, w.force_N[2][i] = force_2;
        w.moment_Nm[0][i] = w.arm_m[1][i] * force_2 - w.arm_m[2][i] * force_1;
        w.moment_Nm[1][i] = w.arm_m[2][i] * force_0 - w.arm_m[0][i] * force_2;
        w.moment_Nm[2][i] = w.arm_m[0][i] * force_1 - w.arm_m[1][i] * force_0;
        const double arm = met.arm_m[i], radius = known.radius_m[i];
        torque_Nm[i] = (arm > 0 ? arm : radius) * met.along_N[i] + met.free_Nm[i] * soft_sign(w.rim_m_s[i], reversal_m_s);
        w.pull_N[i] = pull, w.resistance_N[i] = resistance, w.resistance_share[i] = turned, w.sideways_N[i] = sideways;
    }
    DriveParameters drive = known.drive;
    drive.inductance_H = 0; // of a run abreast: no branch
    const double enabled = orders.enabled ? 1 : 0;
    for (std::size_t i = 0; i < four; ++i) {
        const WheelEffects mine = effects_of(known.wheel, i);
        const double before = w.speed_rad_s[i];
        DriveState d{.motor_angle_rad = w.angle_rad[i],
                     .motor_speed_rad_s = before,
                     .wheel_angle_rad = w.angle_rad[i],
                     .wheel_speed_rad_s = before,
                     .current_A = w.current_A[i],
                     .heat_K = w.heat_K[i],
                     .since_s = w.since_s[i]};
        const double current = drive_current(drive, mine, d, orders.duty[i], orders.supply_V, known.dt_s, 0);
        d.current_A = enabled > 0 ? current : 0;
        drive_step(drive, mine, d, torque_Nm[i], known.dt_s);
        w.angle_rad[i] = d.wheel_angle_rad, w.speed_rad_s[i] = d.wheel_speed_rad_s, w.current_A[i] = d.current_A;
        w.heat_K[i] = d.heat_K, w.since_s[i] = d.since_s;
        const double radius = known.radius_m[i];
        const double spin = 0.5 * known.wheel_mass_kg * radius * radius * (d.wheel_speed_rad_s - before) / known.dt_s;
        for (std::size_t k = 0; k < 3; ++k) w.nod_Nm[k][i] = (0.0 * on.turn[3 * k][i] - 1.0 * on.turn[3 * k + 1][i]) * spin;
    }
}

inline void firm_here(const FourKnown &known, const FourCarriers &on, const FourOrders &orders, FourWheels &__restrict w) {
    FourMet met;
    feel_grip(known, w);
    meet_firm(known, w, met);
    push_and_turn(known, on, orders, met, w);
}

inline void soft_here(const FourKnown &known, const FourCarriers &on, const FourOrders &orders, const FourGiven &given,
                      FourWheels &__restrict w) {
    FourMet met;
    meet_soft(known, given, w, met);
    push_and_turn(known, on, orders, met, w);
}

// The same operations for each wheel, none contracted: the same bits, however many go at once.
#define TRACTION_FOUR_IN_narrow __attribute__((flatten))
#define TRACTION_FOUR_IN_avx2 __attribute__((target("avx2"), flatten))
#define TRACTION_FOUR_STEPS(name)                                                                                                          \
    TRACTION_FOUR_IN_##name void ride_##name(const HalfNow &left, const HalfNow &right, FourCarriers &on) { ride_here(left, right, on); }  \
    TRACTION_FOUR_IN_##name void stand_##name(const FourKnown &known, const FourCarriers &on, FourWheels &__restrict w) {                  \
        stand_here(known, on, w);                                                                                                          \
    }                                                                                                                                      \
    TRACTION_FOUR_IN_##name void firm_##name(const FourKnown &known, const FourCarriers &on, const FourOrders &orders,                     \
                                             FourWheels &__restrict w) {                                                                   \
        firm_here(known, on, orders, w);                                                                                                   \
    }                                                                                                                                      \
    TRACTION_FOUR_IN_##name void slide_##name(const FourKnown &known, FourWheels &__restrict w) { slide_here(known, w); }                  \
    TRACTION_FOUR_IN_##name void soft_##name(const FourKnown &known, const FourCarriers &on, const FourOrders &orders,                     \
                                             const FourGiven &given, FourWheels &__restrict w) {                                           \
        soft_here(known, on, orders, given, w);                                                                                            \
    }                                                                                                                                      \
    constexpr FourSteps steps_##name{ride_##name, stand_##name, firm_##name, slide_##name, soft_##name};

TRACTION_FOUR_STEPS(narrow)
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define TRACTION_WIDE_VECTORS 1
TRACTION_FOUR_STEPS(avx2)
#endif

} // namespace

const FourSteps &four_steps_in([[maybe_unused]] Vectors vectors) {
#ifdef TRACTION_WIDE_VECTORS
    if (vectors != Vectors::narrow) return steps_avx2; // four fill no wider ones
#endif
    return steps_narrow;
}

const FourSteps &four_steps() {
    static const FourSteps &widest = four_steps_in(has(Vectors::avx2) ? Vectors::avx2 : Vectors::narrow);
    return widest;
}

} // namespace traction::sim
