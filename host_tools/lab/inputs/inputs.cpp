#include "inputs.h"

#include "follow_motion.h"
#include "smooth.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <utility>

namespace traction::lab {

namespace {

constexpr double plain_step_s = 0.02;
constexpr double most_step_loss = 0.06; // second-order differences with steps h lose (omega h)^2 / 3 of a swing at omega: clean drives 1 to
                                        // 2 %, loops that swing 8 to 10 %
constexpr double longest_gap_s = 0.25;  // beyond it a wheel's speed is not known

} // namespace

double sample_period(const log::Signal &signal) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < signal.t_s.size(); ++i) steps.push_back(signal.t_s[i] - signal.t_s[i - 1]);
    return median(steps);
}

double parameter(const Parameters &table, const std::string &key) {
    const auto found = table.find(key);
    return found == table.end() ? 0.0 : found->second.value;
}

const log::Signal *InputBuilder::signal(const std::string &name) const {
    const log::Signal *found = log.find(name);
    return found != nullptr && found->t_s.size() >= 3 ? found : nullptr;
}

const log::Signal *InputBuilder::wheel_signal(std::size_t i, const std::string &quantity) const {
    return signal("wheel" + std::to_string(i) + "." + quantity);
}

double InputBuilder::header(const std::string &key) const {
    const auto found = log.header.find(key);
    return found == log.header.end() ? 0.0 : std::atof(found->second.c_str());
}

double InputBuilder::window_of(const log::Signal &s) const {
    const double own = header("window." + s.name);
    if (own > 0 || s.name.substr(0, 5) != "wheel") return own;
    return header("window.wheel" + s.name.substr(s.name.find('.')));
}

void InputBuilder::say(const std::string &text) { data.messages.push_back(text); }

void InputBuilder::header_of_log() {
    data.log_file = log.source.substr(log.source.find_last_of('/') + 1);
    data.duration_s = log.duration_s();
    if (const auto found = log.header.find("scenario"); found != log.header.end()) data.scenario = found->second;
    data.accel_bias_prior_m_s2 = header("bias.imu.accel_x_m_s2");
    if (const auto found = log.header.find("date"); found != log.header.end()) data.date = found->second;
}

const log::Signal *InputBuilder::motion_signal(std::size_t i, double &angle_scale) const {
    for (const std::size_t j : wheels_of_motor(model, model.motor_of(i)))
        if (const log::Signal *found = own_motion_signal(j, angle_scale)) return found;
    return nullptr;
}

const log::Signal *InputBuilder::own_motion_signal(std::size_t i, double &angle_scale) const {
    angle_scale = 0;
    if (const log::Signal *count = wheel_signal(i, "encoder_count")) {
        // an encoder that counts the other way says so in the header
        const auto sign = log.header.find("firmware.encoder_sign_" + std::to_string(i));
        angle_scale = 2 * std::numbers::pi / parameter(model.sensors, "encoder.counts_per_turn");
        if (sign != log.header.end() && sign->second == "-1") angle_scale = -angle_scale;
        return count;
    }
    if (const log::Signal *angle = wheel_signal(i, "angle_rad")) {
        angle_scale = 1;
        return angle;
    }
    return wheel_signal(i, "speed_rad_s");
}

double InputBuilder::top_speed_rad_s() const {
    double top = 0;
    for (std::size_t i = 0; i < model.wheel.size(); ++i) {
        double scale = 0;
        const log::Signal *s = motion_signal(i, scale);
        if (s == nullptr) continue;
        std::vector<double> speed;
        for (std::size_t a = 0, b = 0; b < s->t_s.size(); ++b) {
            if (scale == 0) {
                speed.push_back(std::fabs(s->value[b]));
                continue;
            }
            if (s->t_s[b] - s->t_s[a] < 0.1) continue;
            speed.push_back(std::fabs(scale * (s->value[b] - s->value[a]) / (s->t_s[b] - s->t_s[a])));
            a = b;
        }
        if (speed.empty()) continue;
        const auto at = speed.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(speed.size() - 1));
        std::nth_element(speed.begin(), at, speed.end());
        top = std::max(top, *at);
    }
    return top;
}

bool InputBuilder::grid_and_wheels() {
    double radius = 0;
    for (const WheelSpec &wheel : model.wheel) radius = std::max(radius, parameter(wheel.geometry, "radius_m"));
    const bool reverses_slowly = parameter(model.wheel.front().soil, "reversal_speed_m_s") > 0;
    if (const double top = top_speed_rad_s(); top > 0)
        data.standstill_rad_s = std::clamp(radius > 0 ? stands_m_s / radius : 0, standstill_share[0] * top,
                                           (reverses_slowly ? standstill_share_slow : standstill_share[1]) * top);
    const auto wheels = [this](double step_s) {
        data.wheel.assign(model.wheel.size(), {});
        if (!set_grid(step_s)) return false;
        wheels_motion();
        for (std::size_t i = 0; i < model.wheel.size(); ++i)
            if (model.wheel[i].drive < 0) turn_with_side(i);
        for (std::size_t i = 0; i < model.wheel.size(); ++i)
            if (model.wheel[i].drive >= 0) data.wheel[i] = data.wheel[model.motor_of(i)], data.wheel[i].turns_with = model.wheel[i].drive;
        return true;
    };
    const std::vector<std::string> said = data.messages;
    if (!wheels(plain_step_s)) return false;
    const double x = swing_rad_s() * data.step_s;
    if (data.independent_rows || !(x * x / 3 > most_step_loss)) return true;
    data.messages = said;
    return wheels(0.5 * plain_step_s);
}

double InputBuilder::swing_rad_s() const {
    constexpr double clear = 5; // standard deviations
    double jerk = 0, accel = 0;
    for (const WheelInput &w : data.wheel)
        for (std::size_t k = 1; k + 1 < w.accel_rad_s2.size(); ++k) {
            if (!(std::fabs(w.accel_rad_s2[k]) > clear * rounding_rad_s2)) continue;
            const double slope = (w.accel_rad_s2[k + 1] - w.accel_rad_s2[k - 1]) / (2 * data.step_s);
            jerk += slope * slope, accel += w.accel_rad_s2[k] * w.accel_rad_s2[k];
        }
    return accel > 0 ? std::sqrt(jerk / accel) : 0;
}

bool InputBuilder::set_grid(double step_s) {
    double first = -1e300, last = 1e300, period = 1e300;
    std::size_t longest = 0;
    bool any = false;
    for (std::size_t i = 0; i < model.wheel.size(); ++i) {
        double scale = 0;
        const log::Signal *s = motion_signal(i, scale);
        if (s == nullptr) continue;
        any = true;
        first = std::max(first, s->t_s.front());
        last = std::min(last, s->t_s.back());
        period = std::min(period, sample_period(*s));
        longest = std::max(longest, s->t_s.size());
    }
    if (!any || !(last > first)) {
        say("the log has no wheel speed (wheel<i>.encoder_count, wheel<i>.angle_rad or wheel<i>.speed_rad_s): nothing can be compared");
        return false;
    }
    data.independent_rows = model.motion == BodyMotion::imposed && period >= 0.5;
    data.start_s = first;
    data.step_s = data.independent_rows ? period : std::max(step_s, (last - first) / 30000);
    if (!data.independent_rows && data.step_s > step_s) {
        char text[160];
        std::snprintf(text, sizeof text, "the log is %.0f s long: the model is integrated in steps of %.0f ms, not %.0f ms", last - first,
                      1e3 * data.step_s, 1e3 * step_s);
        say(text);
    }
    data.count = static_cast<std::size_t>((last - first) / data.step_s + 1e-6) + 1;
    data.gap.assign(data.count, 0);
    return data.count >= 3;
}

void InputBuilder::wheel_motion(std::size_t i, Found &found) {
    WheelInput &input = data.wheel[i];
    double scale = 0;
    const log::Signal *s = motion_signal(i, scale);
    if (s == nullptr) {
        input.rolls_freely = !model.wheel[i].driven;
        say("wheel " + std::to_string(i) +
            (input.rolls_freely ? " has no motor and no speed in the log: taken to roll freely"
                                : " has no speed in the log: taken to turn as the others of its side, its balances are left out"));
        input.angle_rad.assign(data.count, 0);
        input.speed_rad_s = input.accel_rad_s2 = input.angle_rad;
        return;
    }
    log::Signal in_the_middle;
    if (const double back = 0.5 * window_of(*s); scale == 0 && back > 0) { // a mean over a window ending at its time
        in_the_middle = *s;
        for (double &t : in_the_middle.t_s) t -= back;
        s = &in_the_middle;
    }
    double half = data.independent_rows ? 0.1 * data.step_s : std::max(0.055, 2.6 * sample_period(*s));
    const double narrowest = half;
    data.smoothing_half_s = half;
    if (scale != 0) {
        std::vector<double> angle(s->value);
        for (double &a : angle) a *= scale;
        if (const double wide = std::min(std::max(half, widest_half_s), widen * half_width_for(s->t_s, angle, sample_period(*s), half,
                                                                                               data.standstill_rad_s, slope_noise));
            wide > 1.2 * half) {
            half = wide;
            scattering.push_back(s->name), widest_smoothing_s = std::max(widest_smoothing_s, half);
        }
        if (widen > 1) data.smoothing_half_s = half;
        const double count_rad = rounding_of(angle);
        input.scatter_rad = scatter_of(angle, count_rad), input.sample_s = sample_period(*s), input.half_s = half;
        const auto smoothed = [&](double width) {
            MotionAtWidth at;
            auto [parabola, cubic] = smooth_twice(s->t_s, angle, data.start_s, data.step_s, data.count, width);
            if (width == half) mark_gaps(parabola.distance_s, *s); // once: of any width they are the same
            at.parabolas.angle_rad = std::move(parabola.value), at.parabolas.speed_rad_s = std::move(parabola.slope);
            at.cubics.speed_rad_s = std::move(cubic.slope);
            slopes_of(at.parabolas), slopes_of(at.cubics);
            return at;
        };
        found.motion = motion_at_widths(input, narrowest, data.step_s, smoothed);
        found.noise_rad_s2 = rounding_noise(count_rad, input.sample_s, half);
        rounding_rad_s2 = std::max(rounding_rad_s2, found.noise_rad_s2);
    } else if (data.independent_rows) {
        for (std::size_t k = 0; k < data.count; ++k) input.speed_rad_s.push_back(interpolate(s->t_s, s->value, data.time(k)));
        input.angle_rad.assign(data.count, 0);
        input.accel_rad_s2.assign(data.count, 0);
    } else {
        auto [parabola, cubic] = smooth_twice(s->t_s, s->value, data.start_s, data.step_s, data.count, half);
        input.speed_rad_s = std::move(parabola.value);
        input.accel_rad_s2 = std::move(parabola.slope);
        mark_gaps(parabola.distance_s, *s);
        found.sharp.speed_rad_s = std::move(cubic.value), found.sharp.accel_rad_s2 = std::move(cubic.slope);
        input.angle_rad.assign(data.count, 0);
        for (std::size_t k = 1; k < data.count; ++k)
            input.angle_rad[k] = input.angle_rad[k - 1] + 0.5 * data.step_s * (input.speed_rad_s[k] + input.speed_rad_s[k - 1]);
    }
}

// Wheels of one side that roll the same way turn alike but for their slips: what blurs one of them blurs all.
std::vector<std::vector<std::size_t>> InputBuilder::sides() const {
    std::vector<std::vector<std::size_t>> out;
    const auto place = [&](std::size_t i) { return parameter(model.wheel[i].geometry, "y_m"); };
    const auto alike = [&](std::size_t i, std::size_t j) {
        return (place(i) > 0) == (place(j) > 0) && (place(i) < 0) == (place(j) < 0) &&
               std::fabs(parameter(model.wheel[i].geometry, "heading_rad") - parameter(model.wheel[j].geometry, "heading_rad")) < 1e-6;
    };
    for (std::size_t i = 0; i < model.wheel.size(); ++i) {
        if (model.wheel[i].drive >= 0) continue;
        const auto side = std::find_if(out.begin(), out.end(), [&](const auto &s) { return alike(s.front(), i); });
        if (side == out.end())
            out.push_back({i});
        else
            side->push_back(i);
    }
    return out;
}

void InputBuilder::wheels_motion() {
    std::vector<Found> found(model.wheel.size());
    for (std::size_t i = 0; i < model.wheel.size(); ++i)
        if (model.wheel[i].drive < 0) wheel_motion(i, found[i]);
    if (!scattering.empty()) {
        const std::size_t more = scattering.size() - 1;
        char text[240];
        std::snprintf(text, sizeof text, "%s%s scatter%s from sample to sample: the wheels' speeds are smoothed over up to +-%.2f s",
                      scattering.front().c_str(), more > 0 ? (" and " + std::to_string(more) + " more").c_str() : "", more > 0 ? "" : "s",
                      widest_smoothing_s);
        say(text);
    }
    for (const std::vector<std::size_t> &side : sides()) {
        std::vector<WheelInput *> inputs;
        for (const std::size_t i : side) inputs.push_back(&data.wheel[i]);
        agree_on_widths(inputs);
        std::vector<char> jumps(data.count, 0);
        for (const std::size_t i : side) {
            if (!found[i].motion.at.empty()) found[i].sharp = take_widths(data.wheel[i], std::move(found[i].motion)).cubics;
            if (!found[i].sharp.accel_rad_s2.empty()) add_jumps(data.wheel[i], found[i].sharp, found[i].noise_rad_s2, jumps);
        }
        for (const std::size_t i : side)
            if (!found[i].sharp.accel_rad_s2.empty()) follow_jumps(data.wheel[i], found[i].sharp, jumps);
    }
    for (std::size_t i = 0; i < model.wheel.size(); ++i)
        if (model.wheel[i].drive < 0) travel(data.wheel[i]);
}

void InputBuilder::turn_with_side(std::size_t i) {
    if (!model.wheel[i].driven || is_measured(i)) return;
    const auto left = [&](std::size_t j) { return parameter(model.wheel[j].geometry, "y_m") > 0; };
    for (const bool of_its_side : {true, false}) { // of its side none: as all
        std::vector<const WheelInput *> others;
        for (std::size_t j = 0; j < model.wheel.size(); ++j)
            if (model.wheel[j].driven && is_measured(j) && (!of_its_side || left(i) == left(j)))
                others.push_back(&data.wheel[model.motor_of(j)]);
        if (others.empty()) continue;
        WheelInput &input = data.wheel[i];
        for (std::vector<double> WheelInput::*series : {&WheelInput::angle_rad, &WheelInput::speed_rad_s, &WheelInput::accel_rad_s2}) {
            (input.*series).assign(data.count, 0);
            for (const WheelInput *other : others)
                for (std::size_t k = 0; k < data.count; ++k) (input.*series)[k] += (other->*series)[k] / static_cast<double>(others.size());
        }
        input.travel_rad.clear();
        return travel(input);
    }
}

bool InputBuilder::is_measured(std::size_t i) const {
    double scale = 0;
    return motion_signal(i, scale) != nullptr;
}

// One count of an encoder, as an angle: the least second difference. Of angles that are written with a few decimals there are smaller
// ones, many of them, and then none up to the count.
double InputBuilder::rounding_of(const std::vector<double> &angle) {
    constexpr double gap = 10;
    constexpr std::size_t many = 20;
    std::vector<double> step;
    for (std::size_t i = 2; i < angle.size(); ++i)
        if (const double s = std::fabs(angle[i] - 2 * angle[i - 1] + angle[i - 2]); s > 1e-9) step.push_back(s);
    std::sort(step.begin(), step.end());
    for (std::size_t i = many; i < step.size(); ++i)
        if (step[i] > gap * step[i - 1]) return step[i];
    return step.empty() ? 0 : step.front();
}

// Standard deviation of the samples of a wheel that turns: rounding at least, more where their times scatter.
double InputBuilder::scatter_of(const std::vector<double> &angle, double count) {
    std::vector<double> bend;
    for (std::size_t i = 2; i < angle.size(); ++i)
        if (std::fabs(angle[i] - angle[i - 2]) > 4 * count) bend.push_back(std::fabs(angle[i] - 2 * angle[i - 1] + angle[i - 2]));
    return std::max(count / std::sqrt(12.0), 1.4826 * median(std::move(bend)) / std::sqrt(6.0));
}

// What the rounding of an encoder leaves in the difference of two accelerations, by cubics and by parabolas [rad/s^2].
double InputBuilder::rounding_noise(double count, double period, double half) {
    constexpr double gain =
        165; // of white noise, by simulation: 167 at half = 55 ms and 165 at 80 ms of 10 ms samples, 140 at 110 ms of 20 ms samples
    return gain * count / std::sqrt(12.0) * std::sqrt(period) / std::pow(half, 1.5);
}

// Where cubics and parabolas differ by more than noise, the wheel jumps.
void InputBuilder::add_jumps(const WheelInput &input, const WheelInput &sharp, double least_noise, std::vector<char> &jumps) const {
    constexpr double jump = 5; // standard deviations
    constexpr double calm = 0.2,
                     quantile = 0.2533; // the difference's noise: from its calmest fifth while the wheel turns, whatever the rest does
    std::vector<double> size, moving;
    for (std::size_t k = 0; k < data.count; ++k) {
        size.push_back(std::fabs(sharp.accel_rad_s2[k] - input.accel_rad_s2[k]));
        if (std::fabs(input.speed_rad_s[k]) > data.standstill_rad_s) moving.push_back(size[k]);
    }
    if (moving.empty()) return;
    const auto place = moving.begin() + static_cast<std::ptrdiff_t>(calm * static_cast<double>(moving.size()));
    std::nth_element(moving.begin(), place, moving.end());
    const double limit = jump * std::max(least_noise, *place / quantile);
    const auto half_steps = static_cast<std::size_t>(std::lround(0.5 * data.smoothing_half_s / data.step_s));
    for (std::size_t k = 0; k < data.count; ++k) {
        if (!(size[k] > limit * (input.width_s.empty() ? 1 : std::pow(input.half_s / input.width_s[k], 1.5)))) continue;
        for (std::size_t j = k - std::min(k, half_steps); j <= std::min(data.count - 1, k + half_steps); ++j) jumps[j] = 1;
    }
}

// Where the side jumps, the speeds by cubics serve; their accelerations everywhere.
void InputBuilder::follow_jumps(WheelInput &input, const WheelInput &sharp, const std::vector<char> &jumps) const {
    const bool turns = std::any_of(input.speed_rad_s.begin(), input.speed_rad_s.end(),
                                   [&](double speed) { return std::fabs(speed) > data.standstill_rad_s; });
    if (!turns) return;
    input.plain_speed_rad_s = input.speed_rad_s;
    input.plain_accel_rad_s2 = std::exchange(input.accel_rad_s2, sharp.accel_rad_s2);
    for (std::size_t k = 0; k < data.count; ++k)
        if (jumps[k] != 0) input.speed_rad_s[k] = sharp.speed_rad_s[k];
}

void InputBuilder::travel(WheelInput &input) const {
    double from = input.angle_rad.empty() ? 0 : input.angle_rad[0], way = 0;
    for (std::size_t k = 0; k < input.angle_rad.size(); ++k) {
        const double w = input.speed_rad_s[k];
        if (std::fabs(w) > data.standstill_rad_s && w * way < 0) from = input.angle_rad[k];
        if (std::fabs(w) > data.standstill_rad_s) way = w;
        input.travel_rad.push_back(input.angle_rad[k] - from);
    }
}

void InputBuilder::slopes_of(WheelInput &input) const {
    std::vector<double> &dw = input.accel_rad_s2;
    const std::vector<double> &w = input.speed_rad_s;
    dw.assign(data.count, 0);
    const auto n = static_cast<std::ptrdiff_t>(data.count), half_steps = std::max<std::ptrdiff_t>(1, std::lround(0.02 / data.step_s));
    const auto over = [&](std::ptrdiff_t k, std::ptrdiff_t by) {
        const std::ptrdiff_t a = std::max<std::ptrdiff_t>(0, k - by), b = std::min(n - 1, k + by);
        return (w[static_cast<std::size_t>(b)] - w[static_cast<std::size_t>(a)]) / (static_cast<double>(b - a) * data.step_s);
    };
    for (std::ptrdiff_t k = 0; k < n; ++k)
        dw[static_cast<std::size_t>(k)] = (4 * over(k, half_steps) - over(k, 2 * half_steps)) / 3; // fourth order
}

void InputBuilder::mark_gaps(const std::vector<double> &distance_s, const log::Signal &s) {
    const double limit = std::max(longest_gap_s, 2.6 * sample_period(s));
    for (std::size_t k = 0; k < data.count; ++k)
        if (distance_s[k] > limit) data.gap[k] = 1;
}

void InputBuilder::voltages() {
    const log::Signal *battery = signal("battery.voltage_V");
    const double nominal_V = parameter(model.rover, "battery_voltage_V");
    if (battery != nullptr) { // a sample that is a mean over a window stands for its middle
        for (const double t : battery->t_s) data.supply_t_s.push_back(t - 0.5 * window_of(*battery));
        data.supply_V = battery->value;
    } else if (nominal_V > 0) {
        data.supply_t_s = {data.start_s}, data.supply_V = {nominal_V};
    }
    bool told = false;
    for (std::size_t i = 0; i < model.wheel.size(); ++i) {
        if (model.wheel[i].drive >= 0) continue; // one voltage a motor
        WheelInput &input = data.wheel[i];
        if (const log::Signal *voltage = wheel_signal(i, "voltage_V")) {
            for (std::size_t k = 0; k < data.count; ++k) input.voltage_V.push_back(interpolate(voltage->t_s, voltage->value, data.time(k)));
            input.voltage_t_s = voltage->t_s;
            input.voltage_integral_Vs.assign(1, 0);
            for (std::size_t j = 0; j + 1 < voltage->t_s.size(); ++j)
                input.voltage_integral_Vs.push_back(input.voltage_integral_Vs.back() + 0.5 * (voltage->value[j] + voltage->value[j + 1]) *
                                                                                           (voltage->t_s[j + 1] - voltage->t_s[j]));
        } else if (const log::Signal *duty = wheel_signal(i, "duty"); duty != nullptr && !data.supply_V.empty()) { // held from its time on
            for (std::size_t k = 0; k < data.count; ++k)
                input.voltage_V.push_back(hold(duty->t_s, duty->value, data.time(k)) *
                                          interpolate(data.supply_t_s, data.supply_V, data.time(k)));
            input.voltage_t_s = duty->t_s;
            input.duty = duty->value;
            input.voltage_integral_Vs = data.voltage_integral(input, 0);
        } else if (!told && model.wheel[i].driven) {
            say("no motor voltage (duty and battery.voltage_V, or wheel<i>.voltage_V): the voltage balance is left out");
            told = true;
        }
    }
}

void InputBuilder::yaw() {
    const log::Signal *gyro = signal("imu.gyro_z_rad_s"), *camera = signal("camera.yaw_rad");
    data.gyro = gyro != nullptr;
    if (gyro != nullptr) {
        const double half = std::max(0.03, 1.5 * sample_period(*gyro));
        data.yaw_rate_rad_s = smooth_at(gyro->t_s, gyro->value, data.start_s, data.step_s, data.count, half, 1).value;
        data.yaw_late = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil((half + bin_s) / data.step_s)));
    } else if (camera != nullptr) {
        data.yaw_rate_rad_s = smooth_at(camera->t_s, unwrapped(camera->value), data.start_s, data.step_s, data.count,
                                        std::max(0.35, 2.5 * sample_period(*camera)), 2)
                                  .slope;
    }
    double sides = 0; // half the distance between the wheels' tracks
    for (const WheelSpec &w : model.wheel) sides = std::max(sides, std::fabs(parameter(w.geometry, "y_m")));
    data.yaw_free = model.motion == BodyMotion::longitudinal && sides > 1e-3 && model.wheel.size() > 1;
    if (data.yaw_free && data.yaw_rate_rad_s.empty())
        say("no yaw rate (imu.gyro_z_rad_s or camera.yaw_rad): how the body turns follows from its wheels and the model's ground alone");
    data.camera_heading = camera != nullptr;
    if (camera != nullptr) {
        const std::vector<double> angle = unwrapped(camera->value);
        for (std::size_t k = 0; k < data.count; ++k) data.yaw_rad.push_back(interpolate(camera->t_s, angle, data.time(k)));
    } else if (!data.yaw_rate_rad_s.empty()) {
        double angle = 0;
        for (std::size_t k = 0; k < data.count; ++k) data.yaw_rad.push_back(angle += data.yaw_rate_rad_s[k] * data.step_s);
    }
}

std::vector<double> InputBuilder::unwrapped(std::vector<double> angle) {
    double turn = 0;
    for (std::size_t i = 1; i < angle.size(); ++i) {
        const double step = angle[i] + turn - angle[i - 1];
        if (std::fabs(step) > std::numbers::pi) turn -= 2 * std::numbers::pi * std::round(step / (2 * std::numbers::pi));
        angle[i] += turn;
    }
    return angle;
}

void InputBuilder::imposed_motion() {
    if (model.motion == BodyMotion::imposed) {
        if (const log::Signal *speed = signal("carriage.speed_m_s")) {
            for (std::size_t k = 0; k < data.count; ++k) data.body_speed_m_s.push_back(interpolate(speed->t_s, speed->value, data.time(k)));
        } else if (const log::Signal *slip = wheel_signal(0, "slip")) { // a bench that states slip instead
            const double radius = parameter(model.wheel[0].geometry, "radius_m");
            for (std::size_t k = 0; k < data.count; ++k) {
                const double s = interpolate(slip->t_s, slip->value, data.time(k)), rim = radius * data.wheel[0].speed_rad_s[k];
                data.body_speed_m_s.push_back(s >= 0 ? rim * (1 - s) : rim / std::max(1e-3, 1 + s));
            }
        } else {
            say("no carriage.speed_m_s (or wheel0.slip): the imposed speed is taken as zero");
        }
    }
    for (std::size_t i = 0; i < model.wheel.size(); ++i) {
        const log::Signal *load = wheel_signal(i, "normal_N");
        if (load == nullptr) continue;
        data.load_N.resize(model.wheel.size());
        for (std::size_t k = 0; k < data.count; ++k)
            data.load_N[i].push_back(std::max(0.0, interpolate(load->t_s, load->value, data.time(k))));
    }
}

} // namespace traction::lab
