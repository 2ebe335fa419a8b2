#include "board_log.h"

#include "host_tools/log/ulog_format.h"
#include "host_tools/simulate/header.h"
#include "host_tools/simulate/recorder.h"
#include "sim/scenario/scenario.h"

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string_view>

namespace traction::board {

namespace {

using log::little_endian, log::ulog_magic, log::ulog_head_bytes;
using Topic = std::map<std::string, log::UlogField, std::less<>>;

// One message's payload by its topic. A field that is not there, or is cut, is 0.
class Row {
  public:
    Row(const Topic &topic, std::string_view payload) : topic_(topic), payload_(payload) {}
    bool has(std::string_view name) const { return topic_.find(name) != topic_.end(); }
    std::uint64_t bits(std::string_view name, std::size_t i = 0) const {
        const auto found = topic_.find(name);
        if (found == topic_.end() || i >= found->second.count) return 0;
        const log::UlogField &field = found->second;
        const std::size_t at = field.at + i * field.size;
        return at + field.size <= payload_.size() ? little_endian(payload_.substr(at, field.size)) : 0;
    }
    template <typename T> void take(T &out, std::string_view name, std::size_t i = 0) const { out = static_cast<T>(bits(name, i)); }
    void take(float &out, std::string_view name, std::size_t i = 0) const {
        const auto value = static_cast<std::uint32_t>(bits(name, i));
        std::memcpy(&out, &value, sizeof out);
    }
    void take(bool &out, std::string_view name, std::size_t i = 0) const { out = bits(name, i) != 0; }

  private:
    const Topic &topic_;
    std::string_view payload_;
};

void read_frame(const Row &row, sensor_frame_t &frame) {
    row.take(frame.tick, "tick");
    row.take(frame.elapsed_ticks, "elapsed_ticks");
    row.take(frame.time_us, "time_us");
    row.take(frame.present, "present");
    for (std::size_t i = 0; i < WHEEL_COUNT; i++) {
        row.take(frame.encoder_count[i], "encoder", i);
        row.take(frame.current_count[i], "current", i);
        row.take(frame.bridge_status[i], "bridge", i);
    }
    row.take(frame.battery_count, "battery");
    row.take(frame.accel_x_count, "accel", 0);
    row.take(frame.accel_y_count, "accel", 1);
    row.take(frame.accel_z_count, "accel", 2);
    row.take(frame.gyro_x_count, "gyro", 0);
    row.take(frame.gyro_y_count, "gyro", 1);
    row.take(frame.gyro_z_count, "gyro", 2);
    row.take(frame.radar_sequence, "radar_sequence");
    row.take(frame.radar_samples, "radar_samples");
    if (frame.radar_samples > RADAR_SAMPLES_PER_TICK_MAX) frame.radar_samples = RADAR_SAMPLES_PER_TICK_MAX;
    row.take(frame.emergency_stop, "emergency_stop");
}

void read_radar(const Row &row, sensor_frame_t &frame) {
    const std::uint32_t first = static_cast<std::uint32_t>(row.bits("sequence")) - frame.radar_sequence;
    for (std::uint32_t i = 0; i < row.bits("samples") && first < RADAR_SAMPLES_PER_TICK_MAX && first + i < RADAR_SAMPLES_PER_TICK_MAX; i++)
        row.take(frame.radar_count[first + i], "count", i);
}

void read_command(const Row &row, command_t &command) {
    const auto mode = row.bits("mode");
    command.mode = mode < MODE_COUNT ? static_cast<control_mode_t>(mode) : MODE_STOP;
    row.take(command.platform_speed_m_s, "platform_speed_m_s");
    row.take(command.yaw_rate_rad_s, "yaw_rate_rad_s");
    for (std::size_t i = 0; i < WHEEL_COUNT; i++) {
        row.take(command.wheel_speed_rad_s[i], "wheel_speed_rad_s", i);
        row.take(command.duty[i], "duty", i);
    }
    row.take(command.slip_ref, "slip_ref");
    row.take(command.slip_wheels, "slip_wheels");
    row.take(command.age_ticks, "age_ticks");
}

void read_trace(const Row &row, const sensor_frame_t &frame, trace_t &trace) {
    trace.tick = frame.tick;
    trace.present = frame.present;
    row.take(trace.faults, "faults");
    row.take(trace.fault_wheels, "fault_wheels");
    const auto mode = row.bits("mode"), drive = row.bits("drive");
    trace.mode = mode < MODE_COUNT ? static_cast<control_mode_t>(mode) : MODE_STOP;
    trace.actuator.drive = drive <= DRIVE_ON ? static_cast<drive_state_t>(drive) : DRIVE_OFF;
    const auto flag = [&row](std::string_view name, std::size_t wheel) { return (row.bits(name) >> wheel & 1u) != 0; };
    for (std::size_t i = 0; i < WHEEL_COUNT; i++) {
        wheel_trace_t &wheel = trace.wheel[i];
        row.take(wheel.speed_rad_s, "speed_rad_s", i);
        row.take(wheel.accel_rad_s2, "accel_rad_s2", i);
        row.take(wheel.set_speed_rad_s, "set_speed_rad_s", i);
        row.take(wheel.current_A, "current_A", i);
        row.take(wheel.torque_Nm, "torque_Nm", i);
        row.take(wheel.traction_N, "traction_N", i);
        row.take(wheel.slip, "slip", i);
        row.take(wheel.slip_std, "slip_std", i);
        row.take(wheel.duty, "duty", i);
        row.take(trace.actuator.duty_q15[i], "duty_q15", i);
        wheel.slip_valid = flag("slip_valid", i);
        wheel.saturated = flag("saturated", i);
        wheel.encoder_refused = flag("encoder_refused", i);
    }
    row.take(trace.battery_voltage_V, "battery_voltage_V");
    row.take(trace.accel_x_m_s2, "accel_x_m_s2");
    row.take(trace.gyro_z_rad_s, "gyro_z_rad_s");
    row.take(trace.radar_speed_m_s, "radar_speed_m_s");
    row.take(trace.speed_m_s, "speed_m_s");
    row.take(trace.speed_std_m_s, "speed_std_m_s");
    row.take(trace.accel_bias_m_s2, "accel_bias_m_s2");
    row.take(trace.radar_fresh, "radar_fresh");
    row.take(trace.standstill, "standstill");
    row.take(trace.actuator.sequence, "order_sequence");
    row.take(trace.actuator.status_led, "status_led");
}

// The messages of a tick come in the order frame, radar, command, trace; a tick is whole with its trace.
class Reader {
  public:
    explicit Reader(const std::string &file) : file_(file) {}
    BoardLog read(std::string_view bytes) {
        const log::UlogStop stop = log::for_each_ulog_message(bytes, [this](char kind, std::string_view payload) { take(kind, payload); });
        if (stop.how == log::UlogEnd::no_message)
            out_.mended.push_back(file_ + ": from byte " + std::to_string(stop.at) + " on there are no messages; left out");
        if (stop.how == log::UlogEnd::within_a_message)
            out_.mended.push_back(file_ + ": cut within a message, at byte " + std::to_string(stop.at) + "; read up to there");
        return finish();
    }

  private:
    void take(char kind, std::string_view payload) {
        if (kind == 'F') {
            const std::size_t colon = payload.find(':');
            const auto fields = colon != std::string_view::npos ? log::ulog_fields(payload.substr(colon + 1)) : std::nullopt;
            if (!fields) return; // nested messages are none of ours
            Topic topic;
            for (const log::UlogField &field : *fields) topic[field.name] = field;
            formats_[std::string(payload.substr(0, colon))] = std::move(topic);
        } else if (kind == 'A' && payload.size() > 3) {
            topics_[little_endian(payload.substr(1, 2))] = std::string(payload.substr(3));
        } else if (kind == 'I' && payload.size() > 1) {
            const std::size_t key = static_cast<std::uint8_t>(payload[0]);
            if (payload.size() >= 1 + key && payload.substr(1, key).ends_with(" ver_sw")) out_.version = payload.substr(1 + key);
        } else if (kind == 'L' && payload.size() > 9) {
            std::array<char, 32> time{};
            std::snprintf(time.data(), time.size(), "%.3f s: ", static_cast<double>(little_endian(payload.substr(1, 8))) * 1e-6);
            out_.text.push_back(time.data() + std::string(payload.substr(9)));
        } else if (kind == 'O' && payload.size() >= 2) {
            out_.mended.push_back(file_ + ": " + std::to_string(little_endian(payload.substr(0, 2))) +
                                  " ms were lost on the rover, its disk was too slow");
        } else if (kind == 'D' && payload.size() > 2) {
            data(little_endian(payload.substr(0, 2)), payload.substr(2));
        }
    }

    void data(std::uint64_t id, std::string_view payload) {
        const auto name = topics_.find(id);
        const auto format = name != topics_.end() ? formats_.find(name->second) : formats_.end();
        if (format == formats_.end()) return;
        const Row row(format->second, payload);
        if (name->second == "frame") {
            now_ = {};
            read_frame(row, now_.frame);
            begun_ = true;
        } else if (begun_ && name->second == "radar") {
            read_radar(row, now_.frame);
        } else if (begun_ && name->second == "command") {
            read_command(row, now_.command);
        } else if (begun_ && name->second == "trace") {
            read_trace(row, now_.frame, now_.trace);
            begun_ = false;
            if (out_.ticks.empty() || now_.frame.tick > out_.ticks.back().frame.tick) // time runs forward, or it is no tick
                out_.ticks.push_back(now_);
        }
    }

    BoardLog finish() {
        if (out_.ticks.empty())
            throw log::LogError(file_, 0, 0, "holds no whole tick of tractiond (topics frame, radar, command, trace)",
                                "give a log_NNNNNN.ulg of its --log folder");
        return std::move(out_);
    }

    std::string file_;
    BoardLog out_;
    std::map<std::string, Topic> formats_;
    std::map<std::uint64_t, std::string> topics_;
    BoardTick now_;
    bool begun_ = false;
};

} // namespace

bool is_ulog(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    std::array<char, ulog_magic.size()> begin{};
    file.read(begin.data(), begin.size());
    return file.gcount() == static_cast<std::streamsize>(ulog_magic.size()) && std::string_view(begin.data(), begin.size()) == ulog_magic;
}

BoardLog read_board_log(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    if (!file.is_open() || file.bad()) throw log::FileError(path, 0, 0, "cannot be read", "give a file that is there");
    if (!std::string_view(bytes).starts_with(ulog_magic) || bytes.size() < ulog_head_bytes)
        throw log::LogError(path, 0, 0, "does not begin as ULog does", "give a log_NNNNNN.ulg of tractiond's --log folder");
    return Reader(path).read(bytes);
}

log::Log to_log(const BoardLog &board, const sim::RoverDescription &rover) {
    Recorder recorder(board.ticks.size(), rover.at("radar", "rate_Hz"), "", sim::firmware_wheels(rover.layout()));
    for (const BoardTick &tick : board.ticks) recorder.add(tick.frame, tick.command, tick.trace);
    log::Log log = recorder.take();
    sim::Scenario scenario;
    sim::set_rover(scenario, rover);
    write_header(scenario, 0, log);
    for (const char *key : {"scenario", "seed", "config_hash", "noise.camera.x_m", "noise.camera.y_m", "noise.camera.yaw_rad"})
        log.header.erase(key);
    log.header["machine"] = rover.name;
    if (!board.version.empty()) log.header["tractiond"] = board.version;
    log.repairs = board.mended;
    return log;
}

} // namespace traction::board
