#include "plant.h"

#include "contact.h"
#include "plant_effects.h"
#include "rut.h"

#include "sim/physics/effects/laws.h"
#include "sim/physics/math.h"
#include "sim/physics/terramechanics.h"

#include <ode/ode.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>
#include <stdexcept>

namespace traction::sim {

namespace {

using Vec3 = std::array<double, 3>;

double dot(const Vec3 &a, const Vec3 &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void start_ode() {
    static std::once_flag once;
    std::call_once(once, [] {
        dInitODE2(0);
        // Debian's armel ODE is single precision: a plant on it would silently differ
        if (dCheckConfiguration("ODE_double_precision") == 0)
            throw std::runtime_error("this ODE library is not the double-precision build; install libode-dev for amd64");
    });
    thread_local const bool ready = dAllocateODEDataForThread(dAllocateMaskAll) != 0;
    if (!ready) throw std::runtime_error("ODE could not allocate its data for this thread");
}

Vec3 gravity_vector(const Ground &ground, const BodyEffects &effects, double g) {
    const double a = g * math::sin(ground.slope_rad), b = g * math::sin(effects.slope_rad);
    const double x = a * math::cos(ground.slope_direction_rad) + b * math::cos(effects.slope_direction_rad);
    const double y = a * math::sin(ground.slope_direction_rad) + b * math::sin(effects.slope_direction_rad);
    return {-x, -y, -std::sqrt(std::max(g * g - x * x - y * y, 0.0))};
}

// -1..1, the sign of a speed made continuous over `width`.
constexpr double reversal_m_s = 0.005; // resistances reverse over this speed: assumed, below any sensor's resolution

double soft_sign(double speed, double width) { return std::clamp(speed / width, -1.0, 1.0); }

constexpr double half_offset_share = 0.25; // a half's centre lies a quarter of the width beside the middle
constexpr bool is_left(int wheel) { return wheel == 0 || wheel == 2; }
constexpr bool is_front(int wheel) { return wheel >= 2; }

} // namespace

struct Plant::World {
    explicit World(const PlantConfig &c);
    ~World();
    void build_bodies();
    void step();
    void step_wheel(int i, double supply_V);
    double grip_factor(int i, double x_m, double y_m, double sliding_m_s) const; // of Fm: place, track, sliding
    struct Meeting {
        ContactForce force;
        double load_N = 0, rolling_N = 0, sinkage_m = 0;
        double arm_m = 0;             // of force.along_N about the axle; 0: the radius
        double free_N = 0, free_Nm = 0; // pull and torque of rolling alone, in its direction
    };
    Meeting meet_aggregated(int i, ContactInput in, const Soil &soil, double factor, double load_N);
    Meeting meet_soft(int i, ContactInput in, const Soil &soil, double factor, const double *point, double sink_m_s);
    const SoilConstants &constants_of(const Soil &soil) const;
    void push_body();
    void observe(const Vec3 &velocity_before);
    Vec3 mean_velocity() const;
    Vec3 axis(int column) const; // mean of the halves, unit, world
    void contact_velocity(int i, Vec3 &out) const;
    double kinetic() const;
    double potential() const;
    bool trails(int wheel) const { return is_front(wheel) != (direction > 0); }
    dBodyID half_of(int wheel) const { return half[is_left(wheel) ? 0 : 1]; }

    PlantConfig config;
    PlantEffects effects;
    Vec3 gravity{};
    dWorldID world = nullptr;
    std::array<dBodyID, 2> half{};
    std::array<Vec3, wheel_count> contact_at{}; // contact point in its half's frame
    std::array<DriveState, wheel_count> drive{};
    std::array<ContactState, wheel_count> contact{};
    std::array<double, wheel_count> duty{};
    std::array<bool, wheel_count> blocked{};
    std::vector<SoilConstants> constants; // of the base soil and of each patch, soft contact only
    RutMemory ruts;
    std::array<RutTrace, wheel_count> trace;
    struct Applied {
        Vec3 force{}, velocity{}; // at the contact point, world
        double resist_N = 0, torque_Nm = 0, spin_mean_rad_s = 0; // resist: rolling resistance, signed
        Vec3 heading{};
    };
    std::array<Applied, wheel_count> applied{};
    Vec3 push{}, push_velocity{}; // drag and tether, whole rover
    bool enabled = true;
    double direction = 1;
    Vec3 heading_before{};
    double potential_0 = 0;
    double used_C = 0; // charge taken from the battery
    std::uint64_t steps = 0;
    Truth truth;
    Energy energy;
};

Plant::World::World(const PlantConfig &c) : config(c), effects(collect_effects(c.effects)) {
    start_ode();
    gravity = gravity_vector(config.ground, effects.body, config.rover.gravity_m_s2);
    world = dWorldCreate();
    dWorldSetGravity(world, gravity[0], gravity[1], gravity[2]);
    dWorldSetAutoDisableFlag(world, 0);
    if (config.ground.contact != ContactLaw::aggregated) {
        const auto prepare = [this](const Soil &soil) {
            constants.push_back(soil.bekker ? soil_constants(*soil.bekker, config.rover.wheel_width_m) : SoilConstants{});
        };
        prepare(config.ground.soil);
        for (const SoilPatch &patch : config.ground.patches) prepare(patch.soil);
    }
    build_bodies();
    for (int i = 0; i < wheel_count; ++i) {
        const auto n = static_cast<std::size_t>(i);
        const double radius = config.rover.wheel_radius_m * (1 + effects.wheel[n].radius_change);
        drive[n].wheel_speed_rad_s = drive[n].motor_speed_rad_s = config.speed_m_s / radius;
    }
    truth.battery_voltage_V = config.rover.battery_voltage_V;
    truth.yaw_rad = config.yaw_rad;
    heading_before = axis(0);
    potential_0 = potential();
    observe(mean_velocity());
    energy = {};
    energy.kinetic = kinetic();
}

Plant::World::~World() {
    if (world != nullptr) dWorldDestroy(world);
}

void Plant::World::build_bodies() {
    const RoverParameters &r = config.rover;
    const double height = r.centre_height_m + effects.body.centre_height_m;
    const double load = r.mass_kg * std::fabs(gravity[2]) / 4;
    double sunk = load / r.contact_stiffness_N_m;
    if (config.ground.contact != ContactLaw::aggregated && config.ground.soil.bekker)
        sunk = sinkage_under(config.ground.contact == ContactLaw::arc ? arc_force : bekker_force, *config.ground.soil.bekker,
                             {r.wheel_radius_m, r.wheel_width_m, r.tyre_hysteresis}, load, 0);
    const double cos_yaw = math::cos(config.yaw_rad), sin_yaw = math::sin(config.yaw_rad);
    dMatrix3 turn;
    dRSetIdentity(turn);
    turn[0] = cos_yaw, turn[1] = -sin_yaw, turn[4] = sin_yaw, turn[5] = cos_yaw;
    for (int h = 0; h < 2; ++h) {
        const double side = h == 0 ? 1 : -1, aside = side * half_offset_share * r.width_m;
        const dBodyID body = half[static_cast<std::size_t>(h)] = dBodyCreate(world);
        dMass mass;
        dMassSetBoxTotal(&mass, r.mass_kg / 2, r.length_m, r.width_m / 2, r.height_m);
        dBodySetMass(body, &mass);
        dBodySetRotation(body, turn);
        dBodySetPosition(body, config.x_m - sin_yaw * aside, config.y_m + cos_yaw * aside, height - sunk);
        dBodySetLinearVel(body, config.speed_m_s * cos_yaw, config.speed_m_s * sin_yaw, 0);
        for (int i = 0; i < wheel_count; ++i)
            if (is_left(i) == (h == 0))
                contact_at[static_cast<std::size_t>(i)] = {
                    (is_front(i) ? r.half_wheelbase_m : -r.half_wheelbase_m) - effects.body.offset_x_m,
                    side * r.half_track_m - aside - effects.body.offset_y_m, -height};
    }
    const dJointID joint = dJointCreateHinge(world, nullptr);
    dJointAttach(joint, half[0], half[1]);
    dJointSetHingeAnchor(joint, config.x_m, config.y_m, height - sunk);
    dJointSetHingeAxis(joint, -sin_yaw, cos_yaw, 0);
}

Vec3 Plant::World::axis(int column) const {
    Vec3 sum{};
    for (const dBodyID body : half) {
        const dReal *rotation = dBodyGetRotation(body);
        for (std::size_t k = 0; k < 3; ++k) sum[k] += rotation[4 * k + static_cast<std::size_t>(column)];
    }
    const double size = std::sqrt(dot(sum, sum));
    for (double &part : sum) part /= size;
    return sum;
}

Vec3 Plant::World::mean_velocity() const {
    const dReal *a = dBodyGetLinearVel(half[0]), *b = dBodyGetLinearVel(half[1]);
    return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
}

void Plant::World::contact_velocity(int i, Vec3 &out) const {
    const Vec3 &at = contact_at[static_cast<std::size_t>(i)];
    dVector3 velocity;
    dBodyGetRelPointVel(half_of(i), at[0], at[1], at[2], velocity);
    out = {velocity[0], velocity[1], velocity[2]};
}

double Plant::World::kinetic() const {
    double sum = 0;
    for (const dBodyID body : half) {
        dMass mass;
        dBodyGetMass(body, &mass);
        const dReal *v = dBodyGetLinearVel(body);
        dVector3 w;
        dBodyVectorFromWorld(body, dBodyGetAngularVel(body)[0], dBodyGetAngularVel(body)[1], dBodyGetAngularVel(body)[2], w);
        sum += 0.5 * mass.mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        sum += 0.5 * (mass.I[0] * w[0] * w[0] + mass.I[5] * w[1] * w[1] + mass.I[10] * w[2] * w[2]);
    }
    for (std::size_t i = 0; i < wheel_count; ++i) {
        const DriveParameters &p = config.rover.drive;
        const bool two_masses = effects.wheel[i].drive.play_rad > 0;
        const double wheel = two_masses ? p.wheel_inertia_kg_m2 : p.inertia_kg_m2;
        sum += 0.5 * wheel * drive[i].wheel_speed_rad_s * drive[i].wheel_speed_rad_s;
        if (two_masses)
            sum += 0.5 * (p.inertia_kg_m2 - wheel) * drive[i].motor_speed_rad_s * drive[i].motor_speed_rad_s;
    }
    return sum;
}

double Plant::World::potential() const {
    double sum = 0;
    for (const dBodyID body : half) {
        const dReal *at = dBodyGetPosition(body);
        sum -= 0.5 * config.rover.mass_kg * dot(gravity, {at[0], at[1], at[2]});
    }
    return sum;
}

double Plant::World::grip_factor(int i, double x_m, double y_m, double sliding_m_s) const {
    const BodyEffects &b = effects.body;
    double factor = 1 + config.ground.grip_change(x_m, y_m);
    factor *= law::soil_patch(b.patch_change, b.patch_start_m, b.patch_length_m,
                              truth.path_m + (is_front(i) ? config.rover.half_wheelbase_m : -config.rover.half_wheelbase_m));
    factor *= law::soil_gradient(b.gradient_1_m, truth.path_m);
    factor *= law::multi_pass(b.multi_pass, trails(i) ? 1 : 0);
    if (b.sliding_loss_s_m != 0) factor *= law::sliding_speed_loss(b.sliding_loss_s_m, sliding_m_s);
    return factor;
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
    out.rolling_N = law::rolling_resistance_N(soil.rolling_coefficient, load_N);
    return out;
}

Plant::World::Meeting Plant::World::meet_soft(int i, ContactInput in, const Soil &soil, double factor, const double *point,
                                              double sink_m_s) {
    const auto n = static_cast<std::size_t>(i);
    const RoverParameters &r = config.rover;
    Meeting out;
    out.sinkage_m = std::max(0.0, -point[2]);
    const double rut = trace[n].follow(ruts, point[0], point[1], out.sinkage_m, config.dt_s * in.along_m_s);
    const SlipChange change = slip_step(in, contact[n], config.dt_s);
    const double total = total_slip(contact[n]);
    const SoilWheel wheel{r.wheel_radius_m, r.wheel_width_m, r.tyre_hysteresis, factor, 1 + effects.body.shear_change};
    const auto law = config.ground.contact == ContactLaw::arc ? arc_force : bekker_force;
    // the law counts slip along the motion: a wheel that rolls backwards sees the mirrored one; near rest, the mean of both
    const double slip = std::copysign(std::min(total, 1.0), in.along_m_s < 0 ? -contact[n].slip : contact[n].slip);
    SoilForce soft = law(*soil.bekker, constants_of(soil), wheel, {out.sinkage_m, slip, rut});
    double by_slip = std::fabs(soft.traction_N - soft.free_traction_N), twist = std::fabs(soft.torque_Nm - soft.free_torque_Nm);
    const double still = 0.5 * (1 - std::fabs(in.along_m_s) / reversal_m_s);
    if (still > 0 && config.ground.contact == ContactLaw::arc) {
        const SoilForce other = law(*soil.bekker, constants_of(soil), wheel, {out.sinkage_m, -slip, rut});
        by_slip += still * (std::fabs(other.traction_N - other.free_traction_N) - by_slip);
        twist += still * (std::fabs(other.torque_Nm - other.free_torque_Nm) - twist);
        soft.normal_N += still * (other.normal_N - soft.normal_N);
        soft.resistance_N += still * (other.resistance_N - soft.resistance_N);
    }
    const double belly = std::max(0.0, out.sinkage_m - 0.9 * r.wheel_radius_m) * r.contact_stiffness_N_m; // the body sits down
    out.load_N = std::max(0.0, soft.normal_N + belly - (soft.normal_N > 0 ? r.contact_damping_Ns_m * sink_m_s : 0));
    if (out.load_N <= 0) return out;
    in.grip_N = soft.largest_N;
    in.shear_slip = soft.shear_slip;
    in.law = TractionLaw::janosi;
    // the part due to slip goes with the slip; what rolling alone does goes with the direction of rolling
    out.force = contact_force(in, contact[n], change, by_slip, config.dt_s);
    out.free_N = soft.free_traction_N;
    out.free_Nm = soft.free_torque_Nm;
    out.arm_m = by_slip > 1e-6 ? twist / by_slip : 0;
    out.rolling_N = soft.resistance_N;
    return out;
}

void Plant::World::step_wheel(int i, double supply_V) {
    const auto n = static_cast<std::size_t>(i);
    const RoverParameters &r = config.rover;
    const WheelEffects &mine = effects.wheel[n];
    const BodyEffects &b = effects.body;
    Applied &out = applied[n];
    const Vec3 &at = contact_at[n];
    const dBodyID body = half_of(i);

    dVector3 point;
    dBodyGetRelPointPos(body, at[0], at[1], at[2], point);
    contact_velocity(i, out.velocity);
    const dReal *rotation = dBodyGetRotation(body);
    const double flat = std::sqrt(rotation[0] * rotation[0] + rotation[4] * rotation[4]);
    out.heading = {rotation[0] / flat, rotation[4] / flat, 0};
    const Vec3 left{-out.heading[1], out.heading[0], 0};
    const double along = dot(out.velocity, out.heading), across = dot(out.velocity, left);

    const double radius = law::wheel_radius_m(r.wheel_radius_m, mine.radius_change);
    const double rim = radius * drive[n].wheel_speed_rad_s;
    const Soil &soil = config.ground.at(point[0], point[1]);
    const double factor = grip_factor(i, point[0], point[1], rim - along);
    const ContactInput input{.law = soil.law, .shear_slip = soil.shear_slip,
                             .relaxation_m = law::relaxation_length_m(r.relaxation_length_m, b.relaxation_m), .rim_m_s = rim,
                             .along_m_s = along, .across_m_s = across, .load_kg = r.mass_kg / 4};
    const bool soft = config.ground.contact != ContactLaw::aggregated && soil.bekker.has_value();
    const Meeting met =
        soft ? meet_soft(i, input, soil, factor, point, out.velocity[2])
             : meet_aggregated(i, input, soil, factor,
                               std::max(0.0, -r.contact_stiffness_N_m * point[2] - r.contact_damping_Ns_m * out.velocity[2]));
    const double load = met.load_N;
    const double slip_size = std::min(1.0, std::fabs(contact[n].slip));
    const double rolling = met.rolling_N + law::rolling_resistance_N(mine.rolling, load) +
                           law::slip_sinkage_N(b.slip_sinkage, slip_size, load) +
                           law::speed_resistance_N(b.speed_resistance_s_m, along, load);
    const double sideways = met.force.across_N - law::lateral_scrub_N(b.scrub, load) * soft_sign(across, 0.02);
    // reversing resistance: never more than would stop a quarter of the rover within the step
    const double width = std::max(reversal_m_s, 4 * (rolling + met.free_N) * config.dt_s / r.mass_kg);
    const double pull = met.force.along_N + met.free_N * soft_sign(along, width);
    const double ahead = pull - rolling * soft_sign(along, width);
    for (std::size_t k = 0; k < 3; ++k) out.force[k] = ahead * out.heading[k] + sideways * left[k];
    out.force[2] = load;
    out.resist_N = pull - ahead;
    dBodyAddForceAtRelPos(body, out.force[0], out.force[1], out.force[2], at[0], at[1], at[2]);

    DriveState &d = drive[n];
    const double speed_before = d.wheel_speed_rad_s;
    if (blocked[n]) d.wheel_speed_rad_s = d.motor_speed_rad_s = 0;
    d.current_A = enabled ? drive_current(r.drive, mine.drive, d, duty[n], supply_V, config.dt_s) : 0;
    if (!blocked[n]) {
        out.torque_Nm = (met.arm_m > 0 ? met.arm_m : radius) * met.force.along_N + met.free_Nm * soft_sign(rim, reversal_m_s);
        const DriveWork work = drive_step(r.drive, mine.drive, d, out.torque_Nm, config.dt_s);
        energy.motor += work.motor;
        energy.friction += work.friction;
    }
    out.spin_mean_rad_s = blocked[n] ? 0 : 0.5 * (speed_before + d.wheel_speed_rad_s);
    // the wheel's own spin-up turns the chassis the other way about y
    const double spin = 0.5 * r.wheel_mass_kg * radius * radius * (d.wheel_speed_rad_s - speed_before) / config.dt_s;
    if (r.centre_height_m + b.centre_height_m > 0) dBodyAddRelTorque(body, 0, -spin, 0);

    WheelTruth &w = truth.wheel[n];
    w.traction_N = pull;
    w.rolling_N = rolling;
    w.lateral_N = sideways;
    w.normal_N = load;
    w.slip = contact[n].slip;
    w.sinkage_m = met.sinkage_m;
    w.ground_speed_m_s = along;
}

void Plant::World::push_body() {
    const BodyEffects &b = effects.body;
    const Vec3 ahead = axis(0);
    push_velocity = mean_velocity();
    push = {};
    const double drag = b.drag_N * soft_sign(dot(push_velocity, ahead), 0.005);
    for (std::size_t k = 0; k < 2; ++k) push[k] = -drag * ahead[k];
    push[0] -= b.tether_N_m * (truth.position_m[0] - config.x_m);
    push[1] -= b.tether_N_m * (truth.position_m[1] - config.y_m);
    for (const dBodyID body : half) dBodyAddForce(body, 0.5 * push[0], 0.5 * push[1], 0);
}

void Plant::World::step() {
    const double dt = config.dt_s;
    double supply_A = 0;
    for (std::size_t i = 0; i < wheel_count; ++i) supply_A += duty[i] * drive[i].current_A;
    used_C += supply_A * dt;
    const double supply_V = config.rover.battery_voltage_V - config.rover.battery_fade_V_C * used_C - config.rover.battery_resistance_ohm * supply_A;
    truth.battery_voltage_V = supply_V;

    const Vec3 before = mean_velocity();
    for (int i = 0; i < wheel_count; ++i) step_wheel(i, supply_V);
    push_body();
    dWorldStep(world, dt);
    ++steps;

    for (int i = 0; i < wheel_count; ++i) {
        Applied &a = applied[static_cast<std::size_t>(i)];
        Vec3 after{};
        contact_velocity(i, after);
        for (std::size_t k = 0; k < 3; ++k) after[k] = 0.5 * (after[k] + a.velocity[k]);
        const double along = dot(after, a.heading);
        const double to_body = dot(a.force, after);
        const double vertical = a.force[2] * after[2];
        const double rolling = a.resist_N * along;
        energy.rolling += rolling * dt;
        energy.slip += (a.torque_Nm * a.spin_mean_rad_s - (to_body - vertical + rolling)) * dt;
        energy.body -= vertical * dt;
    }
    const Vec3 velocity = mean_velocity();
    energy.body -= 0.5 * (dot(push, velocity) + dot(push, push_velocity)) * dt;
    energy.kinetic = kinetic();
    energy.potential = potential() - potential_0;
    observe(before);
}

void Plant::World::observe(const Vec3 &velocity_before) {
    const double dt = config.dt_s;
    truth.t_s = static_cast<double>(steps) * dt;
    const dReal *a = dBodyGetPosition(half[0]), *b = dBodyGetPosition(half[1]);
    truth.position_m = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
    const dReal *q = dBodyGetQuaternion(half[0]);
    truth.orientation = {q[0], q[1], q[2], q[3]};
    const Vec3 ex = axis(0), ey = axis(1), ez = axis(2), v = mean_velocity();
    truth.v_body_m_s = {dot(v, ex), dot(v, ey), dot(v, ez)};
    const dReal *rate = dBodyGetAngularVel(half[0]);
    const Vec3 rate_world{rate[0], rate[1], rate[2]};
    truth.rate_body_rad_s = {dot(rate_world, ex), dot(rate_world, ey), dot(rate_world, ez)};
    Vec3 felt{};
    if (steps > 0)
        for (std::size_t k = 0; k < 3; ++k) felt[k] = (v[k] - velocity_before[k]) / dt - gravity[k];
    truth.specific_force_m_s2 = {dot(felt, ex), dot(felt, ey), dot(felt, ez)};
    // heading by its change, so that it never wraps
    const double cross = heading_before[0] * ex[1] - heading_before[1] * ex[0];
    const double along = heading_before[0] * ex[0] + heading_before[1] * ex[1];
    truth.yaw_rad += math::atan2(cross, along);
    heading_before = ex;
    truth.pitch_rad = -math::asin(ex[2]);
    truth.path_m += truth.v_body_m_s[0] * (steps > 0 ? dt : 0);
    if (std::fabs(truth.v_body_m_s[0]) > 1e-3) direction = truth.v_body_m_s[0] > 0 ? 1 : -1;
    for (std::size_t i = 0; i < wheel_count; ++i) {
        WheelTruth &w = truth.wheel[i];
        w.angle_rad = drive[i].wheel_angle_rad;
        w.speed_rad_s = drive[i].wheel_speed_rad_s;
        w.motor_angle_rad = drive[i].motor_angle_rad;
        w.motor_speed_rad_s = drive[i].motor_speed_rad_s;
        w.current_A = drive[i].current_A;
        w.duty = enabled ? duty[i] : 0;
        w.winding_temperature_C = 25 + drive[i].heat_K; // ambient 25 C, assumed
    }
}

Plant::Plant(const PlantConfig &config) : world_(std::make_unique<World>(config)) {}
Plant::~Plant() = default;

void Plant::set_duty(int wheel, double duty) {
    world_->duty.at(static_cast<std::size_t>(wheel)) = std::isnan(duty) ? 0 : std::clamp(duty, -1.0, 1.0);
}

void Plant::set_enabled(bool enabled) { world_->enabled = enabled; }

void Plant::block_wheel(int wheel, bool blocked) { world_->blocked.at(static_cast<std::size_t>(wheel)) = blocked; }

void Plant::step() { world_->step(); }

const Truth &Plant::truth() const { return world_->truth; }

const Energy &Plant::energy() const { return world_->energy; }

std::uint64_t Plant::state_hash() const {
    std::uint64_t hash = 1469598103934665603ull; // FNV-1a
    const auto mix = [&hash](double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        for (unsigned byte = 0; byte < 8; ++byte) hash = (hash ^ ((bits >> (8 * byte)) & 0xff)) * 1099511628211ull;
    };
    for (const dBodyID body : world_->half)
        for (std::size_t k = 0; k < 4; ++k) {
            mix(dBodyGetQuaternion(body)[k]);
            if (k < 3) mix(dBodyGetPosition(body)[k]), mix(dBodyGetLinearVel(body)[k]), mix(dBodyGetAngularVel(body)[k]);
        }
    for (std::size_t i = 0; i < wheel_count; ++i) {
        const DriveState &d = world_->drive[i];
        for (const double value : {d.motor_angle_rad, d.motor_speed_rad_s, d.wheel_angle_rad, d.wheel_speed_rad_s, d.current_A,
                                   d.heat_K, world_->contact[i].slip, world_->contact[i].side_slip})
            mix(value);
    }
    for (const RutTrace &trace : world_->trace) mix(trace.found_m()), mix(trace.deepest_m());
    mix(world_->truth.path_m), mix(world_->truth.yaw_rad), mix(world_->used_C);
    return hash ^ world_->ruts.hash();
}

} // namespace traction::sim
