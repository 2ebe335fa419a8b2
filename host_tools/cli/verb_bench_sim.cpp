// verb_bench_sim.cpp - traction bench sim: how fast the simulator is, beside its peers (tests/bench/sim_bench).
#include "bench_program.h"
#include "verbs.h"

#include <memory>

namespace traction::cli {

Verb verb_bench_sim() {
    const auto rounds = std::make_shared<int>(5);
    return {.name = "bench sim",
            .summary = "simulated seconds per CPU second, beside ODE contacts and MuJoCo",
            .options = {{.name = "--rounds",
                         .into = rounds.get(),
                         .help = "interleaved rounds; the median is shown",
                         .shows_default = true,
                         .range = Range{1, 1000}}},
            .run = [rounds](Outcome &outcome) {
                run_bench("sim_bench", {"--rounds", std::to_string(*rounds)}, outcome);
            }};
}

} // namespace traction::cli
