// Every effect of the catalogue has a drawing, of its own place; its curve is the law's; the docs show what the catalogue draws.
#include "host_tools/report/effect_drawing.h"
#include "host_tools/report/report.h"
#include "xml_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <string>

namespace traction::report {
namespace {

std::string content(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(EffectDrawing, every_effect_has_one_that_is_strict_xml_and_names_itself) {
    ASSERT_FALSE(sim::catalogue().empty());
    for (const sim::Effect &effect : sim::catalogue())
        for (const bool alone : {false, true}) {
            const std::string svg = effect_svg(effect, alone);
            EXPECT_EQ(test::XmlCheck(svg).fault(), "") << effect.name;
            EXPECT_NE(svg.find("aria-label=\"" + std::string(effect.name) + " acts: "), std::string::npos) << svg;
            EXPECT_TRUE(svg.find("class=\"mark") != std::string::npos || svg.find("class=\"force") != std::string::npos) << effect.name;
            EXPECT_EQ(svg.find("nan"), std::string::npos) << effect.name;
            EXPECT_EQ(svg.find("style"), alone ? svg.find("<style>") + 1 : std::string::npos) << "the live page's policy forbids it";
        }
}

// The scene without the curve: what is drawn of a place is drawn of no other, and of every sensor something else.
TEST(EffectDrawing, what_acts_elsewhere_looks_otherwise) {
    std::map<std::string, std::set<std::string>> places; // by scene
    for (const sim::Effect &effect : sim::catalogue()) {
        const std::string svg = effect_svg(effect, false);
        const std::size_t begin = svg.find('>'), axis = svg.find("class=\"axis\"");
        std::string place = std::to_string(static_cast<int>(effect.acts_on));
        if (effect.acts_on == sim::ActsOn::sensor) place += std::string(effect.name.substr(0, effect.name.find('_')));
        places[svg.substr(begin, axis == std::string::npos ? axis : axis - begin)].insert(place);
    }
    for (const auto &[scene, several] : places) EXPECT_EQ(several.size(), 1u) << scene;
    EXPECT_GE(places.size(), 13u); // seven places, of which the sensors are seven
}

TEST(EffectDrawing, curves_are_the_laws_at_their_usual_size) {
    const std::map<std::string, std::function<double(double)>> laws = {
        // closed forms as docs and `traction effects` print them, at the catalogue's typical values
        {"coulomb_friction", [](double w) { return w > 0   ? 0.04
                                                   : w < 0 ? -0.04
                                                           : 0; }},
        {"viscous_friction", [](double w) { return 0.005 * w; }},
        {"stribeck_friction", [](double w) { return w == 0 ? 0 : 0.03 * std::exp(-w * w) * (w > 0 ? 1 : -1); }},
        {"mesh_loss", [](double torque) { return 0.1 * torque; }},
        {"wear_in", [](double t) { return 0.05 * std::exp(-t / 30); }},
        {"torque_ripple", [](double a) { return 0.02 * std::cos(a) + 0.02 * std::sin(a); }},
        {"rolling_resistance", [](double) { return 0.06; }},
        {"slip_sinkage", [](double s) { return 0.2 * std::fabs(s); }},
        {"squared_resistance", [](double v) { return 0.3 * v * v; }},
        {"soil_patch", [](double x) { return x >= 1 && x < 1.8 ? 0.35 : 0; }},
        {"soil_gradient", [](double x) { return 0.06 * x; }},
        {"sliding_speed_loss", [](double v) { return std::exp(-0.5 * v) - 1; }},
        {"body_drag", [](double v) { return v > 0   ? -1.2
                                            : v < 0 ? 1.2
                                                    : 0; }},
        {"fluid_drag", [](double v) { return -8 * v * std::fabs(v); }},
    };
    for (const auto &[name, law] : laws) {
        const auto curve = curve_of(*sim::find_effect(name));
        ASSERT_TRUE(curve.has_value()) << name;
        ASSERT_GE(curve->x.size(), 20u);
        for (std::size_t i = 0; i < curve->x.size(); ++i)
            EXPECT_NEAR(curve->y[i], law(curve->x[i]), 1e-6) << name << " at " << curve->x[i]; // the portable exp and sin: 1e-7
    }
    EXPECT_FALSE(curve_of(*sim::find_effect("camera_delay")).has_value()); // acts inside a sensor
}

TEST(EffectDrawing, a_result_gets_the_drawings_of_the_effects_that_it_names_and_no_other) {
    const nlohmann::json result = {{"candidates", {{{"effect", "slip_sinkage"}, {"evidence", {1, 2, 3}}}, {{"effect", "own_law"}}}},
                                   {"model", {{"name", "rover"}, {"effects", {{{"name", "grade"}}}}}}};
    const nlohmann::json drawings = drawings_of(result);
    EXPECT_EQ(drawings.size(), 2u) << drawings;
    EXPECT_EQ(drawings["slip_sinkage"], effect_svg(*sim::find_effect("slip_sinkage"), false));
    EXPECT_TRUE(drawings.contains("grade"));
}

TEST(EffectDrawing, the_docs_show_what_the_catalogue_draws) {
    const std::string docs = content("docs/effects.md");
    for (const sim::Effect &effect : sim::catalogue()) {
        const std::string file = "figures/effects/" + std::string(effect.name) + ".svg";
        EXPECT_EQ(content("docs/" + file), effect_svg(effect, true) + "\n")
            << "./traction effects --drawings docs/figures/effects draws them anew";
        EXPECT_NE(docs.find("![" + drawing_words(effect) + "](" + file + ")"), std::string::npos) << effect.name;
    }
}

} // namespace
} // namespace traction::report
