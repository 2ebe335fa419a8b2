// verb_bench_speed.cpp - traction bench speed: ground speed by the paper's method and by ours, table by profile
// (tests/bench/speed_bench: radar signals from the tests' own generator and from the simulator).
#include "bench_program.h"
#include "verbs.h"

#include <memory>

namespace traction::cli {

Verb verb_bench_speed() {
    const auto seeds = std::make_shared<int>(12);
    return {.name = "bench speed",
            .summary = "ground speed from the radar: the paper's method and ours, by profile; exit 1 when a goal is missed",
            .options = {{.name = "--seeds",
                         .into = seeds.get(),
                         .help = "radar tracks of each profile; a third of them for the misfits",
                         .shows_default = true,
                         .range = Range{1, 1000}}},
            .run = [seeds](Outcome &outcome) {
                run_bench("speed_bench", {"--seeds", std::to_string(*seeds)}, outcome);
            }};
}

} // namespace traction::cli
