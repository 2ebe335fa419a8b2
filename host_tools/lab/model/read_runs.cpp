#include "read_runs.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace traction::lab {

namespace {

// What a run may have of its own (physics.cpp: run_keys).
constexpr std::array<std::string_view, 5> of_ground = {"mu", "adhesion_N", "shear_slip", "rolling_coefficient", "lateral_coefficient"};
constexpr std::array<std::string_view, 2> of_sensors = {"accel.bias_m_s2", "gyro.bias_rad_s"};

template <std::size_t n>
void keep_to(const ModelReader &reader, const toml::table &table, const std::string &where, const Parameters &read,
             const std::array<std::string_view, n> &may) {
    std::string names;
    for (const std::string_view name : may) names += (names.empty() ? "" : ", ") + std::string(name);
    for (const auto &[key, p] : read)
        if (std::find(may.begin(), may.end(), key) == may.end())
            reader.fail(table, where + "." + key, "is the machine's, not a run's", "a run may have " + names + " of its own");
}

RunSpec read_run(const ModelReader &reader, const toml::table &table, const std::string &where) {
    RunSpec run;
    run.log = reader.text(table, where, "log", "");
    if (run.log.empty()) reader.fail(table, where + ".log", "is missing", "name the run's log file, without folder");
    for (const auto &[name_key, node] : table) {
        const std::string name(name_key.str());
        if (name == "log" || name == "note") continue;
        const toml::table *inner = node.as_table();
        if ((name != "soil" && name != "sensors") || inner == nullptr)
            reader.fail(node, where + "." + name, "is not known", "a run has log, and the tables soil and sensors");
        if (name == "soil") {
            reader.table(*inner, where + ".soil", soil_keys(), run.soil, {});
            keep_to(reader, *inner, where + ".soil", run.soil, of_ground);
            continue;
        }
        for (const auto &[sensor_key, sensor_node] : *inner) {
            const std::string sensor(sensor_key.str()), path = where + ".sensors." + sensor;
            const toml::table *of_sensor = sensor_node.as_table();
            if (of_sensor == nullptr) reader.fail(sensor_node, path, "is not a table", "write [run.sensors." + sensor + "]");
            reader.table(*of_sensor, path, sensor_keys(), run.sensors, {}, sensor + ".");
        }
        keep_to(reader, *inner, where + ".sensors", run.sensors, of_sensors);
    }
    return run;
}

} // namespace

void read_runs(const ModelReader &reader, const toml::table &root, Model &model) {
    const toml::node *node = root.get("run");
    if (node == nullptr) return;
    const toml::array *runs = node->as_array();
    if (runs == nullptr) reader.fail(*node, "run", "is not a list", "write [[run]] and its keys below");
    for (std::size_t i = 0; i < runs->size(); ++i) {
        const std::string where = "run[" + std::to_string(i) + "]";
        const toml::table *table = (*runs)[i].as_table();
        if (table == nullptr) reader.fail((*runs)[i], where, "is not a table", "write [[run]] and its keys below");
        RunSpec run = read_run(reader, *table, where);
        if (std::any_of(model.runs.begin(), model.runs.end(), [&](const RunSpec &other) { return other.log == run.log; }))
            reader.fail(*table, where + ".log", "\"" + run.log + "\" is there twice", "keep one [[run]] for each log");
        model.runs.push_back(std::move(run));
    }
}

} // namespace traction::lab
