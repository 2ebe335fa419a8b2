// answer.h - the lab, run as a library on one log: the campaign's questions and the parts of traction.lab/1 that it judges.
#pragma once

#include "campaign.h"

#include <string>

namespace traction::bench_lab {

// Reads the log and the model, runs diagnose, returns the answer.
nlohmann::json ask_lab(const std::string &log_file, const std::string &model_file, const std::string &map_file = "");

// The fit of a model that holds every effect of the opened seal, of the hidden size to begin with: the error that it leaves (root of the
// mean over balances, in units of noise) and the d' of the first. Nothing (zeros) where an effect is outside the catalogue.
TruthFit fit_with_truth(const SealedLog &one, const nlohmann::json &seal);

// Data sheet of the campaign's rover on that soil.
std::string campaign_model(const std::string &generator, const std::string &soil);

} // namespace traction::bench_lab
