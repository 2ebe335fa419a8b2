// terms.h - extra terms of the model: a user's expression, or a structure-free shape f(X) with one coefficient per knot.
//
// Signals a term may name (SI): t time, w wheel speed, v ground speed at the wheel, s slip, Fn wheel load, theta wheel angle,
// x path travelled, a body acceleration, I winding current (the model's, never the measured one), u motor voltage, Ft traction,
// V body speed, r yaw rate, X path of the body's middle, d wheel angle since its last reversal, Io current of the other motors together,
// Ia of those on the same axle, Is of those on the same side (the model's).
#pragma once

#include "sim/physics/effects/catalogue.h"

#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace traction::lab {

// What a parameter, term or effect touches of the prediction, hence what must be computed again when it moves.
enum Stage : unsigned {
    stage_motion = sim::needs_motion,
    stage_torque = sim::needs_torque,
    stage_voltage = sim::needs_voltage,
    stage_sensors = sim::needs_sensors,
    stage_all = sim::needs_stages
};

// Where a term acts. Multipliers act as times (1 + f).
enum class TermTarget {
    wheel_torque,   // adds to Gr [N m], opposing the motor; the term carries its own sign
    wheel_friction, // adds to Gr against the wheel's motion [N m]
    wheel_force,    // adds to the force of the wheel on the body, along its heading [N]
    rolling,        // adds to the rolling resistance Rr [N], opposes motion
    body_force,     // adds to the force on the body along x [N]
    voltage,        // lost of the motor's voltage [V]
    soil_strength,  // Fm times (1 + f)
    shear_slip,     // sc times (1 + f)
    motor_constant, // KG and ke times (1 + f)
    resistance,     // Ra times (1 + f)
    accel,          // adds to the accelerometer [m/s^2]
    radar,          // radar speed times (1 + f)
    camera,         // camera displacement times (1 + f)
    current,        // measured current times (1 + f)
    count
};

std::string_view target_name(TermTarget target);
bool parse_target(std::string_view name, TermTarget &target);
unsigned target_stages(TermTarget target); // Stage bits
bool acts_on_motor(TermTarget target);     // on the motor, its gear or its sensors: once for all the wheels that it turns

struct Signals {
    double t = 0, w = 0, v = 0, s = 0, Fn = 0, theta = 0, x = 0, a = 0, I = 0, u = 0, Ft = 0, V = 0, r = 0, X = 0, d = 0, Io = 0, Ia = 0,
           Is = 0;
};

// A function of the signals, linear or not in its coefficients. Evaluation does not change the object's meaning (a parser inside
// is reused), so one Term serves one thread.
class Term {
  public:
    virtual ~Term() = default;
    virtual double value(const Signals &signals, const double *coefficients) const = 0;
    // What each coefficient counts, of a shape that is linear in them: value = sum of weight times coefficient.
    virtual void weights(const Signals &signals, std::size_t count, double *weight) const;
    virtual bool of_other_motors() const { return false; } // asks for Io, Ia or Is
};

enum class Axis {
    time,
    wheel_speed,
    speed,
    slip,
    load,
    angle,
    path,
    accel,
    current,
    direction,
    abs_speed,
    yaw_rate,
    place,
    reversal,
    other_current,
    axle_current,
    side_current,
    abs_wheel_speed,
    voltage,
    turn, // wheel angle within its turn, -pi to pi, from where the log begins
    count
};
std::string_view axis_name(Axis axis);
std::string_view axis_unit(Axis axis);
double axis_value(Axis axis, const Signals &signals);
bool is_of_other_motors(Axis axis); // Io, Ia, Is

// sum_k c_k * hat_k(X): piecewise linear through the knots, constant outside them.
std::shared_ptr<Term> make_piecewise(Axis axis, std::vector<double> knots);

// sum_k c_k where X lies in cell k: cells of equal length from `start` on.
std::shared_ptr<Term> make_cells(Axis axis, double start, double length);

// c_0 cos(n X) + c_1 sin(n X), n in radians per unit of the axis.
std::shared_ptr<Term> make_periodic(Axis axis, double order);

// A muparser expression in the signals and the named parameters (the coefficients, in that order). Throws std::runtime_error
// with muparser's message and position.
std::shared_ptr<Term> make_expression(const std::string &expression, const std::vector<std::string> &parameters);

} // namespace traction::lab
