// false_alarms - hours of normal driving in which the firmware must name nothing: all soils, slopes to 10 degrees from the start, along the
// path and as steps, tilted directions, modes, speeds, starts, stops, turns, restarts with warm motors, motors and sensors unlike their
// description within what the catalogue calls usual. usage: false_alarms_run [HOURS [FIRST_SEED [wide]]], or scenario SEED [wide] for the
// file of one drive; a short run of it is a test. `wide` varies what the others hold fixed: five soils, sand to 10 degrees, turns on the
// spot, payload and where it lies, offset and vibration of the accelerometer, gyros that warm up, the radar's mounting, ground and fading,
// lamps.
//
// Every drive is drawn from its own seed, printed when it fails. A drive that asks for what the rover cannot do (a wheel held by a slope it
// cannot climb) would be a fault by right: demands stay within grip and power.
#include "host_tools/simulate/simulate.h"

#include "sim/sensors/random.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace traction;

namespace {

constexpr double degree = 3.14159265358979323846 / 180;

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6f", value);
    return text;
}

// Sand gives way on its steeper slopes: what is asked there is driven at any slip, but not climbed.
std::string draw(std::uint64_t seed, double duration_s, bool wide) {
    sim::Random random(seed, wide ? "wide false alarms" : "false alarms");
    static const char *const soils[] = {"sand", "gravel", "concrete", "dry_sand_literature", "loam"};
    const int soil = random.below(wide ? 5 : 3);
    const double steepest = (soil == 0 && !wide ? 6 : 10) * degree;
    std::string text =
        "duration_s = " + number(duration_s) + "\nseed = " + std::to_string(seed) + "\n[ground]\nsoil = \"" + soils[soil] + "\"\n";
    if (random.below(3) > 0) text += "slope_rad = " + number(random.uniform(-steepest, steepest)) + "\n";
    if (random.below(2) == 0) {
        text += "slope_steps = [";
        for (double path_m = random.uniform(0.5, 2); path_m < 12; path_m += random.uniform(0.5, 3))
            text += "[" + number(path_m) + ", " + number(random.uniform(-steepest, steepest)) + "], ";
        text += "]\n";
    }
    if (wide) {
        text += "[rover]\nmass_kg = " + number(random.uniform(2.4, 4.0)) + "\n[sensors]\nheave_m = " + number(random.uniform(0, 0.002)) +
                "\nheave_Hz = " + number(random.uniform(3, 15)) + "\npitch_vibration_rad = " + number(random.uniform(0, 0.01)) +
                "\npitch_vibration_Hz = " + number(random.uniform(2, 12)) +
                "\n[sensors.accel]\noffset_m_s2 = " + number(random.uniform(-0.2, 0.2)) +
                "\n[radar]\nmounting_error_deg = " + number(random.uniform(-3, 3)) + "\nground_exponent = " + number(random.uniform(0, 2)) +
                "\n";
        sim::Random more(seed, "lamps and gyros"); // of its own: what was drawn before stays
        static constexpr double lamp_Hz[] = {50, 60, 100, 120, 150};
        if (more.below(3) == 0)
            text += "[[radar.interference]]\nfrequency_Hz = " + number(lamp_Hz[more.below(5)] + more.uniform(-0.3, 0.3)) +
                    "\nrms_count = " + number(more.uniform(0.5, 20)) + "\n";
        for (const char *axis : {"x", "y", "z"}) // warms up, by up to 1 deg/s in ten minutes
            text += std::string("[[fault]]\nwhat = \"sensor\"\nsensor = \"gyro\"\nhow = \"drift\"\naxis = \"") + axis +
                    "\"\ndrift_s = " + number(more.uniform(-degree, degree) / 600) + "\nfrom_s = 0.0\n";
    } else if (random.below(3) == 0)
        text += "[sensors]\npitch_vibration_rad = " + number(random.uniform(0, 0.01)) + "\nheave_m = " + number(random.uniform(0, 0.001)) +
                "\n";
    for (double t_s = 0; t_s < duration_s;) {
        const double for_s = random.uniform(0.5, 6);
        const double speed = random.uniform(-0.5, 0.6);
        text += "[[drive]]\nfor_s = " + number(for_s) + "\n";
        switch (random.below(5)) {
        case 0:
            text += "mode = \"stop\"\n";
            break;
        case 1:
            text += "mode = \"wheel_speed\"\nwheel_speed_rad_s = " + number(speed / 0.057) + "\n";
            break;
        case 2:
            text += "mode = \"platform_speed\"\nspeed_m_s = " + number(speed) +
                    "\nyaw_rate_rad_s = " + number(wide ? random.uniform(-1, 1) : random.uniform(-0.5, 0.5)) + "\n";
            break;
        default:
            text += "mode = \"platform_speed\"\nspeed_m_s = " + number(speed) + "\n";
        }
        t_s += for_s;
    }
    return text;
}

// What motors and sensors are really like: within a tenth of their description.
std::string unlike(std::uint64_t seed, bool wide) {
    sim::Random random(seed, "unlike");
    std::string text;
    const auto effect = [&](const char *name, const char *parameter, double size) {
        text += std::string("[[effect]]\nname = \"") + name + "\"\n" + parameter + " = " + number(size) + "\n";
    };
    if (random.below(2) == 0) effect("voltage_gain", "change", random.uniform(-0.05, 0.05));
    if (random.below(2) == 0) {
        effect("current_gain", "change", random.uniform(-0.1, 0.1));
        text += "wheel = " + std::to_string(random.below(4)) + "\n";
    }
    if (wide && random.below(2) == 0) effect("mass_offset_x", "offset_m", random.uniform(-0.03, 0.03));
    return text;
}

// Every second drive is a restart of which nothing is known.
bool is_warm(std::uint64_t seed) { return seed % 2 == 0; }

} // namespace

int main(int argc, char **argv) {
    const bool wide = std::string(argv[argc - 1]) == "wide";
    argc -= wide ? 1 : 0;
    if (argc == 3 && std::string(argv[1]) == "scenario") {
        const auto seed = static_cast<std::uint64_t>(std::atoll(argv[2]));
        if (is_warm(seed)) std::puts("# begins with windings taken to be warm, which a scenario cannot say");
        std::fputs((draw(seed, 60, wide) + unlike(seed, wide)).c_str(), stdout);
        return 0;
    }
    const double hours = argc > 1 ? std::atof(argv[1]) : 10;
    const auto first = static_cast<std::uint64_t>(argc > 2 ? std::atoll(argv[2]) : 1);
    constexpr double drive_s = 60;
    const auto drives = static_cast<std::uint64_t>(hours * 3600 / drive_s + 0.5);
    std::uint64_t alarms = 0;
    for (std::uint64_t seed = first; seed < first + drives; seed++) {
        SimulateOptions options;
        options.record = false;
        options.warm = is_warm(seed);
        const auto scenario = sim::parse_scenario(draw(seed, drive_s, wide) + unlike(seed, wide), "seed " + std::to_string(seed));
        const SimulationResult result = simulate(scenario, options);
        if (result.faults == 0) continue;
        alarms++;
        std::printf("seed %llu: faults %08x\n", static_cast<unsigned long long>(seed), result.faults);
        std::fflush(stdout);
    }
    std::printf("%llu drives of %.0f s, %.2f h from seed %llu: %llu with a false alarm\n", static_cast<unsigned long long>(drives), drive_s,
                static_cast<double>(drives) * drive_s / 3600, static_cast<unsigned long long>(first),
                static_cast<unsigned long long>(alarms));
    return alarms == 0 ? 0 : 1;
}
