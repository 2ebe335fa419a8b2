#include "scenario.h"

#include "read_parts.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace traction::sim {

namespace {

constexpr std::array<std::string_view, faulty_sensor_count> sensor_names{"encoder", "current", "battery", "accel",         "gyro",
                                                                         "radar",   "camera",  "bridge",  "emergency_stop"};
constexpr std::array<std::string_view, fault_kind_count> kind_names{"stuck", "noisy", "dropped", "delayed",  "timeout", "offset",
                                                                    "drift", "spike", "dead",    "slipping", "lost"};
static_assert(!sensor_names.back().empty() && !kind_names.back().empty(), "each has a name");

// [sensors.accel] and its like: offset, drift, gain, noise in the sensor's unit.
void read_analog(Keys &parent, std::string_view key, const std::string &unit, const std::string &drift_unit, double largest,
                 std::span<AnalogConfig> configs) {
    const toml::table *table = parent.table(key);
    if (table == nullptr) return;
    Keys keys(*table, parent.file(), parent.full_name(key));
    const AnalogConfig &now = configs.front();
    const double gain = keys.number("gain", now.gain, {0.1, 10});
    const double offset = keys.number("offset_" + unit, now.offset, {-largest, largest});
    const double drift = keys.number("drift_" + drift_unit, now.drift_s, {-largest, largest});
    const double noise = keys.number("noise_" + unit, now.noise, {0, largest});
    keys.finish();
    for (AnalogConfig &config : configs) config = {.gain = gain, .offset = offset, .drift_s = drift, .noise = noise};
}

void read_camera(Keys &parent, CameraConfig &camera) {
    const toml::table *table = parent.table("camera");
    if (table == nullptr) return;
    Keys keys(*table, parent.file(), parent.full_name("camera"));
    camera.delay_s = keys.number("delay_s", camera.delay_s, {0, 2});
    camera.noise_m = keys.number("noise_m", camera.noise_m, {0, 1});
    camera.noise_rad = keys.number("noise_rad", camera.noise_rad, {0, 1});
    keys.finish();
}

} // namespace

void read_sensors(const toml::table &table, const std::string &file, SensorConfig &config) {
    Keys keys(table, file, "sensors");
    read_analog(keys, "current", "A", "A_s", 5, config.current);
    read_analog(keys, "battery", "V", "V_s", 5, {&config.battery, 1});
    read_analog(keys, "accel", "m_s2", "m_s3", 10, {&config.accel, 1});
    read_analog(keys, "gyro", "rad_s", "rad_s2", 5, {&config.gyro, 1});
    config.accel_vibration_1_s = keys.number("accel_vibration_1_s", config.accel_vibration_1_s, {0, 10});
    config.heave_m = keys.number("heave_m", config.heave_m, {0, 0.1});
    config.heave_Hz = keys.number("heave_Hz", config.heave_m > 0 ? 8 : 0, {0, 200});
    config.pitch_vibration_rad = keys.number("pitch_vibration_rad", config.pitch_vibration_rad, {0, 0.3});
    config.pitch_vibration_Hz = keys.number("pitch_vibration_Hz", config.pitch_vibration_rad > 0 ? 6 : 0, {0, 200});
    read_camera(keys, config.camera);
    keys.finish();
}

void read_radar(const toml::table &table, const std::string &file, Scenario &scenario) {
    Keys keys(table, file, "radar");
    RadarConfig &config = scenario.sensors.radar;
    static const auto models = radar_models();
    std::array<std::string_view, models.size()> names;
    std::transform(models.begin(), models.end(), names.begin(), [](const RadarModel &model) { return model.name; });
    if (keys.has("model")) { // else the rover's
        config.model = names[keys.word("model", "", names)];
        config.frequency_Hz = config.vertical_deg = config.horizontal_deg = 0;
        scenario.rover.radar = config.model; // which radar is mounted is known to the firmware
    }
    config.mounting_error_deg = keys.number("mounting_error_deg", config.mounting_error_deg, {-10, 10});
    config.height_m = keys.number("height_m", config.height_m, {0.1, 1});
    config.ground_exponent = keys.number("ground_exponent", config.ground_exponent, {0, 2});
    config.echo_count = keys.number("echo_count", config.echo_count, {0, 500});
    config.noise_count = keys.number("noise_count", config.noise_count, {0, 200});
    config.flicker_count = keys.number("flicker_count", config.flicker_count, {0, 200});
    config.dropout_per_s = keys.number("dropout_per_s", config.dropout_per_s, {0, 10});
    config.dropout_s = keys.number("dropout_s", config.dropout_s, {0.01, 10});
    config.offset_error_count = keys.number("offset_error_count", config.offset_error_count, {-500, 500});
    if (const toml::array *list = keys.tables("interference"))
        for (std::size_t i = 0; i < list->size(); i++) {
            Keys line(*(*list)[i].as_table(), file, "radar.interference[" + std::to_string(i) + "]");
            config.interference.push_back({line.need_number("frequency_Hz", {0.1, 10000}), line.need_number("rms_count", {0, 500})});
            line.finish();
        }
    keys.finish();
}

namespace {

SensorFault read_sensor_fault(Keys &keys) {
    SensorFault fault;
    fault.sensor = static_cast<FaultySensor>(keys.word("sensor", "", sensor_names));
    fault.kind = static_cast<FaultKind>(keys.word("how", "", kind_names));
    if (fault.sensor == FaultySensor::encoder || fault.sensor == FaultySensor::current || fault.sensor == FaultySensor::bridge)
        fault.wheel = static_cast<int>(keys.integer("wheel", -1, 0, wheel_count - 1));
    const bool rising = fault.kind == FaultKind::offset || fault.kind == FaultKind::drift || fault.kind == FaultKind::spike;
    if (rising && (fault.sensor == FaultySensor::accel || fault.sensor == FaultySensor::gyro)) {
        constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
        fault.axis = static_cast<int>(keys.word("axis", fault.sensor == FaultySensor::gyro ? "z" : "x", axes));
    }
    if (fault.kind == FaultKind::noisy) fault.amount = keys.need_number("noise", {0, 10000});
    if (fault.kind == FaultKind::delayed) fault.amount = keys.need_number("delay_s", {0, 2});
    if (fault.kind == FaultKind::offset) fault.amount = keys.need_number("offset", {-10000, 10000});
    if (fault.kind == FaultKind::drift) fault.amount = keys.need_number("drift_s", {-10000, 10000});
    if (fault.kind == FaultKind::spike) fault.amount = keys.need_number("spike", {-10000, 10000});
    if (fault.kind == FaultKind::dead) fault.amount = keys.number("noise", 0.3, {0, 100});
    if (fault.kind == FaultKind::slipping || fault.kind == FaultKind::lost) fault.amount = keys.need_number("share", {0, 1});
    const bool radar_kind = fault.kind == FaultKind::dead || fault.kind == FaultKind::lost;
    if (radar_kind && fault.sensor != FaultySensor::radar)
        keys.fail("how", "is a way in which the radar fails", "write sensor = \"radar\"");
    if (fault.kind == FaultKind::slipping && fault.sensor != FaultySensor::encoder)
        keys.fail("how", "is a way in which an encoder fails", "write sensor = \"encoder\"");
    const bool line = fault.sensor == FaultySensor::bridge || fault.sensor == FaultySensor::emergency_stop;
    if (line && fault.kind != FaultKind::dropped && fault.kind != FaultKind::timeout)
        keys.fail("how", "is not a way in which a line of one bit fails", "write \"dropped\" or \"timeout\"");
    if (fault.sensor == FaultySensor::camera && (rising || radar_kind))
        keys.fail("how", "is for the rover's own devices; the camera is none of them",
                  "write \"stuck\", \"noisy\", \"dropped\" or \"delayed\"");
    if (fault.kind == FaultKind::timeout && fault.sensor == FaultySensor::camera)
        keys.fail("how", "is for the rover's own devices; the camera is none of them", "write \"dropped\"");
    return fault;
}

CanFault read_can_fault(Keys &keys, double from_s, double to_s) {
    constexpr std::array<std::string_view, 6> kinds{"lost", "duplicated", "late", "corrupted", "silent", "bus_off"};
    constexpr std::array<std::string_view, 7> nodes{"wheel0", "wheel1", "wheel2", "wheel3", "sensors", "computer", "all"};
    CanFault fault{.from_s = from_s, .to_s = to_s};
    fault.kind = static_cast<CanFaultKind>(keys.word("how", "", kinds));
    fault.node = static_cast<CanNode>(keys.word("node", "all", nodes));
    if (fault.kind != CanFaultKind::silent && fault.kind != CanFaultKind::bus_off) fault.share = keys.need_number("share", {0, 1});
    return fault;
}

} // namespace

void read_faults(const toml::array &list, const std::string &file, Scenario &scenario) {
    constexpr std::array<std::string_view, 8> what{"wheel_blocked", "sensor",    "emergency_stop", "command_lost",
                                                   "motor_open",    "brown_out", "missed_ticks",   "can"};
    for (std::size_t i = 0; i < list.size(); i++) {
        Keys keys(*list[i].as_table(), file, "fault[" + std::to_string(i) + "]");
        const std::size_t kind = keys.word("what", "", what);
        const double from_s = keys.number("from_s", 0, {0, 36000});
        const double to_s = keys.number("to_s", scenario.duration_s, {0, 36000});
        if (to_s < from_s) keys.fail("to_s", "ends before it begins", "give a time after from_s");
        if (kind == 0) {
            if (!keys.has("wheel")) keys.fail("wheel", "missing", "give 0, 1, 2 or 3");
            const long wheel = keys.integer("wheel", 0, 0, wheel_count - 1);
            scenario.wheel_blocks.push_back({static_cast<int>(wheel), from_s, to_s});
        } else if (kind == 1) {
            SensorFault fault = read_sensor_fault(keys);
            fault.from_s = from_s;
            fault.to_s = to_s;
            scenario.sensor_faults.push_back(fault);
        } else if (kind == 2) {
            scenario.emergency_stops.emplace_back(from_s, to_s);
        } else if (kind == 3) {
            scenario.command_losses.emplace_back(from_s, to_s);
        } else if (kind == 4) {
            if (!keys.has("wheel")) keys.fail("wheel", "missing", "give 0, 1, 2 or 3");
            scenario.open_motors.push_back({static_cast<int>(keys.integer("wheel", 0, 0, wheel_count - 1)), from_s, to_s});
        } else if (kind == 5) {
            scenario.supply_sags.push_back({keys.need_number("sag_V", {0, 60}), from_s, to_s});
        } else if (kind == 7) {
            if (!scenario.can_bus) keys.fail("what", "is a fault of the CAN bus, and there is none", "write bus = \"can\" at the top");
            scenario.can_faults.push_back(read_can_fault(keys, from_s, to_s));
        } else {
            const auto ticks = static_cast<std::uint32_t>(keys.integer("ticks", 1, 1, 1000));
            scenario.missed_ticks.push_back({ticks, keys.number("every_s", 0, {0, 3600}), from_s, to_s});
        }
        keys.finish();
    }
}

} // namespace traction::sim
