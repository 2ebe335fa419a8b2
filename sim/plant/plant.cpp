#include "world.h"

#include "sim/physics/math.h"
#include "sim/physics/terramechanics.h"

#include <array>
#include <ode/ode.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>
#include <stdexcept>

namespace traction::sim {

namespace {

void start_ode() {
    static std::once_flag once;
    std::call_once(once, [] {
        dInitODE2(0);
        // Debian's armel ODE is single precision: a plant on it would silently differ
        if (dCheckConfiguration("ODE_double_precision") == 0)
            throw std::runtime_error("this ODE library is not the double-precision build; install libode-dev for amd64");
    });
    thread_local const bool ready = dAllocateODEDataForThread(static_cast<unsigned>(dAllocateMaskAll)) != 0;
    if (!ready) throw std::runtime_error("ODE could not allocate its data for this thread");
}

// A slope of its own kind each, in world axes: the body that heads along x is turned by -direction from the rise.
Vec3 gravity_vector(const Ground &ground, const BodyEffects &effects, double g, double path_m) {
    const law::Slope known = law::grade_m_s2(g, ground.slope_here_rad(path_m), -ground.slope_direction_rad),
                     unnoticed = law::grade_m_s2(g, effects.slope_rad, -effects.slope_direction_rad);
    const double x = known.along_m_s2 + unnoticed.along_m_s2, y = known.across_m_s2 + unnoticed.across_m_s2;
    return {x, y, -std::sqrt(std::max(g * g - x * x - y * y, 0.0))};
}

} // namespace

Plant::World::World(const PlantConfig &c)
    : config(c), wheels(wheels_of(c.rover.layout.kind)), effects(act_together(c.effects)), ruts(c.rover.wheel_width_m),
      steering(c.rover.layout, c.rover.half_wheelbase_m, c.rover.half_track_m) {
    start_ode();
    contact_kg = config.rover.mass_kg / static_cast<double>(wheels.size());
    know_wheels();
    gravity = gravity_vector(config.ground, effects.body, config.rover.gravity_m_s2, 0);
    rise_rad = config.ground.slope_here_rad(0);
    world = dWorldCreate();
    calls.serve(world);
    dWorldSetGravity(world, gravity[0], gravity[1], gravity[2]);
    dWorldSetAutoDisableFlag(world, 0);
    if (config.ground.contact != ContactLaw::aggregated) {
        const auto prepare = [this](const Soil &soil) {
            constants.push_back(soil.bekker ? soil_constants(*soil.bekker, config.rover.wheel_width_m) : SoilConstants{});
        };
        prepare(config.ground.soil);
        for (const SoilPatch &patch : config.ground.patches) prepare(patch.soil);
    }
    if (!config.ground.terrain.flat()) relief.emplace(config.ground.terrain, config.ground.seed);
    build_bodies();
    if (relief && !config.rover.layout.rocker) place_on_terrain();
    know_bodies();
    take_hinge();
    know_abreast();
    for (const int i : wheels) {
        if (caster(i)) continue; // a ball has no spin of its own here
        const auto n = static_cast<std::size_t>(i);
        const auto m = static_cast<std::size_t>(motor_of(i));
        const double radius = law::wheel_radius_m(config.rover.wheel_radius_m, effects.wheel[m].radius_change);
        drive[n].wheel_speed_rad_s = drive[n].motor_speed_rad_s = config.speed_m_s / radius;
    }
    truth.battery_voltage_V = config.rover.battery_voltage_V;
    truth.yaw_rad = config.yaw_rad;
    heading_before = axes().x;
    potential_0 = potential();
    observe(mean_velocity());
    energy = {};
    energy.kinetic = kinetic();
}

void Plant::World::know_wheels() {
    for (const int i : wheels) {
        const auto n = static_cast<std::size_t>(i);
        place_ahead_m[n] = place(i).ahead_m;
        is_ball[n] = is_caster(config.rover.layout.kind, i);
        motor[n] = sim::motor_of(config.rover.layout, i);
        if (!is_ball[n]) turned_by[static_cast<std::size_t>(motor[n])].push_back(i);
    }
}

void Plant::World::know_bodies() {
    for (const dBodyID body : bodies)
        now.push_back({.body = body,
                       .turn = dBodyGetRotation(body),
                       .at = dBodyGetPosition(body),
                       .velocity = dBodyGetLinearVel(body),
                       .spin = dBodyGetAngularVel(body)});
    const auto place_of = [this](dBodyID body) {
        return static_cast<std::size_t>(std::find(bodies.begin(), bodies.end(), body) - bodies.begin());
    };
    for (std::size_t n = 0; n < 2; ++n) half_at[n] = place_of(half[n]);
    for (const int i : wheels) carrier_at[static_cast<std::size_t>(i)] = place_of(carrier[static_cast<std::size_t>(i)]);
}

Plant::World::~World() {
    if (world != nullptr) dWorldDestroy(world);
}

// Rows of four, as ODE's: three columns and one that means nothing, side by side.
Plant::World::Axes Plant::World::axes() const {
    const double *a = now[half_at[0]].turn, *b = now[half_at[1]].turn;
    double sum[3][4], size[4];
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t c = 0; c < 4; ++c) sum[k][c] = 0.0 + a[4 * k + c] + b[4 * k + c];
    for (std::size_t c = 0; c < 4; ++c) size[c] = std::sqrt(sum[0][c] * sum[0][c] + sum[1][c] * sum[1][c] + sum[2][c] * sum[2][c]);
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t c = 0; c < 4; ++c) sum[k][c] /= size[c];
    return {{sum[0][0], sum[1][0], sum[2][0]}, {sum[0][1], sum[1][1], sum[2][1]}, {sum[0][2], sum[1][2], sum[2][2]}};
}

Vec3 Plant::World::mean_velocity() const {
    const double *a = now[half_at[0]].velocity, *b = now[half_at[1]].velocity;
    return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
}

void Plant::World::contact_velocity(int i, Vec3 &out) const {
    const Vec3 &at = contact_at[static_cast<std::size_t>(i)], &point = applied[static_cast<std::size_t>(i)].stand.point;
    dVector3 velocity;
    if (relief)
        dBodyGetPointVel(half_of(i), point[0], point[1], point[2], velocity);
    else
        dBodyGetRelPointVel(half_of(i), at[0], at[1], at[2], velocity);
    out = {velocity[0], velocity[1], velocity[2]};
}

// Where the halves hang on their hinge and on nothing else, ODE steps them as free bodies and hinge.h says what the joint does to them. A
// joint that asks for nothing keeps them one island, which is less work than two.
void Plant::World::take_hinge() {
    if (half[0] == half[1]) return; // on rockers
    const bool alone = dBodyGetNumJoints(half[0]) == 1 && dBodyGetNumJoints(half[1]) == 1 && dJointGetType(joint) == dJointTypeHinge;
    if (!alone || dJointGetHingeParam(joint, dParamLoStop) > -dInfinity || dJointGetHingeParam(joint, dParamHiStop) < dInfinity) return;
    dVector3 anchor, axis_now;
    dJointGetHingeAnchor(joint, anchor);
    dJointGetHingeAxis(joint, axis_now);
    Hinge &taken = hinge.emplace();
    taken.erp = dWorldGetERP(world), taken.cfm = dWorldGetCFM(world);
    for (std::size_t n = 0; n < 2; ++n) {
        dMass mass;
        dBodyGetMass(half[n], &mass);
        dVector3 place, along, lies, stands;
        dBodyGetPosRelPoint(half[n], anchor[0], anchor[1], anchor[2], place);
        dBodyVectorFromWorld(half[n], axis_now[0], axis_now[1], axis_now[2], along);
        dPlaneSpace(along, lies, stands);
        const auto vector_of = [](const dReal *v) { return Vec3{v[0], v[1], v[2]}; };
        taken.body[n] = {.mass_kg = mass.mass,
                         .inertia_kg_m2 = {mass.I[0], mass.I[5], mass.I[10]}, // a box's: diagonal
                         .anchor_m = vector_of(place),
                         .axis = vector_of(along),
                         .normal_1 = vector_of(lies),
                         .normal_2 = vector_of(stands)};
        dBodySetGyroscopicMode(half[n], 0);
    }
    dJointDestroy(joint); // one that is only disabled is looked at in every step
    joint = nullptr;
    dJointAttach(dJointCreateNull(world, nullptr), half[0], half[1]);
}

void Plant::World::hold_halves() {
    std::array<HingeMotion, 2> moving{};
    for (std::size_t n = 0; n < 2; ++n) {
        const BodyNow &one = now[half_at[n]];
        moving[n] = {one.turn, one.at, one.velocity, one.spin, {}, one.torque};
        for (std::size_t k = 0; k < 3; ++k) moving[n].force_N[k] = one.force[k] + hinge->body[n].mass_kg * gravity[k]; // ODE adds it itself
    }
    const auto loads = hinge->loads(moving, config.dt_s);
    for (std::size_t n = 0; n < 2; ++n)
        for (std::size_t k = 0; k < 3; ++k)
            now[half_at[n]].force[k] += loads[n].force_N[k], now[half_at[n]].torque[k] += loads[n].torque_Nm[k];
}

double Plant::World::kinetic() const {
    double sum = 0;
    for (const dBodyID body : bodies) {
        dMass mass;
        dBodyGetMass(body, &mass);
        const dReal *v = dBodyGetLinearVel(body);
        dVector3 w;
        dBodyVectorFromWorld(body, dBodyGetAngularVel(body)[0], dBodyGetAngularVel(body)[1], dBodyGetAngularVel(body)[2], w);
        sum += 0.5 * mass.mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        sum += 0.5 * (mass.I[0] * w[0] * w[0] + mass.I[5] * w[1] * w[1] + mass.I[10] * w[2] * w[2]);
    }
    for (const int slot : wheels) {
        if (motor_of(slot) != slot) continue; // in its motor's inertia
        const auto i = static_cast<std::size_t>(slot);
        const DriveParameters &p = config.rover.drive;
        const bool two_masses = effects.wheel[i].play_rad > 0;
        const double wheel = two_masses ? p.wheel_inertia_kg_m2 : p.inertia_kg_m2;
        sum += 0.5 * wheel * drive[i].wheel_speed_rad_s * drive[i].wheel_speed_rad_s;
        if (two_masses) sum += 0.5 * (p.inertia_kg_m2 - wheel) * drive[i].motor_speed_rad_s * drive[i].motor_speed_rad_s;
    }
    return sum;
}

double Plant::World::potential() const {
    double sum = 0;
    for (const dBodyID body : bodies) {
        const dReal *at = dBodyGetPosition(body);
        dMass mass;
        dBodyGetMass(body, &mass);
        sum -= mass.mass * dot(gravity, {at[0], at[1], at[2]});
    }
    return sum;
}

void Plant::World::push_body() {
    const BodyEffects &b = effects.body;
    push_velocity = mean_velocity();
    if (b.drag_N == 0 && b.drag_Ns2_m2 == 0 && b.tether_N_m == 0 && config.rover.layout.drawbar_N == 0) return;
    const Vec3 &ahead = heading_before; // as the last step left it
    push = {};
    const double along = dot(push_velocity, ahead), drag = dragged_N(b, along, soft_sign(along, 0.005));
    for (std::size_t k = 0; k < 2; ++k) push[k] = drag * ahead[k];
    push[0] += law::tether_drag_N(b.tether_N_m, truth.position_m[0] - config.x_m);
    push[1] += law::tether_drag_N(b.tether_N_m, truth.position_m[1] - config.y_m);
    if (config.rover.layout.drawbar_N != 0)
        for (std::size_t k = 0; k < 2; ++k) push[k] -= config.rover.layout.drawbar_N * ahead[k];
    for (const std::size_t at : half_at)
        for (std::size_t k = 0; k < 3; ++k) now[at].force[k] += 0.5 * push[k];
}

void Plant::World::step() {
    const double dt = config.dt_s;
    double supply_A = 0;
    for (const int slot : wheels) {
        const auto i = static_cast<std::size_t>(slot);
        supply_A += duty[i] * (abreast.ahead ? abreast.wheels.current_A[i] : drive[i].current_A);
    }
    used_C += supply_A * dt;
    const double supply_V =
        config.rover.battery_voltage_V - sag_V - config.rover.battery_fade_V_C * used_C - config.rover.battery_resistance_ohm * supply_A;
    truth.battery_voltage_V = supply_V;

    if (!config.ground.slope_steps.empty()) { // the plane stays, gravity leans: what a rover on it feels
        const double before_rad = rise_rad;
        rise_rad = config.ground.slope_here_rad(truth.path_m);
        truth.rise_rate_rad_s = (rise_rad - before_rad) / dt * math::cos(truth.yaw_rad - config.ground.slope_direction_rad);
        gravity = gravity_vector(config.ground, effects.body, config.rover.gravity_m_s2, truth.path_m);
        dWorldSetGravity(world, gravity[0], gravity[1], gravity[2]);
    }
    steering.step(dt);
    const Vec3 before = mean_velocity();
    begin_bodies();
    if (goes_abreast())
        step_abreast(supply_V);
    else
        step_wheels(supply_V);
    push_body();
    if (hinge) hold_halves();
    push_bodies();
    dWorldStep(world, dt);
    ++steps;

    if (config.audit) keep_energy();
    observe(before);
}

void Plant::World::step_wheels(double supply_V) {
    settle();
    abreast.holds = false;
    for (const int i : wheels) {
        if (caster(i)) {
            step_caster(i);
            continue;
        }
        step_wheel(i);
        if (i == turned_by[static_cast<std::size_t>(motor_of(i))].back()) turn(motor_of(i), supply_V);
    }
}

void Plant::World::begin_bodies() {
    for (BodyNow &one : now) {
        const double *turn = one.turn;
        const double flat = std::sqrt(turn[0] * turn[0] + turn[4] * turn[4]);
        one.heading = {turn[0] / flat, turn[4] / flat, 0};
        one.force = one.torque = {};
    }
}

void Plant::World::push_bodies() {
    for (const BodyNow &one : now) { // once a step: each call costs
        dBodyAddForce(one.body, one.force[0], one.force[1], one.force[2]);
        dBodyAddTorque(one.body, one.torque[0], one.torque[1], one.torque[2]);
    }
}

// What the step that was just taken did, by forces at its beginning and speeds at its middle.
void Plant::World::keep_energy() {
    const double dt = config.dt_s;
    for (const int i : wheels) {
        Applied &a = applied[static_cast<std::size_t>(i)];
        Vec3 after{};
        contact_velocity(i, after);
        for (std::size_t k = 0; k < 3; ++k) after[k] = 0.5 * (after[k] + a.stand.velocity[k]);
        const double along = dot(after, a.stand.ahead);
        const double to_body = dot(a.force, after);
        const double vertical = a.load_N * dot(a.stand.up, after);
        const double edge = a.edge_N * along; // a caster only rolls
        const double rolling = caster(i) ? vertical + edge - to_body : a.resist_N * along;
        energy.rolling += rolling * dt;
        energy.slip += (a.torque_Nm * a.spin_mean_rad_s - (to_body - vertical + rolling - edge)) * dt;
        energy.body -= (vertical + edge) * dt;
    }
    const Vec3 velocity = mean_velocity();
    energy.body -= 0.5 * (dot(push, velocity) + dot(push, push_velocity)) * dt;
    energy.kinetic = kinetic();
    energy.potential = potential() - potential_0;
}

void Plant::World::observe(const Vec3 &velocity_before) {
    const double dt = config.dt_s;
    truth.t_s = static_cast<double>(steps) * dt;
    const dReal *a = dBodyGetPosition(half[0]), *b = dBodyGetPosition(half[1]);
    truth.position_m = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
    const dReal *q = dBodyGetQuaternion(half[0]);
    truth.orientation = {q[0], q[1], q[2], q[3]};
    const dReal *rate = dBodyGetAngularVel(half[0]);
    Vec3 rate_world{rate[0], rate[1], rate[2]};
    if (relief) { // the halves move apart: the body's way is their mean
        const dReal *other = dBodyGetQuaternion(half[1]), *other_rate = dBodyGetAngularVel(half[1]);
        double size = 0;
        for (std::size_t k = 0; k < 4; ++k) truth.orientation[k] += other[k], size += truth.orientation[k] * truth.orientation[k];
        for (double &part : truth.orientation) part /= std::sqrt(size);
        for (std::size_t k = 0; k < 3; ++k) rate_world[k] = 0.5 * (rate_world[k] + other_rate[k]);
        truth.joint_rad = math::asin(dBodyGetRotation(half[0])[8]) - math::asin(dBodyGetRotation(half[1])[8]);
    }
    if (config.rover.layout.rocker) observe_links();
    const auto [ex, ey, ez] = axes();
    const Vec3 v = mean_velocity();
    truth.v_body_m_s = {dot(v, ex), dot(v, ey), dot(v, ez)};
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
    left_rises = ey[2];
    truth.path_m += truth.v_body_m_s[0] * (steps > 0 ? dt : 0);
    if (std::fabs(truth.v_body_m_s[0]) > 1e-3) direction = truth.v_body_m_s[0] > 0 ? 1 : -1;
    if (abreast.ahead) {
        for (std::size_t i = 0; i < truth.wheel.size(); ++i) truth.wheel[i].current_A = abreast.wheels.current_A[i];
        return;
    }
    for (const int slot : wheels) {
        const auto i = static_cast<std::size_t>(slot);
        WheelTruth &w = truth.slot(slot);
        w.angle_rad = drive[i].wheel_angle_rad;
        w.speed_rad_s = drive[i].wheel_speed_rad_s;
        w.motor_angle_rad = drive[i].motor_angle_rad;
        w.motor_speed_rad_s = drive[i].motor_speed_rad_s;
        w.current_A = drive[i].current_A;
        w.duty = enabled && motor_of(slot) == slot ? duty[i] : 0;
        w.steer_rad = steering.wheel(slot).angle_rad;
        w.winding_temperature_C = 25 + drive[i].heat_K; // ambient 25 C, assumed
    }
}

Plant::Plant(const PlantConfig &config) : world_(std::make_unique<World>(config)) {}
Plant::~Plant() = default;

void Plant::set_duty(int wheel, double duty) {
    world_->duty.at(static_cast<std::size_t>(wheel)) = std::isnan(duty) ? 0 : std::clamp(duty, -1.0, 1.0);
}

void Plant::set_curvature(double curvature_1_m) { world_->steering.order(curvature_1_m); }

void Plant::set_enabled(bool enabled) { world_->enabled = enabled; }

void Plant::block_wheel(int wheel, bool blocked) { world_->blocked.at(static_cast<std::size_t>(wheel)) = blocked; }

void Plant::open_motor(int wheel, bool open) { world_->open.at(static_cast<std::size_t>(wheel)) = open; }

void Plant::sag_supply(double sag_V) { world_->sag_V = sag_V; }

void Plant::step() { world_->step(); }

const Truth &Plant::truth() const {
    world_->settle();
    world_->truth.roll_rad = math::asin(world_->left_rises);
    return world_->truth;
}

const Truth &Plant::truth_of_body() const { return world_->truth; }

const Energy &Plant::energy() const { return world_->energy; }

std::uint64_t Plant::state_hash() const {
    world_->settle();
    std::uint64_t hash = 1469598103934665603ull; // FNV-1a
    const auto mix = [&hash](double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        for (unsigned byte = 0; byte < 8; ++byte) hash = (hash ^ ((bits >> (8 * byte)) & 0xff)) * 1099511628211ull;
    };
    for (const dBodyID body : world_->bodies)
        for (std::size_t k = 0; k < 4; ++k) {
            mix(dBodyGetQuaternion(body)[k]);
            if (k < 3) mix(dBodyGetPosition(body)[k]), mix(dBodyGetLinearVel(body)[k]), mix(dBodyGetAngularVel(body)[k]);
        }
    for (const int slot : world_->wheels) {
        const auto i = static_cast<std::size_t>(slot);
        const DriveState &d = world_->drive[i];
        for (const double value :
             {d.motor_angle_rad, d.motor_speed_rad_s, d.wheel_angle_rad, d.wheel_speed_rad_s, d.current_A, d.heat_K,
              world_->contact[i].slip, world_->contact[i].side_slip, world_->contact[i].rolling, world_->contact[i].speed_m_s})
            mix(value);
    }
    if (world_->config.rover.layout.kind == Layout::caster) mix(world_->contact[4].rolling_aside);
    if (world_->steering.there()) mix(world_->steering.servo_rad());
    for (const int slot : world_->wheels) {
        const RutTrace &trace = world_->trace[static_cast<std::size_t>(slot)];
        mix(trace.found_m()), mix(trace.deepest_m());
    }
    mix(world_->truth.path_m), mix(world_->truth.yaw_rad), mix(world_->used_C);
    return hash ^ world_->ruts.hash();
}

} // namespace traction::sim
