// words.h - how results are said to people: lines that fit a terminal, small pictures made of letters, and what a model leaves.
#pragma once

#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/fit/remainder.h"

#include <string>
#include <vector>

namespace traction::lab {

constexpr std::size_t terminal_columns = 80;

// Broken at blanks into lines of at most `columns` letters (UTF-8; a longer word stands alone); every line but the first begins with
// `indent` blanks; blanks before the first word stay. Ends with a newline.
std::string wrapped(const std::string &text, std::size_t indent = 0, std::size_t columns = terminal_columns);

// `text` filled with blanks to so many letters (UTF-8); unchanged where it is longer.
std::string padded(const std::string &text, std::size_t columns);

// One letter a value, its height by the value over the largest: "▁▂█·". NaN is a blank: nothing was measured there.
std::string strip_text(const std::vector<double> &values);

// An error in units of noise: "4.4", "22".
std::string times(double error);

// "0.199 [0.19, 0.208] N m": four digits; no unit where it is "1".
std::string sized_text(double value, double low, double high, const std::string &unit);

// The parts of what is left that hold a twentieth or more of its square, largest first. `settled`: a diagnosis has found nothing more, and
// the parts are told as causes; else as what the residual follows.
std::string left_words(const Remainder &left, bool settled);

// By how much the held-out error falls from the first step of the ladder to the last [%], at least 0: the one percentage that is shown.
double fall_percent(const std::vector<LadderStep> &ladder);

} // namespace traction::lab
