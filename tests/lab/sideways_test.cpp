// A skid steer that drifts outwards in its bends is followed sideways, whatever its model says of its motion; one that does not drift, or
// whose log cannot show it, is not.
#include "generator/generator.h"

#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/session.h"
#include "host_tools/lab/sideways.h"
#include "host_tools/rover/rover.h"
#include "host_tools/simulate/simulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace traction::lab {
namespace {

Model sand() { return read_model("models/rover_sand.toml"); }

// The simulated rover's sides are moved by the ground's forces alone: bends to the left and to the right, at two speeds.
log::Log in_bends() {
    std::string scenario = "duration_s = 40.0\nseed = 5\n[ground]\nsoil = \"sand\"\n";
    for (const char *wheels : {"[3.0, 7.0, 3.0, 7.0]", "[8.0, 4.0, 8.0, 4.0]", "[9.0, 12.0, 9.0, 12.0]", "[6.0, 6.0, 6.0, 6.0]"})
        scenario += std::string("[[drive]]\nfor_s = 10.0\nmode = \"wheel_speed\"\nwheel_speed_rad_s = ") + wheels + "\n";
    return simulate(sim::parse_scenario(scenario, "bends.toml")).log;
}

const log::Log &bends() {
    static const log::Log log = in_bends();
    return log;
}

TEST(Sideways, ARoverThatDriftsInItsBendsIsFollowed) {
    const Model model = sand();
    EXPECT_TRUE(drifts_sideways(model, make_dataset(model, bends())));
}

// What the sensors' scales make blows the scales of one fit up: by those the other was no better.
TEST(Sideways, ARoverWhoseGyroAndCurrentsReadTooMuchIsFollowedToo) {
    log::Log log = bends();
    for (log::Signal &s : log.signals) {
        const double scale = s.name == "imu.gyro_z_rad_s" ? 1.08 : s.name.ends_with("current_A") ? 1.2 : 1;
        for (double &value : s.value) value *= scale;
    }
    EXPECT_TRUE(drifts_sideways(sand(), make_dataset(sand(), log)));
}

TEST(Sideways, ARoverThatIsHeldOnItsLineIsNot) { // the generator's middle does not drift: v and yaw rate are all it has
    for (const char *drive : {"curves", "spins"}) {
        generator::GeneratorConfig config;
        config.drive = drive, config.duration_s = 60, config.seed = 77;
        const Model model = parse_model(generator::data_sheet(config), "sheet");
        EXPECT_FALSE(drifts_sideways(model, make_dataset(model, generator::generate(config)))) << drive;
    }
}

// A sideways grip that the model lacks turns it too; a drift would make it half right, and what is named beside it false. Without either
// rule both were followed, without the camera's the second alone (it drifts by what its grip does not explain).
TEST(Sideways, WhatASidewaysGripTurnsIsNotFollowed) {
    for (const auto &[size, camera] : {std::pair(generator::Size::small, false), {generator::Size::large, true}}) {
        generator::GeneratorConfig config;
        config.size = size, config.soil = generator::Soil::concrete, config.drive = "curves", config.duration_s = 60, config.seed = 77,
        config.apart = true;
        config.hidden = {generator::parse_setting("lateral_scrub:coefficient=0.25")};
        const Model model = parse_model(generator::data_sheet(config), "sheet");
        log::Log log = generator::generate(config);
        if (!camera) std::erase_if(log.signals, [](const log::Signal &s) { return s.name == "camera.y_m"; });
        const Dataset data = make_dataset(model, log);
        EXPECT_EQ(data.camera_left.measured.empty(), !camera);
        EXPECT_FALSE(drifts_sideways(model, data)) << camera;
    }
}

TEST(Sideways, WhatCannotShowItIsNotAsked) {
    const Model model = sand();
    log::Log blind = bends();
    std::erase_if(blind.signals, [](const log::Signal &s) { return s.name == "imu.gyro_z_rad_s"; });
    EXPECT_TRUE(drifts_sideways(model, make_dataset(model, blind))) << "the camera's heading tells how it turns";
    std::erase_if(blind.signals, [](const log::Signal &s) { return s.name == "camera.yaw_rad"; });
    EXPECT_FALSE(drifts_sideways(model, make_dataset(model, blind))) << "neither gyro nor heading";

    Model rollers = model;
    for (WheelSpec &w : rollers.wheel) w.grips_sideways = false;
    EXPECT_FALSE(drifts_sideways(rollers, make_dataset(rollers, bends()))) << "wheels with rollers";

    Model one_axle = model;
    for (WheelSpec &w : one_axle.wheel) w.geometry.at("x_m").value = 0;
    EXPECT_FALSE(drifts_sideways(one_axle, make_dataset(one_axle, bends()))) << "one axle";

    Model planar = model;
    planar.motion = BodyMotion::planar;
    EXPECT_FALSE(drifts_sideways(planar, make_dataset(planar, bends()))) << "it is followed already";
}

// Two driven wheels and a caster: the wheels do not drift, the middle does, for it lies behind them.
TEST(Sideways, OneAxleAwayFromTheMiddleIsFollowedToo) {
    const sim::RoverDescription rover = sim::read_rover_file("rovers/two_wheels.toml");
    std::string text = "duration_s = 40.0\nseed = 5\n[ground]\nsoil = \"concrete\"\n";
    for (const char *wheels : {"[3.0, 7.0, 3.0, 7.0]", "[8.0, 4.0, 8.0, 4.0]", "[9.0, 12.0, 9.0, 12.0]", "[6.0, 6.0, 6.0, 6.0]"})
        text += std::string("[[drive]]\nfor_s = 10.0\nmode = \"wheel_speed\"\nwheel_speed_rad_s = ") + wheels + "\n";
    sim::Scenario scenario = sim::parse_scenario(text, "bends.toml");
    sim::set_rover(scenario, rover);
    const Model model = parse_model(traction::model_text(rover, "concrete"), "two and caster");
    EXPECT_TRUE(drifts_sideways(model, make_dataset(model, simulate(scenario).log)));
}

TEST(Sideways, TheSessionSaysSoAndItsModelKeepsIt) {
    Request request;
    request.model = "models/rover_sand.toml", request.log = "bends.csv";
    request.read = [](const std::string &, const std::string &, std::vector<log::Repair> &) { return bends(); };
    const Session session = open_session(request);
    EXPECT_EQ(session.model.motion, BodyMotion::planar);
    EXPECT_EQ(std::count(session.data.messages.begin(), session.data.messages.end(), followed_sideways), 1);
    EXPECT_TRUE(std::any_of(session.data.balance.begin(), session.data.balance.end(), [](const Balance &b) {
        return b.kind == BalanceKind::camera_y;
    })) << "the camera's sideways rows come with it";
}

TEST(Session, WhatAModelDoesNotStateIsTold) { // a motor's losses and inertia are 0 then, and what they do is an effect
    Request request;
    request.model = "models/rover_sand.toml", request.log = "bends.csv";
    request.read = [](const std::string &, const std::string &, std::vector<log::Repair> &) { return bends(); };
    const auto told = [&](const Model &model) {
        std::string found;
        for (const std::string &m : open_session(request, model).data.messages)
            if (m.find("does not state") != std::string::npos) found += m;
        return found;
    };
    Model model = sand();
    EXPECT_EQ(told(model), "");
    for (WheelSpec &w : model.wheel) w.motor.at("coulomb_Nm") = {};
    EXPECT_NE(told(model).find("motor.coulomb_Nm:"), std::string::npos) << told(model);
    for (WheelSpec &w : model.wheel) w.motor.at("viscous_Nms") = {};
    EXPECT_NE(told(model).find("motor.viscous_Nms, motor.coulomb_Nm:"), std::string::npos) << told(model);
}

TEST(Sideways, WhatIsFoundIsAskedForIt) { // not the session's own model
    Session held;
    held.model = sand(), held.runs = {bends()};
    held.data = make_dataset(held.model, bends());
    held.data.messages = held.told = held.despite = {"kept"};
    const std::optional<Session> anew = asked_anew(held, held.model);
    ASSERT_TRUE(anew);
    EXPECT_EQ(anew->model.motion, BodyMotion::planar);
    EXPECT_EQ(std::count(anew->data.messages.begin(), anew->data.messages.end(), followed_sideways), 1);
    EXPECT_EQ(std::count(anew->data.messages.begin(), anew->data.messages.end(), "kept"), 1);
    EXPECT_EQ(anew->data.despite, held.despite);
    Model found = held.model;
    found.motion = BodyMotion::planar;
    EXPECT_FALSE(asked_anew(held, found)) << "it is followed already";
}

} // namespace
} // namespace traction::lab
