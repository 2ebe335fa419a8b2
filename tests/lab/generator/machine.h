// machine.h - the independent rover: planar (forward and yaw), four wheels, its own equations, stiff steps of 1 ms.
//
//   M dv/dt = sum_i (F_i - Q_i) + B          Izz dr/dt = b sum_i (+-)(F_i - Q_i) - scrub                        (a)
//   J dw/dt = KG*I - G(w) - R*F,  I = soft(u - ke*w, dead)/Ra                          (17)-(18) Lhomme-Desages  (b)
//   F = Fm*f(|s|)*sign(R*w - v), f from (20) or (21); s = (R*w - v)/max(|R*w|, |v|, 1 cm/s), odd, bounded         (c)
//   sigma dz/dt = max(|R*w|, |v|, 2 cm/s)*(s - z): the slip that grips is z where there is a relaxation length    (d)
// State y = [v, r, w0..3, then z0..3 and gear angles and motor speeds where hidden effects need them], stepped by the linearly
// implicit second-order ROS2 (Verwer, Spee, Blom, Hundsdorfer 1999), gamma = 1 - 1/sqrt(2), L-stable; Jacobian by differences.
#pragma once

#include "kinds.h"
#include "random.h"

#include <Eigen/Core>
#include <array>

#include <deque>
#include <string_view>
#include <vector>

namespace traction::generator {

enum class Soil { sand, gravel, concrete, loam, snow };
enum class Size { small, medium, large }; // 2.9, 12, 60 kg
// How the ground goes from its stiffness to its strength: as (20), (21) of the sheet say, or by another curve that begins as steeply, of
// y = tanh x; x / (1 + x); sin(1.25 atan(x / 1.25)), Pacejka's with C = 1.25 and D = 1.
enum class Knee { stated, tanh, hyperbola, magic };

// One machine: table I and (17)-(21) of docs/sources.md, then spread by `draw` as real machines are.
struct Machine {
    double mass = 2.88, yaw_inertia = 0.0391; // yaw: a plate of 30 x 27 cm, assumed
    double radius = 0.057, half_base = 0.083, half_track = 0.12, gravity = 9.81;
    double KG = 0.265, ke = 0.265, Ra = 3.24, J = 5e-3;
    double viscous = 1.6e-3, coulomb = 0.03;
    double battery_V = 7.2, battery_ohm = 0.06;             // internal resistance assumed
    double battery_sag_1_s = 1e-4;                          // share of the voltage lost a second: 1.2 % in two minutes, assumed
    double motor_share = 0.9;                               // of J on the motor's side of the gear, assumed
    double tooth_stiffness = 80, tooth_damping = 0.05;      // [N m/rad, N m s] behind the play, assumed
    double current_noise_A = 0.015, current_step_A = 0.002; // of the motor's bridge: about 1 % of the stall current
    Soil soil = Soil::sand;
    Knee knee = Knee::stated;
    double mu = 0, sc = 0, rolling = 0;
    double grip_noise = 0, grip_length = 0.2; // random field, relative rms and correlation length [m]
    // each wheel's share of the value above; 1 where all wheels are alike
    PerWheel KG_each{1, 1, 1, 1}, Ra_each{1, 1, 1, 1}, coulomb_each{1, 1, 1, 1}, viscous_each{1, 1, 1, 1}, radius_each{1, 1, 1, 1};
};

Machine nominal(Soil soil, Size size = Size::small);

// What a quantity of the small rover becomes on another size: by the unit in its name ("torque_Nm", "resistance_ohm", "start_m"), so that
// what is hidden is as large beside the machine as it was. 1 on the small one.
double scale_of(std::string_view name, Size size);
Machine draw(Soil soil, Random &random, Size size = Size::small); // 1-3 % off nominal, as machines of one type are

// How far the wheels of one machine are from each other (standard deviations, relative): magnets and windings of one batch, grease and
// bearings, rims. After issue 12; motor constants of a batch are within 1 to 3 %, resistances within 5 % of the sheet, friction differs
// most.
struct WheelSpread {
    double KG = 0.01, Ra = 0.05, friction = 0.15, radius = 0.002;
};
void draw_apart(Machine &machine, const WheelSpread &spread, Random &random);

// Grip over the ground: a sum of plane waves with Gaussian wave numbers, so Gaussian correlation (spectral method, Shinozuka).
class GroundField {
  public:
    GroundField(double rms, double length_m, Random &random);
    double at(double x_m, double y_m) const; // relative change
  private:
    struct Wave {
        double kx, ky, phase;
    };
    std::vector<Wave> waves_;
    double amplitude_;
};

struct WheelState {
    double angle = 0, motor_angle = 0, current = 0, grip = 1, heat = 0, bristle = 0, load = 0, force = 0;
};

class World {
  public:
    World(const Machine &machine, const Hidden &hidden, Random &random);
    void step(const PerWheel &duty); // 1 ms

    double t = 0, x = 0, y = 0, yaw = 0, path = 0, accel = 0, specific_force = 0, battery = 0;
    std::array<WheelState, wheels> wheel;
    double v() const { return state_[0]; }
    double yaw_rate() const { return state_[1]; }
    double wheel_speed(int i) const { return state_[2 + i]; }
    double motor_speed(int i) const { return backlash_ ? state_[motor_at_ + i] : state_[2 + i]; }

  private:
    struct GustWave {
        double rate, phase;
    };
    using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 18, 1>;
    struct Forces {
        double F, Q, torque, I;
    };
    void rate(const Vector &state, Vector &derivative);
    double friction(int i, double w) const;
    double current(int i, double w) const;
    double shear(double s) const;
    double mass() const { return h_.dropped > 0 && t > h_.dropped_time ? m_.mass * (1 - h_.dropped) : m_.mass; }
    double pushed() const;
    double waves() const;
    double muddy(std::size_t i) const;
    void set_loads();
    void set_grip();
    void integrate_slow(double v_mid, double r_mid);

    Machine m_;
    Hidden h_;
    GroundField field_;
    Vector state_;
    bool relaxed_, backlash_;
    std::vector<GustWave> weather_;
    int slip_at_ = 0, gear_at_ = 0, motor_at_ = 0;
    PerWheel voltage_{}, current_now_{}, radius_{}, KG_{}, ke_{}, Ra_{};
    std::deque<PerWheel> delayed_;
};

} // namespace traction::generator
