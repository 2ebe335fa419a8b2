#include "soil.h"

#include "math.h"

#include <array>
#include <stdexcept>

namespace traction::sim {

namespace {

constexpr double degree = math::pi / 180;

// Adhesion and friction of (5) for the rover's wheel: l = 4 cm (docs/sources.md section 2), ww = 42 mm (table I); sc = K/l.
Soil from_bekker(std::string name, const Bekker &bekker, double rolling, std::string source) {
    constexpr double contact_length_m = 0.04, wheel_width_m = 0.042;
    Soil soil;
    soil.name = std::move(name);
    soil.law = TractionLaw::janosi;
    soil.adhesion_N = contact_length_m * wheel_width_m * bekker.c_Pa;
    soil.fm_per_fn = math::tan(bekker.phi_rad);
    soil.shear_slip = bekker.K_m / contact_length_m;
    soil.rolling_coefficient = rolling;
    soil.lateral_coefficient = soil.fm_per_fn;
    soil.bekker = bekker;
    soil.source = std::move(source);
    return soil;
}

Bekker table_iii_ground(double kphi, double n, double c_Pa, double phi_deg, double K_m) {
    Bekker b;
    b.kphi = kphi, b.n = n, b.c_Pa = c_Pa, b.phi_rad = phi_deg * degree, b.K_m = K_m;
    b.weight_N_m3 = 15000, b.reload_N_m4 = 5.03e8, b.slip_sinkage = 0.1;
    return b;
}

Soil concrete() {
    return {"concrete",
            TractionLaw::burckhardt,
            0,
            0.8,
            0.05,
            0.01,
            0.8,
            std::nullopt,
            "mu: (21) Lhomme-Desages, Fm = 5.6 N at Fn = 7 N; shear_slip, rolling, lateral: assumed"};
}

Soil gravel() {
    return {"gravel",
            TractionLaw::janosi,
            0,
            6.8 / 7,
            0.088,
            0.03,
            0.8,
            table_iii_ground(5e6, 1.0, 0, 44.17, 0.0035),
            "Fm, sc: table III Lhomme-Desages at Fn = 7 N; rolling, lateral: assumed; Bekker: phi = atan(Fm/Fn), K = sc * 4 cm, "
            "the rest assumed"};
}

Soil sand() {
    return {"sand",
            TractionLaw::janosi,
            0,
            5.1 / 7,
            0.27,
            0.05,
            0.6,
            table_iii_ground(1.528e6, 1.1, 0, 36.08, 0.0108),
            "Fm, sc: table III Lhomme-Desages at Fn = 7 N; rolling, lateral: assumed; Bekker: phi = atan(Fm/Fn), K = sc * 4 cm, "
            "kphi and n of dry sand (Land Locomotion Laboratory, in Wong, Theory of Ground Vehicles), the rest assumed"};
}

Soil dry_sand() {
    Bekker b;
    b.kc = 990, b.kphi = 1528430, b.n = 1.1, b.c_Pa = 1040, b.phi_rad = 28 * degree, b.K_m = 0.02;
    b.weight_N_m3 = 15000, b.reload_N_m4 = 5.03e8, b.slip_sinkage = 0.1;
    return from_bekker(
        "dry_sand_literature", b, 0.05,
        "c, phi, K: docs/sources.md section 2 (Bekker/Wong); kc, kphi, n: dry sand, Land Locomotion Laboratory, in Wong, Theory of "
        "Ground Vehicles; weight, reload, slip_sinkage, rolling: assumed");
}

Soil loam() {
    Bekker b;
    b.kc = 5270, b.kphi = 1515040, b.n = 0.7, b.c_Pa = 1720, b.phi_rad = 29 * degree, b.K_m = 0.01;
    b.c1 = 0.43, b.weight_N_m3 = 16000, b.reload_N_m4 = 5.03e8, b.slip_sinkage = 0.1;
    return from_bekker("loam", b, 0.06,
                       "kc, kphi, n, c, phi: sandy loam at 15 % moisture, Land Locomotion Laboratory, in Wong, Theory of Ground Vehicles; "
                       "K, c1, weight, reload, slip_sinkage, rolling: assumed");
}

Soil snow() {
    Bekker b;
    b.kphi = 1e7, b.n = 1.44, b.c_Pa = 1000, b.phi_rad = 19.7 * degree, b.K_m = 0.015;
    b.weight_N_m3 = 3500, b.reload_N_m4 = 2e8, b.slip_sinkage = 0.1;
    return from_bekker("snow", b, 0.10,
                       "packed snow: phi and n in the range of Wong, Theory of Ground Vehicles (fresh snow of that table would bog a 7 N "
                       "wheel); every value assumed");
}

Soil lunar() {
    Bekker b;
    b.kc = 1400, b.kphi = 820000, b.n = 1.0, b.c_Pa = 170, b.phi_rad = 35 * degree, b.K_m = 0.0178;
    b.weight_N_m3 = 16700, b.reload_N_m4 = 5.03e8, b.slip_sinkage = 0.1;
    return from_bekker("lunar_simulant", b, 0.06,
                       "kc, kphi, n, c, phi, K: recommended lunar soil, Lunar Sourcebook (Heiken, Vaniman, French 1991) chapter 9; weight "
                       "at 1700 kg/m^3 under Earth's gravity; reload, slip_sinkage, rolling: assumed");
}

} // namespace

std::span<const Soil> soil_library() {
    static const std::array<Soil, 7> all{concrete(), gravel(), sand(), dry_sand(), loam(), snow(), lunar()};
    return all;
}

const Soil *find_soil(std::string_view name) {
    for (const Soil &soil : soil_library())
        if (soil.name == name) return &soil;
    return nullptr;
}

} // namespace traction::sim
