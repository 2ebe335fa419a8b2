// lab_generate - writes a log of the independent rover: with chosen effects, or sealed (--blind: what is hidden goes to --seal alone).
#include "generator.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

namespace {

using namespace traction;
using namespace traction::generator;

nlohmann::json seal_of(const BlindCase &blind) {
    nlohmann::json seal = {{"schema", "traction.seal/1"}, {"category", blind.category}, {"soil", name_of(blind.config.soil)},
                           {"seed", blind.config.seed},   {"generator", "independent"}, {"effects", nlohmann::json::array()}};
    const Machine m = machine_of(blind.config);
    seal["machine"] = {{"mass_kg", m.mass},
                       {"radius_m", m.radius},
                       {"torque_constant_Nm_A", m.KG},
                       {"resistance_ohm", m.Ra},
                       {"inertia_kg_m2", m.J},
                       {"viscous_Nms", m.viscous},
                       {"coulomb_Nm", m.coulomb},
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
        nlohmann::json effect = {{"name", setting.name},
                                 {"wheel", setting.wheel},
                                 {"outside", kind->outside},
                                 {"variable", std::string(kind->variable)},
                                 {"parameters", nlohmann::json::object()}};
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
    std::string soil = "sand", out, seal, model;
    std::vector<std::string> effects;
    bool is_blind = false, list = false;
    app.add_option("--soil", soil, "sand, gravel or concrete");
    app.add_option("--effect", effects, "NAME:param=value[,param=value][,wheel=i]; may be given again");
    app.add_option("--seed", blind.config.seed, "machine, drive, ground and noise");
    app.add_option("--noise-seed", blind.config.noise_seed, "the same run with other sensor noise");
    app.add_option("--duration", blind.config.duration_s, "seconds")->check(CLI::Range(1.0, 3600.0));
    app.add_option("--drive", blind.config.drive, "full, cruise, stairs or sweep");
    app.add_flag("--apart", blind.config.apart, "every wheel drawn for itself; without it all wheels of a machine are alike");
    app.add_flag("--exact", blind.config.exact, "nominal machine, even ground");
    app.add_flag("--quiet", blind.config.quiet, "no sensor noise");
    app.add_flag("--truth", blind.config.truth, "add truth.* columns");
    app.add_flag("--blind", is_blind, "draw soil and what is hidden by the seed");
    app.add_option("--seal", seal, "write what is hidden to this JSON file");
    app.add_option("--model", model, "write the operator's data sheet, a model file, here");
    app.add_option("--out", out, "the log (CSV)");
    app.add_flag("--list", list, "list what can be hidden");
    CLI11_PARSE(app, argc, argv);
    if (list) return list_kinds(), 0;
    if (out.empty()) throw std::invalid_argument("--out LOG is missing");
    if (is_blind) {
        const GeneratorConfig asked = blind.config;
        blind = draw_case(asked.seed, asked.duration_s);
        blind.config.noise_seed = asked.noise_seed;
        blind.config.apart = asked.apart;
    } else {
        blind.config.soil = soil_of(soil);
        for (const std::string &effect : effects) blind.config.hidden.push_back(parse_setting(effect));
    }
    if (!model.empty()) write_text(model, data_sheet(blind.config));
    if (!seal.empty()) write_text(seal, seal_of(blind).dump(1));
    log::write_csv(generate(blind.config), out);
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
