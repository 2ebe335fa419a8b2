// radar.h - a CW Doppler radar as its ADC sees it: echo along the track, band-pass, noise, offset, 10 bits, 512 Hz or another rate.
//
// One mixer channel: the real part of the echo, so its sign of speed is lost. The signal depends on the path travelled
// (radar_track.h). Not modelled: turning on the spot changes the echo only by what the radar travels along x.
// Noise: white and flicker, 1.0 and 0.5 counts rms at the ADC (assumed: 37 dB below the echo's 75 counts), plus rounding.
#pragma once

#include "radar_track.h"
#include "random.h"

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace traction::sim {

// A line that does not move with the ground: mains, a switching supply.
struct RadarLine {
    double frequency_Hz = 0, rms_count = 0;
};

struct RadarConfig {
    std::string_view model = "MDU1130";                            // of radar_models(), or "own": the five numbers that follow
    double frequency_Hz = 0, vertical_deg = 0, horizontal_deg = 0; // carrier, one-way beamwidths; 0: the model's
    double band_low_Hz = -1, band_high_Hz = 0;                     // -1, 0: the model's; a lower edge of 0 passes the offset of the mixer
    double rate_Hz = 512;                                          // of the converter; section IV: 256 points in about 0.5 s
    double depression_deg = 20;    // theta_d of (11), docs/sources.md section 4: where the description says that it is mounted
    double mounting_error_deg = 0; // added to it: where it really is
    double height_m = 0.3;         // docs/evidence.md section 2
    double ground_exponent = 1;    // n of sigma0 ~ sin^n
    double echo_count = 75;        // [ADC count] rms of the echo before the band-pass, assumed: 4 sigma inside 10 bits
    double noise_count = 1.0;      // [ADC count] rms white, assumed
    double flicker_count = 0.5;    // [ADC count] rms 1/f, assumed
    double offset_count = 512;     // [ADC count] mid-scale of 10 bits, as the description has it
    double offset_error_count = 0; // [ADC count] added to it: where the converter really rests
    std::vector<RadarLine> interference = {};
    int max_count = 1023;     // [ADC count] the converter's rail
    double dropout_per_s = 0; // [1/s] how often the echo fades out altogether
    double dropout_s = 0.3;   // [s] for how long
};

// A row of table II, Lhomme-Desages.
struct RadarModel {
    std::string_view name;
    double frequency_Hz = 0;
    double vertical_deg = 0, horizontal_deg = 0;
    double mass_kg = 0;
};
std::array<RadarModel, 4> radar_models();
RadarModel model_of(const RadarConfig &config); // throws std::logic_error for a name that is none

// 3..80 Hz at 9.9 GHz (section IV), moved in proportion for the other carriers and held below 0.469 of the rate (assumed): a high-pass
// and a low-pass of second order (Butterworth, order assumed), bilinear, prewarped.
class BandPass {
  public:
    BandPass(double low_Hz, double high_Hz, double rate_Hz);
    double step(double x);
    void settle(double x); // as if x had been there for ever

  private:
    struct Section {
        double b0, b1, b2, a1, a2, x1 = 0, x2 = 0, y1 = 0, y2 = 0;
        double step(double x);
    };
    Section high_pass_, low_pass_;
};

class Radar {
  public:
    static constexpr int count_max = 1023; // 10 bits

    Radar(const RadarConfig &config, std::uint64_t seed);

    // The next ADC value; path_m is where the rover is at that sample's instant.
    std::uint16_t sample(double path_m);
    RadarTrack &track() { return track_; }

  private:
    RadarConfig config_;
    RadarTrack track_;
    BandPass filter_;
    Random noise_, fade_;
    struct Flicker {
        double keep, gain, state = 0;
    };
    std::array<Flicker, 3> flicker_{};
    int faded_samples_ = 0;
    std::int64_t samples_ = 0;
    bool settled_ = false;
};

} // namespace traction::sim
