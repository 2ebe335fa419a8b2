#include "header.h"

#include "hal/sim/counts.h"
#include "host_tools/rover/rover.h"

#include <cstdio>
#include <string>

namespace traction {

namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

// FNV-1a of the scenario's text: says whether two logs come from the same file, and nothing of its content.
std::string text_hash(const std::string &text) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    char out[20];
    std::snprintf(out, sizeof out, "%016llx", static_cast<unsigned long long>(hash));
    return out;
}

} // namespace

// The noise stated is the scenario's sensors', not the run's: an effect that is hidden in the run must not show here.
void write_header(const sim::Scenario &scenario, std::uint64_t seed, log::Log &log) {
    const sim::SensorConfig &sensors = scenario.sensors;
    const sim::RoverDescription &rover = believed(scenario); // what its user takes it for
    const hal::CountScale scale = hal::count_scale(rover);
    const double rad_per_count = 6.283185307179586 / rover.encoder_counts_per_turn();
    log.header["scenario"] = scenario.name;
    log.header["seed"] = std::to_string(seed);
    log.header["config_hash"] = text_hash(scenario.text);
    log.header["firmware"] = scenario.firmware.config;
    log.header["machine"] = "simulated rover";
    for (std::size_t i = 0; i < sim::wheel_count; i++) {
        const std::string wheel = "wheel" + std::to_string(i) + '.';
        log.header["noise." + wheel + "current_A"] = number(sensors.current[i].noise);
        log.header["quantum." + wheel + "current_A"] = number(scale.current_A);
        log.header["quantum." + wheel + "encoder_count"] = "1";
        // rounding of one pulse at both ends of a 10 ms difference: q/(T sqrt 6)
        log.header["noise." + wheel + "speed_rad_s"] = number(rad_per_count / 0.01 * 0.40824829046386302);
        log.header["quantum." + wheel + "speed_rad_s"] = number(rad_per_count / 0.01);
    }
    if (rover.layout().kind != sim::Layout::four) log.header["rover.wheels"] = number(rover.at("layout", "wheels"));
    if (rover.drives[0] >= 0) log.header["rover.drives"] = std::to_string(rover.drives[0]) + ' ' + std::to_string(rover.drives[1]);
    if (const std::string axles = sim::steered_axles(rover.layout()); !axles.empty()) log.header["rover.steering"] = axles;
    log.header["encoder.rad_per_count"] = number(rad_per_count);
    log.header["noise.battery.voltage_V"] = number(sensors.battery.noise);
    log.header["quantum.battery.voltage_V"] = number(scale.battery_V);
    log.header["noise.imu.accel_x_m_s2"] = number(sensors.accel.noise);
    log.header["quantum.imu.accel_x_m_s2"] = number(scale.accel_m_s2);
    log.header["noise.imu.gyro_z_rad_s"] = number(sensors.gyro.noise);
    log.header["quantum.imu.gyro_z_rad_s"] = number(scale.gyro_rad_s);
    log.header["noise.camera.x_m"] = log.header["noise.camera.y_m"] = number(sensors.camera.noise_m);
    log.header["noise.camera.yaw_rad"] = number(sensors.camera.noise_rad);
    // the small sensors average over a tick (sim/sensors/analog.h), and a speed is the difference of two counts
    for (const char *signal : {"wheel.current_A", "wheel.speed_rad_s", "battery.voltage_V", "imu.accel_x_m_s2", "imu.gyro_z_rad_s"})
        log.header[std::string("window.") + signal] = "0.01";
    // a value of the firmware's Doppler stage: floor and share of the speed (docs/performance.md), mean over its window
    const bool paper = scenario.firmware.config == "paper";
    log.header["noise.radar.speed_m_s"] = paper ? "0.02" : "0.008";
    log.header["noise.radar.speed_m_s.relative"] = paper ? "0.1" : "0.015";
    log.header["window.radar.speed_m_s"] = number(rover.at("radar", "window_samples") / rover.at("radar", "rate_Hz"));
    log.header["radar.model"] = rover.radar;
    log.header["radar.sample_rate_Hz"] = number(rover.at("radar", "rate_Hz"));
    parameters_t parameters = firmware_parameters(rover);
    if (scenario.firmware.doppler_scale > 0)
        parameters.rover.value[ROVER_doppler_scale] = static_cast<float>(scenario.firmware.doppler_scale);
    for (const auto &[key, value] : parameter_lines(parameters)) log.header[key] = value; // none for the reference rover
}

} // namespace traction
