#include "long_log.h"

#include "dataset.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace traction::lab {

std::string keep_busiest(const Model &model, log::Log &log, double most_s) {
    if (!(log.duration_s() > most_s)) return "";
    const Dataset coarse = measured_data(model, log); // its grid is coarse, which is good enough to see where wheels change their speeds
    const double whole_s = coarse.step_s * static_cast<double>(coarse.count > 0 ? coarse.count - 1 : 0);
    if (coarse.independent_rows || coarse.count < 3 || !(whole_s > most_s)) return "";
    std::vector<double> sum(1, 0); // of the changes of speed up to each step
    for (std::size_t k = 1; k < coarse.count; ++k) {
        double change = 0;
        for (const WheelInput &w : coarse.wheel) change += std::fabs(w.speed_rad_s[k] - w.speed_rad_s[k - 1]);
        sum.push_back(sum.back() + change);
    }
    const auto length = static_cast<std::size_t>(most_s / coarse.step_s);
    std::size_t best = 0;
    for (std::size_t k = 0; k + length < coarse.count; ++k)
        if (sum[k + length] - sum[k] > sum[best + length] - sum[best]) best = k;
    const double from_s = coarse.time(best), to_s = from_s + most_s;
    keep_part(log, from_s, to_s);
    char text[260];
    std::snprintf(
        text, sizeof text,
        "the log is %.0f s long: the %.0f s from %.0f s to %.0f s, in which the wheels change their speeds the most, are looked at "
        "(--from, --to: another part)",
        whole_s, most_s, from_s, to_s);
    return text;
}

void keep_part(log::Log &log, double from_s, double to_s) {
    if (!(from_s > 0) && !(to_s > 0)) return;
    if (!(to_s > 0)) to_s = std::numeric_limits<double>::infinity();
    for (log::Signal &s : log.signals) {
        log::Signal part;
        part.name = s.name;
        for (std::size_t i = 0; i < s.t_s.size(); ++i)
            if (s.t_s[i] >= from_s && s.t_s[i] <= to_s) part.t_s.push_back(s.t_s[i]), part.value.push_back(s.value[i]);
        s = std::move(part);
    }
}

} // namespace traction::lab
