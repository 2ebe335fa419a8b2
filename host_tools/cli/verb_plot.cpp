// traction plot LOG --out FILE.svg|png: draws signals of any log without a display.
#include "rows.h"
#include "verbs.h"

#include "host_tools/log/log.h"
#include "host_tools/report/log_figure.h"
#include "host_tools/report/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace traction::cli {

namespace {

struct PlotOptions {
    std::string log, map, out;
    report::LogFigureOptions figure;
    double width_px = 860;
};

void plot(const PlotOptions &options, Outcome &outcome) {
    const log::Log log = log::read_csv(options.log, options.map);
    report::Figure figure = report::log_figure(log, options.figure);
    figure.width_px = options.width_px;
    const std::string svg = report::to_svg(figure);
    if (std::filesystem::path(options.out).extension() == ".png")
        report::write_png(svg, options.out);
    else
        report::write_text(svg, options.out);
    std::printf("figure: %s\n", options.out.c_str());
    nlohmann::json panels = nlohmann::json::array();
    for (const report::Panel &panel : figure.panels) {
        nlohmann::json signals = nlohmann::json::array();
        for (const report::Series &series : panel.series)
            signals.push_back({{"name", series.name}, // gaps are no samples
                               {"samples", std::count_if(series.y.begin(), series.y.end(), [](double y) { return !std::isnan(y); })}});
        panels.push_back({{"label", panel.y_label}, {"signals", signals}});
    }
    outcome.json = {{"schema", "traction.plot/1"}, {"figure", options.out}, {"panels", panels}, {"repairs", log.repairs}};
}

std::string plot_ending(const std::string &path) {
    const std::string ending = std::filesystem::path(path).extension().string();
    return path == "-" || ending == ".svg" || ending == ".png" ? "" : "must end in .svg or .png, or be - for SVG on standard output";
}

} // namespace

Verb verb_plot() {
    const auto options = std::make_shared<PlotOptions>();
    return {.name = "plot",
            .summary = "draw signals of any log as SVG or PNG, one panel per unit",
            .options =
                {log_row(options->log, "the log"),
                 {.name = "--signals",
                  .into = &options->figure.signals,
                  .help = "names with commas between; * stands for any text; all when left out",
                  .value = "A,B,...",
                  .delimiter = ','},
                 map_row(options->map),
                 {.name = "--from", .into = &options->figure.from_s, .help = "first time shown", .value = "S"},
                 {.name = "--to", .into = &options->figure.to_s, .help = "last time shown", .value = "S"},
                 {.name = "--width", .into = &options->width_px, .help = "width of the figure", .value = "PX", .range = Range{200, 8000}},
                 {.name = "--out",
                  .into = &options->out,
                  .help = "the figure",
                  .value = "FILE.svg|png",
                  .kind = Kind::output,
                  .required = true,
                  .check = plot_ending}},
            .run = [options](Outcome &outcome) { plot(*options, outcome); }};
}

} // namespace traction::cli
