// pack.h - numbers as text: 16 bits each between the lowest and the highest, little-endian, in base64 (RFC 4648).
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace traction::report {

// { "lowest": a, "step": s, "data": base64 }: value = a + s * code. A value that is not finite is the code 65535. Else the text is off by
// s/2 = (highest - lowest) / 131068 at most; whole numbers over a range below 65535 are exact (s = 1).
nlohmann::json packed(const std::vector<double> &values);

std::string base64(const std::vector<unsigned char> &bytes);

} // namespace traction::report
