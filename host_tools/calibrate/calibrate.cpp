#include "calibrate.h"

#include "firmware/core/rover_config.h"
#include "host_tools/report/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <optional>
#include <vector>

namespace traction {

namespace {

constexpr int window_samples = 256;
constexpr double slowest_m_s = 0.15;  // below, 1 mm of camera noise at 7 Hz is more than 5 %, and the band-pass blinds the radar
constexpr double steady_share = 0.12; // largest spread of the true speed within a window
constexpr double model_std = 0.005;   // [1] of the scale, assumed: ground exponent 0..2 and the likelihood's own bias, measured 0.2 to 0.5 %
constexpr int blocks = 10;

// The true speed, piecewise constant.
struct Speed {
    std::vector<double> t_s, value; // value[i] from t_s[i] to t_s[i + 1]
    double at(double t) const {
        const auto next = std::upper_bound(t_s.begin(), t_s.end(), t);
        if (next == t_s.begin() || next == t_s.end()) return std::nan("");
        return value[static_cast<std::size_t>(next - t_s.begin()) - 1];
    }
};

std::optional<Speed> camera_speed(const log::Log &log) {
    const log::Signal *x = log.find("camera.x_m"), *y = log.find("camera.y_m");
    if (x == nullptr || y == nullptr || x->t_s != y->t_s || x->t_s.size() < 3) return std::nullopt;
    Speed out;
    for (std::size_t i = 0; i + 1 < x->t_s.size(); i++) {
        out.t_s.push_back(x->t_s[i]);
        out.value.push_back(std::hypot(x->value[i + 1] - x->value[i], y->value[i + 1] - y->value[i]) / (x->t_s[i + 1] - x->t_s[i]));
    }
    return out;
}

std::optional<Speed> wheel_speed(const log::Log &log, double radius_m) {
    Speed out;
    for (int wheel = 0; wheel < WHEEL_COUNT; wheel++) {
        const log::Signal *signal = log.find("wheel" + std::to_string(wheel) + ".speed_rad_s");
        if (signal == nullptr || (!out.t_s.empty() && signal->t_s != out.t_s)) return std::nullopt;
        out.t_s = signal->t_s;
        out.value.resize(signal->value.size());
        for (std::size_t i = 0; i < signal->value.size(); i++) out.value[i] += radius_m * signal->value[i] / 4; // wheels
    }
    for (double &value : out.value) value = std::fabs(value);
    return out;
}

// Mean over the Hann window squared that ends with sample `last`; NaN unless fast and steady.
double window_mean(const Speed &speed, const std::vector<double> &t_s, std::size_t last) {
    double sum = 0, weight = 0, low = 1e9, high = 0;
    for (std::size_t j = 0; j < window_samples; j++) {
        const double v = speed.at(t_s[last - (window_samples - 1) + j]);
        const double h = std::pow(std::sin(std::numbers::pi * static_cast<double>(j) / window_samples), 4);
        sum += h * v;
        weight += h;
        if (h > 0.1) low = std::min(low, v), high = std::max(high, v);
    }
    const double mean = sum / weight;
    const bool good = mean > slowest_m_s && high - low < steady_share * mean + 0.025; // 0.025: two sigma of the camera's 1 mm at 7 Hz
    return good ? mean : std::nan("");
}

// Power of the Hann window at d bins from its centre.
double hann_power(double d) {
    if (std::fabs(d) < 1e-9) return 1;
    if (std::fabs(std::fabs(d) - 1) < 1e-9) return 0.25;
    const double w = std::sin(std::numbers::pi * d) / (std::numbers::pi * d * (1 - d * d));
    return w * w;
}

// (2): what the firmware's likelihood makes of the expected echo of a radar at this angle, over the true speed of 0.5 m/s. The beam
// is the MDU1130's, as firmware/template weighs it.
double heard_share(const doppler_template_t &beam, double angle_deg) {
    constexpr double v = 0.5, f0_Hz = 9.9e9, c_m_s = 299792458.0, df_Hz = 2;
    const double rad = std::numbers::pi / 180, c = std::cos(angle_deg * rad), s = std::sin(angle_deg * rad);
    std::vector<double> power(static_cast<std::size_t>(beam.bins), 0.0);
    for (double th = 0.5; th < 90; th += 1)
        for (double ph = -89.5; ph < 90; ph += 1) {
            const double x = std::cos(th * rad) * std::cos(ph * rad), y = std::cos(th * rad) * std::sin(ph * rad), z = -std::sin(th * rad);
            const double along = x * c - z * s, up = x * s + z * c;
            if (along <= 0) continue;
            const double el = std::asin(up) / rad / 36, az = std::atan2(y, along) / rad / 72;
            const double f = 2 * v * f0_Hz / c_m_s * x;
            const double band = 1 / (1 + std::pow(3 / f, 4)) / (1 + std::pow(f / 80, 4));
            const double weight = band * std::exp(-8 * std::log(2.0) * (el * el + az * az)) * std::pow(std::sin(th * rad), 2) * std::cos(th * rad);
            const int near = static_cast<int>(f / df_Hz) - beam.first_bin;
            for (int k = std::max(0, near - 3); k < std::min(beam.bins, near + 5); k++)
                power[static_cast<std::size_t>(k)] += weight * hann_power(k + beam.first_bin - f / df_Hz);
        }
    double total = 0;
    for (const double p : power) total += p;
    std::vector<double> J;
    for (int i = 0; i < beam.speeds; i++) {
        double sum = total * beam.volume[i];
        for (int k = 0; k < beam.bins; k++) {
            const double p = 0.95 * power[static_cast<std::size_t>(k)] + 0.05 * total / beam.bins; // the template's share of white noise
            sum += p * beam.inverse[i * beam.bins + k];
        }
        J.push_back(sum);
    }
    const auto best = static_cast<std::size_t>(std::min_element(J.begin() + 1, J.end() - 1) - J.begin());
    const double left = J[best - 1] - J[best], right = J[best + 1] - J[best], offset = left + right > 0 ? 0.5 * (left - right) / (left + right) : 0;
    return static_cast<double>(beam.speed_m_s[best]) * std::exp(offset * static_cast<double>(beam.log_step)) / v;
}

double angle_of(const doppler_template_t &beam, double scale) {
    double low = 2, high = 45;
    for (int i = 0; i < 12; i++) { // heard_share falls with the angle; 12 halvings: 0.01 deg
        const double middle = 0.5 * (low + high);
        (heard_share(beam, middle) * scale > 1 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

struct Pair {
    double reference, radar;
};

double ratio(const std::vector<Pair> &pairs, std::size_t from, std::size_t to) { // leaves from..to out
    double reference = 0, radar = 0;
    for (std::size_t i = 0; i < pairs.size(); i++)
        if (i < from || i >= to) reference += pairs[i].reference, radar += pairs[i].radar;
    return reference / radar;
}

} // namespace

Calibration calibrate(const log::Log &log, CalibrationTruth truth, double wheel_radius_m) {
    const log::Signal *adc = log.find("radar.adc_count");
    if (adc == nullptr) throw log::LogError(log.source, 0, 0, "no column radar.adc_count", "record the radar's samples: the speed alone cannot be calibrated");
    std::optional<Speed> speed;
    Calibration out;
    if (truth != CalibrationTruth::wheels && (speed = camera_speed(log))) out.truth = "camera";
    if (!speed && truth != CalibrationTruth::camera && (speed = wheel_speed(log, wheel_radius_m))) out.truth = "wheels";
    if (!speed) throw log::LogError(log.source, 0, 0, "no true speed", "give camera.x_m and camera.y_m, or the four wheel speeds of a drive on firm ground");

    control_config_t config = rover_config_default();
    config.doppler.scale = 1;
    doppler_state_t state{};
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < adc->value.size(); i++) {
        const auto sample = static_cast<std::uint16_t>(std::clamp(adc->value[i], 0.0, 1023.0));
        const doppler_output_t value = doppler_step(&config.doppler, &state, &sample, 1);
        if (!value.fresh || value.quiet || value.late_samples < 1) continue; // a negative age: half a window
        const std::size_t last = i - static_cast<std::size_t>(value.late_samples);
        const double reference = window_mean(*speed, adc->t_s, last);
        if (std::isfinite(reference)) pairs.push_back({reference, static_cast<double>(value.speed_m_s)});
    }
    out.windows = static_cast<int>(pairs.size());
    if (out.windows < 20)
        throw log::LogError(log.source, 0, 0, "only " + std::to_string(out.windows) + " steady windows above 0.15 m/s",
                            "drive straight at constant speeds from 0.2 to 0.8 m/s for half a minute on firm ground");
    out.scale = ratio(pairs, 0, 0);
    std::array<double, blocks> without{};
    double mean = 0;
    for (std::size_t b = 0; b < blocks; b++) mean += (without[b] = ratio(pairs, pairs.size() * b / blocks, pairs.size() * (b + 1) / blocks)) / blocks;
    for (const double value : without) out.scale_std += (value - mean) * (value - mean);
    out.scale_std = std::sqrt(out.scale_std * (blocks - 1) / blocks); // jackknife: blocks are longer than a window's memory
    out.angle_deg = angle_of(*config.doppler.beam, out.scale);
    const double spread = std::hypot(out.scale_std, model_std); // one number cannot tell an angle from a ground
    out.angle_std_deg = 0.5 * std::fabs(angle_of(*config.doppler.beam, out.scale + spread) - angle_of(*config.doppler.beam, out.scale - spread));
    return out;
}

void put_parameter(const std::string &path, const std::string &key, double value, const std::string &comment) {
    std::string text, line;
    std::ifstream file(path);
    bool format = false;
    while (std::getline(file, line)) {
        const std::string name = line.substr(0, line.find_first_of(" \t="));
        if (name == key) continue;
        format = format || name == "format";
        text += line + '\n';
    }
    if (!format) text = "format = \"traction.firmware/1\"\n" + text;
    char number[40];
    std::snprintf(number, sizeof number, "%.7g", value);
    report::write_text(text + key + " = " + number + " # " + comment + '\n', path);
}

} // namespace traction
