#include "simulate.h"

#include "frames.h"
#include "header.h"
#include "recorder.h"

#include "hal/sim/fault_hal.h"
#include "hal/sim/sim_hal.h"
#include "host_tools/rover/rover.h"

#include <chrono>
#include <cstring>
#include <memory>
#include <thread>

namespace traction {

namespace {

command_t command_of(const sim::Demand &demand) {
    command_t command{};
    switch (demand.mode) {
    case sim::DriveMode::stop:
        command.mode = MODE_STOP;
        break;
    case sim::DriveMode::open_loop:
        command.mode = MODE_OPEN_LOOP;
        break;
    case sim::DriveMode::wheel_speed:
        command.mode = MODE_WHEEL_SPEED;
        break;
    case sim::DriveMode::platform_speed:
        command.mode = MODE_PLATFORM_SPEED;
        break;
    case sim::DriveMode::slip:
        command.mode = MODE_SLIP;
        break;
    case sim::DriveMode::soil_sweep:
        command.mode = MODE_SOIL_SWEEP;
        break;
    }
    command.platform_speed_m_s = static_cast<float>(demand.speed_m_s);
    command.yaw_rate_rad_s = static_cast<float>(demand.yaw_rate_rad_s);
    command.slip_ref = static_cast<float>(demand.slip);
    for (std::size_t i = 0; i < WHEEL_COUNT; i++) {
        command.wheel_speed_rad_s[i] = static_cast<float>(demand.wheel_speed_rad_s[i]);
        command.duty[i] = static_cast<float>(demand.duty[i]);
        if (demand.slip_wheel[i]) command.slip_wheels = static_cast<std::uint8_t>(command.slip_wheels | 1u << i);
    }
    return command;
}

// The operator: the drive plan, and what the link loses of it.
class Operator {
  public:
    explicit Operator(const sim::Scenario &scenario) : scenario_(scenario) {}
    const command_t &command_at(double t_s) {
        bool lost = false;
        for (const auto &[from_s, to_s] : scenario_.command_losses) lost = lost || (t_s >= from_s && t_s < to_s);
        if (lost) {
            last_.age_ticks++;
        } else {
            last_ = command_of(sim::demand_at(scenario_.drive, t_s));
        }
        return last_;
    }

  private:
    const sim::Scenario &scenario_;
    command_t last_{};
};

// Camera faults: the camera is no device of the rover, so no HAL carries it.
class CameraFaults {
  public:
    CameraFaults(const sim::Scenario &scenario, std::uint64_t seed) : random_(seed, "camera.faults") {
        for (const sim::SensorFault &fault : scenario.sensor_faults)
            if (fault.sensor == sim::FaultySensor::camera) faults_.push_back(fault);
    }
    void apply(std::span<const sim::Pose> in, std::vector<sim::Pose> &out) {
        out.clear();
        for (sim::Pose pose : in) {
            past_.push_back(pose);
            bool dropped = false;
            for (const sim::SensorFault &fault : faults_) {
                if (pose.t_s < fault.from_s || pose.t_s >= fault.to_s) continue;
                if (fault.kind == sim::FaultKind::dropped) dropped = true;
                if (fault.kind == sim::FaultKind::stuck) pose = at(fault.from_s, pose.t_s);
                if (fault.kind == sim::FaultKind::delayed) pose = at(pose.t_s - fault.amount, pose.t_s);
                if (fault.kind == sim::FaultKind::noisy) {
                    pose.x_m += fault.amount * random_.normal();
                    pose.y_m += fault.amount * random_.normal();
                }
            }
            if (!dropped) out.push_back(pose);
        }
    }

  private:
    // the last pose taken not after t_s, stamped now_s
    sim::Pose at(double t_s, double now_s) const {
        sim::Pose pose = past_.front();
        for (const sim::Pose &candidate : past_)
            if (candidate.t_s <= t_s) pose = candidate;
        pose.t_s = now_s;
        return pose;
    }
    std::vector<sim::SensorFault> faults_;
    std::vector<sim::Pose> past_;
    sim::Random random_;
};

std::uint64_t mix_trace(std::uint64_t hash, const trace_t &trace) {
    const auto mix = [&hash](float value) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 0x100000001b3u;
    };
    for (const wheel_trace_t &wheel : trace.wheel) {
        mix(wheel.speed_rad_s);
        mix(wheel.current_A);
        mix(wheel.duty);
        mix(wheel.slip);
    }
    mix(trace.speed_m_s);
    mix(trace.accel_x_m_s2);
    mix(trace.radar_speed_m_s);
    return hash;
}

hal::SimHalConfig world_of(const sim::Scenario &scenario, const std::vector<sim::ActiveEffect> &effects, std::uint64_t seed) {
    hal::SimHalConfig world{.plant = scenario.plant,
                            .sensors = scenario.sensors,
                            .scale = count_scale(scenario.rover),
                            .wheel_blocks = {},
                            .actuation_delay_s = 0,
                            .ticks = static_cast<std::uint32_t>(scenario.duration_s * 100 + 0.5),
                            .seed = seed};
    world.plant.effects = effects;
    const std::vector<sim::ActiveEffect> wheels = sim::wheel_differences(scenario.rover);
    world.plant.effects.insert(world.plant.effects.end(), wheels.begin(), wheels.end());
    world.plant.ground.seed = scenario.ground_seed.value_or(sim::mix64(seed));
    sim::apply_sensor_effects(effects, world.sensors);
    for (const sim::ActiveEffect &active : effects)
        if (active.effect->name == "actuation_delay") world.actuation_delay_s += active.value("delay_s");
    for (const sim::WheelBlockSpan &block : scenario.wheel_blocks) world.wheel_blocks.push_back({block.wheel, block.from_s, block.to_s});
    return world;
}

} // namespace

SimulationResult simulate(const sim::Scenario &scenario, const SimulateOptions &options) {
    SimulationResult result;
    const std::uint64_t seed = options.seed.value_or(scenario.seed);
    std::vector<sim::ActiveEffect> effects = scenario.effects;
    effects.insert(effects.end(), options.effects.begin(), options.effects.end());
    if (const auto &hide = options.hide ? options.hide : scenario.hidden) {
        result.hidden = sim::draw_effects(*hide);
        result.hide_seed = hide->seed;
        effects.insert(effects.end(), result.hidden.begin(), result.hidden.end());
    }

    const hal::SimHalConfig config = world_of(scenario, effects, seed);
    hal::SimHal world(config);
    hal::FaultHal faulty(world.hal(), {.sensors = scenario.sensor_faults, .emergency_stop_s = scenario.emergency_stops}, config.scale,
                         seed);
    const bool wrapped = !scenario.sensor_faults.empty() || !scenario.emergency_stops.empty();
    const hal_t hal = wrapped ? faulty.hal() : world.hal();

    const control_config_t firmware = firmware_of(scenario, options.firmware.value_or(""));
    const auto state = std::make_unique<control_state_t>();
    control_reset(&firmware, state.get());
    Operator person(scenario);
    CameraFaults camera_faults(scenario, seed);
    std::vector<sim::Pose> poses;
    Recorder recorder(options.record ? config.ticks : 0);
    TruthRecorder truth;
    std::unique_ptr<FrameWriter> frames;
    if (!options.frames_path.empty())
        frames = std::make_unique<FrameWriter>(options.frames_path, options.firmware.value_or(scenario.firmware.config));

    const auto start = std::chrono::steady_clock::now();
    result.trace_hash = 0xcbf29ce484222325u;
    while (hal.wait_tick(hal.context) == HAL_OK) {
        sensor_frame_t frame{};
        if (hal.read(hal.context, &frame) < 0) break;
        const command_t &command = person.command_at(frame.tick / 100.0);
        const trace_t trace = control_step(&firmware, state.get(), &command, &frame);
        if (hal.write(hal.context, &trace.actuator) < 0) break;
        result.ticks++;
        result.faults |= trace.faults;
        result.trace_hash = mix_trace(result.trace_hash, trace);
        if (options.record) {
            camera_faults.apply(world.camera(), poses);
            recorder.add(frame, command, trace);
            recorder.add_camera(poses);
        }
        if (options.truth) truth.add(world.truth());
        if (frames) frames->add(frame, command);
        if (options.after_second && result.ticks % 100 == 0) options.after_second();
        if (options.realtime)
            std::this_thread::sleep_until(start + std::chrono::milliseconds(10) * static_cast<std::int64_t>(result.ticks));
    }
    hal.safe_stop(hal.context);

    if (options.record) result.log = recorder.take();
    if (options.truth) result.truth = truth.take();
    if (frames) frames->keep();
    write_header(scenario, seed, result.log);
    if (options.truth) result.truth.header = {{"scenario", scenario.name}, {"seed", std::to_string(seed)}};
    return result;
}

} // namespace traction
