#include "dataset.h"

#include "inputs.h"
#include "smooth.h"
#include "track_heading.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace traction::lab {

namespace {

struct Builder : InputBuilder {
    Builder(const Model &of, const log::Log &from, double noise, double widen_) : InputBuilder{of, from, noise, widen_, {}} {}

    // A released bridge carries no current whatever the duty says (actuator.motor_enable 0).
    bool powered(double t0, double t1) const {
        const log::Signal *enable = signal("actuator.motor_enable");
        return enable == nullptr ||
               (hold(enable->t_s, enable->value, t0 - 0.02) > 0.5 && hold(enable->t_s, enable->value, t1 + 0.02) > 0.5);
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
            if (std::fabs(data.wheel[i].speed_rad_s[k]) < data.standstill_rad_s) return false;
        return true;
    }

    // A body that moves by its wheels' forces, on wheels that have none.
    void grip() {
        if (model.motion != BodyMotion::longitudinal && model.motion != BodyMotion::planar) return;
        for (std::size_t i = 0; i < model.wheel.size(); ++i)
            if (!(parameter(model.wheel[i].soil, "mu") > 0) && !(parameter(model.wheel[i].soil, "adhesion_N") > 0))
                say("the model has no soil.mu above 0 for wheel " + std::to_string(i) + ": it has no grip");
    }

    void currents(std::size_t i) {
        const log::Signal *current = wheel_signal(i, "current_A");
        if (model.wheel[i].drive >= 0) {
            if (current != nullptr)
                say(current->name + " is not read: wheel " + std::to_string(i) + " turns with the motor of wheel " +
                    std::to_string(model.wheel[i].drive));
            return;
        }
        if (current == nullptr) {
            if (model.wheel[i].driven && model.motion != BodyMotion::imposed)
                say("wheel" + std::to_string(i) + ".current_A is missing: its torque and voltage balances are left out");
            return;
        }
        double scale = 0;
        if (motion_signal(i, scale) == nullptr) return;
        Balance torque{BalanceKind::current_torque,
                       static_cast<int>(i),
                       "wheel" + std::to_string(i) + ".current_A",
                       "current of wheel " + std::to_string(i) + ", torque balance",
                       "A",
                       0,
                       "",
                       {},
                       {},
                       {},
                       {},
                       {}};
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
                torque.t0_s.push_back(all.t0_s[r]);
                torque.t1_s.push_back(all.t1_s[r]);
                torque.measured.push_back(all.measured[r]);
            }
            add(std::move(torque));
        } else {
            say("the model has no motor.torque_constant_Nm_A above 0: torque balances are left out");
        }
        if (data.wheel[i].voltage_V.empty()) return;
        if (!(parameter(model.wheel[i].motor, "resistance_ohm") > 0)) {
            say("the model has no motor.resistance_ohm above 0: voltage balances are left out");
            return;
        }
        all.kind = BalanceKind::current_voltage;
        all.name = "wheel" + std::to_string(i) + ".voltage_balance_A";
        all.title = "current of wheel " + std::to_string(i) + ", voltage balance";
        add(std::move(all));
    }

    void simple(const std::string &name, const std::string &title, const std::string &unit, BalanceKind kind, int wheel,
                const std::string &noise_key) {
        const log::Signal *s = signal(name);
        if (s == nullptr) return;
        Balance balance{kind, wheel, name, title, unit, 0, "", {}, {}, {}, {}, {}};
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
            for (std::size_t k = a; k <= b && !data.wheel[i].rolls_freely; ++k, ++n)
                sum += std::fabs(data.wheel[i].speed_rad_s[k]) * parameter(model.wheel[i].geometry, "radius_m");
        return n > 0 ? sum / n : 0;
    }

    // A radar that knows the direction: clearly negative in places, or declared so by signed.radar.speed_m_s.
    bool carries_sign(const log::Signal &s, double noise) const {
        if (header("signed." + s.name) > 0) return true;
        const auto beyond = [&](double sign) {
            const double least = std::max(4 * noise, parameter(model.sensors, "radar.minimum_m_s"));
            return std::count_if(s.value.begin(), s.value.end(), [&](double v) { return sign * v > least; });
        };
        const auto few = static_cast<std::ptrdiff_t>(s.value.size() / 100 + 3);
        return beyond(-1) > few; // the check has refused a magnitude that is negated
    }

    bool reverses(double t0, double t1) const {
        const auto a = static_cast<std::size_t>(std::max(0.0, (t0 - data.start_s) / data.step_s));
        const auto b = std::min(data.count - 1, static_cast<std::size_t>(std::max(0.0, (t1 - data.start_s) / data.step_s)));
        bool forward = false, back = false;
        for (std::size_t k = a; k <= b; ++k) {
            double sum = 0;
            for (const WheelInput &wheel : data.wheel) sum += wheel.speed_rad_s[k];
            forward = forward || sum > 0, back = back || sum < 0;
        }
        return forward && back;
    }

    void radar() {
        const log::Signal *s = signal("radar.speed_m_s");
        if (s == nullptr) {
            say(log.find("radar.adc_count") != nullptr ? "radar.adc_count is raw: no radar.speed_m_s, the radar balance is left out"
                                                       : "radar.speed_m_s is missing: the radar balance is left out");
            return;
        }
        Balance balance{BalanceKind::radar, -1, "radar.speed_m_s", "ground speed by radar", "m/s", 0, "", {}, {}, {}, {}, {}};
        balance.noise = sample_noise(*s, "radar.noise_m_s", balance.noise_source);
        const double relative = header("noise.radar.speed_m_s.relative");
        const double window = window_of(*s) > 0 ? window_of(*s) : parameter(model.sensors, "radar.window_s"),
                     least = parameter(model.sensors, "radar.minimum_m_s");
        const bool has_sign = carries_sign(*s, balance.noise);
        if (has_sign) say("radar.speed_m_s carries a sign: its magnitude is compared, but where the wheels reverse");
        double last_value = std::nan("");
        for (std::size_t i = 0; i < s->t_s.size(); ++i) {
            const double t1 = s->t_s[i], t0 = t1 - window, y = has_sign ? std::fabs(s->value[i]) : s->value[i];
            if (has_sign && reverses(t0, t1)) continue;                                             // the mean of both directions
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

    double on_grid(const std::vector<double> &series, double t) const {
        const double k = std::clamp((t - data.start_s) / data.step_s, 0.0, static_cast<double>(data.count - 1));
        const auto a = static_cast<std::size_t>(k), b = std::min(a + 1, data.count - 1);
        return series[a] + (k - static_cast<double>(a)) * (series[b] - series[a]);
    }

    // No driven wheel rolls sideways or is turned.
    bool goes_along_its_heading() const {
        return std::all_of(model.wheel.begin(), model.wheel.end(), [](const WheelSpec &w) {
            return !w.driven || (w.grips_sideways && std::fabs(parameter(w.geometry, "heading_rad")) < 1e-3);
        });
    }

    // Mean way of the rims of the wheels whose motion is known, from the log's begin [m].
    std::vector<double> rim_way() const {
        std::vector<double> way(data.count, 0);
        double wheels = 0;
        for (std::size_t i = 0; i < model.wheel.size(); ++i) {
            if (data.wheel[i].rolls_freely) continue;
            wheels += 1;
            const double radius = parameter(model.wheel[i].geometry, "radius_m");
            for (std::size_t k = 0; k < data.count; ++k) way[k] += radius * data.wheel[i].speed_rad_s[k] * data.step_s;
        }
        for (std::size_t k = 0; k < data.count; ++k) way[k] = (k > 0 ? way[k - 1] : 0) + way[k] / std::max(1.0, wheels);
        return way;
    }

    // Rows of the track, from fix to fix at least `spacing` apart; their times are those of `balance`.
    std::vector<TrackRow> track(const log::Signal &x, const log::Signal *y, const log::Signal *angle, double spacing, Balance &balance) {
        const std::vector<double> yaw = angle != nullptr ? unwrapped(angle->value) : std::vector<double>(), rim_m = rim_way();
        const double mount = parameter(model.sensors, "camera.yaw_rad");
        const auto heading = [&](double t) {
            if (angle != nullptr) return interpolate(angle->t_s, yaw, t) + mount;
            return data.yaw_rad.empty() ? 0 : on_grid(data.yaw_rad, t);
        };
        const auto place = [&](std::size_t i) {
            return std::complex<double>(x.value[i], y != nullptr ? interpolate(y->t_s, y->value, x.t_s[i]) : 0);
        };
        std::vector<TrackRow> rows;
        for (std::size_t i = 1, from = 0; i < x.t_s.size(); ++i) {
            const double t0 = x.t_s[from], t1 = x.t_s[i];
            if (t1 - t0 < spacing) continue;
            if (t1 - t0 < 3 * spacing && usable(t0, t1)) {
                rows.push_back({place(i) - place(from),
                                on_grid(rim_m, t1) - on_grid(rim_m, t0),
                                {heading(t0), heading(t1)},
                                balance.t1_s.empty() || balance.t1_s.back() != t0});
                balance.t0_s.push_back(t0), balance.t1_s.push_back(t1);
            }
            from = i;
        }
        return rows;
    }

    void camera() {
        const log::Signal *x = signal("camera.x_m"), *y = signal("camera.y_m"), *angle = signal("camera.yaw_rad");
        if (x == nullptr) {
            say("camera.x_m is missing: the camera balance is left out");
            return;
        }
        Balance along{BalanceKind::camera_x, -1, "camera.forward_m", "camera displacement, forward", "m", 0, "", {}, {}, {}, {}, {}};
        const double spacing = std::max(0.28, 0.99 * sample_period(*x));
        along.noise = std::sqrt(2.0) * sample_noise(*x, "camera.noise_m", along.noise_source);
        const std::vector<TrackRow> rows = track(*x, y, angle, spacing, along);
        const std::complex<double> lever_m(parameter(model.sensors, "camera.x_m"), parameter(model.sensors, "camera.y_m"));
        std::vector<double> delta_rad(rows.size(), 0);
        if (angle == nullptr && y != nullptr && goes_along_its_heading()) {
            delta_rad = track_heading(rows, lever_m, along.noise, spacing).delta_rad;
            say(delta_rad.empty()
                    ? "camera.x_m and y_m without camera.yaw_rad: no heading lays them along the wheels' way: the camera balance is "
                      "left out (imu.gyro_z_rad_s tells how the machine turns)"
                    : "no camera.yaw_rad: the heading is the gyro's, turned until the wheels' way lies on the track");
            if (delta_rad.empty()) return;
        }
        Balance side = along, turn = along;
        side.kind = BalanceKind::camera_y, side.name = "camera.left_m", side.title = "camera displacement, to the left";
        turn.kind = BalanceKind::camera_yaw, turn.name = "camera.yaw_rad", turn.title = "camera heading change", turn.unit = "rad";
        if (angle != nullptr) turn.noise = std::sqrt(2.0) * std::max(1e-4, noise_from_differences(angle->value));
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const std::complex<double> way = way_of_body(rows[i], lever_m, delta_rad[i]);
            along.measured.push_back(way.real());
            side.measured.push_back(way.imag());
            turn.measured.push_back(rows[i].turned_rad[1] - rows[i].turned_rad[0]);
        }
        add(std::move(along));
        if (model.motion == BodyMotion::planar && y != nullptr)
            add(std::move(side));
        else if (y != nullptr)
            data.camera_left = std::move(side);
        if (angle != nullptr && signal("imu.gyro_z_rad_s") == nullptr) add(std::move(turn));
    }

    void balances() {
        grip();
        for (std::size_t i = 0; i < model.wheel.size(); ++i) {
            if (model.wheel[i].driven && !is_measured(i)) continue; // what it would read is not known
            currents(i);
            const std::string w = "wheel" + std::to_string(i);
            simple(w + ".drawbar_pull_N", "drawbar pull of wheel " + std::to_string(i), "N", BalanceKind::force, static_cast<int>(i),
                   "force.noise_N");
            if (model.wheel[i].drive < 0) // a motor's shaft
                simple(w + ".torque_Nm", "torque of wheel " + std::to_string(i), "N m", BalanceKind::torque, static_cast<int>(i),
                       "torque.noise_Nm");
        }
        if (model.motion == BodyMotion::imposed || model.motion == BodyMotion::none) return;
        simple("imu.accel_x_m_s2", "longitudinal acceleration", "m/s^2", BalanceKind::accel, -1, "accel.noise_m_s2");
        if (signal("imu.accel_x_m_s2") == nullptr) say("imu.accel_x_m_s2 is missing: the acceleration balance is left out");
        radar();
        camera();
        simple("imu.gyro_z_rad_s", "yaw rate", "rad/s", BalanceKind::yaw_rate, -1, "gyro.noise_rad_s");
    }

    void build() {
        header_of_log();
        if (!grid_and_wheels()) {
            data.count = 0;
            return;
        }
        voltages();
        yaw();
        imposed_motion();
        balances();
        if (data.balance.empty()) say("the log has no measurement that this model predicts: nothing can be compared");
    }
};

} // namespace

double Dataset::acceleration_loss(double omega) const {
    const double x = omega * step_s; // differences of fourth order, then linear interpolation between them
    if (!(x > 1e-6)) return 0;
    const double difference = (8 * std::sin(x) - std::sin(2 * x)) / (6 * x);
    const double kept = slope_response(smoothing_half_s, omega) * difference * std::pow(std::sin(x / 2) / (x / 2), 2);
    return std::clamp(1 - kept, 0.0, 1.0);
}

std::vector<double> Dataset::voltage_integral(const WheelInput &input, double lag_s) const {
    if (input.duty.empty() || (lag_s == 0 && !input.voltage_integral_Vs.empty())) return input.voltage_integral_Vs;
    std::vector<double> sum(1, 0);
    sum.reserve(input.voltage_t_s.size());
    std::size_t i = 0;
    for (std::size_t j = 0; j + 1 < input.voltage_t_s.size(); ++j) {
        const double step = input.voltage_t_s[j + 1] - input.voltage_t_s[j], middle = input.voltage_t_s[j] + 0.5 * step + lag_s;
        while (i + 2 < supply_t_s.size() && supply_t_s[i + 1] <= middle) ++i;
        double V = supply_V[i];
        if (i + 1 < supply_t_s.size())
            V += std::clamp((middle - supply_t_s[i]) / (supply_t_s[i + 1] - supply_t_s[i]), 0.0, 1.0) * (supply_V[i + 1] - supply_V[i]);
        sum.push_back(sum.back() + input.duty[j] * V * step);
    }
    return sum;
}

Dataset measured_data(const Model &model, const log::Log &log, double slope_noise, double widen) {
    Builder builder(model, log, slope_noise, widen);
    builder.build();
    return builder.data;
}

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

} // namespace traction::lab
