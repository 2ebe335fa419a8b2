// row.h - one log of a blind campaign as one row: what was hidden, what the lab said, what the judge makes of it. Campaigns keep such rows
// (docs/campaign.md), and the bench's table is made of them again.
//
// The order is the bench's: the log and its seal are made by other programs, the lab answers from the log and its data sheet, then the seal
// is opened. A row is a function of generator, category, seed and duration, but for the processor time.
#pragma once

#include "campaign.h"

#include <functional>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <vector>

namespace traction::bench_lab {

// Makes options.logs logs, has the lab answer each, then opens the seals and fits with the truth; `before_seals` sees the answered logs
// first. Throws std::runtime_error when a generator fails.
std::vector<Judged> run_blind(const CampaignOptions &options, const std::function<void(const std::vector<SealedLog> &)> &before_seals = {});

// One log's row, of
//   soil, hidden_category, hidden [{name, wheel, parameters}]     the opened seal
//   verdict, text, named, classes, intervals [{effect, wheel, parameters {value, low, high}}], error_before, error_after (held out, in
//   units of noise; null where the lab has none)                  the answer
//   floor, detectability                                          the fit that is given the truth; null where it could not be made
//   judged                                                        case_json without "seconds"
//   seconds                                                       processor time of the lab, the one thing that is another each time
//   error                                                         why there is no answer; null
nlohmann::json row_json(const Judged &one);

// The cases of rows, one {"judged": ..., "seconds": ...} a line. Throws std::runtime_error with the line's number where it is none.
std::vector<Case> read_rows(std::istream &lines);

} // namespace traction::bench_lab
