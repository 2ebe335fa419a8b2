// round_trip.h - simulate with known numbers, fit, and count how many of them lie inside the fit's 95 % intervals.
//
// Sources of logs: the independent rover (tests/lab/generator, its machine drawn off its data sheet), the same with every wheel drawn for
// itself (the first wheel's numbers are judged), and the ODE plant (the model's own numbers moved by their priors). One effect of known
// size is hidden in each and its place in the model is given to the fit: what is judged is the interval, not the search.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace traction::round_trip {

enum class Source { independent, apart, plant };

struct Estimate {
    std::string key; // "motor.resistance_ohm"; "effect: slip_sinkage" for the hidden effect's strength
    double truth = 0, value = 0, low = 0, high = 0;
    std::uint64_t log = 0; // seed of the log it was fitted to
    bool inside() const { return low <= truth && truth <= high; }
    double standard_errors() const { return (value - truth) / ((high - low) / (2 * 1.96)); }
};

// One log: simulated, fitted, compared. Throws what the lab throws.
std::vector<Estimate> run(Source source, std::uint64_t seed, double duration_s);

// An estimate as JSON {log, key, truth, value, low, high, inside} and back, without loss: what is not finite is a text.
nlohmann::json estimate_json(const Estimate &);
Estimate read_estimate(const nlohmann::json &); // throws nlohmann::json::exception where it is none

struct Tally {
    int inside = 0, count = 0;
    double sum = 0, squares = 0;                         // of the distance, estimate minus truth, in standard errors
    std::map<std::uint64_t, std::pair<int, int>> of_log; // inside, count: what one log gives errs together

    double share() const { return static_cast<double>(inside) / count; }
    // Standard error of the share, logs being what is drawn; never less than independent intervals of 0.92 would have.
    double share_error() const;
    // Do these intervals hold the truth as often as 95 % intervals are to, 0.92 to 0.98, within the error of a sample of this size? False
    // where a lab with that coverage would give such a sample once in two hundred (2.58 standard errors, one side).
    // least: of what is published, where that is less (the plant).
    bool as_claimed(double least = 0.92) const;
};

// By key, and "all effects", "all parameters".
std::map<std::string, Tally> tally(const std::vector<Estimate> &estimates);

std::string table(const std::map<std::string, Tally> &tallies);

} // namespace traction::round_trip
