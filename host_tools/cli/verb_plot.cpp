// traction plot LOG --out FILE.svg|png: draws signals of any log without a display.
#include "verbs.h"

#include "host_tools/log/log.h"
#include "host_tools/report/log_figure.h"
#include "host_tools/report/report.h"

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
        for (const report::Series &series : panel.series) signals.push_back({{"name", series.name}, {"samples", series.x.size()}});
        panels.push_back({{"label", panel.y_label}, {"signals", signals}});
    }
    outcome.json = {{"schema", "traction.plot/1"}, {"figure", options.out}, {"panels", panels}, {"repairs", log.repairs}};
}

std::string check_ending(const std::string &path) {
    const std::string ending = std::filesystem::path(path).extension().string();
    return ending == ".svg" || ending == ".png" ? "" : "must end in .svg or .png";
}

} // namespace

void add_plot(CLI::App &app, Outcome &outcome) {
    const auto options = std::make_shared<PlotOptions>();
    CLI::App *verb = app.add_subcommand("plot", "draw signals of any log as SVG or PNG, one panel per unit");
    verb->add_option("log", options->log, "the log")->required()->type_name("LOG");
    verb->add_option("--signals", options->figure.signals, "names with commas between; * stands for any text; all when left out")
        ->delimiter(',')
        ->type_name("A,B,...");
    verb->add_option("--map", options->map, "how to read a foreign CSV")->type_name("MAP.toml");
    verb->add_option("--from", options->figure.from_s, "first time shown")->type_name("S");
    verb->add_option("--to", options->figure.to_s, "last time shown")->type_name("S");
    verb->add_option("--width", options->width_px, "width of the figure")->check(CLI::Range(200.0, 8000.0))->type_name("PX");
    verb->add_option("--out", options->out, "the figure")
        ->required()
        ->type_name("FILE.svg|png")
        ->check(CLI::Validator(check_ending, "", "ending"));
    add_json_option(verb, outcome);
    verb->callback([options, &outcome] { plot(*options, outcome); });
}

} // namespace traction::cli
