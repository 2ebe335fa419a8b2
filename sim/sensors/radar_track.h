// radar_track.h - the radar echo of a stretch of ground: a complex signal that depends on the rover's place alone.
//
// A scatterer j at (x_j, y_j), x_j along the track, seen from p by a radar at height h looking forward and down:
//   r = sqrt((x_j-p)^2 + y_j^2 + h^2)                                                            (1)
//   z(p) = sum_j A_j G(theta, psi) r^-2 sin(theta)^(n/2) exp(-i 4 pi r/lambda)                   (2)
// A_j complex normal (rough ground), theta depression, psi azimuth, n the ground's exponent (sigma0 ~ sin^n), G the antenna's
// two-way amplitude: a Gaussian whose one-way power falls to half at half the beamwidth, applied twice.  docs/evidence.md section 2
// Any speed profile, backward too, is a reading of z along p, so speckle repeats when the rover passes the same place again.
// z is kept without its carrier exp(i 4 pi p cos(theta_d)/lambda) on nodes lambda/6 apart and read by cubic interpolation.
#pragma once

#include <complex>
#include <cstdint>
#include <map>
#include <vector>

namespace traction::sim {

// One radar of table II (Lhomme-Desages), as it is mounted.
struct RadarBeam {
    double frequency_Hz = 9.9e9; // f0
    double vertical_deg = 36;    // one-way beamwidth
    double horizontal_deg = 72;  // one-way beamwidth
    double depression_deg = 20;  // theta_d plus the mounting error
    double height_m = 0.3;       // docs/evidence.md section 2
    double ground_exponent = 1;  // n, 0..2
};

inline constexpr double light_speed_m_s = 299792458.0;

class RadarTrack {
  public:
    // Two tracks of the same beam and seed are equal; different seeds are different ground.
    RadarTrack(const RadarBeam &beam, std::uint64_t seed);
    ~RadarTrack();
    RadarTrack(RadarTrack &&) noexcept;

    // (2) at path position p, mean power 1 over the ground.
    std::complex<double> echo(double position_m);

    double wavelength_m() const { return wavelength_m_; }
    double node_m() const { return node_m_; }
    // Mean Doppler over the nominal 2 v cos(theta_d)/lambda of (11), from the weights of (2): what a perfect mean would read.
    double mean_ratio() const { return mean_ratio_; }

  private:
    static constexpr int chunk_nodes = 256;
    struct Line {
        std::vector<float> re, im;
    };
    using Chunk = Line;
    static void add(const Line &line, std::int64_t tap, float a, float b, Chunk &sum, std::int64_t at, std::int64_t count);
    const Chunk &chunk(std::int64_t index);
    std::complex<double> node(std::int64_t index);
    void make_response(const RadarBeam &beam);

    std::uint64_t seed_;
    double wavelength_m_, node_m_, carrier_turns_m_;
    double mean_ratio_ = 0;
    int first_tap_ = 0, taps_ = 0, per_cell_ = 0; // response reaches from first_tap_ nodes ahead
    std::vector<Line> response_;                  // per row of scatterers, farthest tap first
    std::map<std::int64_t, Chunk> chunks_;
    std::int64_t last_index_ = INT64_MIN;
    const Chunk *last_chunk_ = nullptr;
};

} // namespace traction::sim
