// report_pages DIR: writes every DIR/*.json as DIR/*.html, so that a browser can look at it. The word @SVG@ in a result stands for
// a drawing of to_svg with one panel of each kind.
#include "host_tools/report/report.h"
#include "host_tools/report/svg.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

using namespace traction::report;

namespace {

Figure every_mark() {
    Figure figure{.title = "Drawbar pull against slip", .x_label = "slip [1]", .note = "Made-up numbers."};
    Series band{.name = "95 % band", .mark = Mark::band}, line{.name = "fit"}, scatter{.name = "measured", .mark = Mark::scatter},
        step{.name = "set point", .mark = Mark::step};
    for (int i = 0; i <= 60; ++i) {
        const double s = i / 60.0, pull = 40 * (1 - std::exp(-s / 0.15));
        for (Series *series : {&band, &line, &scatter, &step}) series->x.push_back(s);
        band.y.push_back(pull - 5);
        band.y_high.push_back(pull + 5);
        line.y.push_back(pull);
        scatter.y.push_back(pull + 4 * std::sin(37.0 * i));
        step.y.push_back(10.0 * (i / 12));
    }
    figure.panels.push_back(
        {.title = "Sand", .y_label = "pull [N]", .series = {band, line, scatter}, .rules = {{.value = 38, .name = "paper"}}});
    figure.panels.push_back({.y_label = "set point [N]", .series = {step}, .rules = {{.value = 0.4, .name = "servo", .vertical = true}}});
    figure.panels.push_back(
        {.title = "Error after each step",
         .y_label = "error [σ]",
         .series = {{.name = "training", .mark = Mark::bar, .y = {3.05, 1.01}}, {.name = "held out", .mark = Mark::bar, .y = {3.12, 1.03}}},
         .rules = {{.value = 1, .name = "noise floor"}},
         .categories = {"baseline", "+ slip_sinkage"}});
    figure.panels.push_back({.title = "Residual over the noise",
                             .y_label = "wheel",
                             .heat = {.x_label = "slip [1]",
                                      .x_edges = {-1, -0.3, 0, 0.3, 1},
                                      .y_labels = {"0", "1"},
                                      .value = {{1, 1.1, 2.2, 6.1}, {1, std::nan(""), 1.4, 3.3}}}});
    return figure;
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 2) return 2;
    for (const auto &entry : std::filesystem::directory_iterator(argv[1])) {
        if (entry.path().extension() != ".json") continue;
        std::ifstream file(entry.path());
        nlohmann::json result = nlohmann::json::parse(file);
        if (result.contains("figures"))
            for (auto &figure : result["figures"])
                if (figure.value("svg", "") == "@SVG@") figure["svg"] = to_svg(every_mark());
        write_html(result, std::filesystem::path(entry.path()).replace_extension(".html").string());
    }
    write_text(to_svg(every_mark()), std::string(argv[1]) + "/every_mark.svg");
    write_png(to_svg(every_mark()), std::string(argv[1]) + "/every_mark.png");
    return 0;
}
