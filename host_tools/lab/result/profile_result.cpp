#include "profile_result.h"

#include <cmath>
#include <cstdio>

namespace traction::lab {

std::string profile_text(const std::vector<Profile> &profiles) {
    std::string text = "profile likelihood: rise of the misfit over the design effect phi, 95 % at 3.84\n";
    char line[400];
    std::snprintf(line, sizeof line, "%-40s %11s %25s %25s %6s  %s\n", "parameter", "best", "profile 95 %", "Wald 95 %", "phi", "verdict");
    text += line;
    for (const Profile &p : profiles) {
        const auto end = [](double value, bool open, bool at_bound) {
            char number[40];
            std::snprintf(number, sizeof number, "%s%.5g%s", open ? "beyond " : "", value, at_bound ? " (bound)" : "");
            return std::string(number);
        };
        std::string interval = "[";
        interval.append(end(p.low, p.low_open, p.low_at_bound)).append(", ").append(end(p.high, p.high_open, p.high_at_bound)).append("]");
        char wald[64];
        std::snprintf(wald, sizeof wald, "[%.5g, %.5g]", p.wald_low, p.wald_high);
        std::snprintf(line, sizeof line, "%-40s %11.5g %25s %25s %6.1f  %s %s\n", p.parameter.c_str(), p.value, interval.c_str(), wald,
                      p.dispersion, p.verdict.c_str(), p.unit == "1" ? "" : p.unit.c_str());
        text += line;
    }
    return text;
}

nlohmann::json profile_json(const std::vector<Profile> &profiles) {
    const auto finite = [](double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr); };
    nlohmann::json out = nlohmann::json::array();
    for (const Profile &p : profiles)
        out.push_back({{"parameter", p.parameter},
                       {"unit", p.unit},
                       {"value", finite(p.value)},
                       {"low", finite(p.low)},
                       {"high", finite(p.high)},
                       {"low_open", p.low_open},
                       {"high_open", p.high_open},
                       {"low_at_bound", p.low_at_bound},
                       {"high_at_bound", p.high_at_bound},
                       {"wald_low", finite(p.wald_low)},
                       {"wald_high", finite(p.wald_high)},
                       {"dispersion", finite(p.dispersion)},
                       {"verdict", p.verdict},
                       {"x", p.x},
                       {"rise", p.rise}});
    return out;
}

} // namespace traction::lab
