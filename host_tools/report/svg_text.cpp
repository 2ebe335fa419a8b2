#include "svg_text.h"

#include "axis.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace traction::report {

namespace {

// Length in bytes of the UTF-8 character at the front, 0 when it is broken or forbidden in XML 1.0 (its section 2.2).
std::size_t character_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
    const std::uint32_t first = byte(0);
    if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
    const std::size_t length = first >= 0xF0 && first < 0xF5   ? 4
                               : first >= 0xE0 && first < 0xF0 ? 3
                               : first >= 0xC2 && first < 0xE0 ? 2
                                                               : 0;
    if (length == 0 || text.size() < length) return 0;
    std::uint32_t code = first & (0x7Fu >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return 0;
        code = code << 6 | (byte(i) & 0x3F);
    }
    const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
    const bool forbidden = (code >= 0xD800 && code < 0xE000) || code == 0xFFFE || code == 0xFFFF || code > 0x10FFFF;
    return overlong || forbidden ? 0 : length;
}

} // namespace

std::string escaped(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const std::size_t length = character_length(text);
        if (length == 0) {
            out += '?';
        } else if (length > 1) {
            out += text.substr(0, length);
        } else {
            switch (text.front()) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            case '\'':
                out += "&#39;";
                break;
            default:
                out += text.front();
            }
        }
        text.remove_prefix(std::max<std::size_t>(1, length));
    }
    return out;
}

double text_width(std::string_view text, double size) {
    const auto characters = std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
    return static_cast<double>(characters) * size * 0.6;
}

std::string shortened(const std::string &text, double width, double size) {
    if (text_width(text, size) <= width) return text;
    std::string cut = text;
    while (!cut.empty() && text_width(cut, size) + 3 * size * 0.4 > width) {
        while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xC0) == 0x80) cut.pop_back();
        if (!cut.empty()) cut.pop_back();
    }
    return cut + "...";
}

std::string svg_text(double x, double y, const std::string &text, const TextLook &look) {
    if (text.empty()) return "";
    const std::string cx = coordinate(x), cy = coordinate(y);
    std::string out = *look.fill != '\0' ? "<text fill=\"" + std::string(look.fill) + "\"" : "<text class=\"words\" fill=\"#111111\"";
    if (look.halo) out += " stroke=\"#ffffff\" stroke-width=\"3\" paint-order=\"stroke\"";
    out += " x=\"" + cx + "\" y=\"" + cy + "\" font-size=\"" + coordinate(look.size) + "\"";
    if (std::string_view(look.anchor) != "start") out += " text-anchor=\"" + std::string(look.anchor) + "\"";
    if (look.bold) out += " font-weight=\"bold\"";
    if (look.turned) out += " transform=\"rotate(-90 " + cx + " " + cy + ")\"";
    return out + ">" + escaped(text) + "</text>\n";
}

} // namespace traction::report
