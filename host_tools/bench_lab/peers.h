// peers.h - PySINDy and SysIdentPy on the same logs, in a .venv of pinned packages (tests/bench/lab).
#pragma once

#include "campaign.h"

#include <string>
#include <vector>

namespace traction::bench_lab {

// Runs both peers on the logs, one after the other on one core (Python). They are told what the lab is told: log and data sheet.
// Returns {"peers": {name: {"answers": [...], "seconds": [...], "use": ...}}}, or {"skipped": why}.
nlohmann::json run_peers(const std::vector<SealedLog> &logs, const CampaignOptions &options);

// Judges the peers' answers and the lab's by the same measures: first term right, exact set, named on clean logs, terms, seconds.
// "lab" is one of the rows; a class that it declares inseparable is one term.
nlohmann::json judge_peers(const nlohmann::json &answers, const std::vector<Judged> &judged);
std::string peers_text(const nlohmann::json &rows);

} // namespace traction::bench_lab
