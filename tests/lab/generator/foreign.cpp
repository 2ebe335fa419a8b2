// foreign.cpp - the log as a machine of another house writes it, and the map that reads it.
#include "generator.h"

#include <array>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <map>
#include <numbers>
#include <stdexcept>

namespace traction::generator {

namespace {

struct Column {
    std::string name;
    double per_unit; // number in the foreign column = per_unit * value in SI
};

std::string text_of(double value) {
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

// Motors are numbered as they are wired, from 1: one of the orders that an installer may have chosen.
constexpr std::array<std::array<int, wheels>, 4> orders = {{{3, 4, 1, 2}, {1, 3, 2, 4}, {2, 1, 4, 3}, {4, 2, 3, 1}}};

Column column_of(const std::string &signal, const GeneratorConfig &config) {
    if (signal.rfind("wheel", 0) != 0) {
        if (signal == "battery.voltage_V") return {"Ubat_mV", 1000};
        if (signal == "imu.gyro_z_rad_s") return {"yaw_dps", 180 / std::numbers::pi};
        if (signal == "imu.accel_x_m_s2") return {"ax_mg", 1000 / 9.80665};
        return {signal, 1};
    }
    const auto wheel = static_cast<std::size_t>(signal[5] - '0');
    const std::string motor = "M" + std::to_string(orders[config.seed % orders.size()][wheel]), quantity = signal.substr(7);
    const double way = wheel % 2 == 1 ? -1 : 1; // the right motors look the other way
    if (quantity == "current_A") return {motor + "_I_mA", 1000 * way};
    if (quantity == "angle_rad") return {motor + "_pos_deg", 180 / std::numbers::pi * way};
    if (quantity == "encoder_count") return {motor + "_ticks", way};
    if (quantity == "duty") return {motor + "_pwm_permille", 1000 * way};
    if (quantity == "set_speed_rad_s") return {motor + "_set_rpm", 30 / std::numbers::pi * way};
    throw std::invalid_argument("no foreign column for " + signal);
}

void write_text(const std::string &path, const std::string &text) {
    std::ofstream file;
    file.exceptions(std::ios::failbit | std::ios::badbit);
    file.open(path);
    file << text;
    file.close();
}

std::string map_of(const log::Log &log, const GeneratorConfig &config) {
    std::string text = "format = \"traction-map 1\"\n\n[header]\n";
    for (const auto &[key, value] : log.header)
        if (key.rfind("noise.", 0) != 0 && key.rfind("quantum.", 0) != 0) text += "\"" + key + "\" = \"" + value + "\"\n";
    if (const auto relative = log.header.find("noise.radar.speed_m_s.relative"); relative != log.header.end())
        text += "\"" + relative->first + "\" = \"" + relative->second + "\"\n";
    text += "\n[time]\ncolumn = \"time_ms\"\nscale = 0.001\n";
    for (const log::Signal &signal : log.signals) {
        const Column column = column_of(signal.name, config);
        text += "\n[[signal]]\nname = \"" + signal.name + "\"\ncolumn = \"" + column.name + "\"\nscale = " + text_of(1 / column.per_unit) +
                "\n";
        for (const std::string key : {"noise", "quantum"})
            if (const auto found = log.header.find(key + "." + signal.name); found != log.header.end())
                text += key + " = " + found->second + "\n";
    }
    return text;
}

} // namespace

void write_log(const log::Log &log, const GeneratorConfig &config, const std::string &csv, const std::string &map) {
    if (!config.chain.foreign) return log::write_csv(log, csv);
    std::map<double, std::vector<std::pair<std::size_t, double>>> rows; // by time: signal, value
    std::string names = "time_ms";
    std::vector<Column> columns;
    for (std::size_t s = 0; s < log.signals.size(); ++s) {
        columns.push_back(column_of(log.signals[s].name, config));
        names += ";" + columns.back().name;
        for (std::size_t k = 0; k < log.signals[s].t_s.size(); ++k) rows[log.signals[s].t_s[k]].emplace_back(s, log.signals[s].value[k]);
    }
    std::string text = names + "\n";
    for (const auto &[t_s, cells] : rows) {
        char time[32];
        std::snprintf(time, sizeof time, "%.3f", 1000 * t_s);
        text += time;
        std::size_t next = 0;
        for (std::size_t s = 0; s < columns.size(); ++s) {
            text += ';';
            if (next < cells.size() && cells[next].first == s) text += text_of(columns[s].per_unit * cells[next++].second);
        }
        text += '\n';
    }
    write_text(csv, text);
    write_text(map, map_of(log, config));
}

} // namespace traction::generator
