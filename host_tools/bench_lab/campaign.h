// campaign.h - a blind campaign: sealed logs made by other programs, the lab run on each, the seals opened when all answers are in.
//
// The logs come from lab_generate (a rover that shares no code with the lab) or from `traction simulate` (the ODE plant). Both run
// as processes of their own and write what they hid to a seal beside the log; this program reads the seals in open_seals() alone.
#pragma once

#include "score.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace traction::bench_lab {

struct CampaignOptions {
    int logs = 250;
    int jobs = 2;
    std::uint64_t seed = 1000; // of the first log; the others follow
    double duration_s = 120;
    std::string generator = "independent"; // or "plant"
    std::string folder;                    // logs, seals and answers are kept here
    std::string lab_generate;              // the generator's program
    std::string traction;                  // this program, for the plant
    std::string scenario;                  // the plant's drive
    std::function<void()> step;            // one log made, or one answered
};

struct SealedLog {
    std::string log, seal, soil;
    double seconds = 0;
    nlohmann::json result;
};

// Makes the sealed logs, several at a time. Throws std::runtime_error when a generator fails.
std::vector<SealedLog> make_logs(const CampaignOptions &options);

// The lab's answer to one log (traction.lab/1). May throw; the campaign notes the failure and goes on.
using Lab = std::function<nlohmann::json(const SealedLog &)>;
void answer_all(std::vector<SealedLog> &logs, const CampaignOptions &options, const Lab &lab);

// Reads the seals. Call it last.
std::vector<Judged> open_seals(const std::vector<SealedLog> &logs);

// Adds the floor to every answered log with catalogue effects: the error that the fit with the true effects leaves.
using Floor = std::function<double(const SealedLog &, const nlohmann::json &seal)>;
void add_floors(std::vector<Judged> &judged, const std::vector<SealedLog> &logs, const CampaignOptions &options, const Floor &floor);

} // namespace traction::bench_lab
