// random.h - seeded random numbers whose bytes are the same on every machine.
//
// xoshiro256** (Blackman and Vigna, public domain, 2018) seeded by splitmix64; normal deviates by the polar method (Marsaglia
// and Bray 1964) with the simulator's own logarithm, so no library decides a bit of a log.
#pragma once

#include <cstdint>
#include <string_view>

namespace traction::sim {

// One step of splitmix64: mixes any 64 bits into 64 good ones.
std::uint64_t mix64(std::uint64_t value);

class Random {
  public:
    explicit Random(std::uint64_t seed);
    // An independent stream: the same seed with another name ("imu.accel") never shares numbers.
    Random(std::uint64_t seed, std::string_view stream);

    std::uint64_t bits();
    double uniform();                        // [0, 1), 53 bits
    double uniform(double low, double high); // [low, high)
    double normal();                         // mean 0, standard deviation 1
    int below(int count);                    // 0..count-1, count > 0

  private:
    std::uint64_t state_[4];
    double spare_ = 0;
    bool have_spare_ = false;
};

} // namespace traction::sim
