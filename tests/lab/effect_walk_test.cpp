// A walk over the catalogue: each effect acts in the simulated rover or its sensors and in the lab, not at all at zero, and the lab's
// sensitivity to it is that of whole predictions. An effect that nobody reads is seen here.
#include "host_tools/lab/forward/forward.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/simulate/simulate.h"
#include "sim/physics/effects/catalogue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace traction::lab {
namespace {

// Pull, brake, turn, reverse, stop, over one patch of soil and back; 30 s.
constexpr const char *drive = R"(title = "walk"
duration_s = 30.0
seed = 3
[ground]
soil = "sand"
[[drive]]
for_s = 1.0
mode = "stop"
[[drive]]
for_s = 6.0
mode = "open_loop"
duty = [0.7, 0.7, 0.45, 0.45]
[[drive]]
for_s = 3.0
mode = "open_loop"
duty = [0.3, 0.6, 0.3, 0.6]
[[drive]]
for_s = 3.0
mode = "open_loop"
duty = [-0.5, 0.5, -0.5, 0.5]
[[drive]]
for_s = 6.0
mode = "open_loop"
duty = -0.6
[[drive]]
for_s = 2.0
mode = "stop"
[[drive]]
for_s = 8.0
mode = "open_loop"
duty = { amplitude = 0.9, period_s = 2.0 }
[[drive]]
for_s = 1.0
mode = "stop"
)";

class Walk {
  public:
    Walk()
        : scenario_(sim::parse_scenario(drive, "walk.toml")), plain_(simulate(scenario_).log), model_(read_model("models/rover_sand.toml")),
          data_(make_dataset(model_, plain_)), physics_(make_physics(model_)), forward_(data_) {
        forward_.set_base(physics_);
        base_ = forward_.predict(physics_);
    }

    // What is wrong with this row; empty: nothing.
    std::vector<std::string> complaints(const sim::Effect &effect) {
        std::vector<std::string> list;
        const auto say = [&](bool right, const std::string &what) {
            if (!right) list.push_back(std::string(effect.name) + ": " + what);
        };
        say(seen_in_world(effect, 1) > 3, "not seen in the simulated rover at its usual size"); // 3 of one value's standard deviations
        say(seen_in_world(effect, 0) == 0, "changes the simulated rover at zero");
        const Physics usual = with(effect, 1);
        const Eigen::VectorXd there = forward_.predict(usual);
        say(scaled(there - base_).norm() > 3, "not seen in the lab at its usual size"); // so d' of a log of 30 s
        say((forward_.predict(with(effect, 0)).array() == base_.array()).all(), "changes the lab's prediction at zero");
        if ((effect.needs & sim::needs_motion) == 0) // only the stages it names are computed again
            say((forward_.predict_from_base(usual, stages(effect), -1) - there).norm() < 1e-9 * there.norm(), "touches more than it needs");
        for (const sim::EffectParameter &p : effect.parameters)
            if (p.strength && (effect.needs & sim::needs_memory) == 0) sensitivity(effect, p, say);
        return list;
    }

  private:
    static unsigned stages(const sim::Effect &effect) { return effect.needs & stage_all; }

    double seen_in_world(const sim::Effect &effect, double scale) const {
        sim::ActiveEffect active{.effect = &effect, .wheel = -1, .values = {}};
        for (const sim::EffectParameter &p : effect.parameters) active.values.push_back(p.strength ? scale * p.typical : p.typical);
        SimulateOptions options;
        options.effects = {active};
        const log::Log log = simulate(scenario_, options).log;
        double most = 0;
        for (const log::Signal &a : plain_.signals) {
            const auto noise = plain_.header.find("noise." + a.name);
            const log::Signal *b = log.find(a.name);
            if (b == nullptr || (scale == 0 && b->t_s != a.t_s)) return 1e9;
            const bool judged = noise != plain_.header.end();
            std::size_t j = 0; // the radar's estimates come and go: those of the same time
            for (std::size_t k = 0; k < a.value.size(); ++k) {
                while (j < b->t_s.size() && b->t_s[j] < a.t_s[k]) ++j;
                if (j == b->t_s.size() || b->t_s[j] != a.t_s[k]) continue;
                const double change = std::fabs(a.value[k] - b->value[j]);
                if (judged || scale == 0) most = std::max(most, change / (judged ? std::stod(noise->second) : 1));
            }
        }
        return most;
    }

    FreeParameter parameter(const sim::Effect &effect, const sim::EffectParameter &p) const {
        FreeParameter free;
        free.touched = stages(effect);
        for (std::size_t i = 0; p.in_wheel != nullptr && i < physics_.wheel.size(); ++i) {
            Slot slot;
            slot.in_wheel = p.in_wheel, slot.wheel = static_cast<int>(i);
            free.slots.push_back(slot);
        }
        if (p.in_body != nullptr) free.slots.emplace_back().in_body = p.in_body;
        return free;
    }

    Physics with(const sim::Effect &effect, double scale) const {
        Physics moved = physics_;
        for (const sim::EffectParameter &p : effect.parameters)
            for (const Slot &slot : parameter(effect, p).slots) slot.of(moved) = p.strength ? scale * p.typical : p.typical;
        return moved;
    }

    template <typename Say> void sensitivity(const sim::Effect &effect, const sim::EffectParameter &p, const Say &say) {
        const FreeParameter free = parameter(effect, p);
        const double step = 1e-3 * p.of_interest; // the search for a step's speed ends at 1e-9 m/s, which asks for so much
        Physics small = with(effect, 0), moved = small, back = small;
        free.add(small, 1e-3 * step), free.add(moved, step), free.add(back, -step);
        const Eigen::VectorXd tangent = (forward_.predict_from_base(small, free.touched, -1) - forward_.base()) / (1e-3 * step);
        const Eigen::VectorXd whole = (forward_.predict(moved) - forward_.predict(back)) / (2 * step);
        // 3 %: curvature over the larger step
        say((tangent - whole).norm() < 0.03 * whole.norm(),
            "sensitivity to " + std::string(p.name) + " is " + std::to_string(tangent.norm()) + ", by whole predictions " +
                std::to_string(whole.norm()) + ", apart by " + std::to_string((tangent - whole).norm()));
    }

    // In units of each row's noise.
    Eigen::VectorXd scaled(Eigen::VectorXd rows) const {
        Eigen::Index r = 0;
        for (const Balance &b : data_.balance)
            for (std::size_t k = 0; k < b.measured.size(); ++k) rows[r++] /= b.noise > 0 ? b.noise : 1;
        return rows;
    }

    sim::Scenario scenario_;
    log::Log plain_;
    Model model_;
    Dataset data_;
    Physics physics_;
    Forward forward_;
    Eigen::VectorXd base_;
};

TEST(Catalogue, each_effect_acts_in_the_world_and_in_the_lab_and_at_zero_nowhere) {
    Walk walk;
    for (const sim::Effect &effect : sim::catalogue())
        for (const std::string &complaint : walk.complaints(effect)) ADD_FAILURE() << complaint;
}

TEST(Catalogue, an_effect_that_nobody_reads_is_seen) {
    Walk walk;
    sim::Effect dead = *sim::find_effect("coulomb_friction");
    dead.name = "dead";
    // a number that acts only beside another, as a field does that no law reads
    dead.parameters[0].in_wheel = &sim::WheelEffects::stribeck_speed_rad_s;
    const std::vector<std::string> complaints = walk.complaints(dead);
    const auto complains = [&](const std::string &what) {
        return std::any_of(complaints.begin(), complaints.end(),
                           [&](const std::string &text) { return text.find(what) != std::string::npos; });
    };
    EXPECT_TRUE(complains("not seen in the simulated rover"));
    EXPECT_TRUE(complains("not seen in the lab"));
    EXPECT_TRUE(complains("sensitivity"));
}

TEST(Catalogue, a_row_that_names_too_few_needs_is_seen) {
    Walk walk;
    sim::Effect row = *sim::find_effect("torque_constant"); // both balances of the motor
    row.needs = sim::needs_voltage;
    EXPECT_FALSE(walk.complaints(row).empty());
}

TEST(Effect, is_read_by_a_scenario_as_the_lab_writes_it_into_a_model) {
    const Model plain = read_model("models/rover_sand.toml");
    for (const sim::Effect &effect : sim::catalogue())
        for (const double sign : {1.0, -1.0}) {
            Model model = plain;
            model.effects.clear();
            EffectUse use;
            use.name = effect.name;
            use.wheel = effect.per_wheel ? 2 : -1;
            std::vector<double> values;
            for (const sim::EffectParameter &p : effect.parameters) {
                values.push_back(sign < 0 && p.both_signs ? -p.variants.back() : p.typical);
                Parameter &written = use.parameters[std::string(p.name)];
                written.value = values.back(), written.unit = p.unit, written.fixed = !p.strength;
                if (p.strength) written.low = 0.5 * p.typical, written.high = 2 * p.typical, written.minimum = p.minimum;
            }
            model.effects.push_back(use);
            const std::string text = model_text(model);
            const sim::Scenario scenario = sim::parse_scenario(drive + text.substr(text.find("[[effect]]")), "written.toml");
            ASSERT_EQ(scenario.effects.size(), 1u);
            EXPECT_EQ(scenario.effects[0].effect, &effect);
            EXPECT_EQ(scenario.effects[0].wheel, use.wheel);
            EXPECT_EQ(scenario.effects[0].values, values) << effect.name;
            const Physics physics = make_physics(parse_model(text, "written.toml")); // and by the lab itself
            for (std::size_t j = 0; j < effect.parameters.size(); ++j) {
                const sim::EffectParameter &p = effect.parameters[j];
                EXPECT_EQ(p.in_wheel != nullptr ? physics.wheel[2].*p.in_wheel : physics.body.*p.in_body, values[j]) << effect.name;
            }
        }
}

TEST(Effect, several_of_one_kind_add_up_in_the_lab_as_in_the_plant) {
    Model model = read_model("models/rover_sand.toml");
    model.effects.clear();
    const std::string text = model_text(model) + "\n[[effect]]\nname = \"coulomb_friction\"\ntorque_Nm = 0.03\n\n[[effect]]\nname = "
                                                 "\"coulomb_friction\"\nwheel = 1\ntorque_Nm = 0.02\n";
    const Physics physics = make_physics(parse_model(text, "two.toml"));
    EXPECT_EQ(physics.wheel[0].coulomb_Nm, 0.03);
    EXPECT_EQ(physics.wheel[1].coulomb_Nm, 0.03 + 0.02);
}

} // namespace
} // namespace traction::lab
