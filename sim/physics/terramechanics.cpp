#include "terramechanics.h"

#include "ground.h"
#include "math.h"

#include <array>
#include <cmath>

namespace traction::sim {

namespace {

constexpr double largest_exponent = 1.3; // (3) is an expansion for moderate n: Bekker

// k of (1) for a contact length: r = min(ww, l).
double modulus(const Bekker &soil, const SoilConstants &constants, double width_m, double length_m) {
    return soil.kc == 0 || length_m >= width_m ? constants.k_wide : soil.kc / length_m + soil.kphi;
}

double slipped_exponent(const Bekker &soil, double s) { return soil.n * (1 + soil.slip_sinkage * std::fabs(s)); }

double chord_m(double radius_m, double depth_m) { return std::sqrt(depth_m * (2 * radius_m - depth_m)); }

// What a rut's depth makes of (5), its logarithm taken once for all the powers.
struct OldRut {
    double log_m, power, reload_N_m3, surface_m; // power: rut^n; reload: k_u
};
inline OldRut old_rut(const Bekker &soil, const SoilConstants &constants, double rut_m) {
    const double log_m = math::log(rut_m), power = math::exp(soil.n * log_m);
    const double own = soil.reload_N_m4 * rut_m, least = 2 * constants.k_wide * math::exp((soil.n - 1) * log_m);
    const double reload = own > least ? own : least, surface = rut_m - constants.k_wide * power / reload;
    const bool there = rut_m > 0;
    return {there ? log_m : 0, there ? power : 0, there ? reload : 0, there ? surface : 0};
}

// Bulldozing: only soil that still stands is pushed.
double bulldozing_N(const Bekker &soil, const SoilConstants &constants, double width_m, double z, double rut_m) {
    const double fresh = z > rut_m ? z - rut_m : 0;
    return 0.5 * width_m * soil.weight_N_m3 * fresh * fresh * constants.passive;
}

// power: z^n
double bekker_normal(double width_m, double radius_m, double k, double n, double z, double power) {
    const double n_fit = n < largest_exponent ? n : largest_exponent;
    return width_m * k * std::sqrt(2 * radius_m * z) * power * (3 - n_fit) / 3;
}

} // namespace

SoilConstants soil_constants(const Bekker &soil, double wheel_width_m) {
    const double t = math::tan(math::pi / 4 + soil.phi_rad / 2);
    return {soil.kc / wheel_width_m + soil.kphi, math::tan(soil.phi_rad), t * t};
}

double rut_surface_m(const Bekker &soil, const SoilConstants &constants, double rut_m) { return old_rut(soil, constants, rut_m).surface_m; }

namespace {

// No early return and no branch but choices between two values: in a loop over wheels it is vector code.
inline SoilForce bekker_here(const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel, double sinkage_m, double slip,
                             double rut_m) {
    const double deepest = 0.9 * wheel.radius_m, z = sinkage_m < deepest ? sinkage_m : deepest;
    const OldRut rut = old_rut(soil, constants, rut_m);
    const double surface = rut.surface_m;
    const double n = slipped_exponent(soil, slip);
    const double chord = chord_m(wheel.radius_m, z);
    const double k = modulus(soil, constants, wheel.width_m, chord);
    const double power = math::pow(z, n), rut_power = math::exp(n * rut.log_m);
    const bool old = rut_m > 0, deeper = rut_m < z; // the work up to the old depth is done already
    const double d = z - surface, patch = 2 * std::sqrt(2 * wheel.radius_m * d), shorter = patch < chord ? patch : chord;
    const double length = old ? shorter : chord;
    const double done = wheel.width_m * k * (deeper ? rut_power : power) * (deeper ? rut_m : z) / (n + 1);
    const double compaction = wheel.width_m * k * power * z / (n + 1), left = compaction - done;
    const double share = (z - surface) / (rut_m - surface);
    const double fresh_N = bekker_normal(wheel.width_m, wheel.radius_m, k, n, z, power);
    const double again_N = bekker_normal(wheel.width_m, wheel.radius_m, k, n, rut_m, rut_power) * share * std::sqrt(share);
    const bool there = z > surface;
    const double normal = z >= rut_m ? fresh_N : again_N;
    const double largest = wheel.strength * (length * wheel.width_m * soil.c_Pa + normal * constants.tan_phi);
    const double shear_slip = wheel.shear * soil.K_m / length;
    const double traction = std::copysign(largest * traction_share(TractionLaw::janosi, std::fabs(slip), shear_slip), slip);
    const double resistance =
        (old ? left : compaction) + bulldozing_N(soil, constants, wheel.width_m, z, rut_m) + wheel.hysteresis * normal;
    SoilForce out;
    out.normal_N = there ? normal : 0;
    out.largest_N = there ? largest : 0;
    out.shear_slip = there ? shear_slip : 1;
    out.traction_N = there ? traction : 0;
    out.resistance_N = there ? resistance : 0;
    out.torque_Nm = there ? wheel.radius_m * traction : 0;
    return out;
}

} // namespace

SoilForce bekker_force(const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel, const SoilContact &contact) {
    return bekker_here(soil, constants, wheel, contact.sinkage_m, contact.slip, contact.rut_m);
}

namespace {

inline void four_bekker(const Bekker &of_soil, const SoilConstants &of_wheel, const SoilWheel &all, const FourSoilContacts &contacts,
                        FourSoilForces &__restrict out) {
    const Bekker soil = of_soil; // copies: nothing is loaded in one side of a choice alone
    const SoilConstants constants = of_wheel;
    SoilWheel wheel = all;
    for (std::size_t i = 0; i < 4; ++i) {
        wheel.strength = contacts.strength[i];
        const SoilForce one = bekker_here(soil, constants, wheel, contacts.sinkage_m[i], contacts.slip[i], contacts.rut_m[i]);
        out.normal_N[i] = one.normal_N, out.largest_N[i] = one.largest_N, out.shear_slip[i] = one.shear_slip;
        out.traction_N[i] = one.traction_N, out.resistance_N[i] = one.resistance_N, out.torque_Nm[i] = one.torque_Nm;
    }
}

__attribute__((flatten)) void four_bekker_narrow(const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel,
                                                 const FourSoilContacts &contacts, FourSoilForces &out) {
    four_bekker(soil, constants, wheel, contacts, out);
}
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define TRACTION_WIDE_VECTORS 1
__attribute__((target("avx2"), flatten)) void four_bekker_avx2(const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel,
                                                               const FourSoilContacts &contacts, FourSoilForces &out) {
    four_bekker(soil, constants, wheel, contacts, out);
}
#endif

using FourFunction = void (*)(const Bekker &, const SoilConstants &, const SoilWheel &, const FourSoilContacts &, FourSoilForces &);
FourFunction four_bekker_in([[maybe_unused]] Vectors vectors) {
#ifdef TRACTION_WIDE_VECTORS
    if (vectors != Vectors::narrow) return four_bekker_avx2; // four fill no wider ones
#endif
    return four_bekker_narrow;
}

} // namespace

void bekker_forces_in(Vectors vectors, const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel,
                      const FourSoilContacts &contacts, FourSoilForces &out) {
    four_bekker_in(vectors)(soil, constants, wheel, contacts, out);
}

void bekker_forces(const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel, const FourSoilContacts &contacts,
                   FourSoilForces &out) {
    static const FourFunction widest = four_bekker_in(has(Vectors::avx2) ? Vectors::avx2 : Vectors::narrow);
    widest(soil, constants, wheel, contacts, out);
}

namespace {

using Nodes = std::array<double, arc_nodes>;

// The arc from the entry angle to straight down, cut into equal steps; nodes in their middle.
struct Arc {
    double radius_m, entry_rad, sin_entry, step_rad;
    Nodes angle, cosine, sine;
};

Arc make_arc(double radius_m, double depth_m) {
    Arc arc{};
    arc.radius_m = radius_m;
    arc.sin_entry = chord_m(radius_m, depth_m) / radius_m;
    arc.entry_rad = math::atan2(arc.sin_entry, 1 - depth_m / radius_m);
    arc.step_rad = arc.entry_rad / arc_nodes;
    double c = math::cos(0.5 * arc.step_rad), s = math::sin(0.5 * arc.step_rad); // then by rotation: no polynomial per node
    const double turn_c = c * c - s * s, turn_s = 2 * c * s;
    for (std::size_t i = 0; i < arc_nodes; ++i) {
        arc.angle[i] = (static_cast<double>(i) + 0.5) * arc.step_rad, arc.cosine[i] = c, arc.sine[i] = s;
        const double next = c * turn_c - s * turn_s;
        s = s * turn_c + c * turn_s;
        c = next;
    }
    return arc;
}

// Depth below the original surface whose stress acts at each node: its own in front of the summit, its mirror's behind.
inline void node_depths(const Arc &arc, double summit_rad, double sinkage_m, Nodes &depth) {
    const double behind = (arc.entry_rad - summit_rad) / summit_rad, floor_cos = 1 - sinkage_m / arc.radius_m;
    const double *angle = arc.angle.data(), *cosine = arc.cosine.data();
    for (std::size_t i = 0; i < arc_nodes; ++i) { // series of cos to x^8: 3e-7 at 1 rad
        const double theta = angle[i], own = cosine[i], image = arc.entry_rad - theta * behind, q = image * image;
        const double mirrored = 1 - q * (0.5 - q * (1.0 / 24 - q * (1.0 / 720 - q * (1.0 / 40320))));
        depth[i] = arc.radius_m * ((theta > summit_rad ? own : mirrored) - floor_cos);
    }
}

// tau at a ratio v/(R w).
inline void shear(const Arc &arc, const Nodes &limit_Pa, double ratio, double inverse_K, Nodes &tau) {
    const double *angle = arc.angle.data(), *sine = arc.sine.data(), *limit = limit_Pa.data();
    double *out = tau.data();
    for (std::size_t i = 0; i < arc_nodes; ++i) {
        const double j = arc.radius_m * ((arc.entry_rad - angle[i]) - ratio * (arc.sin_entry - sine[i]));
        out[i] = limit[i] * std::copysign(1 - math::exp(-std::fabs(j) * inverse_K), j);
    }
}

struct Stresses {
    Nodes sigma, tau, free_tau;
};

// What the stresses at the nodes need to know. rut_m, surface_m, reload_Pa_m: (5) up to the old depth, and what the slip and the contact's
// length make of (1) there; beyond it the soil is new. No rut: 0.
struct Pressing {
    double summit_rad, sinkage_m, k, exponent, rut_m, surface_m, reload_Pa_m;
    double strength, cohesion_Pa, tan_phi, ratio, inverse_K;
};

inline void stresses_at(const Arc &arc, const Pressing &p, Stresses &out) {
    Nodes depth, limit;
    node_depths(arc, p.summit_rad, p.sinkage_m, depth);
    for (std::size_t i = 0; i < arc_nodes; ++i) out.sigma[i] = p.k * math::exp(p.exponent * math::log(depth[i]));
    if (p.rut_m > 0)
        for (std::size_t i = 0; i < arc_nodes; ++i) {
            const double sprung = p.reload_Pa_m * (depth[i] - p.surface_m), again = depth[i] > p.surface_m ? sprung : 0;
            const double least = again < out.sigma[i] ? again : out.sigma[i];
            out.sigma[i] = depth[i] >= p.rut_m ? out.sigma[i] : least;
        }
    for (std::size_t i = 0; i < arc_nodes; ++i) limit[i] = p.strength * (p.cohesion_Pa + out.sigma[i] * p.tan_phi);
    shear(arc, limit, p.ratio, p.inverse_K, out.tau);
    shear(arc, limit, 1, p.inverse_K, out.free_tau);
}

// The nodes side by side in the widest vectors that this processor has: the same operations on each, none contracted, so the same bits.
void stresses_narrow(const Arc &arc, const Pressing &p, Stresses &out) { stresses_at(arc, p, out); }
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
__attribute__((target("avx2"), flatten)) void stresses_avx2(const Arc &arc, const Pressing &p, Stresses &out) { stresses_at(arc, p, out); }
__attribute__((target("avx512f,avx512dq,avx512vl,prefer-vector-width=512"), flatten)) void
stresses_avx512(const Arc &arc, const Pressing &p, Stresses &out) {
    stresses_at(arc, p, out);
}
#endif

using StressFunction = void (*)(const Arc &, const Pressing &, Stresses &);
StressFunction stresses_in(Vectors vectors) {
#ifdef TRACTION_WIDE_VECTORS
    if (vectors == Vectors::avx512) return stresses_avx512;
    if (vectors == Vectors::avx2) return stresses_avx2;
#endif
    return vectors == Vectors::narrow ? stresses_narrow : nullptr;
}

StressFunction widest_stresses() {
    for (const Vectors vectors : {Vectors::avx512, Vectors::avx2})
        if (has(vectors)) return stresses_in(vectors);
    return stresses_narrow;
}

struct ArcSum {
    double along = 0, down = 0, total = 0;
};
ArcSum sum_over(const Arc &arc, const Nodes &stress) {
    ArcSum sum;
    for (std::size_t i = 0; i < arc_nodes; ++i) {
        sum.along += stress[i] * arc.cosine[i];
        sum.down += stress[i] * arc.sine[i];
        sum.total += stress[i];
    }
    return sum;
}

} // namespace

bool has([[maybe_unused]] Vectors vectors) {
#ifdef TRACTION_WIDE_VECTORS
    __builtin_cpu_init();
    if (vectors == Vectors::avx512)
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    if (vectors == Vectors::avx2) return __builtin_cpu_supports("avx2");
#endif
    return vectors == Vectors::narrow;
}

namespace {

SoilForce arc_force_by(StressFunction stresses, const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel,
                       const SoilContact &contact) {
    SoilForce out;
    const double r = wheel.radius_m, s = contact.slip;
    const double z = contact.sinkage_m < 0.9 * r ? contact.sinkage_m : 0.9 * r;
    const OldRut rut = old_rut(soil, constants, contact.rut_m);
    const double surface = rut.surface_m;
    if (!(z > surface)) return out;
    const Arc arc = make_arc(r, z - surface);
    const double length = r * arc.sin_entry, k = modulus(soil, constants, wheel.width_m, length);
    const double n = slipped_exponent(soil, s), place = soil.c1 + soil.c2 * std::fabs(s);
    Pressing p{.summit_rad = (place < 0.95 ? place : 0.95) * arc.entry_rad,
               .sinkage_m = z,
               .k = k,
               .exponent = n,
               .rut_m = contact.rut_m,
               .surface_m = surface,
               .reload_Pa_m = 0,
               .strength = wheel.strength,
               .cohesion_Pa = soil.c_Pa,
               .tan_phi = constants.tan_phi,
               .ratio = s >= 0 ? 1 - s : 1 / (1 + (s > -0.99 ? s : -0.99)),
               .inverse_K = 1 / (soil.K_m * wheel.shear)};
    if (contact.rut_m > 0) p.reload_Pa_m = k * math::exp(n * rut.log_m) / (constants.k_wide * rut.power) * rut.reload_N_m3;
    Stresses at;
    stresses(arc, p, at);

    const double area = r * wheel.width_m * arc.step_rad;
    const ArcSum press = sum_over(arc, at.sigma), grip = sum_over(arc, at.tau), free = sum_over(arc, at.free_tau);
    const double normal = area * (press.along + grip.down);
    out.normal_N = normal > 0 ? normal : 0;
    out.traction_N = area * grip.along;
    out.torque_Nm = r * area * grip.total;
    out.free_traction_N = area * free.along;
    out.free_torque_Nm = r * area * free.total;
    out.largest_N = wheel.strength * (length * wheel.width_m * soil.c_Pa + out.normal_N * constants.tan_phi);
    out.shear_slip = wheel.shear * soil.K_m / length;
    out.resistance_N = area * press.down + bulldozing_N(soil, constants, wheel.width_m, z, contact.rut_m) + wheel.hysteresis * out.normal_N;
    return out;
}

} // namespace

SoilForce arc_force(const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel, const SoilContact &contact) {
    static const StressFunction widest = widest_stresses();
    return arc_force_by(widest, soil, constants, wheel, contact);
}

SoilForce arc_force_in(Vectors vectors, const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel,
                       const SoilContact &contact) {
    return arc_force_by(stresses_in(vectors), soil, constants, wheel, contact);
}

double sinkage_under(SoilLawFunction law, const Bekker &soil, const SoilWheel &wheel, double load_N, double slip, double rut_m) {
    const SoilConstants constants = soil_constants(soil, wheel.width_m);
    double low = 0, high = 0.9 * wheel.radius_m;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (law(soil, constants, wheel, {middle, slip, rut_m}).normal_N < load_N ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

} // namespace traction::sim
