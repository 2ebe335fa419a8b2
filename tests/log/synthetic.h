// synthetic.h - a log of a four-wheeled rover made by kinematics and motor equations alone, for the tests of the check.
//
// The motion is prescribed (starts, stops, reverse over the same track, turns, a slip sweep); slip follows from the force by the
// inverse of (21), current from (17), duty from the voltage balance. Nothing of the simulator or the lab is used.
#pragma once

#include "host_tools/log/log.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace traction::test {

struct Drive {
    std::uint64_t seed = 1;
    double noise = 1;          // factor on every sensor noise
    double soil_noise_N = 0.2; // standard deviation of the force on each wheel
    double grip_N = 5.6;       // Fm of (21)
    bool rich = true;          // false: constant speed straight ahead
};

log::Log drive(const Drive &how);

// Changes one signal of a log in place.
log::Signal &at(log::Log &log, std::string_view name);
void scale(log::Log &log, const std::string &name, double factor);
void exchange(log::Log &log, const std::string &a, const std::string &b);

// splitmix64: (Steele, Lea, Flood 2014), and a normal deviate as the sum of twelve uniform ones (deviates beyond 6 do not occur).
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    double uniform();
    double normal();

  private:
    std::uint64_t state_;
};

} // namespace traction::test
