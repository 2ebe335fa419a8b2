#include "tune.h"

#include "order_delay.h"

#include "host_tools/loop/loop.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace traction {

namespace {

constexpr double tick_s = 0.01;
constexpr double probe_duty = 0.1;

// Normal equations of (1) for one wheel.
struct Fit {
    double A[3][3] = {}, y[3] = {};
    int rows = 0;
    void add(const std::array<double, 3> &x, double next) {
        for (std::size_t i = 0; i < 3; i++) {
            y[i] += x[i] * next;
            for (std::size_t j = 0; j < 3; j++) A[i][j] += x[i] * x[j];
        }
        rows++;
    }
    std::array<double, 3> solve() const { // Cramer's rule
        const auto det = [](const double(&m)[3][3]) {
            return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                   m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
        };
        std::array<double, 3> x{};
        for (std::size_t k = 0; k < 3; k++) {
            double m[3][3];
            for (std::size_t i = 0; i < 3; i++)
                for (std::size_t j = 0; j < 3; j++) m[i][j] = j == k ? y[i] : A[i][j];
            x[k] = det(m) / det(A);
        }
        return x;
    }
};

// Drives the pulses as the loop's operator: MODE_OPEN_LOOP, so that the firmware's safety watches over the experiment too.
class Experiment : public Link {
  public:
    Experiment(const control_config_t &config, const TuneLimits &limits) : config_(config), limits_(limits) {
        pulse(probe_duty, 0.03); // the current of a wheel at rest tells its circuit
        pulse(0, 0.1);
        probe_ticks_ = plan_.size();
        for (const double duty : {0.5, -0.5, 1.0, -1.0, 0.7, -0.7}) {
            pulse(duty * limits.duty, 0.7);
            pulse(0, 0.5);
        }
    }

    bool over() override {
        if (samples_.size() == plan_.size()) return true;
        if (used_s_ >= limits_.time_s)
            throw std::runtime_error("tune: the time limit is over before the experiment is; give more --time-s");
        return false;
    }

    // The plan's duty, less where (3) would pass the torque limit. Without (3), the probe: as it is.
    void command(const sensor_frame_t &frame, command_t &command) override {
        if (frame.emergency_stop) throw std::runtime_error("tune: emergency stop");
        const sense_output_t sense = sense_measure(&config_.sense, &sense_, &frame);
        if ((sense.usable & 0x1ffu) != 0x1ffu) throw std::runtime_error("tune: an encoder, a current or the battery is silent or absurd");
        used_s_ += tick_s;
        battery_V_ = static_cast<double>(sense.battery_V);
        Sample sample{.battery_V = battery_V_};
        for (std::size_t i = 0; i < WHEEL_COUNT; i++) {
            const double w = static_cast<double>(sense.speed_rad_s[i]), current_A = static_cast<double>(sense.current_A[i]);
            const double torque = static_cast<double>(config_.motor.torque_constant_Nm_A) * std::fabs(current_A);
            largest_Nm_ = std::max(largest_Nm_, torque);
            if (torque > limits_.torque_Nm * largest_excess)
                throw std::runtime_error("tune: wheel " + std::to_string(i) +
                                         " took more torque than allowed; check its current sensor, or raise --torque-Nm");
            sample.wheel[i] = {.speed_rad_s = w, .current_A = current_A, .ordered = last_duty_[i]};
        }
        samples_.push_back(sample);
        if (samples_.size() == probe_ticks_) seen_late_s_ = std::floor(order_delay_s(samples_) / tick_s + 1e-6) * tick_s;
        for (std::size_t i = 0; i < WHEEL_COUNT; i++) {
            const Sample::Wheel &wheel = sample.wheel[i];
            learn_circuit(i, duty_in_force(samples_, samples_.size() - 1, i, seen_late_s_), wheel.speed_rad_s, wheel.current_A);
            last_duty_[i] = within_torque(i, plan_[samples_.size() - 1], wheel.speed_rad_s);
            command.duty[i] = static_cast<float>(last_duty_[i]);
        }
        command.mode = MODE_OPEN_LOOP;
    }

    void log(const sensor_frame_t &, const command_t &, const trace_t &trace) override {
        if (trace.mode == MODE_OPEN_LOOP) return;
        char text[16];
        std::snprintf(text, sizeof text, "%08x", static_cast<unsigned>(trace.faults));
        throw std::runtime_error(std::string("tune: the firmware stopped the motors, faults ") + text + " (docs/firmware.md)");
    }

    TuneResult result() const {
        TuneResult r{.battery_V = battery_V_, .largest_torque_Nm = largest_Nm_, .used_s = used_s_};
        r.order_delay_s = order_delay_s(samples_);
        double largest = 0;
        for (std::size_t i = 0; i < WHEEL_COUNT; i++) {
            const Fit fit = fit_of(i, r.order_delay_s);
            if (fit.rows < 50)
                throw std::runtime_error("tune: wheel " + std::to_string(i) + " hardly turned; raise --duty or --torque-Nm, or free it");
            const auto [a, b, c] = fit.solve();
            if (!(a > 0.2 && a < 0.9999 && b > 0))
                throw std::runtime_error("tune: wheel " + std::to_string(i) + " does not answer like a motor; check its encoder's sign");
            r.pole_1_s[i] = -std::log(a) / tick_s;
            r.gain_rad_s2[i] = b * battery_V_ / tick_s;
            if (r.gain_rad_s2[i] > largest) {
                largest = r.gain_rad_s2[i];
                const double crossover = (90 - limits_.margin_deg) * std::numbers::pi / 180 / (2 * tick_s + r.order_delay_s);
                r.kp_s = crossover / largest;
                r.ki_1 = r.kp_s * r.pole_1_s[i]; // (2)
            }
        }
        return r;
    }

  private:
    void pulse(double duty, double seconds) {
        for (double t = 0; t < seconds; t += tick_s) plan_.push_back(duty);
    }
    // (1) over the ticks of a turning wheel whose duty held still: half of the encoder's difference is the tick's before.
    Fit fit_of(std::size_t i, double late_s) const {
        Fit fit;
        for (std::size_t k = 1; k < samples_.size(); k++) {
            const double w = samples_[k].wheel[i].speed_rad_s, last_w = samples_[k - 1].wheel[i].speed_rad_s;
            const double duty = duty_in_force(samples_, k, i, late_s), last_duty = duty_in_force(samples_, k - 1, i, late_s);
            const bool turning = std::fabs(w) > 0.5 && std::fabs(last_w) > 0.5 && duty * w > 0 && duty == last_duty;
            if (turning) fit.add({last_w, duty * samples_[k].battery_V, duty > 0 ? 1.0 : -1.0}, w);
        }
        return fit;
    }
    // (3) for the duty in force, whose current is read now: R from the probe at rest, ke from what turns.
    void learn_circuit(std::size_t i, double duty, double w, double current_A) {
        const double volt = duty * battery_V_;
        if (std::fabs(w) < 0.3 && std::fabs(current_A) > 0.02 && volt * current_A > 0) { // 10 steps of the converter
            ohm_[i] = ohm_[i] > 0 ? std::min(ohm_[i], volt / current_A) : volt / current_A;
        } else if (std::fabs(w) > 1 && ohm_[i] > 0) {
            emf_Vs_[i] += 0.3 * (std::max(0.0, (volt - ohm_[i] * current_A) / w) - emf_Vs_[i]);
        }
    }
    double within_torque(std::size_t i, double duty, double w) const {
        if (!(ohm_[i] > 0)) return std::clamp(duty, -probe_duty, probe_duty);
        const double most_A = margin * limits_.torque_Nm / static_cast<double>(config_.motor.torque_constant_Nm_A);
        const double emf = emf_Vs_[i] * w / battery_V_, swing = ohm_[i] * most_A / battery_V_;
        return std::clamp(std::clamp(duty, emf - swing, emf + swing), -1.0, 1.0);
    }

    static constexpr double margin = 0.9;         // what the wheel's speed changes in a tick, and the error of ke
    static constexpr double largest_excess = 1.2; // beyond, (3) does not hold

    const control_config_t &config_;
    const TuneLimits &limits_;
    std::vector<double> plan_; // duty asked for, tick by tick
    std::vector<Sample> samples_;
    sense_state_t sense_{};
    std::array<double, WHEEL_COUNT> ohm_{}, emf_Vs_{};
    std::array<double, WHEEL_COUNT> last_duty_{};
    std::size_t probe_ticks_ = 0; // after these the probe has told in which tick an order acts
    double seen_late_s_ = 0;      // whole ticks of it
    double used_s_ = 0, battery_V_ = 0, largest_Nm_ = 0;
};

} // namespace

TuneResult tune(const hal_t &hal, const control_config_t &config, const TuneLimits &limits) {
    Experiment experiment(config, limits);
    const daemon_result_t run = run_loop(hal, config, experiment);
    if (run.ended_by < 0) throw std::runtime_error("tune: a device was lost");
    if (!experiment.over()) throw std::runtime_error("tune: the rover's loop ended before the experiment did");
    return experiment.result();
}

} // namespace traction
