// lab_round_trip plant|independent|apart [FIRST LAST [SECONDS]] - the whole round trip, a table for docs/lab_benchmark.md. Run in the
// project's folder. Exit 1 where intervals of all parameters, or of all effects, do not hold the truth in 0.92 to 0.98 of the cases, within
// the error of the sample.
#include "round_trip.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iterator>
#include <map>
#include <utility>

int main(int count, char **arguments) {
    using namespace traction::round_trip;
    constexpr std::pair<const char *, Source> sources[] = {
        {"independent", Source::independent}, {"apart", Source::apart}, {"plant", Source::plant}};
    const auto *source = std::find_if(std::begin(sources), std::end(sources),
                                      [&](const auto &one) { return count >= 2 && std::strcmp(arguments[1], one.first) == 0; });
    const long first = count >= 4 ? std::atol(arguments[2]) : 1, last = count >= 4 ? std::atol(arguments[3]) : 100;
    const double duration_s = count >= 5 ? std::atof(arguments[4]) : 120;
    if (source == std::end(sources) || first < 1 || last < first || !(duration_s >= 20)) {
        std::fprintf(stderr, "usage: lab_round_trip plant|independent|apart [FIRST LAST [SECONDS]]   1 <= FIRST <= LAST, SECONDS >= 20\n");
        return 2;
    }
    try {
        std::vector<Estimate> all;
        for (long seed = first; seed <= last; ++seed) {
            const std::vector<Estimate> one = run(source->second, static_cast<std::uint64_t>(seed), duration_s);
            all.insert(all.end(), one.begin(), one.end());
            int inside = 0;
            for (const Estimate &e : one) inside += e.inside();
            std::fprintf(stderr, "seed %ld: %s, %d of %zu inside\n", seed, one.back().key.c_str(), inside, one.size());
        }
        const std::map<std::string, Tally> tallies = tally(all);
        std::printf("%s, seeds %ld to %ld, %.0f s each\n\n%s", arguments[1], first, last, duration_s, table(tallies).c_str());
        return tallies.at("all parameters").as_claimed() && tallies.at("all effects").as_claimed() ? 0 : 1;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "lab_round_trip: %s\n", error.what());
        return 3;
    }
}
