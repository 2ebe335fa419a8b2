// Loops of one's own: the simulated world tick by tick, and the rover's firmware as one pure step whose state the object owns.
#include "scenario.h"

#include "firmware/core/control.h"
#include "hal/sim/plan_operator.h"
#include "hal/sim/sim_rover.h"
#include "host_tools/rover/rover.h"

#include <cstdint>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <optional>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <type_traits>

namespace traction::python {

namespace {

template <typename T> nb::bytes bytes_of(const T &value) { return nb::bytes(reinterpret_cast<const char *>(&value), sizeof value); }

template <typename T> void from_bytes(T &value, const nb::bytes &bytes) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (bytes.size() != sizeof value) throw nb::value_error("this was pickled by another build of the firmware; make it again");
    std::memcpy(&value, bytes.c_str(), sizeof value);
}

// A view of four numbers of a struct that `owner` holds; `apart` in elements.
template <typename T> nb::ndarray<nb::numpy, T, nb::ndim<1>> four(T *first, const nb::handle &owner, std::int64_t apart = 1) {
    const std::size_t shape[1] = {WHEEL_COUNT};
    return nb::ndarray<nb::numpy, T, nb::ndim<1>>(first, 1, shape, owner, &apart);
}

template <typename Struct, typename T, std::size_t N> auto get_array(T (Struct::*member)[N]) {
    return [member](nb::handle self) {
        const std::size_t shape[1] = {N};
        return nb::ndarray<nb::numpy, T, nb::ndim<1>>(nb::cast<Struct &>(self).*member, 1, shape, self);
    };
}

template <typename Struct, typename T, std::size_t N> auto set_array(T (Struct::*member)[N]) {
    return [member](Struct &self, const std::array<T, N> &values) {
        for (std::size_t i = 0; i < N; i++) (self.*member)[i] = values[i];
    };
}

template <typename T> void pickles(nb::class_<T> &type) {
    type.def("__getstate__", [](const T &self) { return bytes_of(self); });
    type.def("__setstate__", [](T &self, const nb::bytes &bytes) {
        new (&self) T{};
        from_bytes(self, bytes);
    });
}

void bind_frame(nb::module_ &m) {
    nb::class_<sensor_frame_t> frame(
        m, "Frame",
        "What the devices gave in one tick of 10 ms: raw counts (firmware/core/signals.h). Arrays are views that can be written to.\n\n"
        "Of the wheels, shape (4,): encoder_count int32 (cumulative), current_count uint16, bridge_status uint8. radar_count uint16, "
        "shape\n"
        "(64,), of which radar_samples are filled. present: bits of what was heard; a clear bit's field has no meaning. time_us: clock "
        "[us].");
    frame.def("__init__", [](sensor_frame_t *self) { new (self) sensor_frame_t{}; });
#define FIELD(name) .def_rw(#name, &sensor_frame_t::name)
    frame FIELD(tick) FIELD(elapsed_ticks) FIELD(time_us) FIELD(present) FIELD(battery_count) FIELD(accel_x_count) FIELD(accel_y_count)
        FIELD(accel_z_count) FIELD(gyro_x_count) FIELD(gyro_y_count) FIELD(gyro_z_count) FIELD(radar_sequence) FIELD(radar_samples)
            FIELD(emergency_stop);
#undef FIELD
#define ARRAY(name) .def_prop_rw(#name, get_array(&sensor_frame_t::name), set_array(&sensor_frame_t::name))
    frame ARRAY(encoder_count) ARRAY(current_count) ARRAY(radar_count) ARRAY(bridge_status);
#undef ARRAY
    pickles(frame);
}

void bind_command(nb::module_ &m) {
    nb::class_<command_t> command(m, "Command");
    command.def("__init__", [](command_t *self) { new (self) command_t{}; });
    command.def_prop_rw(
        "mode", [](const command_t &self) { return static_cast<int>(self.mode); },
        [](command_t &self, int mode) {
            if (mode < 0 || mode >= MODE_COUNT) throw nb::value_error("mode: give 0 to 5, of traction.Mode");
            self.mode = static_cast<control_mode_t>(mode);
        });
#define FIELD(name) .def_rw(#name, &command_t::name)
    command FIELD(platform_speed_m_s) FIELD(yaw_rate_rad_s) FIELD(slip_ref) FIELD(slip_wheels) FIELD(age_ticks);
#undef FIELD
#define ARRAY(name) .def_prop_rw(#name, get_array(&command_t::name), set_array(&command_t::name))
    command ARRAY(wheel_speed_rad_s) ARRAY(duty);
#undef ARRAY
    pickles(command);
}

template <auto Member> auto of_wheels() {
    return [](nb::handle self) {
        static_assert(sizeof(wheel_trace_t) % sizeof(float) == 0);
        return four<const float>(&(nb::cast<trace_t &>(self).wheel[0].*Member), self, sizeof(wheel_trace_t) / sizeof(float));
    };
}

template <auto Member> auto flags_of_wheels() {
    return [](const trace_t &self) {
        std::array<bool, WHEEL_COUNT> out{};
        for (std::size_t i = 0; i < WHEEL_COUNT; i++) out[i] = self.wheel[i].*Member;
        return out;
    };
}

void bind_trace(nb::module_ &m) {
    nb::class_<trace_t> trace(
        m, "Trace",
        "What one tick came to (firmware/core/signals.h). Of the wheels, float32, shape (4,), read-only views: wheel_speed_rad_s,\n"
        "wheel_accel_rad_s2, set_speed_rad_s, current_A, torque_Nm, traction_N, slip, slip_std, duty; slip_valid, saturated: four bools.\n"
        "Of the rover: speed_m_s and speed_std_m_s (fused ground speed), radar_speed_m_s, accel_x_m_s2, accel_bias_m_s2, gyro_z_rad_s,\n"
        "battery_voltage_V, standstill, mode in force, faults (bits, latched), fault_wheels (bits).");
#define FIELD(name) .def_ro(#name, &trace_t::name)
    trace FIELD(tick) FIELD(faults) FIELD(fault_wheels) FIELD(present) FIELD(battery_voltage_V) FIELD(accel_x_m_s2) FIELD(gyro_z_rad_s)
        FIELD(radar_speed_m_s) FIELD(radar_fresh) FIELD(speed_m_s) FIELD(speed_std_m_s) FIELD(accel_bias_m_s2) FIELD(standstill);
#undef FIELD
    trace.def_prop_ro("mode", [](const trace_t &self) { return static_cast<int>(self.mode); });
#define WHEELS(name, member) .def_prop_ro(#name, of_wheels<&wheel_trace_t::member>())
    trace WHEELS(wheel_speed_rad_s, speed_rad_s) WHEELS(wheel_accel_rad_s2, accel_rad_s2) WHEELS(set_speed_rad_s, set_speed_rad_s)
        WHEELS(current_A, current_A) WHEELS(torque_Nm, torque_Nm) WHEELS(traction_N, traction_N) WHEELS(slip, slip)
            WHEELS(slip_std, slip_std) WHEELS(duty, duty);
#undef WHEELS
    trace.def_prop_ro("slip_valid", flags_of_wheels<&wheel_trace_t::slip_valid>())
        .def_prop_ro("saturated", flags_of_wheels<&wheel_trace_t::saturated>());
    pickles(trace);
}

// The firmware of one rover: configuration and state are this object's, so that it can be copied, pickled and run beside others.
class Firmware {
  public:
    Firmware() = default;
    explicit Firmware(const control_config_t &config) : config_(config), beam_(std::make_unique<doppler_template_t>(*config.doppler.beam)) {
        config_.doppler.beam = beam_.get();
        control_reset(&config_, &state_);
    }
    trace_t step(const sensor_frame_t &frame, const command_t &command) { return control_step(&config_, &state_, &command, &frame); }
    void reset() { control_reset(&config_, &state_); }
    nb::tuple get() const {
        control_config_t config = config_;
        config.doppler.beam = nullptr;
        return nb::make_tuple(bytes_of(config), bytes_of(*beam_), bytes_of(state_));
    }
    void set(const nb::tuple &parts) {
        beam_ = std::make_unique<doppler_template_t>();
        from_bytes(config_, nb::cast<nb::bytes>(parts[0]));
        from_bytes(*beam_, nb::cast<nb::bytes>(parts[1]));
        from_bytes(state_, nb::cast<nb::bytes>(parts[2]));
        config_.doppler.beam = beam_.get();
    }
    double wheel_radius_m() const { return static_cast<double>(config_.geometry.wheel_radius_m); }

  private:
    control_config_t config_{};
    std::unique_ptr<doppler_template_t> beam_;
    control_state_t state_{};
};

// The world of a scenario: plant, sensors, late orders, failing sensors. It does not end with the scenario's duration.
class Plant {
  public:
    Plant(const ScenarioData &given, std::optional<std::uint64_t> seed, const std::vector<std::string> &effects)
        : scenario_(given.scenario), seed_(seed.value_or(given.scenario.seed)), plan_(scenario_) {
        for (const std::string &text : effects) scenario_.effects.push_back(sim::parse_effect(text));
        const std::vector<sim::ActiveEffect> all = hal::effects_of(scenario_);
        hal::SimHalConfig world = hal::world_of(scenario_, all, seed_);
        world.ticks = std::numeric_limits<std::uint32_t>::max();
        rover_ = std::make_unique<hal::SimRover>(scenario_, all, world);
        hal_ = rover_->hal();
        hal_open_devices(&hal_);
    }
    Plant(const Plant &) = delete;
    Plant &operator=(const Plant &) = delete;

    sensor_frame_t step(double dt_s) {
        const double ticks = std::nearbyint(dt_s * 100);
        if (!(ticks >= 1) || std::fabs(dt_s * 100 - ticks) > 1e-6 || ticks > 1e6)
            throw nb::value_error("dt_s: the world is heard every 10 ms; give a multiple of 0.01 s");
        sensor_frame_t frame{};
        for (double i = 0; i < ticks; i++) {
            if (hal_.wait_tick(hal_.context) == HAL_END) throw std::runtime_error("the plant has run for 2^32 ticks");
        }
        const hal_result_t read = hal_.read(hal_.context, &frame);
        if (read == HAL_ERR_IO) throw std::runtime_error("a device of the simulated rover is lost");
        return frame;
    }
    void write(const actuator_frame_t &actuator) {
        if (hal_.write(hal_.context, &actuator) == HAL_ERR_IO) throw std::runtime_error("the bridges of the simulated rover are lost");
        sequence_ = actuator.sequence;
    }
    void set_duty(const std::array<double, WHEEL_COUNT> &duty) {
        actuator_frame_t actuator{.sequence = sequence_ + 1, .drive = DRIVE_ON, .duty_q15 = {}, .status_led = false};
        for (std::size_t i = 0; i < WHEEL_COUNT; i++) {
            const double d = std::isfinite(duty[i]) ? std::fmin(1, std::fmax(-1, duty[i])) : 0;
            actuator.duty_q15[i] = static_cast<std::int16_t>(std::nearbyint(d * 32767));
        }
        write(actuator);
    }
    const sim::Truth &truth() const { return rover_->world().truth(); }
    command_t planned(std::uint32_t tick) { return plan_.command_at(tick); }
    std::uint64_t seed() const { return seed_; }

  private:
    sim::Scenario scenario_;
    std::uint64_t seed_;
    hal::PlanOperator plan_;
    std::unique_ptr<hal::SimRover> rover_;
    hal_t hal_{};
    std::uint32_t sequence_ = 0;
};

template <auto Member> auto truth_of_wheels() {
    return [](const Plant &self) {
        std::array<double, sim::wheel_count> out{};
        for (std::size_t i = 0; i < out.size(); i++) out[i] = self.truth().wheel[i].*Member;
        return out;
    };
}

} // namespace

void bind_loop(nb::module_ &m) {
    bind_frame(m);
    bind_command(m);
    bind_trace(m);
    nb::class_<Firmware>(m, "FirmwareCore")
        .def("__init__", [](Firmware *self, const ScenarioData &scenario,
                            const std::string &config) { new (self) Firmware(firmware_of(scenario.scenario, config)); })
        .def("__init__", [](Firmware *self, const RoverData &rover) { new (self) Firmware(firmware_config(rover.rover)); })
        .def("step", &Firmware::step, nb::arg("frame"), nb::arg("command"))
        .def("reset", &Firmware::reset)
        .def_prop_ro("wheel_radius_m", &Firmware::wheel_radius_m)
        .def("__getstate__", &Firmware::get)
        .def("__setstate__", [](Firmware &self, const nb::tuple &parts) {
            new (&self) Firmware();
            self.set(parts);
        });
    nb::class_<Plant>(m, "PlantCore")
        .def(nb::init<const ScenarioData &, std::optional<std::uint64_t>, const std::vector<std::string> &>(), nb::arg("scenario"),
             nb::arg("seed").none(), nb::arg("effects"))
        .def("step", &Plant::step, nb::arg("dt_s"))
        .def("write", [](Plant &self, const trace_t &trace) { self.write(trace.actuator); })
        .def("set_duty", &Plant::set_duty)
        .def("planned", &Plant::planned)
        .def_prop_ro("seed", &Plant::seed)
        .def_prop_ro("t_s", [](const Plant &self) { return self.truth().t_s; })
        .def_prop_ro("position_m", [](const Plant &self) { return self.truth().position_m; })
        .def_prop_ro("v_body_m_s", [](const Plant &self) { return self.truth().v_body_m_s; })
        .def_prop_ro("yaw_rad", [](const Plant &self) { return self.truth().yaw_rad; })
        .def_prop_ro("battery_voltage_V", [](const Plant &self) { return self.truth().battery_voltage_V; })
        .def_prop_ro("wheel_speed_rad_s", truth_of_wheels<&sim::WheelTruth::speed_rad_s>())
        .def_prop_ro("wheel_slip", truth_of_wheels<&sim::WheelTruth::slip>())
        .def_prop_ro("wheel_current_A", truth_of_wheels<&sim::WheelTruth::current_A>())
        .def_prop_ro("wheel_traction_N", truth_of_wheels<&sim::WheelTruth::traction_N>())
        .def_prop_ro("wheel_sinkage_m", truth_of_wheels<&sim::WheelTruth::sinkage_m>());
}

} // namespace traction::python
