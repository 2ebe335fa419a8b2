#include "odd_wheel.h"

#include "host_tools/lab/inputs/smooth.h"
#include "shape_rules.h"
#include "shape_scores.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace traction::lab {

namespace {

constexpr double odd_by_voltage = 1.25, odd_by_torque = 2; // (1)
constexpr double few_rows = 0.01;                          // a current that meets its converter's rail is no fault of the wheel: assumed
constexpr double most_left = 0.5;                          // of a wheel's excess, with its cause in the model: assumed

// Error of each wheel's currents by one of their balances, in noises; 0 where it has none.
std::vector<double> errors_of(const Problem &fitted, BalanceKind kind) {
    std::vector<double> out(fitted.data().wheel.size(), 0);
    const Eigen::VectorXd noise = fitted.noise_rows();
    Eigen::Index row = 0;
    for (const Balance &b : fitted.data().balance) {
        std::vector<double> squares;
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) squares.push_back(std::pow(fitted.residual[row] / noise[row], 2));
        if (b.kind != kind || b.wheel < 0 || static_cast<std::size_t>(b.wheel) >= out.size() || squares.empty()) continue;
        const std::size_t kept = squares.size() - static_cast<std::size_t>(few_rows * static_cast<double>(squares.size()));
        std::nth_element(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(kept - 1), squares.end());
        out[static_cast<std::size_t>(b.wheel)] = std::sqrt(
            std::accumulate(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(kept), 0.0) / static_cast<double>(kept));
    }
    return out;
}

double median_of_others(const std::vector<double> &errors, std::size_t wheel) {
    std::vector<double> others;
    for (std::size_t i = 0; i < errors.size(); ++i)
        if (i != wheel && errors[i] > 0) others.push_back(errors[i]);
    return median(std::move(others));
}

BalanceKind kind_of(bool electric) { return electric ? BalanceKind::current_voltage : BalanceKind::current_torque; }

bool is_electric(TermTarget target) {
    return target == TermTarget::voltage || target == TermTarget::resistance || target == TermTarget::motor_constant;
}

UnknownShape nothing_tried(const OddWheel &wheel) {
    UnknownShape told;
    const std::string what = wheel.electric ? "voltage" : "torque";
    told.variable = std::string("nothing that was tried");
    told.target = std::string(target_name(wheel.electric ? TermTarget::voltage : TermTarget::wheel_torque));
    told.balance = what + " on wheel " + std::to_string(wheel.wheel);
    told.expression = std::string("0");
    told.unit_y = std::string(wheel.electric ? "V" : "N m");
    return told;
}

} // namespace

std::optional<OddWheel> odd_wheel(const Problem &fitted) {
    std::optional<OddWheel> oddest;
    double most = 1;
    for (const bool electric : {true, false}) {
        const std::vector<double> errors = errors_of(fitted, kind_of(electric));
        for (std::size_t i = 0; i < errors.size(); ++i) {
            const double others = median_of_others(errors, i), limit = electric ? odd_by_voltage : odd_by_torque;
            if (!(others > 0) || !(errors[i] / others > most * limit)) continue;
            most = errors[i] / others / limit;
            oddest = OddWheel{static_cast<int>(i), electric, errors[i], others};
        }
    }
    return oddest;
}

double excess_of(const OddWheel &wheel, const Problem &fitted) {
    const std::vector<double> errors = errors_of(fitted, kind_of(wheel.electric));
    const auto i = static_cast<std::size_t>(wheel.wheel);
    return std::pow(errors[i], 2) - std::pow(median_of_others(errors, i), 2);
}

bool explains_wheel(double excess_without, double excess_with) { return excess_with < most_left * excess_without; }

UnknownShape what_acts_on(const OddWheel &wheel, const Problem &fitted) {
    Problem at = fitted; // its forward model is moved about
    const Screen screen(at);
    const std::vector<ShapeScore> scores = all_shapes(at, screen);
    const ShapeScore *best = nullptr;
    for (const ShapeScore &s : scores) {
        const bool acts_so = is_electric(s.candidate.target) == wheel.electric && s.candidate.on == std::vector<int>{wheel.wheel};
        if (acts_so && is_curve(s.candidate) && s.assessment.gain > 0 && (best == nullptr || s.assessment.gain > best->assessment.gain))
            best = &s;
    }
    UnknownShape told = best != nullptr ? describe(*best, screen.heldout_error()) : nothing_tried(wheel);
    told.at_a_guess = true;
    return told;
}

std::string odd_wheel_words(const OddWheel &wheel) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "wheel %d alone is missed by far: its current by the %s of its motor is off by %.3g times its noise, the others' by %.3g",
                  wheel.wheel, wheel.electric ? "voltage" : "torque", wheel.error, wheel.others);
    return text;
}

} // namespace traction::lab
