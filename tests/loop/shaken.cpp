// A rover that its motors shake to and fro by duty alone: rovers, soils, periods, duties and slopes. Prints the drives in which the
// firmware neither knows its speed nor that it does not (error beyond 4 cm/s and NEES beyond 2), or has a wrong sign for more than 0.5 s,
// or names a fault; and how many of all those are.
//   shaken_run [FIRST]      seeds from there on, each drive its own [1]
#include "host_tools/simulate/simulate.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace traction;

namespace {

struct Drive {
    const char *rover, *soil;
    double period_s, duty, slope_rad;
};

SimulationResult drive(const Drive &is, std::uint64_t seed) {
    const std::string text = "duration_s = 22.0\nrover = \"rovers/" + std::string(is.rover) + ".toml\"\n[ground]\nsoil = \"" + is.soil +
                             "\"\nslope_rad = " + std::to_string(is.slope_rad) +
                             "\n[[drive]]\nfor_s = 1.0\nmode = \"stop\"\n"
                             "[[drive]]\nfor_s = 4.0\nmode = \"platform_speed\"\nspeed_m_s = 0.3\n"
                             "[[drive]]\nfor_s = 14.0\nmode = \"open_loop\"\nduty = { amplitude = " +
                             std::to_string(is.duty) + ", period_s = " + std::to_string(is.period_s) +
                             " }\n[[drive]]\nfor_s = 3.0\nmode = \"stop\"\n";
    SimulateOptions options;
    options.seed = seed;
    options.truth = true;
    return simulate(sim::parse_scenario(text, "scenarios/shaken.toml"), options);
}

// Whether the drive meets the goals; prints it where it does not.
bool judged(const Drive &is, std::uint64_t seed, double &worst_m_s) {
    const SimulationResult result = drive(is, seed);
    const log::Signal &v = *result.truth.find("truth.speed_m_s"), &e = *result.log.find("estimate.speed_m_s"),
                      &std = *result.log.find("estimate.speed_std_m_s");
    const std::size_t n = std::min({v.value.size(), e.value.size(), std.value.size()});
    double squares = 0, nees = 0, worst = 0;
    int wrong = 0, longest = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double off = e.value[i] - v.value[i];
        squares += off * off, nees += off * off / (std.value[i] * std.value[i]);
        worst = std::max(worst, std::fabs(off));
        const bool other = e.value[i] * v.value[i] < 0 && std::min(std::fabs(e.value[i]), std::fabs(v.value[i])) > 0.05;
        wrong = other ? wrong + 1 : 0;
        longest = std::max(longest, wrong);
    }
    const double count = static_cast<double>(n), rms = std::sqrt(squares / count);
    worst_m_s = std::max(worst_m_s, worst);
    const bool met = (rms <= 0.04 || nees / count <= 2) && longest <= 50 && result.faults == 0;
    if (!met)
        std::printf("%-16s %-9s period %.1f s, duty %.1f, slope %5.2f, seed %3llu: %5.1f cm/s, worst %4.2f m/s, NEES %5.2f, sign %.2f s, "
                    "faults %x\n",
                    is.rover, is.soil, is.period_s, is.duty, is.slope_rad, static_cast<unsigned long long>(seed), 100 * rms, worst,
                    nees / count, 0.01 * longest, static_cast<unsigned>(result.faults));
    return met;
}

} // namespace

int main(int argc, char **argv) {
    std::uint64_t seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
    for (const char *rover : {"heavy", "lhomme_desages", "two_wheels"}) {
        int bad = 0, all = 0;
        double worst_m_s = 0;
        for (const char *soil : {"concrete", "gravel", "sand", "loam", "snow"})
            for (const double period_s : {1.0, 1.5, 2.0, 3.0, 5.0})
                for (const double duty : {0.5, 0.7, 0.9})
                    for (const double slope_rad : {0.0, 0.06, -0.06}) {
                        bad += judged({rover, soil, period_s, duty, slope_rad}, seed++, worst_m_s) ? 0 : 1;
                        ++all;
                    }
        std::printf("%s: %d of %d miss, worst error %.2f m/s\n", rover, bad, all, worst_m_s);
    }
}
