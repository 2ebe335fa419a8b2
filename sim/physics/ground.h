// ground.h - which soil lies where, its shape, how it slopes, how its grip varies; and the aggregated traction laws.
//
//   Janosi, aggregated:  Ft(s)/Fm = 1 - sc/s * (1 - exp(-s/sc))     (20) Lhomme-Desages, odd in s
//   Burckhardt:          Ft(s)/Fm = 1 - exp(-s/sc)                  (21) Lhomme-Desages, odd in s
#pragma once

#include "math.h"
#include "soil.h"
#include "terrain.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace traction::sim {

// Ft/Fm for s_abs = |s| >= 0 and shear_slip > 0, within 0..1.
inline double traction_share(TractionLaw law, double s_abs, double shear_slip) {
    const double q = s_abs / shear_slip;
    if (law == TractionLaw::burckhardt) return 1 - math::exp(-q);
    if (q < 1e-3) return q * (0.5 - q / 6); // series of 1 - (1 - exp(-q))/q; the next term is below 4e-11
    return 1 - (1 - math::exp(-q)) / q;
}

// How wheel and ground meet.
enum class ContactLaw {
    aggregated, // (20) or (21) with Rr = coefficient * Fn on an almost rigid surface: what the paper identifies
    bekker,     // closed form: sinkage from load and slip, (5) with the contact length of that sinkage, Rr by (3)
    arc         // Wong-Reece stresses integrated over the contact arc (terramechanics.h)
};

// A region of other soil, in world coordinates.
struct SoilPatch {
    double x_min_m = 0, x_max_m = 0, y_min_m = -1e9, y_max_m = 1e9;
    Soil soil;
};

// From path_m on the ground rises by slope_rad.
struct SlopeStep {
    double path_m = 0, slope_rad = 0;
};

// The cell of the grip's noise where one asked last, and what its corners hold: who goes on from there asks the lattice seldom.
struct GripCell {
    double i = std::numeric_limits<double>::quiet_NaN(), j = i;
    double corner[4]{}; // (i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)
    void go_to(double i_now, double j_now, std::uint64_t seed);
};

struct Ground {
    Soil soil;                                   // where no patch lies
    std::vector<SoilPatch> patches;              // the last that covers a place wins
    ContactLaw contact = ContactLaw::aggregated; // of every soil that has Bekker parameters; the others stay aggregated
    double slope_rad = 0;                        // the ground rises ...
    double slope_direction_rad = 0;              // ... towards this world heading
    std::vector<SlopeStep> slope_steps;          // along the path: the rise from each place on, instead of slope_rad
    double slope_blend_m = 0.1;                  // over which one rise goes over into the next
    Terrain terrain;                             // what stands up from the plane that slopes; flat: nothing
    double grip_noise = 0;                       // relative rms of the grip over the ground [1]; 0.06 on soil, 0.02 on concrete (assumed)
    double grip_length_m = 0.2;                  // its correlation length: lattice step of the noise
    std::uint64_t seed = 1;                      // of the grip noise, and with it of the terrain's roughness

    double gradient_1_m = 0; // grip times (1 + gradient * distance along its direction)
    double gradient_direction_rad = 0;

    const Soil &at(double x_m, double y_m) const;
    // The rise where the rover has come to, path_m along its way: slope_rad, or the steps' with a straight blend before each.
    double slope_here_rad(double path_m) const;
    // Relative change of the grip at a place: value noise, deterministic, rms grip_noise.
    double grip_change(double x_m, double y_m, GripCell &last) const;
};

// ---- inline: what every wheel of every step calls, and in several wheels side by side becomes vector code (sim/plant/abreast.cpp)
namespace detail {

// |x| < 2^51. In additions: std::floor is a call without SSE4.1.
inline double floor(double x) {
    constexpr double round_by = 6755399441055744.0; // 1.5 * 2^52
    const double near = (x + round_by) - round_by;
    return near > x ? near - 1 : near;
}

inline double smooth(double u) { return u * u * u * (u * (u * 6 - 15) + 10); }

// (u, v): the place within its cell.
inline double grip_between(double u, double v, double low_left, double low_right, double high_left, double high_right, double trend,
                           double grip_noise) {
    const double a = smooth(u), b = smooth(v);
    const double low = low_left * (1 - a) + low_right * a;
    const double high = high_left * (1 - a) + high_right * a;
    // Uniform -1..1 has variance 1/3; the quintic weights keep 0.78355 of it per dimension (the mean of (1-a)^2 + a^2).
    constexpr double scale = 1.7320508075688772 / 0.78355; // makes the rms 1
    const double change = trend + grip_noise * scale * (low * (1 - b) + high * b);
    return change > -0.95 ? change : -0.95;
}

} // namespace detail

} // namespace traction::sim
