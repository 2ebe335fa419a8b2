// classes.h - effects that a log cannot tell apart.
#pragma once

#include "trial.h"

#include <string>
#include <vector>

namespace traction::lab {

// Which of the candidates that pass the data cannot tell from the winner. The nearly sure are in the class too where they explain more of
// all rows than the winner does, or change the log in the same way, or where the rows alone would not have named it but the data sheet's
// tolerances did: then what explains half as much may be meant. base_error: the baseline's held-out error; explainable: the part of it that
// is not noise.
std::vector<std::size_t> confounded(const std::vector<Trial> &trials, std::size_t winner, double base_error, double explainable,
                                    const DiagnoseOptions &options);

// Takes out the class that the label stands for, if there is one; those behind it move up.
void remove_class(Diagnosis &d, const std::string &label);

// What was accepted beside a name is no alternative to it.
void separate_accepted(Diagnosis &d);

// Effects of the class that the accepted one stands for, wheels left out; empty: it stands alone.
std::vector<std::string> members_of(const Diagnosis &d, const CandidateResult &accepted);

// Something that is in no catalogue explains as much as what was accepted as i: one class, an existing one of that name if there is one.
void join_class(Diagnosis &d, std::size_t i, const std::string &member);

} // namespace traction::lab
