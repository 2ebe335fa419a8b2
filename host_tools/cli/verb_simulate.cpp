// verb_simulate.cpp - traction simulate SCENARIO: drives the rover through a scenario and writes the log.

#include "progress.h"
#include "rows.h"
#include "stop_signal.h"
#include "verbs.h"

#if TRACTION_WITH_BUS
#include "host_tools/bus_world/bus_world.h"
#endif
#include "host_tools/lab/next/manoeuvre.h"
#include "host_tools/log/log.h"
#include "host_tools/log/write_file.h"
#include "host_tools/report/report.h"
#include "host_tools/rover/rover.h"
#include "host_tools/simulate/batch.h"
#include "host_tools/simulate/fault_names.h"
#include "host_tools/simulate/simulate.h"
#include "sim/scenario/scenario.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

namespace traction::cli {

namespace {

struct SimulateArguments {
    std::string scenario, out, truth, radar, frames, seal, seeds, firmware, model, rover, believes, live, can;
    std::int64_t seed = -1, hide = -1;
    int hide_count = 1, jobs = 1;
    double seconds = 0; // 0: the scenario's own
    std::vector<std::string> effects;
    bool realtime = false, self_test = false;
};

// "log.csv" for seed 7 is "log.7.csv".
std::string with_seed(const std::string &path, std::uint64_t seed) {
    const std::filesystem::path p(path);
    return (p.parent_path() / (p.stem().string() + '.' + std::to_string(seed) + p.extension().string())).string();
}

bool parse_range(const std::string &text, std::uint64_t &first, std::uint64_t &last) {
    char rest = 0;
    unsigned long long a = 0, b = 0;
    if (std::sscanf(text.c_str(), "%llu..%llu%c", &a, &b, &rest) != 2 || b < a || b - a > 1000000) return false;
    first = a;
    last = b;
    return true;
}

// The options of one run of several: files and hidden effects of its own.
SimulateOptions options_of(const SimulateArguments &arguments, SimulateOptions options, std::uint64_t seed, std::uint64_t first,
                           bool batch) {
    const auto name = [&](const std::string &path) { return batch && !path.empty() ? with_seed(path, seed) : path; };
    options.log_path = name(arguments.out);
    options.truth_path = name(arguments.truth);
    options.radar_path = name(arguments.radar);
    if (arguments.hide >= 0)
        options.hide = sim::HiddenDraw{
            .seed = static_cast<std::uint64_t>(arguments.hide) + (seed - first), .count = arguments.hide_count, .among = {}};
    return options;
}

// What the self-test found, a sentence each, the wheels beside it.
std::vector<std::string> self_test_names(const self_test_result_t &result) {
    std::vector<std::string> names;
    std::string wheels;
    for (unsigned i = 0; i < WHEEL_COUNT; i++)
        if ((result.wheels >> i & 1U) != 0) wheels += (wheels.empty() ? " (wheels " : ", ") + std::to_string(i);
    for (std::int32_t i = 0; i < SELF_TEST_FAILURES; i++)
        if ((result.failures >> static_cast<unsigned>(i) & 1U) != 0)
            names.push_back(self_test_name(i) + (wheels.empty() ? wheels : wheels + ")"));
    return names;
}

nlohmann::json summary(const SimulationResult &result, std::uint64_t seed) {
    char hash[20];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(result.trace_hash));
    return {{"seed", seed},
            {"ticks", result.ticks},
            {"simulated_s", static_cast<double>(result.ticks) / 100},
            {"interrupted", result.interrupted},
            {"faults", result.faults},
            {"fault_names", fault_names(result.faults)},
            {"self_test_failures", self_test_names(result.self_test)},
            {"trace_hash", hash}};
}

// The scenario's drive, sensors and faults with a lab's model for rover, ground and effects.
void drive_as(const std::string &file, sim::Scenario &scenario) {
    const lab::Model model = lab::read_model(file);
    if (const std::string why = lab::cannot_drive(model); !why.empty())
        throw lab::ModelError(file, 0, "--model", "cannot be driven: " + why, "give the model of a four-wheeled rover");
    std::vector<std::string> notes;
    const sim::Scenario machine =
        sim::parse_scenario(lab::scenario_of(model, "", "[[drive]]\nfor_s = 1\nmode = \"stop\"\n", 1, notes), file);
    if (machine.rover.drives != scenario.rover.drives)
        throw lab::ModelError(file, 0, "--model", "has other motors (rover.drives) than the scenario's rover, which the firmware drives",
                              "give a --rover whose [layout] has the same drives, such as rovers/two_motors.toml");
    sim::RoverDescription really = scenario.rover; // the firmware goes on believing the scenario's rover
    for (std::size_t i = 0; i < really.values.size(); i++)
        if (machine.rover.values[i].given) really.values[i] = machine.rover.values[i];
    sim::put_in_plant(really, scenario.plant.rover);
    scenario.plant.rover.battery_voltage_V = machine.plant.rover.battery_voltage_V;
    scenario.plant.ground.soil = machine.plant.ground.soil;
    scenario.plant.ground.grip_noise = machine.plant.ground.grip_noise;
    scenario.effects = machine.effects;
    for (const std::string &note : notes) std::printf("note: %s\n", note.c_str());
}

// The firmware's estimate ten times a simulated second, as rows of a log; a slip that means nothing is an empty cell.
class Live {
  public:
    Live() {
        std::string names = "t_s,estimate.speed_m_s";
        for (const char *quantity : {".slip", ".current_A"})
            for (int i = 0; i < WHEEL_COUNT; ++i) names += ",wheel" + std::to_string(i) + quantity;
        log::write_file(names + '\n', "-");
    }
    void row(const trace_t &trace) {
        if (trace.tick % 10 != 0) return;
        char cell[32];
        std::snprintf(cell, sizeof cell, "%.2f", static_cast<double>(trace.tick) / 100);
        std::string line = cell;
        const auto put = [&](float value, bool valid) {
            std::snprintf(cell, sizeof cell, ",%.4g", static_cast<double>(value));
            line += valid && std::isfinite(value) ? cell : ",";
        };
        put(trace.speed_m_s, true);
        for (const wheel_trace_t &wheel : trace.wheel) put(wheel.slip, wheel.slip_valid);
        for (const wheel_trace_t &wheel : trace.wheel) put(wheel.current_A, true);
        log::write_file(line + '\n', "-");
    }
};

// A run that ended with a latched fault is told, and is a negative answer: the rover stood still at its end.
void tell_faults(Outcome &outcome) {
    for (const nlohmann::json &run : outcome.json["runs"]) {
        for (const auto &failure : run["self_test_failures"]) {
            std::printf("seed %s failed its self-test: %s\n", run["seed"].dump().c_str(), failure.get<std::string>().c_str());
            outcome.exit_code = exit_negative;
        }
        const std::string names = fault_names(run["faults"].get<std::uint32_t>());
        if (names.empty()) continue;
        std::printf("seed %s ended with a latched fault: %s (docs/firmware.md, faults)\n", run["seed"].dump().c_str(), names.c_str());
        outcome.exit_code = exit_negative;
    }
}

#if TRACTION_WITH_BUS
// What is hidden in this run, sealed, after the effects that are asked for.
std::vector<sim::ActiveEffect> effects_of(const SimulateArguments &arguments, const sim::Scenario &scenario) {
    std::vector<sim::ActiveEffect> effects = scenario.effects;
    for (const std::string &text : arguments.effects) effects.push_back(sim::parse_effect(text));
    std::optional<sim::HiddenDraw> hide = scenario.hidden;
    if (arguments.hide >= 0)
        hide = sim::HiddenDraw{.seed = static_cast<std::uint64_t>(arguments.hide), .count = arguments.hide_count, .among = {}};
    if (!hide) return effects;
    const std::vector<sim::ActiveEffect> hidden = sim::draw_effects(*hide);
    if (!arguments.seal.empty()) report::write_text(sim::seal_text(hidden, scenario.name, hide->seed), arguments.seal);
    effects.insert(effects.end(), hidden.begin(), hidden.end());
    return effects;
}

// The rover's nodes on a CAN bus of this machine, for a computer at its other end.
void answer_on_bus(const SimulateArguments &arguments, const sim::Scenario &scenario, Outcome &outcome) {
    const std::uint64_t seed = arguments.seed >= 0 ? static_cast<std::uint64_t>(arguments.seed) : scenario.seed;
    can_socket_t bus = bus_world::open_bus(arguments.can);
    bus_world::BusWorld world(scenario, effects_of(arguments, scenario), seed);
    std::printf("%s: the rover's nodes are on %s; waiting for the SYNC of a computer (tractiond --hal linux)\n", scenario.name.c_str(),
                arguments.can.c_str());
    (void)std::fflush(stdout); // a script waits for it
    const auto start = std::chrono::steady_clock::now();
    const StopSignal stop("\ntraction: the nodes leave the bus. Once more ends it without a word\n");
    bus_world::Run done;
    {
        Progress progress("simulate " + scenario.name, static_cast<long>(scenario.duration_s + 0.5));
        done = bus_world::answer(
            world, bus, arguments.can,
            {.stopped = [] { return StopSignal::asked() != 0; }, .begun = {}, .after_second = [&progress] { progress.step(); }});
    }
    can_socket_close(&bus);
    const emulate::Counts &counts = done.counts;
    std::printf(
        "%.1f s: %u ticks, %u of them without a SYNC; %llu frames from the computer, %llu to it, %llu lost; orders out up to %.1f ms "
        "after their SYNC\n",
        static_cast<double>(counts.ticks) / 100, counts.ticks, counts.unread, static_cast<unsigned long long>(counts.frames_from),
        static_cast<unsigned long long>(counts.frames_to), static_cast<unsigned long long>(done.lost),
        counts.ticks > 0 && counts.order.most > 0 ? counts.order.most * 1e-3 : 0.0);
    outcome.json = {{"schema", "traction.simulate/1"},
                    {"scenario", scenario.name},
                    {"runs", nlohmann::json::array()},
                    {"spent_s", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()},
                    {"bus",
                     {{"interface", arguments.can},
                      {"seed", seed},
                      {"ticks", counts.ticks},
                      {"unread_ticks", counts.unread},
                      {"frames_from_computer", counts.frames_from},
                      {"frames_to_computer", counts.frames_to},
                      {"lost_frames", done.lost},
                      {"interrupted", done.interrupted}}}};
    if (const int signal = StopSignal::asked(); signal != 0) outcome.exit_code = 128 + signal;
}
#else
void answer_on_bus(const SimulateArguments &, const sim::Scenario &, Outcome &) {
    throw UsageError("--can: this build has no CAN bus (cantools was not there); `./traction build` of the source tree brings it");
}
#endif

void run_simulate(const SimulateArguments &arguments, Outcome &outcome) {
    for (const std::string &text : arguments.effects) need_effect("--effect", text, ":");
    sim::Scenario scenario = sim::read_scenario(arguments.scenario);
    if (!arguments.rover.empty()) sim::set_rover(scenario, sim::read_rover_file(arguments.rover));
    if (!arguments.model.empty()) drive_as(arguments.model, scenario);
    if (!arguments.believes.empty()) scenario.firmware.believes = sim::read_rover_file(arguments.believes);
    if (!arguments.frames.empty() && !parameter_lines(firmware_parameters(believed(scenario))).empty())
        throw UsageError(
            "--frames: replays the reference rover's firmware; for another rover keep the log (--out), which `traction replay` reads");
    if (arguments.seconds > 0) scenario.duration_s = std::min(scenario.duration_s, arguments.seconds);
    if (!arguments.can.empty()) {
        answer_on_bus(arguments, scenario, outcome);
        return;
    }
    SimulateOptions options;
    options.record = false;
    options.realtime = arguments.realtime;
    options.self_test = arguments.self_test;
    options.frames_path = arguments.frames;
    if (!arguments.firmware.empty()) options.firmware = arguments.firmware;
    for (const std::string &text : arguments.effects) options.effects.push_back(sim::parse_effect(text));

    std::uint64_t first = arguments.seed >= 0 ? static_cast<std::uint64_t>(arguments.seed) : scenario.seed, last = first;
    const bool batch = !arguments.seeds.empty();
    if (batch && !parse_range(arguments.seeds, first, last)) throw UsageError("--seeds: write FIRST..LAST, such as 0..99");
    if (batch && !arguments.frames.empty()) throw UsageError("--frames: takes one run, not a batch");
    if (batch && !arguments.live.empty()) throw UsageError("--live: takes one run, not a batch");
    std::optional<Live> live;
    if (!arguments.live.empty()) live.emplace();
    if (live) options.after_tick = [&live](const trace_t &trace) { live->row(trace); };

    for (const std::string &path : {arguments.out, arguments.truth, arguments.radar})
        if (!path.empty() && std::filesystem::exists(path + ".part"))
            std::printf("note: %s.part is what an earlier run had when it was ended; traction recover makes a log of it\n", path.c_str());

    const auto start = std::chrono::steady_clock::now();
    outcome.json = {{"schema", "traction.simulate/1"}, {"scenario", scenario.name}, {"runs", nlohmann::json::array()}};
    const auto count = static_cast<long>(last - first + 1);
    Progress progress("simulate " + scenario.name, count * static_cast<long>(scenario.duration_s + 0.5));
    options.after_second = [&progress] { progress.step(); };
    const StopSignal stop;
    options.stopped = [] { return StopSignal::asked() != 0; };
    double simulated_s = 0;
    bool as_parts = false; // of a run that was stopped
    const auto own = [&](std::uint64_t seed) { return options_of(arguments, options, seed, first, batch); };
    simulate_batch(scenario, own, first, last, arguments.jobs, [&](std::uint64_t seed, SimulationResult &&result) {
        if (!arguments.seal.empty())
            report::write_text(sim::seal_text(result.hidden, scenario.name, result.hide_seed),
                               batch ? with_seed(arguments.seal, seed) : arguments.seal);
        simulated_s += static_cast<double>(result.ticks) / 100;
        for (const auto &[part, stood] : result.parts) {
            const auto beside = std::filesystem::path(stood).parent_path() / std::filesystem::path(part).filename(); // as it was given
            std::printf("%s stood already and is as it was; what this run had: traction recover '%s' --out NEW\n", stood.c_str(),
                        (std::filesystem::exists(beside) ? beside.string() : part).c_str());
        }
        as_parts = as_parts || !result.parts.empty();
        outcome.json["runs"].push_back(summary(result, seed));
    });
    auto &runs = outcome.json["runs"];
    std::sort(runs.begin(), runs.end(), [](const auto &a, const auto &b) { return a["seed"] < b["seed"]; });
    const double spent_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("%s: %ld run%s, %.1f s simulated in %.2f s (%.0f x real time)%s%s\n", scenario.name.c_str(), count, count == 1 ? "" : "s",
                simulated_s, spent_s, simulated_s / spent_s, arguments.out.empty() || as_parts ? "" : ", log in ",
                as_parts ? "" : arguments.out.c_str());
    outcome.json["spent_s"] = spent_s;
    if (arguments.out.empty() && arguments.truth.empty() && arguments.radar.empty() && arguments.frames.empty())
        std::printf("the log was not kept; --out LOG keeps it\n");
    tell_faults(outcome);
    if (const int signal = StopSignal::asked(); signal != 0) {
        std::printf("stopped by a signal with %zu of %ld run%s begun%s\n", runs.size(), count, count == 1 ? "" : "s",
                    as_parts ? "" : "; what was written is whole, and says `ended: interrupted`");
        outcome.exit_code = 128 + signal;
    }
}

} // namespace

Verb verb_simulate() {
    const auto arguments = std::make_shared<SimulateArguments>();
    const std::vector<std::string> of_firmware = {"--out",      "--truth", "--radar",    "--frames",    "--firmware",
                                                  "--believes", "--live",  "--realtime", "--self-test", "--seeds"};
    return {.name = "simulate",
            .summary = "drive the simulated rover through a scenario and write the log",
            .options =
                {{.argument = "SCENARIO",
                  .into = &arguments->scenario,
                  .help = "scenario file (scenarios/*.toml)",
                  .kind = Kind::scenario,
                  .required = true},
                 {.name = "--out",
                  .into = &arguments->out,
                  .help = "the log, CSV; ULog where it ends in .ulg",
                  .value = "LOG",
                  .kind = Kind::output},
                 {.name = "--truth",
                  .into = &arguments->truth,
                  .help = "what really happened, in a file of its own",
                  .value = "FILE",
                  .kind = Kind::output},
                 {.name = "--radar",
                  .into = &arguments->radar,
                  .help = "the radar's samples, 512 a second, in a log of their own instead of in --out, which then has few empty cells",
                  .value = "FILE",
                  .kind = Kind::output},
                 {.name = "--seed", .into = &arguments->seed, .help = "instead of the scenario's seed", .range = Range{.low = 0}},
                 {.name = "--effect",
                  .into = &arguments->effects,
                  .help = "add an effect: 'name:parameter=value,wheel=2' (traction effects lists them)",
                  .value = "EFFECT",
                  .kind = Kind::effect},
                 {.name = "--model",
                  .into = &arguments->model,
                  .help = "rover, ground and effects of a lab's model (TOML) instead of the scenario's",
                  .value = "FILE",
                  .kind = Kind::model},
                 {.name = "--rover",
                  .into = &arguments->rover,
                  .help = "the rover that drives (rovers/*.toml) instead of the scenario's",
                  .value = "FILE",
                  .kind = Kind::rover},
                 {.name = "--believes",
                  .into = &arguments->believes,
                  .help = "the rover that the firmware takes itself for: another one is a firmware that is wrong about its rover",
                  .value = "FILE",
                  .kind = Kind::rover},
                 {.name = "--hide",
                  .into = &arguments->hide,
                  .help = "hide an effect drawn by this seed; with --seeds each run hides another, by the seeds that follow",
                  .value = "SEED",
                  .range = Range{.low = 0}},
                 {.name = "--hide-count",
                  .into = &arguments->hide_count,
                  .help = "how many effects to hide",
                  .range = Range{1, 5},
                  .needs = {"--hide"}},
                 {.name = "--seal",
                  .into = &arguments->seal,
                  .help = "write what was hidden to this file",
                  .value = "FILE",
                  .kind = Kind::output},
                 {.name = "--frames",
                  .into = &arguments->frames,
                  .help = "frames and commands as text that tractiond --hal replay runs",
                  .value = "FILE",
                  .kind = Kind::output},
                 {.name = "--firmware",
                  .into = &arguments->firmware,
                  .help = "firmware configuration instead of the scenario's",
                  .one_of = {"default", "paper"}},
                 {.name = "--live",
                  .into = &arguments->live,
                  .help = "speed, slip and currents as the firmware knows them to standard output, ten rows a simulated second",
                  .value = "-",
                  .kind = Kind::output,
                  .one_of = {"-"}},
                 {.name = "--for",
                  .into = &arguments->seconds,
                  .help = "end the drive after this many seconds, where the scenario's is longer",
                  .value = "S",
                  .range = Range{0.01, 1e6}},
                 {.name = "--realtime", .into = &arguments->realtime, .help = "keep pace with the wall clock"},
                 {.name = "--self-test",
                  .into = &arguments->self_test,
                  .help = "the firmware's self-test before the drive; what fails is named and ends the run"},
                 {.name = "--seeds", .into = &arguments->seeds, .help = "run seeds FIRST..LAST; file names get the seed", .value = "A..B"},
                 {.name = "--can",
                  .into = &arguments->can,
                  .help = "no firmware here: the rover's nodes, on this CAN interface, for a computer at its other end (docs/can.md)",
                  .value = "INTERFACE",
                  .excludes = of_firmware},
                 {.name = "--jobs", .into = &arguments->jobs, .help = "runs side by side", .range = Range{1, 256}}},
            .run = [arguments](Outcome &outcome) { run_simulate(*arguments, outcome); }};
}

} // namespace traction::cli
