#include "simulate.h"

#include "frames.h"
#include "header.h"
#include "recorder.h"

#include "hal/pace/pace_hal.h"
#include "hal/sim/plan_operator.h"
#include "hal/sim/sim_rover.h"
#include "host_tools/loop/loop.h"
#include "host_tools/rover/rover.h"

#include <cstring>
#include <filesystem>
#include <memory>
#include <span>
#include <system_error>

namespace traction {

namespace {

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

// What a run leaves behind: the drive plan asks, every tick is recorded.
class Session : public Link {
  public:
    Session(const sim::Scenario &scenario, const SimulateOptions &options, const hal::SimHal &world, std::uint64_t seed,
            std::uint64_t expected_ticks)
        : options_(options), world_(world), person_(scenario), camera_faults_(scenario, seed),
          recorder_(options.record ? expected_ticks : 0, scenario.sensors.radar.rate_Hz, options.log_path,
                    sim::firmware_wheels(believed(scenario).layout()), options.radar_path),
          truth_(options.truth_path, !scenario.plant.ground.terrain.flat(), scenario.plant.rover.layout) {
        if (!options.frames_path.empty())
            frames_ = std::make_unique<FrameWriter>(options.frames_path, options.firmware.value_or(scenario.firmware.config));
    }
    // What the logs' headers will say, for what a killed run leaves.
    void begin(const SimulationResult &result) {
        recorder_.begin(result.log.header);
        truth_.begin(result.truth.header);
    }
    bool over() override { return interrupted_ = interrupted_ || (options_.stopped && options_.stopped()); }
    void command(const sensor_frame_t &frame, command_t &command) override { command = person_.command_at(frame.tick); }
    void log(const sensor_frame_t &frame, const command_t &command, const trace_t &trace) override {
        hash_ = mix_trace(hash_, trace);
        if (records()) {
            camera_faults_.apply(world_.camera(), poses_);
            recorder_.add(frame, command, trace);
            recorder_.add_camera(poses_);
        } else if (!options_.radar_path.empty()) {
            recorder_.add_radar(frame);
        }
        recorder_.tick_is_over();
        if (options_.truth || !options_.truth_path.empty()) truth_.add(world_.truth());
        if (frames_) frames_->add(frame, command);
        if (options_.after_tick) options_.after_tick(trace);
        if (++ticks_ % 100 != 0) return;
        if (options_.realtime) { // a chunk fills slowly
            recorder_.put_by();
            truth_.put_by();
        }
        if (options_.after_second) options_.after_second();
    }
    // What was recorded goes into the result, or under its path; the headers stand in result already.
    void take(SimulationResult &result) {
        result.trace_hash = hash_;
        result.interrupted = interrupted_;
        for (log::Log *log : {&result.log, &result.truth})
            if (interrupted_) log->header["ended"] = "interrupted";
        if (!options_.radar_path.empty()) {
            if (!stays(options_.radar_path, recorder_, &Recorder::radar_part, result)) recorder_.write_radar(result.log.header);
        }
        if (!options_.log_path.empty()) {
            if (!stays(options_.log_path, recorder_, &Recorder::part, result)) recorder_.write(result.log.header);
        } else if (options_.record) {
            result.log.signals = recorder_.take().signals;
        }
        if (!options_.truth_path.empty()) {
            if (!stays(options_.truth_path, truth_, &TruthRecorder::part, result)) truth_.write(result.truth.header);
        } else if (options_.truth) {
            result.truth.signals = truth_.take().signals;
        }
        if (frames_ && !stands(options_.frames_path)) frames_->keep();
    }

  private:
    // A file is there, and this run is no whole one.
    bool stands(const std::string &path) const {
        std::error_code none;
        return interrupted_ && std::filesystem::is_regular_file(path, none);
    }
    // An interrupted run takes no other's place: where a file stands it stays, and what the run had is kept as its part.
    template <typename Of>
    bool stays(const std::string &path, Of &recorder, const std::string &(Of::*part)() const, SimulationResult &result) const {
        if (!stands(path)) return false;
        recorder.put_by();
        if (const std::string &name = (recorder.*part)(); !name.empty()) result.parts.emplace_back(name, path);
        return true;
    }
    bool records() const { return options_.record || !options_.log_path.empty(); }
    const SimulateOptions &options_;
    const hal::SimHal &world_;
    hal::PlanOperator person_;
    CameraFaults camera_faults_;
    std::vector<sim::Pose> poses_;
    Recorder recorder_;
    TruthRecorder truth_;
    std::unique_ptr<FrameWriter> frames_;
    std::uint64_t hash_ = 0xcbf29ce484222325u, ticks_ = 0;
    bool interrupted_ = false;
};

} // namespace

SimulationResult simulate(const sim::Scenario &scenario, const SimulateOptions &options) {
    SimulationResult result;
    const std::uint64_t seed = options.seed.value_or(scenario.seed);
    std::vector<sim::ActiveEffect> effects = scenario.effects;
    effects.insert(effects.end(), options.effects.begin(), options.effects.end());
    if (const auto &hide = options.hide ? options.hide : scenario.hidden) {
        if (!sim::is_plain(scenario.rover.layout()))
            throw sim::ScenarioError(
                scenario.file, 0, "--hide", "",
                "effects are hidden in rovers of four wheels alone, on a plain chassis, with a motor each and fixed in their heading",
                "leave it out");
        result.hidden = sim::draw_effects(*hide);
        result.hide_seed = hide->seed;
        effects.insert(effects.end(), result.hidden.begin(), result.hidden.end());
    }

    const hal::SimHalConfig config = hal::world_of(scenario, effects, seed);
    hal::SimRover rover(scenario, effects, config);
    Session session(scenario, options, rover.world(), seed, config.ticks);
    write_header(scenario, seed, result.log);
    if (options.truth || !options.truth_path.empty()) result.truth.header = {{"scenario", scenario.name}, {"seed", std::to_string(seed)}};
    session.begin(result);
    pace_hal_t pace{};
    const hal_t world = rover.hal();
    const daemon_result_t run =
        run_loop(options.realtime ? pace_hal(&pace, &world) : world, firmware_of(scenario, options.firmware.value_or("")), session,
                 {.self_test = options.self_test, .warm = options.warm, .rise_K = nullptr, .rise_out_K = nullptr});
    result.ended_by = run.ended_by;
    result.ticks = run.ticks;
    result.faults = run.faults;
    result.self_test = run.self_test;
    session.take(result);
    return result;
}

} // namespace traction
