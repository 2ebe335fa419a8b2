#include "svg.h"

#include "axis.h"
#include "svg_text.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace traction::report {

namespace {

constexpr double title_px = 26, panel_title_px = 20, legend_row_px = 18, gap_px = 16, tick_room_px = 20, x_label_px = 18;
constexpr double left_px = 74, right_px = 16;

// Okabe and Ito (2008), "Color Universal Design": told apart under all common colour deficiencies. Its yellow gave way to grey: it
// vanishes on white.
constexpr std::array<const char *, 8> colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#777777", "#000000"};
constexpr std::array<const char *, 8> dashes{"", "7 3", "2 3", "9 3 2 3", "12 4", "5 2 1 2 1 2", "1 2", "4 4"};

std::size_t style_of(const Series &series, std::size_t position) {
    return (series.style >= 0 ? static_cast<std::size_t>(series.style) : position) % colours.size();
}

struct Frame { // where a panel's data goes
    double x, y, width, height;
    Axis across, up;
    double px(double value) const { return x + across.place(value) * width; }
    double py(double value) const { return y + (1 - up.place(value)) * height; }
};

std::string line(double x1, double y1, double x2, double y2, const char *kind, const char *attributes = "") {
    return "<line class=\"" + std::string(kind) + "\" x1=\"" + coordinate(x1) + "\" y1=\"" + coordinate(y1) + "\" x2=\"" + coordinate(x2) +
           "\" y2=\"" + coordinate(y2) + "\" " + attributes + "/>\n";
}

// Eight shapes, so that series differ without colour.
std::string marker(double x, double y, std::size_t style) {
    static constexpr std::array<const char *, 8> shapes{"m-3,0a3,3 0 1,0 6,0a3,3 0 1,0 -6,0z",
                                                        "m-3,-3h6v6h-6z",
                                                        "m0,-4l4,7h-8z",
                                                        "m0,-4l4,4l-4,4l-4,-4z",
                                                        "m0,4l4,-7h-8z",
                                                        "m-3,-3l6,6m-6,0l6,-6",
                                                        "m-4,0h8m-4,-4v8",
                                                        "m-4,-2h8v4h-8z"};
    const bool open = style >= 5 && style <= 6;
    return "<path d=\"M" + coordinate(x) + "," + coordinate(y) + shapes[style] + "\" fill=\"" + (open ? "none" : colours[style]) +
           "\" stroke=\"" + colours[style] + "\"/>";
}

bool drawable(const Frame &frame, double x, double y) { return std::isfinite(x) && std::isfinite(y) && (!frame.up.logarithmic || y > 0); }

struct Point {
    double x, y;
    bool operator==(const Point &) const = default;
};

// The samples of a line as runs of pixels, each column thinned to first, lowest, highest, last.
std::vector<std::vector<Point>> runs_of(const Frame &frame, const Series &series, bool held) {
    std::vector<std::vector<Point>> runs(1);
    std::array<Point, 4> column{}; // first, lowest, highest, last
    long at = -1;
    const auto flush = [&] {
        if (at < 0) return;
        std::array<Point, 4> ordered = column;
        if (ordered[1].x > ordered[2].x) std::swap(ordered[1], ordered[2]);
        for (const Point &point : ordered)
            if (runs.back().empty() || runs.back().back() != point) runs.back().push_back(point);
        at = -1;
    };
    const std::size_t count = std::min(series.x.size(), series.y.size());
    for (std::size_t i = 0; i < count; ++i) {
        if (!drawable(frame, series.x[i], series.y[i])) {
            flush();
            if (!runs.back().empty()) runs.emplace_back();
            continue;
        }
        const Point point{frame.px(series.x[i]), frame.py(series.y[i])};
        const long bin = std::lround(point.x * 2);
        if (held && at >= 0 && bin != at) { // a step keeps its height until the next sample
            const Point corner{point.x, column[3].y};
            flush();
            runs.back().push_back(corner);
        }
        if (bin != at) {
            flush();
            column = {point, point, point, point};
            at = bin;
        }
        if (point.y < column[1].y) column[1] = point;
        if (point.y > column[2].y) column[2] = point;
        column[3] = point;
    }
    flush();
    if (runs.back().empty()) runs.pop_back();
    return runs;
}

std::string draw_line(const Frame &frame, const Series &series, std::size_t style) {
    std::string out;
    for (const auto &run : runs_of(frame, series, series.mark == Mark::step)) {
        if (run.size() == 1) {
            out += marker(run[0].x, run[0].y, style);
            continue;
        }
        out += "<path class=\"curve\" fill=\"none\" stroke=\"" + std::string(colours[style]) +
               "\" stroke-width=\"1.5\" stroke-linejoin=\"round\"";
        if (*dashes[style] != '\0') out += " stroke-dasharray=\"" + std::string(dashes[style]) + "\"";
        out += " d=\"M";
        for (std::size_t i = 0; i < run.size(); ++i) {
            if (i > 0) out += ' ';
            out.append(coordinate(run[i].x)).append(",").append(coordinate(run[i].y));
        }
        out += "\"/>\n";
        const std::size_t stride = std::max<std::size_t>(1, run.size() / 7);
        if (style != 0) // the first series is the plain solid line; markers start at another place in each series
            for (std::size_t i = stride * (style % 4) / 4; i < run.size(); i += stride) out += marker(run[i].x, run[i].y, style);
        out += '\n';
    }
    return out;
}

std::string draw_scatter(const Frame &frame, const Series &series, std::size_t style) {
    std::string out;
    const std::size_t count = std::min(series.x.size(), series.y.size());
    for (std::size_t i = 0; i < count; ++i)
        if (drawable(frame, series.x[i], series.y[i])) out += marker(frame.px(series.x[i]), frame.py(series.y[i]), style);
    return out + "\n";
}

std::string draw_band(const Frame &frame, const Series &series, std::size_t style) {
    std::string out, there;
    std::vector<std::string> corners; // of the upper edge, walked back
    const auto close = [&] {
        std::string back;
        for (auto corner = corners.rbegin(); corner != corners.rend(); ++corner) back.append(" ").append(*corner);
        if (!there.empty())
            out += "<path d=\"M" + there + back + "z\" fill=\"" + colours[style] + "\" fill-opacity=\"0.18\" stroke=\"" + colours[style] +
                   "\" stroke-width=\"0.5\"/>\n";
        there.clear();
        corners.clear();
    };
    const std::size_t count = std::min({series.x.size(), series.y.size(), series.y_high.size()});
    for (std::size_t i = 0; i < count; ++i) {
        if (!drawable(frame, series.x[i], series.y[i]) || !drawable(frame, series.x[i], series.y_high[i])) {
            close();
            continue;
        }
        const std::string x = coordinate(frame.px(series.x[i])) + ",";
        there.append(there.empty() ? "" : " ").append(x).append(coordinate(frame.py(series.y[i])));
        corners.push_back(x + coordinate(frame.py(series.y_high[i])));
    }
    close();
    return out;
}

std::string draw_bars(const Frame &frame, const Panel &panel, const Series &series, std::size_t style, std::size_t slot,
                      std::size_t slots) {
    std::string out;
    const double group = frame.width / static_cast<double>(std::max<std::size_t>(1, panel.categories.size()));
    const double width = std::min(70.0, group * 0.8 / static_cast<double>(slots));
    const double base = panel.log_y ? frame.y + frame.height : std::clamp(frame.py(0), frame.y, frame.y + frame.height);
    const std::size_t count = std::min(panel.categories.size(), series.y.size());
    for (std::size_t i = 0; i < count; ++i) {
        if (!drawable(frame, 0, series.y[i])) continue;
        const double middle = frame.x + (static_cast<double>(i) + 0.5) * group;
        const double x = middle + (static_cast<double>(slot) - static_cast<double>(slots) / 2) * width;
        const double y = frame.py(series.y[i]);
        out += "<rect x=\"" + coordinate(x) + "\" y=\"" + coordinate(std::min(y, base)) + "\" width=\"" + coordinate(width * 0.94) +
               "\" height=\"" + coordinate(std::fabs(base - y)) + "\" fill=\"" + colours[style] + "\" fill-opacity=\"" +
               (slot % 2 == 0 ? "0.85" : "0.35") + "\" stroke=\"" + colours[style] + "\"/>";
        out +=
            svg_text(x + width / 2, std::max(frame.y + 9, std::min(y, base) - 3), number(series.y[i], 3), {.anchor = "middle", .size = 10});
    }
    return out;
}

std::string draw_rules(const Frame &frame, const Panel &panel) {
    std::string out;
    for (const Rule &rule : panel.rules) {
        if (!std::isfinite(rule.value) || (!rule.vertical && !drawable(frame, 0, rule.value))) continue;
        const char *look = "stroke=\"#555555\" stroke-width=\"1\" stroke-dasharray=\"6 4\"";
        if (rule.vertical) {
            const double x = frame.px(rule.value);
            if (x < frame.x || x > frame.x + frame.width) continue;
            out += line(x, frame.y, x, frame.y + frame.height, "ink", look) +
                   svg_text(x + 4, frame.y + 11, rule.name, {.size = 10, .halo = true});
        } else {
            const double y = frame.py(rule.value);
            out += line(frame.x, y, frame.x + frame.width, y, "ink", look) +
                   svg_text(frame.x + frame.width - 4, y - 3, rule.name, {.anchor = "end", .size = 10, .halo = true});
        }
    }
    return out;
}

std::string draw_axes(const Frame &frame, const Panel &panel, bool with_x_ticks, const std::string &x_label) {
    std::string out;
    const double bottom = frame.y + frame.height;
    for (std::size_t i = 0; i < frame.up.ticks.size(); ++i) {
        const double y = frame.py(frame.up.ticks[i]);
        out += line(frame.x, y, frame.x + frame.width, y, "grid", "stroke=\"#dddddd\"");
        out += svg_text(frame.x - 6, y + 3.5, frame.up.labels[i], {.anchor = "end", .size = 11});
    }
    if (!panel.categories.empty()) {
        const double group = frame.width / static_cast<double>(panel.categories.size());
        for (std::size_t i = 0; i < panel.categories.size(); ++i)
            out += svg_text(frame.x + (static_cast<double>(i) + 0.5) * group, bottom + 14, shortened(panel.categories[i], group - 6, 11),
                            {.anchor = "middle", .size = 11});
    } else {
        for (std::size_t i = 0; i < frame.across.ticks.size(); ++i) {
            const double x = frame.px(frame.across.ticks[i]);
            out += line(x, frame.y, x, bottom, "grid", "stroke=\"#dddddd\"");
            if (with_x_ticks) out += svg_text(x, bottom + 14, frame.across.labels[i], {.anchor = "middle", .size = 11});
        }
    }
    out += "<rect class=\"frame\" x=\"" + coordinate(frame.x) + "\" y=\"" + coordinate(frame.y) + "\" width=\"" + coordinate(frame.width) +
           "\" height=\"" + coordinate(frame.height) + "\" fill=\"none\" stroke=\"#555555\"/>\n";
    out += svg_text(16, frame.y + frame.height / 2, shortened(panel.y_label, frame.height + 30, 12),
                    {.anchor = "middle", .size = 12, .turned = true});
    if (with_x_ticks && !x_label.empty())
        out += svg_text(frame.x + frame.width / 2, bottom + tick_room_px + 12, x_label, {.anchor = "middle", .size = 12});
    return out;
}

struct LegendEntry {
    const Series *series;
    std::size_t style;
    double x, row;
};

std::vector<LegendEntry> legend_of(const Panel &panel, double width) {
    std::vector<LegendEntry> entries;
    double x = 0, row = 0;
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
        if (panel.series[i].name.empty()) continue;
        const double wide = 38 + text_width(panel.series[i].name, 11) + 14;
        if (x > 0 && x + wide > width) {
            x = 0;
            row += 1;
        }
        entries.push_back({&panel.series[i], style_of(panel.series[i], i), x, row});
        x += wide;
    }
    return entries;
}

std::string draw_legend(const std::vector<LegendEntry> &entries, double left, double top, double width) {
    std::string out;
    for (const LegendEntry &entry : entries) {
        const double x = left + entry.x, y = top + entry.row * legend_row_px + 9;
        const std::string colour = colours[entry.style];
        const Mark mark = entry.series->mark;
        if (mark == Mark::band || mark == Mark::bar)
            out += "<rect x=\"" + coordinate(x + 4) + "\" y=\"" + coordinate(y - 5) + "\" width=\"24\" height=\"10\" fill=\"" + colour +
                   "\" fill-opacity=\"" + (mark == Mark::band ? "0.18" : "0.7") + "\" stroke=\"" + colour + "\"/>";
        if (mark == Mark::line || mark == Mark::step) {
            const std::string dash = dashes[entry.style];
            out += line(
                x + 2, y, x + 32, y, "curve",
                ("stroke=\"" + colour + "\" stroke-width=\"1.5\" stroke-dasharray=\"" + (dash.empty() ? "none" : dash) + "\"").c_str());
        }
        if (mark == Mark::scatter || ((mark == Mark::line || mark == Mark::step) && entry.style != 0))
            out += marker(x + 17, y, entry.style);
        out += svg_text(x + 38, y + 4, shortened(entry.series->name, width - 38, 11), {.size = 11});
    }
    return out;
}

// Cividis-like ramp from pale to dark blue (derived here: linear in lightness), so that print keeps the order.
std::string shade(double part) {
    const auto mix = [part](double pale, double dark) { return static_cast<int>(std::lround(pale + (dark - pale) * part)); };
    return "rgb(" + std::to_string(mix(247, 8)) + "," + std::to_string(mix(251, 48)) + "," + std::to_string(mix(255, 107)) + ")";
}

std::string draw_heat(const Frame &frame, const Panel &panel) {
    std::string out;
    const HeatMap &heat = panel.heat;
    Range range;
    for (const auto &row : heat.value)
        for (const double value : row) range.include(value);
    const std::size_t rows = heat.value.size(), columns = heat.x_edges.size() - 1;
    const double wide = frame.width / static_cast<double>(columns),
                 high = frame.height / static_cast<double>(std::max<std::size_t>(1, rows));
    for (std::size_t r = 0; r < rows; ++r) {
        for (std::size_t c = 0; c < std::min(columns, heat.value[r].size()); ++c) {
            const double value = heat.value[r][c];
            if (!std::isfinite(value)) continue;
            const double spread = range.high - range.low;
            const double part = spread > 0 ? std::clamp((value - range.low) / spread, 0.0, 1.0) : 0.5;
            const double x = frame.x + static_cast<double>(c) * wide, y = frame.y + static_cast<double>(r) * high;
            out += "<rect x=\"" + coordinate(x) + "\" y=\"" + coordinate(y) + "\" width=\"" + coordinate(wide) + "\" height=\"" +
                   coordinate(high) + "\" fill=\"" + shade(part) + "\"/>";
            const std::string text = number(value, 2);
            if (text_width(text, 11) < wide - 4 && high >= 13)
                out += svg_text(x + wide / 2, y + high / 2 + 4, text,
                                {.anchor = "middle", .size = 11, .fill = part > 0.5 ? "#ffffff" : "#111111"});
        }
        if (r < heat.y_labels.size())
            out += svg_text(frame.x - 6, frame.y + (static_cast<double>(r) + 0.5) * high + 4, shortened(heat.y_labels[r], left_px - 24, 11),
                            {.anchor = "end", .size = 11});
    }
    out += "<rect class=\"frame\" x=\"" + coordinate(frame.x) + "\" y=\"" + coordinate(frame.y) + "\" width=\"" + coordinate(frame.width) +
           "\" height=\"" + coordinate(frame.height) + "\" fill=\"none\" stroke=\"#555555\"/>\n";
    const std::size_t stride = 1 + columns * 48 / static_cast<std::size_t>(frame.width);
    for (std::size_t c = 0; c <= columns; c += stride)
        out += svg_text(frame.x + static_cast<double>(c) * wide, frame.y + frame.height + 14, number(heat.x_edges[c], 3),
                        {.anchor = "middle", .size = 11});
    out += svg_text(frame.x + frame.width / 2, frame.y + frame.height + tick_room_px + 12, heat.x_label, {.anchor = "middle", .size = 12});
    return out + svg_text(16, frame.y + frame.height / 2, panel.y_label, {.anchor = "middle", .size = 12, .turned = true});
}

Axis up_axis(const Panel &panel, double height) {
    Range range;
    const auto see = [&](double value) {
        if (!panel.log_y || value > 0) range.include(value);
    };
    bool bars = false;
    for (const Series &series : panel.series) {
        for (const double y : series.y) see(y);
        if (series.mark == Mark::band)
            for (const double y : series.y_high) see(y);
        bars = bars || series.mark == Mark::bar;
    }
    for (const Rule &rule : panel.rules)
        if (!rule.vertical) see(rule.value);
    if (panel.log_y) return make_log_axis(range);
    if (bars || panel.from_zero) range.include(0);
    Axis axis = make_axis(range, bars ? 0.12 : 0.04, std::max(2, static_cast<int>(height / 34)));
    if (bars && range.low >= 0 && range.high > 0) axis.low = 0; // bars stand on the frame
    return axis;
}

// Over one panel's own series, or over those of all panels that share the axis.
Axis across_axis(const std::vector<Panel> &panels, double width, bool own) {
    Range range;
    for (const Panel &panel : panels)
        for (const Series &series : panel.series)
            if (series.mark != Mark::bar && own == !panel.x_label.empty())
                for (const double x : series.x) range.include(x);
    return make_axis(range, 0, std::max(2, static_cast<int>(width / 80)));
}

bool has_heat(const Panel &panel) { return panel.heat.x_edges.size() >= 2; }

// Heat maps, bars and panels with a label of their own have an x axis of their own.
bool shares_x(const Panel &panel) { return !has_heat(panel) && panel.categories.empty() && panel.x_label.empty(); }

std::string draw_panel(const Panel &panel, Frame frame, const Figure &figure, bool lowest) {
    if (has_heat(panel)) return draw_heat(frame, panel);
    frame.up = up_axis(panel, frame.height);
    std::string out = draw_axes(frame, panel, lowest, panel.x_label.empty() ? figure.x_label : panel.x_label);
    std::size_t slots = 0, slot = 0;
    for (const Series &series : panel.series) slots += series.mark == Mark::bar ? 1 : 0;
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
        const Series &series = panel.series[i];
        const std::size_t style = style_of(series, i);
        switch (series.mark) {
        case Mark::line:
        case Mark::step:
            out += draw_line(frame, series, style);
            break;
        case Mark::scatter:
            out += draw_scatter(frame, series, style);
            break;
        case Mark::band:
            out += draw_band(frame, series, style);
            break;
        case Mark::bar:
            out += draw_bars(frame, panel, series, style, slot++, slots);
            break;
        }
    }
    return out + draw_rules(frame, panel); // their names stay readable over the data
}

double height_of(const Panel &panel, std::size_t panels) {
    if (panel.height_px > 0) return std::clamp(panel.height_px, 40.0, 4000.0);
    if (has_heat(panel)) return std::max(60.0, 26.0 * static_cast<double>(panel.heat.value.size()));
    return panels == 1 ? 300 : panels == 2 ? 200 : 140;
}

} // namespace

std::string to_svg(const Figure &figure) {
    const double width = std::clamp(figure.width_px, 200.0, 8000.0);
    const double inner = width - left_px - right_px;
    const Axis across = across_axis(figure.panels, inner, false);
    std::string body;
    double y = 8;
    if (!figure.title.empty()) {
        body += svg_text(left_px, y + 15, shortened(figure.title, inner, 15), {.size = 15, .bold = true});
        y += title_px;
    }
    for (std::size_t i = 0; i < figure.panels.size(); ++i) {
        const Panel &panel = figure.panels[i];
        if (!panel.title.empty()) {
            body += svg_text(left_px, y + 13, shortened(panel.title, inner, 12), {.size = 12, .bold = true});
            y += panel_title_px;
        }
        const auto legend = legend_of(panel, inner);
        body += draw_legend(legend, left_px, y, inner);
        if (!legend.empty()) y += (legend.back().row + 1) * legend_row_px + 2;
        const double height = height_of(panel, figure.panels.size());
        const bool own = !panel.x_label.empty();
        const bool lowest =
            has_heat(panel) || own || (shares_x(panel) && (i + 1 == figure.panels.size() || !shares_x(figure.panels[i + 1])));
        body += "<g class=\"panel\">\n" +
                draw_panel(panel, {left_px, y, inner, height, own ? across_axis({panel}, inner, true) : across, {}}, figure, lowest) +
                "</g>\n";
        const bool labelled = lowest || !panel.categories.empty();
        y += height + gap_px + (labelled ? tick_room_px : 0) + (lowest ? x_label_px : 0) - (labelled ? gap_px / 2 : 0);
    }
    if (!figure.note.empty()) {
        body += svg_text(left_px, y + 10, shortened(figure.note, inner, 11), {.size = 11});
        y += 16;
    }
    y += 6;
    const std::string w = coordinate(width), h = coordinate(y);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h + "\" viewBox=\"0 0 " + w + " " + h +
           "\" role=\"img\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\">\n<title>" +
           escaped(figure.title.empty() ? "figure" : figure.title) + "</title>\n<rect class=\"paper\" width=\"" + w + "\" height=\"" + h +
           "\" fill=\"#ffffff\"/>\n" + body + "</svg>\n";
}

} // namespace traction::report
