#include "soft.h"
#include "world.h"

#include <algorithm>
#include <array>

namespace traction::sim {

// Four wheels with a motor each, fixed in their heading, on two halves on a plane of one soil, no energy kept; and effects that make no
// branch of their own.
void Plant::World::know_abreast() {
    const Ground &ground = config.ground;
    const RoverParameters &r = config.rover;
    const BodyEffects &b = effects.body;
    const bool plain = is_plain(r.layout) && !r.layout.rocker && !steering.there() && !relief && ground.patches.empty() && !config.audit;
    const bool even =
        even_strength(b) && ground.gradient_1_m == 0 && b.sliding_loss_s_m == 0 && b.shear_peak == 0 && b.heavy_resistance == 0;
    bool simple = r.drive.inductance_H <= 0;
    for (std::size_t i = 0; i < wheel_count; ++i) {
        const WheelEffects &e = effects.wheel[i];
        for (const double other : {e.play_rad, e.stribeck_Nm, e.ripple_cos_Nm, e.ripple_sin_Nm, e.wear_in_Nm, e.reverse_Nm, e.churning_Nms2,
                                   e.speed_loss_s, e.shared_ohm})
            simple = simple && other == 0;
    }
    if (!plain || !even || !simple || carrier_at[2] != carrier_at[0] || carrier_at[3] != carrier_at[1]) return;
    abreast.can = true;
    abreast.soft = ground.contact != ContactLaw::aggregated && ground.soil.bekker.has_value();
    abreast.steps = &four_steps();
    FourKnown &known = abreast.known;
    for (std::size_t i = 0; i < wheel_count; ++i) {
        for (std::size_t k = 0; k < 3; ++k) known.bottom_m[k][i] = contact_at[i][k];
        known.radius_m[i] = law::wheel_radius_m(r.wheel_radius_m, effects.wheel[i].radius_change);
        for (std::size_t n = 0; n < WheelEffects::all().size(); ++n)
            (known.wheel.*WheelEffectsOf<Four>::all()[n])[i] = effects.wheel[i].*WheelEffects::all()[n];
    }
    known.soil_radius_m = r.wheel_radius_m;
    known.body = b;
    known.drive = r.drive;
    const Soil &soil = ground.soil;
    known.law = soil.law;
    known.adhesion_N = soil.adhesion_N, known.fm_per_fn = soil.fm_per_fn;
    known.shear_slip = abreast.soft ? soil.shear_slip : law::shear_stiffness(soil.shear_slip, b.shear_change);
    known.lateral_coefficient = soil.lateral_coefficient, known.rolling_coefficient = soil.rolling_coefficient;
    known.stiffness_N_m = r.contact_stiffness_N_m, known.damping_Ns_m = r.contact_damping_Ns_m;
    known.relaxation_m = law::relaxation_length_m(r.relaxation_length_m, b.relaxation_m);
    known.load_kg = load_kg(), known.wheel_mass_kg = r.wheel_mass_kg, known.dt_s = config.dt_s;
    known.grip_noise = ground.grip_noise, known.grip_length_m = ground.grip_length_m;
    known.nods = law::load_transfer_m(r.centre_height_m, b.raised_m) > 0;
}

bool Plant::World::goes_abreast() const {
    if (!abreast.can) return false;
    for (std::size_t i = 0; i < wheel_count; ++i)
        if (blocked[i] || open[i]) return false;
    return true;
}

void Plant::World::step_abreast(double supply_V) {
    FourWheels &w = abreast.wheels;
    if (!abreast.holds) {
        for (std::size_t i = 0; i < wheel_count; ++i) {
            w.slip[i] = contact[i].slip, w.side_slip[i] = contact[i].side_slip;
            w.speed_m_s[i] = contact[i].speed_m_s, w.rolling[i] = contact[i].rolling;
            w.angle_rad[i] = drive[i].wheel_angle_rad, w.speed_rad_s[i] = drive[i].wheel_speed_rad_s;
            w.current_A[i] = drive[i].current_A, w.heat_K[i] = drive[i].heat_K, w.since_s[i] = drive[i].since_s;
            w.cell_i[i] = grip_cell[i].i, w.cell_j[i] = grip_cell[i].j;
            for (std::size_t k = 0; k < 4; ++k) w.corner[k][i] = grip_cell[i].corner[k];
        }
        abreast.holds = true;
    }
    FourCarriers &on = abreast.carriers;
    const std::array<BodyNow *, 2> side{&now[carrier_at[0]], &now[carrier_at[1]]};
    for (std::size_t i = 0; i < wheel_count; ++i) abreast.orders.duty[i] = duty[i];
    abreast.orders.supply_V = supply_V, abreast.orders.enabled = enabled;

    const auto half_now = [](const BodyNow &one) -> HalfNow { return {one.turn, one.at, one.velocity, one.spin, one.heading.data()}; };
    abreast.steps->ride(half_now(*side[0]), half_now(*side[1]), on);
    abreast.steps->stand(abreast.known, on, w);
    if (abreast.known.grip_noise > 0)
        for (std::size_t i = 0; i < wheel_count; ++i)
            if (!(w.now_i[i] == w.cell_i[i] && w.now_j[i] == w.cell_j[i])) {
                grip_cell[i].go_to(w.now_i[i], w.now_j[i], config.ground.seed);
                w.cell_i[i] = w.now_i[i], w.cell_j[i] = w.now_j[i];
                for (std::size_t k = 0; k < 4; ++k) w.corner[k][i] = grip_cell[i].corner[k];
            }
    if (abreast.soft) {
        abreast.steps->slide(abreast.known, w);
        give_abreast(abreast.given);
        abreast.steps->soft(abreast.known, on, abreast.orders, abreast.given, w);
    } else {
        abreast.steps->firm(abreast.known, on, abreast.orders, w);
    }

    for (std::size_t n = 0; n < 2; ++n) { // in the order of the wheels
        BodyNow &to = *side[n];
        for (std::size_t k = 0; k < 3; ++k) {
            to.force[k] = to.force[k] + w.force_N[k][n] + w.force_N[k][n + 2];
            to.torque[k] = abreast.known.nods
                               ? to.torque[k] + w.moment_Nm[k][n] + w.nod_Nm[k][n] + w.moment_Nm[k][n + 2] + w.nod_Nm[k][n + 2]
                               : to.torque[k] + w.moment_Nm[k][n] + w.moment_Nm[k][n + 2];
        }
    }
    abreast.ahead = true;
}

void Plant::World::give_abreast(FourGiven &given) {
    FourWheels &w = abreast.wheels;
    const RoverParameters &r = config.rover;
    const Soil &soil = config.ground.soil;
    SoilWheel wheel{r.wheel_radius_m, r.wheel_width_m, r.tyre_hysteresis, 1, law::shear_stiffness(1, effects.body.shear_change)};
    std::array<double, wheel_count> rut_m{};
    for (std::size_t i = 0; i < wheel_count; ++i) rut_m[i] = trace[i].follow(ruts, w.point_m[0][i], w.point_m[1][i], w.sinkage_m[i]);
    if (config.ground.contact == ContactLaw::bekker) {
        bekker_forces(*soil.bekker, constants[0], wheel, {w.factor.of.data(), w.sinkage_m.of.data(), w.law_slip.of.data(), rut_m.data()},
                      given.soil);
        return; // its free_N and free_Nm are 0
    }
    for (std::size_t i = 0; i < wheel_count; ++i) {
        wheel.strength = w.factor[i];
        const Given one = on_soft(soil, constants[0], config.ground.contact, wheel, {w.sinkage_m[i], w.law_slip[i], rut_m[i]}, w.still[i]);
        FourSoilForces &to = given.soil;
        to.normal_N[i] = one.soil.normal_N, to.largest_N[i] = one.soil.largest_N, to.shear_slip[i] = one.soil.shear_slip;
        to.traction_N[i] = one.by_slip_N, to.torque_Nm[i] = one.twist_Nm, to.resistance_N[i] = one.soil.resistance_N;
        given.free_N[i] = one.soil.free_traction_N, given.free_Nm[i] = one.soil.free_torque_Nm;
    }
}

void Plant::World::settle() {
    if (!abreast.ahead) return;
    abreast.ahead = false;
    const FourWheels &w = abreast.wheels;
    for (std::size_t i = 0; i < wheel_count; ++i) {
        contact[i].slip = w.slip[i], contact[i].side_slip = w.side_slip[i];
        contact[i].speed_m_s = w.speed_m_s[i], contact[i].rolling = w.rolling[i];
        drive[i] = {.motor_angle_rad = w.angle_rad[i],
                    .motor_speed_rad_s = w.speed_rad_s[i],
                    .wheel_angle_rad = w.angle_rad[i],
                    .wheel_speed_rad_s = w.speed_rad_s[i],
                    .current_A = w.current_A[i],
                    .heat_K = w.heat_K[i],
                    .since_s = w.since_s[i]};
        truth.wheel[i] = {.angle_rad = w.angle_rad[i],
                          .speed_rad_s = w.speed_rad_s[i],
                          .motor_angle_rad = w.angle_rad[i],
                          .motor_speed_rad_s = w.speed_rad_s[i],
                          .current_A = w.current_A[i],
                          .duty = abreast.orders.enabled ? abreast.orders.duty[i] : 0,
                          .traction_N = w.pull_N[i],
                          .rolling_N = w.resistance_N[i],
                          .rolling_share = w.resistance_share[i],
                          .lateral_N = w.sideways_N[i],
                          .normal_N = w.load_N[i],
                          .slip = std::clamp(w.slip[i], -1.0, 1.0),
                          .sinkage_m = w.sinkage_m[i],
                          .ground_speed_m_s = w.along_m_s[i],
                          .winding_temperature_C = 25 + w.heat_K[i]};
    }
}

} // namespace traction::sim
