#include "words.h"

#include "append.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace traction::lab {

namespace {

// Letters, not bytes: those that continue a letter of UTF-8 are 10xxxxxx.
std::size_t letters(const std::string &text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

constexpr double least_share = 0.05; // of the square of what is left: a part below it is not worth a word

} // namespace

std::string wrapped(const std::string &text, std::size_t indent, std::size_t columns) {
    const std::size_t first = std::min(text.find_first_not_of(' '), text.size());
    std::string out, line = text.substr(0, first);
    bool fresh = true; // nothing but blanks in the line
    for (std::size_t at = first; at < text.size();) {
        const std::size_t end = std::min(text.find_first_of(" \n", at), text.size());
        const std::string word = text.substr(at, end - at);
        at = end + 1;
        if (word.empty()) continue;
        if (!fresh && letters(line) + 1 + letters(word) > columns) {
            out += line + "\n";
            line = std::string(indent, ' ');
            fresh = true;
        }
        line += (fresh ? "" : " ") + word;
        fresh = false;
    }
    return out + line + "\n";
}

std::string padded(const std::string &text, std::size_t columns) {
    const std::size_t n = letters(text);
    return n < columns ? text + std::string(columns - n, ' ') : text;
}

std::string strip_text(const std::vector<double> &values) {
    static constexpr const char *heights[] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
    double most = 0;
    for (const double v : values)
        if (std::isfinite(v)) most = std::max(most, v);
    std::string text;
    for (const double v : values) {
        if (std::isfinite(v))
            text += heights[most > 0 ? std::min(7, static_cast<int>(std::max(0.0, v) / most * 8)) : 0];
        else
            text += ' ';
    }
    return text;
}

std::string times(double x) {
    std::string text;
    append(text, x < 9.95 ? "%.1f" : "%.0f", x);
    return text;
}

std::string sized_text(double value, double low, double high, const std::string &unit) {
    std::string text;
    if (std::isfinite(low) && std::isfinite(high))
        append(text, "%.4g [%.4g, %.4g]", value, low, high);
    else
        append(text, "%.4g", value);
    if (unit != "1" && !unit.empty()) text += " " + unit;
    return text;
}

std::string left_words(const Remainder &left, bool settled) {
    std::vector<std::pair<double, LeftBy>> parts;
    for (std::size_t c = 0; c < left_by_count; ++c)
        if (left.part[c] * left.part[c] >= least_share * left.error * left.error && left.part[c] > 0)
            parts.emplace_back(left.part[c], static_cast<LeftBy>(c));
    std::stable_sort(parts.begin(), parts.end(), [](const auto &a, const auto &b) { return a.first > b.first; });
    std::string text = times(left.error) + " times the sensor noise is left";
    for (std::size_t i = 0; i < parts.size(); ++i) {
        text += i == 0 ? settled ? ", of which " : ". By what it follows: " : i + 1 == parts.size() ? " and " : ", ";
        text += times(parts[i].first) + (i == 0 && settled ? " is " : " ") + words_of(parts[i].second);
    }
    if (parts.size() > 1) text += " (the parts add up as squares)";
    return text + (settled ? "" : ". An effect that is missing would show there too");
}

double fall_percent(const std::vector<LadderStep> &ladder) {
    if (ladder.size() < 2 || !(ladder.front().heldout > 0)) return 0;
    return std::max(0.0, 100 * (1 - ladder.back().heldout / ladder.front().heldout));
}

} // namespace traction::lab
