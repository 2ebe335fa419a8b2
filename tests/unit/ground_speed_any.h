// ground_speed_any.h - any track and any past, for the tests of ground_speed's parts: each equation of ground_speed.h against one of its
// own in double.
#pragma once

#include "firmware/core/rover_config.h"
#include "tests/unit/clutter.h"

#include <cmath>
#include <cstdint>

extern "C" {
#include "firmware/core/ground_speed_parts.h"
}

namespace any_state {

inline double wide(float x) { return static_cast<double>(x); }
inline float narrow(double x) { return static_cast<float>(x); }
inline double square(double x) { return x * x; }

struct Any : clutter::Random {
    double between(double low, double high) { return low + (high - low) * uniform(); }
    double log_between(double low, double high) { return low * std::pow(high / low, uniform()); }
    bool one_in(int n) { return next() % static_cast<unsigned>(n) == 0; }
    double either() { return one_in(2) ? -1 : 1; }

    ground_speed_track_t track(double v_max = 2, double b_max = 2) {
        const double vv = log_between(1e-5, 1), bb = log_between(1e-5, 1);
        return {narrow(between(-v_max, v_max)), narrow(between(-b_max, b_max)), narrow(vv),
                narrow(between(-0.95, 0.95) * std::sqrt(vv * bb)), narrow(bb)};
    }

    // A past of a ring's length: an acceleration that wanders, and noise.
    ground_speed_state_t past(const ground_speed_config_t &config) {
        ground_speed_state_t made;
        ground_speed_reset(&config, &made);
        auto V = static_cast<uint32_t>(next()); // it may wrap anywhere
        const double noise = 3.5 * log_between(0.02, 3);
        double accel = between(-2, 2);
        made.head = static_cast<int32_t>(next() % GROUND_SPEED_HISTORY);
        for (int k = 0; k < GROUND_SPEED_HISTORY; ++k) {
            const double u = uniform() - 0.5, w = std::fmod(1021 * u, 0.5);
            accel += 0.5 * u - 0.02 * accel;
            V += static_cast<uint32_t>(static_cast<int32_t>((accel + noise * w) * 0.01 * 1048576));
            made.integral_q20[(made.head + 1 + k) % GROUND_SPEED_HISTORY] = static_cast<int32_t>(V);
        }
        const ground_speed_track_t best = track();
        ground_speed_keep_best(&made, &best);
        made.speed_noise_m2_s2 = narrow(log_between(4e-6, 4e-4));
        made.wheel_m_s = narrow(between(-1, 1));
        made.wheel_mean_m_s = narrow(wide(made.wheel_m_s) + between(-0.1, 0.1));
        return made;
    }

    // And the last value, as it came.
    void value(const ground_speed_config_t &config, ground_speed_state_t &made) {
        made.value_heard_m_s = narrow(between(0.02, 1.5));
        made.value_m_s = made.value_heard_m_s;
        made.value_accel_m_s2 = narrow(between(-2, 2));
        made.value_trust = narrow(one_in(2) ? 1 : log_between(1, 30));
        made.value_noise_m2_s2 = narrow(log_between(3e-5, 1e-2));
        made.value_tau_s = narrow(wide(config.window->tau_s) + between(0, 0.1));
        made.value_change_m_s = narrow(between(-0.3, 0.3));
        made.value_sign = narrow(either());
        made.value_cost = narrow(between(-10, 5));
        made.value_wheel_m_s = narrow(between(-1.2, 1.2));
        made.value_parts = one_in(3);
    }
};

// V `back` ticks before the newest one [m/s]; of V alone only differences mean something.
inline double passed(const ground_speed_state_t &state, int newer_back, int older_back) {
    const auto at = [&](int back) {
        return static_cast<uint32_t>(state.integral_q20[(state.head + 4 * GROUND_SPEED_HISTORY - back) % GROUND_SPEED_HISTORY]);
    };
    return static_cast<double>(static_cast<int32_t>(at(newer_back) - at(older_back))) / 1048576.0;
}

// Mean and variance of h . [v, b], h = [1, tau].
inline double mean_of(const ground_speed_track_t &t, double tau) { return wide(t.speed_m_s) + tau * wide(t.bias_m_s2); }
inline double spread_of(const ground_speed_track_t &t, double tau) {
    return wide(t.p_vv) + 2 * tau * wide(t.p_vb) + tau * tau * wide(t.p_bb);
}

} // namespace any_state
