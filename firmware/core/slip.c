#include "slip.h"

#include "fixed.h"

#include <math.h>

slip_output_t slip_measure(const slip_config_t *config, float wheel_speed_rad_s, float ground_speed_m_s)
{
    const float rim_m_s = config->wheel_radius_m * wheel_speed_rad_s;
    const float rim_abs = fabsf(rim_m_s);
    const float ground_abs = fabsf(ground_speed_m_s);
    const float largest = fixed_greater(rim_abs, ground_abs) ? rim_abs : ground_abs;
    slip_output_t out = {0.0f, false};
    if (!fixed_is_finite(rim_m_s) || !fixed_is_finite(ground_speed_m_s) || !fixed_greater(largest, 0.0f)) {
        return out;
    }
    const float difference = rim_m_s - ground_speed_m_s;
    // (1); a difference that overflows means opposite signs, hence full sliding
    out.slip = fixed_clamp(fixed_is_finite(difference) ? difference / largest : rim_m_s / rim_abs, -1.0f, 1.0f);
    out.valid = fixed_greater(largest, config->valid_m_s);
    return out;
}

float slip_std(const slip_config_t *config, float wheel_speed_rad_s, float ground_speed_m_s, float ground_std_m_s)
{
    const float rim = fabsf(config->wheel_radius_m * wheel_speed_rad_s);
    const float ground = fabsf(ground_speed_m_s);
    const bool pushed = fixed_greater(rim, ground);
    const float larger = pushed ? rim : ground;
    const float per = 1.0f / larger;
    const float of_larger = (pushed ? config->rim_std_m_s : ground_std_m_s) * ((pushed ? ground : rim) * per);
    const float of_smaller = pushed ? ground_std_m_s : config->rim_std_m_s;
    const float variance = (of_smaller * of_smaller + of_larger * of_larger) * (per * per); // (2)
    return fixed_is_finite(variance) && fixed_greater(1.0f, variance) ? sqrtf(variance) : 1.0f;
}
