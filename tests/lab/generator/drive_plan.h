// drive_plan.h - the identification drive of the independent generator: what is asked of each wheel at a time, and the PI that does it.
#pragma once

#include "kinds.h"
#include "random.h"

#include <string>
#include <vector>

namespace traction::generator {

struct Segment {
    enum class Kind { drive, front_sweep, rear_sweep, drag_one, coast } kind = Kind::drive;
    double duration_s = 1;
    double speed_m_s = 0; // wanted platform speed at the end
    double ramp_m_s2 = 1; // how fast the set point moves there
    double yaw_rate_rad_s = 0;
    int wheel = 0; // drag_one: that wheel turns slower
    double drag_share = 0.5;
};

// full: every manoeuvre (120 s); cruise: constant speed; stairs: gentle steps; sweep: slip sweeps alone. Drawn anew each time, as long as
// the log: mixed (every manoeuvre, in any order), stop_and_go, slow, curves, slopes (there and back, turning round between), spins
// (turns alone, most on the spot), shuttle (to and fro without a halt), halt (mixed, and a quarter of the time standing in the middle).
// speed: how much faster than the small rover this machine drives.
std::vector<Segment> make_plan(const std::string &name, double duration_s, Random &random, double speed = 1);

// What the wheel-speed loop needs of the machine; the small rover's.
struct LoopTune {
    double back_emf_Vs_rad = 0.265, duty_per_rad_s = 0.045, duty_per_rad = 0.25;
};

// Wheel-speed PI with back-EMF feed-forward.
class Driver {
  public:
    Driver(std::vector<Segment> plan, double radius_m, double half_track_m, LoopTune tune, double tick_s = 0.01);
    // estimate_m_s: ground speed the operator's station believes (the slip sweeps hold the platform by it).
    PerWheel command(double t_s, const PerWheel &wheel_speed_rad_s, double estimate_m_s, double battery_V);
    const PerWheel &set_speed() const { return set_; }

  private:
    std::vector<Segment> plan_;
    double radius_, half_track_;
    LoopTune tune_;
    double tick_;
    std::size_t index_ = 0;
    double segment_start_ = 0, speed_ = 0;
    PerWheel set_{}, integral_{};
};

} // namespace traction::generator
