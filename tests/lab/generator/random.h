// random.h - seeded numbers of the independent generator: PCG32 (O'Neill 2014) and normals by the polar method.
#pragma once

#include <cmath>
#include <cstdint>

namespace traction::generator {

class Random {
  public:
    Random(std::uint64_t seed, std::uint64_t stream) : increment_((stream << 1U) | 1U) {
        bits();
        state_ += seed * 0x9e3779b97f4a7c15ULL + 0x632be59bd9b4e019ULL;
        bits();
    }
    std::uint32_t bits() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ULL + increment_;
        const auto shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
        const auto turn = static_cast<std::uint32_t>(old >> 59U);
        return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
    }
    double uniform(double low = 0, double high = 1) { return low + (high - low) * (bits() + 0.5) / 4294967296.0; }
    double log_uniform(double low, double high) { return low * std::exp(uniform() * std::log(high / low)); }
    int below(int count) { return static_cast<int>(uniform(0, count)); }
    double sign() { return (bits() & 1U) != 0 ? 1.0 : -1.0; }
    double normal() {
        for (;;) {
            const double u = uniform(-1, 1), v = uniform(-1, 1), r = u * u + v * v;
            if (r > 0 && r < 1) return u * std::sqrt(-2 * std::log(r) / r);
        }
    }

  private:
    std::uint64_t state_ = 0;
    std::uint64_t increment_;
};

} // namespace traction::generator
