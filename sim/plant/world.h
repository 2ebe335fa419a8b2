// world.h - the state behind Plant: bodies, wheels, drives, and the steps between them. Included by plant.cpp, build.cpp and wheels.cpp
// only.
#pragma once

#include "abreast.h"
#include "contact.h"
#include "hinge.h"
#include "layout.h"
#include "plant.h"
#include "rut.h"
#include "soft_sign.h"
#include "steering.h"
#include "step_calls.h"

#include "sim/physics/effects/acting.h"
#include "sim/physics/terramechanics.h"

#include <cstdint>
#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

namespace traction::sim {

using Vec3 = std::array<double, 3>;

inline double dot(const Vec3 &a, const Vec3 &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline constexpr double half_offset_share = 0.25; // a half's centre lies a quarter of the width beside the middle
constexpr bool is_left(int slot) { return slot % 2 == 0; }
constexpr bool is_front(int slot) { return slot == 2 || slot == 3; }
constexpr bool is_middle(int slot) { return slot >= 4; }

// Yaw (by its cosine and sine), then roll, then pitch (nose down).
void turn_of(double c, double s, double roll_rad, double pitch_rad, dMatrix3 turn);

struct Plant::World {
    explicit World(const PlantConfig &c);
    ~World();
    void build_bodies();
    void build_joints(const Vec3 &anchor);
    void build_rocker();
    void stand_rocker();
    void observe_links();
    double depth_under(double load_N) const;
    Stance stance() const;
    void pose(const Vec3 &middle, double roll_rad, double pitch_rad);
    void stand_up(double height_m);
    void place_whole_on_terrain();
    void step();
    void step_wheels(double supply_V); // one after another
    void know_abreast();               // whether the four can be stepped side by side (abreast.h)
    bool goes_abreast() const;         // in this step
    void step_abreast(double supply_V);
    void give_abreast(FourGiven &given);
    void settle();                        // what was stepped side by side goes where all else looks for it
    void step_wheel(int i);               // what the ground does to it
    void turn(int slot, double supply_V); // and its motor's wheels by it
    int motor_of(int slot) const { return motor[static_cast<std::size_t>(slot)]; }
    bool caster(int slot) const { return is_ball[static_cast<std::size_t>(slot)]; }
    void know_wheels();
    void step_caster(int i);
    struct Stand {                        // where a wheel meets the ground: the plane it touches and how far it is pressed in
        Vec3 point{}, velocity{};         // contact point of the body, world
        Vec3 arm{};                       // from the half's centre to it
        Vec3 heading{};                   // of the wheel, horizontal
        Vec3 ahead{}, left{}, up{};       // of the plane
        double depth_m = 0, sink_m_s = 0; // vertical; sink: how fast it grows
        double steep = 1;                 // depth_m over that along `up`
    };
    Stand stand(int i);
    Stand stand_on_plane(int i);
    void place_on_terrain();
    double place_on_path(int i) const;
    double current_of_others(int i);
    double grip_factor(int i, double x_m, double y_m, double sliding_m_s); // of Fm: place, track, sliding
    struct Meeting {
        ContactForce force;
        double load_N = 0, rolling_N = 0, sinkage_m = 0;
        double arm_m = 0;               // of force.along_N about the axle; 0: the radius
        double free_N = 0, free_Nm = 0; // pull and torque of rolling alone, in its direction
        double edge_N = 0;              // ahead: of the edge between two soils
    };
    struct Footing { // the soils under a wheel
        const Soil *behind, *front;
        double share_front = 1;
        double length_m = 0;
    };
    Footing footing(const Vec3 &point, const Vec3 &heading, double half_m) const;
    Meeting meet_aggregated(int i, ContactInput in, const Soil &soil, double factor, double load_N);
    Meeting meet_soft(int i, ContactInput in, const Footing &foot, double factor, const Stand &at);
    const SoilConstants &constants_of(const Soil &soil) const;
    void push_body();
    void take_hinge();
    void hold_halves();
    void keep_energy();
    void observe(const Vec3 &velocity_before);
    Vec3 mean_velocity() const;
    struct Axes {
        Vec3 x, y, z;
    };
    Axes axes() const;                             // mean of the halves, unit, world
    void contact_velocity(int i, Vec3 &out) const; // of the contact point, as far as the last step knew it
    double kinetic() const;
    double potential() const;
    bool trails(int slot) const {
        const bool rows = config.rover.layout.kind == Layout::four || config.rover.layout.kind == Layout::six;
        return rows && (is_middle(slot) || is_front(slot) != (direction > 0));
    }
    WheelPlace place(int slot) const {
        return wheel_place(config.rover.layout, config.rover.half_wheelbase_m, config.rover.half_track_m, slot);
    }
    double radius_m(int slot) const { // as the ground feels it
        return caster(slot) ? config.rover.layout.caster_radius_m : config.rover.wheel_radius_m;
    }
    double load_kg() const { return contact_kg; } // of a wheel, on the mean; of a light link's what it can hold
    dBodyID half_of(int wheel) const { return carrier[static_cast<std::size_t>(wheel)]; } // or the link that carries it

    PlantConfig config;
    std::span<const int> wheels; // slots, in order
    double contact_kg = 0;
    std::array<double, wheel_most> place_ahead_m{}; // of the centre of mass
    std::array<int, wheel_most> motor{};            // the slot whose motor turns this one
    std::array<bool, wheel_most> is_ball{};
    std::array<std::vector<int>, wheel_most> turned_by; // the slots that this one's motor turns, in order
    RoverEffects effects;
    Vec3 gravity{};
    std::optional<Relief> relief; // none: a plane
    dWorldID world = nullptr;
    dJointID joint = nullptr;
    std::optional<Hinge> hinge;                // the joint, where it is all that holds the halves: solved here, not by ODE
    std::array<dJointID, 2> rail{};            // a carriage's: no way aside, no turning
    StepCalls calls;                           // its own: ODE's default is shared by all worlds and not thread-safe
    std::array<dBodyID, 2> half{};             // on rockers both are the body
    std::vector<dBodyID> bodies;               // all of them
    std::array<dBodyID, wheel_most> carrier{}; // of each wheel
    struct Links {                             // and, as they were built, level at the origin, their centres and pivots
        std::array<dBodyID, 2> rocker{}, bogie{};
        dBodyID bar = nullptr;
        Vec3 body_at{}, bar_at{};
        std::array<Vec3, 2> rocker_at{}, bogie_at{}, pivot_at{}, joint_at{};
    } links;
    struct BodyNow {
        dBodyID body = nullptr;
        const double *turn = nullptr, *at = nullptr, *velocity = nullptr, *spin = nullptr; // ODE's own numbers, which follow the body
        Vec3 heading{};                                                                    // horizontal, as the step begins
        Vec3 force{}, torque{};                                                            // of the wheels, in this step
    };
    std::vector<BodyNow> now;                         // of `bodies`, in their order
    std::array<std::size_t, 2> half_at{};             // in it
    std::array<std::size_t, wheel_most> carrier_at{}; // in it, of each wheel
    BodyNow &now_of(int wheel) { return now[carrier_at[static_cast<std::size_t>(wheel)]]; }
    void know_bodies();
    void begin_bodies();
    void push_bodies();
    // A wheel's force on the body that carries it. What the wheels give is added up here and handed to ODE once.
    void push_at(int wheel, const Vec3 &force, const Vec3 &arm) {
        BodyNow &to = now_of(wheel);
        for (std::size_t k = 0; k < 3; ++k) to.force[k] += force[k];
        to.torque[0] += arm[1] * force[2] - arm[2] * force[1];
        to.torque[1] += arm[2] * force[0] - arm[0] * force[2];
        to.torque[2] += arm[0] * force[1] - arm[1] * force[0];
    }
    std::array<Vec3, wheel_most> contact_at{}; // contact point in its half's frame
    std::array<DriveState, wheel_most> drive{};
    std::array<ContactState, wheel_most> contact{};
    std::array<double, wheel_most> duty{}, others_A{}; // others_A: of the motors that share a lead
    std::array<bool, wheel_most> blocked{}, open{};
    double sag_V = 0;
    double rise_rad = 0;                  // of the ground where the rover is
    std::vector<SoilConstants> constants; // of the base soil and of each patch, soft contact only
    RutMemory ruts;
    Steering steering;
    std::array<RutTrace, wheel_most> trace;
    std::array<GripCell, wheel_most> grip_cell{};
    struct Abreast {
        bool can = false, soft = false;
        bool holds = false; // the wheels' state stands here; and
        bool ahead = false; // here alone
        FourKnown known;
        FourCarriers carriers;
        FourOrders orders;
        FourGiven given;
        FourWheels wheels;
        const FourSteps *steps = nullptr;
    } abreast;
    struct Applied {
        Vec3 force{};                                                                    // at the contact point, world
        double load_N = 0, resist_N = 0, edge_N = 0, torque_Nm = 0, spin_mean_rad_s = 0; // resist: rolling resistance, signed
        Stand stand;
    };
    std::array<Applied, wheel_most> applied{};
    Vec3 push{}, push_velocity{}; // drag and tether, whole rover
    bool enabled = true;
    double direction = 1;
    Vec3 heading_before{};
    double left_rises = 0; // sine of the roll
    double potential_0 = 0;
    double used_C = 0; // charge taken from the battery
    std::uint64_t steps = 0;
    Truth truth;
    Energy energy;
};

} // namespace traction::sim
