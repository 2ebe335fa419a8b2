#include "dataset.h"

#include "smooth.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traction::lab {

namespace {

constexpr double bin_s = 0.05;         // rows of fast signals: keeps all below 10 Hz, assumed enough for a rover's physics
constexpr double longest_gap_s = 0.25; // beyond it a wheel's speed is not known
constexpr double standstill_rad_s = 0.15; // below it friction is indeterminate: the torque balance says nothing

double sample_period(const log::Signal &signal) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < signal.t_s.size(); ++i) steps.push_back(signal.t_s[i] - signal.t_s[i - 1]);
    return median(steps);
}

double parameter(const Parameters &table, const std::string &key) {
    const auto found = table.find(key);
    return found == table.end() ? 0.0 : found->second.value;
}

struct Builder {
    const Model &model;
    const log::Log &log;
    Dataset data;

    const log::Signal *signal(const std::string &name) const {
        const log::Signal *found = log.find(name);
        return found != nullptr && found->t_s.size() >= 3 ? found : nullptr;
    }
    const log::Signal *wheel_signal(std::size_t i, const std::string &quantity) const {
        return signal("wheel" + std::to_string(i) + "." + quantity);
    }
    double header(const std::string &key) const {
        const auto found = log.header.find(key);
        return found == log.header.end() ? 0.0 : std::atof(found->second.c_str());
    }
    // Header window.<signal>, or window.wheel.<quantity> for all wheels: a sample is the mean of the window that ends at its time.
    double window_of(const log::Signal &s) const {
        const double own = header("window." + s.name);
        if (own > 0 || s.name.substr(0, 5) != "wheel") return own;
        return header("window.wheel" + s.name.substr(s.name.find('.')));
    }
    void say(const std::string &text) { data.messages.push_back(text); }

    void header_of_log() {
        data.log_file = log.source.substr(log.source.find_last_of('/') + 1);
        data.duration_s = log.duration_s();
        if (const auto found = log.header.find("scenario"); found != log.header.end()) data.scenario = found->second;
        data.accel_bias_prior_m_s2 = header("bias.imu.accel_x_m_s2");
        if (const auto found = log.header.find("date"); found != log.header.end()) data.date = found->second;
    }

    // The signal that tells wheel i's motion best: counts, then angle, then speed.
    const log::Signal *motion_signal(std::size_t i, double &angle_scale) const {
        angle_scale = 0;
        if (const log::Signal *count = wheel_signal(i, "encoder_count")) {
            angle_scale = 2 * std::numbers::pi / parameter(model.sensors, "encoder.counts_per_turn");
            return count;
        }
        if (const log::Signal *angle = wheel_signal(i, "angle_rad")) {
            angle_scale = 1;
            return angle;
        }
        return wheel_signal(i, "speed_rad_s");
    }

    bool set_grid() {
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
        data.step_s = data.independent_rows ? period : std::max(0.02, (last - first) / 30000);
        data.count = static_cast<std::size_t>((last - first) / data.step_s + 1e-6) + 1;
        data.gap.assign(data.count, 0);
        return data.count >= 3;
    }

    void wheel_motion(std::size_t i) {
        WheelInput &input = data.wheel[i];
        double scale = 0;
        const log::Signal *s = motion_signal(i, scale);
        if (s == nullptr) {
            say("wheel " + std::to_string(i) + " has no speed in the log: taken as standing still, its balances are left out");
            input.angle_rad.assign(data.count, 0);
            input.speed_rad_s = input.accel_rad_s2 = input.angle_rad;
            return;
        }
        const double half = data.independent_rows ? 0.1 * data.step_s : std::max(0.055, 2.6 * sample_period(*s));
        if (scale > 0) {
            std::vector<double> angle(s->value);
            for (double &a : angle) a *= scale;
            Smooth smooth = smooth_at(s->t_s, angle, data.start_s, data.step_s, data.count, half, 2);
            input.angle_rad = std::move(smooth.value);
            input.speed_rad_s = std::move(smooth.slope);
            mark_gaps(smooth.distance_s, *s);
            slopes_of(input);
            WheelInput narrow;
            narrow.speed_rad_s = smooth_at(s->t_s, angle, data.start_s, data.step_s, data.count, 0.55 * half, 2).slope;
            slopes_of(narrow);
            for (std::size_t k = 0; k < data.count; ++k) input.jerk_rad_s2.push_back(narrow.accel_rad_s2[k] - input.accel_rad_s2[k]);
        } else if (data.independent_rows) {
            for (std::size_t k = 0; k < data.count; ++k) input.speed_rad_s.push_back(interpolate(s->t_s, s->value, data.time(k)));
            input.angle_rad.assign(data.count, 0);
            input.accel_rad_s2.assign(data.count, 0);
        } else {
            Smooth smooth = smooth_at(s->t_s, s->value, data.start_s, data.step_s, data.count, half, 2);
            input.speed_rad_s = std::move(smooth.value);
            input.accel_rad_s2 = std::move(smooth.slope);
            mark_gaps(smooth.distance_s, *s);
            const std::vector<double> narrow = smooth_at(s->t_s, s->value, data.start_s, data.step_s, data.count, 0.55 * half, 2).slope;
            for (std::size_t k = 0; k < data.count; ++k) input.jerk_rad_s2.push_back(narrow[k] - input.accel_rad_s2[k]);
            input.angle_rad.assign(data.count, 0);
            for (std::size_t k = 1; k < data.count; ++k)
                input.angle_rad[k] = input.angle_rad[k - 1] + 0.5 * data.step_s * (input.speed_rad_s[k] + input.speed_rad_s[k - 1]);
        }
    }

    void travel(WheelInput &input) const {
        double from = input.angle_rad.empty() ? 0 : input.angle_rad[0], way = 0;
        for (std::size_t k = 0; k < input.angle_rad.size(); ++k) {
            const double w = input.speed_rad_s[k];
            if (std::fabs(w) > standstill_rad_s && w * way < 0) from = input.angle_rad[k];
            if (std::fabs(w) > standstill_rad_s) way = w;
            input.travel_rad.push_back(input.angle_rad[k] - from);
        }
    }

    // Acceleration from the smoothed speed by a second, equal smoothing of central differences.
    void slopes_of(WheelInput &input) const {
        std::vector<double> &dw = input.accel_rad_s2;
        const std::vector<double> &w = input.speed_rad_s;
        dw.assign(data.count, 0);
        const auto n = static_cast<std::ptrdiff_t>(data.count), reach = std::max<std::ptrdiff_t>(1, std::lround(0.02 / data.step_s));
        for (std::ptrdiff_t k = 0; k < n; ++k) {
            const std::ptrdiff_t a = std::max<std::ptrdiff_t>(0, k - reach), b = std::min(n - 1, k + reach);
            dw[static_cast<std::size_t>(k)] = (w[static_cast<std::size_t>(b)] - w[static_cast<std::size_t>(a)]) / (static_cast<double>(b - a) * data.step_s);
        }
    }

    void mark_gaps(const std::vector<double> &distance_s, const log::Signal &s) {
        const double limit = std::max(longest_gap_s, 2.6 * sample_period(s));
        for (std::size_t k = 0; k < data.count; ++k)
            if (distance_s[k] > limit) data.gap[k] = 1;
    }

    template <typename Mean> static void integrate_voltage(WheelInput &input, const std::vector<double> &t, Mean &&mean_V) {
        input.voltage_t_s = t;
        input.voltage_integral_Vs.assign(1, 0);
        for (std::size_t j = 0; j + 1 < t.size(); ++j) input.voltage_integral_Vs.push_back(input.voltage_integral_Vs.back() + mean_V(j) * (t[j + 1] - t[j]));
    }

    void voltages() {
        const log::Signal *battery = signal("battery.voltage_V");
        const double nominal_V = parameter(model.rover, "battery_voltage_V");
        std::vector<double> battery_V;
        if (battery != nullptr) battery_V = smooth_at(battery->t_s, battery->value, data.start_s, data.step_s, data.count, std::max(0.03, 1.5 * sample_period(*battery)), 1).value;
        else if (nominal_V > 0) battery_V.assign(data.count, nominal_V);
        bool told = false;
        for (std::size_t i = 0; i < model.wheel.size(); ++i) {
            WheelInput &input = data.wheel[i];
            if (const log::Signal *voltage = wheel_signal(i, "voltage_V")) {
                for (std::size_t k = 0; k < data.count; ++k) input.voltage_V.push_back(interpolate(voltage->t_s, voltage->value, data.time(k)));
                integrate_voltage(input, voltage->t_s, [&](std::size_t j) { return 0.5 * (voltage->value[j] + voltage->value[j + 1]); });
            } else if (const log::Signal *duty = wheel_signal(i, "duty"); duty != nullptr && !battery_V.empty()) { // held from its time on
                const auto supply = [&](double t) {
                    const double x = std::clamp((t - data.start_s) / data.step_s, 0.0, static_cast<double>(data.count - 1));
                    const auto k = std::min(static_cast<std::size_t>(x), data.count - 2);
                    return battery_V[k] + (x - static_cast<double>(k)) * (battery_V[k + 1] - battery_V[k]);
                };
                for (std::size_t k = 0; k < data.count; ++k) input.voltage_V.push_back(hold(duty->t_s, duty->value, data.time(k)) * battery_V[k]);
                integrate_voltage(input, duty->t_s, [&](std::size_t j) { return duty->value[j] * supply(0.5 * (duty->t_s[j] + duty->t_s[j + 1])); });
            } else if (!told && model.wheel[i].driven) {
                say("no motor voltage (duty and battery.voltage_V, or wheel<i>.voltage_V): the voltage balance is left out");
                told = true;
            }
        }
    }

    void yaw() {
        const log::Signal *gyro = signal("imu.gyro_z_rad_s"), *camera = signal("camera.yaw_rad");
        if (gyro != nullptr) {
            data.yaw_rate_rad_s = smooth_at(gyro->t_s, gyro->value, data.start_s, data.step_s, data.count, std::max(0.03, 1.5 * sample_period(*gyro)), 1).value;
        } else if (camera != nullptr) {
            data.yaw_rate_rad_s = smooth_at(camera->t_s, unwrapped(camera->value), data.start_s, data.step_s, data.count, std::max(0.35, 2.5 * sample_period(*camera)), 2).slope;
        } else if (model.wheel.size() > 1 && model.motion == BodyMotion::longitudinal) {
            say("no yaw rate (imu.gyro_z_rad_s or camera.yaw_rad): the body is taken to drive straight");
        }
        double sides = 0; // half the distance between the wheels' tracks
        for (const WheelSpec &w : model.wheel) sides = std::max(sides, std::fabs(parameter(w.geometry, "y_m")));
        data.yaw_free = model.motion == BodyMotion::longitudinal && (gyro != nullptr || camera != nullptr) && sides > 1e-3 && model.wheel.size() > 1;
        if (camera != nullptr) {
            const std::vector<double> angle = unwrapped(camera->value);
            for (std::size_t k = 0; k < data.count; ++k) data.yaw_rad.push_back(interpolate(camera->t_s, angle, data.time(k)));
        } else if (!data.yaw_rate_rad_s.empty()) {
            double angle = 0;
            for (std::size_t k = 0; k < data.count; ++k) data.yaw_rad.push_back(angle += data.yaw_rate_rad_s[k] * data.step_s);
        }
    }

    static std::vector<double> unwrapped(std::vector<double> angle) {
        double turn = 0;
        for (std::size_t i = 1; i < angle.size(); ++i) {
            const double step = angle[i] + turn - angle[i - 1];
            if (std::fabs(step) > std::numbers::pi) turn -= 2 * std::numbers::pi * std::round(step / (2 * std::numbers::pi));
            angle[i] += turn;
        }
        return angle;
    }

    void imposed_motion() {
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
            for (std::size_t k = 0; k < data.count; ++k) data.load_N[i].push_back(std::max(0.0, interpolate(load->t_s, load->value, data.time(k))));
        }
    }

    // A released bridge carries no current whatever the duty says (actuator.motor_enable 0).
    bool powered(double t0, double t1) const {
        const log::Signal *enable = signal("actuator.motor_enable");
        return enable == nullptr || (hold(enable->t_s, enable->value, t0 - 0.02) > 0.5 && hold(enable->t_s, enable->value, t1 + 0.02) > 0.5);
    }

    bool usable(double t0, double t1) const {
        if (t0 < data.start_s || t1 > data.time(data.count - 1)) return false;
        const auto a = static_cast<std::size_t>((t0 - data.start_s) / data.step_s);
        const auto b = std::min(data.count - 1, static_cast<std::size_t>((t1 - data.start_s) / data.step_s) + 1);
        for (std::size_t k = a; k <= b; ++k)
            if (data.gap[k] != 0) return false;
        return true;
    }

    // Noise of one sample: the log's own word, then the model's, then what the series shows at its highest frequency.
    double sample_noise(const log::Signal &s, const std::string &model_key, std::string &source) const {
        const double quantum = header("quantum." + s.name);
        if (const double told = header("noise." + s.name); told > 0) {
            source = "log header";
            return std::hypot(told, quantum / std::sqrt(12.0));
        }
        if (const double told = parameter(model.sensors, model_key); told > 0) {
            source = "model";
            return std::hypot(told, quantum / std::sqrt(12.0));
        }
        source = "high-frequency content";
        double noise = noise_from_differences(s.value);
        if (!(noise > 0)) { // quantised: smallest step over sqrt(12)
            double step = 0;
            for (std::size_t i = 1; i < s.value.size(); ++i) {
                const double d = std::fabs(s.value[i] - s.value[i - 1]);
                if (d > 0 && (step <= 0 || d < step)) step = d;
            }
            noise = std::max(quantum, step) / std::sqrt(12.0);
        }
        return noise > 0 ? noise : 1e-6;
    }

    // Rows of a signal that is the running value of something: means over bins, or the samples themselves when they are slow.
    void add_rows(Balance &balance, const log::Signal &s, double noise) {
        const double period = sample_period(s);
        const double back = 0.5 * window_of(s); // a sample that is a mean over a window ending at its time stands for the middle
        std::size_t i = 0, total = 0;
        while (i < s.t_s.size()) {
            std::size_t j = i + 1;
            if (!data.independent_rows && period < 0.8 * bin_s) {
                const double bin = std::floor((s.t_s[i] - data.start_s) / bin_s + 1e-9);
                while (j < s.t_s.size() && s.t_s[j] < data.start_s + (bin + 1) * bin_s - 1e-9) ++j;
            }
            const bool single = j == i + 1;
            const double lead = single ? back : 0.5 * period;
            const double t0 = s.t_s[i] - back - lead, t1 = s.t_s[j - 1] - back + lead;
            double sum = 0;
            for (std::size_t m = i; m < j; ++m) sum += s.value[m];
            if (usable(t0, t1)) {
                balance.t0_s.push_back(t0);
                balance.t1_s.push_back(t1);
                balance.measured.push_back(sum / static_cast<double>(j - i));
                total += j - i;
            }
            i = j;
        }
        if (!balance.measured.empty())
            balance.noise = noise / std::sqrt(static_cast<double>(total) / static_cast<double>(balance.measured.size()));
    }

    void add(Balance balance) {
        if (balance.measured.size() >= 4) data.balance.push_back(std::move(balance));
    }

    bool moves(std::size_t i, double t0, double t1) const {
        const auto a = static_cast<std::size_t>(std::max(0.0, (t0 - data.start_s) / data.step_s));
        const auto b = std::min(data.count - 1, static_cast<std::size_t>((t1 - data.start_s) / data.step_s) + 1);
        for (std::size_t k = a; k <= b; ++k)
            if (std::fabs(data.wheel[i].speed_rad_s[k]) < standstill_rad_s) return false;
        return true;
    }

    // Current that the smoothing of the acceleration may have cost the torque balance in a window [A].
    double smoothing_error(std::size_t i, double t0, double t1) const {
        const std::vector<double> &jerk = data.wheel[i].jerk_rad_s2;
        if (jerk.empty()) return 0;
        const auto a = static_cast<std::size_t>(std::max(0.0, (t0 - data.start_s) / data.step_s));
        const auto b = std::min(data.count - 1, static_cast<std::size_t>((t1 - data.start_s) / data.step_s) + 1);
        double sum = 0;
        for (std::size_t k = a; k <= b; ++k) sum += std::fabs(jerk[k]);
        const double mean = std::max(0.0, sum / static_cast<double>(b - a + 1) - jerk_noise(i));
        return mean * parameter(model.wheel[i].motor, "inertia_kg_m2") / parameter(model.wheel[i].motor, "torque_constant_Nm_A");
    }

    // Median of the same difference: what the encoder's noise alone makes.
    double jerk_noise(std::size_t i) const {
        if (jerk_noise_.size() < data.wheel.size()) jerk_noise_.assign(data.wheel.size(), -1);
        if (jerk_noise_[i] < 0) {
            std::vector<double> size(data.wheel[i].jerk_rad_s2);
            for (double &x : size) x = std::fabs(x);
            jerk_noise_[i] = 2 * median(size);
        }
        return jerk_noise_[i];
    }
    mutable std::vector<double> jerk_noise_;
    std::size_t too_quick_ = 0;

    void currents(std::size_t i) {
        const log::Signal *current = wheel_signal(i, "current_A");
        if (current == nullptr) {
            if (model.wheel[i].driven && model.motion != BodyMotion::imposed) say("wheel" + std::to_string(i) + ".current_A is missing: its torque and voltage balances are left out");
            return;
        }
        double scale = 0;
        if (motion_signal(i, scale) == nullptr) return;
        Balance torque{BalanceKind::current_torque, static_cast<int>(i), "wheel" + std::to_string(i) + ".current_A", "current of wheel " + std::to_string(i) + ", torque balance", "A", 0, "", {}, {}, {}, {}};
        const double noise = sample_noise(*current, "current.noise_A", torque.noise_source);
        Balance all = torque, powered_rows = torque;
        add_rows(all, *current, noise);
        for (std::size_t r = 0; r < all.measured.size(); ++r) {
            if (!powered(all.t0_s[r], all.t1_s[r])) continue;
            powered_rows.t0_s.push_back(all.t0_s[r]);
            powered_rows.t1_s.push_back(all.t1_s[r]);
            powered_rows.measured.push_back(all.measured[r]);
        }
        powered_rows.noise = all.noise;
        all = std::move(powered_rows);
        if (parameter(model.wheel[i].motor, "torque_constant_Nm_A") > 0) {
            torque.noise = all.noise;
            for (std::size_t r = 0; r < all.measured.size(); ++r) {
                if (!data.independent_rows && !moves(i, all.t0_s[r], all.t1_s[r])) continue;
                if (smoothing_error(i, all.t0_s[r], all.t1_s[r]) > 8 * torque.noise) {
                    ++too_quick_; // a set-point step: the encoder cannot follow it
                    continue;
                }
                torque.t0_s.push_back(all.t0_s[r]);
                torque.t1_s.push_back(all.t1_s[r]);
                torque.measured.push_back(all.measured[r]);
                torque.noise_factor.push_back(std::hypot(1.0, smoothing_error(i, all.t0_s[r], all.t1_s[r]) / torque.noise));
            }
            add(std::move(torque));
        } else {
            say("the model has no motor.torque_constant_Nm_A: torque balances are left out");
        }
        if (data.wheel[i].voltage_V.empty()) return;
        if (!(parameter(model.wheel[i].motor, "resistance_ohm") > 0)) {
            say("the model has no motor.resistance_ohm: voltage balances are left out");
            return;
        }
        all.kind = BalanceKind::current_voltage;
        all.name = "wheel" + std::to_string(i) + ".voltage_balance_A";
        all.title = "current of wheel " + std::to_string(i) + ", voltage balance";
        add(std::move(all));
    }

    void simple(const std::string &name, const std::string &title, const std::string &unit, BalanceKind kind, int wheel, const std::string &noise_key) {
        const log::Signal *s = signal(name);
        if (s == nullptr) return;
        Balance balance{kind, wheel, name, title, unit, 0, "", {}, {}, {}, {}};
        const double noise = sample_noise(*s, noise_key, balance.noise_source);
        add_rows(balance, *s, noise);
        add(std::move(balance));
    }

    // Mean rim speed over a window: scales a noise that grows with speed, without the noise itself.
    double rim_speed(double t0, double t1) const {
        const auto a = static_cast<std::size_t>(std::max(0.0, (t0 - data.start_s) / data.step_s));
        const auto b = std::min(data.count - 1, static_cast<std::size_t>((t1 - data.start_s) / data.step_s));
        double sum = 0, n = 0;
        for (std::size_t i = 0; i < data.wheel.size(); ++i)
            for (std::size_t k = a; k <= b; ++k, ++n) sum += std::fabs(data.wheel[i].speed_rad_s[k]) * parameter(model.wheel[i].geometry, "radius_m");
        return n > 0 ? sum / n : 0;
    }

    void radar() {
        const log::Signal *s = signal("radar.speed_m_s");
        if (s == nullptr) {
            say(log.find("radar.adc_count") != nullptr ? "radar.adc_count is raw: no radar.speed_m_s, the radar balance is left out" : "radar.speed_m_s is missing: the radar balance is left out");
            return;
        }
        Balance balance{BalanceKind::radar, -1, "radar.speed_m_s", "ground speed by radar", "m/s", 0, "", {}, {}, {}, {}};
        balance.noise = sample_noise(*s, "radar.noise_m_s", balance.noise_source);
        const double relative = header("noise.radar.speed_m_s.relative");
        const double window = window_of(*s) > 0 ? window_of(*s) : parameter(model.sensors, "radar.window_s"), least = parameter(model.sensors, "radar.minimum_m_s");
        double last_value = std::nan("");
        for (std::size_t i = 0; i < s->t_s.size(); ++i) {
            const double t1 = s->t_s[i], t0 = t1 - window, y = s->value[i];
            const bool held = y == last_value && i > 0 && s->t_s[i] - s->t_s[i - 1] < 0.4 * window; // a value held between frames
            last_value = y;
            if (held || std::fabs(y) < least || !usable(t0, t1)) continue;
            balance.t0_s.push_back(t0);
            balance.t1_s.push_back(t1);
            balance.measured.push_back(y);
            if (relative > 0) balance.noise_factor.push_back(std::hypot(balance.noise, relative * rim_speed(t0, t1)) / balance.noise);
        }
        add(std::move(balance));
    }

    void camera() {
        const log::Signal *x = signal("camera.x_m"), *y = signal("camera.y_m"), *angle = signal("camera.yaw_rad");
        if (x == nullptr) {
            say("camera.x_m is missing: the camera balance is left out");
            return;
        }
        const std::vector<double> yaw = angle != nullptr ? unwrapped(angle->value) : std::vector<double>();
        Balance along{BalanceKind::camera_x, -1, "camera.forward_m", "camera displacement, forward", "m", 0, "", {}, {}, {}, {}};
        const double noise = sample_noise(*x, "camera.noise_m", along.noise_source);
        along.noise = std::sqrt(2.0) * noise;
        Balance side = along, turn = along;
        side.kind = BalanceKind::camera_y, side.name = "camera.left_m", side.title = "camera displacement, to the left";
        turn.kind = BalanceKind::camera_yaw, turn.name = "camera.yaw_rad", turn.title = "camera heading change", turn.unit = "rad";
        if (angle != nullptr) turn.noise = std::sqrt(2.0) * std::max(1e-4, noise_from_differences(angle->value));
        const double mx = parameter(model.sensors, "camera.x_m"), my = parameter(model.sensors, "camera.y_m"), mount = parameter(model.sensors, "camera.yaw_rad");
        const double spacing = std::max(0.28, 0.99 * sample_period(*x));
        struct Pose { double t, x, y, yaw; };
        const auto pose = [&](std::size_t i) {
            const double t = x->t_s[i];
            double heading = angle != nullptr ? interpolate(angle->t_s, yaw, t) + mount : 0;
            if (angle == nullptr && !data.yaw_rad.empty() && data.count > 0) {
                const double k = std::clamp((t - data.start_s) / data.step_s, 0.0, static_cast<double>(data.count - 1));
                heading = data.yaw_rad[static_cast<std::size_t>(k)];
            }
            const double py = y != nullptr ? interpolate(y->t_s, y->value, t) : 0;
            return Pose{t, x->value[i] - (mx * std::cos(heading) - my * std::sin(heading)), py - (mx * std::sin(heading) + my * std::cos(heading)), heading};
        };
        Pose a = pose(0);
        for (std::size_t i = 1; i < x->t_s.size(); ++i) {
            if (x->t_s[i] - a.t < spacing) continue;
            const Pose b = pose(i);
            if (b.t - a.t < 3 * spacing && usable(a.t, b.t)) {
                const double c = std::cos(0.5 * (a.yaw + b.yaw)), s = std::sin(0.5 * (a.yaw + b.yaw));
                for (Balance *balance : {&along, &side, &turn}) balance->t0_s.push_back(a.t), balance->t1_s.push_back(b.t);
                along.measured.push_back((b.x - a.x) * c + (b.y - a.y) * s);
                side.measured.push_back(-(b.x - a.x) * s + (b.y - a.y) * c);
                turn.measured.push_back(b.yaw - a.yaw);
            }
            a = b;
        }
        add(std::move(along));
        if (model.motion == BodyMotion::planar && y != nullptr) add(std::move(side));
        if (angle != nullptr && (model.motion == BodyMotion::planar || signal("imu.gyro_z_rad_s") == nullptr)) add(std::move(turn));
    }

    void balances() {
        for (std::size_t i = 0; i < model.wheel.size(); ++i) {
            currents(i);
            const std::string w = "wheel" + std::to_string(i);
            simple(w + ".drawbar_pull_N", "drawbar pull of wheel " + std::to_string(i), "N", BalanceKind::force, static_cast<int>(i), "force.noise_N");
            simple(w + ".torque_Nm", "torque of wheel " + std::to_string(i), "N m", BalanceKind::torque, static_cast<int>(i), "torque.noise_Nm");
        }
        if (model.motion == BodyMotion::imposed || model.motion == BodyMotion::none) return;
        simple("imu.accel_x_m_s2", "longitudinal acceleration", "m/s^2", BalanceKind::accel, -1, "accel.noise_m_s2");
        if (signal("imu.accel_x_m_s2") == nullptr) say("imu.accel_x_m_s2 is missing: the acceleration balance is left out");
        radar();
        camera();
        if (model.motion == BodyMotion::longitudinal) simple("imu.gyro_z_rad_s", "yaw rate", "rad/s", BalanceKind::yaw_rate, -1, "gyro.noise_rad_s");
    }

    void build() {
        header_of_log();
        data.wheel.resize(model.wheel.size());
        if (!set_grid()) {
            data.count = 0;
            return;
        }
        for (std::size_t i = 0; i < model.wheel.size(); ++i) wheel_motion(i), travel(data.wheel[i]);
        voltages();
        yaw();
        imposed_motion();
        balances();
        if (too_quick_ > 0) say(std::to_string(too_quick_) + " rows of the torque balances lie at speed steps quicker than the encoder can tell: left out");
        if (data.balance.empty()) say("the log has no measurement that this model predicts: nothing can be compared");
    }
};

// Two runs of one drive: the standard deviation of their difference over sqrt(2) is the noise of one.
void noise_from_repeat(Dataset &data, const Dataset &other) {
    for (Balance &balance : data.balance) {
        for (const Balance &twin : other.balance) {
            if (twin.name != balance.name) continue;
            double sum = 0;
            std::size_t n = 0;
            for (std::size_t i = 0, j = 0; i < balance.measured.size(); ++i) {
                const double t = balance.t0_s[i] - data.start_s;
                while (j < twin.t0_s.size() && twin.t0_s[j] - other.start_s < t - 0.02) ++j;
                if (j >= twin.t0_s.size() || std::fabs(twin.t0_s[j] - other.start_s - t) > 0.02) continue;
                const double d = balance.measured[i] - twin.measured[j];
                sum += d * d;
                ++n;
            }
            if (n < 20 || !(sum > 0)) continue;
            balance.noise = std::sqrt(sum / static_cast<double>(n) / 2);
            balance.noise_source = "repeat run";
        }
    }
}

} // namespace

Dataset make_dataset(const Model &model, const log::Log &log, const log::Log *repeat) {
    Builder builder{model, log, {}, {}, 0};
    builder.build();
    if (repeat != nullptr) {
        Builder other{model, *repeat, {}, {}, 0};
        other.build();
        noise_from_repeat(builder.data, other.data);
    }
    return builder.data;
}

} // namespace traction::lab
