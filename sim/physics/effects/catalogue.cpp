#include "catalogue.h"

#include "parts.h"

#include <array>
#include <charconv>
#include <stdexcept>

namespace traction::sim {

std::span<const Effect> catalogue() {
    static const std::vector<Effect> all = [] {
        std::vector<Effect> list;
        for (const auto part : {drive_effects, ground_effects, body_effects, sensor_effects})
            for (Effect &effect : part()) list.push_back(std::move(effect));
        return list;
    }();
    return all;
}

const Effect *find_effect(std::string_view name) {
    for (const Effect &effect : catalogue())
        if (effect.name == name) return &effect;
    return nullptr;
}

bool of_motor(const Effect &effect) {
    const bool acts = effect.acts_on == ActsOn::wheel_torque || effect.acts_on == ActsOn::motor_voltage || effect.acts_on == ActsOn::sensor;
    return acts && !effect.parameters.empty() && effect.parameters.front().in_wheel != nullptr;
}

bool EffectParameter::takes(double value) const {
    return (value >= minimum && value <= maximum) || (both_signs && value >= -maximum && value <= -minimum);
}

std::string EffectParameter::range() const {
    const auto text = [](double value) {
        std::array<char, 32> buffer{};
        return std::string(buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr);
    };
    const std::string plain = "a number from " + text(minimum) + " to " + text(maximum);
    return both_signs ? plain + ", or from " + text(-maximum) + " to " + text(-minimum) : plain;
}

double ActiveEffect::value(std::string_view parameter) const {
    for (std::size_t i = 0; i < effect->parameters.size() && i < values.size(); ++i)
        if (effect->parameters[i].name == parameter) return values[i];
    throw std::out_of_range("effect " + std::string(effect->name) + " has no parameter " + std::string(parameter));
}

} // namespace traction::sim
