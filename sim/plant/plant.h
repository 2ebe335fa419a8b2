// plant.h - the simulated rover: two ODE chassis halves on a revolute joint, its wheels on soil (layout.h), stepped by 1 ms.
//
// Semi-implicit Euler of first order: drive trains and slip states first, then forces on the halves, then dWorldStep. Wheel
// spin is integrated outside ODE (the reflected inertia would otherwise add false gyroscopic loads). Deterministic: the same
// configuration and the same calls give the same bytes.
#pragma once

#include "drive.h"
#include "layout.h"
#include "truth.h"

#include "sim/physics/effects/catalogue.h"
#include "sim/physics/ground.h"

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

namespace traction::sim {

// docs/sources.md section 3 (table I Lhomme-Desages) unless said otherwise.
struct RoverParameters {
    double mass_kg = 2.88, length_m = 0.30, width_m = 0.27, height_m = 0.185;
    double half_wheelbase_m = 0.083, half_track_m = 0.12;
    double wheel_radius_m = 0.057;
    double wheel_mass_kg = 0.150;        // for the reaction of the wheel's own inertia on the chassis
    double centre_height_m = 0;          // of the centre of mass over the ground; 0 as in the paper, which keeps Fn constant:
                                         // the effect load_transfer raises it
    double contact_stiffness_N_m = 6000; // vertical, per wheel: 1.2 mm under 7 N, assumed for a foam-filled tyre
    double contact_damping_Ns_m = 60;    // vertical, per wheel, assumed: half of critical (2 sqrt(6000 N/m 0.72 kg) = 131)
    double relaxation_length_m = 0.005;  // of the slip state, assumed: an eighth of the contact length
    DriveParameters drive;
    double battery_voltage_V = 7.2;       // open circuit, assumed
    double battery_resistance_ohm = 0.06; // assumed
    double battery_fade_V_C = 0;          // fall of the open-circuit voltage per coulomb: 0 is a supply, 5e-5 six small cells (assumed)
    double wheel_width_m = 0.042;         // table I; soft contact only
    double tyre_hysteresis = 0.005;       // Rh/Fn of (3), soft contact only, assumed: a nearly rigid tyre
    double gravity_m_s2 = 9.81;
    LayoutParameters layout;
    bool operator==(const RoverParameters &) const = default;
};

struct PlantConfig {
    RoverParameters rover;
    Ground ground;
    std::vector<ActiveEffect> effects; // those that act in a sensor are ignored here
    double x_m = 0, y_m = 0, yaw_rad = 0;
    double speed_m_s = 0; // initial, along the heading, wheels rolling without slip
    double dt_s = 0.001;
    bool audit = true; // keep Energy; without it a step is quicker, and no other number differs
};

// Energy since the start [J], with PlantConfig::audit; the balance is supplied = kinetic + potential + the losses. For audits.
struct Energy {
    double motor = 0;     // KG*I*w into the drive trains
    double friction = 0;  // lost in gears and bearings
    double slip = 0;      // lost (and elastically stored) in the contact patches
    double rolling = 0;   // lost in rolling resistance
    double body = 0;      // taken by body forces (drag, tether), lateral scrub and the vertical contact
    double kinetic = 0;   // now: bodies and wheels
    double potential = 0; // now, against the start
};

class Plant {
  public:
    explicit Plant(const PlantConfig &config); // throws std::runtime_error when ODE is not the double-precision build
    ~Plant();
    Plant(const Plant &) = delete;
    Plant &operator=(const Plant &) = delete;

    void set_duty(int wheel, double duty);    // of a slot of layout.h; clamped to -1..1; NaN counts as 0
    void set_curvature(double curvature_1_m); // the steering servo's order: steering.h; nothing where no wheel steers
    void set_enabled(bool enabled);           // false releases all bridges: no current
    void block_wheel(int wheel, bool blocked);
    void open_motor(int wheel, bool open); // a broken wire, or a bridge that let go: no current in this winding
    void sag_supply(double sag_V);         // the battery gives so much less than it should
    void step();                           // advances by dt_s

    const Truth &truth() const;
    const Truth &truth_of_body() const; // the same but for roll_rad, and of the wheels current_A alone is of this step
    const Energy &energy() const;
    std::uint64_t state_hash() const; // of every state variable's bits

  private:
    struct World;
    std::unique_ptr<World> world_;
};

} // namespace traction::sim
