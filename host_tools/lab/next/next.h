// next.h - the next experiment: the drive whose predicted difference answers what a log left open.
//
// Every manoeuvre of the library is driven by the plant with the model's own numbers; what its log would tell is computed with the
// lab's forward model (information.h) and added to what the present log told. A question is "which of these two" (a confounded
// class, at the sizes found) or "is it there at all" (an effect that was not excited, at three sizes of interest). It counts as
// answered at d' >= 2 (and at least 2 more than before, in quadrature, where a log of d' 2 did not decide it). Effects asked for by
// name have three sizes of interest, or, where the model's own parameters hide that, the size that stands out from them. Chosen: up
// to three manoeuvres that answer most questions that any can answer; among these the largest square of the least d' per second (d'^2 adds
// up over time).
#pragma once

#include "host_tools/lab/decision/diagnose.h"

#include "host_tools/log/log.h"

#include <functional>
#include <string>
#include <vector>

namespace traction::lab {

// Drives a scenario's text and returns the log: lent by the caller, because the lab knows no plant.
using DriveScenario = std::function<log::Log(const std::string &scenario_toml)>;

struct Question {
    std::vector<std::string> members; // two that the log cannot tell apart, or one that it could not show
    double before = 0, after = 0;     // least predicted d', with the present log alone and with the chosen drive too
    double best = 0;                  // with the best single manoeuvre
    std::string status;               // told (by the log), answered, later (another drive), never (by driving)
    std::string measure;              // what to measure instead; `never` only
};

struct Tried {
    std::string title;
    double duration_s = 0;
    double least = 0; // d' over the questions that some manoeuvre answers
    int answered = 0;
};

struct NextExperiment {
    bool predicted = false; // false: the plant cannot drive this machine; only kinds of manoeuvre are named
    std::string why_not;
    std::string title, scenario_toml; // empty when no drive is needed or none helps
    double duration_s = 0;
    std::vector<Question> questions;
    std::vector<Tried> tried; // every manoeuvre alone
    std::vector<std::string> notes;
};

// What a diagnosis left open: pairs of its classes; when it has none (or `all`), what was not excited too.
NextExperiment next_experiment(const Diagnosis &diagnosis, const Model &model, const Dataset &data, bool all, const DriveScenario &drive);

// Between effects by name ("grade", "coulomb_friction:2" for wheel 2): every pair, or whether a single one shows. data: what is known
// already; nullptr when there is no log. Throws ModelError for a name that is no candidate.
NextExperiment next_experiment(const std::vector<std::string> &effects, const Model &model, const Dataset *data,
                               const DriveScenario &drive);

} // namespace traction::lab
