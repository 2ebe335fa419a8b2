#include "suggest.h"

#include <algorithm>

namespace traction {

std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j - 1] + (a[i - 1] != b[j - 1]), row[j - 1] + 1, last[j] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before.swap(last);
        last.swap(row);
    }
    return last[b.size()];
}

const std::string *nearest(std::string_view word, const std::vector<std::string> &known, std::size_t most) {
    const std::string *found = nullptr;
    std::size_t best = most + 1;
    for (const std::string &candidate : known) {
        const bool begins = word.size() >= 3 && candidate.rfind(word, 0) == 0; // cut short
        const std::size_t d = begins ? 1 : distance(word, candidate);
        if (d < best && d < std::max(word.size(), candidate.size())) best = d, found = &candidate;
    }
    return found;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string> &known) {
    const std::string *found = nearest(word, known, std::max<std::size_t>(2, word.size() / 3));
    return found == nullptr ? "" : "; did you mean '" + *found + "'?";
}

std::string did_you_mean(std::string_view word, const std::vector<std::string> &known, const std::string &command) {
    const std::string meant = did_you_mean(word, known);
    return (meant.empty() ? ";" : meant) + " `" + command + "` lists all";
}

} // namespace traction
