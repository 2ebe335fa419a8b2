#include "host_tools/log/log.h"
#include "host_tools/report/axis.h"
#include "host_tools/report/log_figure.h"
#include "host_tools/report/report.h"
#include "host_tools/report/svg.h"
#include "host_tools/report/svg_text.h"
#include "xml_check.h"

#include <algorithm>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <regex>
#include <sstream>

namespace {

using namespace traction::report;
using traction::test::XmlCheck;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

// Coordinates of the curve of style 0 (the first series), as numbers.
std::vector<std::pair<double, double>> curve_points(const std::string &svg, std::size_t which = 0) {
    std::vector<std::pair<double, double>> points;
    std::size_t at = 0;
    for (std::size_t i = 0; i <= which; ++i) at = svg.find("class=\"curve\" fill=\"none\"", at + 1);
    if (at == std::string::npos) return points;
    at = svg.find(" d=\"M", at) + 5;
    std::istringstream text(svg.substr(at, svg.find('"', at) - at));
    double x = 0, y = 0;
    char comma = 0;
    while (text >> x >> comma >> y) points.emplace_back(x, y);
    return points;
}

Figure of(std::vector<double> x, std::vector<double> y, Mark mark = Mark::line) {
    Figure figure{.title = "t", .x_label = "x [s]"};
    figure.panels.push_back({.y_label = "y [m]", .series = {{.name = "a", .mark = mark, .x = std::move(x), .y = y, .y_high = y}}});
    if (mark == Mark::bar) figure.panels[0].categories = {"one", "two", "three"};
    return figure;
}

// Well formed, and no coordinate is anything but a plain number.
void expect_sound(const std::string &svg) {
    XmlCheck check(svg);
    ASSERT_EQ(check.fault(), "") << svg.substr(0, 2000);
    for (const std::string &value : check.values) {
        ASSERT_EQ(value.find("nan"), std::string::npos) << value;
        ASSERT_EQ(value.find("inf"), std::string::npos) << value;
    }
}

TEST(XmlCheck, finds_what_is_wrong) {
    EXPECT_EQ(XmlCheck("<a b=\"1\"><c/>x &amp; y</a>").fault(), "");
    for (const char *bad :
         {"<a>", "<a></b>", "<a b=1/>", "<a b=\"1\" b=\"2\"/>", "<a>&</a>", "<a>\x01</a>", "<a/><b/>", "x<a/>", "<a b=\"<\"/>", ""})
        EXPECT_NE(XmlCheck(bad).fault(), "") << bad;
}

TEST(Svg, the_same_figure_gives_the_same_bytes) { EXPECT_EQ(to_svg(of({0, 1, 2}, {1, 4, 2})), to_svg(of({0, 1, 2}, {1, 4, 2}))); }

TEST(Svg, every_sample_stands_where_the_axes_say) {
    // x from 0 to 2 without margin, y from 1 to 4 with 4 % of 3 on either side: 0.88 to 4.12
    const std::string svg = to_svg(of({0, 1, 2}, {1, 4, 2}));
    const auto points = curve_points(svg);
    ASSERT_EQ(points.size(), 3u);
    const double width = points[2].first - points[0].first, scale = (points[0].second - points[1].second) / 3; // px per m
    EXPECT_NEAR(points[1].first - points[0].first, width / 2, 0.011);                                          // two roundings to 0.01 px
    EXPECT_NEAR(points[0].second - points[2].second, scale * (2 - 1), 0.015); // three roundings to 0.01 px, a third of one
    std::smatch frame;
    ASSERT_TRUE(std::regex_search(svg, frame,
                                  std::regex("class=\"frame\" x=\"([0-9.]+)\" y=\"([0-9.]+)\" width=\"([0-9.]+)\" height=\"([0-9.]+)\"")));
    EXPECT_NEAR(points[0].first, std::stod(frame[1]), 0.011);
    EXPECT_NEAR(points[2].first, std::stod(frame[1]) + std::stod(frame[3]), 0.011);
    EXPECT_NEAR(points[1].second, std::stod(frame[2]) + std::stod(frame[4]) * 0.12 / 3.24, 0.011);
}

TEST(Svg, thinning_a_long_line_keeps_its_only_spike) {
    std::vector<double> x, y;
    for (int i = 0; i < 200000; ++i) {
        x.push_back(i * 1e-3);
        y.push_back(i == 123456 ? 7 : 0);
    }
    for (const Mark mark : {Mark::line, Mark::step}) {
        const std::string svg = to_svg(of(x, y, mark));
        const auto points = curve_points(svg);
        EXPECT_LT(points.size(), 4u * 2 * 860 + 10); // four per half pixel of 860 px
        std::size_t high = 0;
        for (const auto &point : points) high = point.second < points[0].second - 100 ? high + 1 : high;
        EXPECT_GE(high, 1u);
    }
}

TEST(Svg, a_step_is_held_until_the_next_sample) {
    const auto points = curve_points(to_svg(of({0, 1, 2}, {1, 4, 2}, Mark::step)));
    ASSERT_EQ(points.size(), 5u); // 0, corner, 1, corner, 2
    EXPECT_EQ(points[1].second, points[0].second);
    EXPECT_EQ(points[1].first, points[2].first);
}

TEST(Svg, a_missing_sample_leaves_a_gap) {
    const std::string svg = to_svg(of({0, 1, 2, 3, 4}, {1, 2, nan_value, 2, 1}));
    EXPECT_EQ(curve_points(svg, 0).size(), 2u);
    EXPECT_EQ(curve_points(svg, 1).size(), 2u);
}

// The first two samples, at 0 and 1, tell where the axes lie; coordinates are rounded to 0.01 px.
TEST(Svg, no_drawn_point_is_not_in_the_data_and_no_extreme_of_a_pixel_column_is_lost) {
    std::mt19937 random(20261122);
    for (int run = 0; run < 60; ++run) {
        std::vector<double> x{0, 1}, y{0, 1};
        const int n = static_cast<int>(random() % 20000) + 2;
        for (int i = 2; i < n; ++i) x.push_back(i), y.push_back(static_cast<double>(random() % 100000) * 1e-5);
        const auto points = curve_points(to_svg(of(x, y)));
        const double left = points.front().first, right = points.back().first, step = (right - left) / (n - 1);
        const double bottom = points[0].second;
        double top = bottom;
        for (const auto &point : points) top = std::min(top, point.second);
        const auto py = [&](double value) { return bottom + (top - bottom) * value; };
        std::vector<double> low, high; // of the drawn points, by half pixel column
        std::vector<double> low_data, high_data;
        const auto note = [](std::vector<double> &least, std::vector<double> &most, double px, double value) {
            const auto column = static_cast<std::size_t>(std::lround(px * 2));
            least.resize(std::max(least.size(), column + 1), 1e9), most.resize(least.size(), -1e9);
            least[column] = std::min(least[column], value), most[column] = std::max(most[column], value);
        };
        for (const auto &[px, value] : points) {
            note(low, high, px, value);
            const auto i = static_cast<std::size_t>(std::lround((px - left) / step)); // columns finer than the rounding: any near sample
            bool there = false;
            const auto reach = static_cast<std::size_t>(std::ceil(0.02 / step));
            for (std::size_t k = i > reach ? i - reach : 0; k < std::min(y.size(), i + reach + 1); ++k)
                there = there || std::fabs(py(y[k]) - value) < 0.021; // two roundings on either side
            ASSERT_TRUE(there) << "run " << run << ", " << px << " " << value;
        }
        for (std::size_t i = 0; i < y.size(); ++i) note(low_data, high_data, left + step * static_cast<double>(i), py(y[i]));
        for (std::size_t c = 1; c + 1 < low_data.size(); ++c) { // a sample on an edge may have gone to the neighbour
            EXPECT_LT(std::min({low[c - 1], low[c], low[c + 1]}), low_data[c] + 0.021) << "run " << run;
            EXPECT_GT(std::max({high[c - 1], high[c], high[c + 1]}), high_data[c] - 0.021) << "run " << run;
        }
    }
}

TEST(Svg, a_panel_with_a_label_of_its_own_has_an_axis_of_its_own) {
    Figure figure;
    for (const double scale : {1.0, 1e-3})
        figure.panels.push_back({.y_label = "rise [1]",
                                 .x_label = scale == 1 ? "mass [kg]" : "height [m]",
                                 .series = {{.x = {scale, 2 * scale}, .y = {0, 1}}}});
    const std::string svg = to_svg(figure);
    expect_sound(svg);
    const auto first = curve_points(svg, 0), second = curve_points(svg, 1);
    EXPECT_NEAR(first[0].first, second[0].first, 0.011); // both span the whole width
    EXPECT_NEAR(first[1].first, second[1].first, 0.011);
    EXPECT_NE(svg.find(">mass [kg]<"), std::string::npos);
    EXPECT_NE(svg.find(">height [m]<"), std::string::npos);
    EXPECT_NE(svg.find(">0.0018<"), std::string::npos); // a tick in the parameter's unit
}

TEST(Svg, no_data_whatever_breaks_the_drawing) {
    const std::vector<std::vector<double>> sets{{},
                                                {1},
                                                {2, 2, 2},
                                                {nan_value, nan_value},
                                                {infinity, -infinity, 0},
                                                {1e-300, 1e300, -1e300},
                                                {5e-324, 0, -5e-324},
                                                {1e300, 1e300},
                                                {-1.7e308, 1.7e308, 0},
                                                {1, 1 + 2.3e-16, 1},
                                                {1e-300, 2e-300, 3e-300},
                                                {-0.0, 0.0},
                                                {1e15, 1e15 + 1, 1e15 + 2}};
    for (const auto &x : sets)
        for (const auto &y : sets)
            for (const Mark mark : {Mark::line, Mark::scatter, Mark::step, Mark::band, Mark::bar})
                for (const bool logarithmic : {false, true}) {
                    Figure figure = of(x, y, mark);
                    figure.panels[0].log_y = logarithmic;
                    figure.panels[0].rules = {{.value = y.empty() ? nan_value : y[0], .name = "r"},
                                              {.value = x.empty() ? infinity : x[0], .name = "v", .vertical = true}};
                    expect_sound(to_svg(figure));
                    if (HasFatalFailure()) return;
                }
}

TEST(Svg, a_heat_map_writes_its_numbers_and_leaves_empty_cells) {
    Figure figure{.title = "h"};
    figure.panels.push_back(
        {.y_label = "wheel",
         .heat = {.x_label = "slip", .x_edges = {0, 1, 2}, .y_labels = {"0", "1"}, .value = {{1.5, nan_value}, {1e300, -1e300}}}});
    const std::string svg = to_svg(figure);
    expect_sound(svg);
    EXPECT_NE(svg.find(">1.5<"), std::string::npos);
    std::size_t cells = 0;
    for (std::size_t at = svg.find("fill=\"rgb("); at != std::string::npos; at = svg.find("fill=\"rgb(", at + 1)) ++cells;
    EXPECT_EQ(cells, 3u);
}

TEST(Svg, words_of_the_data_are_never_markup) {
    Figure figure = of({0, 1}, {0, 1});
    figure.title = "a < b & \"c\" \x01 \xff </svg><script>";
    figure.panels[0].series[0].name =
        "\xc3\xa9 \xed\xa0\x80 \xf4\x90\x80\x80"; // e acute; a surrogate and a value past the last are no characters
    const std::string svg = to_svg(figure);
    expect_sound(svg);
    EXPECT_EQ(svg.find("<script"), std::string::npos);
    EXPECT_NE(svg.find("\xc3\xa9 ???"), std::string::npos);
}

TEST(Axis, ticks_are_round_inside_the_axis_and_labelled_alike) {
    const Axis axis = make_axis({.low = 0.13, .high = 0.87}, 0, 6);
    ASSERT_GE(axis.ticks.size(), 3u);
    for (std::size_t i = 0; i < axis.ticks.size(); ++i) {
        EXPECT_GE(axis.ticks[i], axis.low);
        EXPECT_LE(axis.ticks[i], axis.high);
        EXPECT_NEAR(std::stod(axis.labels[i]), axis.ticks[i], 1e-12); // the label names the tick: same decimal, double rounding
    }
    EXPECT_EQ(axis.labels.front(), "0.2");
}

TEST(Axis, labels_tell_neighbouring_ticks_apart_however_small_their_difference) {
    for (const double offset : {0.0, 1.0, 1e6, -3e-7, 1e12})
        for (const double span : {1e-3, 1.0, 1e5}) {
            const Axis axis = make_axis({.low = offset, .high = offset + span * (1 + std::fabs(offset) * 1e-9)}, 0, 6);
            for (std::size_t i = 1; i < axis.labels.size(); ++i) EXPECT_NE(axis.labels[i], axis.labels[i - 1]) << offset << " " << span;
        }
}

TEST(LogFigure, signals_of_one_unit_share_a_panel) {
    traction::log::Log log;
    log.source = "x/drive.csv";
    for (const char *name : {"wheel0.speed_rad_s", "wheel0.current_A", "wheel1.speed_rad_s", "wheel0.duty", "radar.adc_count",
                             "wheel0.encoder_count", "imu.accel_x_m_s2"})
        log.signals.push_back({.name = name, .t_s = {0, 1, 2}, .value = {1, 2, 3}});
    const Figure figure = log_figure(log, {.signals = {}, .from_s = 0.5});
    ASSERT_EQ(figure.panels.size(), 6u);
    EXPECT_EQ(figure.panels[0].y_label, "speed [rad/s]");
    ASSERT_EQ(figure.panels[0].series.size(), 2u);
    EXPECT_EQ(figure.panels[0].series[1].name, "wheel1.speed_rad_s");
    EXPECT_EQ(figure.panels[0].series[1].y, (std::vector<double>{2, 3}));
    EXPECT_EQ(figure.panels[5].y_label, "accel_x [m/s\u00b2]");
    EXPECT_EQ(log_figure(log, {.signals = {"wheel*.current_A", "wheel0.*"}}).panels.size(), 4u);
}

TEST(LogFigure, a_slip_that_is_not_valid_is_not_drawn) {
    traction::log::Log log;
    log.source = "drive.csv";
    log.signals.push_back({.name = "wheel0.slip", .t_s = {0, 1, 2, 3, 4}, .value = {1, -1, 0.1, 0.2, 1}});
    log.signals.push_back({.name = "wheel0.slip_valid", .t_s = {0, 2, 4}, .value = {0, 1, 0}}); // held until its next sample
    const Series slip = log_figure(log, {.signals = {"wheel0.slip"}}).panels[0].series[0];
    ASSERT_EQ(slip.y.size(), 5u);
    for (const std::size_t i : {0u, 1u, 4u}) EXPECT_TRUE(std::isnan(slip.y[i])) << i;
    EXPECT_EQ(slip.y[2], 0.1);
    EXPECT_EQ(slip.y[3], 0.2);
}

TEST(LogFigure, a_sensor_that_fell_silent_leaves_a_gap) {
    traction::log::Log log;
    log.source = "drive.csv";
    traction::log::Signal radar{.name = "radar.speed_m_s", .t_s = {}, .value = {}};
    for (int i = 0; i < 100; ++i)
        if (i < 40 || i > 60) radar.t_s.push_back(0.125 * i), radar.value.push_back(i);
    log.signals.push_back(radar);
    const Series series = log_figure(log, {}).panels[0].series[0];
    EXPECT_EQ(std::count_if(series.y.begin(), series.y.end(), [](double y) { return std::isnan(y); }), 1);
    EXPECT_EQ(series.y.size(), radar.value.size() + 1);
}

TEST(LogFigure, an_unknown_signal_is_told_with_the_nearest_names) {
    traction::log::Log log;
    log.source = "drive.csv";
    log.signals.push_back({.name = "wheel0.current_A", .t_s = {0}, .value = {1}});
    try {
        log_figure(log, {.signals = {"wheel0.curent_A"}});
        FAIL();
    } catch (const traction::log::LogError &error) {
        const std::string said = error.what();
        EXPECT_NE(said.find("drive.csv"), std::string::npos);
        EXPECT_NE(said.find("wheel0.curent_A"), std::string::npos);
        EXPECT_NE(said.find("the nearest are wheel0.current_A"), std::string::npos);
    }
}

class Files : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (std::filesystem::temp_directory_path() / "traction_svg_XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder = pattern;
    }
    void TearDown() override { std::filesystem::remove_all(folder); }
    std::size_t files() const { return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {})); }
    std::filesystem::path folder;
};

TEST_F(Files, a_png_has_the_size_of_the_figure_and_leaves_nothing_else) {
    if (std::system("command -v rsvg-convert >/dev/null") != 0)
        GTEST_SKIP() << "no rsvg-convert here (Debian: apt-get install librsvg2-bin)";
    Figure figure = of({0, 1, 2}, {1, 4, 2});
    figure.width_px = 400;
    write_png(to_svg(figure), (folder / "f.png").string(), 2);
    std::ifstream file(folder / "f.png", std::ios::binary);
    std::string head(24, '\0');
    file.read(head.data(), 24);
    EXPECT_EQ(head.substr(1, 3), "PNG");
    // PNG specification, section 11.2.2: width is the big-endian number at byte 16
    EXPECT_EQ(static_cast<unsigned char>(head[18]) * 256 + static_cast<unsigned char>(head[19]), 800);
    EXPECT_EQ(files(), 1u);
}

TEST_F(Files, what_cannot_be_drawn_as_png_leaves_nothing_behind) {
    EXPECT_THROW(write_png("this is no drawing", (folder / "f.png").string()), ReportError);
    EXPECT_EQ(files(), 0u);
}

TEST_F(Files, a_page_holds_its_result_whole_and_safely) {
    const nlohmann::json result{{"schema", "traction.lab/1"}, {"title", "</script><!-- \xff"}, {"messages", {"a", "b"}}};
    write_html(result, (folder / "r.html").string());
    EXPECT_EQ(files(), 1u);
    std::ifstream file(folder / "r.html");
    const std::string page((std::istreambuf_iterator<char>(file)), {});
    const std::string opening = "<script type=\"application/json\" id=\"result\">";
    const std::size_t from = page.find(opening) + opening.size();
    const nlohmann::json back = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
    EXPECT_EQ(back["title"], "</script><!-- \xef\xbf\xbd"); // the broken byte became U+FFFD
    EXPECT_EQ(back["messages"], result["messages"]);
    EXPECT_FALSE(std::regex_search(page, std::regex("(src|href)=\"?(https?:)?//")));
}

TEST_F(Files, an_unknown_schema_or_a_missing_folder_is_told) {
    EXPECT_THROW(to_html({{"schema", "traction.lab/9"}}), ReportError);
    EXPECT_THROW(to_html(nlohmann::json::array()), ReportError);
    EXPECT_THROW(write_html({{"schema", "traction.lab/1"}}, (folder / "no" / "r.html").string()), traction::log::FileError);
    EXPECT_EQ(files(), 0u);
}

} // namespace
