#include "parts.h"

namespace traction::sim {

std::vector<Effect> body_effects() {
    using enum ActsOn;
    return {
        {"load_transfer", "A centre of mass higher than thought", load, false, "dFn = -+ M*a*h/(2*wheelbase) on each front/rear wheel",
         "moment balance about the ground, derived here", "When it accelerates, front currents fall and rear currents rise.",
         "Hard starts and stops, both directions. Steady drives show nothing; an offset mass shows all the time.",
         {strength("height_m", "m", "added height of the centre of mass", 0, 0.2, 0.08, 0.01)}},
        {"mass_offset_x", "A load carried fore or aft", load, false, "static Fn shifts: sum Fn*x = M*g*offset",
         "moment balance, derived here", "Front and rear wheels pull unlike shares at all times.",
         "Any drive with slip; reverse to tell it from multi-pass.",
         {strength("offset_m", "m", "centre of mass forward of the platform's centre", -0.06, 0.06, 0.025, 0.003)}},
        {"mass_offset_y", "A load carried to one side", load, false, "static Fn shifts: sum Fn*y = M*g*offset",
         "moment balance, derived here", "Left and right wheels pull unlike shares; the rover veers.",
         "Straight drives with slip, both directions. A weaker motor on one side shows in its own current balance too.",
         {strength("offset_m", "m", "centre of mass left of the platform's centre", -0.06, 0.06, 0.025, 0.003)}},
        {"grade", "A slope nobody noticed", body_force, false, "F_body = -M*g*sin(slope)*cos(yaw - direction)",
         "statics, derived here", "A constant force along one direction of the world; the accelerometer feels it as well.",
         "Drive the same line both ways, and across (d' from 0.1 to 67 by reversing).",
         {strength("slope_rad", "rad", "angle of the rise", -0.3, 0.3, 0.06, 0.005),
          shape("direction_rad", "rad", "world heading of the rise", -3.2, 3.2, 0, {0, 1.5707963267948966})}},
        {"tether_drag", "A cable that pulls back", body_force, false, "F_body = -k*(distance from the start), towards the start",
         "linear spring, derived here", "Pull missing in proportion to the distance from the start, also when driving back.",
         "Drive out, stop, come back: the force helps on the way home.",
         {strength("stiffness_N_m", "N/m", "force per distance", 0, 3, 0.6, 0.05)}},
        {"body_drag", "Something dragged along", body_force, false, "F_body = -F*sgn(v)",
         "Coulomb friction of a dragged object, derived here", "A constant force against the motion, whatever the wheels' load.",
         "Drive both ways at several loads. Rolling resistance scales with load, this does not.",
         {strength("force_N", "N", "drag force", 0, 5, 1.2, 0.1)}},
    };
}

} // namespace traction::sim
