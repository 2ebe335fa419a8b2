#include "creeps.h"

#include "host_tools/lab/decision/manner.h"
#include "host_tools/lab/inputs/inputs.h"

#include <cmath>

namespace traction::lab {

namespace {

constexpr const char *speed_key = "reversal_speed_m_s";
constexpr double speed_m_s = 0.006, deviation_m_s = 0.004, least_m_s = 5e-4; // assumed
constexpr double slow_m_s = 0.05, share = 0.1; // of the rims that move, at least; eight times the speed above (assumed)

} // namespace

bool creeps(const Model &model, const Dataset &data) {
    const bool moves = model.motion == BodyMotion::longitudinal || model.motion == BodyMotion::planar;
    if (!moves || data.wheel.size() != model.wheel.size() || is_of_one_manner(data)) return false;
    std::size_t moving = 0, slow = 0;
    for (std::size_t i = 0; i < model.wheel.size(); ++i) {
        if (const auto stated = model.wheel[i].soil.find(speed_key); stated != model.wheel[i].soil.end() && stated->second.given)
            return false;
        for (const double w : data.wheel[i].speed_rad_s) {
            if (!(std::fabs(w) > data.standstill_rad_s)) continue;
            ++moving;
            if (std::fabs(w) * parameter(model.wheel[i].geometry, "radius_m") < slow_m_s) ++slow;
        }
    }
    return static_cast<double>(slow) > share * static_cast<double>(moving);
}

void ask_for_reversal(Model &model) {
    for (WheelSpec &wheel : model.wheel) {
        Parameter &p = wheel.soil[speed_key];
        p.value = speed_m_s, p.prior = deviation_m_s, p.minimum = least_m_s;
        p.unit = "m/s", p.source = "assumed: the drive is slow";
    }
}

} // namespace traction::lab
