#include "spoil.h"
#include "tamper.h"

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
