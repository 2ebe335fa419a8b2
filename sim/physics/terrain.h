// terrain.h - the shape of ground that is not flat: steps and ramps along a heading, a height map, roughness; and where a wheel rests on
// it.
//
//   Gd(n) = Gd(n0) (n/n0)^-2, n0 = 0.1 1/m       ISO 8608: one-sided spectrum of the height along a track [m^3], n in cycles per metre (1)
//   S(k) = Gd(n0) n0^2/(4 k^3)                   the field that has (1) along every straight track: the integral of S over the wave
//                                                number across is Gd/2 (both signs); derived here                                    (2)
//   z(x) -> s z(x/s) of a rover s times as large as the vehicle that (1) was written for: Gd -> s Gd                                 (3)
//   e = max_u [h(x + u c, y + u s) + sqrt(R^2 - u^2)] - R   how high a rigid disc that heads along (c, s) is carried                 (4)
//   grad e = u/sqrt(R^2 - u^2) ahead, dh across             of the place it touches (envelope theorem)                              (5)
// Heights in metres, world coordinates. Waves of (1) from longest_m to shortest_m; everything is a pure function of place and seed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

namespace traction::sim {

// Heights on a square lattice; between its nodes Catmull-Rom, beyond its edge the edge's.
struct HeightMap {
    int columns = 0, rows = 0;            // along x, along y; each at least 2
    double cell_m = 0.02;                 // > 0
    double x_m = 0, y_m = 0;              // of the first node
    std::vector<double> height_m;         // row by row, y ascending
    double at(int column, int row) const; // clamped into the map
};

inline constexpr std::size_t height_map_most = 4'000'000; // nodes: 32 MB

// Reads a CSV of numbers, one row of the lattice a line, y ascending; `#` begins a comment. Throws std::runtime_error with file, line,
// field.
HeightMap read_height_map(const std::string &path, double cell_m, double height_scale);

// Whether it is to be read as a picture: its name ends in .png, or it begins as a PNG does.
bool is_height_picture(const std::string &path);

// Reads a grey PNG of 8 or 16 bit, interlaced or not, as one looks at a map: x to the right, y up, so that the lowest line of pixels is
// the first row. Height of a pixel c of 0..2^bits - 1: black_m + c (white_m - black_m)/(2^bits - 1). Counts are taken as they stand: no
// gamma, no colour profile. Throws std::runtime_error with file and mend for what is no such picture, is torn, or has more than
// height_map_most pixels.
HeightMap read_height_picture(const std::string &path, double cell_m, double black_m, double white_m);

struct ProfilePoint {
    double distance_m = 0, height_m = 0;
};

struct Terrain {
    std::vector<ProfilePoint> profile; // heights by the distance along profile_direction_rad, straight between; two at one distance: a step
    double profile_direction_rad = 0;
    double roughness_m3 = 0;                  // Gd(n0) after (3); 0: none
    double shortest_m = 0.05, longest_m = 10; // waves of the roughness
    std::shared_ptr<const HeightMap> map;
    bool flat() const { return profile.empty() && roughness_m3 <= 0 && !map; }
};

// Geometric mean of Gd(n0) of an ISO 8608 class, 'A' to 'H' [m^3]; 0 for another letter.
double iso_8608_m3(char roughness_class);

// Where a wheel rests.
struct Rest {
    double height_m = 0;                  // e of (4): of the lowest point of its rim
    double rise_ahead = 0, rise_left = 0; // (5) [1]
};

// Reads heights; keeps those lattice nodes of the roughness that were asked for. The answer does not depend on the order of questions.
class Relief {
  public:
    Relief(const Terrain &terrain, std::uint64_t seed);

    double height_m(double x_m, double y_m);
    // (4), (5) of a disc with its axle over (x, y), heading along the unit vector (c, s); across its width the profile is averaged and the
    // rest of the ground taken at its middle. u is searched within 0.95 R: a wall higher than 0.69 R stops a wheel like one of 0.69 R.
    Rest rest(double x_m, double y_m, double c, double s, double radius_m, double width_m);

  private:
    static constexpr int block = 16; // nodes
    using Block = std::array<double, block * block>;
    struct Wave {
        double kx, ky, phase, amplitude_m;
    };
    struct Cut { // the profile as a wheel meets it
        double origin_m, along, blur_m;
    };
    double rough_m(double x_m, double y_m);
    double node_m(std::int64_t i, std::int64_t j);
    double smooth_m(double x_m, double y_m); // roughness and map
    double profile_m(double distance_m, double blur_m) const;
    double profile_area(double distance_m) const;
    double carried_m(double u, double x_m, double y_m, double c, double s, double radius_m, const Cut &cut, double most_m = 1e9);

    Terrain terrain_;
    double ahead_x_, ahead_y_; // unit vector of the profile
    double node_step_m_;
    std::vector<double> area_; // integral of the profile up to each of its points
    std::vector<Wave> waves_;
    std::unordered_map<std::uint64_t, std::unique_ptr<Block>> blocks_;
    std::uint64_t last_key_ = 0;
    const Block *last_ = nullptr;
};

} // namespace traction::sim
