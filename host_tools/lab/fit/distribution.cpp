#include "distribution.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace traction::lab {

namespace {

double beta_fraction(double a, double b, double x) {
    constexpr double tiny = 1e-300;
    double c = 1, d = 1 - (a + b) * x / (a + 1);
    d = 1 / (std::fabs(d) < tiny ? tiny : d);
    double h = d;
    for (int m = 1; m < 500; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        double change = 1;
        for (const double term : {even, odd}) {
            d = 1 + term * d;
            d = 1 / (std::fabs(d) < tiny ? tiny : d);
            c = 1 + term / c;
            if (std::fabs(c) < tiny) c = tiny;
            change = c * d;
            h *= change;
        }
        if (std::fabs(change - 1) < 1e-14) break;
    }
    return h;
}

double incomplete_beta(double a, double b, double x) {
    if (x <= 0) return 0;
    if (x >= 1) return 1;
    const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
    return x < (a + 1) / (a + b + 2) ? front * beta_fraction(a, b, x) / a : 1 - front * beta_fraction(b, a, 1 - x) / b;
}

} // namespace

double f_tail(double f, double d1, double d2) {
    if (!(f > 0) || !(d2 > 0)) return 1;
    return incomplete_beta(0.5 * d2, 0.5 * d1, d2 / (d2 + d1 * f));
}

double t_quantile(double p, double freedom) {
    double low = 0, high = 1e3;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (f_tail(middle * middle, 1, freedom) > p ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double signed_rank_tail(std::vector<double> values) {
    std::erase(values, 0.0);
    std::stable_sort(values.begin(), values.end(), [](double a, double b) { return std::fabs(a) < std::fabs(b); });
    const std::size_t n = values.size();
    std::size_t below = 0; // sum of the ranks of what is negative
    for (std::size_t i = 0; i < n; ++i)
        if (!(values[i] > 0)) below += i + 1;
    const auto count = static_cast<double>(n);
    if (n == 0) return 1;
    if (n > 60)
        return 0.5 * std::erfc((0.25 * count * (count + 1) - static_cast<double>(below) - 0.5) /
                               std::sqrt(count * (count + 1) * (2 * count + 1) / 12));
    std::vector<double> share(below + 1, 0); // of all choices of signs: those whose ranks sum to the index
    share[0] = std::ldexp(1.0, -static_cast<int>(n));
    for (std::size_t rank = 1; rank <= n; ++rank)
        for (std::size_t sum = below; sum >= rank; --sum) share[sum] += share[sum - rank];
    double tail = 0;
    for (const double s : share) tail += s;
    return tail;
}

} // namespace traction::lab
