// spoil.h - the corpus of spoilt logs and wrong models: sound logs, one thing wrong at a time, and what the lab makes of each.
//
// Nothing here may end in a name, nor in "nothing found": the gate refuses the log, or the verdict is that the model does not describe it.
#pragma once

#include "host_tools/lab/model/model.h"
#include "host_tools/log/log.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace traction::gate {

// A sound log with the model of its machine.
struct Base {
    std::string name; // "plant": speeds and counts; "angle": angles alone; "counts": the independent rover, counts alone
    log::Log log;
    lab::Model model;
};
Base base(const std::string &name, double duration_s);
std::vector<std::string> base_names();

// One row: a log and a model that do not belong together.
struct Row {
    std::string name;
    std::function<void(log::Log &)> spoil{};
    std::function<void(lab::Model &)> mistake{};
};
const std::vector<Row> &spoilt_logs();
const std::vector<Row> &wrong_models();

struct Outcome {
    std::string end;  // "refused", "wrong_model", "named", "unknown", "nothing", "does not apply"
    std::string text; // ids of the check, or names
    bool good() const { return end == "refused" || end == "wrong_model" || end == "does not apply"; }
};
// check_only: a row that passes the check is not diagnosed ("passed").
Outcome judge(const Base &sound, const Row &row, bool check_only);

// A sound log by its number: soils, rovers, sensors coarse and fine, effects of any strength, plans, what is logged.
struct Sound {
    std::string about;
    log::Log log;
    lab::Model model;
};
Sound sound_log(std::uint64_t seed, double duration_s);

} // namespace traction::gate
