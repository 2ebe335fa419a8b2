// verb_tune.cpp - traction tune: gains of the wheel-speed loop from an experiment with torque and time limits, on the simulated rover.
#include "verbs.h"

#include "hal/sim/sim_rover.h"
#include "host_tools/calibrate/calibrate.h"
#include "host_tools/calibrate/tune.h"
#include "host_tools/rover/rover.h"
#include "sim/scenario/scenario.h"

#include <cstdio>
#include <memory>

namespace traction::cli {

namespace {

struct TuneOptions {
    std::string scenario, parameters;
    TuneLimits limits;
};

void run_tune(const TuneOptions &options, Outcome &outcome) {
    sim::Scenario scenario = sim::read_scenario(options.scenario);
    scenario.duration_s = 601; // beyond any time limit
    // what fails at its times on the drive plan is the plan's; the rover and its ground are tuned
    scenario.sensor_faults.clear();
    scenario.wheel_blocks.clear();
    scenario.emergency_stops.clear();
    hal::SimRover rover(scenario, hal::effects_of(scenario), scenario.seed);
    const TuneResult r = tune(rover.hal(), firmware_of(scenario), options.limits);
    std::printf("largest torque %.2f N m, %.1f s, motors stopped\n", r.largest_torque_Nm, r.used_s);
    for (std::size_t i = 0; i < r.pole_1_s.size(); i++)
        std::printf("wheel %zu: pole %.2f 1/s, %.0f rad/s^2 per duty at %.2f V\n", i, r.pole_1_s[i], r.gain_rad_s2[i], r.battery_V);
    if (r.order_delay_s > 0) std::printf("order delay %.0f ms: the loop is slower for it\n", r.order_delay_s * 1000);
    std::printf("wheel_kp_s %.4f, wheel_ki_1 %.4f for a phase margin of %.0f deg\n", r.kp_s, r.ki_1, options.limits.margin_deg);
    if (!options.parameters.empty()) {
        put_parameter(options.parameters, "wheel_kp_s", r.kp_s, "duty per rad/s, traction tune");
        put_parameter(options.parameters, "wheel_ki_1", r.ki_1, "duty per rad, traction tune");
        std::printf("wrote %s\n", options.parameters.c_str());
    }
    outcome.json = {{"schema", "traction.tune/1"},
                    {"kp_s", r.kp_s},
                    {"ki_1", r.ki_1},
                    {"pole_1_s", r.pole_1_s},
                    {"gain_rad_s2", r.gain_rad_s2},
                    {"order_delay_s", r.order_delay_s},
                    {"largest_torque_Nm", r.largest_torque_Nm},
                    {"used_s", r.used_s}};
}

} // namespace

Verb verb_tune() {
    const auto options = std::make_shared<TuneOptions>();
    return {.name = "tune",
            .summary = "wheel-speed gains for the motors of a scenario's rover; the motors are stopped at the end",
            .options =
                {{.argument = "SCENARIO",
                  .into = &options->scenario,
                  .help = "scenario (TOML) whose rover is tuned; its drive plan is not used",
                  .kind = Kind::scenario,
                  .required = true},
                 {.name = "--torque-Nm",
                  .into = &options->limits.torque_Nm,
                  .help = "largest torque at a wheel",
                  .value = "NM",
                  .shows_default = true,
                  .range = Range{0.01, 20}},
                 {.name = "--duty", .into = &options->limits.duty, .help = "largest duty", .shows_default = true, .range = Range{0.05, 1}},
                 {.name = "--time-s",
                  .into = &options->limits.time_s,
                  .help = "the experiment takes at most so long",
                  .value = "S",
                  .shows_default = true,
                  .range = Range{1, 600}},
                 {.name = "--margin-deg",
                  .into = &options->limits.margin_deg,
                  .help = "phase margin",
                  .value = "DEG",
                  .shows_default = true,
                  .range = Range{30, 80}},
                 {.name = "--parameters",
                  .into = &options->parameters,
                  .help = "set the gains in this parameter file of the firmware",
                  .value = "FILE",
                  .kind = Kind::output}},
            .run = [options](Outcome &outcome) { run_tune(*options, outcome); }};
}

} // namespace traction::cli
