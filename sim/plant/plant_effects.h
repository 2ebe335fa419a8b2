// plant_effects.h - the active effects as numbers the plant computes with, each zero when its effect is absent.
#pragma once

#include "drive.h"

#include "sim/physics/effects/catalogue.h"

#include <array>
#include <vector>

namespace traction::sim {

struct WheelEffects {
    DriveEffects drive;
    double rolling = 0;       // [1]
    double radius_change = 0; // [1]
};

struct BodyEffects {
    double slip_sinkage = 0, speed_resistance_s_m = 0, multi_pass = 0;
    double centre_height_m = 0, offset_x_m = 0, offset_y_m = 0;
    double patch_change = 0, patch_start_m = 0, patch_length_m = 0, gradient_1_m = 0;
    double relaxation_m = 0, sliding_loss_s_m = 0, shear_change = 0, scrub = 0;
    double slope_rad = 0, slope_direction_rad = 0, tether_N_m = 0, drag_N = 0;
};

struct PlantEffects {
    std::array<WheelEffects, 4> wheel;
    BodyEffects body;
};

// Collects the effects that act in the plant; those of the sensors are left to sim/sensors. Several of one kind add up.
PlantEffects collect_effects(const std::vector<ActiveEffect> &effects);

} // namespace traction::sim
