// answer.h - the lab, run as a library on one log: the campaign's questions and the parts of traction.lab/1 that it judges.
#pragma once

#include "campaign.h"

#include <string>

namespace traction::bench_lab {

// Reads the log and the model, runs diagnose, returns the answer. `timing`: seconds of reading, preparing and diagnosing.
nlohmann::json ask_lab(const std::string &log_file, const std::string &model_file);

// Data sheet of the campaign's rover on that soil.
std::string campaign_model(const std::string &generator, const std::string &soil);

} // namespace traction::bench_lab
