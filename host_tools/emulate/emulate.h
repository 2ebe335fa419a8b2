// emulate.h - one run on the emulated board: the shipped tractiond, in lockstep with a scenario's plant, and the same run in process.
#pragma once

#include "world.h"

#include "firmware/core/control.h"

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace traction::emulate {

struct Options {
    std::string board;      // folder of zImage, versatile-pb.dtb, initramfs
    std::string folder;     // of the run; made, and what lies there is replaced
    std::string parameters; // a parameter file instead of the scenario's rover's
    std::string flash; // the board's NOR flash: the version in its slots drives, with the description and parameters it was packed with
    std::uint64_t seed = 1;
    std::vector<sim::ActiveEffect> effects; // all of them
    Sensors sensors = Sensors::can;
    std::function<bool()> stopped = {};      // asked at each record; true stops the board as its operator would
    std::function<void()> after_second = {}; // called after every second of the plant
};

struct Run {
    Counts counts;
    std::uint32_t ticks = 0;            // lines of the board's trace
    int status = 0;                     // exit code of tractiond
    std::uint32_t faults = 0;           // latched at its last tick
    std::string said;                   // its words
    double cpu_s = 0, ran_s = 0;        // processor time of tractiond; from its first SYNC to its last record, both on the board's clock
    std::uint32_t memory_kB = 0;        // its largest resident set
    std::string trace_sha, records_sha; // SHA-256 of the trace; of all records with their times
    std::vector<std::string> logs;      // ULog files that it wrote
    bool interrupted = false;
};

// Throws std::runtime_error when the board cannot be started or breaks off, sim::ScenarioError for what it cannot have.
Run run_on_board(const sim::Scenario &scenario, const Options &options);

struct Difference {
    std::uint32_t ticks = 0; // that were compared
    bool equal = false;
    std::uint32_t tick = 0;  // the first that differs
    std::string here, there; // that line of the trace, in process and on the board
};

// The run in process beside the trace of the board, with what the board's clock read at each tick (its log tells), and with its orders
// as late in their ticks as the board's were.
Difference compare_in_process(const sim::Scenario &scenario, const Options &options, const Run &run);

} // namespace traction::emulate
