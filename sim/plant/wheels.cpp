#include "soft.h"
#include "world.h"

#include <algorithm>
#include <cmath>

namespace traction::sim {

double Plant::World::place_on_path(int i) const { return truth.path_m + place_ahead_m[static_cast<std::size_t>(i)]; }

// Of the other motors on a shared lead, a step before: where the lead is long beside the windings that would ring, so they follow slowly.
double Plant::World::current_of_others(int i) {
    const auto n = static_cast<std::size_t>(i);
    const double with = effects.wheel[n].shared_with;
    if (effects.wheel[n].shared_ohm == 0) return 0;
    double sum = 0;
    for (const int j : wheels)
        if (j != i && !caster(j) && law::shares_lead(with, is_front(j) == is_front(i), is_left(j) == is_left(i)))
            sum += drive[static_cast<std::size_t>(j)].current_A;
    constexpr double share = 0.3; // of the difference, per step: assumed, 3 ms
    others_A[n] += share * (sum - others_A[n]);
    return others_A[n];
}

double Plant::World::grip_factor(int i, double x_m, double y_m, double sliding_m_s) {
    const double place = 1 + config.ground.grip_change(x_m, y_m, grip_cell[static_cast<std::size_t>(i)]);
    const double here =
        even_strength(effects.body) ? place : strength_here(place, effects.body, place_on_path(i), truth.path_m, trails(i) ? 1 : 0);
    return strength_sliding(here, effects.body, sliding_m_s);
}

const SoilConstants &Plant::World::constants_of(const Soil &soil) const {
    std::size_t n = 0; // the base soil, unless a patch owns it
    for (std::size_t i = 0; i < config.ground.patches.size(); ++i)
        if (&config.ground.patches[i].soil == &soil) n = i + 1;
    return constants[n];
}

Plant::World::Meeting Plant::World::meet_aggregated(int i, ContactInput in, const Soil &soil, double factor, double load_N) {
    const auto n = static_cast<std::size_t>(i);
    Meeting out;
    out.load_N = load_N;
    in.grip_N = load_N > 0 ? (soil.adhesion_N + soil.fm_per_fn * load_N) * factor : 0;
    in.shear_slip = law::shear_stiffness(soil.shear_slip, effects.body.shear_change);
    in.side_ratio = in.grip_N > 0 ? soil.lateral_coefficient * load_N * factor / in.grip_N : 1;
    out.force = contact_step(in, contact[n], config.dt_s);
    out.rolling_N = soil.rolling_coefficient * load_N;
    return out;
}

// The soils before and behind the axle, and how much of the wheel's footprint the one in front has: at a patch's edge a wheel stands on
// both.
Plant::World::Footing Plant::World::footing(const Vec3 &point, const Vec3 &heading, double half_m) const {
    if (config.ground.patches.empty()) return {.behind = &config.ground.soil, .front = &config.ground.soil};
    const auto soil_at = [&](double ahead_m) {
        return &config.ground.at(point[0] + ahead_m * heading[0], point[1] + ahead_m * heading[1]);
    };
    Footing out{.behind = soil_at(-half_m), .front = soil_at(half_m), .length_m = 2 * half_m};
    if (out.behind == out.front) return out;
    double low = -half_m, high = half_m; // one edge under a wheel: a strip narrower than the footprint is overlooked (assumed wider)
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (low + high);
        (soil_at(middle) == out.behind ? low : high) = middle;
    }
    out.share_front = (half_m - high) / (2 * half_m);
    return out;
}

// Work to press the wheel down to its sinkage: Gauss-Legendre, 4 points.
template <class Normal> double work_to_sink_J(double sinkage_m, const Normal &normal_N) {
    constexpr double place[] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263};
    constexpr double weight[] = {0.17392742256872692, 0.32607257743127305, 0.32607257743127305, 0.17392742256872692};
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += weight[i] * normal_N(place[i] * sinkage_m);
    return sum * sinkage_m;
}

Plant::World::Meeting Plant::World::meet_soft(int i, ContactInput in, const Footing &foot, double factor, const Stand &at) {
    const auto n = static_cast<std::size_t>(i);
    const RoverParameters &r = config.rover;
    Meeting out;
    out.sinkage_m = std::max(0.0, at.depth_m / at.steep);
    const double rut = trace[n].follow(ruts, at.point[0], at.point[1], out.sinkage_m);
    const SlipChange change = slip_step(in, contact[n], config.dt_s);
    const double total = total_slip(contact[n]);
    const SoilWheel wheel{radius_m(i), r.wheel_width_m, r.tyre_hysteresis, factor, law::shear_stiffness(1, effects.body.shear_change)};
    // the law counts slip along the motion: a wheel that rolls backwards sees the mirrored one; near rest, the mean of both
    const double slip = std::copysign(std::min(total, 1.0), in.along_m_s < 0 ? -contact[n].slip : contact[n].slip);
    const double still = 0.5 * (1 - std::fabs(in.along_m_s) / reversal_m_s);
    const auto given_by = [&](const Soil &soil, double sinkage_m) {
        return soil.bekker ? on_soft(soil, constants_of(soil), config.ground.contact, wheel, {sinkage_m, slip, rut}, still)
                           : on_firm(soil, r, wheel, sinkage_m, total);
    };
    Given given = given_by(*foot.front, out.sinkage_m);
    if (foot.front != foot.behind) {
        blend(given, given_by(*foot.behind, out.sinkage_m), 1 - foot.share_front);
        // the wheel is lifted by what it enters and let down by what it leaves: -dU/dx of the mixture, so that an edge gives no energy
        const auto work_J = [&](const Soil &soil) {
            return work_to_sink_J(out.sinkage_m, [&](double z) { return given_by(soil, z).soil.normal_N; });
        };
        out.edge_N = (work_J(*foot.behind) - work_J(*foot.front)) / foot.length_m;
    }
    const double belly = std::max(0.0, out.sinkage_m - 0.9 * wheel.radius_m) * r.contact_stiffness_N_m; // the body sits down
    out.load_N =
        std::max(0.0, given.soil.normal_N + belly - (given.soil.normal_N > 0 ? r.contact_damping_Ns_m * -(at.sink_m_s / at.steep) : 0));
    if (out.load_N <= 0) return out;
    in.grip_N = given.soil.largest_N;
    in.shear_slip = given.soil.shear_slip;
    in.side_ratio = given.side_ratio;
    in.law = TractionLaw::janosi;
    // the part due to slip goes with the slip; what rolling alone does goes with the direction of rolling
    out.force = contact_force(in, contact[n], change, given.by_slip_N, config.dt_s);
    out.free_N = given.soil.free_traction_N;
    out.free_Nm = given.soil.free_torque_Nm;
    out.arm_m = given.by_slip_N > 1e-6 ? given.twist_Nm / given.by_slip_N : 0;
    out.rolling_N = given.soil.resistance_N;
    return out;
}

// The body's lowest point under the axle, on the plane z = 0.
Plant::World::Stand Plant::World::stand_on_plane(int i) {
    const Vec3 &bottom = contact_at[static_cast<std::size_t>(i)];
    const BodyNow &on = now_of(i);
    Stand at;
    for (std::size_t k = 0; k < 3; ++k) {
        at.arm[k] = on.turn[4 * k] * bottom[0] + on.turn[4 * k + 1] * bottom[1] + on.turn[4 * k + 2] * bottom[2];
        at.point[k] = at.arm[k] + on.at[k];
    }
    at.velocity = {on.velocity[0] + (on.spin[1] * at.arm[2] - on.spin[2] * at.arm[1]),
                   on.velocity[1] + (on.spin[2] * at.arm[0] - on.spin[0] * at.arm[2]),
                   on.velocity[2] + (on.spin[0] * at.arm[1] - on.spin[1] * at.arm[0])};
    at.heading = on.heading;
    if (steering.there()) {
        const Steering::Wheel &turned = steering.wheel(i);
        at.heading = {turned.cosine * on.heading[0] - turned.sine * on.heading[1],
                      turned.sine * on.heading[0] + turned.cosine * on.heading[1], 0};
    }
    at.ahead = at.heading;
    at.left = {-at.heading[1], at.heading[0], 0};
    at.up = {0, 0, 1};
    at.depth_m = -at.point[2];
    at.sink_m_s = -at.velocity[2];
    return at;
}

// On terrain the wheel is a disc: it touches where (4) of terrain.h says. The force along `up` is steep times that of the depth, so that
// an elastic ground has the potential k depth^2/2 and gives no energy, however steep.
Plant::World::Stand Plant::World::stand(int i) {
    Stand at = stand_on_plane(i);
    if (!relief) return at;
    const RoverParameters &r = config.rover;
    const Vec3 &bottom = contact_at[static_cast<std::size_t>(i)];
    const dBodyID body = half_of(i);
    const Vec3 &h = at.heading, l = at.left;
    dVector3 axle, velocity;
    const double radius = radius_m(i);
    dBodyGetRelPointPos(body, bottom[0], bottom[1], bottom[2] + radius, axle);
    const Rest rest = relief->rest(axle[0], axle[1], h[0], h[1], radius, r.wheel_width_m);
    at.steep = std::sqrt(1 + rest.rise_ahead * rest.rise_ahead + rest.rise_left * rest.rise_left);
    const double run = std::sqrt(1 + rest.rise_ahead * rest.rise_ahead);
    for (std::size_t k = 0; k < 3; ++k) {
        const double z = k == 2 ? 1 : 0;
        at.up[k] = (z - rest.rise_ahead * h[k] - rest.rise_left * l[k]) / at.steep;
        at.ahead[k] = (h[k] + z * rest.rise_ahead) / run;
    }
    at.left = {at.up[1] * at.ahead[2] - at.up[2] * at.ahead[1], at.up[2] * at.ahead[0] - at.up[0] * at.ahead[2],
               at.up[0] * at.ahead[1] - at.up[1] * at.ahead[0]};
    for (std::size_t k = 0; k < 3; ++k) at.point[k] = axle[k] - radius * at.up[k], at.arm[k] = at.point[k] - now_of(i).at[k];
    dBodyGetPointVel(body, at.point[0], at.point[1], at.point[2], velocity);
    at.velocity = {velocity[0], velocity[1], velocity[2]};
    at.depth_m = rest.height_m - (axle[2] - radius);
    at.sink_m_s = -at.steep * dot(at.velocity, at.up);
    return at;
}

void Plant::World::step_wheel(int i) {
    const auto n = static_cast<std::size_t>(i);
    const RoverParameters &r = config.rover;
    const WheelEffects &mine = effects.wheel[n];
    const BodyEffects &b = effects.body;
    Applied &out = applied[n];
    const Stand &at = out.stand = stand(i);
    const double along = dot(at.velocity, at.ahead), across = dot(at.velocity, at.left);

    const double radius = law::wheel_radius_m(r.wheel_radius_m, mine.radius_change);
    const double rim = radius * drive[n].wheel_speed_rad_s; // of a motor's wheels all, as it left them
    const bool soft = config.ground.contact != ContactLaw::aggregated;
    const Footing foot = footing(at.point, at.heading, soft && !config.ground.patches.empty() ? 0.5 * radius : 0);
    const Soil &soil = *foot.front;
    const double factor = strength_slipping(grip_factor(i, at.point[0], at.point[1], rim - along), b,
                                            std::clamp(contact[n].slip, -1.0, 1.0), law::shear_stiffness(soil.shear_slip, b.shear_change));
    const ContactInput input{.law = soil.law,
                             .shear_slip = soil.shear_slip,
                             .relaxation_m = law::relaxation_length_m(r.relaxation_length_m, b.relaxation_m),
                             .rim_m_s = rim,
                             .along_m_s = along,
                             .across_m_s = across,
                             .load_kg = load_kg()};
    const Meeting met =
        soft && (foot.front->bekker || foot.behind->bekker)
            ? meet_soft(i, input, foot, factor, at)
            : meet_aggregated(i, input, soil, factor,
                              at.steep * std::max(0.0, r.contact_stiffness_N_m * at.depth_m + r.contact_damping_Ns_m * at.sink_m_s));
    const double load = met.load_N;
    const double slip_size = std::min(1.0, std::fabs(contact[n].slip));
    double rolling = met.rolling_N;
    each_resistance(mine, b, slip_size, along, [&](double per_load) { rolling += per_load * load; });
    if (b.heavy_resistance != 0) rolling += resistance_here(b, place_on_path(i)) * load;
    const double sideways = met.force.across_N - law::lateral_scrub_N(b.scrub, load) * soft_sign(across, 0.02);
    // what rolling alone pulls (arc law) is part of what it takes: both turn with the direction of rolling
    const double turned = rolling_step(contact[n], along, rolling - met.free_N, load_kg(), config.dt_s);
    const double pull = met.force.along_N + met.free_N * turned;
    const double ahead = pull - rolling * turned + met.edge_N;
    for (std::size_t k = 0; k < 3; ++k) out.force[k] = ahead * at.ahead[k] + sideways * at.left[k] + load * at.up[k];
    out.load_N = load;
    out.resist_N = rolling * turned;
    out.edge_N = met.edge_N;
    push_at(i, out.force, at.arm);

    out.torque_Nm = (met.arm_m > 0 ? met.arm_m : radius) * met.force.along_N + met.free_Nm * soft_sign(rim, reversal_m_s);

    WheelTruth &w = truth.slot(i);
    w.traction_N = pull;
    w.rolling_N = rolling;
    w.rolling_share = turned;
    w.lateral_N = sideways;
    w.normal_N = load;
    w.slip = std::clamp(contact[n].slip, -1.0, 1.0); // beyond: wheels that turn against the motion, full sliding all the same
    w.sinkage_m = met.sinkage_m;
    w.ground_speed_m_s = along;
}

// One drive train for all the wheels that the motor turns: it carries their torques together, and they share its speed.
void Plant::World::turn(int slot, double supply_V) {
    const auto n = static_cast<std::size_t>(slot);
    const RoverParameters &r = config.rover;
    const WheelEffects &mine = effects.wheel[n];
    bool held = false;
    double torque_Nm = 0;
    for (const int i : turned_by[n]) {
        held = held || blocked[static_cast<std::size_t>(i)];
        torque_Nm += applied[static_cast<std::size_t>(i)].torque_Nm;
    }
    DriveState &d = drive[n];
    const double speed_before = d.wheel_speed_rad_s;
    if (held) d.wheel_speed_rad_s = d.motor_speed_rad_s = 0;
    d.current_A = enabled && !open[n] ? drive_current(r.drive, mine, d, duty[n], supply_V, config.dt_s, current_of_others(slot)) : 0;
    if (!held) {
        const DriveWork work = drive_step(r.drive, mine, d, torque_Nm, config.dt_s);
        energy.motor += work.motor;
        energy.friction += work.friction;
    }
    for (const int i : turned_by[n]) {
        const auto j = static_cast<std::size_t>(i);
        if (i != slot) drive[j] = d, drive[j].current_A = 0;
        applied[j].spin_mean_rad_s = held ? 0 : 0.5 * (speed_before + d.wheel_speed_rad_s);
        // the wheel's own spin-up turns the chassis the other way about y
        const double radius = law::wheel_radius_m(r.wheel_radius_m, effects.wheel[j].radius_change);
        const double spin = 0.5 * r.wheel_mass_kg * radius * radius * (d.wheel_speed_rad_s - speed_before) / config.dt_s;
        if (law::load_transfer_m(r.centre_height_m, effects.body.raised_m) > 0) {
            const Steering::Wheel &turned = steering.wheel(i); // its axle, of the body
            BodyNow &on = now_of(i);
            for (std::size_t k = 0; k < 3; ++k) on.torque[k] += (turned.sine * on.turn[4 * k] - turned.cosine * on.turn[4 * k + 1]) * spin;
        }
    }
}

// A ball that rolls any way: the ground's resistance and its bearing's, against its velocity. No motor turns it, so where rolling takes a
// torque (arc law) the ground gives it by a drag of that torque over the radius (energy: derived here).
void Plant::World::step_caster(int i) {
    const auto n = static_cast<std::size_t>(i);
    const RoverParameters &r = config.rover;
    Applied &out = applied[n];
    const Stand &at = out.stand = stand(i);
    const double along = dot(at.velocity, at.ahead), across = dot(at.velocity, at.left), radius = radius_m(i);
    const bool soft = config.ground.contact != ContactLaw::aggregated;
    const Footing foot = footing(at.point, at.heading, soft && !config.ground.patches.empty() ? 0.5 * radius : 0);
    const Soil &soil = *foot.front;
    const ContactInput input{.law = soil.law,
                             .shear_slip = soil.shear_slip,
                             .relaxation_m = law::relaxation_length_m(r.relaxation_length_m, effects.body.relaxation_m),
                             .rim_m_s = along, // no slip, hence no traction
                             .along_m_s = along,
                             .load_kg = load_kg()};
    const Meeting met =
        soft && (foot.front->bekker || foot.behind->bekker)
            ? meet_soft(i, input, foot, 1, at)
            : meet_aggregated(i, input, soil, 1,
                              at.steep * std::max(0.0, r.contact_stiffness_N_m * at.depth_m + r.contact_damping_Ns_m * at.sink_m_s));
    const double speed = std::sqrt(along * along + across * across);
    double rolling = met.rolling_N - met.free_N + met.free_Nm / radius + r.layout.caster_rolling * met.load_N;
    each_resistance(effects.wheel[n], effects.body, 0.0, speed, [&](double per_load) { rolling += per_load * met.load_N; });
    rolling = std::max(rolling, 0.0);
    const RollingShare turned = drag_step(contact[n], along, across, rolling, load_kg(), config.dt_s);
    for (std::size_t k = 0; k < 3; ++k)
        out.force[k] = (met.edge_N - rolling * turned.along) * at.ahead[k] - rolling * turned.across * at.left[k] + met.load_N * at.up[k];
    out.load_N = met.load_N, out.edge_N = met.edge_N;
    push_at(i, out.force, at.arm);
    WheelTruth &w = truth.slot(i);
    w.rolling_N = rolling;
    w.rolling_share = turned.along;
    w.lateral_N = -rolling * turned.across;
    w.normal_N = met.load_N;
    w.sinkage_m = met.sinkage_m;
    w.ground_speed_m_s = along;
}

} // namespace traction::sim
