// simulate.h - runs a scenario: the rover's own loop (daemon_run) on the simulated rover in lockstep, everything recorded.
//
// A device that times out is left to safety, as on the rover: the run goes on.
// The same scenario, seed and effects give the same log, byte for byte.
#pragma once

#include "firmware/core/self_test.h"
#include "hal/hal.h"
#include "host_tools/log/log.h"
#include "sim/scenario/scenario.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace traction {

struct SimulateOptions {
    std::optional<std::uint64_t> seed;      // instead of the scenario's
    std::vector<sim::ActiveEffect> effects; // beside the scenario's
    std::optional<sim::HiddenDraw> hide;    // instead of the scenario's [hidden]
    std::optional<std::string> firmware;    // "default" or "paper", instead of the scenario's
    bool record = true;                     // false: run only (benchmarks)
    bool truth = false;                     // fill SimulationResult::truth
    std::string log_path, truth_path;       // written as CSV instead of kept in memory, which does not grow with the run; empty: not
    std::string radar_path;                 // where the radar's samples go instead of into the log, as truth_path; empty: they stay
    bool realtime = false;                  // keep pace with the wall clock
    bool warm = false;                      // a restart: the windings are taken to be warm
    bool self_test = false;                 // before the drive plan; what fails ends the run
    std::string frames_path;                // replay text, one line a tick; empty: none
    std::function<void()> after_second;     // called after every simulated second
    std::function<void(const trace_t &)> after_tick; // every tick, with what the firmware made of it
    std::function<bool()> stopped;                   // asked before every tick; true ends the run, and its log says so (header `ended`)
};

struct SimulationResult {
    log::Log log;                          // its header alone where it was written to a path
    log::Log truth;                        // empty unless asked for
    std::vector<sim::ActiveEffect> hidden; // what was drawn; goes to the seal and nowhere else
    std::uint64_t hide_seed = 0;
    hal_result_t ended_by = HAL_END;                        // HAL_END: the scenario's duration; negative: a device was lost
    bool interrupted = false;                               // by SimulateOptions::stopped
    std::vector<std::pair<std::string, std::string>> parts; // of a run that was interrupted: LOG.part, LOG, which stood already and stays
    std::uint64_t ticks = 0;
    std::uint32_t faults = 0;       // fault_t bits that the firmware has latched
    self_test_result_t self_test{}; // all zero unless asked for
    std::uint64_t trace_hash = 0;   // FNV-1a over every trace, for comparing runs
};

// Throws FileError where a path cannot be written.
SimulationResult simulate(const sim::Scenario &scenario, const SimulateOptions &options = {});

} // namespace traction
