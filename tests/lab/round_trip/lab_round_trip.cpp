// lab_round_trip [plant|independent] [FIRST LAST [SECONDS]] - the whole round trip, a table for docs/lab_benchmark.md. Run in the project's
// folder.
#include "round_trip.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

int main(int count, char **arguments) {
    using namespace traction::round_trip;
    const bool known = count >= 2 && (std::strcmp(arguments[1], "plant") == 0 || std::strcmp(arguments[1], "independent") == 0);
    const long first = count >= 4 ? std::atol(arguments[2]) : 1, last = count >= 4 ? std::atol(arguments[3]) : 100;
    const double duration_s = count >= 5 ? std::atof(arguments[4]) : 120;
    if (!known || first < 1 || last < first || !(duration_s >= 20)) {
        std::fprintf(stderr, "usage: lab_round_trip plant|independent [FIRST LAST [SECONDS]]   1 <= FIRST <= LAST, SECONDS >= 20\n");
        return 2;
    }
    try {
        std::vector<Estimate> all;
        for (long seed = first; seed <= last; ++seed) {
            const std::vector<Estimate> one = run(std::strcmp(arguments[1], "plant") == 0 ? Source::plant : Source::independent,
                                                  static_cast<std::uint64_t>(seed), duration_s);
            all.insert(all.end(), one.begin(), one.end());
            int inside = 0;
            for (const Estimate &e : one) inside += e.inside();
            std::fprintf(stderr, "seed %ld: %s, %d of %zu inside\n", seed, one.back().key.c_str(), inside, one.size());
        }
        std::printf("%s, seeds %ld to %ld, %.0f s each\n\n%s", arguments[1], first, last, duration_s, table(tally(all)).c_str());
    } catch (const std::exception &error) {
        std::fprintf(stderr, "lab_round_trip: %s\n", error.what());
        return 3;
    }
    return 0;
}
