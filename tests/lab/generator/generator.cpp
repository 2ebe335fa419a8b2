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

constexpr double h_s = 1e-3, g_m_s2 = 9.81;
constexpr double accel_noise = 0.2, accel_bias_sd = 0.05, gyro_noise = 0.01;
constexpr double battery_noise_V = 0.01, radar_relative = 0.07, radar_floor_m_s = 0.005, radar_window_s = 0.5, radar_every_s = 0.125;
constexpr double camera_noise_m = 0.001, camera_noise_rad = 0.004, camera_hz = 7;

double frame_of_antenna(std::uint64_t seed) { return 1 + static_cast<double>(seed % 5); } // [rad] from where the rover begins
constexpr double counts_per_turn = 6000;

// Turns the world into the columns of a log.
class Recorder {
  public:
    Recorder(const GeneratorConfig &config, const Machine &machine, const Hidden &hidden, Random noise)
        : c_(config), m_(machine), h_(hidden), noise_(noise), scale_(config.quiet ? 0 : config.habits.noise),
          accel_offset_((config.quiet ? 0 : 1) * accel_bias_sd * noise_.normal()),
          gyro_offset_((config.quiet ? 0 : 1) * 0.003 * noise_.normal()) {
        for (int k = 0; k < 5; ++k) radar_parts_.push_back(noise_.normal());
    }

    // every 1 ms
    void watch(const World &world) {
        PerWheel current{};
        for (std::size_t i = 0; i < wheels; ++i) current[i] = world.wheel[i].current;
        current_now_ = aged(currents_, current, h_.current_delay);
        yaw_rate_now_ = aged(yaw_rates_, world.yaw_rate(), h_.gyro_delay);
        for (std::size_t i = 0; i < wheels; ++i) current_sum_[i] += current_now_[i];
        accel_sum_ += felt(world.specific_force - h_.accel_ahead * world.yaw_rate() * world.yaw_rate() -
                           h_.accel_left * (world.yaw_rate() - yaw_rate_before_) / h_s);
        yaw_rate_before_ = world.yaw_rate();
        battery_sum_ += world.battery;
        for (int k = 0; k < wheels; ++k) seen_[at(k)] += h_s * world.motor_speed(k) * (1 - h_.missed[at(k)]);
        leaned_ += h_s / 0.1 * (world.accel - leaned_);
        ++samples_;
        radar_.push_back(aged(speeds_, std::fabs(world.v()) * (1 + h_.radar_scale + h_.radar_pitch * world.accel), h_.radar_delay));
        if (radar_.size() > static_cast<std::size_t>(radar_window_s / h_s)) radar_.pop_front();
        past_.push_back({world.x, world.y, world.yaw});
        if (past_.size() > 501) past_.pop_front();
    }

    PerWheel tick(const World &world, double length_s) { // at the end of every tick; returns the encoder speeds
        const double n = samples_;
        stamp_ = c_.chain.jitter_s > 0 ? std::max(stamp_ + 1e-3, world.t + 0.2 * c_.chain.jitter_s * noise_.normal()) : world.t;
        PerWheel speed{};
        for (std::size_t i = 0; i < wheels; ++i) {
            const double count = c_.quiet ? seen_[i] * counts_per_turn / (2 * std::numbers::pi)
                                          : std::floor(seen_[i] * counts_per_turn / (2 * std::numbers::pi));
            speed[i] = (count - count_[i]) * 2 * std::numbers::pi / counts_per_turn / length_s;
            count_[i] = count;
            if (c_.chain.angle_only)
                put(wheel_name(i, "angle_rad"), stamp_, count * 2 * std::numbers::pi / counts_per_turn);
            else
                put(wheel_name(i, "encoder_count"), stamp_, count);
            const double mean = c_.chain.current_at_end ? current_now_[i] : current_sum_[i] / n;
            const double I = mean * (1 + h_.current_gain[i] + h_.gain_drift[i] * world.t / 120) + h_.current_offset[i] +
                             scale_ * m_.current_noise_A * noise_.normal();
            put(wheel_name(i, "current_A"), stamp_, c_.quiet ? I : m_.current_step_A * std::round(I / m_.current_step_A));
            current_sum_[i] = 0;
        }
        const double tilt = g_m_s2 * h_.accel_tilt * leaned_;
        const double felt = accel_sum_ / n * (1 + h_.accel_scale) + h_.accel_bias + h_.accel_drift * world.t + tilt + accel_offset_ +
                            scale_ * accel_noise * noise_.normal();
        if (c_.habits.accel) put("imu.accel_x_m_s2", stamp_, felt);
        const double turned = yaw_rate_now_ * (1 + h_.gyro_scale) + gyro_offset_ + scale_ * gyro_noise * noise_.normal();
        if (c_.habits.gyro) put("imu.gyro_z_rad_s", stamp_, turned);
        battery_now_ = battery_sum_ / n * (1 + h_.voltage_gain) + scale_ * battery_noise_V * noise_.normal();
        if (c_.battery) put("battery.voltage_V", stamp_, battery_now_);
        accel_sum_ = battery_sum_ = 0;
        samples_ = 0;
        if (c_.radar) radar(world);
        if (c_.camera) camera(world);
        return speed;
    }

    void commands(const PerWheel &duty, const PerWheel &set) {
        for (std::size_t i = 0; i < wheels; ++i) {
            put(wheel_name(i, "duty"), stamp_, duty[i]);
            put(wheel_name(i, "set_speed_rad_s"), stamp_, set[i]);
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
    // What the accelerometer's own filter and its way to the log leave of the specific force.
    double felt(double force) {
        if (c_.chain.accel_cutoff_Hz > 0)
            filtered_ += (1 - std::exp(-2 * std::numbers::pi * c_.chain.accel_cutoff_Hz * h_s)) * (force - filtered_), force = filtered_;
        if (h_.accel_lag > 0) smoothed_ += h_s / (h_.accel_lag + h_s) * (force - smoothed_), force = smoothed_;
        return aged(waiting_, force, c_.chain.accel_late_s + h_.accel_delay);
    }
    // What it was `late_s` ago.
    template <typename T> static T aged(std::deque<T> &past, const T &now, double late_s) {
        if (!(late_s > 0)) return now;
        past.push_back(now);
        if (past.size() > static_cast<std::size_t>(std::lround(late_s / h_s)) + 1) past.pop_front();
        return past.front();
    }
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
        put("radar.speed_m_s", stamp_, std::max(0.0, mean + scale_ * std::hypot(radar_relative * mean, radar_floor_m_s) * wobble));
    }

    void camera(const World &world) {
        if (world.t + 1e-9 < next_camera_) return;
        next_camera_ += 1 / camera_hz;
        const auto late = std::min(past_.size() - 1, static_cast<std::size_t>(std::lround(h_.camera_delay / h_s)));
        const Pose &pose = past_[past_.size() - 1 - late];
        const double x = pose.x * (1 + h_.camera_scale) + scale_ * camera_noise_m * noise_.normal();
        const double y = pose.y * (1 + h_.camera_scale) + scale_ * camera_noise_m * noise_.normal();
        const double frame_rad = c_.habits.heading ? 0 : frame_of_antenna(c_.seed), c = std::cos(frame_rad), s = std::sin(frame_rad);
        put("camera.x_m", stamp_, c * x - s * y);
        put("camera.y_m", stamp_, s * x + c * y);
        const double yaw = pose.yaw + scale_ * camera_noise_rad * noise_.normal();
        if (c_.habits.heading) put("camera.yaw_rad", stamp_, yaw);
    }

    const GeneratorConfig &c_;
    const Machine &m_;
    const Hidden &h_;
    Random noise_;
    double scale_, accel_offset_, gyro_offset_, accel_sum_ = 0, battery_sum_ = 0, battery_now_ = 7.2, leaned_ = 0, samples_ = 0;
    double next_radar_ = 0, next_camera_ = 0;
    PerWheel current_sum_{}, seen_{}, count_{};
    double stamp_ = 0, filtered_ = 0, smoothed_ = 0; // time that the log writes; states of the accelerometer's filters
    double yaw_rate_now_ = 0, yaw_rate_before_ = 0;
    PerWheel current_now_{};
    std::deque<double> radar_, radar_parts_, waiting_, speeds_, yaw_rates_;
    std::deque<PerWheel> currents_;
    std::deque<Pose> past_;
    std::vector<log::Signal> signals_;
};

std::string number(double value) {
    std::string text = std::to_string(value);
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text;
}

void write_header(const GeneratorConfig &config, const Machine &machine, log::Log &log) {
    auto &header = log.header;
    header["scenario"] = "identification drive on " + name_of(config.soil); // never what is hidden
    header["soil"] = name_of(config.soil);
    header["seed"] = std::to_string(config.seed);
    header["generator"] = "independent planar rover";
    for (int i = 0; i < wheels; ++i) header["noise.wheel" + std::to_string(i) + ".current_A"] = number(machine.current_noise_A);
    header["noise.imu.accel_x_m_s2"] = number(accel_noise);
    header["bias.imu.accel_x_m_s2"] = number(accel_bias_sd);
    header["noise.imu.gyro_z_rad_s"] = number(gyro_noise);
    header["noise.battery.voltage_V"] = number(battery_noise_V);
    header["noise.radar.speed_m_s"] = number(radar_floor_m_s);
    header["noise.radar.speed_m_s.relative"] = number(radar_relative);
    header["noise.camera.x_m"] = header["noise.camera.y_m"] = number(camera_noise_m);
    header["noise.camera.yaw_rad"] = number(camera_noise_rad);
    header["window.radar.speed_m_s"] = number(radar_window_s); // a value is the mean of the window that ends at its time
    if (!config.chain.current_at_end)
        header["window.wheel.current_A"] = number(config.habits.tick_s); // likewise: averaged over the control period
    header["window.imu.accel_x_m_s2"] = number(config.habits.tick_s);
    header["counts_per_turn"] = number(counts_per_turn);
    if (config.chain.angle_only)
        for (int i = 0; i < wheels; ++i)
            header["quantum.wheel" + std::to_string(i) + ".angle_rad"] = number(2 * std::numbers::pi / counts_per_turn);
    header["ground.grip_noise"] = config.soil == Soil::concrete                              ? "0.02"
                                  : config.soil == Soil::sand || config.soil == Soil::gravel ? "0.06"
                                                                                             : "0.05";
}

} // namespace

std::string name_of(Soil soil) {
    constexpr const char *names[] = {"sand", "gravel", "concrete", "loam", "snow"};
    return names[static_cast<std::size_t>(soil)];
}

Soil soil_of(const std::string &name) {
    for (const Soil soil : {Soil::sand, Soil::gravel, Soil::concrete, Soil::loam, Soil::snow})
        if (name_of(soil) == name) return soil;
    throw std::invalid_argument("unknown soil \"" + name + "\"; use sand, gravel, concrete, loam or snow");
}

std::string name_of(Size size) { return size == Size::small ? "small" : size == Size::medium ? "medium" : "large"; }

Size size_of(const std::string &name) {
    for (const Size size : {Size::small, Size::medium, Size::large})
        if (name_of(size) == name) return size;
    throw std::invalid_argument("unknown size \"" + name + "\"; use small, medium or large");
}

Machine machine_of(const GeneratorConfig &config) {
    Random random(config.seed, 11);
    Machine machine = config.exact ? nominal(config.soil, config.size) : draw(config.soil, random, config.size);
    if (config.exact) machine.grip_noise = 0;
    if (config.apart && !config.exact) {
        Random wheel_random(config.seed, 15); // a stream of its own: the rest of the machine stays as it was
        draw_apart(machine, WheelSpread(), wheel_random);
    }
    return machine;
}

namespace {

// Switched on while the machine drives: its clock begins there, its counters do not.
void begin_at(double begin_s, log::Log &log) {
    for (log::Signal &s : log.signals) {
        const auto from = std::lower_bound(s.t_s.begin(), s.t_s.end(), begin_s) - s.t_s.begin();
        s.t_s.erase(s.t_s.begin(), s.t_s.begin() + from);
        s.value.erase(s.value.begin(), s.value.begin() + from);
        for (double &t : s.t_s) t = std::round((t - begin_s) * 1e6) / 1e6;
    }
    std::erase_if(log.signals, [](const log::Signal &s) { return s.t_s.empty(); });
}

} // namespace

log::Log generate(const GeneratorConfig &config) {
    Hidden hidden;
    for (const Setting &setting : config.hidden) apply(setting, hidden);
    const std::uint64_t place = config.seed + 7000003ULL * static_cast<std::uint64_t>(config.run); // run 0: the seed itself
    Random ground(place, 12), plan_random(place, 13), clock(place, 16);
    const double tick_s = config.habits.tick_s;
    Machine machine = machine_of(config);
    machine.knee = config.knee;
    machine.battery_ohm *= config.habits.soft;
    if (config.habits.sag > 0) machine.battery_sag_1_s = config.habits.sag / config.duration_s;
    World world(machine, hidden, ground);
    const Machine believed = nominal(config.soil, config.size); // the operator knows the data sheet
    const Machine first = nominal(config.soil);
    const auto pull = [](const Machine &m) { return m.J * m.Ra / (m.KG * m.battery_V); }; // duty for a given wheel acceleration
    LoopTune tune;
    tune.back_emf_Vs_rad = believed.ke;
    tune.duty_per_rad_s *= pull(believed) / pull(first);
    tune.duty_per_rad *= pull(believed) / pull(first);
    const double faster = std::sqrt(believed.radius / first.radius);
    Driver driver(make_plan(config.drive, config.duration_s, plan_random, faster), believed.radius, believed.half_track, tune, tick_s);
    Recorder recorder(config, machine, hidden, Random(place + 1000003 * config.noise_seed, 14));

    PerWheel duty{}, speed{};
    double estimate = 0;
    const long ticks = std::lround(config.duration_s / tick_s);
    for (long tick = 0; tick < ticks; ++tick) {
        duty = driver.command(world.t, speed, estimate, recorder.battery_V());
        recorder.commands(duty, driver.set_speed()); // takes effect from this row's time to the next
        const int late = config.chain.jitter_s > 0 ? static_cast<int>(std::lround(config.chain.jitter_s / h_s * clock.normal())) : 0;
        const int ms = static_cast<int>(std::lround(tick_s / h_s)), steps = std::clamp(ms + late, 6 * ms / 10, 14 * ms / 10);
        for (int sub = 0; sub < steps; ++sub) {
            world.step(duty);
            recorder.watch(world);
        }
        speed = recorder.tick(world, late == 0 ? tick_s : steps * h_s);
        estimate += tick_s / 0.2 * (world.v() - estimate); // a slow outside estimate of ground speed, 0.2 s
        if (!std::isfinite(world.v())) throw std::runtime_error("the generator's world diverged");
        if (config.truth) recorder.truth(world);
    }
    log::Log log;
    log.signals = recorder.take();
    if (config.habits.begin_s > 0) begin_at(config.habits.begin_s, log);
    log.source = "generator";
    write_header(config, machine, log);
    return log;
}

namespace {

// The first sets know neither the newer kinds nor single wheels outside the catalogue: their draws stay as they were.
Setting draw_setting(bool outside, Random &random, const std::string &not_this, Sets sets = Sets::all, Size size = Size::small) {
    std::vector<const Kind *> pool;
    for (const Kind &kind : kinds())
        if (kind.outside == outside && kind.name != not_this && kind.drawn <= sets) pool.push_back(&kind);
    const Kind &kind = *pool[static_cast<std::size_t>(random.below(static_cast<int>(pool.size())))];
    Setting setting;
    setting.name = kind.name;
    if (kind.per_wheel() && (sets != Sets::all || !outside) && random.uniform() < 0.5) setting.wheel = random.below(wheels);
    for (const KindParameter &parameter : kind.parameters) {
        double value = 0;
        if (parameter.strength)
            value = random.log_uniform(parameter.low, parameter.high) * (parameter.either_sign ? random.sign() : 1.0);
        else
            value = parameter.choices[static_cast<std::size_t>(random.below(static_cast<int>(parameter.choices.size())))];
        setting.values.emplace_back(parameter.name, value * scale_of(parameter.name, size));
    }
    return setting;
}

} // namespace

BlindCase draw_case(std::uint64_t seed, double duration_s, const std::string &wanted) {
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
    if (!wanted.empty()) blind.category = wanted;
    if (blind.category != "clean") blind.config.hidden.push_back(draw_setting(blind.category == "outside", random, ""));
    if (blind.category == "two") blind.config.hidden.push_back(draw_setting(false, random, blind.config.hidden.front().name));
    return blind;
}

namespace {

BlindCase draw_machine(std::uint64_t seed, const std::string &category, Sets sets) {
    Random random(seed, 31);
    BlindCase blind;
    GeneratorConfig &config = blind.config;
    config.seed = seed;
    config.apart = true;
    const double size = random.uniform(), soil = random.uniform(), drive = random.uniform(), what = random.uniform();
    config.size = size < 0.4 ? Size::small : size < 0.7 ? Size::medium : Size::large;
    config.soil = soil < 0.3 ? Soil::sand : soil < 0.5 ? Soil::gravel : soil < 0.8 ? Soil::concrete : soil < 0.9 ? Soil::loam : Soil::snow;
    config.drive = drive < 0.35   ? "full"
                   : drive < 0.65 ? "mixed"
                   : drive < 0.8  ? "stop_and_go"
                   : drive < 0.88 ? "curves"
                   : drive < 0.94 ? "slopes"
                                  : "slow";
    config.duration_s = std::round(random.log_uniform(60, 300));
    if (random.uniform() < 0.5) { // the second chain, or parts of it
        SensorChain &chain = config.chain;
        if (random.uniform() < 0.5) chain.accel_cutoff_Hz = random.log_uniform(8, 25), chain.accel_late_s = random.uniform(0.005, 0.03);
        chain.current_at_end = random.uniform() < 0.5;
        chain.angle_only = random.uniform() < 0.5;
        if (random.uniform() < 0.5) chain.jitter_s = random.log_uniform(3e-4, 1.5e-3);
        chain.foreign = random.uniform() < 0.5;
    }
    config.camera = random.uniform() < 0.8;
    config.radar = !config.camera || random.uniform() < 0.8;
    const std::string drawn = what < 0.15 ? "clean" : what < 0.65 ? "one" : what < 0.8 ? "two" : "outside";
    blind.category = category.empty() ? drawn : category;
    if (blind.category == "clean") return blind;
    config.hidden.push_back(draw_setting(blind.category == "outside", random, "", sets, config.size));
    if (config.drive == "slopes" && blind.category == "two" && config.hidden.front().name != "grade")
        config.hidden.push_back({"grade", -1, {{"slope_rad", random.sign() * random.log_uniform(0.02, 0.12)}, {"direction_rad", 0}}});
    else if (blind.category == "two")
        config.hidden.push_back(draw_setting(false, random, config.hidden.front().name, sets, config.size));
    return blind;
}

} // namespace

BlindCase draw_fleet_case(std::uint64_t seed, const std::string &category) { return draw_machine(seed, category, Sets::fleet); }

BlindCase draw_bent_case(std::uint64_t seed, const std::string &category) {
    BlindCase blind = draw_machine(seed, category, Sets::bent);
    blind.config.knee = static_cast<Knee>(1 + Random(seed, 43).below(3));
    return blind;
}

BlindCase draw_strange_case(std::uint64_t seed, const std::string &category) {
    BlindCase blind = draw_fleet_case(seed, category);
    Random random(seed, 41);
    GeneratorConfig &config = blind.config;
    Habits &habits = config.habits;
    if (random.uniform() < 0.6) {
        static const char *const plans[] = {"spins", "halt", "shuttle", "stairs", "sweep", "cruise"};
        config.drive = plans[random.below(6)];
    }
    habits.tick_s = 1e-3 * (5 << random.below(3));
    const double noise[] = {0.5, 1, 2};
    habits.noise = noise[random.below(3)];
    if (random.uniform() < 0.3) habits.begin_s = random.uniform(3, 20);
    if (random.uniform() < 0.3) habits.sag = random.uniform(0.05, 0.2);
    if (random.uniform() < 0.3) habits.soft = random.uniform(2, 5);
    habits.gyro = random.uniform() > 0.15, habits.accel = random.uniform() > 0.15;
    config.battery = random.uniform() > 0.15;
    if (random.uniform() < 0.15) config.camera = config.radar = false;
    return blind;
}

} // namespace traction::generator
