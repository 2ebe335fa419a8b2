// campaign.h - a blind campaign: sealed logs made by other programs, the lab run on each, the seals opened when all answers are in.
//
// The logs come from lab_generate (rovers that share no code with the lab) or from `traction simulate` (the ODE plant). Both run
// as processes of their own and write what they hid to a seal beside the log; this program reads the seals in open_seals() alone.
#pragma once

#include "score.h"

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace traction::bench_lab {

// A generator that draws length, sensors and habits by the seed.
inline bool draws_its_own(std::string_view generator) { return generator == "fleet" || generator == "strange" || generator == "bent"; }

struct CampaignOptions {
    int logs = 250;
    int jobs = 2;
    std::uint64_t seed = 1000; // of the first log; the others follow
    double duration_s = 120;
    std::string generator = "independent"; // wheels alike; "apart": each drawn for itself; "fleet": sizes, sensors, plans; "strange": and
                                           // habits; "bent": the fleet on grounds of other curves; "plant"
    std::string category;                  // clean, one, two, outside: that alone; empty: as they are drawn
    std::string folder;                    // logs, seals and answers are kept here
    std::string lab_generate;              // the generator's program
    std::string traction;                  // this program, for the plant
    std::string scenario;                  // the plant's drive
    std::function<void()> step;            // one log made, or one answered
};

struct SealedLog {
    std::string log, seal, soil;
    std::string model, map; // what the operator hands over with the log; map empty: our own format
    double seconds = 0;     // processor time of the lab on this log
    nlohmann::json result;
};

// Makes the sealed logs, several at a time. Throws std::runtime_error when a generator fails.
std::vector<SealedLog> make_logs(const CampaignOptions &options);

// The lab's answer to one log (traction.lab/1). May throw; the campaign notes the failure and goes on.
using Lab = std::function<nlohmann::json(const SealedLog &)>;
void answer_all(std::vector<SealedLog> &logs, const CampaignOptions &options, const Lab &lab);

// Reads the seals. Call it last.
std::vector<Judged> open_seals(const std::vector<SealedLog> &logs);

// Adds to every answered log with catalogue effects what the fit that is given the true effects leaves and knows.
struct TruthFit {
    double floor = 0;         // error in units of noise; 0: the fit could not be made
    double detectability = 0; // d' of the first hidden effect: its size / its standard error in that fit
};
using Floor = std::function<TruthFit(const SealedLog &, const nlohmann::json &seal)>;
void add_floors(std::vector<Judged> &judged, const std::vector<SealedLog> &logs, const CampaignOptions &options, const Floor &floor);

} // namespace traction::bench_lab
