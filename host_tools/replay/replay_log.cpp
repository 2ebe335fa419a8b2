#include "replay_log.h"

#include "firmware/core/rover_config.h"
#include "hal/replay/frames.h"
#include "hal/replay/replay_hal.h"
#include "host_tools/loop/loop.h"
#include "host_tools/rover/rover.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

namespace traction::replay {

namespace {

// One column read forward, sample by sample.
class Column {
  public:
    Column(const log::Log &log, const std::string &name) : signal_(log.find(name)) {}
    bool there() const { return signal_ != nullptr; }
    // The sample at t_s; `otherwise` when there is none. Times must not fall from call to call.
    double at(double t_s, double otherwise = 0) {
        if (signal_ == nullptr) return otherwise;
        while (next_ < signal_->t_s.size() && signal_->t_s[next_] < t_s - tolerance_s) ++next_;
        return next_ < signal_->t_s.size() && signal_->t_s[next_] < t_s + tolerance_s ? signal_->value[next_] : otherwise;
    }

  private:
    static constexpr double tolerance_s = 1e-4; // radar samples are 1.95 ms apart, ticks 10 ms
    const log::Signal *signal_;
    std::size_t next_ = 0;
};

struct Columns {
    explicit Columns(const log::Log &log)
        : present(log, "frame.present"), samples(log, "frame.radar_samples"), stop(log, "frame.emergency_stop"),
          battery(log, "battery.voltage_count"), accel(log, "imu.accel_x_count"), gyro(log, "imu.gyro_z_count"),
          radar(log, "radar.adc_count"), mode(log, "command.mode"), speed(log, "command.speed_m_s"),
          yaw_rate(log, "command.yaw_rate_rad_s"), time(log, "frame.time_us"), elapsed(log, "frame.elapsed_ticks"),
          sequence(log, "frame.radar_sequence"), accel_y(log, "imu.accel_y_count"), accel_z(log, "imu.accel_z_count"),
          gyro_x(log, "imu.gyro_x_count"), gyro_y(log, "imu.gyro_y_count"), slip(log, "command.slip"),
          slip_wheels(log, "command.slip_wheels"), age(log, "command.age_ticks") {
        for (int i = 0; i < WHEEL_COUNT; ++i) {
            const std::string wheel = "wheel" + std::to_string(i) + '.';
            encoder.emplace_back(log, wheel + "encoder_count");
            current.emplace_back(log, wheel + "current_count");
            wheel_speed.emplace_back(log, wheel + "command_speed_rad_s");
            duty.emplace_back(log, wheel + "command_duty");
            bridge.emplace_back(log, wheel + "bridge_status");
        }
    }
    Column present, samples, stop, battery, accel, gyro, radar, mode, speed, yaw_rate, time, elapsed, sequence, accel_y, accel_z, gyro_x,
        gyro_y, slip, slip_wheels, age;
    std::vector<Column> encoder, current, wheel_speed, duty, bridge;
};

void read_radar(Columns &columns, double t_s, double rate_Hz, sensor_frame_t &frame) {
    frame.radar_samples = static_cast<std::uint8_t>(columns.samples.at(t_s));
    // the converter's clock: sample n at n/rate. A log without sequence numbers lost none: its newest sample is the tick's last
    const double first = columns.sequence.at(t_s, std::floor(t_s * rate_Hz + 1e-6) - frame.radar_samples + 1);
    frame.radar_sequence = static_cast<std::uint32_t>(static_cast<std::int64_t>(first));
    for (int i = 0; i < frame.radar_samples && i < RADAR_SAMPLES_PER_TICK_MAX; ++i)
        frame.radar_count[i] = static_cast<std::uint16_t>(columns.radar.at((first + i) / rate_Hz));
}

LoggedTick read_tick(Columns &columns, double t_s, double rate_Hz) {
    LoggedTick tick{};
    sensor_frame_t &frame = tick.frame;
    frame.tick = static_cast<std::uint32_t>(std::lround(t_s * 100)) - 1; // a tick ends its 10 ms
    frame.present = static_cast<std::uint32_t>(columns.present.at(t_s));
    frame.battery_count = static_cast<std::uint16_t>(columns.battery.at(t_s));
    frame.accel_x_count = static_cast<std::int16_t>(columns.accel.at(t_s));
    frame.gyro_z_count = static_cast<std::int16_t>(columns.gyro.at(t_s));
    // a log from before there was a time read the emergency stop in every tick, and said so of nothing
    if (!columns.time.there()) frame.present |= FRAME_EMERGENCY_STOP;
    frame.time_us = static_cast<std::uint32_t>(columns.time.at(t_s));
    frame.elapsed_ticks = static_cast<std::uint32_t>(columns.elapsed.at(t_s, 1));
    frame.accel_y_count = static_cast<std::int16_t>(columns.accel_y.at(t_s));
    frame.accel_z_count = static_cast<std::int16_t>(columns.accel_z.at(t_s));
    frame.gyro_x_count = static_cast<std::int16_t>(columns.gyro_x.at(t_s));
    frame.gyro_y_count = static_cast<std::int16_t>(columns.gyro_y.at(t_s));
    frame.emergency_stop = columns.stop.at(t_s) != 0;
    read_radar(columns, t_s, rate_Hz, frame);
    command_t &command = tick.command;
    const double mode = columns.mode.at(t_s);
    command.mode = mode >= 0 && mode < static_cast<double>(MODE_COUNT) ? static_cast<control_mode_t>(static_cast<int>(mode)) : MODE_STOP;
    command.platform_speed_m_s = static_cast<float>(columns.speed.at(t_s));
    command.yaw_rate_rad_s = static_cast<float>(columns.yaw_rate.at(t_s));
    command.slip_ref = static_cast<float>(columns.slip.at(t_s));
    command.slip_wheels = static_cast<std::uint8_t>(columns.slip_wheels.at(t_s));
    command.age_ticks = static_cast<std::uint32_t>(columns.age.at(t_s));
    for (std::size_t i = 0; i < WHEEL_COUNT; ++i) {
        frame.encoder_count[i] = static_cast<std::int32_t>(columns.encoder[i].at(t_s));
        frame.current_count[i] = static_cast<std::uint16_t>(columns.current[i].at(t_s));
        frame.bridge_status[i] = static_cast<std::uint8_t>(columns.bridge[i].at(t_s));
        command.wheel_speed_rad_s[i] = static_cast<float>(columns.wheel_speed[i].at(t_s));
        command.duty[i] = static_cast<float>(columns.duty[i].at(t_s));
    }
    return tick;
}

// The ticks as the source of the HAL that replays them.
struct Source {
    const std::vector<LoggedTick> &ticks;
    std::size_t next = 0;
};

hal_result_t next_tick(void *context, sensor_frame_t *frame, command_t *command) {
    auto &source = *static_cast<Source *>(context);
    if (source.next >= source.ticks.size()) return HAL_END;
    *frame = source.ticks[source.next].frame;
    *command = source.ticks[source.next].command;
    source.next++;
    return HAL_OK;
}

} // namespace

std::vector<LoggedTick> logged_ticks(const log::Log &log) {
    for (const char *name : {"frame.present", "command.mode", "wheel0.encoder_count", "wheel0.current_count"})
        if (log.find(name) == nullptr)
            throw log::LogError(log.source, 0, 0, std::string("there is no column ") + name + ", so its frames cannot be replayed",
                                "replay a log that `traction simulate` or the on-board log wrote whole");
    if (const log::Signal *samples = log.find("frame.radar_samples"); samples != nullptr && log.find("radar.adc_count") == nullptr)
        if (std::any_of(samples->value.begin(), samples->value.end(), [](double count) { return count > 0; }))
            throw log::LogError(log.source, 0, 0, "there is no column radar.adc_count, and its frames had samples of the radar",
                                "give the file that has them with --radar");
    const log::Signal &clock = *log.find("frame.present");
    Columns columns(log);
    std::vector<LoggedTick> ticks;
    ticks.reserve(clock.t_s.size());
    const auto stated = log.header.find("radar.sample_rate_Hz");
    const double rate = stated != log.header.end() ? std::strtod(stated->second.c_str(), nullptr) : 0;
    for (const double t_s : clock.t_s) ticks.push_back(read_tick(columns, t_s, rate > 0 ? rate : 512));
    return ticks;
}

std::string frames_text(const std::vector<LoggedTick> &ticks) {
    std::string text;
    text.reserve(ticks.size() * 220);
    char line[FRAMES_LINE];
    for (const auto &[frame, command] : ticks) text.append(line, frames_print(&frame, &command, line));
    return text;
}

control_config_t logged_config(const log::Log &log) {
    const auto firmware = log.header.find("firmware");
    control_config_t config;
    try {
        const parameters_t parameters = parameters_of_lines(log.header);
        control_config_build(&parameters.rover, &config);
    } catch (const std::invalid_argument &error) {
        throw log::LogError(log.source, 0, 0, error.what(), "replay it with the firmware that drove it");
    }
    if (firmware != log.header.end() && firmware->second == "paper") control_config_make_paper(&config);
    return config;
}

namespace {

// Compares every trace with what the log recorded of it.
class Compare : public Link {
  public:
    Compare(const log::Log &log, const replay_hal_t &replay) : log_(log), replay_(replay) {
        for (std::size_t i = 0; i < WHEEL_COUNT; ++i) {
            const std::string wheel = "wheel" + std::to_string(i) + '.';
            watch(
                wheel + "duty", [](const trace_t &t, std::size_t w) { return t.wheel[w].duty; }, i);
            watch(
                wheel + "slip", [](const trace_t &t, std::size_t w) { return t.wheel[w].slip; }, i);
            watch(
                wheel + "traction_N", [](const trace_t &t, std::size_t w) { return t.wheel[w].traction_N; }, i);
            watch(
                wheel + "set_speed_rad_s", [](const trace_t &t, std::size_t w) { return t.wheel[w].set_speed_rad_s; }, i);
        }
        watch("estimate.speed_m_s", [](const trace_t &t, std::size_t) { return t.speed_m_s; });
        watch("estimate.speed_std_m_s", [](const trace_t &t, std::size_t) { return t.speed_std_m_s; });
        watch("estimate.accel_bias_m_s2", [](const trace_t &t, std::size_t) { return t.accel_bias_m_s2; });
        watch("actuator.curvature_1_m", [](const trace_t &t, std::size_t) { return t.actuator.curvature_1_m; });
        watch("control.faults", [](const trace_t &t, std::size_t) { return static_cast<float>(t.faults); }); // 20 bits: exact
    }
    void command(const sensor_frame_t &, command_t &command) override { command = replay_.command; }
    void log(const sensor_frame_t &frame, const command_t &, const trace_t &trace) override {
        const double t_s = (frame.tick + 1.0) / 100;
        bool differs = false;
        for (Watched &w : watched_) {
            const double now = static_cast<double>(w.value(trace, w.wheel)), logged = w.column.at(t_s, now);
            if (std::fabs(now - logged) <= 5.1e-7) continue; // six decimals are kept: half of the last, and its own rounding
            if (result.differing == 0 && !differs) {
                result.first_s = t_s;
                result.first_signal = w.name;
                result.logged = logged;
                result.replayed = now;
            }
            differs = true;
        }
        ++result.ticks;
        if (differs) ++result.differing;
    }
    Comparison result;

  private:
    using Value = float (*)(const trace_t &, std::size_t);
    struct Watched {
        std::string name;
        Column column;
        Value value;
        std::size_t wheel;
    };
    void watch(const std::string &name, Value value, std::size_t wheel = 0) {
        watched_.push_back({name, Column(log_, name), value, wheel});
    }

    const log::Log &log_;
    const replay_hal_t &replay_;
    std::vector<Watched> watched_;
};

} // namespace

Comparison replay_log(const log::Log &log, const std::vector<LoggedTick> &ticks) {
    Source source{.ticks = ticks};
    replay_hal_t replay{};
    replay.source = &source;
    replay.next = next_tick;
    Compare compare(log, replay);
    run_loop(replay_hal(&replay), logged_config(log), compare);
    return compare.result;
}

} // namespace traction::replay
