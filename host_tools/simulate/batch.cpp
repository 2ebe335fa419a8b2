#include "batch.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace traction {

void simulate_batch(const sim::Scenario &scenario, const std::function<SimulateOptions(std::uint64_t)> &options, std::uint64_t first,
                    std::uint64_t last, int jobs, const std::function<void(std::uint64_t, SimulationResult &&)> &done) {
    std::atomic<std::uint64_t> next{first};
    std::mutex mutex;
    std::exception_ptr failure;
    const auto work = [&] {
        for (;;) {
            const std::uint64_t seed = next++;
            if (seed > last) return;
            try {
                SimulateOptions own;
                {
                    const std::lock_guard lock(mutex);
                    if (failure) return;
                    own = options(seed);
                }
                if (own.stopped && own.stopped()) return;
                own.seed = seed;
                SimulationResult result = simulate(scenario, own);
                const std::lock_guard lock(mutex);
                if (failure) return;
                done(seed, std::move(result));
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!failure) failure = std::current_exception();
                return;
            }
        }
    };
    std::vector<std::jthread> threads;
    for (int i = 1; i < jobs; i++) threads.emplace_back(work);
    work();
    threads.clear(); // joins
    if (failure) std::rethrow_exception(failure);
}

} // namespace traction
