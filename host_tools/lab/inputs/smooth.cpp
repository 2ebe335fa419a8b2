#include "smooth.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace traction::lab {

namespace {

// Weighted least squares of a polynomial of degree <= 3 about x = 0, from its moments; degrades to a lower degree when singular.
void solve_local(const double (&s)[7], const double (&r)[4], int degree, double &value, double &slope) {
    if (degree >= 3) {
        Eigen::Matrix4d S;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) S(i, j) = s[i + j];
        const Eigen::LDLT<Eigen::Matrix4d> factor(S);
        if (factor.vectorD().minCoeff() > 1e-9 * s[0]) {
            const Eigen::Vector4d c = factor.solve(Eigen::Vector4d(r[0], r[1], r[2], r[3]));
            value = c[0];
            slope = c[1];
            return;
        }
    }
    if (degree >= 2) {
        const double det = s[0] * (s[2] * s[4] - s[3] * s[3]) - s[1] * (s[1] * s[4] - s[3] * s[2]) + s[2] * (s[1] * s[3] - s[2] * s[2]);
        if (det > 1e-12 * s[0] * s[0] * s[0]) {
            value = (r[0] * (s[2] * s[4] - s[3] * s[3]) - s[1] * (r[1] * s[4] - s[3] * r[2]) + s[2] * (r[1] * s[3] - s[2] * r[2])) / det;
            slope = (s[0] * (r[1] * s[4] - r[2] * s[3]) - r[0] * (s[1] * s[4] - s[3] * s[2]) + s[2] * (s[1] * r[2] - r[1] * s[2])) / det;
            return;
        }
    }
    const double det = s[0] * s[2] - s[1] * s[1];
    if (det > 1e-12 * s[0] * s[0]) {
        value = (r[0] * s[2] - s[1] * r[1]) / det;
        slope = (s[0] * r[1] - s[1] * r[0]) / det;
        return;
    }
    value = s[0] > 0 ? r[0] / s[0] : 0;
    slope = 0;
}

// What is white in the samples while the wheel turns, by the covariance -sigma^2 of neighbouring deviations from the straight line
// through a sample's neighbours; an acceleration makes that covariance positive. `speed`: its median.
double angle_scatter(const std::vector<double> &t, const std::vector<double> &angle, double period, double still, double &speed) {
    std::vector<double> deviation, size, moving;
    for (std::size_t j = 1; j + 1 < angle.size(); ++j) {
        const double span = t[j + 1] - t[j - 1], mean = (angle[j + 1] - angle[j - 1]) / span;
        deviation.push_back(std::numeric_limits<double>::quiet_NaN());
        if (!(span < 4 * period) || !(std::fabs(mean) > still)) continue;
        deviation.back() = angle[j] - angle[j - 1] - mean * (t[j] - t[j - 1]);
        size.push_back(std::fabs(deviation.back()));
        moving.push_back(std::fabs(mean));
    }
    if (moving.size() < 50) return 0;
    speed = median(moving);
    const auto most_of = static_cast<std::ptrdiff_t>(size.size() * 4 / 5);
    std::nth_element(size.begin(), size.begin() + most_of, size.end());
    const double most = 4 * size[static_cast<std::size_t>(most_of)]; // a counter's reset is no scatter
    double sum = 0, n = 0;
    for (std::size_t j = 0; j + 1 < deviation.size(); ++j)
        if (std::fabs(deviation[j]) < most && std::fabs(deviation[j + 1]) < most) sum -= deviation[j] * deviation[j + 1], ++n;
    return n > 0 ? std::sqrt(std::max(0.0, sum / n)) : 0;
}

} // namespace

double half_width_for(const std::vector<double> &t_s, const std::vector<double> &angle_rad, double period_s, double half_s,
                      double still_rad_s, double slope_noise) {
    double speed = 0;
    const double scatter = angle_scatter(t_s, angle_rad, period_s, still_rad_s, speed);
    if (!(scatter > 0)) return half_s;
    return std::clamp(std::pow(scatter_in_slope * scatter * std::sqrt(period_s) / (slope_noise * speed), 2.0 / 3), half_s,
                      std::max(half_s, widest_half_s));
}

Smooth smooth_at(const std::vector<double> &t_s, const std::vector<double> &value, double start_s, double step_s, std::size_t count,
                 double half_width_s, int degree) {
    Smooth out;
    out.value.resize(count);
    out.slope.resize(count);
    out.distance_s.assign(count, std::numeric_limits<double>::infinity());
    const std::size_t n = t_s.size(), need = std::min<std::size_t>(n, static_cast<std::size_t>(degree) + 3);
    if (n == 0) return out;
    std::size_t begin = 0, end = 0, near = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double t = start_s + static_cast<double>(k) * step_s;
        while (begin < n && t_s[begin] < t - half_width_s) ++begin;
        while (end < n && t_s[end] <= t + half_width_s) ++end;
        while (near + 1 < n && std::fabs(t_s[near + 1] - t) <= std::fabs(t_s[near] - t)) ++near;
        std::size_t a = std::min(begin, n), b = std::max(end, a);
        double width = half_width_s;
        while (b - a < need) { // few samples: widen towards the nearer side
            const double left = a > 0 ? t - t_s[a - 1] : std::numeric_limits<double>::infinity();
            const double right = b < n ? t_s[b] - t : std::numeric_limits<double>::infinity();
            if (left <= right)
                --a;
            else
                ++b;
            width = std::max(width, 1.05 * std::min(left, right));
        }
        double s[7] = {}, r[4] = {};
        const double y0 = value[near]; // removed first: keeps precision for large angles
        for (std::size_t i = a; i < b; ++i) {
            const double x = (t_s[i] - t) / width;
            const double c = 1 - std::fabs(x * x * x);
            const double w = c > 0 ? c * c * c : 0;
            const double y = value[i] - y0, wx = w * x, wxx = wx * x;
            s[0] += w, s[1] += wx, s[2] += wxx, s[3] += wxx * x, s[4] += wxx * x * x, s[5] += wxx * x * x * x, s[6] += wxx * x * x * x * x;
            r[0] += w * y, r[1] += wx * y, r[2] += wxx * y, r[3] += wxx * x * y;
        }
        double slope = 0;
        solve_local(s, r, degree, out.value[k], slope);
        out.value[k] += y0;
        out.slope[k] = slope / width;
        out.distance_s[k] = std::fabs(t_s[near] - t);
    }
    return out;
}

double slope_response(double half_width_s, double omega_rad_s) {
    const double x = omega_rad_s * half_width_s;
    if (!(x > 1e-6)) return 1;
    double kept = 0, norm = 0;
    for (int i = -200; i <= 200; ++i) {
        const double u = i / 200.0, c = 1 - std::fabs(u * u * u), w = c * c * c;
        kept += w * u * std::sin(x * u);
        norm += w * u * x * u;
    }
    return kept / norm;
}

double interpolate(const std::vector<double> &t_s, const std::vector<double> &value, double at_s) {
    if (t_s.empty()) return 0;
    const auto upper = std::upper_bound(t_s.begin(), t_s.end(), at_s);
    if (upper == t_s.begin()) return value.front();
    if (upper == t_s.end()) return value.back();
    const auto i = static_cast<std::size_t>(upper - t_s.begin());
    const double f = (at_s - t_s[i - 1]) / (t_s[i] - t_s[i - 1]);
    return value[i - 1] + f * (value[i] - value[i - 1]);
}

double hold(const std::vector<double> &t_s, const std::vector<double> &value, double at_s) {
    if (t_s.empty()) return 0;
    const auto upper = std::upper_bound(t_s.begin(), t_s.end(), at_s + 1e-9);
    return upper == t_s.begin() ? value.front() : value[static_cast<std::size_t>(upper - t_s.begin()) - 1];
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double noise_from_differences(const std::vector<double> &value) {
    std::vector<double> difference;
    for (std::size_t i = 2; i < value.size(); ++i) difference.push_back(std::fabs(value[i] - 2 * value[i - 1] + value[i - 2]));
    return 1.4826 * median(difference) / std::sqrt(6.0);
}

} // namespace traction::lab
