// reproduce.h - the experiments of the paper, figure by figure, made by our firmware on our simulator (docs/sources.md section 7).
//
// Each experiment says the paper's number, ours, the bound it is held to and where the bound comes from, and draws its figure.
#pragma once

#include <nlohmann/json.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace traction {

struct ReproduceSettings {
    std::string scenarios = "scenarios"; // folder of the gallery
    std::string bench_data;              // CSV of the CMU single-wheel bench; empty: that experiment is left out
    int seeds = 20;                      // of table III
    int jobs = 1;
    std::function<void()> after_run; // called after every simulated run
};

// One figure of merit against its bound.
struct Check {
    std::string what, paper, unit;
    double value = 0, low = 0, high = 0; // must lie in low..high
    std::string why;                     // where the bound comes from: docs/reproduce.md had it before the run
    std::optional<double> theirs = {};   // by the paper's own method, here
    bool of_ours = true;                 // false: a row about the paper's method alone
    bool within(double x) const { return x >= low && x <= high; }
    bool pass() const { return !of_ours || within(value); }
};

struct Experiment {
    std::string id, title, paper, ours, notes, svg;
    std::vector<Check> checks;
    std::string paper_here = {}; // the paper's method on our simulator, in words
    bool agrees() const;         // ours keeps every bound
    bool reproduced() const;     // the paper's method does, where it has a figure; else ours
};

struct SoilTable {
    std::vector<std::vector<nlohmann::json>> rows; // of table III
};

Experiment bench_curve(const ReproduceSettings &settings);                           // fig 3
Experiment radar_spectrum(const ReproduceSettings &settings);                        // fig 8
Experiment speed_error(const ReproduceSettings &settings);                           // (12)
Experiment fused_speed(const ReproduceSettings &settings);                           // fig 10
Experiment sweep_in_time(const ReproduceSettings &settings);                         // fig 11-13
Experiment soil_identification(const ReproduceSettings &settings, SoilTable &table); // fig 14, (21), table III, fig 15
Experiment blocked_wheels(const ReproduceSettings &settings);                        // fig 16
Experiment slip_servo(const ReproduceSettings &settings);                            // fig 17
Experiment measured_bench(const ReproduceSettings &settings);                        // a bench that others measured

// Scale of the paper's Doppler reading, calibrated on a drive with the camera as the paper did.
double calibrate_paper_radar(const ReproduceSettings &settings);

// All of them as "traction.figures/1" (host_tools/report/report.h), with "checks" and "pass" for programs.
nlohmann::json reproduce(const ReproduceSettings &settings);

} // namespace traction
