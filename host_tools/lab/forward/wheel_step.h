// wheel_step.h - the wheels of one time step: loads, slip, traction, resistance of each, at a body velocity that is being sought.
//
// Slip (1), traction (20) janosi or (21) burckhardt, combined slip sideways; the catalogue's ground and wheel effects and the user's
// terms act here. Loads: the least-norm solution of sum Fn = W, sum Fn x = W ox - M a h, sum Fn y = W oy - M ay h
// (ay = v r, planar motion). Halves on a joint: each half's own pull F tips it, sum over the half Fn x = W ox / 2 - F h.
#pragma once

#include "host_tools/lab/inputs/dataset.h"
#include "physics.h"
#include "wheel_laws.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>

namespace traction::lab {

inline constexpr std::size_t most_wheels = 32;

class WheelStep {
  public:
    WheelStep(const Dataset &data, const Physics &physics);

    // Prepares time index k from the state at the step before: wheels first to last - 1, the others are left as they are. away: of the
    // way from the start, the part along the heading.
    void prepare(std::size_t k, double v_before, double accel_before, double path_m, double away_m, std::size_t first = 0,
                 std::size_t last = most_wheels);

    // What wheel i contributes to (Fx, Fy, Mz) at body velocity q = (vx, vy, yaw rate). Its state() is then that of q.
    Eigen::Vector3d force(std::size_t i, const Eigen::Vector3d &q);
    // All wheels at once: their sum, and in `each`, if given, what every one contributes.
    Eigen::Vector3d forces(const Eigen::Vector3d &q, std::array<Eigen::Vector3d, most_wheels> *each);
    // Moves the state of wheel i by a small change of q, to first order; rolling and side are left. The caller knows the traction's change.
    void nudge(std::size_t i, const Eigen::Vector3d &change, double traction_N);
    double body_force(double v) const;   // along the velocity: drag, tether, the user's
    Eigen::Vector2d grade_accel() const; // of the slope: forward, left
    void commit();                       // the step is found: slip and play become the next step's memory
    // s' of (2) of wheel_laws.h, along and across.
    void remember(std::size_t i, double slip, double side_slip) {
        state_[i].slip_before = slip, four_[i / 4].slip_before.set(i % 4, slip);
        state_[i].side_slip_before = side_slip, four_[i / 4].side_slip_before.set(i % 4, side_slip);
    }

    // Where the chassis is two halves: what turns one against the other, half the difference of their pulls a step before.
    void remember_twist(double twist_N) { twist_ = twist_N; }
    double twist() const { return twist_; }

    struct State {
        double x = 0, y = 0; // place from the centre of mass (longitudinal motion: from the middle)
        double arm_m = 0;    // to the left of the centre of mass: about it forces turn the body, however that moves
        double c = 1, s = 0, radius = 0, gain = 1, sigma = 0, order = 0, lag_1_m = 0, plain_sc = 0.1, load_0 = 0, load_per_accel = 0,
               load_per_side = 0, load_per_twist = 0;
        double mu = 0, adhesion = 0, rolling_coefficient = 0, lateral = 0; // of the ground it stands on
        double rim = 0, w = 0, theta = 0, travel = 0, load = 0, Fm = 0, sc = 0.1, resistance_here = 0;
        double slip_before = 0, side_slip_before = 0, play_before = 0; // of slips: s' of (2) of wheel_laws.h
        double last_slip = 0, last_side_slip = 0;                      // as the last step left them
        double v = 0, side_v = 0, slip = 0, side_slip = 0, play = 0, traction = 0, rolling = 0, side = 0;
        bool free = false; // its rim is as fast as it moves over the ground
    };
    const State &state(std::size_t i) const { return state_[i]; }
    // Back to a state of the same step that was had before, its memory left alone.
    void restore(std::size_t i, const State &s) {
        State &to = state_[i];
        to.load = s.load, to.v = s.v, to.side_v = s.side_v, to.slip = s.slip, to.side_slip = s.side_slip, to.play = s.play;
        to.traction = s.traction, to.rolling = s.rolling, to.side = s.side;
        if (to.free) to.rim = s.v;
    }
    std::size_t wheels() const { return n_; }
    bool widen(bool wide); // vectors as wide as four numbers, or not: the same bits; what was chosen, for the processor may have none
    double order(std::size_t i) const { return state_[i].order; }  // (7) of wheel_laws.h
    bool lags(std::size_t i) const { return state_[i].sigma > 0; } // its slips are carried from step to step: a relaxation length
    bool has_play() const { return play_; }
    bool has_terms() const { return motion_terms_; }
    bool feels_path() const { return feels_path_; } // some force depends on the path travelled

  private:
    // Four wheels side by side; where there are fewer, the last carry nothing.
    struct Four {
        Lane c = Lane(1.0), s = Lane(0.0), x = Lane(0.0), y = Lane(0.0), arm_m = Lane(0.0), grip = Lane(0.0), resistance = Lane(0.0),
             resistance_here = Lane(0.0), lateral = Lane(0.0);
        sim::WheelEffectsOf<Lane> effects;
        Lane per_sc = Lane(1.0), curve = Lane(0.0), lag_1_m = Lane(0.0), slip_before = Lane(0.0), side_slip_before = Lane(0.0);
        Lane per_speed_m = Lane(0.0), adhesion = Lane(0.0), mu = Lane(0.0), load_0 = Lane(0.0), load_per_accel = Lane(0.0),
             load_per_side = Lane(0.0), load_per_twist = Lane(0.0), reversal = Lane(1.0);
        Lane rim = Lane(0.0), load = Lane(0.0), Fm = Lane(0.0);
        Lane v, slip, side_slip, traction, rolling, side;
    };
    using Each = std::array<Eigen::Vector3d, most_wheels>;
    void gather();
    void stand_on(const RunPhysics *run); // the ground of that run; nullptr: the machine's
    // Where nothing asks for each wheel by itself; of the widest vectors that the processor has.
    [[gnu::always_inline]] inline void contact_of(Four &four, const Lane &v, const Lane &side_v) const;
    [[gnu::always_inline]] inline Eigen::Vector3d plain_forces(const Eigen::Vector3d &q, Each *each);
    Eigen::Vector3d narrow_forces(const Eigen::Vector3d &q, Each *each);
    Eigen::Vector3d wide_forces(const Eigen::Vector3d &q, Each *each);
    void prepare_wheel(std::size_t i, std::size_t k, double v_before);
    void prepare_four(std::size_t g, std::size_t k, double v_before);
    double strength(std::size_t i, double v_before) const;
    double pull(std::size_t i, double v, double body_v, double side_v);
    double slip_at(const State &s, double v) const;
    double side_slip_at(const State &s, double v, double side_v) const;
    double contact(std::size_t i, double v);
    void terms(std::size_t i, double v, double body_v, double &Fm, double &sc, double &extra, double &rolling) const;
    double load(std::size_t i) const; // without a measured load
    void lag_at(std::size_t k);       // lag_1_m of step k; from 2 on it stays
    void loads();
    void followers();

    const Dataset &data_;
    const Physics &p_;
    std::size_t n_;
    std::array<State, most_wheels> state_{};
    std::array<double, most_wheels> ahead_{}, behind_{};
    std::size_t k_ = 0;
    std::size_t lag_step_ = 0;
    double t_ = 0, path_ = 0, away_ = 0, accel_ = 0, side_accel_ = 0, twist_ = 0, yaw_ = 0, yaw_rate_ = 0;
    std::array<Four, most_wheels / 4> four_;
    bool sideways_ = false;           // the body moves sideways as the forces have it, on wheels that grip
    bool wide_ = false;               // the processor has vectors as wide as four numbers
    bool plain_ = false;              // the wheels' forces need no more than `four_`
    bool even_ = false;               // the ground is as strong everywhere
    bool reverses_ = false;           // resistance reverses over a speed of its own
    const RunPhysics *run_ = nullptr; // whose ground it stands on
    bool grounds_ = false;            // some run has a ground of its own
    bool motion_terms_ = false, play_ = false, lags_ = false, feels_path_ = false;
};

} // namespace traction::lab
