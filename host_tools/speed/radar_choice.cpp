#include "radar_choice.h"

#include "host_tools/rover/radar_geometry.h"
#include "host_tools/rover/rover.h"

#include <cstdlib>
#include <stdexcept>

namespace traction::speed {

namespace {

constexpr double section_4_Hz = 512; // any rate: measure() puts that of the counts in its place
constexpr double walking_m_s = 1.35, driving_m_s = 15;

void take_rover(const sim::RoverDescription &rover, Settings &out) {
    out.radar = radar_geometry_of(rover);
    out.scale = static_cast<double>(firmware_parameters(rover).rover.value[ROVER_doppler_scale]);
    out.offset_count = static_cast<int>(rover.at("radar", "offset_count"));
    out.max_count = static_cast<int>(rover.at("radar", "max_count"));
    out.quiet_count2 = rover.at("radar", "quiet_count2");
    out.wheel_radius_m = rover.mean_radius_m();
}

// A log of `traction simulate` tells the parameters of the firmware that drove.
void take_header(const log::Log &log, Settings &out) {
    const parameters_t known = parameters_of_lines(log.header);
    const float *v = known.rover.value;
    out.offset_count = static_cast<int>(v[ROVER_radar_offset_count]);
    out.max_count = static_cast<int>(v[ROVER_radar_max_count]);
    out.quiet_count2 = static_cast<double>(v[ROVER_radar_quiet_count2]);
    out.scale = static_cast<double>(v[ROVER_doppler_scale]);
    out.wheel_radius_m = static_cast<double>(v[ROVER_wheel_radius_m]);
    if (known.rover.beam != nullptr) {
        out.radar = geometry_of_lines(log.header, "firmware.radar.");
    } else if (const auto model = log.header.find("radar.model"); model != log.header.end()) {
        sim::RoverDescription described;
        described.radar = model->second;
        out.radar = radar_geometry_of(described);
    }
}

void take_model(const std::string &name, Settings &out) {
    for (const sim::RadarModel &model : sim::radar_models())
        if (model.name == name)
            out.radar = radar_geometry_like_reference(model.frequency_Hz, model.vertical_deg, model.horizontal_deg, section_4_Hz);
}

} // namespace

Settings settings_of(const RadarChoice &choice, const log::Log *log) {
    Settings out;
    if (log != nullptr) take_header(*log, out);
    if (!choice.rover.empty()) take_rover(sim::read_rover_file(choice.rover), out);
    if (!choice.model.empty()) take_model(choice.model, out);
    radar_geometry_t &radar = out.radar;
    if (choice.carrier_Hz || choice.vertical_deg || choice.horizontal_deg) {
        const double depression = radar.depression_deg;
        radar =
            radar_geometry_like_reference(choice.carrier_Hz.value_or(radar.carrier_Hz), choice.vertical_deg.value_or(radar.vertical_deg),
                                          choice.horizontal_deg.value_or(radar.horizontal_deg), section_4_Hz);
        radar.depression_deg = depression;
        radar.band_low_Hz = 0; // of a module of one's own no filter is known
        radar.band_high_Hz = 1e9;
    }
    if (choice.point) {
        radar.target = RADAR_TARGET_POINT;
        radar.speed_high_m_s = driving_m_s;
        if (choice.rover.empty() && choice.model.empty()) radar.band_low_Hz = 0, radar.band_high_Hz = 1e9, radar.depression_deg = 0;
    } else if (radar.speed_high_m_s < walking_m_s) {
        radar.speed_high_m_s = walking_m_s;
    }
    if (choice.depression_deg) radar.depression_deg = *choice.depression_deg;
    if (choice.band_low_Hz) radar.band_low_Hz = *choice.band_low_Hz;
    if (choice.band_high_Hz) radar.band_high_Hz = *choice.band_high_Hz;
    if (choice.speed_high_m_s) radar.speed_high_m_s = *choice.speed_high_m_s;
    if (choice.scale) out.scale = *choice.scale;
    return out;
}

} // namespace traction::speed
