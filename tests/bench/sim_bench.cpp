// sim_bench - simulated seconds per CPU second, one core, median of interleaved rounds: the plant alone and end to end (plant,
// sensors, firmware in process, log written), beside ODE's and MuJoCo's contacts and MuJoCo with the same wheel law.
//
// Usage: sim_bench [--rounds N] [--json FILE]. Exit 1 when a goal of the end-to-end runs is missed.
#include "sim_bench_rival.h"

#include "host_tools/log/log.h"
#include "host_tools/log/write_file.h"
#include "host_tools/simulate/simulate.h"
#include "sim/plant/plant.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

using namespace traction;

namespace {

struct Case {
    std::string name;
    double seconds;                  // simulated, each round
    std::function<double()> run;     // CPU seconds
    double goal = 0;                 // 0: none
    std::vector<double> factor = {}; // simulated seconds per CPU second
    double median() const {
        std::vector<double> sorted = factor;
        std::sort(sorted.begin(), sorted.end());
        return sorted[sorted.size() / 2];
    }
};

double plant_alone(double seconds, sim::ContactLaw law) {
    sim::PlantConfig config;
    config.ground.soil = *sim::find_soil("dry_sand_literature");
    config.ground.contact = law;
    sim::Plant plant(config);
    for (int i = 0; i < 4; ++i) plant.set_duty(i, bench::rival_duty);
    const std::clock_t start = std::clock();
    const long steps = static_cast<long>(seconds / config.dt_s);
    for (long k = 0; k < steps; ++k) plant.step();
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

enum class Keep { nothing, log, file };

double end_to_end(sim::Scenario scenario, sim::ContactLaw law, Keep keep) {
    scenario.plant.ground.contact = law;
    SimulateOptions options;
    options.record = keep != Keep::nothing;
    const std::string path = (std::filesystem::temp_directory_path() / ("sim_bench_" + std::to_string(getpid()) + ".csv")).string();
    const std::clock_t start = std::clock();
    const SimulationResult result = simulate(scenario, options);
    if (keep == Keep::file) log::write_csv(result.log, path);
    const double cpu_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    std::filesystem::remove(path);
    return cpu_s;
}

std::vector<Case> cases(const sim::Scenario &scenario) {
    using enum sim::ContactLaw;
    const double s = 20, long_s = scenario.duration_s;
    std::vector<Case> list;
    const auto add = [&list](std::string name, double seconds, std::function<double()> run, double goal = 0) {
        list.push_back({std::move(name), seconds, std::move(run), goal});
    };
    add(
        "end to end, log file written, aggregated law", long_s, [=] { return end_to_end(scenario, aggregated, Keep::file); }, 400);
    add(
        "end to end, log file written, closed law (Bekker)", long_s, [=] { return end_to_end(scenario, bekker, Keep::file); }, 400);
    add(
        "end to end, log file written, arc law", long_s, [=] { return end_to_end(scenario, arc, Keep::file); }, 150);
    add("end to end, log in memory, aggregated law", long_s, [=] { return end_to_end(scenario, aggregated, Keep::log); });
    add("end to end, no log, aggregated law", long_s, [=] { return end_to_end(scenario, aggregated, Keep::nothing); });
    add("plant alone, aggregated law", s, [=] { return plant_alone(s, aggregated); });
    add("plant alone, closed law (Bekker)", s, [=] { return plant_alone(s, bekker); });
    add("plant alone, arc law", s, [=] { return plant_alone(s, arc); });
    add("ODE contacts, six bodies", s, [=] { return bench::ode_contacts(s).cpu_s; });
#if TRACTION_HAVE_MUJOCO
    add("MuJoCo, same law applied, aggregated", s, [=] { return bench::mujoco_forces(s, aggregated).cpu_s; });
    add("MuJoCo, same law applied, closed", s, [=] { return bench::mujoco_forces(s, bekker).cpu_s; });
    add("MuJoCo, same law applied, arc", s, [=] { return bench::mujoco_forces(s, arc).cpu_s; });
    add("MuJoCo contacts, six bodies", s, [=] { return bench::mujoco_contacts(s).cpu_s; });
#endif
    return list;
}

// Where an end-to-end second of the aggregated law goes, from the differences of the cases.
void print_profile(const std::vector<Case> &list) {
    const auto cost_us = [&](std::size_t i) { return 1e6 / list[i].median(); }; // per simulated second
    const double file = cost_us(0), memory = cost_us(3), bare = cost_us(4), plant = cost_us(5);
    std::printf("\nof %.0f us a simulated second (aggregated law): plant %.0f, sensors and firmware %.0f, log in memory %.0f, file %.0f\n",
                file, plant, bare - plant, memory - bare, file - memory);
}

void write_json(const std::vector<Case> &list, const char *path) {
    std::ostringstream out;
    out << "{\"schema\": \"traction.bench_sim/1\", \"unit\": \"simulated seconds per CPU second\", \"cases\": [";
    for (std::size_t i = 0; i < list.size(); ++i) {
        out << (i == 0 ? "" : ",") << "\n  {\"name\": \"" << list[i].name << "\", \"median\": " << list[i].median();
        if (list[i].goal > 0) out << ", \"goal\": " << list[i].goal;
        out << "}";
    }
    out << "\n]}\n";
    log::write_file(out.str(), path);
}

} // namespace

int main(int argc, char **argv) {
    int rounds = 5;
    const char *json = nullptr;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--rounds") == 0 && i + 1 < argc)
            rounds = std::atoi(argv[++i]);
        else if (std::strcmp(argv[i], "--json") == 0 && i + 1 < argc)
            json = argv[++i];
        else
            rounds = 0;
    }
    if (rounds < 1) {
        std::fputs("usage: sim_bench [--rounds N] [--json FILE]\n", stderr);
        return 2;
    }
    try {
        std::vector<Case> list = cases(sim::read_scenario(TRACTION_SOURCE_DIR "/scenarios/identification.toml"));
        for (int round = 0; round < rounds; ++round)
            for (Case &one : list) one.factor.push_back(one.seconds / one.run());
        bool reached = true;
        std::printf("simulated seconds per CPU second, one core, median of %d interleaved rounds, 1 ms step\n\n", rounds);
        for (const Case &one : list) {
            std::printf("%-52s %7.0f", one.name.c_str(), one.median());
            if (one.goal > 0) {
                std::printf("   goal %.0f: %s", one.goal, one.median() >= one.goal ? "reached" : "MISSED");
                reached = reached && one.median() >= one.goal;
            }
            std::printf("\n");
        }
        print_profile(list);
#if TRACTION_HAVE_MUJOCO
        // the same law on another engine must reach the same place, or the comparison means nothing
        const double there = bench::mujoco_forces(10, sim::ContactLaw::aggregated).x_m;
        sim::PlantConfig config;
        config.ground.soil = *sim::find_soil("dry_sand_literature");
        config.rover.battery_resistance_ohm = 0;
        sim::Plant plant(config);
        for (int i = 0; i < 4; ++i) plant.set_duty(i, bench::rival_duty);
        for (int k = 0; k < 10000; ++k) plant.step();
        const double here = plant.truth().position_m[0];
        std::printf("MuJoCo %s and the plant with the same law after 10 s: %.4f m and %.4f m (%.3f %%)\n", bench::mujoco_version().c_str(),
                    there, here, 100 * (there / here - 1));
#else
        std::printf("\nMuJoCo is not here: apt-get install libmujoco-dev, configure again, and its four rows appear\n");
#endif
        if (json != nullptr) write_json(list, json);
        return reached ? 0 : 1;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "sim_bench: %s\n", error.what());
        return 3;
    }
}
