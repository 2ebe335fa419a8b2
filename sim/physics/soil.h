// soil.h - what the ground is: the numbers of the traction laws and, where known, of full terramechanics; and the soil library.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace traction::sim {

enum class TractionLaw {
    janosi,    // (20) Lhomme-Desages: soft ground
    burckhardt // (21) Lhomme-Desages: hard ground
};

// Parameters of pressure-sinkage and shear, SI: p = (kc/b + kphi) z^n, tau = (c + p tan phi)(1 - exp(-j/K)).
struct Bekker {
    double kc = 0;               // [N/m^(n+1)]
    double kphi = 0;             // [N/m^(n+2)]
    double n = 1;                // [1] sinkage exponent
    double c_Pa = 0;             // cohesion
    double phi_rad = 0;          // angle of internal friction
    double K_m = 0.02;           // shear deformation modulus
    double weight_N_m3 = 0;      // bulk density times gravity
    double c1 = 0.18, c2 = 0.32; // [1] place of the largest stress, theta_m = (c1 + c2 s) theta_1 (Wong-Reece 1967, compact sand)
    double slip_sinkage = 0;     // [1] sinkage exponent grows with slip: n(1 + slip_sinkage*|s|)
    double reload_N_m4 = 0;      // a second pass: dp/dz = reload * (depth reached before), Wong
};

struct Soil {
    std::string name;
    TractionLaw law = TractionLaw::burckhardt;
    double adhesion_N = 0;            // Fm = adhesion + fm_per_fn * Fn
    double fm_per_fn = 0.8;           // [1]
    double shear_slip = 0.05;         // sc [1]
    double rolling_coefficient = 0;   // Rr = coefficient * Fn [1]
    double lateral_coefficient = 0.8; // largest lateral force = coefficient * Fn [1]
    std::optional<Bekker> bekker;     // none: the ground has no sinkage (contact law `aggregated` only)
    std::string source;               // of every number above
};

// concrete, gravel, sand, dry_sand_literature, loam, snow, lunar_simulant.
std::span<const Soil> soil_library();
const Soil *find_soil(std::string_view name); // or nullptr

} // namespace traction::sim
