#include "pack.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace traction::report {

namespace {
constexpr double absent_code = 65535, highest_code = 65534;
}

std::string base64(const std::vector<unsigned char> &bytes) {
    constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t here = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k) word = word << 8U | (k < here ? bytes[i + k] : 0U);
        for (std::size_t k = 0; k < 4; ++k) out += k <= here ? letters[word >> (18U - 6U * k) & 63U] : '=';
    }
    return out;
}

nlohmann::json packed(const std::vector<double> &values) {
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    bool whole = true;
    for (const double value : values) {
        if (!std::isfinite(value)) continue;
        lowest = std::fmin(lowest, value), highest = std::fmax(highest, value);
        whole = whole && value == std::nearbyint(value);
    }
    if (!(lowest <= highest)) lowest = highest = 0;
    const double step = whole && highest - lowest <= highest_code ? 1 : (highest - lowest) / highest_code;
    std::vector<unsigned char> bytes;
    bytes.reserve(2 * values.size());
    for (const double value : values) {
        const double code =
            std::isfinite(value) ? std::fmin(highest_code, step > 0 ? std::nearbyint((value - lowest) / step) : 0) : absent_code;
        const auto word = static_cast<std::uint16_t>(code);
        bytes.push_back(static_cast<unsigned char>(word & 255U));
        bytes.push_back(static_cast<unsigned char>(word >> 8U));
    }
    return {{"lowest", lowest}, {"step", step}, {"data", base64(bytes)}};
}

} // namespace traction::report
