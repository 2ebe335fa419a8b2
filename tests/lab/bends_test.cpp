// A ground whose pull over slip bends otherwise than the law of the model is asked for its curve, and is no missing effect; a ground of the
// law is not asked.
#include "generator/generator.h"

#include "host_tools/lab/bends.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/session.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace traction::lab {
namespace {

generator::GeneratorConfig ground(generator::Soil soil, generator::Knee knee) {
    generator::GeneratorConfig config;
    config.soil = soil, config.knee = knee, config.duration_s = 60, config.seed = 1003001;
    config.exact = true; // even ground
    return config;
}

Model sheet_of(const generator::GeneratorConfig &config) { return parse_model(generator::data_sheet(config), "sheet"); }

double curve_of(const generator::GeneratorConfig &config) {
    Model model = sheet_of(config);
    ask_for_curve(model);
    const Dataset data = make_dataset(model, generator::generate(config));
    fit_model(model, data, "fitted");
    return model.wheel.front().soil.at("shear_curve").value;
}

TEST(Bends, a_ground_of_another_curve_is_asked_and_one_of_the_law_is_not) {
    for (const generator::Soil soil : {generator::Soil::concrete, generator::Soil::sand}) {
        for (const generator::Knee knee : {generator::Knee::stated, generator::Knee::tanh}) {
            const generator::GeneratorConfig config = ground(soil, knee);
            const Model model = sheet_of(config);
            EXPECT_EQ(bends_otherwise(model, make_dataset(model, generator::generate(config))), knee == generator::Knee::tanh)
                << name_of(soil);
        }
    }
    EXPECT_LT(curve_of(ground(generator::Soil::concrete, generator::Knee::hyperbola)), -0.05) << "softer than the law's";
    EXPECT_GT(curve_of(ground(generator::Soil::concrete, generator::Knee::magic)), 0.05) << "and sharper";
}

TEST(Bends, who_states_the_curve_or_has_no_ground_is_not_asked) {
    const generator::GeneratorConfig config = ground(generator::Soil::concrete, generator::Knee::tanh);
    const log::Log log = generator::generate(config);
    Model stated = sheet_of(config);
    stated.wheel.front().soil.at("shear_curve").given = true;
    EXPECT_FALSE(bends_otherwise(stated, make_dataset(stated, log)));
    Model asked = sheet_of(config);
    ask_for_curve(asked);
    EXPECT_FALSE(bends_otherwise(asked, make_dataset(asked, log))) << "twice";
    Model imposed = sheet_of(config);
    imposed.motion = BodyMotion::imposed;
    EXPECT_FALSE(bends_otherwise(imposed, make_dataset(imposed, log)));
}

// The lab before told of shapes over slip here, and of a shear_peak.
TEST(Bends, is_said_once_and_leaves_nothing_to_name) {
    const generator::BlindCase one = generator::draw_bent_case(1001013, "clean");
    Session session;
    session.model = sheet_of(one.config), session.runs = {generator::generate(one.config)};
    ask_the_log(session);
    EXPECT_EQ(std::count(session.data.messages.begin(), session.data.messages.end(), curve_is_asked), 1);
    const Diagnosed found = diagnose_session(session, {});
    EXPECT_EQ(found.diagnosis.kind, "nothing") << found.diagnosis.text;
}

} // namespace
} // namespace traction::lab
