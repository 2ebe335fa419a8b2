// answer.h - what each verb of the lab answers, as JSON and as words, before anything is written: the CLI and the Python package call
// these, so that both give the same numbers.
//
// Throws what open_session and the lab's parts throw: ModelError, log::LogError, Refused.
#pragma once

#include "host_tools/lab/fit/profile.h"
#include "host_tools/lab/next/next.h"
#include "session.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace traction::lab {

struct Answer {
    nlohmann::json json;        // schema traction.lab/1 (docs/json_schema.md)
    std::string text;           // the same for people
    std::string kind;           // diagnose, add: the verdict's kind; empty elsewhere
    std::optional<Model> model; // what it arrived at: add, fit; diagnose where something was named, when asked for
    bool negative = false;      // it ran, and the answer is no (exit code 1)
};

struct AnswerOptions {
    std::function<void(int, int)> progress = {}; // diagnose: candidates done, a guess of how many
    DriveScenario drive = {};                    // diagnose, next: the simulated rover
    bool details = false;                        // diagnose, next: the statistics in `text` too
};

// fitted: balances after the parameters moved within their priors. details: the statistics in `text` too.
Answer compare_answer(const Session &session, bool fitted, bool details = false);

// apply: `model` is the model with what was named, refitted, with its lineage; none where nothing was.
Answer diagnose_answer(const Session &session, const Request &request, const AnswerOptions &options, bool apply);

// effect_file: TOML with [[effect]] tables of the user's own; empty for the catalogue. wheel -1: all.
Answer add_answer(const Session &session, const Request &request, const std::string &effect, int wheel, const std::string &effect_file);

// `model` has its values and intervals, and its lineage when `keep`. Profiles follow where `profile` is there: of these parameters, of
// every effect's strength where it is empty.
struct FitAnswer : Answer {
    std::vector<Profile> profiles;
};
FitAnswer fit_answer(const Session &session, const Request &request, bool keep,
                     const std::optional<std::vector<std::string>> &profile = std::nullopt, bool details = false);

// session null: between the effects alone. scenario: the drive's TOML, empty where there is none.
struct NextAnswer : Answer {
    std::string scenario;
};
NextAnswer next_answer(const Session *session, const Model &model, const std::vector<std::string> &effects, bool all,
                       const AnswerOptions &options);

// The model without an effect, with its lineage. wheel below -1: on whichever wheel. Throws ModelError where it has none of it.
Model without_effect(Model model, const std::string &effect, int wheel, std::size_t &dropped);

} // namespace traction::lab
