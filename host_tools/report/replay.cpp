#include "replay.h"

#include "pack.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

namespace traction::report {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t window = 256; // of the firmware's spectrum

struct Rows {
    double t0_s = 0, dt_s = 0;
    std::size_t count = 0;
};

enum class Between { line, held };

// A silence: longer than half a second and than five of the signal's usual spacings. Across it nothing is known.
double longest_spacing_s(const log::Signal &signal) {
    std::vector<double> apart;
    for (std::size_t i = 1; i < signal.t_s.size(); ++i) apart.push_back(signal.t_s[i] - signal.t_s[i - 1]);
    if (apart.empty()) return 0.5;
    const auto middle = apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2);
    std::nth_element(apart.begin(), middle, apart.end());
    return std::fmax(0.5, 5 * *middle);
}

std::vector<double> at_rows(const log::Signal &signal, const Rows &rows, Between between) {
    const double longest_s = longest_spacing_s(signal);
    const std::vector<double> &t = signal.t_s, &v = signal.value;
    std::vector<double> out(rows.count, nothing);
    std::size_t next = 0; // first sample after the row
    for (std::size_t i = 0; i < rows.count; ++i) {
        const double t_s = rows.t0_s + static_cast<double>(i) * rows.dt_s;
        while (next < t.size() && t[next] <= t_s) ++next;
        const bool has_before = next > 0, has_after = next < t.size();
        if (has_before && has_after && t[next] - t[next - 1] <= longest_s) {
            const double share = between == Between::held ? 0 : (t_s - t[next - 1]) / (t[next] - t[next - 1]);
            out[i] = v[next - 1] + share * (v[next] - v[next - 1]);
        } else if (has_before && t_s - t[next - 1] <= longest_s)
            out[i] = v[next - 1]; // the end of what is there
        else if (has_after && t[next] - t_s <= longest_s)
            out[i] = v[next];
    }
    return out;
}

const log::Signal *found(const log::Log *log, const std::string &name) {
    const log::Signal *signal = log == nullptr ? nullptr : log->find(name);
    return signal == nullptr || signal->t_s.empty() ? nullptr : signal;
}

// An angle without jumps of a turn: some cameras write -pi..pi.
log::Signal unwrapped(const log::Signal &signal) {
    log::Signal out = signal;
    for (std::size_t i = 1; i < out.value.size(); ++i)
        out.value[i] = out.value[i - 1] + std::remainder(signal.value[i] - signal.value[i - 1], 2 * std::numbers::pi);
    return out;
}

// The way of the path as a heading, where none was recorded: it changes once the rover went on by 20 mm, several times a camera's noise.
log::Signal heading_of_path(const log::Signal &x, const log::Signal &y) {
    log::Signal out{.name = "path", .t_s = {}, .value = {}};
    std::size_t from = 0;
    for (std::size_t i = 0; i < std::min(x.value.size(), y.value.size()); ++i) {
        const double dx = x.value[i] - x.value[from], dy = y.value[i] - y.value[from];
        if (dx * dx + dy * dy < 0.02 * 0.02) continue;
        if (out.t_s.empty()) out.t_s.push_back(x.t_s[0]), out.value.push_back(std::atan2(dy, dx));
        out.t_s.push_back(x.t_s[i]), out.value.push_back(std::atan2(dy, dx));
        from = i;
    }
    if (out.t_s.empty()) out.t_s = {x.t_s[0]}, out.value = {0};
    return unwrapped(out);
}

double value_at(const log::Signal &signal, double t_s) {
    const auto after = std::lower_bound(signal.t_s.begin(), signal.t_s.end(), t_s);
    if (after == signal.t_s.end()) return signal.value.back();
    const auto i = static_cast<std::size_t>(after - signal.t_s.begin());
    if (i == 0) return signal.value[0];
    const double share = (t_s - signal.t_s[i - 1]) / (signal.t_s[i] - signal.t_s[i - 1]);
    return signal.value[i - 1] + share * (signal.value[i] - signal.value[i - 1]);
}

// Integral of a rate, trapezoids; across a silence it stands still.
log::Signal integral(const log::Signal &rate) {
    const double longest_s = longest_spacing_s(rate);
    log::Signal out{.name = rate.name, .t_s = rate.t_s, .value = std::vector<double>(rate.t_s.size(), 0)};
    for (std::size_t i = 1; i < rate.t_s.size(); ++i) {
        const double dt = rate.t_s[i] - rate.t_s[i - 1];
        out.value[i] = out.value[i - 1] + (dt <= longest_s ? 0.5 * dt * (rate.value[i] + rate.value[i - 1]) : 0);
    }
    return out;
}

struct Pose {
    std::string from; // "truth" or "camera"
    log::Signal x, y, yaw;
    bool own_heading = true;
};

std::optional<Pose> pose_of(const log::Log &log, const log::Log *truth) {
    for (const auto &[where, from] : {std::pair{truth, "truth"}, std::pair{&log, "truth"}, std::pair{&log, "camera"}}) {
        const std::string object = from;
        const log::Signal *x = found(where, object + ".x_m"), *y = found(where, object + ".y_m"), *yaw = found(where, object + ".yaw_rad");
        if (x == nullptr || y == nullptr || x->t_s.size() < 2) continue;
        return Pose{.from = object,
                    .x = *x,
                    .y = *y,
                    .yaw = yaw != nullptr ? unwrapped(*yaw) : heading_of_path(*x, *y),
                    .own_heading = yaw != nullptr};
    }
    return std::nullopt;
}

// Everything of the replay as it grows.
class Replay {
  public:
    Replay(const log::Log &log, const log::Log *truth, const Rows &rows) : log_(log), truth_(truth), rows_(rows) {}
    nlohmann::json channels = nlohmann::json::object();

    bool put(const std::string &name, const log::Signal *signal, Between between = Between::line) {
        if (signal == nullptr) return false;
        put(name, at_rows(*signal, rows_, between), signal->name);
        return true;
    }
    void put(const std::string &name, const std::vector<double> &values, const std::string &from) {
        nlohmann::json channel = packed(values);
        channel["from"] = from;
        channels[name] = std::move(channel);
    }
    const log::Signal *truth(const std::string &name) const {
        const log::Signal *signal = found(truth_, "truth." + name);
        return signal != nullptr ? signal : found(&log_, "truth." + name);
    }
    const log::Signal *measured(const std::string &name) const { return found(&log_, name); }
    // The truth's where it is known, else the log's.
    const log::Signal *best(const std::string &name) const { return truth(name) != nullptr ? truth(name) : measured(name); }

    void put_body() {
        for (const char *name : {"z_m", "roll_rad", "pitch_rad", "joint_rad"}) put(name, truth(name));
        put("speed_m_s", truth("speed_m_s"));
        put("estimate_m_s", measured("estimate.speed_m_s"));
        put("radar_m_s", measured("radar.speed_m_s"), Between::held);
    }
    void put_wheel(std::size_t i, int number); // the drawn rover's wheel i, by its number in the log
    void put_ghost(const Pose &pose, nlohmann::json &notes);

  private:
    const log::Log &log_;
    const log::Log *truth_;
    Rows rows_;
};

void Replay::put_wheel(std::size_t i, int number) {
    const std::string name = "wheel" + std::to_string(number) + '.', as = "wheel" + std::to_string(i) + '.';
    if (const log::Signal *slip = measured(name + "slip")) {
        std::vector<double> values = at_rows(*slip, rows_, Between::line);
        if (const log::Signal *valid = measured(name + "slip_valid")) {
            const std::vector<double> told = at_rows(*valid, rows_, Between::held);
            for (std::size_t k = 0; k < values.size(); ++k)
                if (!(told[k] >= 0.5)) values[k] = nothing;
        }
        put(as + "slip", values, slip->name);
    } else
        put(as + "slip", truth(name + "slip"));
    if (const log::Signal *angle = measured(name + "angle_rad"))
        put(as + "turn_rad", angle);
    else if (const log::Signal *speed = best(name + "speed_rad_s")) {
        const log::Signal turned = integral(*speed);
        put(as + "turn_rad", &turned);
    }
    put(as + "traction_N", best(name + "traction_N"));
    put(as + "normal_N", best(name + "normal_N"));
    if (!put(as + "lateral_N", truth(name + "lateral_N"))) put(as + "lateral_N", measured(name + "side_force_N"));
    put(as + "sinkage_m", best(name + "sinkage_m"));
    put(as + "current_A", measured(name + "current_A"));
}

// The firmware's ground speed, integrated along the gyro's heading from the first pose on: what a rover without a camera would believe.
void Replay::put_ghost(const Pose &pose, nlohmann::json &notes) {
    const log::Signal *speed = measured("estimate.speed_m_s"), *rate = measured("imu.gyro_z_rad_s");
    if (speed == nullptr || speed->t_s.size() < 2) return;
    const double begin_s = std::fmax(speed->t_s.front(), pose.x.t_s.front());
    log::Signal heading = pose.yaw;
    if (rate != nullptr) {
        heading = integral(*rate);
        const double offset = value_at(pose.yaw, begin_s) - value_at(heading, begin_s);
        for (double &value : heading.value) value += offset;
    }
    log::Signal x{.name = "estimate.speed_m_s", .t_s = {begin_s}, .value = {value_at(pose.x, begin_s)}}, y = x;
    y.value[0] = value_at(pose.y, begin_s);
    double last = value_at(*speed, begin_s);
    const double longest_s = longest_spacing_s(*speed);
    for (std::size_t i = 0; i < speed->t_s.size(); ++i) {
        const double dt = speed->t_s[i] - x.t_s.back(), mean = 0.5 * (last + speed->value[i]);
        if (dt <= 0) continue;
        const double yaw = value_at(heading, speed->t_s[i] - 0.5 * dt), step = dt <= longest_s ? mean * dt : 0;
        x.value.push_back(x.value.back() + step * std::cos(yaw)), y.value.push_back(y.value.back() + step * std::sin(yaw));
        x.t_s.push_back(speed->t_s[i]), y.t_s.push_back(speed->t_s[i]);
        last = speed->value[i];
    }
    put("ghost.x_m", &x);
    put("ghost.y_m", &y);
    put("ghost.yaw_rad", &heading);
    notes.push_back(std::string("Ghost: the firmware's speed (estimate.speed_m_s), added up along the heading of ") +
                    (rate != nullptr ? "the gyro (imu.gyro_z_rad_s)" : "the pose, since the log has no gyro") +
                    ", from the first pose on.");
}

int number_of(const RoverShape &rover, std::size_t i) { return rover.wheel[i].number >= 0 ? rover.wheel[i].number : static_cast<int>(i); }

// The radar's samples in stretches without a hole: { t0_s, from (index in the data), n }; of a long log, windows of 256 spread evenly.
nlohmann::json radar_of(const log::Signal &signal, std::size_t most, double Hz_per_m_s) {
    if (signal.t_s.size() < window) return nullptr;
    std::vector<double> apart;
    for (std::size_t i = 1; i < signal.t_s.size(); ++i) apart.push_back(signal.t_s[i] - signal.t_s[i - 1]);
    const double mean_s = (signal.t_s.back() - signal.t_s.front()) / static_cast<double>(apart.size());
    std::nth_element(apart.begin(), apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2), apart.end());
    const double middle_s = apart[apart.size() / 2];
    const double period_s =
        std::fabs(mean_s / middle_s - 1) < 0.02 ? mean_s : middle_s; // the mean, unless there are holes: times are rounded
    const std::size_t stride = std::max(window, (signal.t_s.size() * window + most - 1) / most);
    std::vector<double> kept;
    nlohmann::json stretches = nlohmann::json::array();
    for (std::size_t begin = 0; begin < signal.t_s.size();) {
        std::size_t end = begin + 1;
        while (end < signal.t_s.size() && signal.t_s[end] - signal.t_s[end - 1] < 1.5 * period_s) ++end;
        const std::size_t part = stride == window ? end - begin : window;
        for (std::size_t from = begin; from + window <= end; from += stride == window ? part : stride) {
            stretches.push_back({signal.t_s[from], kept.size(), part});
            kept.insert(kept.end(), signal.value.begin() + static_cast<std::ptrdiff_t>(from),
                        signal.value.begin() + static_cast<std::ptrdiff_t>(from + part));
        }
        begin = end;
    }
    if (kept.empty()) return nullptr;
    nlohmann::json out = packed(kept);
    out["rate_Hz"] = 1 / period_s;
    out["every_s"] = stride == window ? 0 : static_cast<double>(stride) * period_s; // between windows where only some were kept
    out["stretches"] = std::move(stretches);
    out["Hz_per_m_s"] = Hz_per_m_s > 0 ? nlohmann::json(Hz_per_m_s) : nlohmann::json(nullptr);
    return out;
}

nlohmann::json shape_json(const RoverShape &rover) {
    nlohmann::json wheels = nlohmann::json::array();
    for (std::size_t i = 0; i < rover.wheel.size(); ++i) {
        const RoverShape::Wheel &wheel = rover.wheel[i];
        wheels.push_back({{"x_m", wheel.x_m},
                          {"y_m", wheel.y_m},
                          {"radius_m", wheel.radius_m},
                          {"width_m", wheel.width_m},
                          {"number", number_of(rover, i)}});
    }
    return {{"name", rover.name},       {"mass_kg", rover.mass_kg},   {"length_m", rover.length_m},
            {"width_m", rover.width_m}, {"height_m", rover.height_m}, {"halves", rover.halves},
            {"wheel", wheels}};
}

// Wheels that turn in the log: one more than the highest number.
std::size_t wheels_of(const log::Log &log) {
    std::size_t count = 0;
    for (const log::Signal &signal : log.signals)
        if (signal.name.rfind("wheel", 0) == 0 && signal.name.find('.') < 8 && !signal.t_s.empty())
            count = std::max(count, static_cast<std::size_t>(std::atoi(signal.name.c_str() + 5)) + 1);
    return count;
}

} // namespace

nlohmann::json replay_of(const log::Log &log, const log::Log *truth, const RoverShape &rover, const ReplayLimits &limits) {
    const std::optional<Pose> pose = pose_of(log, truth);
    if (!pose) return nullptr;
    Rows rows{.t0_s = pose->x.t_s.front()};
    const double span_s = pose->x.t_s.back() - rows.t0_s;
    rows.dt_s = std::fmax(limits.row_s, span_s / static_cast<double>(limits.rows - 1));
    rows.count = static_cast<std::size_t>(std::floor(span_s / rows.dt_s + 1e-9)) + 1;
    nlohmann::json notes = nlohmann::json::array();
    notes.push_back(pose->from == "truth" ? "Pose: the truth, as the simulator has it."
                                          : "Pose: the camera's; between its pictures a straight line.");
    if (!pose->own_heading) notes.push_back("Heading: the way of the path, since the log has none; a rover that drives back looks turned.");
    Replay replay(log, truth, rows);
    replay.put("x_m", &pose->x);
    replay.put("y_m", &pose->y);
    replay.put("yaw_rad", &pose->yaw);
    replay.put_body();
    for (std::size_t i = 0; i < rover.wheel.size(); ++i) replay.put_wheel(i, number_of(rover, i));
    replay.put_ghost(*pose, notes);
    if (!replay.channels.contains("z_m")) notes.push_back("Height: not in the log, so the ground is drawn level.");
    std::size_t known = 0; // one more than the highest number
    for (std::size_t i = 0; i < rover.wheel.size(); ++i) known = std::max(known, static_cast<std::size_t>(number_of(rover, i)) + 1);
    if (const std::size_t there = wheels_of(log); there > known)
        notes.push_back("The log has " + std::to_string(there) + " wheels, the rover that is drawn (" + rover.name + ") " +
                        std::to_string(rover.wheel.size()) + ": `traction report --rover` takes the right one.");
    const log::Signal *echo = found(&log, "radar.adc_count");
    return {{"t0_s", rows.t0_s},
            {"dt_s", rows.dt_s},
            {"rows", rows.count},
            {"pose_from", pose->from},
            {"rover", shape_json(rover)},
            {"channels", std::move(replay.channels)},
            {"radar", echo == nullptr ? nlohmann::json(nullptr) : radar_of(*echo, limits.radar_samples, rover.Hz_per_m_s)},
            {"notes", std::move(notes)}};
}

} // namespace traction::report
