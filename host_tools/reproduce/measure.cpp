#include "measure.h"

#include <cmath>
#include <cstdio>

namespace traction {

Spread spread(const std::vector<double> &values) {
    Spread s;
    if (values.empty()) return s;
    for (const double v : values) s.mean += v / static_cast<double>(values.size());
    for (const double v : values) s.deviation += (v - s.mean) * (v - s.mean);
    s.deviation = values.size() > 1 ? std::sqrt(s.deviation / static_cast<double>(values.size() - 1)) : 0;
    return s;
}

std::vector<double> values_between(const log::Log &log, const std::string &name, double from_s, double to_s) {
    std::vector<double> out;
    if (const log::Signal *signal = log.find(name))
        for (std::size_t i = 0; i < signal->t_s.size(); i++)
            if (signal->t_s[i] >= from_s && signal->t_s[i] < to_s) out.push_back(signal->value[i]);
    return out;
}

report::Series line(const log::Log &log, const std::string &name, const std::string &label) {
    report::Series series{.name = label};
    if (const log::Signal *signal = log.find(name)) {
        series.x = signal->t_s;
        series.y = signal->value;
    }
    return series;
}

std::string number(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

std::string with_spread(const Spread &s, int digits) { return number(s.mean, digits) + " +- " + number(s.deviation, digits); }

} // namespace traction
