// tamper.h - what people and machines do to a log, each as a few lines: a unit, a sign, an order, a clock, a dead wire.
#pragma once

#include "host_tools/log/log.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace traction::gate {

constexpr double pi = 3.141592653589793;

inline bool ends(const std::string &name, const std::string &tail) {
    return name.size() >= tail.size() && name.compare(name.size() - tail.size(), tail.size(), tail) == 0;
}

// Every column whose name begins and ends so.
template <typename Change> void each(log::Log &log, const std::string &start, const std::string &tail, Change &&change) {
    for (log::Signal &s : log.signals)
        if (s.name.rfind(start, 0) == 0 && ends(s.name, tail)) change(s);
}
inline void scale(log::Log &log, const std::string &start, const std::string &tail, double factor) {
    each(log, start, tail, [&](log::Signal &s) {
        for (double &v : s.value) v *= factor;
    });
}
inline const char *const motion_columns[] = {".speed_rad_s", ".angle_rad", ".encoder_count"};
inline void scale_motion(log::Log &log, const std::string &wheel, double factor) {
    for (const char *column : motion_columns) scale(log, wheel, column, factor);
}
inline void fold(log::Log &log, const std::string &start, const std::string &tail) {
    each(log, start, tail, [](log::Signal &s) {
        for (double &v : s.value) v = std::fabs(v);
    });
}
// The values of wheel order[i] under the name of wheel i.
inline void reorder(log::Log &log, const std::vector<const char *> &tails, const std::vector<int> &order) {
    const log::Log from = log;
    for (const char *tail : tails)
        for (std::size_t i = 0; i < order.size(); ++i) {
            const std::string to = "wheel" + std::to_string(i) + tail, source = "wheel" + std::to_string(order[i]) + tail;
            for (log::Signal &s : log.signals)
                if (s.name == to)
                    if (const log::Signal *other = from.find(source)) s.t_s = other->t_s, s.value = other->value;
        }
}
inline void late(log::Log &log, const std::string &start, const std::string &tail, double seconds) {
    each(log, start, tail, [&](log::Signal &s) {
        for (double &t : s.t_s) t += seconds;
    });
}
inline void keep_rows(log::Log &log, const std::function<bool(double)> &keep) {
    for (log::Signal &s : log.signals) {
        log::Signal kept{s.name, {}, {}};
        for (std::size_t i = 0; i < s.t_s.size(); ++i)
            if (keep(s.t_s[i])) kept.t_s.push_back(s.t_s[i]), kept.value.push_back(s.value[i]);
        s = std::move(kept);
    }
}
inline void noise(log::Log &log, const std::string &start, const std::string &tail, double sigma) {
    std::mt19937_64 random(7);
    each(log, start, tail, [&](log::Signal &s) {
        for (double &v : s.value) { // sum of twelve uniforms: the same on every library
            double sum = -6;
            for (int i = 0; i < 12; ++i) sum += static_cast<double>(random() >> 11U) * 0x1p-53;
            v += sigma * sum;
        }
    });
}
inline void hold(log::Log &log, const std::string &start, const std::string &tail, double from_s, double to_s) {
    each(log, start, tail, [&](log::Signal &s) {
        double held = 0;
        bool any = false;
        for (std::size_t i = 0; i < s.t_s.size(); ++i) {
            if (s.t_s[i] < from_s || s.t_s[i] > to_s) continue;
            if (!any) held = s.value[i], any = true;
            s.value[i] = held;
        }
    });
}
inline void clip(log::Log &log, const std::string &start, const std::string &tail, double limit) {
    each(log, start, tail, [&](log::Signal &s) {
        for (double &v : s.value) v = std::clamp(v, -limit, limit);
    });
}
inline void reverse_values(log::Log &log, const std::string &start, const std::string &tail) {
    each(log, start, tail, [](log::Signal &s) { std::reverse(s.value.begin(), s.value.end()); });
}
inline void wrap(log::Log &log, const std::string &tail, double period) {
    each(log, "wheel", tail, [&](log::Signal &s) {
        for (double &v : s.value) v -= period * std::floor(v / period);
    });
}
inline void stretch(log::Log &log, double factor) {
    for (log::Signal &s : log.signals)
        for (double &t : s.t_s) t *= factor;
}
inline void erase(log::Log &log, const std::string &start, const std::string &tail) {
    std::erase_if(log.signals, [&](const log::Signal &s) { return s.name.rfind(start, 0) == 0 && ends(s.name, tail); });
}

// The values of another part of the same drive: what stood `seconds` before, round the end.
inline void roll(log::Log &log, const std::string &start, const std::string &tail, double seconds) {
    each(log, start, tail, [&](log::Signal &s) {
        const auto first = std::lower_bound(s.t_s.begin(), s.t_s.end(), s.t_s.empty() ? 0 : s.t_s.front() + seconds);
        std::rotate(s.value.begin(), s.value.begin() + (first - s.t_s.begin()), s.value.end());
    });
}
inline void copy_column(log::Log &log, const std::string &from, const std::string &to) {
    const log::Log as_was = log;
    if (const log::Signal *source = as_was.find(from))
        for (log::Signal &s : log.signals)
            if (s.name == to) s.t_s = source->t_s, s.value = source->value;
}
inline void add(log::Log &log, const std::string &start, const std::string &tail, double amount) {
    each(log, start, tail, [&](log::Signal &s) {
        for (double &v : s.value) v += amount;
    });
}
// A filter of first order, forgotten in the sensor's settings.
inline void low_pass(log::Log &log, const std::string &start, const std::string &tail, double time_constant_s) {
    each(log, start, tail, [&](log::Signal &s) {
        for (std::size_t i = 1; i < s.value.size(); ++i)
            s.value[i] = s.value[i - 1] + (s.value[i] - s.value[i - 1]) * (1 - std::exp(-(s.t_s[i] - s.t_s[i - 1]) / time_constant_s));
    });
}
// A part of the drive once more at its end, as if it had gone on; angles and positions return to where they were.
inline void paste_again(log::Log &log, double from_s, double to_s) {
    double end = 0;
    for (const log::Signal &s : log.signals)
        if (!s.t_s.empty()) end = std::max(end, s.t_s.back());
    for (log::Signal &s : log.signals) {
        const std::size_t n = s.t_s.size();
        for (std::size_t i = 0; i < n; ++i) {
            if (s.t_s[i] < from_s || s.t_s[i] > to_s) continue;
            s.t_s.push_back(s.t_s[i] - from_s + end + 0.01), s.value.push_back(s.value[i]);
        }
    }
}
// A logger that stamps whole buffers: the samples of `buffer_s` all carry the time at which it was written, some microseconds apart.
inline void stamp_by_buffer(log::Log &log, double buffer_s) {
    for (log::Signal &s : log.signals) {
        double last = -1e9;
        for (double &t : s.t_s) {
            t = std::max(buffer_s * std::ceil(t / buffer_s), last + 1e-6);
            last = t;
        }
    }
}

} // namespace traction::gate
