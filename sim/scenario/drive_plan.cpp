#include "drive_plan.h"

#include "sim/physics/math.h"

#include <algorithm>

namespace traction::sim {

double Reference::at(double t_s, double length_s) const {
    const double u = length_s > 0 ? std::clamp(t_s / length_s, 0.0, 1.0) : 1.0;
    const double ramp = start + (end - start) * u;
    return amplitude != 0 ? ramp + amplitude * math::sin(2 * math::pi * t_s / period_s) : ramp;
}

Demand demand_at(const std::vector<DriveSegment> &plan, double t_s) {
    for (const DriveSegment &segment : plan) {
        if (t_s < segment.from_s || t_s >= segment.to_s) continue;
        const double t = t_s - segment.from_s, length = segment.to_s - segment.from_s;
        Demand demand{.mode = segment.mode,
                      .speed_m_s = segment.speed_m_s.at(t, length),
                      .yaw_rate_rad_s = segment.yaw_rate_rad_s.at(t, length),
                      .slip = segment.slip.at(t, length),
                      .wheel_speed_rad_s = {},
                      .duty = {},
                      .slip_wheel = segment.slip_wheel};
        for (std::size_t i = 0; i < wheel_count; i++) {
            demand.wheel_speed_rad_s[i] = segment.wheel_speed_rad_s[i].at(t, length);
            demand.duty[i] = segment.duty[i].at(t, length);
        }
        return demand;
    }
    return {};
}

} // namespace traction::sim
