#include "radar_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace traction {

namespace {

constexpr double f0_Hz = 9.9e9, c_m_s = 299792458.0; // MDU1130, table II (Lhomme-Desages)
constexpr double bin_Hz = 2, shift_Hz_per_m_s = 2 * f0_Hz / c_m_s;
constexpr double low_Hz = 3, high_Hz = 80; // band-pass, section IV
constexpr double calm_share = 0.004;       // white noise in the band, as firmware/template assumes it
constexpr int cells = 1000;                // of the shift's share of the largest
constexpr int reach = 20;                  // quarters of a bin beyond which (1) is cut: 1e-4 of its peak

// Power over cos(theta) cos(psi): (1) of firmware/template.
std::vector<double> beam_histogram(const RadarGuess &guess) {
    const double rad = std::numbers::pi / 180, c = std::cos(guess.angle_deg * rad), s = std::sin(guess.angle_deg * rad);
    std::vector<double> power(cells, 0.0);
    for (double th = 0.25; th < 90; th += 0.5)
        for (double ph = 0.25; ph < 90; ph += 0.5) { // left and right alike
            const double x = std::cos(th * rad) * std::cos(ph * rad), y = std::cos(th * rad) * std::sin(ph * rad), z = -std::sin(th * rad);
            const double along = x * c - z * s, up = x * s + z * c;
            if (along <= 0) continue;
            const double el = std::asin(up) / rad / 36, az = std::atan2(y, along) / rad / 72;
            power[static_cast<std::size_t>(x * cells)] += std::exp(-8 * std::log(2.0) * (el * el + az * az)) *
                                                          std::pow(std::sin(th * rad), guess.ground_exponent + 1) * std::cos(th * rad);
        }
    return power;
}

// Amplitude of the Hann window at d quarters of a bin from its centre.
double hann(int d) {
    static const std::vector<double> table = [] {
        std::vector<double> out;
        for (int i = 0; i < 4 * (2 * DOPPLER_BINS_MAX + 20); i++) {
            const double bins = 0.25 * i, angle = std::numbers::pi * bins;
            out.push_back(i == 0 ? 1 : i == 4 ? 0.5 : std::sin(angle) / (angle * (1 - bins * bins)));
        }
        return out;
    }();
    return table[static_cast<std::size_t>(std::abs(d))];
}

// Amplitudes of (1) on quarters of a bin at speed v; the echo's powers have the sum 1.
std::vector<double> amplitudes(const std::vector<double> &histogram, double v, int bins) {
    const int last = std::min(4 * (bins + 8), static_cast<int>(4 * shift_Hz_per_m_s * v / bin_Hz) + 2); // no guess has a larger shift
    std::vector<double> power(static_cast<std::size_t>(last), 0.0);
    for (int i = 0; i < cells; i++) {
        const double f = shift_Hz_per_m_s * v * (i + 0.5) / cells;
        const auto m = static_cast<std::size_t>(4 * f / bin_Hz + 0.5);
        if (m > 0 && m < power.size())
            power[m] += histogram[static_cast<std::size_t>(i)] / (1 + std::pow(low_Hz / f, 4)) / (1 + std::pow(f / high_Hz, 4));
    }
    double sum = 0;
    for (int m = 1; m < static_cast<int>(power.size()); m++)
        for (int k = 1; k <= bins && power[static_cast<std::size_t>(m)] > 0; k++)
            sum += power[static_cast<std::size_t>(m)] * (std::pow(hann(4 * k - m), 2) + std::pow(hann(4 * k + m), 2));
    for (double &p : power) p = std::sqrt(p / sum);
    return power;
}

using Powers = std::array<double, DOPPLER_BINS_MAX>;

// What chance adds to a window: each cell's normal numbers, and the white noise of each bin.
struct Chance {
    std::vector<std::array<double, 2>> cell, noise;
};

Chance draw(std::size_t cells_at_v, int bins, std::mt19937_64 &random) {
    std::normal_distribution<double> normal(0, std::sqrt(0.5));
    Chance out{.cell = std::vector<std::array<double, 2>>(cells_at_v),
               .noise = std::vector<std::array<double, 2>>(static_cast<std::size_t>(bins) + 2)};
    for (auto &z : out.cell)
        for (double &part : z) part = normal(random);
    const double white = std::sqrt(calm_share / (0.375 * bins)); // 3/8: the window's mean square
    for (auto &n : out.noise)
        for (double &part : n) part = white * normal(random);
    return out;
}

Powers window(const std::vector<double> &amplitude, const Chance &chance, int bins) {
    const auto &[cell, noise] = chance;
    std::vector<std::array<double, 2>> z(amplitude.size());
    for (std::size_t m = 0; m < z.size(); m++) z[m] = {amplitude[m] * cell[m][0], amplitude[m] * cell[m][1]};
    Powers power{};
    for (int k = 1; k <= bins; k++) {
        const auto at = static_cast<std::size_t>(k);
        double re = 0.5 * noise[at][0] + 0.25 * (noise[at - 1][0] + noise[at + 1][0]),
               im = 0.5 * noise[at][1] + 0.25 * (noise[at - 1][1] + noise[at + 1][1]);
        for (int m = std::max(1, 4 * k - reach); m <= 4 * k + reach && m < static_cast<int>(z.size()); m++) {
            const double w = hann(4 * k - m), mirrored = hann(4 * k + m);
            re += z[static_cast<std::size_t>(m)][0] * (w + mirrored);
            im += z[static_cast<std::size_t>(m)][1] * (w - mirrored);
        }
        power[at - 1] = re * re + im * im;
    }
    return power;
}

// (2) of doppler.h over the whole grid.
double heard_m_s(const doppler_template_t &beam, const Powers &power) {
    double total = 0;
    for (const double p : power) total += p;
    std::array<double, DOPPLER_SPEEDS_MAX> J{};
    for (int i = 0; i < beam.speeds; i++) {
        double sum = total * beam.volume[i];
        for (int k = 0; k < beam.bins; k++) sum += power[static_cast<std::size_t>(k)] * beam.inverse[i * beam.bins + k];
        J[static_cast<std::size_t>(i)] = sum;
    }
    const auto best = static_cast<std::size_t>(std::min_element(J.begin() + 1, J.begin() + beam.speeds - 1) - J.begin());
    const double left = J[best - 1] - J[best], right = J[best + 1] - J[best];
    const double offset = left + right > 0 ? std::clamp(0.5 * (left - right) / (left + right), -0.5, 0.5) : 0;
    return static_cast<double>(beam.speed_m_s[best]) * std::exp(offset * static_cast<double>(beam.log_step));
}

} // namespace

std::vector<double> modelled_scales(const doppler_template_t &beam, const std::vector<RadarGuess> &guesses,
                                    const std::vector<double> &speed_m_s, int repeats) {
    std::vector<std::vector<double>> histogram;
    for (const RadarGuess &guess : guesses) histogram.push_back(beam_histogram(guess));
    std::mt19937_64 random(20261121);
    double reference = 0;
    std::vector<double> heard(guesses.size(), 0.0);
    for (const double v : speed_m_s) {
        std::vector<std::vector<double>> amplitude;
        for (const std::vector<double> &power : histogram) amplitude.push_back(amplitudes(power, v, beam.bins));
        for (int r = 0; r < repeats; r++) {
            reference += v;
            const Chance chance = draw(amplitude.front().size(), beam.bins, random); // cells depend on the speed alone
            for (std::size_t g = 0; g < guesses.size(); g++) heard[g] += heard_m_s(beam, window(amplitude[g], chance, beam.bins));
        }
    }
    for (double &h : heard) h = reference / h;
    return heard;
}

} // namespace traction
