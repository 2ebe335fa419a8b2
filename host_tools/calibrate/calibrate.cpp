#include "calibrate.h"

#include "radar_model.h"

#include "firmware/core/rover_config.h"
#include "host_tools/report/report.h"
#include "host_tools/rover/rover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>
#include <vector>

namespace traction {

namespace {

constexpr int window_samples = 256;
constexpr double slowest_m_s = 0.15;   // below, 1 mm of camera noise at 7 Hz is more than 5 %, and the band-pass blinds the radar
constexpr double steady_share = 0.12;  // largest spread of the true speed within a window
constexpr double model_std = 0.003;    // [1] of the scale: (2)'s radar against the tests' and the simulator's, measured 0 to 0.3 %
constexpr int modelled_windows = 2000; // 2.5 % of spread each: 0.06 % of the scale
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

struct Pair {
    double reference, radar;
};

double ratio(const std::vector<Pair> &pairs, std::size_t from, std::size_t to) { // leaves from..to out
    double reference = 0, radar = 0;
    for (std::size_t i = 0; i < pairs.size(); i++)
        if (i < from || i >= to) reference += pairs[i].reference, radar += pairs[i].radar;
    return reference / radar;
}

// Angle at which (2) gives this scale on ground of this exponent. The scale rises with the angle; the table is read backwards.
class AngleTable {
  public:
    AngleTable(const doppler_template_t &beam, double exponent, const std::vector<double> &speed_m_s) {
        const int repeats = std::max(1, modelled_windows / static_cast<int>(speed_m_s.size()));
        std::vector<RadarGuess> guesses;
        for (double angle = lowest_deg; angle <= highest_deg; angle += step_deg)
            guesses.push_back({.angle_deg = angle, .ground_exponent = exponent});
        for (const double scale : modelled_scales(beam, guesses, speed_m_s, repeats))
            scale_.push_back(scale_.empty() ? scale : std::max(scale, scale_.back() + 1e-6)); // rising, whatever the draws say
    }
    double angle_deg(double scale) const {
        const auto above = std::upper_bound(scale_.begin(), scale_.end(), scale);
        if (above == scale_.begin()) return lowest_deg;
        if (above == scale_.end()) return highest_deg;
        const auto i = static_cast<std::size_t>(above - scale_.begin());
        return lowest_deg + step_deg * (static_cast<double>(i) - (scale_[i] - scale) / (scale_[i] - scale_[i - 1]));
    }

  private:
    static constexpr double lowest_deg = 4, highest_deg = 44, step_deg = 5;
    std::vector<double> scale_;
};

// Every n-th of the reference speeds: what (2) is drawn at.
std::vector<double> speeds_of(const std::vector<Pair> &pairs) {
    std::vector<double> out;
    const std::size_t step = std::max<std::size_t>(1, pairs.size() / 100);
    for (std::size_t i = 0; i < pairs.size(); i += step) out.push_back(pairs[i].reference);
    return out;
}

} // namespace

static constexpr double narrow_deg = 20, narrow_per_deg = 0.00635; // tan 20 deg per degree

Calibration calibrate(const log::Log &log, CalibrationTruth truth, double wheel_radius_m) {
    const log::Signal *adc = log.find("radar.adc_count");
    if (adc == nullptr)
        throw log::LogError(log.source, 0, 0, "no column radar.adc_count",
                            "record the radar's samples: the speed alone cannot be calibrated");
    std::optional<Speed> speed;
    Calibration out;
    if (truth != CalibrationTruth::wheels && (speed = camera_speed(log))) out.truth = "camera";
    if (!speed && truth != CalibrationTruth::camera && (speed = wheel_speed(log, wheel_radius_m))) out.truth = "wheels";
    if (!speed)
        throw log::LogError(log.source, 0, 0, "no true speed",
                            "give camera.x_m and camera.y_m, or the four wheel speeds of a drive on firm ground");

    const rover_parameters_t rover = parameters_of_lines(log.header).rover;
    control_config_t config;
    control_config_build(&rover, &config);
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
    for (std::size_t b = 0; b < blocks; b++)
        mean += (without[b] = ratio(pairs, pairs.size() * b / blocks, pairs.size() * (b + 1) / blocks)) / blocks;
    for (const double value : without) out.scale_std += (value - mean) * (value - mean);
    out.scale_std = std::sqrt(out.scale_std * (blocks - 1) / blocks); // jackknife: blocks are longer than a window's memory
    const std::vector<double> speeds = speeds_of(pairs);
    const double spread = std::hypot(out.scale_std, model_std);
    if (rover.radar !=
        ROVER_RADAR_MDU1130) { // of a narrow beam the angle goes with cos theta_d, whatever the ground: rover_parameters.h (7)
        out.angle_deg = narrow_deg + (out.scale - 1) / narrow_per_deg;
        out.angle_by_exponent_deg.fill(out.angle_deg);
        out.angle_std_deg = out.angle_known_ground_std_deg = out.scale_std / narrow_per_deg;
        return out;
    }
    for (std::size_t n = 0; n < out.angle_by_exponent_deg.size(); n++) {
        const AngleTable table(*config.doppler.beam, static_cast<double>(n), speeds);
        out.angle_by_exponent_deg[n] = table.angle_deg(out.scale);
        if (n == 1) out.angle_known_ground_std_deg = 0.5 * (table.angle_deg(out.scale + spread) - table.angle_deg(out.scale - spread));
    }
    out.angle_deg = out.angle_by_exponent_deg[1];
    const double ground =
        (out.angle_by_exponent_deg[0] - out.angle_by_exponent_deg[2]) / std::sqrt(12.0); // exponent 0 to 2, all as likely (assumed)
    out.angle_std_deg = std::hypot(out.angle_known_ground_std_deg, ground);
    return out;
}

void put_parameter(const std::string &path, const std::string &key, double value, const std::string &comment) {
    std::string text, line;
    std::ifstream file(path);
    if (!file.is_open() && std::filesystem::exists(path)) // what stands in it would be lost
        throw log::FileError(path, 0, 0, "cannot be read, so nothing is put into it", "check its permissions");
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
