#include "acting.h"

#include <vector>

namespace traction::sim {

namespace {

// The strengths of the catalogue with what their effects need, in one flat list: it is asked for in every integration.
template <typename Field> struct Strength {
    Field field;
    unsigned needs;
};

template <typename Field> std::vector<Strength<Field>> strengths_at(Field EffectParameter::*place) {
    std::vector<Strength<Field>> list;
    for (const Effect &effect : catalogue())
        for (const EffectParameter &p : effect.parameters)
            if (p.strength && p.*place != nullptr) list.push_back({p.*place, effect.needs});
    return list;
}

template <typename Field, typename Effects> bool any(const std::vector<Strength<Field>> &list, const Effects &effects, unsigned needs) {
    for (const Strength<Field> &s : list)
        if ((s.needs & needs) != 0 && effects.*s.field != 0) return true;
    return false;
}

} // namespace

void act(const ActiveEffect &active, std::span<WheelEffects> wheels, BodyEffects &body) {
    for (std::size_t j = 0; j < active.effect->parameters.size(); ++j) {
        const EffectParameter &p = active.effect->parameters[j];
        const auto put = [&](double &number) { number = p.strength ? number + active.values[j] : active.values[j]; };
        if (p.in_body != nullptr) put(body.*p.in_body);
        for (std::size_t i = 0; p.in_wheel != nullptr && i < wheels.size(); ++i)
            if (active.wheel < 0 || static_cast<std::size_t>(active.wheel) == i) put(wheels[i].*p.in_wheel);
    }
}

RoverEffects act_together(std::span<const ActiveEffect> effects) {
    RoverEffects all;
    for (const ActiveEffect &active : effects) act(active, all.wheel, all.body);
    return all;
}

bool needs_any(const WheelEffects &wheel, unsigned needs) {
    static const auto list = strengths_at(&EffectParameter::in_wheel);
    return any(list, wheel, needs);
}

bool needs_any(const BodyEffects &body, unsigned needs) {
    static const auto list = strengths_at(&EffectParameter::in_body);
    return any(list, body, needs);
}

} // namespace traction::sim
