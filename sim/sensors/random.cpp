#include "random.h"

#include "sim/physics/math.h"

#include <cmath>

namespace traction::sim {

namespace {

std::uint64_t rotate(std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }

// FNV-1a: the name of a stream as 64 bits
std::uint64_t hash(std::string_view text) {
    std::uint64_t value = 0xcbf29ce484222325u;
    for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return value;
}

} // namespace

std::uint64_t mix64(std::uint64_t value) {
    value += 0x9e3779b97f4a7c15u;
    value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9u;
    value = (value ^ (value >> 27)) * 0x94d049bb133111ebu;
    return value ^ (value >> 31);
}

Random::Random(std::uint64_t seed) : state_{} {
    for (std::uint64_t &word : state_) {
        word = mix64(seed);
        seed += 0x9e3779b97f4a7c15u;
    }
}

Random::Random(std::uint64_t seed, std::string_view stream) : Random(mix64(seed) ^ hash(stream)) {}

std::uint64_t Random::bits() {
    const std::uint64_t result = rotate(state_[1] * 5, 7) * 9;
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = rotate(state_[3], 45);
    return result;
}

double Random::uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }

double Random::uniform(double low, double high) { return low + (high - low) * uniform(); }

double Random::normal() {
    if (have_spare_) {
        have_spare_ = false;
        return spare_;
    }
    double x = 0, y = 0, square = 0;
    do {
        x = 2 * uniform() - 1;
        y = 2 * uniform() - 1;
        square = x * x + y * y;
    } while (square >= 1 || square <= 0);
    const double scale = std::sqrt(-2 * math::log(square) / square);
    spare_ = y * scale;
    have_spare_ = true;
    return x * scale;
}

int Random::below(int count) { return static_cast<int>(uniform() * count); }

} // namespace traction::sim
