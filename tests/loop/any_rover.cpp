// any_rover - rovers that nobody has built: each is drawn whole (1 to 100 kg, wheels, motors, converters, noises, radar and its place), its
// firmware is made from the description alone, and it drives for a minute over slopes and through stops and turns, from its first tick on.
// It must name no false fault, know its speed (error at most 4 cm/s or NEES at most 2, never a wrong sign for more than 0.5 s) and keep the
// speed that it is asked for within 0.1 m/s. usage: any_rover_run [DRIVES [FIRST_SEED [reference]]]; `reference` draws the drives alone,
// for the reference rover. A line each; exit 1 where a rover is refused or has a false fault. A few of them are a test.
//
// A drive that asks for what its rover cannot do would be a fault by right: motors carry its weight up 10 degrees for long, and no speed is
// more than 0.6 of what its firmware takes for its highest.
#include "host_tools/rover/rover.h"
#include "host_tools/simulate/simulate.h"

#include "sim/scenario/scenario_error.h"
#include "sim/sensors/random.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace traction;

namespace {

constexpr double degree = 3.14159265358979323846 / 180, g = 9.81, drive_s = 60;

double spread(sim::Random &random, double low, double high) { return low * std::exp(random.uniform() * std::log(high / low)); }

sim::RoverDescription draw_rover(std::uint64_t seed) {
    sim::Random random(seed, "any rover");
    sim::RoverDescription rover;
    const auto set = [&rover](const char *section, const char *name, double value) {
        rover.value(section, name).value = value, rover.value(section, name).given = true;
    };
    const double mass = spread(random, 1, 100), size = std::cbrt(mass / 2.88);
    const double radius = 0.057 * size * random.uniform(0.7, 1.4), load = mass * g / 4;
    rover.name = "any " + std::to_string(seed), rover.file = "seed " + std::to_string(seed);
    set("body", "mass_kg", mass);
    set("body", "half_wheelbase_m", radius * random.uniform(1.3, 2.2));
    set("body", "half_track_m", radius * random.uniform(1.4, 2.6));
    set("body", "length_m", radius * 5.3), set("body", "width_m", radius * 4.7), set("body", "height_m", radius * 3.2);
    set("wheels", "radius_m", radius);
    set("wheels", "width_m", radius * random.uniform(0.5, 1));
    set("wheels", "mass_kg", 0.05 * mass);
    const double stiffness = load / (0.02 * radius * random.uniform(0.7, 1.5));
    set("wheels", "contact_stiffness_N_m", stiffness);
    set("wheels", "contact_damping_Ns_m", 0.66 * std::sqrt(stiffness * mass / 4));
    set("wheels", "relaxation_length_m", 0.09 * radius);
    // motors: a no-load rim speed, a stall torque and a time constant
    static constexpr double packs_V[] = {7.2, 11.1, 14.8, 24, 36, 48};
    const double volt = packs_V[random.below(3) + (mass < 6 ? 0 : mass < 25 ? 1 : 3)]; // a pack for its size
    const double K = volt * radius / random.uniform(0.9, 2.2), stall = radius * load * random.uniform(1.2, 3);
    const double Ra = K * volt / stall, tau = spread(random, 0.012, 0.25);
    set("battery", "voltage_V", volt), set("battery", "resistance_ohm", random.uniform(0.005, 0.03) * Ra);
    set("motor", "torque_constant_Nm_A", K), set("motor", "resistance_ohm", Ra);
    set("motor", "inertia_kg_m2", std::min(1.0, tau * K * K / Ra));
    set("motor", "viscous_Nms", random.uniform(0.004, 0.07) * K * K / Ra);
    set("motor", "coulomb_Nm", random.uniform(0.005, 0.05) * stall);
    const double borne_A = random.uniform(0.7, 1.5) * radius * load / K, rise = random.uniform(60, 110);
    set("motor", "winding_rise_max_K", rise), set("motor", "winding_K_W", rise / (borne_A * borne_A * Ra));
    set("motor", "winding_J_K", random.uniform(40, 120) / rover.at("motor", "winding_K_W"));
    set("gear", "ratio", 1), set("gear", "wheel_inertia_kg_m2", 0.1 * rover.at("motor", "inertia_kg_m2"));
    set("encoder", "counts_per_motor_turn", std::round(spread(random, 1000, 20000)));
    const double bits = random.below(2) == 0 ? 1023 : 4095;
    set("battery", "V_per_count", volt * random.uniform(1.2, 1.6) / bits), set("battery", "max_count", bits);
    set("battery", "noise_V", rover.at("battery", "V_per_count") * random.uniform(0.5, 2));
    set("current", "max_count", bits);
    set("current", "A_per_count", volt / Ra * random.uniform(1.1, 2.2) / (0.5 * bits));
    set("current", "offset_count", std::round(bits / 2 * random.uniform(0.98, 1.02)));
    set("current", "noise_A", rover.at("current", "A_per_count") * random.uniform(0.5, 2.5));
    set("accel", "m_s2_per_count", spread(random, 0.0005, 0.01)), set("accel", "offset_count", random.below(40) - 20);
    set("accel", "noise_m_s2", spread(random, 0.01, 0.15)), set("accel", "vibration_1_s", random.uniform(0.02, 0.1));
    set("gyro", "rad_s_per_count", spread(random, 1e-4, 1e-3)), set("gyro", "offset_count", random.below(40) - 20);
    set("gyro", "noise_rad_s", spread(random, 0.0005, 0.008));
    static constexpr const char *radars[] = {"MDU1130", "DJ Radar II", "DJ Radar III", "DRS1000"};
    rover.radar = radars[random.below(4)];
    set("radar", "depression_deg", random.uniform(15, 40)), set("radar", "height_m", random.uniform(0.15, 0.8));
    static constexpr double rates_Hz[] = {512, 512, 1000, 2000};
    set("radar", "rate_Hz", rates_Hz[random.below(4)]);
    set("radar", "echo_count", spread(random, 30, 120)), set("radar", "noise_count", random.uniform(0.8, 2));
    for (sim::RoverWheel &wheel : rover.wheel) wheel.encoder_sign = random.below(2) == 0 ? 1 : -1;
    return rover;
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6f", value);
    return text;
}

std::string draw_drive(std::uint64_t seed, const sim::RoverDescription &rover, double fastest_m_s) {
    sim::Random random(seed, "any drive");
    static constexpr const char *soils[] = {"sand", "gravel", "concrete"};
    const int soil = random.below(3);
    const double steepest = (soil == 0 ? 6 : 10) * degree;
    std::string text =
        "duration_s = " + number(drive_s) + "\nseed = " + std::to_string(seed) + "\n[ground]\nsoil = \"" + soils[soil] + "\"\n";
    if (random.below(3) > 0) text += "slope_rad = " + number(random.uniform(-steepest, steepest)) + "\n";
    if (random.below(2) == 0) {
        text += "slope_steps = [";
        for (double path_m = random.uniform(0.5, 2); path_m < 12; path_m += random.uniform(0.5, 3))
            text += "[" + number(path_m) + ", " + number(random.uniform(-steepest, steepest)) + "], ";
        text += "]\n";
    }
    const double most = std::min(0.6, 0.6 * fastest_m_s);
    for (double t_s = 0; t_s < drive_s;) {
        const double for_s = random.uniform(1.5, 6), speed = random.uniform(-most, most);
        text += "[[drive]]\nfor_s = " + number(for_s) + "\n";
        switch (random.below(5)) {
        case 0:
            text += "mode = \"stop\"\n";
            break;
        case 1:
            text += "mode = \"wheel_speed\"\nwheel_speed_rad_s = " + number(speed / rover.at("wheels", "radius_m")) + "\n";
            break;
        case 2:
            text += "mode = \"platform_speed\"\nspeed_m_s = " + number(speed) +
                    "\nyaw_rate_rad_s = " + number(random.uniform(-0.3, 0.3) * std::fabs(speed) / rover.at("body", "half_track_m")) + "\n";
            break;
        default:
            text += "mode = \"platform_speed\"\nspeed_m_s = " + number(speed) + "\n";
        }
        t_s += for_s;
    }
    return text;
}

// Over the drive's ticks, the first second left out.
struct Known {
    double error_m_s = 0, nees = 0, wrong_sign_s = 0, off_m_s = 0;
    double fault_s = 0, then_m_s = 0; // the first fault's time, and the true speed then
};

Known judge(const SimulationResult &result, const sim::Scenario &scenario) {
    const auto signal = [](const log::Log &log, const char *name) {
        const log::Signal *found = log.find(name);
        if (found == nullptr) std::printf("no %s\n", name), std::exit(2);
        return found;
    };
    const log::Signal *speed = signal(result.log, "estimate.speed_m_s"), *deviation = signal(result.log, "estimate.speed_std_m_s"),
                      *truth = signal(result.truth, "truth.speed_m_s");
    Known out;
    double count = 0, wrong = 0;
    std::size_t k = 0;
    for (std::size_t i = 0; i < speed->value.size(); i++) {
        const double t = speed->t_s[i];
        while (k + 1 < truth->t_s.size() && truth->t_s[k] < t - 1e-6) k++;
        if (t < 1) continue;
        const double error = speed->value[i] - truth->value[k];
        out.error_m_s += error * error, out.nees += error * error / std::max(1e-6, deviation->value[i] * deviation->value[i]), count++;
        wrong = speed->value[i] * truth->value[k] < 0 && std::fabs(truth->value[k]) > 0.05 ? wrong + 0.01 : 0;
        out.wrong_sign_s = std::max(out.wrong_sign_s, wrong);
    }
    const log::Signal *faults = signal(result.log, "control.faults");
    for (std::size_t i = 0; i < faults->value.size() && out.fault_s == 0; i++)
        if (faults->value[i] != 0) {
            out.fault_s = faults->t_s[i];
            const auto after = std::upper_bound(truth->t_s.begin(), truth->t_s.end(), out.fault_s);
            if (after != truth->t_s.begin()) out.then_m_s = truth->value[static_cast<std::size_t>(after - truth->t_s.begin()) - 1];
        }
    for (const sim::DriveSegment &segment : scenario.drive) { // the end of each piece of 2.5 s or more that asks for a platform speed
        if (segment.mode != sim::DriveMode::platform_speed || segment.to_s - segment.from_s < 2.5 || segment.to_s > drive_s) continue;
        const double asked = sim::demand_at(scenario.drive, segment.from_s + 0.01).speed_m_s;
        double sum = 0, n = 0;
        for (std::size_t i = 0; i < truth->t_s.size(); i++)
            if (truth->t_s[i] > segment.to_s - 0.5 && truth->t_s[i] < segment.to_s) sum += truth->value[i], n++;
        if (n > 0) out.off_m_s = std::max(out.off_m_s, std::fabs(sum / n - asked));
    }
    out.error_m_s = std::sqrt(out.error_m_s / count), out.nees /= count;
    return out;
}

} // namespace

int main(int argc, char **argv) {
    const bool reference = std::string(argv[argc - 1]) == "reference";
    argc -= reference ? 1 : 0;
    const auto at = [argv](int i) { return static_cast<std::uint64_t>(std::atoll(argv[i])); };
    const std::uint64_t drives = argc > 1 ? at(1) : 100, first = argc > 2 ? at(2) : 1;
    std::uint64_t refused = 0, faults = 0, ignorant = 0, astray = 0;
    for (std::uint64_t seed = first; seed < first + drives; seed++) {
        const sim::RoverDescription rover = reference ? sim::RoverDescription() : draw_rover(seed);
        try {
            const parameters_t parameters = firmware_parameters(rover);
            (void)firmware_config(rover);
            const double fastest = static_cast<double>(parameters.rover.value[ROVER_speed_max_m_s]);
            sim::Scenario scenario = sim::parse_scenario(draw_drive(seed, rover, fastest), rover.file);
            sim::set_rover(scenario, rover);
            SimulateOptions options;
            options.truth = true;
            const SimulationResult result = simulate(scenario, options);
            const Known known = judge(result, scenario);
            const bool bad = known.error_m_s > 0.04 && known.nees > 2;
            // coasts down a slope faster than its radar hears: named by right
            const bool right = result.faults == FAULT_SPEED_BEYOND && std::fabs(known.then_m_s) > fastest;
            faults += result.faults != 0 && !right, ignorant += bad || known.wrong_sign_s > 0.5, astray += known.off_m_s > 0.1;
            std::printf("%llu: %5.1f kg R %.3f m %s at %.0f deg, %4.0f Hz: faults %08x (%.2f s, at %.2f m/s), %.1f cm/s, NEES %.2f, wrong "
                        "sign %.2f s, off by %.3f m/s\n",
                        static_cast<unsigned long long>(seed), rover.at("body", "mass_kg"), rover.at("wheels", "radius_m"),
                        rover.radar.c_str(), rover.at("radar", "depression_deg"), rover.at("radar", "rate_Hz"), result.faults,
                        known.fault_s, known.then_m_s, 100 * known.error_m_s, known.nees, known.wrong_sign_s, known.off_m_s);
        } catch (const sim::ScenarioError &error) {
            refused++;
            std::printf("%llu: refused: %s\n", static_cast<unsigned long long>(seed), error.what());
        }
        std::fflush(stdout);
    }
    std::printf(
        "%llu rovers from seed %llu: %llu refused, %llu with a false fault, %llu that do not know their speed, %llu off by more than "
        "0.1 m/s\n",
        static_cast<unsigned long long>(drives), static_cast<unsigned long long>(first), static_cast<unsigned long long>(refused),
        static_cast<unsigned long long>(faults), static_cast<unsigned long long>(ignorant), static_cast<unsigned long long>(astray));
    return refused + faults == 0 ? 0 : 1;
}
