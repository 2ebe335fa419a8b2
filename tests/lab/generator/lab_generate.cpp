// lab_generate - writes a log of the independent rover: with chosen effects, or sealed (--blind: what is hidden goes to --seal alone).
#include "generator.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>

namespace {

using namespace traction;
using namespace traction::generator;

const std::map<std::string, Knee> knees = {
    {"stated", Knee::stated}, {"tanh", Knee::tanh}, {"hyperbola", Knee::hyperbola}, {"magic", Knee::magic}};

nlohmann::json seal_of(const BlindCase &blind) {
    nlohmann::json seal = {{"schema", "traction.seal/1"}, {"category", blind.category}, {"soil", name_of(blind.config.soil)},
                           {"seed", blind.config.seed},   {"generator", "independent"}, {"effects", nlohmann::json::array()}};
    const SensorChain &chain = blind.config.chain;
    seal["size"] = name_of(blind.config.size);
    seal["drive"] = blind.config.drive;
    seal["duration_s"] = blind.config.duration_s;
    seal["chain"] = {{"accel_cutoff_Hz", chain.accel_cutoff_Hz},
                     {"accel_late_s", chain.accel_late_s},
                     {"current_at_end", chain.current_at_end},
                     {"angle_only", chain.angle_only},
                     {"jitter_s", chain.jitter_s},
                     {"foreign", chain.foreign},
                     {"camera", blind.config.camera},
                     {"radar", blind.config.radar}};
    const Habits &habits = blind.config.habits;
    seal["habits"] = {{"tick_s", habits.tick_s}, {"noise", habits.noise}, {"begin_s", habits.begin_s}, {"sag", habits.sag},
                      {"soft", habits.soft},     {"gyro", habits.gyro},   {"accel", habits.accel},     {"battery", blind.config.battery}};
    const Machine m = machine_of(blind.config);
    seal["machine"] = {
        {"mass_kg", m.mass},
        {"radius_m", m.radius},
        {"torque_constant_Nm_A", m.KG},
        {"resistance_ohm", m.Ra},
        {"inertia_kg_m2", m.J},
        {"viscous_Nms", m.viscous},
        {"coulomb_Nm", m.coulomb},
        {"knee", std::find_if(knees.begin(), knees.end(), [&](const auto &k) { return k.second == blind.config.knee; })->first},
        {"mu", m.mu},
        {"shear_slip", m.sc},
        {"rolling_coefficient", m.rolling},
        {"grip_noise", m.grip_noise},
        {"grip_length_m", m.grip_length}};
    if (blind.config.apart)
        seal["machine"]["each"] = {{"torque_constant", m.KG_each},
                                   {"resistance", m.Ra_each},
                                   {"coulomb", m.coulomb_each},
                                   {"viscous", m.viscous_each},
                                   {"radius", m.radius_each}};
    for (const Setting &setting : blind.config.hidden) {
        const Kind *kind = find_kind(setting.name);
        nlohmann::json effect = {{"name", setting.name},          {"wheel", setting.wheel},
                                 {"outside", kind->outside},      {"variable", std::string(kind->variable)},
                                 {"law", std::string(kind->law)}, {"parameters", nlohmann::json::object()}};
        for (const auto &[name, value] : setting.values) effect["parameters"][name] = value;
        seal["effects"].push_back(effect);
    }
    return seal;
}

void write_text(const std::string &path, const std::string &text) {
    std::ofstream file;
    file.exceptions(std::ios::failbit | std::ios::badbit);
    file.open(path + ".part");
    file << text << '\n';
    file.close();
    std::filesystem::rename(path + ".part", path);
}

void list_kinds() {
    for (const Kind &kind : kinds()) {
        std::printf("%s%s\n", std::string(kind.name).c_str(), kind.outside ? "   (outside the catalogue)" : "");
        for (const KindParameter &p : kind.parameters)
            std::printf("    %s  %g to %g%s\n", std::string(p.name).c_str(), p.strength ? p.low : p.choices.front(),
                        p.strength ? p.high : p.choices.back(), p.strength ? "" : "  (shape)");
    }
}

int run(int argc, char **argv) {
    CLI::App app{"Writes a log of a rover that the lab's authors did not model."};
    BlindCase blind;
    blind.category = "chosen";
    std::string soil = "sand", out, seal, model, map, size = "small", category;
    int runs = 1;
    std::vector<std::string> effects;
    bool is_blind = false, is_fleet = false, is_strange = false, is_bent = false, list = false;
    app.add_option("--soil", soil, "sand, gravel, concrete, loam or snow");
    app.add_option("--size", size, "small (2.9 kg), medium (12 kg) or large (60 kg)");
    app.add_option("--effect", effects, "NAME:param=value[,param=value][,wheel=i]; may be given again");
    app.add_option("--seed", blind.config.seed, "machine, drive, ground and noise");
    app.add_option("--noise-seed", blind.config.noise_seed, "the same run with other sensor noise");
    app.add_option("--duration", blind.config.duration_s, "seconds")->check(CLI::Range(1.0, 3600.0));
    app.add_option("--drive", blind.config.drive,
                   "full, cruise, stairs, sweep, mixed, stop_and_go, slow, curves, slopes, spins, shuttle or halt");
    app.add_option("--run", blind.config.run, "another drive of the same machine: other plan, place and noise")->check(CLI::Range(0, 100));
    app.add_option("--accel-cutoff", blind.config.chain.accel_cutoff_Hz, "low pass in the accelerometer [Hz]");
    app.add_option("--accel-late", blind.config.chain.accel_late_s, "age of its samples [s]");
    app.add_option("--jitter", blind.config.chain.jitter_s, "standard deviation of a tick's length [s]");
    Habits &habits = blind.config.habits;
    std::vector<std::string> without;
    app.add_option("--tick", habits.tick_s, "of loop and log [s]")->check(CLI::Range(0.001, 0.1));
    app.add_option("--noise", habits.noise, "of the sensors, over what the header states")->check(CLI::Range(0.0, 100.0));
    app.add_option("--begin", habits.begin_s, "the log begins that late [s]")->check(CLI::Range(0.0, 3600.0));
    app.add_option("--sag", habits.sag, "share of its voltage that the battery loses")->check(CLI::Range(0.0, 0.5));
    app.add_option("--without", without,
                   "a sensor that is not there (heading: the camera's; its track is in a frame of its own); may be given again")
        ->check(CLI::IsMember({"camera", "heading", "radar", "battery", "gyro", "accel"}));
    app.add_flag("--current-at-end", blind.config.chain.current_at_end, "currents sampled once, at the end of the PWM period");
    app.add_flag("--angle-only", blind.config.chain.angle_only, "wheel angles, no counts");
    app.add_flag("--foreign", blind.config.chain.foreign, "a CSV of its own, which --map reads");
    app.add_flag("--apart", blind.config.apart, "every wheel drawn for itself; without it all wheels of a machine are alike");
    app.add_flag("--exact", blind.config.exact, "nominal machine, even ground");
    app.add_flag("--quiet", blind.config.quiet, "no sensor noise");
    app.add_flag("--truth", blind.config.truth, "add truth.* columns");
    app.add_flag("--blind", is_blind, "draw soil and what is hidden by the seed");
    app.add_flag("--fleet", is_fleet, "draw size, soil, sensors, plan, length and what is hidden by the seed");
    app.add_flag("--strange", is_strange, "as --fleet, and habits of another workshop: plans, rates, noise, battery, what is logged");
    app.add_flag("--bent", is_bent, "as --fleet, on grounds whose curve over slip no sheet names");
    app.add_option("--knee", blind.config.knee, "of the ground's curve over slip: stated, tanh, hyperbola or magic")
        ->transform(CLI::CheckedTransformer(knees));
    app.add_option("--category", category, "with --blind or --fleet: clean, one, two or outside instead of drawing it")
        ->check(CLI::IsMember({"clean", "one", "two", "outside"}));
    app.add_option("--map", map, "write the map of a foreign log here (default: OUT.map.toml)");
    app.add_option("--runs", runs, "that many drives of the machine: OUT, OUT.2.csv, ...")->check(CLI::Range(1, 9));
    app.add_option("--seal", seal, "write what is hidden to this JSON file");
    app.add_option("--model", model, "write the operator's data sheet, a model file, here");
    app.add_option("--out", out, "the log (CSV)");
    app.add_flag("--list", list, "list what can be hidden");
    CLI11_PARSE(app, argc, argv);
    if (list) return list_kinds(), 0;
    if (out.empty()) throw std::invalid_argument("--out LOG is missing");
    for (const std::string &sensor : without) {
        GeneratorConfig &c = blind.config;
        (sensor == "camera"    ? c.camera
         : sensor == "radar"   ? c.radar
         : sensor == "battery" ? c.battery
         : sensor == "heading" ? c.habits.heading
         : sensor == "gyro"    ? c.habits.gyro
                               : c.habits.accel) = false;
    }
    if (is_fleet || is_strange || is_bent) {
        const GeneratorConfig asked = blind.config;
        blind = is_strange ? draw_strange_case(asked.seed, category)
                : is_bent  ? draw_bent_case(asked.seed, category)
                           : draw_fleet_case(asked.seed, category);
        blind.config.noise_seed = asked.noise_seed, blind.config.run = asked.run;
    } else if (is_blind) {
        const GeneratorConfig asked = blind.config;
        blind = draw_case(asked.seed, asked.duration_s, category);
        blind.config.noise_seed = asked.noise_seed;
        blind.config.apart = asked.apart;
    } else {
        blind.config.soil = soil_of(soil);
        blind.config.size = size_of(size);
        for (const std::string &effect : effects) blind.config.hidden.push_back(parse_setting(effect));
    }
    if (!model.empty()) write_text(model, data_sheet(blind.config));
    if (!seal.empty()) write_text(seal, seal_of(blind).dump(1));
    if (map.empty()) map = out + ".map.toml";
    write_log(generate(blind.config), blind.config, out, map);
    for (int run = 1; run < runs; ++run) {
        ++blind.config.run;
        const std::string other = out + "." + std::to_string(run + 1) + ".csv";
        write_log(generate(blind.config), blind.config, other, other + ".map.toml");
    }
    return 0;
}

} // namespace

int main(int argc, char **argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "lab_generate: %s\n", error.what());
        return 3;
    }
}
