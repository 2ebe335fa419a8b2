// svg_text.h - words in a drawing: escaping, an estimate of their width, and the element that shows them.
#pragma once

#include <string>
#include <string_view>

namespace traction::report {

// Text fit for XML: & < > " ' escaped; characters that XML 1.0 forbids and broken UTF-8 become '?'.
std::string escaped(std::string_view text);

// Width in px at a font size, estimated from DejaVu Sans (0.6 em a character): good enough to keep things apart.
double text_width(std::string_view text, double size);

// The text cut with "..." where it would be wider than `width`.
std::string shortened(const std::string &text, double width, double size);

struct TextLook {
    const char *anchor = "start";
    double size = 12;
    bool bold = false;
    bool turned = false;   // reads upwards
    const char *fill = ""; // empty: the ink of the page
    bool halo = false;     // a rim of paper, where it crosses data
};

// One text element at its baseline; nothing for an empty text.
std::string svg_text(double x, double y, const std::string &text, const TextLook &look);

} // namespace traction::report
