// Scenario files: everything in the gallery reads, and each kind of mistake is told with file, line, key and the mend.
#include "sim/scenario/scenario.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

using namespace traction::sim;

namespace {

const std::string drive = "[[drive]]\nfor_s = 1.0\nmode = \"stop\"\n";

std::string message(const std::string &text) {
    try {
        parse_scenario(text, "x.toml");
    } catch (const ScenarioError &error) {
        return error.what();
    }
    return "accepted";
}

} // namespace

TEST(Scenario, every_file_of_the_gallery_reads) {
    int count = 0;
    for (const auto &entry : std::filesystem::directory_iterator("scenarios")) {
        if (entry.path().extension() != ".toml") continue;
        const Scenario scenario = read_scenario(entry.path().string());
        EXPECT_EQ(scenario.name, entry.path().stem().string());
        EXPECT_DOUBLE_EQ(scenario.drive.back().to_s, scenario.duration_s) << scenario.name; // the plan fills the run
        count++;
    }
    EXPECT_GE(count, 11);
}

// The gallery's own picture, from where the test runs.
TEST(Scenario, a_picture_of_heights_needs_its_scales_and_a_csv_has_others) {
    const auto with = [](const std::string &keys) { return message("duration_s = 1\n[ground.terrain]\n" + keys + drive); };
    const std::string dunes = "map = \"scenarios/dunes.png\"\n", cell = "map_cell_m = 0.05\n";
    EXPECT_EQ(with(dunes + cell + "map_white_m = 0.1\n"), "accepted");
    EXPECT_EQ(with(dunes + "map_white_m = 0.1\n"), "x.toml:2: ground.terrain.map_cell_m: missing; give a number from 0.001 to 10");
    EXPECT_EQ(with(dunes + cell), "x.toml:2: ground.terrain.map_white_m: missing; give a number from -1000 to 1000");
    EXPECT_EQ(with(dunes + cell + "map_height = 0.5\n"), "x.toml:5: ground.terrain.map_height = 0.5: is of a CSV, and the map is a PNG; "
                                                         "give the heights of white and black: map_white_m, map_black_m");
    EXPECT_EQ(with("map = \"README.md\"\nmap_black_m = 0.5\n"),
              "x.toml:4: ground.terrain.map_black_m = 0.5: is of a PNG, and the map is a CSV; scale a CSV's heights by map_height");
    EXPECT_EQ(with("map = \"none.png\"\n" + cell + "map_white_m = 1\n"),
              "x.toml:3: ground.terrain.map = 'none.png': none.png: cannot be read; name a PNG of heights; the file's place is counted "
              "from the scenario's folder");
}

TEST(Scenario, a_mistake_is_told_with_file_line_key_value_and_mend) {
    struct Case {
        std::string text, expected;
    };
    const Case cases[] = {
        {"duration_s = 1\nseeds = 3\n" + drive, "x.toml:2: seeds = 3: unknown key; did you mean seed?"},
        {"duration_s = 1\n[ground]\nsoil = \"snd\"\n" + drive, "x.toml:3: ground.soil = 'snd': no such soil; use one of: concrete"},
        {"duration_s = 1\n[ground]\nslope_rad = \"up\"\n" + drive,
         "x.toml:3: ground.slope_rad = 'up': not a finite number; give a number from -0.5 to 0.5"},
        {"duration_s = 1\n[ground]\nslope_rad = 2\n" + drive,
         "x.toml:3: ground.slope_rad = 2: out of range; give a number from -0.5 to 0.5"},
        {"duration_s = nan\n" + drive, "x.toml:1: duration_s = nan: not a finite number"},
        {"duration_s = -1\n" + drive, "x.toml:1: duration_s = -1: out of range"},
        {drive, "duration_s: missing; give a number"},
        {"duration_s = 1\n", "drive: missing; add at least one [[drive]]"},
        {"duration_s = 1\nseed = 1.5\n" + drive, "x.toml:2: seed = 1.5: not a whole number"},
        {"duration_s = 1\n[drive]\nfor_s = 1\n", "x.toml:2: drive = {...}: not a list of tables; write [[drive]]"},
        {"duration_s = 1\n[[drive]]\nfor_s = 1\nmode = \"fly\"\n",
         "x.toml:4: drive[0].mode = 'fly': not known here; use one of: stop, open_loop"},
        {"duration_s = 1\n[[drive]]\nfor_s = 1\nmode = \"platform_speed\"\n", "drive[0].speed_m_s: missing in this mode"},
        {"duration_s = 1\n[[drive]]\nfor_s = 1\nmode = \"platform_speed\"\nspeed_m_s = [1, 2, 3]\n",
         "drive[0].speed_m_s = [ 1, 2, 3 ]: a ramp has two ends; write [from, to]"},
        {"duration_s = 1\n[[drive]]\nfor_s = 1\nmode = \"stop\"\nduty = 1\n", "x.toml:5: drive[0].duty = 1: unknown key"},
        {"duration_s = 1\n" + drive + "[[drive]]\nfrom_s = 0.5\nfor_s = 1\nmode = \"stop\"\n",
         "drive[1].from_s = 0.5: begins before the segment above ends"},
        {"duration_s = 1\n" + drive + "[[fault]]\nwhat = \"sensor\"\nsensor = \"radar\"\nhow = \"noisy\"\n", "fault[0].noise: missing"},
        {"duration_s = 1\n" + drive + "[[fault]]\nwhat = \"wheel_blocked\"\n", "fault[0].wheel: missing; give 0, 1, 2 or 3"},
        {"duration_s = 1\n" + drive + "[[effect]]\nname = \"slip_sinkag\"\n",
         "effect[0].name = 'slip_sinkag': no such effect; use one of: coulomb_friction"},
        {"duration_s = 1\n" + drive + "[[effect]]\nname = \"slip_sinkage\"\nwheel = 1\n",
         "effect[0].wheel = 1: this effect is not confined to a wheel"},
        {"duration_s = 1\n" + drive + "[[effect]]\nname = \"slip_sinkage\"\ncoefficient = 7\n",
         "effect[0].coefficient = 7: out of range; give a number from 0 to 0.6"},
        {"duration_s = 1\n" + drive + "[[effect]]\nname = \"torque_ripple\"\norder = 0.5\n",
         "effect[0].order = 0.5: out of range; give a number from 1 to 8, or from -8 to -1"},
        {"duration_s = 1\n" + drive + "[hidden]\n", "hidden.draw_from_seed: missing"},
        {"duration_s = 1\n[radar]\nmodel = \"X\"\n" + drive,
         "x.toml:3: radar.model = 'X': not known here; use one of: MDU1130, DJ Radar II"},
        {"duration_s = = 1\n", "x.toml:1: "},
    };
    for (const Case &c : cases) EXPECT_NE(message(c.text).find(c.expected), std::string::npos) << c.text << "\ngave: " << message(c.text);
}

// What the first hour outdoors brings: each bad value is refused with its file, line, key and mend, and what is right is read.
TEST(Scenario, a_mistake_in_what_happens_outdoors_is_told_like_any_other) {
    const auto ground = [](const std::string &line) { return "duration_s = 1\n[ground]\n" + line + "\n" + drive; };
    const auto sensors = [](const std::string &line) { return "duration_s = 1\n[sensors]\n" + line + "\n" + drive; };
    const auto radar = [](const std::string &line) { return "duration_s = 1\n[radar]\n" + line + "\n" + drive; };
    const auto fault = [](const std::string &lines) { return "duration_s = 1\n" + drive + "[[fault]]\n" + lines; };
    struct Case {
        std::string text, expected;
    };
    const Case cases[] = {
        {ground("slope_steps = [[1.0, 0.75]]"), "x.toml:3: ground.slope_steps = 0.75: out of range; give a number from -0.5 to 0.5"},
        {ground("slope_steps = [[2.0, 0.1], [1.0, 0.0]]"), "its path does not lie after the one before; order the steps by their path"},
        {ground("slope_steps = [1.0, 0.1]"), "x.toml:3: ground.slope_steps = 1.0: is not a list of pairs"},
        {ground("slope_blend_m = 0"), "x.toml:3: ground.slope_blend_m = 0: out of range; give a number from 0.001 to 10"},
        {sensors("heave_m = -0.001"), "x.toml:3: sensors.heave_m = -0.001: out of range; give a number from 0 to 0.1"},
        {sensors("heave_Hz = \"fast\""), "x.toml:3: sensors.heave_Hz = 'fast': not a finite number; give a number from 0 to 200"},
        {sensors("pitch_vibration_rad = 1"), "x.toml:3: sensors.pitch_vibration_rad = 1: out of range; give a number from 0 to 0.3"},
        {sensors("pitch_vibration_Hz = 300"), "x.toml:3: sensors.pitch_vibration_Hz = 300: out of range; give a number from 0 to 200"},
        {radar("offset_error_count = 501"), "x.toml:3: radar.offset_error_count = 501: out of range; give a number from -500 to 500"},
        {radar("[[radar.interference]]\nfrequency_Hz = 0"),
         "x.toml:4: radar.interference[0].frequency_Hz = 0: out of range; give a number from 0.1 to 10000"},
        {radar("[[radar.interference]]\nfrequency_Hz = 50"), "radar.interference[0].rms_count: missing"},
        {fault("what = \"missed_ticks\"\nticks = 0\n"), "fault[0].ticks = 0"},
        {fault("what = \"brown_out\"\n"), "fault[0].sag_V: missing"},
        {fault("what = \"motor_open\"\n"), "fault[0].wheel: missing"},
        {fault("what = \"sensor\"\nsensor = \"radar\"\nhow = \"lost\"\nshare = 1.5\n"), "fault[0].share = 1.5: out of range"},
        {fault("what = \"sensor\"\nsensor = \"encoder\"\nwheel = 0\nhow = \"slipping\"\n"), "fault[0].share: missing"},
        {fault("what = \"sensor\"\nsensor = \"accel\"\nhow = \"spike\"\n"), "fault[0].spike: missing"},
        {fault("what = \"sensor\"\nsensor = \"gyro\"\nhow = \"dead\"\n"), "fault[0].how = 'dead'"},
    };
    for (const Case &c : cases) EXPECT_NE(message(c.text).find(c.expected), std::string::npos) << c.text << "\ngave: " << message(c.text);
    EXPECT_EQ(message(ground("slope_steps = [[1.0, 0.1], [2.0, 0.0]]\nslope_blend_m = 0.2")), "accepted");
    EXPECT_EQ(message(sensors("heave_m = 0.005\nheave_Hz = 8.0\npitch_vibration_rad = 0.01\npitch_vibration_Hz = 5.0")), "accepted");
    EXPECT_EQ(message(radar("[[radar.interference]]\nfrequency_Hz = 50.0\nrms_count = 10.0")), "accepted");
}

TEST(Scenario, a_plan_ramps_waves_and_stops_where_nothing_is_asked) {
    const Scenario scenario = parse_scenario(R"(
duration_s = 20
[[drive]]
for_s = 10.0
mode = "platform_speed"
speed_m_s = [0.0, 1.0]
yaw_rate_rad_s = { mean = 0.1, amplitude = 0.2, period_s = 4.0 }
[[drive]]
from_s = 12.0
for_s = 2.0
mode = "wheel_speed"
wheel_speed_rad_s = [1.0, [0.0, 2.0], 3.0, 4.0]
)",
                                             "x.toml");
    EXPECT_DOUBLE_EQ(demand_at(scenario.drive, 2.5).speed_m_s, 0.25);
    EXPECT_NEAR(demand_at(scenario.drive, 1).yaw_rate_rad_s, 0.3, 1e-12); // a quarter period: mean + amplitude
    EXPECT_EQ(demand_at(scenario.drive, 11).mode, DriveMode::stop);
    EXPECT_DOUBLE_EQ(demand_at(scenario.drive, 13).wheel_speed_rad_s[1], 1);
    EXPECT_DOUBLE_EQ(demand_at(scenario.drive, 13).wheel_speed_rad_s[3], 4);
    EXPECT_EQ(demand_at(scenario.drive, 15).mode, DriveMode::stop);
}

TEST(Hidden, a_draw_repeats_by_seed_stays_plausible_and_reaches_the_whole_catalogue) {
    std::set<std::string_view> drawn;
    for (std::uint64_t seed = 0; seed < 600; seed++) {
        const auto effects = draw_effects({.seed = seed, .count = 2, .among = {}});
        const auto again = draw_effects({.seed = seed, .count = 2, .among = {}});
        ASSERT_EQ(effects.size(), 2u);
        EXPECT_NE(effects[0].effect, effects[1].effect);
        for (std::size_t i = 0; i < 2; i++) {
            EXPECT_EQ(effects[i].effect, again[i].effect);
            EXPECT_EQ(effects[i].values, again[i].values);
            EXPECT_TRUE(effects[i].wheel == -1 || effects[i].effect->per_wheel);
            drawn.insert(effects[i].effect->name);
            for (std::size_t p = 0; p < effects[i].values.size(); p++) {
                const EffectParameter &parameter = effects[i].effect->parameters[p];
                if (!parameter.strength) continue;
                EXPECT_GE(effects[i].values[p], parameter.minimum);
                EXPECT_LE(effects[i].values[p], parameter.maximum);
                EXPECT_GT(std::abs(effects[i].values[p]), parameter.of_interest) << effects[i].effect->name; // worth finding
            }
        }
    }
    EXPECT_EQ(drawn.size(), catalogue().size());
    const auto only = draw_effects({.seed = 1, .count = 1, .among = {"grade"}});
    EXPECT_EQ(only.front().effect->name, "grade");
}

TEST(Effect, of_the_command_line_is_read_or_refused_with_the_mend) {
    const ActiveEffect effect = parse_effect("coulomb_friction:torque_Nm=0.02,wheel=2");
    EXPECT_EQ(effect.wheel, 2);
    EXPECT_EQ(effect.value("torque_Nm"), 0.02);
    const auto refused = [](const std::string &text) {
        try {
            parse_effect(text);
        } catch (const ScenarioError &error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    EXPECT_NE(refused("nope").find("no such effect"), std::string::npos);
    EXPECT_NE(refused("coulomb_friction:torque_Nm").find("is not parameter=number"), std::string::npos);
    EXPECT_NE(refused("coulomb_friction:torque_Nm=9").find("out of range"), std::string::npos);
    EXPECT_NE(refused("coulomb_friction:force=1").find("no parameter force"), std::string::npos);
    EXPECT_NE(refused("slip_sinkage:coefficient=0.1,wheel=1").find("wheel does not fit"), std::string::npos);
}
