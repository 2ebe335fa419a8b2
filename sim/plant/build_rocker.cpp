// Bodies, pivots and first pose of a rover on rockers (rocker.h).
#include "rocker.h"
#include "world.h"

#include "sim/physics/math.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace traction::sim {

namespace {

constexpr double at_ends = 1.7320508075688772;    // of a link's length: a box of this length has the inertia of half its mass at each end
constexpr double bar_share = 0.002;               // of the body's mass, in the differential's bar: assumed, little beside all loads
constexpr double horn_share = 0.5, rod_share = 1; // of half a track: the horn's height over the pivot, the rods' length; assumed

dBodyID make_body(dWorldID world, double mass_kg, const Vec3 &size, const Vec3 &at) {
    const dBodyID body = dBodyCreate(world);
    dMass mass;
    dMassSetBoxTotal(&mass, mass_kg, size[0], size[1], size[2]);
    dBodySetMass(body, &mass);
    dBodySetPosition(body, at[0], at[1], at[2]);
    return body;
}

dJointID make_hinge(dWorldID world, dBodyID a, dBodyID b, const Vec3 &at, const Vec3 &axis) {
    const dJointID hinge = dJointCreateHinge(world, nullptr);
    dJointAttach(hinge, a, b);
    dJointSetHingeAnchor(hinge, at[0], at[1], at[2]);
    dJointSetHingeAxis(hinge, axis[0], axis[1], axis[2]);
    return hinge;
}

Vec3 less(const Vec3 &a, const Vec3 &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

struct Turn { // yaw, then roll, then pitch (nose down)
    dMatrix3 m;
    Turn(double c, double s, double roll_rad, double pitch_rad) { turn_of(c, s, roll_rad, pitch_rad, m); }
    Vec3 of(const Vec3 &v) const {
        return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[4] * v[0] + m[5] * v[1] + m[6] * v[2], m[8] * v[0] + m[9] * v[1] + m[10] * v[2]};
    }
};

Vec3 plus(const Vec3 &a, const Vec3 &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

void put(dBodyID body, const Vec3 &at, const Turn &turn) {
    dBodySetPosition(body, at[0], at[1], at[2]);
    dBodySetRotation(body, turn.m);
}

} // namespace

// Level, at the origin, heading along x, wheels on z = 0: here all anchors are taken. x and y are counted from the centre of mass.
void Plant::World::build_rocker() {
    const RoverParameters &r = config.rover;
    const LayoutParameters &l = r.layout;
    const bool six = l.kind == Layout::six;
    const double off_x = effects.body.offset_x_m, off_y = effects.body.offset_y_m;
    const auto shifted = [&](double x, double y, double z) { return Vec3{law::mass_offset_m(x, off_x), law::mass_offset_m(y, off_y), z}; };
    const double whole = r.mass_kg - 2 * l.rocker_kg - (six ? 2 * l.bogie_kg : 0), bar_kg = bar_share * whole;
    const Vec3 &middle = links.body_at = {0, 0, law::load_transfer_m(r.centre_height_m, effects.body.raised_m)};
    const dBodyID body = make_body(world, whole - bar_kg, {r.length_m, r.width_m, r.height_m}, middle);
    half = {body, body};
    bodies = {body};
    const double horn_m = horn_share * r.half_track_m, rod_m = rod_share * r.half_track_m, high = l.rocker_height_m + horn_m;
    links.bar_at = shifted(l.rocker_m - rod_m, 0, high);
    links.bar = make_body(world, bar_kg, {0.02 * r.half_track_m, 2 * r.half_track_m, 0.02 * r.half_track_m}, links.bar_at);
    bodies.push_back(links.bar);
    make_hinge(world, body, links.bar, links.bar_at, {0, 0, 1});
    const LinkPlace rocker = rocker_place(l, r.half_wheelbase_m, r.wheel_radius_m);
    for (int side = 0; side < 2; ++side) {
        const auto n = static_cast<std::size_t>(side);
        const double aside = side == 0 ? r.half_track_m : -r.half_track_m;
        const double thick = 0.5 * r.wheel_width_m;
        const Vec3 at = links.rocker_at[n] = shifted(rocker.ahead_m, aside, rocker.height_m);
        links.pivot_at[n] = shifted(l.rocker_m, aside, l.rocker_height_m);
        const dBodyID link = links.rocker[n] = make_body(world, l.rocker_kg, {at_ends * rocker.length_m, thick, thick}, at);
        bodies.push_back(link);
        make_hinge(world, body, link, links.pivot_at[n], {0, 1, 0});
        const dJointID rod = dJointCreateDBall(world, nullptr);
        const Vec3 from = shifted(l.rocker_m - rod_m, aside, high), to = shifted(l.rocker_m, aside, high);
        dJointAttach(rod, links.bar, link);
        dJointSetDBallAnchor1(rod, from[0], from[1], from[2]);
        dJointSetDBallAnchor2(rod, to[0], to[1], to[2]);
        const auto carry = [&](int slot, dBodyID by, const Vec3 &centre) {
            const WheelPlace wheel = place(slot);
            carrier[static_cast<std::size_t>(slot)] = by;
            contact_at[static_cast<std::size_t>(slot)] = less(shifted(wheel.ahead_m, wheel.left_m, 0), centre);
        };
        const RockerSide chain = rocker_side(l, side);
        carry(chain.rocker_wheel, link, at);
        dBodyID last = link;
        Vec3 centre = at;
        if (six) {
            const LinkPlace bogie = bogie_place(l, r.half_wheelbase_m, r.wheel_radius_m);
            centre = links.bogie_at[n] = shifted(bogie.ahead_m, aside, bogie.height_m);
            links.joint_at[n] = shifted(l.bogie_m, aside, l.bogie_height_m);
            last = links.bogie[n] = make_body(world, l.bogie_kg, {at_ends * bogie.length_m, thick, thick}, centre);
            bodies.push_back(last);
            make_hinge(world, link, last, links.joint_at[n], {0, 1, 0});
        }
        for (const int slot : chain.others) carry(slot, last, centre);
    }
    // what hangs on a contact that pushes along: a link that gives way turns about its own centre
    const auto hangs_kg = [](double mass_kg, const LinkPlace &link, double carried) {
        const double arm = 2 * link.height_m / link.length_m;
        return mass_kg / (1 + arm * arm) / carried;
    };
    contact_kg = std::min(contact_kg, hangs_kg(l.rocker_kg, rocker, six ? 1 : 2));
    if (six) contact_kg = std::min(contact_kg, hangs_kg(l.bogie_kg, bogie_place(l, r.half_wheelbase_m, r.wheel_radius_m), 2));
    stand_rocker();
    const double c = math::cos(config.yaw_rad), s = math::sin(config.yaw_rad);
    for (const dBodyID b : bodies) dBodySetLinearVel(b, config.speed_m_s * c, config.speed_m_s * s, 0);
}

// How deep a wheel stands that bears this.
double Plant::World::depth_under(double load_N) const {
    const RoverParameters &r = config.rover;
    if (config.ground.contact == ContactLaw::aggregated || !config.ground.soil.bekker) return load_N / r.contact_stiffness_N_m;
    return sinkage_under(config.ground.contact == ContactLaw::arc ? arc_force : bekker_force, *config.ground.soil.bekker,
                         {r.wheel_radius_m, r.wheel_width_m, r.tyre_hysteresis}, load_N, 0);
}

// Each wheel as deep in the ground under it as what it bears presses it: from the wheels' heights the bogie's pitch, the rocker's, the
// body's (1), and the roll. A few rounds, for a wheel that is lifted moves along, too.
void Plant::World::stand_rocker() {
    const RoverParameters &r = config.rover;
    const LayoutParameters &l = r.layout;
    const bool six = l.kind == Layout::six;
    const double c = math::cos(config.yaw_rad), s = math::sin(config.yaw_rad), weight = r.mass_kg * std::fabs(gravity[2]);
    const auto share = rocker_loads(l, r.mass_kg, r.half_wheelbase_m, r.wheel_radius_m);
    for (int round = 0; round < 6; ++round) {
        const auto height = [&](int slot) { // of the wheel's lowest point
            const auto n = static_cast<std::size_t>(slot);
            double ground = 0;
            if (relief) {
                dVector3 axle;
                const Vec3 &at = contact_at[n];
                const WheelPlace wheel = place(slot);
                if (round > 0)
                    dBodyGetRelPointPos(carrier[n], at[0], at[1], at[2] + r.wheel_radius_m, axle);
                else
                    axle[0] = config.x_m + c * wheel.ahead_m - s * wheel.left_m,
                    axle[1] = config.y_m + s * wheel.ahead_m + c * wheel.left_m;
                ground = relief->rest(axle[0], axle[1], c, s, r.wheel_radius_m, r.wheel_width_m).height_m;
            }
            return ground - depth_under(share[n] * weight);
        };
        std::array<double, 2> rocker_rad{}, bogie_rad{}, pivot_m{};
        for (int side = 0; side < 2; ++side) {
            const auto n = static_cast<std::size_t>(side);
            const RockerSide chain = rocker_side(l, side);
            // the end of the rocker that its own wheel does not carry, and how high that end stands
            const double a = place(chain.rocker_wheel).ahead_m, R = r.wheel_radius_m;
            double b = place(chain.others.front()).ahead_m, far_m = R, stands_m = height(chain.others.front()) + R;
            if (six) {
                const double e = place(chain.others.back()).ahead_m, rear_m = stands_m, front_m = height(chain.others.back()) + R;
                bogie_rad[n] = math::asin(std::clamp((rear_m - front_m) / (e - b), -0.9, 0.9));
                const double p = bogie_rad[n], up = l.bogie_height_m - R; // the pivot from the rear wheel's axle
                stands_m = rear_m - (l.bogie_m - b) * math::sin(p) + up * math::cos(p);
                b = l.bogie_m, far_m = l.bogie_height_m;
            }
            const double own_m = height(chain.rocker_wheel) + R, dx = b - a, dz = far_m - R;
            double &p = rocker_rad[n]; // stands - own = -dx sin p + dz cos p
            for (int i = 0; i < 20; ++i)
                p -= (-dx * math::sin(p) + dz * math::cos(p) - (stands_m - own_m)) / (-dx * math::cos(p) - dz * math::sin(p));
            pivot_m[n] = own_m - (l.rocker_m - a) * math::sin(p) + (l.rocker_height_m - R) * math::cos(p);
        }
        const double pitch = 0.5 * (rocker_rad[0] + rocker_rad[1]), roll = math::atan2(pivot_m[0] - pivot_m[1], 2 * r.half_track_m);
        const Turn body(c, s, roll, pitch);
        const Vec3 to_left = body.of(less(links.pivot_at[0], links.body_at)), to_right = body.of(less(links.pivot_at[1], links.body_at));
        const Vec3 middle{config.x_m, config.y_m, 0.5 * (pivot_m[0] - to_left[2] + pivot_m[1] - to_right[2])};
        put(half[0], middle, body);
        // (1): the bar's ends go with the horns, the left one ahead by h sin(r)
        const double lean = 0.5 * (rocker_rad[0] - rocker_rad[1]);
        const double swing = -math::asin(horn_share * math::sin(lean));
        Turn bar(c, s, roll, pitch);
        const Turn about(math::cos(swing), math::sin(swing), 0, 0);
        const Vec3 ex = body.of(about.of({1, 0, 0})), ey = body.of(about.of({0, 1, 0})), ez = body.of({0, 0, 1});
        for (std::size_t k = 0; k < 3; ++k) bar.m[4 * k] = ex[k], bar.m[4 * k + 1] = ey[k], bar.m[4 * k + 2] = ez[k];
        put(links.bar, plus(middle, body.of(less(links.bar_at, links.body_at))), bar);
        for (std::size_t n = 0; n < 2; ++n) {
            const Turn rocker(c, s, roll, rocker_rad[n]), bogie(c, s, roll, bogie_rad[n]);
            const Vec3 pivot = plus(middle, n == 0 ? to_left : to_right);
            put(links.rocker[n], plus(pivot, rocker.of(less(links.rocker_at[n], links.pivot_at[n]))), rocker);
            if (!six) continue;
            const Vec3 joint_at = plus(pivot, rocker.of(less(links.joint_at[n], links.pivot_at[n])));
            put(links.bogie[n], plus(joint_at, bogie.of(less(links.bogie_at[n], links.joint_at[n]))), bogie);
        }
    }
}

// Angles of the links, nose down positive: rockers against the body, bogies against their rocker.
void Plant::World::observe_links() {
    const auto pitch = [](dBodyID body) { return -math::asin(std::clamp(dBodyGetRotation(body)[8], -1.0, 1.0)); };
    const double body = pitch(half[0]);
    for (std::size_t n = 0; n < 2; ++n) {
        const double rocker = pitch(links.rocker[n]);
        truth.rocker_rad[n] = rocker - body;
        truth.bogie_rad[n] = links.bogie[n] != nullptr ? pitch(links.bogie[n]) - rocker : 0;
    }
    truth.joint_rad = truth.rocker_rad[1] - truth.rocker_rad[0];
}

} // namespace traction::sim
