// addition.h - an effect added to a model, fitted, with the ladder of its errors; and the lineage that a model carries.
#pragma once

#include "host_tools/lab/decision/diagnose.h"

#include <string>
#include <vector>

namespace traction::lab {

struct Added {
    Model model;
    std::vector<LadderStep> ladder; // baseline, + effect
    bool helps = false;             // the held-out error fell by more than its standard error, that of the fit too
    std::vector<Limit> limits;      // at which parameters stand with the effect in
    std::string text;
};

// The model with the effect, fitted. `file`: TOML with [[effect]] tables of the user's own; empty for the catalogue. The best of the
// effect's variants is taken. Throws ModelError for an unknown effect, a wheel that is not there, an effect that is in already.
Added add_effect(const Model &model, const Dataset &data, const std::string &effect, int wheel, const std::string &file);
std::string added_text(const Added &added);

// Appends the ladder's steps to the model's history.
void append_lineage(Model &model, const Dataset &data, const std::vector<LadderStep> &ladder, const LadderStep &final_step);

} // namespace traction::lab
