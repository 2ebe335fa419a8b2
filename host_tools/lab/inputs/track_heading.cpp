#include "track_heading.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace {

using Complex = std::complex<double>;

constexpr double half_window_s = 10;
constexpr double known_to_rad = 0.02;
constexpr double least_agreement = 0.9; // cos of 0.45 rad: below it this is not the track of these wheels

Complex middle(const TrackRow &row) { return std::polar(1.0, 0.5 * (row.turned_rad[0] + row.turned_rad[1])); }

Complex without_lever(const TrackRow &row, Complex lever_m, double delta_rad) {
    return row.way_m - lever_m * (std::polar(1.0, row.turned_rad[1] + delta_rad) - std::polar(1.0, row.turned_rad[0] + delta_rad));
}

} // namespace

Complex way_of_body(const TrackRow &row, Complex lever_m, double delta_rad) {
    return without_lever(row, lever_m, delta_rad) * std::conj(middle(row) * std::polar(1.0, delta_rad));
}

TrackHeading track_heading(const std::vector<TrackRow> &rows, Complex lever_m, double noise_m, double row_s) {
    const auto half_window = static_cast<std::size_t>(std::max(1.0, half_window_s / row_s));
    const std::size_t count = rows.size();
    TrackHeading out;
    std::vector<double> delta(count, 0);
    std::vector<bool> known(count, false);
    const int passes = lever_m == Complex() ? 1 : 4; // the lever's own part follows the heading
    for (int pass = 0; pass < passes; ++pass) {
        // What (1) sums before each row, and the square of the wheels' way, which says how well the sum tells an angle.
        std::vector<Complex> turned = {Complex()};
        std::vector<double> way2 = {0};
        for (std::size_t i = 0; i < count; ++i) {
            const Complex way = pass == 0 ? rows[i].way_m : without_lever(rows[i], lever_m, delta[i]);
            turned.push_back(turned.back() + way * std::conj(rows[i].rim_m * middle(rows[i])));
            way2.push_back(way2.back() + rows[i].rim_m * rows[i].rim_m);
        }
        for (std::size_t first = 0, last; first < count; first = last) {
            for (last = first + 1; last < count && !rows[last].begins;) ++last;
            for (std::size_t i = first; i < last; ++i) {
                for (std::size_t half = half_window;; half *= 2) {
                    const std::size_t a = i - std::min(half, i - first), b = std::min(last, i + half + 1);
                    known[i] = noise_m < known_to_rad * std::sqrt(way2[b] - way2[a]);
                    if (known[i]) delta[i] = std::arg(turned[b] - turned[a]);
                    if (known[i] || (a == first && b == last)) break;
                }
            }
        }
    }
    double along = 0, whole = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (!known[i]) continue;
        const Complex way = way_of_body(rows[i], lever_m, delta[i]);
        if (std::abs(way) < 3 * noise_m) continue;
        along += way.real() * rows[i].rim_m;
        whole += std::abs(way) * std::fabs(rows[i].rim_m);
    }
    out.agreement = whole > 0 ? along / whole : 0;
    if (out.agreement < least_agreement) return out;
    // a piece that tells nothing takes what the nearest before it, else after it, told
    std::size_t told = static_cast<std::size_t>(std::find(known.begin(), known.end(), true) - known.begin());
    for (std::size_t i = 0; i < count; ++i) {
        if (known[i]) told = i;
        delta[i] = delta[told];
    }
    out.delta_rad = std::move(delta);
    return out;
}

} // namespace traction::lab
