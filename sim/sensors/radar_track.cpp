#include "radar_track.h"

#include "random.h"
#include "sim/physics/math.h"
#include "sim/physics/terramechanics.h"

#include <algorithm>
#include <cmath>

namespace traction::sim {

namespace {

constexpr double near_m = 0.05;          // [m] footprint kept: at 20 deg and 0.3 m its middle lies at 0.8 m, and outside
constexpr double far_m = 4.0;            // [m] these limits (2) has less than 1 % of its power (test: mean Doppler)
constexpr double half_width_m = 2.0;     // [m] likewise to the side
constexpr int rows = 32;                 // lines of scatterers beside the track; left and right give the same echo
constexpr double scatterers_per_m = 160; // [1/m] of track: some 60 share the echo at any instant, enough for Rayleigh speckle
constexpr int cell_nodes = 64;           // scatterers are drawn for so many nodes at once
constexpr double row_bend_m = 0.35;      // [m] rows are dense below this offset and thin out beyond

struct Weight {
    double amplitude, range_m, direction; // direction: cosine between line of sight and travel
};

Weight weigh(const RadarBeam &beam, double x_m, double y_m) {
    const double ground_m = std::sqrt(x_m * x_m + y_m * y_m);
    const double range_m = std::sqrt(ground_m * ground_m + beam.height_m * beam.height_m);
    const double degree = 180 / math::pi;
    const double elevation = (math::atan2(beam.height_m, ground_m) * degree - beam.depression_deg) / beam.vertical_deg;
    const double azimuth = math::atan2(y_m, x_m) * degree / beam.horizontal_deg;
    const double half_power = 2.7725887222397811; // 4 ln 2: exp(-4 ln2 (angle/width)^2) is 1/2 at half the width
    const double sine = beam.height_m / range_m;
    // two-way power is the square of the one-way power, so two-way amplitude is the one-way power
    const double ground = beam.ground_exponent > 0 ? math::exp(0.5 * beam.ground_exponent * math::log(sine)) : 1.0;
    const double amplitude = math::exp(-half_power * (elevation * elevation + azimuth * azimuth)) * ground / (range_m * range_m);
    return {amplitude, range_m, x_m / range_m};
}

// Rows crowd where the beam is: y = bend * q/(1-q) stretched to end at half_width_m; returns y and dy/drow.
void row_place(double row, double *y_m, double *pitch_m) {
    const double q = row / rows, c = half_width_m / (half_width_m + row_bend_m);
    *y_m = row_bend_m * c * q / (1 - c * q);
    *pitch_m = row_bend_m * c / ((1 - c * q) * (1 - c * q)) / rows;
}

std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

std::complex<double> turn(double turns) {
    const double angle = 2 * math::pi * (turns - std::floor(turns));
    return {math::cos(angle), math::sin(angle)};
}

} // namespace

RadarTrack::RadarTrack(const RadarBeam &beam, std::uint64_t seed)
    : seed_(seed), wavelength_m_(light_speed_m_s / beam.frequency_Hz), node_m_(wavelength_m_ / 6),
      carrier_turns_m_(2 / wavelength_m_ * math::cos(beam.depression_deg * math::pi / 180)) {
    make_response(beam);
}

RadarTrack::~RadarTrack() = default;
RadarTrack::RadarTrack(RadarTrack &&) noexcept = default;

// response_[row][k]: (2) of a scatterer of amplitude 1 that lies first_tap_ + k nodes ahead, with the carrier taken off.
void RadarTrack::make_response(const RadarBeam &beam) {
    first_tap_ = static_cast<int>(near_m / node_m_);
    taps_ = static_cast<int>(far_m / node_m_) - first_tap_;
    double power = 0, doppler = 0;
    for (int row = 0; row < rows; row++) {
        double y_m = 0, pitch_m = 0;
        row_place(row + 0.5, &y_m, &pitch_m);
        Line line{std::vector<float>(static_cast<std::size_t>(taps_)), std::vector<float>(static_cast<std::size_t>(taps_))};
        for (int k = 0; k < taps_; k++) {
            const double x_m = (first_tap_ + k) * node_m_;
            const Weight weight = weigh(beam, x_m, y_m);
            const double amplitude = weight.amplitude * std::sqrt(pitch_m);
            power += amplitude * amplitude;
            doppler += amplitude * amplitude * weight.direction;
            // the rover's place is -x_m as seen from the scatterer: its carrier there is turned back
            const auto value = amplitude * turn(-2 * weight.range_m / wavelength_m_ + carrier_turns_m_ * x_m);
            line.re[static_cast<std::size_t>(taps_ - 1 - k)] = static_cast<float>(value.real());
            line.im[static_cast<std::size_t>(taps_ - 1 - k)] = static_cast<float>(value.imag());
        }
        response_.push_back(std::move(line));
    }
    mean_ratio_ = doppler / power / math::cos(beam.depression_deg * math::pi / 180);
    // mean power 1: a scatterer sits in a given row and node with probability density/rows, its A has mean power 2 (two normals)
    per_cell_ = static_cast<int>(scatterers_per_m * node_m_ * cell_nodes + 0.5);
    const double expected = power * per_cell_ / cell_nodes / rows * 2;
    const auto scale = static_cast<float>(1 / std::sqrt(expected));
    for (Line &line : response_)
        for (std::size_t k = 0; k < line.re.size(); k++) {
            line.re[k] *= scale;
            line.im[k] *= scale;
        }
}

namespace {

inline void add_here(const float *h_re, const float *h_im, float a, float b, float *__restrict re, float *__restrict im,
                     std::int64_t count) {
    for (std::int64_t i = 0; i < count; i++) {
        re[i] += a * h_re[i] - b * h_im[i];
        im[i] += a * h_im[i] + b * h_re[i];
    }
}

// In the widest vectors that this processor has: the same operations on each number, none contracted, so the same bits.
using Add = void (*)(const float *, const float *, float, float, float *, float *, std::int64_t);
void add_narrow(const float *h_re, const float *h_im, float a, float b, float *re, float *im, std::int64_t count) {
    add_here(h_re, h_im, a, b, re, im, count);
}
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
__attribute__((target("avx2"), flatten)) void add_avx2(const float *h_re, const float *h_im, float a, float b, float *re, float *im,
                                                       std::int64_t count) {
    add_here(h_re, h_im, a, b, re, im, count);
}
Add widest_add() { return has(Vectors::avx2) ? add_avx2 : add_narrow; }
#else
Add widest_add() { return add_narrow; }
#endif

} // namespace

// sum[at ...] += (a + ib) * line[tap ...]
void RadarTrack::add(const Line &line, std::int64_t tap, float a, float b, Chunk &sum, std::int64_t at, std::int64_t count) {
    static const Add widest = widest_add();
    widest(line.re.data() + tap, line.im.data() + tap, a, b, sum.re.data() + at, sum.im.data() + at, count);
}

// Baseband of nodes [index*chunk_nodes, +chunk_nodes). Each node owns its scatterers, so chunks can be made in any order.
const RadarTrack::Chunk &RadarTrack::chunk(std::int64_t index) {
    if (index == last_index_) return *last_chunk_;
    auto found = chunks_.find(index);
    if (found == chunks_.end()) {
        Chunk sum{std::vector<float>(chunk_nodes), std::vector<float>(chunk_nodes)};
        const std::int64_t start = index * chunk_nodes;
        const std::int64_t first = start + first_tap_, end = start + chunk_nodes + first_tap_ + taps_ - 1;
        for (std::int64_t cell = floor_divide(first, cell_nodes); cell <= floor_divide(end - 1, cell_nodes); cell++) {
            Random random(mix64(seed_) + mix64(static_cast<std::uint64_t>(cell)));
            for (int j = 0; j < per_cell_; j++) {
                const std::int64_t place = cell * cell_nodes + random.below(cell_nodes);
                const Line &line = response_[static_cast<std::size_t>(random.below(rows))];
                const double turns = static_cast<double>(place) * node_m_ * carrier_turns_m_;
                const double re = random.normal(), im = random.normal();
                const std::complex<double> amplitude = std::complex<double>(re, im) * turn(-turns);
                // node n sees it at tap place - n - first_tap_; lines are stored from the far end, so both run forward
                const std::int64_t low = std::max(start, place - first_tap_ - taps_ + 1);
                const std::int64_t high = std::min(start + chunk_nodes - 1, place - first_tap_);
                if (low > high) continue;
                const std::int64_t tap = taps_ - 1 - (place - low - first_tap_);
                add(line, tap, static_cast<float>(amplitude.real()), static_cast<float>(amplitude.imag()), sum, low - start,
                    high - low + 1);
            }
        }
        found = chunks_.emplace(index, std::move(sum)).first;
    }
    last_index_ = index;
    last_chunk_ = &found->second;
    return found->second;
}

std::complex<double> RadarTrack::node(std::int64_t index) {
    const std::int64_t owner = floor_divide(index, chunk_nodes);
    const Line &values = chunk(owner);
    const auto i = static_cast<std::size_t>(index - owner * chunk_nodes);
    return {static_cast<double>(values.re[i]), static_cast<double>(values.im[i])};
}

std::complex<double> RadarTrack::echo(double position_m) {
    const double place = position_m / node_m_;
    const double base = std::floor(place), u = place - base;
    const auto index = static_cast<std::int64_t>(base);
    // Lagrange through nodes -1, 0, 1, 2
    const std::complex<double> value = node(index - 1) * (-u * (u - 1) * (u - 2) / 6) + node(index) * ((u + 1) * (u - 1) * (u - 2) / 2) +
                                       node(index + 1) * (-(u + 1) * u * (u - 2) / 2) + node(index + 2) * ((u + 1) * u * (u - 1) / 6);
    return value * turn(position_m * carrier_turns_m_);
}

} // namespace traction::sim
