#include "terramechanics.h"

#include "math.h"
#include "ground.h"

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

struct Arc {
    double k, n, depth_m, surface_m, reload_N_m3; // stress below the original surface; reload 0: fresh soil
};

// sigma at the depth of a node, z >= 0 below the original surface.
double stress_Pa(const Arc &arc, double z) {
    const double fresh = arc.k * math::pow(z, arc.n);
    if (arc.reload_N_m3 <= 0) return fresh;
    const double again = z > arc.surface_m ? arc.reload_N_m3 * (z - arc.surface_m) : 0;
    return again < fresh ? again : fresh;
}

} // namespace

SoilConstants soil_constants(const Bekker &soil, double wheel_width_m) {
    const double t = math::tan(math::pi / 4 + soil.phi_rad / 2);
    return {soil.kc / wheel_width_m + soil.kphi, math::tan(soil.phi_rad), t * t};
}

double rut_surface_m(const Bekker &soil, const SoilConstants &constants, double rut_m) {
    if (rut_m <= 0 || soil.reload_N_m4 <= 0) return 0;
    const double rebound = constants.k_wide * math::pow(rut_m, soil.n) / (soil.reload_N_m4 * rut_m);
    return rebound < rut_m ? rut_m - rebound : 0;
}

SoilForce bekker_force(const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel, const SoilContact &contact) {
    SoilForce out;
    const double z = contact.sinkage_m < 0.9 * wheel.radius_m ? contact.sinkage_m : 0.9 * wheel.radius_m;
    if (!(z > 0)) return out;
    const double n = slipped_exponent(soil, contact.slip), n_fit = n < largest_exponent ? n : largest_exponent;
    double length = chord_m(wheel.radius_m, z);
    const double k = modulus(soil, constants, wheel.width_m, length);
    const double power = math::pow(z, n);
    double normal = wheel.width_m * k * std::sqrt(2 * wheel.radius_m * z) * power * (3 - n_fit) / 3;
    double compaction = wheel.width_m * k * power * z / (n + 1);
    if (contact.rut_m > 0 && soil.reload_N_m4 > 0) {
        const double surface = rut_surface_m(soil, constants, contact.rut_m), d = z - surface;
        if (d <= 0) return out;
        // elastic bed, both sides of the lowest point: integral of k_u (d - x^2/2R) over |x| < sqrt(2Rd)
        const double half = std::sqrt(2 * wheel.radius_m * d);
        const double again = wheel.width_m * soil.reload_N_m4 * contact.rut_m * d * half * (4.0 / 3);
        if (again < normal) {
            normal = again;
            length = 2 * half < length ? 2 * half : length;
        }
        const double before = contact.rut_m < z ? contact.rut_m : z; // the work up to the old depth is done already
        compaction -= wheel.width_m * k * math::pow(before, n + 1) / (n + 1);
    }
    out.normal_N = normal;
    out.largest_N = wheel.strength * (length * wheel.width_m * soil.c_Pa + normal * constants.tan_phi);
    out.shear_slip = wheel.shear * soil.K_m / length;
    out.traction_N = out.largest_N * std::copysign(traction_share(TractionLaw::janosi, std::fabs(contact.slip), out.shear_slip), contact.slip);
    const double fresh_depth = z > contact.rut_m ? z - contact.rut_m : 0; // only soil that still stands is pushed
    const double bulldozing = 0.5 * wheel.width_m * soil.weight_N_m3 * fresh_depth * fresh_depth * constants.passive;
    out.resistance_N = (compaction > 0 ? compaction : 0) + bulldozing + wheel.hysteresis * normal;
    out.torque_Nm = wheel.radius_m * out.traction_N;
    return out;
}

SoilForce arc_force(const Bekker &soil, const SoilConstants &constants, const SoilWheel &wheel, const SoilContact &contact) {
    SoilForce out;
    const double r = wheel.radius_m;
    const double z = contact.sinkage_m < 0.9 * r ? contact.sinkage_m : 0.9 * r;
    const bool rolled = contact.rut_m > 0 && soil.reload_N_m4 > 0;
    const double surface = rolled ? rut_surface_m(soil, constants, contact.rut_m) : 0;
    if (!(z > surface)) return out;

    const double cos_entry = 1 - (z - surface) / r; // where the wheel meets the soil, counted from straight down
    const double sin_entry = chord_m(r, z - surface) / r;
    const double entry = math::atan2(sin_entry, cos_entry);
    const double s = contact.slip, size = std::fabs(s);
    const double share = soil.c1 + soil.c2 * size;
    const double summit = (share < 0.95 ? share : 0.95) * entry; // theta_m
    const double ratio = s >= 0 ? 1 - s : 1 / (1 + (s > -0.99 ? s : -0.99)); // v/(R w)
    const double length = r * sin_entry;
    const Arc arc{modulus(soil, constants, wheel.width_m, length), slipped_exponent(soil, s), z, surface,
                  rolled ? soil.reload_N_m4 * contact.rut_m : 0};
    const double step = entry / arc_nodes, inverse_K = 1 / (soil.K_m * wheel.shear);
    const double behind = (entry - summit) / summit;

    std::array<double, arc_nodes> sine, cosine, mirrored_cosine, sigma, tau;
    // cos and sin of theta_i = (i + 1/2) step by rotation: no polynomial per node
    double c = math::cos(0.5 * step), d = math::sin(0.5 * step);
    const double turn_c = c * c - d * d, turn_s = 2 * c * d;
    for (std::size_t i = 0; i < arc_nodes; ++i) {
        cosine[i] = c, sine[i] = d;
        const double next = c * turn_c - d * turn_s;
        d = d * turn_c + c * turn_s;
        c = next;
    }
    for (std::size_t i = 0; i < arc_nodes; ++i) { // series of cos to x^8: < 1e-7 of the stress for entry angles below 1 rad
        const double theta = (static_cast<double>(i) + 0.5) * step;
        const double image = entry - theta * behind, q = image * image;
        const double shown = 1 - q * (0.5 - q * (1.0 / 24 - q * (1.0 / 720 - q * (1.0 / 40320))));
        mirrored_cosine[i] = theta > summit ? cosine[i] : shown;
    }
    const double floor_cos = 1 - z / r;
    for (std::size_t i = 0; i < arc_nodes; ++i) {
        const double depth = r * (mirrored_cosine[i] - floor_cos);
        sigma[i] = arc.k * math::exp(arc.n * math::log(depth));
    }
    if (rolled)
        for (std::size_t i = 0; i < arc_nodes; ++i) sigma[i] = stress_Pa(arc, r * (mirrored_cosine[i] - floor_cos));
    for (std::size_t i = 0; i < arc_nodes; ++i) {
        const double theta = (static_cast<double>(i) + 0.5) * step;
        const double j = r * ((entry - theta) - ratio * (sin_entry - sine[i]));
        const double grip = 1 - math::exp(-std::fabs(j) * inverse_K);
        tau[i] = wheel.strength * (soil.c_Pa + sigma[i] * constants.tan_phi) * std::copysign(grip, j);
    }
    double normal = 0, pull = 0, push = 0, twist = 0;
    for (std::size_t i = 0; i < arc_nodes; ++i) {
        normal += sigma[i] * cosine[i] + tau[i] * sine[i];
        pull += tau[i] * cosine[i];
        push += sigma[i] * sine[i];
        twist += tau[i];
    }
    const double area = r * wheel.width_m * step;
    out.normal_N = area * normal > 0 ? area * normal : 0;
    out.traction_N = area * pull;
    out.torque_Nm = r * area * twist;
    out.largest_N = wheel.strength * (length * wheel.width_m * soil.c_Pa + out.normal_N * constants.tan_phi);
    out.shear_slip = wheel.shear * soil.K_m / length;
    const double fresh_depth = z > contact.rut_m ? z - contact.rut_m : 0;
    const double bulldozing = 0.5 * wheel.width_m * soil.weight_N_m3 * fresh_depth * fresh_depth * constants.passive;
    out.resistance_N = area * push + bulldozing + wheel.hysteresis * out.normal_N;
    return out;
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
