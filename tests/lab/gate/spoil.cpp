#include "spoil.h"

#include "host_tools/check/check.h"
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/gate.h"
#include "host_tools/rover/rover.h"
#include "host_tools/simulate/simulate.h"
#include "tests/lab/generator/generator.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

namespace traction::gate {

namespace {

constexpr double pi = 3.141592653589793;

bool ends(const std::string &name, const std::string &tail) {
    return name.size() >= tail.size() && name.compare(name.size() - tail.size(), tail.size(), tail) == 0;
}

// Every column whose name begins and ends so.
template <typename Change> void each(log::Log &log, const std::string &start, const std::string &tail, Change &&change) {
    for (log::Signal &s : log.signals)
        if (s.name.rfind(start, 0) == 0 && ends(s.name, tail)) change(s);
}
void scale(log::Log &log, const std::string &start, const std::string &tail, double factor) {
    each(log, start, tail, [&](log::Signal &s) {
        for (double &v : s.value) v *= factor;
    });
}
const char *const motion_columns[] = {".speed_rad_s", ".angle_rad", ".encoder_count"};
void scale_motion(log::Log &log, const std::string &wheel, double factor) {
    for (const char *column : motion_columns) scale(log, wheel, column, factor);
}
void fold(log::Log &log, const std::string &start, const std::string &tail) {
    each(log, start, tail, [](log::Signal &s) {
        for (double &v : s.value) v = std::fabs(v);
    });
}
// The values of wheel order[i] under the name of wheel i.
void reorder(log::Log &log, const std::vector<const char *> &tails, const std::vector<int> &order) {
    const log::Log from = log;
    for (const char *tail : tails)
        for (std::size_t i = 0; i < order.size(); ++i) {
            const std::string to = "wheel" + std::to_string(i) + tail, source = "wheel" + std::to_string(order[i]) + tail;
            for (log::Signal &s : log.signals)
                if (s.name == to)
                    if (const log::Signal *other = from.find(source)) s.t_s = other->t_s, s.value = other->value;
        }
}
void late(log::Log &log, const std::string &start, const std::string &tail, double seconds) {
    each(log, start, tail, [&](log::Signal &s) {
        for (double &t : s.t_s) t += seconds;
    });
}
void keep_rows(log::Log &log, const std::function<bool(double)> &keep) {
    for (log::Signal &s : log.signals) {
        log::Signal kept{s.name, {}, {}};
        for (std::size_t i = 0; i < s.t_s.size(); ++i)
            if (keep(s.t_s[i])) kept.t_s.push_back(s.t_s[i]), kept.value.push_back(s.value[i]);
        s = std::move(kept);
    }
}
void noise(log::Log &log, const std::string &start, const std::string &tail, double sigma) {
    std::mt19937_64 random(7);
    each(log, start, tail, [&](log::Signal &s) {
        for (double &v : s.value) { // sum of twelve uniforms: the same on every library
            double sum = -6;
            for (int i = 0; i < 12; ++i) sum += static_cast<double>(random() >> 11U) * 0x1p-53;
            v += sigma * sum;
        }
    });
}
void hold(log::Log &log, const std::string &start, const std::string &tail, double from_s, double to_s) {
    each(log, start, tail, [&](log::Signal &s) {
        double held = 0;
        bool any = false;
        for (std::size_t i = 0; i < s.t_s.size(); ++i) {
            if (s.t_s[i] < from_s || s.t_s[i] > to_s) continue;
            if (!any) held = s.value[i], any = true;
            s.value[i] = held;
        }
    });
}
void clip(log::Log &log, const std::string &start, const std::string &tail, double limit) {
    each(log, start, tail, [&](log::Signal &s) {
        for (double &v : s.value) v = std::clamp(v, -limit, limit);
    });
}
void reverse_values(log::Log &log, const std::string &start, const std::string &tail) {
    each(log, start, tail, [](log::Signal &s) { std::reverse(s.value.begin(), s.value.end()); });
}
void wrap(log::Log &log, const std::string &tail, double period) {
    each(log, "wheel", tail, [&](log::Signal &s) {
        for (double &v : s.value) v -= period * std::floor(v / period);
    });
}
void stretch(log::Log &log, double factor) {
    for (log::Signal &s : log.signals)
        for (double &t : s.t_s) t *= factor;
}
void erase(log::Log &log, const std::string &start, const std::string &tail) {
    std::erase_if(log.signals, [&](const log::Signal &s) { return s.name.rfind(start, 0) == 0 && ends(s.name, tail); });
}

} // namespace

const std::vector<Row> &spoilt_logs() {
    using log::Log;
    static const std::vector<Row> rows = {
        {"speeds in rpm", [](Log &l) { scale_motion(l, "wheel", 30 / pi); }},
        {"speeds in deg/s", [](Log &l) { scale_motion(l, "wheel", 180 / pi); }},
        {"one speed in rpm", [](Log &l) { scale_motion(l, "wheel2", 30 / pi); }},
        {"one encoder negated", [](Log &l) { scale_motion(l, "wheel1", -1); }},
        {"all encoders negated", [](Log &l) { scale_motion(l, "wheel", -1); }},
        {"counts x 4", [](Log &l) { scale_motion(l, "wheel", 4); }},
        {"counts x 4 of one wheel", [](Log &l) { scale_motion(l, "wheel3", 4); }},
        {"counts halved", [](Log &l) { scale_motion(l, "wheel", 0.5); }},
        {"counts x 1.45", [](Log &l) { scale_motion(l, "wheel", 1.45); }},
        {"one motor mounted the other way", [](Log &l) { scale_motion(l, "wheel1", -1), scale(l, "wheel1", ".current_A", -1), scale(l, "wheel1", ".duty", -1); }},
        {"currents in mA", [](Log &l) { scale(l, "wheel", ".current_A", 1000); }},
        {"one current in mA", [](Log &l) { scale(l, "wheel3", ".current_A", 1000); }},
        {"one current negated", [](Log &l) { scale(l, "wheel1", ".current_A", -1); }},
        {"all currents negated", [](Log &l) { scale(l, "wheel", ".current_A", -1); }},
        {"currents as magnitudes", [](Log &l) { fold(l, "wheel", ".current_A"); }},
        {"one current as a magnitude", [](Log &l) { fold(l, "wheel2", ".current_A"); }},
        {"currents x 5", [](Log &l) { scale(l, "wheel", ".current_A", 5); }},
        {"currents / 5", [](Log &l) { scale(l, "wheel", ".current_A", 0.2); }},
        {"one current x 3", [](Log &l) { scale(l, "wheel0", ".current_A", 3); }},
        {"one current dead", [](Log &l) { scale(l, "wheel2", ".current_A", 0); }},
        {"one current stands for half the drive", [](Log &l) { hold(l, "wheel2", ".current_A", 20, 50); }},
        {"one encoder stands for a quarter of the drive",
         [](Log &l) {
             for (const char *column : motion_columns) hold(l, "wheel2", column, 20, 35);
         }},
        {"currents of two wheels exchanged", [](Log &l) { reorder(l, {".current_A"}, {3, 1, 2, 0}); }},
        {"currents round a ring", [](Log &l) { reorder(l, {".current_A"}, {1, 2, 3, 0}); }},
        {"duties of two wheels exchanged", [](Log &l) { reorder(l, {".duty"}, {2, 1, 0, 3}); }},
        {"duties round a ring", [](Log &l) { reorder(l, {".duty"}, {3, 0, 1, 2}); }},
        {"speeds of two wheels exchanged", [](Log &l) { reorder(l, {".speed_rad_s", ".angle_rad", ".encoder_count"}, {0, 2, 1, 3}); }},
        {"speeds round a ring", [](Log &l) { reorder(l, {".speed_rad_s", ".angle_rad", ".encoder_count"}, {2, 0, 3, 1}); }},
        {"left and right exchanged",
         [](Log &l) { reorder(l, {".speed_rad_s", ".angle_rad", ".encoder_count", ".current_A", ".duty"}, {1, 0, 3, 2}); }},
        {"duty in percent", [](Log &l) { scale(l, "wheel", ".duty", 100); }},
        {"duty of 8 bits", [](Log &l) { scale(l, "wheel", ".duty", 255); }},
        {"duties negated", [](Log &l) { scale(l, "wheel", ".duty", -1); }},
        {"one duty negated", [](Log &l) { scale(l, "wheel0", ".duty", -1); }},
        {"duties as magnitudes", [](Log &l) { fold(l, "wheel", ".duty"); }},
        {"battery in mV", [](Log &l) { scale(l, "battery", "_V", 1000); }},
        {"battery halved", [](Log &l) { scale(l, "battery", "_V", 0.5); }},
        {"battery doubled", [](Log &l) { scale(l, "battery", "_V", 2); }},
        {"battery negated", [](Log &l) { scale(l, "battery", "_V", -1); }},
        {"battery in kV", [](Log &l) { scale(l, "battery", "_V", 0.001); }},
        {"clock x 1.1", [](Log &l) { stretch(l, 1.1); }},
        {"clock x 0.8", [](Log &l) { stretch(l, 0.8); }},
        {"clock x 2", [](Log &l) { stretch(l, 2); }},
        {"times in ms", [](Log &l) { stretch(l, 1000); }},
        {"clock jumps by 7 s",
         [](Log &l) {
             for (log::Signal &s : l.signals)
                 for (double &t : s.t_s) t += t > 20 ? 7 : 0;
         }},
        {"currents 0.5 s late", [](Log &l) { late(l, "wheel", ".current_A", 0.5); }},
        {"duties 0.5 s late", [](Log &l) { late(l, "wheel", ".duty", 0.5); }},
        {"one current 0.7 s early", [](Log &l) { late(l, "wheel3", ".current_A", -0.7); }},
        {"wheels 1 s late",
         [](Log &l) {
             for (const char *column : motion_columns) late(l, "wheel", column, 1);
         }},
        {"camera 1.2 s late", [](Log &l) { late(l, "camera", "", 1.2); }},
        {"gyro in deg/s", [](Log &l) { scale(l, "imu.gyro_z", "_rad_s", 180 / pi); }},
        {"gyro negated", [](Log &l) { scale(l, "imu.gyro_z", "_rad_s", -1); }},
        {"gyro 1.2 s late", [](Log &l) { late(l, "imu.gyro_z", "_rad_s", 1.2); }},
        {"gyro clipped", [](Log &l) { clip(l, "imu.gyro_z", "_rad_s", 0.15); }},
        {"accelerometer in g", [](Log &l) { scale(l, "imu.accel_x", "_m_s2", 1 / 9.80665); }},
        {"accelerometer in mg", [](Log &l) { scale(l, "imu.accel_x", "_m_s2", 1000 / 9.80665); }},
        {"accelerometer negated", [](Log &l) { scale(l, "imu.accel_x", "_m_s2", -1); }},
        {"vertical acceleration logged",
         [](Log &l) {
             scale(l, "imu.accel_x", "_m_s2", 0.1);
             each(l, "imu.accel_x", "_m_s2", [](log::Signal &s) {
                 for (double &v : s.value) v += 9.81;
             });
         }},
        {"accelerometer dead", [](Log &l) { scale(l, "imu.accel_x", "_m_s2", 0); }},
        {"accelerometer backwards in time", [](Log &l) { reverse_values(l, "imu.accel_x", "_m_s2"); }},
        {"radar negated", [](Log &l) { scale(l, "radar.speed", "_m_s", -1); }},
        {"radar in cm/s", [](Log &l) { scale(l, "radar.speed", "_m_s", 100); }},
        {"radar in km/h", [](Log &l) { scale(l, "radar.speed", "_m_s", 3.6); }},
        {"radar backwards in time", [](Log &l) { reverse_values(l, "radar.speed", "_m_s"); }},
        {"camera in mm", [](Log &l) { scale(l, "camera", "_m", 1000); }},
        {"camera mirrored", [](Log &l) { scale(l, "camera.y", "_m", -1); }},
        {"camera's heading in degrees", [](Log &l) { scale(l, "camera.yaw", "_rad", 180 / pi); }},
        {"camera's heading turned by 1 rad",
         [](Log &l) {
             each(l, "camera.yaw", "_rad", [](log::Signal &s) {
                 for (double &v : s.value) v += 1;
             });
         }},
        {"camera's heading negated", [](Log &l) { scale(l, "camera.yaw", "_rad", -1); }},
        {"camera stands for half the drive",
         [](Log &l) { hold(l, "camera", "_m", 20, 50), hold(l, "camera", "_rad", 20, 50); }},
        {"a third of the rows lost",
         [](Log &l) { keep_rows(l, [](double t) { return (static_cast<std::uint64_t>(std::llround(t * 100)) * 2654435761U >> 7U) % 10 > 2; }); }},
        {"one row", [](Log &l) { keep_rows(l, [](double t) { return t >= 30 && t < 30.005; }); }},
        {"a third of a second", [](Log &l) { keep_rows(l, [](double t) { return t >= 30 && t < 30.3; }); }},
        {"standing still", [](Log &l) { keep_rows(l, [](double t) { return t < 1.5; }); }},
        {"currents drowned in noise", [](Log &l) { noise(l, "wheel", ".current_A", 200); }},
        {"everything drowned in noise",
         [](Log &l) {
             noise(l, "wheel", ".current_A", 200), noise(l, "imu", "", 400), noise(l, "camera", "_m", 20), noise(l, "radar.speed", "_m_s", 100);
         }},
        {"currents clipped", [](Log &l) { clip(l, "wheel", ".current_A", 0.25); }},
        {"angles start again with every turn",
         [](Log &l) { wrap(l, ".angle_rad", 2 * pi), wrap(l, ".encoder_count", 6000), erase(l, "wheel", ".speed_rad_s"); }},
        {"counters of 12 bits", [](Log &l) { wrap(l, ".encoder_count", 4096), wrap(l, ".angle_rad", 4.29), erase(l, "wheel", ".speed_rad_s"); }},
        {"counters reset half-way",
         [](Log &l) {
             for (const char *tail : {".encoder_count", ".angle_rad"})
                 each(l, "wheel", tail, [](log::Signal &s) {
                     const auto half = s.value.size() / 2;
                     const double at = s.value[half] + (ends(s.name, "count") ? 40000 : 42);
                     for (std::size_t i = half; i < s.value.size(); ++i) s.value[i] -= at;
                 });
             erase(l, "wheel", ".speed_rad_s");
         }},
        {"currents backwards in time", [](Log &l) { reverse_values(l, "wheel", ".current_A"); }},
        {"duties backwards in time", [](Log &l) { reverse_values(l, "wheel", ".duty"); }},
        {"wheels backwards in time",
         [](Log &l) {
             for (const char *column : motion_columns) reverse_values(l, "wheel", column);
         }},
        {"everything backwards in time", [](Log &l) { reverse_values(l, "", ""); }},
    };
    return rows;
}

const std::vector<Row> &wrong_models() {
    using lab::Model;
    const auto motor = [](const char *key, double factor) {
        return [=](Model &m) {
            for (lab::WheelSpec &w : m.wheel) {
                if (w.motor.count(key) == 0) continue;
                lab::Parameter &p = w.motor.at(key);
                p.value *= factor, p.prior *= factor;
            }
        };
    };
    const auto geometry = [](const char *key, double factor) {
        return [=](Model &m) {
            for (lab::WheelSpec &w : m.wheel) w.geometry.at(key).value *= factor, w.geometry.at(key).prior *= factor;
        };
    };
    const auto soil = [](const char *key, double value) {
        return [=](Model &m) {
            for (lab::WheelSpec &w : m.wheel) w.soil.at(key).value = value;
        };
    };
    const auto rover = [](const char *key, double factor) {
        return [=](Model &m) { m.rover.at(key).value *= factor, m.rover.at(key).prior *= factor; };
    };
    static const std::vector<Row> rows = {
        {"mass x 2", {}, rover("mass_kg", 2)},
        {"mass x 5", {}, rover("mass_kg", 5)},
        {"mass / 3", {}, rover("mass_kg", 1.0 / 3)},
        {"mass in g", {}, rover("mass_kg", 1000)},
        {"radius x 2", {}, geometry("radius_m", 2)},
        {"radius / 2", {}, geometry("radius_m", 0.5)},
        {"radius x 1.4", {}, geometry("radius_m", 1.4)},
        {"radius is the diameter's in mm / 50", {}, geometry("radius_m", 20)},
        {"torque constant x 2", {}, motor("torque_constant_Nm_A", 2)},
        {"torque constant / 3", {}, motor("torque_constant_Nm_A", 1.0 / 3)},
        {"torque constant of the motor's side of the gear", {}, motor("torque_constant_Nm_A", 0.02)},
        {"resistance x 5", {}, motor("resistance_ohm", 5)},
        {"resistance / 5", {}, motor("resistance_ohm", 0.2)},
        {"inertia x 30", {}, motor("inertia_kg_m2", 30)},
        {"friction x 20", {}, motor("coulomb_Nm", 20)},
        {"counts of half a turn",
         {},
         [](Model &m) { m.sensors["encoder.counts_per_turn"].value *= 2, m.sensors["encoder.counts_per_turn"].given = true; }},
        {"counts of the motor's turn",
         {},
         [](Model &m) { m.sensors["encoder.counts_per_turn"].value /= 50, m.sensors["encoder.counts_per_turn"].given = true; }},
        {"ground without grip", {}, soil("mu", 0.05)},
        {"ground that resists with half the weight", {}, soil("rolling_coefficient", 0.5)},
        {"left and right exchanged",
         {},
         [](Model &m) {
             for (lab::WheelSpec &w : m.wheel) w.geometry.at("y_m").value *= -1;
         }},
        {"one wheel of four", {}, [](Model &m) { m.wheel.resize(1); }},
        {"another robot", {}, [](Model &m) { m = lab::read_model("models/robotino.toml"); }},
        {"a rover twenty times as heavy",
         {},
         [](Model &m) { m = lab::parse_model(traction::model_text(sim::read_rover_file("rovers/heavy.toml"), "sand"), "heavy"); }},
    };
    return rows;
}

std::vector<std::string> base_names() { return {"plant", "angle", "counts"}; }

Base base(const std::string &name, double duration_s) {
    Base out;
    out.name = name;
    if (name == "counts") {
        generator::GeneratorConfig config;
        config.soil = generator::Soil::concrete;
        config.seed = 31;
        config.duration_s = duration_s;
        out.log = generator::generate(config);
        out.model = lab::read_model("tests/lab/campaign/machine_concrete.toml");
        return out;
    }
    sim::Scenario scenario = sim::read_scenario("scenarios/identification.toml");
    scenario.duration_s = std::min(scenario.duration_s, duration_s);
    SimulateOptions options;
    options.seed = 5;
    out.log = simulate(scenario, options).log;
    out.model = lab::read_model("models/rover_sand.toml");
    if (name != "angle") return out;
    erase(out.log, "wheel", ".speed_rad_s");
    for (log::Signal &s : out.log.signals) {
        if (!ends(s.name, ".encoder_count")) continue;
        s.name = s.name.substr(0, s.name.find('.')) + ".angle_rad";
        for (double &v : s.value) v *= 2 * pi / 6000;
    }
    return out;
}

Outcome judge(const Base &sound, const Row &row, bool check_only) {
    log::Log log = sound.log;
    lab::Model model = sound.model;
    if (row.spoil) row.spoil(log);
    if (row.mistake) row.mistake(model);
    // a model's encoder says nothing of a log that has angles
    const bool counts = log.find("wheel0.encoder_count") != nullptr;
    bool changed = row.mistake && (counts || row.name.rfind("counts", 0) != 0);
    for (std::size_t i = 0; i < log.signals.size() && !changed; ++i)
        changed = log.signals.size() != sound.log.signals.size() || log.signals[i].value != sound.log.signals[i].value ||
                  log.signals[i].t_s != sound.log.signals[i].t_s;
    if (!changed) return {"does not apply", ""};
    for (log::Signal &s : log.signals) { // as the reader orders a file
        if (std::is_sorted(s.t_s.begin(), s.t_s.end())) continue;
        std::reverse(s.t_s.begin(), s.t_s.end()), std::reverse(s.value.begin(), s.value.end());
    }
    const check::Report report = check::check(log, {}, lab::machine_of(model));
    if (!report.passed()) {
        std::string ids;
        for (const check::Finding &f : report.findings)
            if (f.severity == check::Severity::error) ids += (ids.empty() ? "" : ", ") + f.id + " [" + f.signal + "]";
        return {"refused", ids};
    }
    if (check_only) return {"passed", ""};
    const lab::Diagnosis d = lab::diagnose(model, lab::make_dataset(model, log), {});
    std::string names;
    for (const std::string &effect : d.effects) names += (names.empty() ? "" : ", ") + effect;
    if (d.kind == "wrong_model") return {"wrong_model", d.text};
    if (!names.empty()) return {"named", names};
    if (d.unknown) return {"unknown", d.text};
    return {"nothing", d.text};
}

Sound sound_log(std::uint64_t seed, double duration_s) {
    std::mt19937_64 random(seed);
    const auto pick = [&](std::uint64_t n) { return random() % n; };
    Sound out;
    out.about = "seed " + std::to_string(seed) + ": ";
    if (pick(3) == 0) { // the independent rover, blind: one effect, two, none, or a law of no catalogue
        generator::BlindCase blind = generator::draw_case(seed, duration_s);
        static const char *const drives[] = {"full", "full", "cruise", "stairs", "sweep"};
        blind.config.drive = drives[pick(5)];
        blind.config.camera = pick(4) != 0, blind.config.radar = pick(4) != 0, blind.config.battery = pick(5) != 0;
        out.log = generator::generate(blind.config);
        const std::string soil = generator::name_of(blind.config.soil);
        out.model = lab::read_model("tests/lab/campaign/machine_" + soil + ".toml");
        out.about += "independent, " + soil + ", " + blind.config.drive + ", " + blind.category;
        for (const auto &hidden : blind.config.hidden) out.about += " " + hidden.name;
    } else {
        static const char *const files[] = {"identification", "identification",       "identification",
                                            "cruise",         "sweep_sand",           "sweep_gravel",
                                            "sweep_concrete", "fig16_blocked_wheels", "fig17_slip_servo_sand"};
        const std::string file = files[pick(9)];
        sim::Scenario scenario = sim::read_scenario("scenarios/" + file + ".toml");
        scenario.duration_s = std::min(scenario.duration_s, duration_s);
        std::string soil = scenario.text.find("gravel") != std::string::npos     ? "gravel"
                           : scenario.text.find("concrete") != std::string::npos ? "concrete"
                                                                                 : "sand";
        if (file == "identification" || file == "cruise") {
            static const char *const soils[] = {"sand", "gravel", "concrete"};
            const std::string other = soils[pick(3)];
            std::string text = scenario.text;
            if (const auto at = text.find("soil = \"" + soil + "\""); at != std::string::npos) {
                text.replace(at, 9 + soil.size(), "soil = \"" + other + "\"");
                scenario = sim::parse_scenario(text, file);
                scenario.duration_s = std::min(scenario.duration_s, duration_s);
                soil = other;
            }
        }
        const bool heavy = pick(3) == 0;
        const sim::RoverDescription rover = sim::read_rover_file(heavy ? "rovers/heavy.toml" : "rovers/lhomme_desages.toml");
        if (heavy) sim::set_rover(scenario, rover);
        const double grain[] = {0.3, 1, 1, 3};
        const double coarse = grain[pick(4)];
        for (auto &c : scenario.sensors.current) c.noise *= coarse;
        scenario.sensors.gyro.noise *= coarse, scenario.sensors.accel.noise *= coarse, scenario.sensors.camera.noise_m *= coarse;
        SimulateOptions options;
        options.seed = seed;
        static const char *const effects[] = {"",
                                              "",
                                              "slip_sinkage",
                                              "wheel_radius",
                                              "current_gain",
                                              "wiring_resistance",
                                              "body_drag",
                                              "backlash",
                                              "radar_scale",
                                              "voltage_gain",
                                              "camera_delay",
                                              "actuation_delay",
                                              "encoder_missed",
                                              "thermal",
                                              "slope",
                                              "camera_scale"};
        const std::string effect = effects[pick(16)];
        if (!effect.empty() && sim::find_effect(effect) != nullptr) options.effects.push_back(sim::parse_effect(effect));
        out.log = simulate(scenario, options).log;
        out.model = lab::parse_model(traction::model_text(rover, soil), "model");
        out.about += file + ", " + soil + (heavy ? ", heavy" : "") + ", noise x " + std::to_string(coarse).substr(0, 3) + " " + effect;
    }
    const std::uint64_t logged = pick(4);
    if (logged == 1) { // angles alone
        const double rad = 2 * pi / out.model.sensors.at("encoder.counts_per_turn").value;
        for (log::Signal &s : out.log.signals) {
            if (!ends(s.name, ".encoder_count")) continue;
            const int wheel = s.name[5] - '0';
            const auto sign = out.log.header.find("firmware.encoder_sign_" + std::to_string(wheel));
            const double turn = sign != out.log.header.end() && sign->second == "-1" ? -rad : rad;
            s.name = s.name.substr(0, s.name.find('.')) + ".angle_rad";
            for (double &v : s.value) v *= turn;
        }
        erase(out.log, "wheel", ".speed_rad_s");
        out.about += ", angles alone";
    } else if (logged == 2) {
        erase(out.log, "wheel", ".speed_rad_s");
        out.about += ", counts alone";
    }
    if (pick(6) == 0) erase(out.log, "imu", ""), out.about += ", no imu";
    return out;
}

} // namespace traction::gate
