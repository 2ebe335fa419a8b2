// generator.h - independent sealed logs for the blind campaign: a rover nobody in host_tools or sim wrote, driven and measured.
#pragma once

#include "kinds.h"
#include "machine.h"

#include "host_tools/log/log.h"

#include <cstdint>
#include <string>
#include <vector>

namespace traction::generator {

struct GeneratorConfig {
    Soil soil = Soil::sand;
    std::string drive = "full"; // full, cruise, stairs, sweep
    double duration_s = 120;
    std::uint64_t seed = 1;       // machine, drive, ground and noise
    std::uint64_t noise_seed = 0; // another value: the same run with other sensor noise (a repeat run)
    std::vector<Setting> hidden;
    bool apart = false; // every wheel drawn for itself (WheelSpread); false: the logs of the first blind sets, to the last digit
    bool exact = false; // nominal machine, no ground noise (for checks)
    bool quiet = false; // no sensor noise (for checks)
    bool camera = true, radar = true, battery = true;
    bool truth = false; // add truth.* columns (for checks; sealed logs never have them)
};

// The measured log, header with the sensors' specifications ("noise.<signal>"), never with what is hidden.
log::Log generate(const GeneratorConfig &config);

// The machine that `config` draws (the seal keeps it, so that a judge can tell which nuisance was off).
Machine machine_of(const GeneratorConfig &config);

// The model that the operator would write: the data sheet's values, one for all wheels, and its tolerances.
std::string data_sheet(const GeneratorConfig &config);

Soil soil_of(const std::string &name); // throws std::invalid_argument
std::string name_of(Soil soil);

// What a blind campaign hides under this seed: clean, one, two (of the catalogue) or outside; soil drawn too.
struct BlindCase {
    std::string category; // "clean", "one", "two", "outside"
    GeneratorConfig config;
};
BlindCase draw_case(std::uint64_t seed, double duration_s);

} // namespace traction::generator
