// svg.h - draws a figure as SVG: stacked panels over one x axis. Same figure, same bytes; readable without colour.
//
//   Figure f{.title = "Slip sweep", .x_label = "time [s]"};
//   f.panels.push_back({.y_label = "current [A]", .series = {{.name = "measured", .x = t, .y = i}}});
//   write_text(to_svg(f), "slip.svg");           // report.h; write_png(to_svg(f), "slip.png") for pixels
//
// Any numbers are accepted: a NaN or infinite sample leaves a gap, values beyond +-1e300 are drawn at +-1e300, empty series and
// empty panels keep their axes. Lines with many samples are thinned to the extremes per pixel column, so no spike is lost.
#pragma once

#include <string>
#include <vector>

namespace traction::report {

enum class Mark {
    line,    // samples joined; dashes and sparse markers tell series apart
    scatter, // markers only
    step,    // held until the next sample
    band,    // area between y and y_high
    bar,     // y over the categories of the panel; x is not used
};

struct Series {
    std::string name{}; // legend entry; empty: none
    Mark mark = Mark::line;
    std::vector<double> x{};
    std::vector<double> y{};
    std::vector<double> y_high{}; // band: upper edge. bar: not used
    int style = -1;               // 0..7 chooses colour, dash and marker; -1: by position in the panel
};

// A straight reference: y = value over the whole width (a limit, a noise band, a number of the paper), or x = value.
struct Rule {
    double value = 0;
    std::string name{}; // written beside it
    bool vertical = false;
};

// Colours and numbers in a grid; a panel with a heat map shows nothing else, and has its own x axis.
struct HeatMap {
    std::string x_label{};
    std::vector<double> x_edges{};            // columns + 1, rising
    std::vector<std::string> y_labels{};      // one per row, the first on top
    std::vector<std::vector<double>> value{}; // [row][column]; NaN: an empty cell
};

struct Panel {
    std::string title{};
    std::string y_label{}; // with unit, "current [A]"
    std::string x_label{}; // with unit; not empty: the panel has an x axis of its own
    std::vector<Series> series{};
    std::vector<Rule> rules{};
    std::vector<std::string> categories{}; // names under the bars
    HeatMap heat{};
    double height_px = 0;   // 0: chosen from the number of panels
    bool log_y = false;     // decades; samples <= 0 are gaps
    bool from_zero = false; // y axis always contains 0 (always so with bars)
};

struct Figure {
    std::string title{};
    std::string x_label{}; // of the lowest panel, with unit; panels share the x range
    std::vector<Panel> panels{};
    std::string note{}; // small print under the figure
    double width_px = 860;
};

std::string to_svg(const Figure &figure);

// Rasterises an SVG with the program rsvg-convert (Debian package librsvg2-bin), `zoom` pixels per px. The file appears whole or
// not at all. Throws ReportError (report.h) with the mend when the program is missing or refuses.
void write_png(const std::string &svg, const std::string &path, double zoom = 2);

} // namespace traction::report
