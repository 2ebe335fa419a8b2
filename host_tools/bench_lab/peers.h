// peers.h - PySINDy and SysIdentPy on the same logs, in a .venv of pinned packages (tests/bench/lab).
#pragma once

#include "campaign.h"

#include <string>
#include <vector>

namespace traction::bench_lab {

// Runs both peers on the logs (Python). Returns {"peers": {name: {"answers": [...], "seconds": ...}}}, or {"skipped": why}.
nlohmann::json run_peers(const std::vector<SealedLog> &logs, const std::string &folder);

// Opens the seals and judges the peers' answers by the lab's measures: first term right, exact set, named on clean logs, terms.
nlohmann::json judge_peers(const nlohmann::json &answers, const std::vector<SealedLog> &logs);
std::string peers_text(const nlohmann::json &judged);

} // namespace traction::bench_lab
