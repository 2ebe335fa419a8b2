#include "soil_fit.h"

#include <cmath>

namespace traction {

double soil_curve(SoilCurve curve, double slip, double shear_slip) {
    const double x = std::fabs(slip) / shear_slip;
    double value = 0;
    if (curve == SoilCurve::burckhardt)
        value = -std::expm1(-x);
    else
        value = x < 1e-4 ? x / 2 : 1 + std::expm1(-x) / x;
    return slip < 0 ? -value : value;
}

SoilFit fit_soil(SoilCurve curve, const std::vector<double> &slip, const std::vector<double> &force_N) {
    SoilFit best{.fm_N = 0, .shear_slip = 0, .rms_N = 0, .count = slip.size()};
    if (slip.empty()) return best;
    const auto at = [&](double log_sc) {
        const double sc = std::exp(log_sc);
        double ff = 0, fy = 0, yy = 0;
        for (std::size_t i = 0; i < slip.size(); i++) {
            const double f = soil_curve(curve, slip[i], sc);
            ff += f * f;
            fy += f * force_N[i];
            yy += force_N[i] * force_N[i];
        }
        best.fm_N = ff > 0 ? fy / ff : 0;
        best.shear_slip = sc;
        const double square = yy - best.fm_N * fy;
        best.rms_N = std::sqrt(square > 0 ? square / static_cast<double>(slip.size()) : 0);
        return square;
    };
    // golden section; 0.003 to 3 covers every soil of the library
    double low = std::log(0.003), high = std::log(3.0);
    const double golden = 0.6180339887498949;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = at(a), at_b = at(b);
    for (int i = 0; i < 60; i++) {
        if (at_a < at_b) {
            high = b;
            b = a;
            at_b = at_a;
            a = high - golden * (high - low);
            at_a = at(a);
        } else {
            low = a;
            a = b;
            at_a = at_b;
            b = low + golden * (high - low);
            at_b = at(b);
        }
    }
    at(0.5 * (low + high));
    return best;
}

} // namespace traction
