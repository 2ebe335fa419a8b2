// soil_fit.h - fits a traction curve to pairs of slip and force, as section V of Lhomme-Desages does.
//
//   Ft = Fm f(s/sc):  f(x) = 1 - (1 - exp(-|x|))/|x|  (20)   or   f(x) = 1 - exp(-|x|)  (21), odd in s
// Least squares: Fm in closed form for a given sc, sc by golden section over ln sc.
#pragma once

#include <cstddef>
#include <vector>

namespace traction {

enum class SoilCurve { janosi, burckhardt }; // (20), (21)

struct SoilFit {
    double fm_N = 0;
    double shear_slip = 0;
    double rms_N = 0;      // of the residual
    std::size_t count = 0; // pairs used
};

double soil_curve(SoilCurve curve, double slip, double shear_slip); // f, odd in slip

SoilFit fit_soil(SoilCurve curve, const std::vector<double> &slip, const std::vector<double> &force_N);

} // namespace traction
