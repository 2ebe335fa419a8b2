#include "remainder.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

const char *words_of(LeftBy cause) {
    switch (cause) {
    case LeftBy::sensors:
        return "noise of the sensors";
    case LeftBy::ground:
        return "how the ground varies from place to place";
    case LeftBy::encoders:
        return "quick changes of a wheel's speed, which the encoders blur";
    case LeftBy::steep_soil:
        return "slow wheels at small slip, where a little slip changes the pull much";
    case LeftBy::vibration:
        return "what grows with the speed, as vibration does";
    case LeftBy::mixed_speed:
        return "speed that changes within one reading";
    case LeftBy::everywhere:
        return "the same everywhere in the log";
    case LeftBy::outliers:
        return "few large errors";
    }
    return "";
}

Remainder remainder_of(const Problem &problem) {
    Remainder out;
    const std::size_t n = problem.data().balance.size();
    std::array<double, left_by_count> squares{};
    const auto add = [&](LeftBy cause, double value) { squares[static_cast<std::size_t>(cause)] += value; };
    for (std::size_t b = 0; b < n; ++b) {
        const double total = std::pow(problem.balance_rms(b, true), 2), sensors = std::min(1.0, total);
        add(LeftBy::sensors, sensors);
        Eigen::VectorXd parts = problem.variance_parts(b);
        parts[0] = std::max(0.0, parts[0] - 1);
        const double rest = total - sensors, told = parts.sum();
        if (told > rest && told > 0) parts *= rest / told;
        constexpr LeftBy causes[] = {LeftBy::everywhere, LeftBy::ground,    LeftBy::encoders,
                                     LeftBy::steep_soil, LeftBy::vibration, LeftBy::mixed_speed};
        for (Eigen::Index c = 0; c < parts.size(); ++c) add(causes[c], parts[c]);
        add(LeftBy::outliers, std::max(0.0, rest - told));
    }
    double sum = 0;
    for (std::size_t c = 0; c < left_by_count && n > 0; ++c) {
        out.part[c] = std::sqrt(squares[c] / static_cast<double>(n));
        sum += squares[c] / static_cast<double>(n);
    }
    out.error = std::sqrt(sum);
    return out;
}

} // namespace traction::lab
