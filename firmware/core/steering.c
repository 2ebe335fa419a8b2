#include "steering.h"

#include "signals.h"

#include <math.h>

float steering_curvature(const steering_config_t *config, float speed_ref_m_s, float yaw_rate_ref_rad_s)
{
    const float limit = config->limit_1_m;
    const float v = fixed_finite(speed_ref_m_s);
    const float yaw = fixed_finite(yaw_rate_ref_rad_s);
    const float most = limit * fabsf(v); // of the yaw rate: no division where it would not hold
    if (fabsf(yaw) >= most) {
        const float side = yaw > 0.0f ? 1.0f : yaw < 0.0f ? -1.0f : 0.0f;
        return v < 0.0f ? -side * limit : side * limit; // (1)
    }
    return fixed_clamp(yaw / v, -limit, limit);
}

static float ahead_m(const steering_config_t *config, int32_t wheel)
{
    return wheel == WHEEL_FRONT_LEFT || wheel == WHEEL_FRONT_RIGHT ? config->front_m : config->rear_m;
}

// A root of what is not negative, bounded so that no square overflows.
static float rooted(float square) { return sqrtf(fixed_clamp(fixed_finite(square), 0.0f, 1e12f)); }

float steering_rim(const steering_config_t *config, int32_t wheel, float forward_m_s, float yaw_rate_rad_s)
{
    const float aside = fixed_clamp(ahead_m(config, wheel) * fixed_finite(yaw_rate_rad_s), -1e5f, 1e5f);
    if (!steering_there(config) || !(fabsf(aside) > 0.0f)) {
        return forward_m_s;
    }
    const float forward = fixed_clamp(fixed_finite(forward_m_s), -1e5f, 1e5f);
    const float rim = rooted(forward * forward + aside * aside); // (2)
    return forward < 0.0f ? -rim : rim;
}

float steering_forward(const steering_config_t *config, int32_t wheel, float rim_m_s, float yaw_rate_rad_s)
{
    const float aside = fixed_clamp(ahead_m(config, wheel) * fixed_finite(yaw_rate_rad_s), -1e5f, 1e5f);
    if (!steering_there(config) || !(fabsf(aside) > 0.0f)) {
        return rim_m_s;
    }
    const float rim = fixed_clamp(fixed_finite(rim_m_s), -1e5f, 1e5f);
    const float forward = rooted(rim * rim - aside * aside); // (3)
    return rim < 0.0f ? -forward : forward;
}
