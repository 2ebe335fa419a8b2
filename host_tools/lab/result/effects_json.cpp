#include "effects_json.h"

namespace traction::lab {

const char *place_of(sim::ActsOn where) {
    switch (where) {
    case sim::ActsOn::wheel_torque:
        return "wheel torque";
    case sim::ActsOn::wheel_force:
        return "wheel force";
    case sim::ActsOn::body_force:
        return "body force";
    case sim::ActsOn::motor_voltage:
        return "motor voltage";
    case sim::ActsOn::kinematics:
        return "kinematics";
    case sim::ActsOn::load:
        return "load";
    case sim::ActsOn::sensor:
        return "sensor";
    }
    return "";
}

nlohmann::json effect_json(const sim::Effect &effect) {
    nlohmann::json parameters = nlohmann::json::array();
    for (const sim::EffectParameter &p : effect.parameters) {
        parameters.push_back({{"name", p.name},
                              {"unit", p.unit},
                              {"meaning", p.meaning},
                              {"strength", p.strength},
                              {"minimum", p.minimum},
                              {"maximum", p.maximum},
                              {"typical", p.typical},
                              {"of_interest", p.of_interest},
                              {"variants", p.variants}});
    }
    return {{"name", effect.name},           {"title", effect.title},       {"acts_on", place_of(effect.acts_on)},
            {"per_wheel", effect.per_wheel}, {"equation", effect.equation}, {"source", effect.source},
            {"signature", effect.signature}, {"reveals", effect.reveals},   {"parameters", parameters}};
}

} // namespace traction::lab
