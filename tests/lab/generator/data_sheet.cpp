// data_sheet.cpp - what the operator knows of the machine: the model file that is handed to the lab beside the log.
#include "generator.h"

#include <cstdio>

namespace traction::generator {

namespace {

std::string value(const char *key, double value, double relative, const char *source) {
    char line[160];
    std::snprintf(line, sizeof line, "%s = { value = %.6g, prior = %.3g, source = \"%s\" }\n", key, value, relative * value, source);
    return line;
}

} // namespace

std::string data_sheet(const GeneratorConfig &config) {
    const Machine m = nominal(config.soil, config.size);
    const bool apart = config.apart; // a sheet that knows of wheels that differ states what batches of motors and bearings state
    char line[400];
    std::string text = "format = \"traction.model/1\"\nname = \"campaign rover on " + name_of(config.soil) +
                       ", data sheet\"\n\n[rover]\nmotion = \"longitudinal\"\n";
    text += value("mass_kg", m.mass, 0.0035, "weighed");
    text += value("yaw_inertia_kg_m2", m.yaw_inertia, 0.05, "assumed: a plate");
    text += "\n[wheels]\n" + value("radius_m", m.radius, apart ? 0.005 : 0.004, "data sheet");
    std::snprintf(line, sizeof line, "width_m = %.4g\n", 0.74 * m.radius);
    text += line;
    for (int i = 0; i < wheels; ++i) {
        std::snprintf(line, sizeof line, "[[wheel]]\nname = \"%s %s\"\nx_m = %.6g\ny_m = %.6g\n", i < 2 ? "rear" : "front",
                      i % 2 == 0 ? "left" : "right", i < 2 ? -m.half_base : m.half_base, i % 2 == 0 ? m.half_track : -m.half_track);
        text += line;
    }
    text += "\n[motor]\n";
    text += value("torque_constant_Nm_A", m.KG, apart ? 0.02 : 0.0125, "data sheet");
    text += value("resistance_ohm", m.Ra, apart ? 0.05 : 0.02, "data sheet");
    text += value("inertia_kg_m2", m.J, 0.026, "data sheet");
    text += value("viscous_Nms", m.viscous, apart ? 0.15 : 0.03, "measured on a machine of this type");
    text += value("coulomb_Nm", m.coulomb, apart ? 0.15 : 0.03, "measured on a machine of this type");
    text += "\n[soil]\nlaw = \"" + std::string(config.soil == Soil::concrete ? "burckhardt" : "janosi") + "\"\n";
    text += value("mu", m.mu, 0.065, "table");
    text += value("shear_slip", m.sc, 0.11, "table");
    text += value("rolling_coefficient", m.rolling, 0.003 / m.rolling, "assumed");
    std::snprintf(line, sizeof line, "\n[sensors.encoder]\ncounts_per_turn = 6000\n[sensors.current]\nnoise_A = %.4g\n", m.current_noise_A);
    text += line;
    text += "[sensors.accel]\nnoise_m_s2 = 0.2\nbias_m_s2 = { value = 0, prior = 0.05, source = \"data sheet\" }\n[sensors.radar]\n"
            "window_s = 0.5\nminimum_m_s = 0.05\n[sensors.camera]\nnoise_m = 0.001\n";
    return text;
}

} // namespace traction::generator
