// physics.h - the numbers the forward model computes with, and the handles by which a fit moves them.
//
// Every catalogue effect has its slot, zero when absent: to try an effect is to move its slot. Built from a Model by
// make_physics(); FreeParameter says which slots move together, with which prior, and which stages they touch.
#pragma once

#include "host_tools/lab/model/model.h"
#include "host_tools/lab/model/terms.h"

#include "sim/physics/effects/acting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace traction::lab {

// The machine, beside the effects that act on it (acting.h).
struct WheelPhysics : sim::WheelEffects {
    double x = 0, y = 0, heading = 0, radius = 0, load = 0; // load 0: from the geometry
    double KG = 0, ke = 0, Ra = 0, J = 0, b = 0, t0 = 0;
    double adhesion = 0, mu = 0, sc = 0, crr = 0, lateral = 0, grip = 0,
           relaxation = 0; // grip: 1 where the soil holds sideways as it holds lengthways
    double curve = 0;      // (6) of wheel_laws.h
    double reversal = 0;   // speed over which rolling resistance reverses (creeps.h); 0: below what the drive shows
    double current_offset0 = 0;
};

inline double rolling_radius(const WheelPhysics &w) { return sim::law::wheel_radius_m(w.radius, w.radius_change); }
// True over measured wheel speed.
inline double count_gain(const WheelPhysics &w) { return 1 / sim::law::encoder_missed(std::min(0.9, w.encoder_missed)); }

// Motors that may share a lead.
inline bool same_axle(const WheelPhysics &a, const WheelPhysics &b) { return std::fabs(a.x - b.x) < 0.01; } // 1 cm: assumed
inline bool same_side(const WheelPhysics &a, const WheelPhysics &b) { return a.y * b.y > 0; }

struct BodyPhysics : sim::BodyEffects {
    double mass = 0, yaw_inertia = 0, centre_height = 0, gravity = 9.81, battery_V = 0;
    double track_scale = 1; // of the wheels' y
    double voltage_delay0 = 0, current_delay = 0, accel_bias0 = 0, accel_delay0 = 0, accel_lag0 = 0, accel_ahead0 = 0, accel_left0 = 0,
           gyro_bias = 0, gyro_scale0 = 0, radar_scale0 = 0, radar_delay = 0, radar_lead = 0, camera_scale0 = 0, camera_delay0 = 0;
};

// By which the duty takes effect later than the log has it.
inline double command_delay_s(const BodyPhysics &b) { return sim::law::actuation_delay_s(b.voltage_delay0, b.actuation_delay_s); }

// By which the currents are later than the log has it.
inline double current_delay_s(const BodyPhysics &b) { return sim::law::current_delay_s(b.current_delay, b.current_delay_s); }

// What a run has of its own; NaN: as the machine has it.
struct RunPhysics {
    double start_s = 0; // it lasts to the start of the next
    double accel_bias = as_the_machine, gyro_bias = as_the_machine;
    double mu = as_the_machine, adhesion = as_the_machine, sc = as_the_machine, crr = as_the_machine, lateral = as_the_machine;
    bool has_ground() const;
    static constexpr double as_the_machine = std::numeric_limits<double>::quiet_NaN();
};

inline double own_or(double own, double shared) { return std::isnan(own) ? shared : own; }

struct ExtraTerm {
    std::string name;
    TermTarget target = TermTarget::wheel_torque;
    int wheel = -1; // -1: all
    std::vector<double> coefficients;
    std::shared_ptr<Term> term;
};

struct Physics {
    SoilLaw soil_law = SoilLaw::janosi;
    BodyMotion motion = BodyMotion::longitudinal;
    bool unsigned_current = false, halves = false;
    std::vector<WheelPhysics> wheel;
    std::vector<bool> driven, grips_sideways;
    std::vector<std::size_t> motor; // per wheel: the wheel whose motor turns it; empty: each has its own
    BodyPhysics body;
    std::vector<ExtraTerm> terms;
    std::vector<RunPhysics> runs; // by their start; empty: none has anything of its own
};

// The run that t_s lies in; nullptr where no run has anything of its own.
const RunPhysics *run_at(const Physics &physics, double t_s);

// Wheels of one motor share its speed; it carries their tractions together. What is on a motor stands at its own wheel.
inline std::size_t motor_of(const Physics &p, std::size_t wheel) { return p.motor.empty() ? wheel : p.motor[wheel]; }
inline bool is_motor(const Physics &p, std::size_t wheel) { return motor_of(p, wheel) == wheel; }
template <typename Do> void each_wheel_of(const Physics &p, std::size_t motor, Do &&act) { // its own first, alone where it turns no other
    act(motor);
    for (std::size_t i = 0; i < p.motor.size(); ++i)
        if (i != motor && p.motor[i] == motor) act(i);
}

// One number inside a Physics.
struct Slot {
    double WheelPhysics::*in_wheel = nullptr;
    int wheel = -1;
    double BodyPhysics::*in_body = nullptr;
    double RunPhysics::*in_run = nullptr;
    std::size_t run = 0;                 // of Physics::runs
    static constexpr int last_term = -2; // and below it those before it
    int term = -1, coefficient = 0;
    double &of(Physics &physics) const;
    double of(const Physics &physics) const { return of(const_cast<Physics &>(physics)); }
};

// One degree of freedom of a fit: an increment added to all its slots.
struct FreeParameter {
    std::string owner; // "motor", "soil", "sensors", or the effect's name
    std::string key;   // "resistance_ohm"
    std::string unit;
    int wheel = -1;
    int run = -1; // of Model::runs; -1: the machine's
    std::string run_log = {};
    std::vector<Slot> slots;
    double base = 0;                 // value in the model, before the increment (first slot)
    double prior = 0;                // standard deviation of the increment; 0: free
    double alike = 1;                // so many of its rows tell as much as one that is independent (design effect, problem.cpp): 1 or more
    double minimum = 0, maximum = 0; // of base + increment
    double step = 0;                 // for differences
    unsigned touched = stage_all;
    bool own = false; // of a parameter that wheels share: what one wheel's differs from that (base 0)
    void add(Physics &physics, double increment) const;
};

// "motor.resistance_ohm", "motor.resistance_ohm on wheel 2": an overridden one, or what that wheel's differs; "soil.mu in gravel.csv".
std::string name_of(const FreeParameter &parameter);

// The same number of the same machine, in two fits.
bool is_same(const FreeParameter &a, const FreeParameter &b);

// An effect as the lab can try it: slots by parameter.
struct EffectHandle {
    std::string name;
    struct Strength {
        std::string key;
        double WheelPhysics::*in_wheel = nullptr;
        double BodyPhysics::*in_body = nullptr;
    };
    std::vector<Strength> strengths, shapes;
    unsigned touched = stage_all;
    bool remembers = false; // whole integrations with a kink
    bool of_motor = false;  // on motors, gears or their sensors
    // Is the effect's number to be set at wheel i where the effect is on `wheel` (-1: all)? On a motor it stands at its own wheel; where it
    // changes how the wheels turn, at each that the motor turns.
    bool acts_at(const Physics &physics, int wheel, std::size_t i) const;
};
const std::vector<EffectHandle> &effect_handles(); // the catalogue's rows, in its order
const EffectHandle *find_handle(const std::string &name);

// Throws ModelError when an effect of the model is neither in the catalogue nor a user's expression.
Physics make_physics(const Model &model);

// The parameters with a prior (nuisance), and the strengths of the effects already in the model (free).
std::vector<FreeParameter> free_parameters(const Model &model, const Physics &physics);

// Writes fitted values back: value of each key that a free parameter stands for.
// `half_width`: of its 95 % interval.
void store(Model &model, const FreeParameter &parameter, double increment, double half_width);

} // namespace traction::lab
