// batch.h - the same scenario over many seeds, several at a time.
#pragma once

#include "simulate.h"

#include <cstdint>
#include <functional>

namespace traction {

// Calls done(seed, result) for every seed first..last, in any order, never two at once. jobs: how many threads, >= 1.
// The first exception thrown by a run or by done stops the rest and is thrown again here.
void simulate_batch(const sim::Scenario &scenario, const SimulateOptions &options, std::uint64_t first, std::uint64_t last, int jobs,
                    const std::function<void(std::uint64_t, SimulationResult &&)> &done);

} // namespace traction
