// suggest.h - what was most likely meant by a mistyped word.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace traction {

// Least number of inserted, deleted, changed or swapped neighbouring letters that make `b` of `a` (optimal string alignment).
std::size_t distance(std::string_view a, std::string_view b);

// The known word that is nearest to `word`; one that it begins counts as one letter away. nullptr: none is within `most` letters, or all
// of the word would have to change.
const std::string *nearest(std::string_view word, const std::vector<std::string> &known, std::size_t most);

// "; did you mean 'simulate'?", or empty when no known word is near (within 2 letters, or a third of the word).
std::string did_you_mean(std::string_view word, const std::vector<std::string> &known);

// The same, then which command lists all: "; did you mean 'fit'? `traction --help` lists all".
std::string did_you_mean(std::string_view word, const std::vector<std::string> &known, const std::string &command);

} // namespace traction
