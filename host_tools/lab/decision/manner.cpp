#include "manner.h"

#include "host_tools/lab/fit/identify.h"
#include "host_tools/lab/inputs/dataset.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace traction::lab {

namespace {

constexpr double one_manner = 0.75, near = 0.2; // share of the moving rows, of the median velocity: assumed

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace

bool is_of_one_manner(const Dataset &data) {
    if (data.independent_rows || !data.body_speed_m_s.empty() || data.wheel.empty()) return false;
    std::vector<std::size_t> moving;
    for (std::size_t row = 0; row < data.wheel[0].speed_rad_s.size(); ++row)
        if (std::any_of(data.wheel.begin(), data.wheel.end(),
                        [&](const WheelInput &w) { return std::fabs(w.speed_rad_s[row]) > data.standstill_rad_s; }))
            moving.push_back(row);
    if (moving.empty()) return false;
    std::vector<double> median;
    double square = 0;
    for (const WheelInput &w : data.wheel) {
        std::vector<double> speed;
        for (const std::size_t row : moving) speed.push_back(w.speed_rad_s[row]);
        median.push_back(median_of(std::move(speed)));
        square += median.back() * median.back();
    }
    const auto alike = std::count_if(moving.begin(), moving.end(), [&](std::size_t row) {
        double off = 0;
        for (std::size_t i = 0; i < median.size(); ++i) off += std::pow(data.wheel[i].speed_rad_s[row] - median[i], 2);
        return off < near * near * square;
    });
    return static_cast<double>(alike) > one_manner * static_cast<double>(moving.size());
}

std::optional<std::string> conflict(const Problem &fitted, const Candidate &candidate) {
    if (!is_of_one_manner(fitted.data())) return std::nullopt;
    if (candidate.wheel >= 0 && (candidate.touched & stage_motion) != 0) return "one wheel unlike the others";
    for (const Limit &limit : limits_of(fitted))
        if (!limit.parameter.starts_with("sensors.") && !limit.parameter.starts_with("soil.")) return limit.parameter + " at its limit";
    return std::nullopt;
}

void note_conflict(Diagnosis &d, const std::string &label, const std::string &only_with) {
    const std::string text = label + " would explain a part, but only with " + only_with + ", and this drive has one manner: not named";
    if (std::find(d.messages.begin(), d.messages.end(), text) == d.messages.end()) d.messages.push_back(text);
}

void reject_conflicts(Diagnosis &d, Problem &last, const std::function<Problem(std::size_t)> &take_back) {
    for (std::size_t i = d.accepted.size(); i-- > 0;) {
        const std::string label = d.accepted[i].candidate.label();
        const std::optional<std::string> only_with = conflict(last, d.accepted[i].candidate);
        if (!only_with) continue;
        note_conflict(d, label, *only_with);
        last = take_back(i);
        for (CandidateResult &r : d.ranking)
            if (r.candidate.label() == label) r.verdict = "conflict";
    }
}

bool changes_stated_number(const Candidate &candidate) { return candidate.wheel < 0 && candidate.effect == "rolling_resistance"; }

} // namespace traction::lab
