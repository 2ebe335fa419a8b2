// tune.h - gains of the wheel-speed loop for the motors at hand, from an experiment on any HAL with limits of torque and time.
//
//   w[k+1] = a w[k] + b duty[k] V[k] + c sgn(duty[k])                               (1)  least squares, each wheel; a = exp(-p T)
//   Kp = x/g, g = b V/T, Ki = p Kp                                                (2)  zero on the pole
//   |duty V - ke w| <= Ra Gamma_max/KG                                            (3)  the torque limit, before a duty is written
//
// With the zero on the pole the open loop is an integrator with a delay of 2 T (half a tick of hold, half of the encoder's
// difference, one of computation) and of D, how late an order acts on this rover: crossover x = (90 deg - margin)/(2 T + D) in
// radians (derived here). D comes out of the experiment's own currents (order_delay.h), and (1) is fitted to the duty in force.
// The experiment is the operator of the rover's own loop, MODE_OPEN_LOOP: the firmware's safety watches over it. The motors are
// stopped at the end, whatever ended it: exceptions too.
#pragma once

#include "firmware/core/control.h"
#include "hal/hal.h"

#include <array>
#include <stdexcept>
#include <string>

namespace traction {

struct TuneLimits {
    double torque_Nm = 0.3; // at the wheel, driving or braking, by (3) with Ra and ke found in the experiment itself
    double duty = 0.6;      // largest pulse
    double time_s = 20;     // of the whole experiment
    double margin_deg = 62; // phase margin asked for
};

struct TuneResult {
    std::array<double, WHEEL_COUNT> pole_1_s{}, gain_rad_s2{}; // p; acceleration per unit of duty
    double kp_s = 0, ki_1 = 0;                                 // of the wheel with the largest gain: the others have more margin
    double order_delay_s = 0;                                  // beyond the 2 T that every rover has: how late an order acts
    double battery_V = 0, largest_torque_Nm = 0, used_s = 0;
};

// Throws std::runtime_error with the reason: a device lost, no motion, the time limit, a fault.
TuneResult tune(const hal_t &hal, const control_config_t &config, const TuneLimits &limits);

} // namespace traction
