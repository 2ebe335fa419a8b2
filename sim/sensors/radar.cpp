#include "radar.h"

#include "sim/physics/math.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace traction::sim {

std::array<RadarModel, 4> radar_models() {
    return {{{"MDU1130", 9.9e9, 36, 72, 0.015},
             {"DJ Radar II", 24.13e9, 15, 15, 2.0},
             {"DJ Radar III", 24.13e9, 20, 16, 0.5}, // 20 vertical, 16 horizontal: order assumed
             {"DRS1000", 35.5e9, 12, 12, 0.23}}};
}

namespace {

RadarModel find_model(std::string_view name) {
    for (const RadarModel &model : radar_models())
        if (model.name == name) return model;
    throw std::logic_error("no radar is called " + std::string(name));
}

RadarBeam beam_of(const RadarConfig &config) {
    const RadarModel model = model_of(config);
    return {.frequency_Hz = model.frequency_Hz,
            .vertical_deg = model.vertical_deg,
            .horizontal_deg = model.horizontal_deg,
            .depression_deg = config.depression_deg + config.mounting_error_deg,
            .height_m = config.height_m,
            .ground_exponent = config.ground_exponent};
}

BandPass filter_of(const RadarConfig &config) {
    const double ratio = model_of(config).frequency_Hz / 9.9e9, nyquist_Hz = 0.46875 * config.rate_Hz;
    return {config.band_low_Hz >= 0 ? config.band_low_Hz : 3 * ratio,
            std::min(config.band_high_Hz > 0 ? config.band_high_Hz : 80 * ratio, nyquist_Hz), config.rate_Hz};
}

} // namespace

RadarModel model_of(const RadarConfig &config) {
    RadarModel model = config.model == "own" ? RadarModel{.name = "own"} : find_model(config.model);
    if (config.frequency_Hz > 0) model.frequency_Hz = config.frequency_Hz;
    if (config.vertical_deg > 0) model.vertical_deg = config.vertical_deg;
    if (config.horizontal_deg > 0) model.horizontal_deg = config.horizontal_deg;
    return model;
}

BandPass::BandPass(double low_Hz, double high_Hz, double rate_Hz) : high_pass_{}, low_pass_{} {
    // bilinear transform of 1/(s^2 + sqrt2 s + 1) and s^2/(...), s = (1/k)(1 - z^-1)/(1 + z^-1), k = tan(pi f/rate)
    const auto design = [rate_Hz](double cut_Hz, bool high) {
        const double angle = math::pi * cut_Hz / rate_Hz, k = math::sin(angle) / math::cos(angle);
        const double norm = 1 / (1 + 1.4142135623730951 * k + k * k);
        const double gain = high ? norm : k * k * norm;
        return Section{.b0 = gain,
                       .b1 = high ? -2 * gain : 2 * gain,
                       .b2 = gain,
                       .a1 = 2 * (k * k - 1) * norm,
                       .a2 = (1 - 1.4142135623730951 * k + k * k) * norm};
    };
    high_pass_ = design(low_Hz, true);
    low_pass_ = design(high_Hz, false);
}

double BandPass::Section::step(double x) {
    const double y = b0 * x + b1 * x1 + b2 * x2 - a1 * y1 - a2 * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = y;
    return y;
}

double BandPass::step(double x) { return low_pass_.step(high_pass_.step(x)); }

void BandPass::settle(double x) {
    high_pass_.x1 = high_pass_.x2 = x; // a constant does not pass, so every output is 0
    high_pass_.y1 = high_pass_.y2 = low_pass_.x1 = low_pass_.x2 = low_pass_.y1 = low_pass_.y2 = 0;
}

Radar::Radar(const RadarConfig &config, std::uint64_t seed)
    : config_(config), track_(beam_of(config), mix64(seed) ^ 0x7261646172u), filter_(filter_of(config)), noise_(seed, "radar.noise"),
      fade_(seed, "radar.dropout") {
    // 1/f between 0.5 and 50 Hz: three first-order noises of equal power, a decade apart
    constexpr std::array<double, 3> corner_Hz{0.5, 5, 50};
    for (std::size_t i = 0; i < corner_Hz.size(); i++) {
        const double keep = 1 - std::min(1.0, 2 * math::pi * corner_Hz[i] / config_.rate_Hz);
        flicker_[i] = {keep, std::sqrt((1 - keep * keep) / 3)};
    }
}

std::uint16_t Radar::sample(double path_m) {
    // mean power of the complex echo is 1, so its real part has rms 1/sqrt 2
    double echo = track_.echo(path_m).real() * 1.4142135623730951 * config_.echo_count;
    if (config_.dropout_per_s > 0) {
        if (faded_samples_ > 0)
            faded_samples_--;
        else if (fade_.uniform() < config_.dropout_per_s / config_.rate_Hz)
            faded_samples_ = static_cast<int>(config_.dropout_s * config_.rate_Hz);
        if (faded_samples_ > 0) echo = 0;
    }
    double flicker = 0;
    for (Flicker &one : flicker_) {
        one.state = one.keep * one.state + one.gain * noise_.normal();
        flicker += one.state;
    }
    if (!settled_) filter_.settle(echo);
    settled_ = true;
    double volts = filter_.step(echo) + config_.noise_count * noise_.normal() + config_.flicker_count * flicker;
    for (const RadarLine &line : config_.interference) {
        const double turns = line.frequency_Hz * static_cast<double>(samples_) / config_.rate_Hz;
        volts += 1.4142135623730951 * line.rms_count * math::sin(2 * math::pi * (turns - std::floor(turns)));
    }
    samples_++;
    return static_cast<std::uint16_t>(std::clamp(std::floor(volts + config_.offset_count + config_.offset_error_count + 0.5), 0.0,
                                                 static_cast<double>(config_.max_count)));
}

} // namespace traction::sim
