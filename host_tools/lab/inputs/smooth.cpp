#include "smooth.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace traction::lab {

namespace {

using Two = double __attribute__((vector_size(16)));

// Sums over a window about a time, x in half widths from it and w the tricube weight: w x^i and w x^i y.
struct Moments {
    double s[7], r[4];
};

// Weighted least squares of a polynomial of degree <= 3 about x = 0, from its moments; degrades to a lower degree when singular.
void solve_local(const Moments &of, int degree, double &value, double &slope) {
    const auto &s = of.s;
    const auto &r = of.r;
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

// The window about one time after another.
class Sliding {
  public:
    Sliding(const std::vector<double> &t_s, const std::vector<double> &value) : t(t_s), y(value) {}

    void move_to(double time, double half_width_s) {
        at = time, half = half_width_s;
        while (begin > 0 && t[begin - 1] >= at - half) --begin;
        while (begin < t.size() && t[begin] < at - half) ++begin;
        while (end > 0 && t[end - 1] > at + half) --end;
        while (end < t.size() && t[end] <= at + half) ++end;
        while (near + 1 < t.size() && std::fabs(t[near + 1] - at) <= std::fabs(t[near] - at)) ++near;
    }

    void fit(int degree, double &value, double &slope) {
        std::size_t a = begin, b = std::max(end, a);
        double width = half;
        for (const std::size_t need = std::min(t.size(), static_cast<std::size_t>(degree) + 3); b - a < need;) {
            const double left = a > 0 ? at - t[a - 1] : std::numeric_limits<double>::infinity(); // few: towards the nearer side
            const double right = b < t.size() ? t[b] - at : std::numeric_limits<double>::infinity();
            if (left <= right)
                --a;
            else
                ++b;
            width = std::max(width, 1.05 * std::min(left, right));
        }
        if (a != summed_from || b != summed_to || at != summed_at || width != summed_width) sum(a, b, width);
        solve_local(moments, degree, value, slope);
        value += y[near];
        slope /= width;
    }

    double distance() const { return std::fabs(t[near] - at); }

  private:
    void sum(std::size_t a, std::size_t b, double width) {
        summed_from = a, summed_to = b, summed_at = at, summed_width = width;
        const std::size_t count = b - a;
        x.resize(count), w.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            x[i] = (t[a + i] - at) / width;
            const double c = 1 - std::fabs(x[i] * x[i] * x[i]);
            w[i] = c > 0 ? c * c * c : 0;
        }
        const double y0 = y[near];                    // removed first: keeps precision for large angles
        Two s01{}, s23{}, s45{}, s56{}, r01{}, r23{}; // pairs of neighbours, each the one before times x
        for (std::size_t i = 0; i < count; ++i) {
            const Two xx{x[i], x[i]}, yy = Two{y[a + i], y[a + i]} - y0;
            const Two w01{w[i], w[i] * x[i]}, w23 = w01 * xx * xx, w45 = w23 * xx * xx;
            s01 += w01, s23 += w23, s45 += w45, s56 += w45 * xx;
            r01 += w01 * yy, r23 += w23 * yy;
        }
        moments = {{s01[0], s01[1], s23[0], s23[1], s45[0], s45[1], s56[1]}, {r01[0], r01[1], r23[0], r23[1]}};
    }

    const std::vector<double> &t, &y;
    double at = 0, half = 0, summed_at = 0, summed_width = 0;
    std::size_t begin = 0, end = 0, near = 0, summed_from = 0, summed_to = 0;
    Moments moments{};
    std::vector<double> x, w;
};

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

ParabolaAndCubic smooth_twice(const std::vector<double> &t_s, const std::vector<double> &value, double start_s, double step_s,
                              std::size_t count, double half_width_s) {
    ParabolaAndCubic out;
    for (Smooth *one : {&out.parabola, &out.cubic}) {
        one->value.resize(count), one->slope.resize(count);
        one->distance_s.assign(count, std::numeric_limits<double>::infinity());
    }
    if (t_s.empty()) return out;
    Sliding window(t_s, value);
    for (std::size_t k = 0; k < count; ++k) {
        window.move_to(start_s + static_cast<double>(k) * step_s, half_width_s);
        window.fit(2, out.parabola.value[k], out.parabola.slope[k]);
        window.fit(3, out.cubic.value[k], out.cubic.slope[k]);
        out.parabola.distance_s[k] = out.cubic.distance_s[k] = window.distance();
    }
    return out;
}

Smooth smooth_at(const std::vector<double> &t_s, const std::vector<double> &value, double start_s, double step_s, std::size_t count,
                 double half_width_s, int degree) {
    Smooth out;
    out.value.resize(count);
    out.slope.resize(count);
    out.distance_s.assign(count, std::numeric_limits<double>::infinity());
    if (t_s.empty()) return out;
    Sliding window(t_s, value);
    for (std::size_t k = 0; k < count; ++k) {
        window.move_to(start_s + static_cast<double>(k) * step_s, half_width_s);
        window.fit(degree, out.value[k], out.slope[k]);
        out.distance_s[k] = window.distance();
    }
    return out;
}

std::vector<double> slopes_at(const std::vector<double> &t_s, const std::vector<double> &value, double start_s, double step_s,
                              const std::vector<double> &half_width_s) {
    std::vector<double> slope(half_width_s.size());
    if (t_s.empty()) return slope;
    Sliding window(t_s, value);
    double unused = 0;
    for (std::size_t k = 0; k < slope.size(); ++k) {
        window.move_to(start_s + static_cast<double>(k) * step_s, half_width_s[k]);
        window.fit(2, unused, slope[k]);
    }
    return slope;
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
