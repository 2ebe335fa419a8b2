// story.h - the five answers that a reader wants of a diagnosis, in plain sentences: is the model good enough, what is missing, how sure
// is that, what is left and why, what next. One text for terminal, JSON and page.
#pragma once

#include "compare.h"
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/next/next.h"

#include <nlohmann/json.hpp>

#include <string>

namespace traction::lab {

struct Story {
    std::string headline; // what the model misses, what explains it, what is left: the verdict in one breath
    std::string good_enough, missing, sure, left, next;
    std::string where; // where the model fails most; may be empty
};

// `comparison`: of the model as given (compare.h), with show_after() of the diagnosis' model where it has one. `next`: the drive that was
// worked out, or nullptr.
Story tell(const Comparison &comparison, const Diagnosis &diagnosis, const NextExperiment *next);

// Of a comparison alone: nothing was tested, so nothing is said of what is missing.
Story tell(const Comparison &comparison);

nlohmann::json story_json(const Story &story); // key `story` of docs/json_schema.md
std::string story_text(const Story &story);    // for a terminal

} // namespace traction::lab
