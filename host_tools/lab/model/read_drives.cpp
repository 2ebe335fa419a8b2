#include "read_drives.h"

#include "sim/physics/effects/catalogue.h"
#include "terms.h"

#include <algorithm>
#include <cstdint>

namespace traction::lab {

namespace {

constexpr const char *key = "rover.drives";

double left_of(const Model &model, std::size_t wheel) { return model.wheel[wheel].geometry.at("y_m").value; }

struct Drives {
    const toml::node &node; // the list
    const toml::table &root;
    Model &model;
    std::vector<int> drive;            // per wheel: whose motor turns it; -1: none yet
    std::vector<std::size_t> for_side; // motors given by their number alone: they turn what is left of their side

    [[noreturn]] void fail(const toml::node &at, const std::string &wrong, const std::string &mend) const {
        throw ModelError(model.file, at.source().begin.line, key, wrong, mend);
    }

    std::size_t wheel(const toml::node &at) const {
        const auto index = at.is_integer() ? at.value<std::int64_t>() : std::nullopt;
        if (!index) fail(at, "holds what is no wheel", "give wheels by their number, such as [0, 1] or [[0, 2], [1, 3]]");
        if (*index < 0 || *index >= static_cast<std::int64_t>(model.wheel.size()))
            fail(at, "names wheel " + std::to_string(*index), "wheels are 0 to " + std::to_string(model.wheel.size() - 1));
        return static_cast<std::size_t>(*index);
    }

    void turn(const toml::node &at, std::size_t turned, std::size_t motor) {
        if (drive[turned] >= 0) fail(at, "has wheel " + std::to_string(turned) + " twice", "a wheel turns with one motor: name it once");
        if (!model.wheel[turned].driven)
            fail(at, "names wheel " + std::to_string(turned) + ", which has driven = false",
                 "take it out of drives, or take driven = false away");
        drive[turned] = static_cast<int>(motor);
    }

    void read() {
        const toml::array *list = node.as_array();
        if (list == nullptr || list->empty())
            fail(node, "is no list of wheels",
                 "give the wheels with a motor, such as [0, 1], or each motor's wheels, its own first, such as [[0, 2], [1, 3]]");
        for (const toml::node &entry : *list) {
            if (!entry.is_array()) {
                for_side.push_back(wheel(entry));
                turn(entry, for_side.back(), for_side.back());
                continue;
            }
            const toml::array &wheels = *entry.as_array();
            if (wheels.empty()) fail(entry, "has an empty list", "give the motor's own wheel, then those that turn with it");
            for (const toml::node &one : wheels) turn(one, wheel(one), wheel(wheels.front()));
        }
    }

    // Wheels that no list names go with the motor of their side.
    void rest() {
        for (std::size_t i = 0; i < model.wheel.size(); ++i) {
            if (drive[i] >= 0 || !model.wheel[i].driven) continue;
            std::vector<std::size_t> beside;
            for (const std::size_t motor : for_side)
                if (left_of(model, i) * left_of(model, motor) > 0) beside.push_back(motor);
            const std::string name = "wheel " + std::to_string(i);
            if (beside.empty())
                fail(node, "leaves " + name + " without a drive",
                     "add it to a motor's wheels, such as [[0, " + std::to_string(i) +
                         "], ...], or write driven = false at it if it rolls freely");
            if (beside.size() > 1)
                fail(node, name + " may turn with wheel " + std::to_string(beside[0]) + " or with wheel " + std::to_string(beside[1]),
                     "name each motor's wheels: [[" + std::to_string(beside[0]) + ", " + std::to_string(i) + "], ...]");
            drive[i] = static_cast<int>(beside[0]);
        }
    }

    void share_motors() {
        const toml::array &tables = *root["wheel"].as_array();
        for (std::size_t i = 0; i < model.wheel.size(); ++i) {
            if (drive[i] < 0 || drive[i] == static_cast<int>(i)) continue;
            const auto motor = static_cast<std::size_t>(drive[i]);
            if (const toml::node *own = tables[i].as_table()->get("motor"))
                throw ModelError(model.file, own->source().begin.line, "wheel[" + std::to_string(i) + "].motor",
                                 "is the motor of a wheel that turns with wheel " + std::to_string(motor),
                                 "write it at wheel " + std::to_string(motor) + ", or give wheel " + std::to_string(i) +
                                     " a drive of its own");
            model.wheel[i].drive = drive[i];
            model.wheel[i].motor = model.wheel[motor].motor;
        }
    }
};

} // namespace

void read_drives(const toml::table &root, Model &model) {
    const toml::table *rover = root["rover"].as_table();
    const toml::node *node = rover != nullptr ? rover->get("drives") : nullptr;
    if (node == nullptr) return;
    Drives drives{*node, root, model, std::vector<int>(model.wheel.size(), -1), {}};
    drives.read();
    drives.rest();
    drives.share_motors();
}

bool acts_on_motor(const EffectUse &use) {
    if (use.expression.empty()) {
        const sim::Effect *known = sim::find_effect(use.name);
        return known != nullptr && sim::of_motor(*known);
    }
    TermTarget target = TermTarget::wheel_torque;
    return parse_target(use.acts_on, target) && acts_on_motor(target);
}

void check_effect_wheel(const toml::table &effect, const std::string &where, const Model &model, const EffectUse &use) {
    if (use.wheel < 0 || model.wheel[static_cast<std::size_t>(use.wheel)].drive < 0 || !acts_on_motor(use)) return;
    const int motor = model.wheel[static_cast<std::size_t>(use.wheel)].drive;
    throw ModelError(model.file, effect.source().begin.line, where + ".wheel",
                     std::to_string(use.wheel) + " turns with wheel " + std::to_string(motor) + ", and " + use.name + " is on a motor",
                     "write wheel = " + std::to_string(motor));
}

} // namespace traction::lab
