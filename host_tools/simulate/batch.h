// batch.h - the same scenario over many seeds, several at a time.
#pragma once

#include "simulate.h"

#include <cstdint>
#include <functional>

namespace traction {

// Runs every seed first..last as options(seed) says and calls done(seed, result), in any order, neither of them two at once: a run
// writes its own files, beside the others. jobs: how many threads, >= 1. What `stopped` of the options ends is the last of its thread.
// The first exception thrown by a run or by done stops the rest and is thrown again here.
void simulate_batch(const sim::Scenario &scenario, const std::function<SimulateOptions(std::uint64_t)> &options, std::uint64_t first,
                    std::uint64_t last, int jobs, const std::function<void(std::uint64_t, SimulationResult &&)> &done);

} // namespace traction
