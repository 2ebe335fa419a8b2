// hidden.h - an effect drawn by seed and kept from the reader: what the demo and the game hide, and the seal that tells it.
//
// A draw depends on its seed alone. The seal is the only place where it is written; logs never hold it.
#pragma once

#include "sim/physics/effects/catalogue.h"

#include <cstdint>
#include <string>
#include <vector>

namespace traction::sim {

struct HiddenDraw {
    std::uint64_t seed = 0;
    int count = 1;                  // how many effects
    std::vector<std::string> among; // names to draw from; empty: the whole catalogue
};

// The drawn effects, each with a size between a quarter and three quarters of its plausible range, sign and wheel at random.
std::vector<ActiveEffect> draw_effects(const HiddenDraw &draw);

// The sealed truth as JSON text, schema "traction.seal/1".
std::string seal_text(const std::vector<ActiveEffect> &effects, const std::string &scenario, std::uint64_t hide_seed);

} // namespace traction::sim
