#include "generator.h"

#include "drive_plan.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace traction::generator {

namespace {

constexpr double h_s = 1e-3, tick_s = 0.01, g_m_s2 = 9.81;
constexpr double current_noise_A = 0.015, current_step_A = 0.002, accel_noise = 0.2, accel_bias_sd = 0.05, gyro_noise = 0.01;
constexpr double battery_noise_V = 0.01, radar_relative = 0.07, radar_floor_m_s = 0.005, radar_window_s = 0.5, radar_every_s = 0.125;
constexpr double camera_noise_m = 0.001, camera_noise_rad = 0.004, camera_hz = 7;
constexpr double counts_per_turn = 6000;

// Turns the world into the columns of a log.
class Recorder {
  public:
    Recorder(const GeneratorConfig &config, const Hidden &hidden, Random noise)
        : c_(config), h_(hidden), noise_(noise), scale_(config.quiet ? 0 : 1), accel_offset_(scale_ * accel_bias_sd * noise_.normal()),
          gyro_offset_(scale_ * 0.003 * noise_.normal()) {
        for (int k = 0; k < 5; ++k) radar_parts_.push_back(noise_.normal());
    }

    // every 1 ms
    void watch(const World &world) {
        for (std::size_t i = 0; i < wheels; ++i) current_sum_[i] += world.wheel[i].current;
        accel_sum_ += world.specific_force;
        battery_sum_ += world.battery;
        for (int k = 0; k < wheels; ++k) seen_[at(k)] += h_s * world.motor_speed(k) * (1 - h_.missed[at(k)]);
        leaned_ += h_s / 0.1 * (world.accel - leaned_);
        ++samples_;
        radar_.push_back(std::fabs(world.v()) * (1 + h_.radar_scale + h_.radar_pitch * world.accel));
        if (radar_.size() > static_cast<std::size_t>(radar_window_s / h_s)) radar_.pop_front();
        past_.push_back({world.x, world.y, world.yaw});
        if (past_.size() > 501) past_.pop_front();
    }

    PerWheel tick(const World &world) { // every 10 ms; returns the encoder speeds
        const double n = samples_;
        PerWheel speed{};
        for (std::size_t i = 0; i < wheels; ++i) {
            const double count = c_.quiet ? seen_[i] * counts_per_turn / (2 * std::numbers::pi)
                                          : std::floor(seen_[i] * counts_per_turn / (2 * std::numbers::pi));
            speed[i] = (count - count_[i]) * 2 * std::numbers::pi / counts_per_turn / tick_s;
            count_[i] = count;
            put(wheel_name(i, "encoder_count"), world.t, count);
            const double I =
                current_sum_[i] / n * (1 + h_.current_gain[i]) + h_.current_offset[i] + scale_ * current_noise_A * noise_.normal();
            put(wheel_name(i, "current_A"), world.t, c_.quiet ? I : current_step_A * std::round(I / current_step_A));
            current_sum_[i] = 0;
        }
        const double tilt = g_m_s2 * h_.accel_tilt * leaned_;
        put("imu.accel_x_m_s2", world.t,
            accel_sum_ / n * (1 + h_.accel_scale) + h_.accel_bias + h_.accel_drift * world.t + tilt + accel_offset_ +
                scale_ * accel_noise * noise_.normal());
        put("imu.gyro_z_rad_s", world.t, world.yaw_rate() + gyro_offset_ + scale_ * gyro_noise * noise_.normal());
        battery_now_ = battery_sum_ / n * (1 + h_.voltage_gain) + scale_ * battery_noise_V * noise_.normal();
        if (c_.battery) put("battery.voltage_V", world.t, battery_now_);
        accel_sum_ = battery_sum_ = 0;
        samples_ = 0;
        if (c_.radar) radar(world);
        if (c_.camera) camera(world);
        return speed;
    }

    void commands(double t, const PerWheel &duty, const PerWheel &set) {
        for (std::size_t i = 0; i < wheels; ++i) {
            put(wheel_name(i, "duty"), t, duty[i]);
            put(wheel_name(i, "set_speed_rad_s"), t, set[i]);
        }
    }

    void truth(const World &world) {
        put("truth.speed_m_s", world.t, world.v());
        put("truth.x_m", world.t, world.x);
        for (std::size_t i = 0; i < wheels; ++i) put("truth." + wheel_name(i, "traction_N"), world.t, world.wheel[i].force);
    }

    double battery_V() const { return battery_now_; }
    std::vector<log::Signal> take() { return std::move(signals_); }

  private:
    struct Pose {
        double x, y, yaw;
    };
    static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
    static std::string wheel_name(std::size_t i, const char *what) { return "wheel" + std::to_string(i) + "." + what; }

    void put(const std::string &name, double t, double value) {
        const auto found = std::find_if(signals_.begin(), signals_.end(), [&](const log::Signal &s) { return s.name == name; });
        log::Signal &signal = found == signals_.end() ? signals_.emplace_back() : *found;
        if (signal.name.empty()) signal.name = name;
        signal.t_s.push_back(std::round(t * 1e6) / 1e6);
        signal.value.push_back(std::round(value * 1e8) / 1e8);
    }

    void radar(const World &world) {
        if (world.t + 1e-9 < next_radar_ || radar_.size() < static_cast<std::size_t>(radar_window_s / h_s)) return;
        next_radar_ = world.t + radar_every_s;
        radar_parts_.pop_front(); // windows overlap by three quarters, and so does their noise
        radar_parts_.push_back(noise_.normal());
        double mean = 0, wobble = 0;
        for (double v : radar_) mean += v;
        mean /= static_cast<double>(radar_.size());
        for (std::size_t k = 1; k < 5; ++k) wobble += radar_parts_[k] / 2;
        if (mean < 0.05) return; // below the band-pass of 3 Hz
        put("radar.speed_m_s", world.t, std::max(0.0, mean + scale_ * std::hypot(radar_relative * mean, radar_floor_m_s) * wobble));
    }

    void camera(const World &world) {
        if (world.t + 1e-9 < next_camera_) return;
        next_camera_ += 1 / camera_hz;
        const auto late = std::min(past_.size() - 1, static_cast<std::size_t>(std::lround(h_.camera_delay / h_s)));
        const Pose &pose = past_[past_.size() - 1 - late];
        put("camera.x_m", world.t, pose.x * (1 + h_.camera_scale) + scale_ * camera_noise_m * noise_.normal());
        put("camera.y_m", world.t, pose.y * (1 + h_.camera_scale) + scale_ * camera_noise_m * noise_.normal());
        put("camera.yaw_rad", world.t, pose.yaw + scale_ * camera_noise_rad * noise_.normal());
    }

    const GeneratorConfig &c_;
    const Hidden &h_;
    Random noise_;
    double scale_, accel_offset_, gyro_offset_, accel_sum_ = 0, battery_sum_ = 0, battery_now_ = 7.2, leaned_ = 0, samples_ = 0;
    double next_radar_ = 0, next_camera_ = 0;
    PerWheel current_sum_{}, seen_{}, count_{};
    std::deque<double> radar_, radar_parts_;
    std::deque<Pose> past_;
    std::vector<log::Signal> signals_;
};

std::string number(double value) {
    std::string text = std::to_string(value);
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text;
}

void write_header(const GeneratorConfig &config, log::Log &log) {
    auto &header = log.header;
    header["scenario"] = "identification drive on " + name_of(config.soil); // never what is hidden
    header["soil"] = name_of(config.soil);
    header["seed"] = std::to_string(config.seed);
    header["generator"] = "independent planar rover";
    for (int i = 0; i < wheels; ++i) header["noise.wheel" + std::to_string(i) + ".current_A"] = number(current_noise_A);
    header["noise.imu.accel_x_m_s2"] = number(accel_noise);
    header["bias.imu.accel_x_m_s2"] = number(accel_bias_sd);
    header["noise.imu.gyro_z_rad_s"] = number(gyro_noise);
    header["noise.battery.voltage_V"] = number(battery_noise_V);
    header["noise.radar.speed_m_s"] = number(radar_floor_m_s);
    header["noise.radar.speed_m_s.relative"] = number(radar_relative);
    header["noise.camera.x_m"] = header["noise.camera.y_m"] = number(camera_noise_m);
    header["noise.camera.yaw_rad"] = number(camera_noise_rad);
    header["window.radar.speed_m_s"] = number(radar_window_s); // a value is the mean of the window that ends at its time
    header["window.wheel.current_A"] = number(tick_s);         // likewise: current is averaged over the control period
    header["window.imu.accel_x_m_s2"] = number(tick_s);
    header["counts_per_turn"] = number(counts_per_turn);
    header["ground.grip_noise"] = config.soil == Soil::concrete ? "0.02" : "0.06";
}

} // namespace

std::string name_of(Soil soil) { return soil == Soil::sand ? "sand" : soil == Soil::gravel ? "gravel" : "concrete"; }

Soil soil_of(const std::string &name) {
    for (const Soil soil : {Soil::sand, Soil::gravel, Soil::concrete})
        if (name_of(soil) == name) return soil;
    throw std::invalid_argument("unknown soil \"" + name + "\"; use sand, gravel or concrete");
}

Machine machine_of(const GeneratorConfig &config) {
    Random random(config.seed, 11);
    Machine machine = config.exact ? nominal(config.soil) : draw(config.soil, random);
    if (config.exact) machine.grip_noise = 0;
    if (config.apart && !config.exact) {
        Random wheel_random(config.seed, 15); // a stream of its own: the rest of the machine stays as it was
        draw_apart(machine, WheelSpread(), wheel_random);
    }
    return machine;
}

log::Log generate(const GeneratorConfig &config) {
    Hidden hidden;
    for (const Setting &setting : config.hidden) apply(setting, hidden);
    Random ground(config.seed, 12), plan_random(config.seed, 13);
    const Machine machine = machine_of(config);
    World world(machine, hidden, ground);
    const Machine believed = nominal(config.soil); // the operator knows the data sheet
    Driver driver(make_plan(config.drive, config.duration_s, plan_random), believed.radius, believed.half_track);
    Recorder recorder(config, hidden, Random(config.seed + 1000003 * config.noise_seed, 14));

    PerWheel duty{}, speed{};
    double estimate = 0;
    const long ticks = std::lround(config.duration_s / tick_s);
    for (long tick = 0; tick < ticks; ++tick) {
        duty = driver.command(world.t, speed, estimate, recorder.battery_V());
        recorder.commands(world.t, duty, driver.set_speed()); // takes effect from this row's time to the next
        for (int sub = 0; sub < 10; ++sub) {
            world.step(duty);
            recorder.watch(world);
        }
        speed = recorder.tick(world);
        estimate += 0.05 * (world.v() - estimate); // a slow outside estimate of ground speed, 0.2 s
        if (!std::isfinite(world.v())) throw std::runtime_error("the generator's world diverged");
        if (config.truth) recorder.truth(world);
    }
    log::Log log;
    log.signals = recorder.take();
    log.source = "generator";
    write_header(config, log);
    return log;
}

namespace {

Setting draw_setting(bool outside, Random &random, const std::string &not_this) {
    std::vector<const Kind *> pool;
    for (const Kind &kind : kinds())
        if (kind.outside == outside && kind.name != not_this) pool.push_back(&kind);
    const Kind &kind = *pool[static_cast<std::size_t>(random.below(static_cast<int>(pool.size())))];
    Setting setting;
    setting.name = kind.name;
    if (kind.per_wheel() && random.uniform() < 0.5) setting.wheel = random.below(wheels);
    for (const KindParameter &parameter : kind.parameters) {
        double value = 0;
        if (parameter.strength)
            value = random.log_uniform(parameter.low, parameter.high) * (parameter.either_sign ? random.sign() : 1.0);
        else
            value = parameter.choices[static_cast<std::size_t>(random.below(static_cast<int>(parameter.choices.size())))];
        setting.values.emplace_back(parameter.name, value);
    }
    return setting;
}

} // namespace

BlindCase draw_case(std::uint64_t seed, double duration_s) {
    Random random(seed, 21);
    BlindCase blind;
    blind.config.seed = seed;
    blind.config.duration_s = duration_s;
    const double soil = random.uniform();
    blind.config.soil = soil < 0.45 ? Soil::sand : soil < 0.65 ? Soil::gravel : Soil::concrete;
    const double category = random.uniform(); // the mixture of docs/evidence.md section 5: clean 15 %, one 55 %, two 15 %, outside 15 %
    if (category < 0.15)
        blind.category = "clean";
    else if (category < 0.70)
        blind.category = "one";
    else if (category < 0.85)
        blind.category = "two";
    else
        blind.category = "outside";
    if (blind.category != "clean") blind.config.hidden.push_back(draw_setting(blind.category == "outside", random, ""));
    if (blind.category == "two") blind.config.hidden.push_back(draw_setting(false, random, blind.config.hidden.front().name));
    return blind;
}

} // namespace traction::generator
