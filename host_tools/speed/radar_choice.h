// radar_choice.h - which radar a recording is of: from a rover's description, from options, from the log's header, else the reference.
#pragma once

#include "speed.h"

#include <optional>
#include <stdexcept>

namespace traction::speed {

struct RadarChoice {
    std::string rover; // file; empty: none
    std::string model; // of table II; empty: none
    std::optional<double> carrier_Hz, vertical_deg, horizontal_deg, depression_deg, band_low_Hz, band_high_Hz, speed_high_m_s, scale;
    bool point = false;
};

// What is given by options stands over what the rover's description says, that over the log's header. Throws sim::ScenarioError and
// std::invalid_argument where it cannot be.
Settings settings_of(const RadarChoice &choice, const log::Log *log);

} // namespace traction::speed
