// What signals.h counts is what it lists: a device or a fault that is added and forgotten there would be silently dead.
#include "firmware/core/fault_name.h"
#include "firmware/core/signals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace {

std::string header() {
    std::ostringstream text;
    text << std::ifstream("firmware/core/signals.h").rdbuf();
    return text.str();
}

// The highest n of "NAME = 1u << n" among the names that begin so; a name that ends in _0 stands for four wheels.
int highest(const std::string &beginning) {
    const std::string text = header();
    const std::regex line(beginning + "([A-Z_0-9]+) = 1u << ([0-9]+)");
    int most = -1;
    for (std::sregex_iterator found(text.begin(), text.end(), line), end; found != end; ++found) {
        const std::string name = (*found)[1];
        const bool of_wheels = name.size() > 2 && name.substr(name.size() - 2) == "_0";
        most = std::max(most, std::stoi((*found)[2]) + (of_wheels ? WHEEL_COUNT - 1 : 0));
    }
    return most;
}

TEST(Signals, all_devices_are_all_bits) {
    ASSERT_GE(highest("FRAME_"), 0) << "firmware/core/signals.h is not where it was";
    EXPECT_EQ(static_cast<unsigned>(FRAME_ALL), (2u << highest("FRAME_")) - 1);
}

TEST(Signals, every_fault_is_counted) { EXPECT_EQ(FAULT_COUNT, highest("FAULT_") + 1); }

TEST(Signals, every_fault_has_a_name_of_its_own_and_what_is_none_is_said_to_be) {
    std::set<std::string> names;
    for (int32_t bit = 0; bit < FAULT_COUNT; bit++) names.insert(fault_name(bit));
    EXPECT_EQ(names.size(), static_cast<std::size_t>(FAULT_COUNT));
    EXPECT_EQ(names.count(""), 0u);
    for (const int32_t bit : {-1, -2147483647, static_cast<int32_t>(FAULT_COUNT), 31, 2147483647})
        EXPECT_STREQ(fault_name(bit), "unknown fault") << bit;
}

} // namespace
