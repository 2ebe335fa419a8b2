// verb_emulate.cpp - traction emulate SCENARIO: the shipped tractiond on the emulated board, in lockstep with the scenario's plant.
#include "verbs.h"

#if TRACTION_WITH_EMULATE
#include "progress.h"
#include "rows.h"
#include "stop_signal.h"

#include "host_tools/board/board_log.h"
#include "host_tools/emulate/emulate.h"
#include "host_tools/report/report.h"
#include "host_tools/rover/rover.h"
#include "host_tools/simulate/fault_names.h"
#include "sim/scenario/hidden.h"
#include "sim/scenario/scenario.h"
#endif

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

namespace traction::cli {

namespace {

struct EmulateArguments {
    std::string scenario, out, keep, seal, rover, parameters, sensors = "can", board, flash;
    std::int64_t seed = -1, hide = -1;
    std::vector<std::string> effects;
};

#if TRACTION_WITH_EMULATE
using namespace emulate;

// Where the run's files lie: the user's folder, or one that goes with this object.
class RunFolder {
  public:
    explicit RunFolder(const std::string &keep) : path(keep), temporary_(keep.empty()) {
        if (!temporary_) return;
        std::string name = (std::filesystem::temp_directory_path() / "traction-emulate.XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": no folder for the run can be made there");
        path = name;
    }
    RunFolder(const RunFolder &) = delete;
    RunFolder &operator=(const RunFolder &) = delete;
    ~RunFolder() {
        std::error_code none;
        if (temporary_) std::filesystem::remove_all(path, none);
    }
    std::string path;

  private:
    bool temporary_;
};

std::string board_folder(const EmulateArguments &arguments) {
    const char *const named = std::getenv("TRACTION_BOARD"); // set by ./traction, which builds it
    const std::string folder = !arguments.board.empty() ? arguments.board : named != nullptr ? named : "";
    if (folder.empty())
        throw UsageError(
            "no emulated board: `./traction emulate` of the source tree builds it and its kernel; or name its folder by --board");
    return folder;
}

Options emulate_options(const EmulateArguments &arguments, const sim::Scenario &scenario, const std::string &folder) {
    Options options;
    options.board = board_folder(arguments);
    options.folder = folder;
    options.parameters = arguments.parameters;
    options.flash = arguments.flash;
    options.seed = arguments.seed >= 0 ? static_cast<std::uint64_t>(arguments.seed) : scenario.seed;
    options.sensors = arguments.sensors == "iio" ? Sensors::iio : Sensors::can;
    options.effects = scenario.effects;
    for (const std::string &text : arguments.effects) options.effects.push_back(sim::parse_effect(text));
    std::optional<sim::HiddenDraw> hide = scenario.hidden;
    if (arguments.hide >= 0) hide = sim::HiddenDraw{.seed = static_cast<std::uint64_t>(arguments.hide), .count = 1, .among = {}};
    if (!hide) return options;
    const std::vector<sim::ActiveEffect> hidden = sim::draw_effects(*hide);
    options.effects.insert(options.effects.end(), hidden.begin(), hidden.end());
    if (!arguments.seal.empty()) report::write_text(sim::seal_text(hidden, scenario.name, hide->seed), arguments.seal);
    return options;
}

// The board's log as one of ours.
void keep_log(const EmulateArguments &arguments, const sim::Scenario &scenario, const Run &run) {
    if (arguments.out.empty()) return;
    if (run.logs.empty()) throw std::runtime_error("the board wrote no log; tractiond said: " + run.said);
    log::write_csv(board::to_log(board::read_board_log(run.logs.front()), believed(scenario)), arguments.out);
}

void tell_run(const Run &run, const Difference &difference) {
    std::printf("tractiond: %s",
                run.said.substr(run.said.rfind("tractiond: ") == std::string::npos ? 0 : run.said.rfind("tractiond: ") + 11).c_str());
    const double share = run.ran_s > 0 ? 100 * run.cpu_s / run.ran_s : 0;
    std::printf(
        "on the board's clock: CPU %.1f %%, a tick begins 0 to %.0f us late, its orders are out %.0f to %.0f us after that; %u kB\n", share,
        run.counts.late.most - run.counts.late.least, run.counts.order.least, run.counts.order.most, run.memory_kB);
    std::printf("trace: %u ticks, SHA-256 %s\n", run.ticks, run.trace_sha.c_str());
    std::printf("records: SHA-256 %s\n", run.records_sha.c_str());
    if (difference.equal)
        std::printf("the simulation in process has the same trace, tick for tick\n");
    else
        std::printf(
            "the simulation in process differs from tick %u on (docs/emulated_board.md says where it may)\n  here  %s\n  board %s\n",
            difference.tick, difference.here.c_str(), difference.there.c_str());
}

nlohmann::json run_json(const sim::Scenario &scenario, const Options &options, const Run &run, const Difference &difference) {
    return {{"schema", "traction.emulate/1"},
            {"scenario", scenario.name},
            {"seed", options.seed},
            {"sensors", options.sensors == Sensors::iio ? "iio" : "can"},
            {"ticks", run.ticks},
            {"status", run.status},
            {"interrupted", run.interrupted},
            {"faults", run.faults},
            {"fault_names", fault_names(run.faults)},
            {"trace_sha256", run.trace_sha},
            {"records_sha256", run.records_sha},
            {"equal_in_process", difference.equal},
            {"equal_ticks", difference.ticks},
            {"frames_from_board", run.counts.frames_from},
            {"frames_to_board", run.counts.frames_to},
            {"unread_ticks", run.counts.unread},
            {"cpu_share", run.ran_s > 0 ? run.cpu_s / run.ran_s : 0},
            {"tick_jitter_us", run.counts.late.most - run.counts.late.least},
            {"order_least_us", run.counts.order.least},
            {"order_most_us", run.counts.order.most},
            {"memory_kB", run.memory_kB}};
}

void run_emulate(const EmulateArguments &arguments, Outcome &outcome) {
    for (const std::string &text : arguments.effects) need_effect("--effect", text, ":");
    sim::Scenario scenario = sim::read_scenario(arguments.scenario);
    if (!arguments.rover.empty()) sim::set_rover(scenario, sim::read_rover_file(arguments.rover));
    const RunFolder folder(arguments.keep);
    Options options = emulate_options(arguments, scenario, folder.path);
    const StopSignal stop;
    Run done;
    {
        Progress progress("emulate " + scenario.name, static_cast<long>(scenario.duration_s + 0.5));
        options.stopped = [] { return StopSignal::asked() != 0; };
        options.after_second = [&progress] { progress.step(); };
        done = run_on_board(scenario, options);
    }
    keep_log(arguments, scenario, done);
    const Difference difference = compare_in_process(scenario, options, done);
    std::printf("%s: %.1f s on the emulated board\n", scenario.name.c_str(), static_cast<double>(done.ticks) / 100);
    tell_run(done, difference);
    outcome.json = run_json(scenario, options, done, difference);
    if (!arguments.keep.empty()) std::printf("trace, log and records of the lockstep: %s\n", arguments.keep.c_str());
    if (const std::string names = fault_names(done.faults); !names.empty())
        std::printf("ended with a latched fault: %s (docs/firmware.md, faults)\n", names.c_str());
    if (done.status != 0 || !difference.equal || done.faults != 0) outcome.exit_code = exit_negative;
    if (const int signal = StopSignal::asked(); signal != 0) outcome.exit_code = 128 + signal;
}
#else
void run_emulate(const EmulateArguments &, Outcome &) {
    throw UsageError("this build has no CAN bus (cantools was not there); `./traction emulate` of the source tree brings it");
}
#endif

} // namespace

Verb verb_emulate() {
    const auto arguments = std::make_shared<EmulateArguments>();
    return {
        .name = "emulate",
        .summary = "drive a scenario with the rover's own program on an emulated ARM board, in lockstep with the plant",
        .options = {{.argument = "SCENARIO",
                     .into = &arguments->scenario,
                     .help = "scenario file (scenarios/*.toml)",
                     .kind = Kind::scenario,
                     .required = true},
                    {.name = "--out",
                     .into = &arguments->out,
                     .help = "the board's log as a log of ours, CSV",
                     .value = "LOG",
                     .kind = Kind::output},
                    {.name = "--keep",
                     .into = &arguments->keep,
                     .help = "keep what the board wrote (trace, on-board log, its words) and the records of the lockstep in this folder",
                     .value = "FOLDER",
                     .kind = Kind::folder},
                    {.name = "--seed", .into = &arguments->seed, .help = "instead of the scenario's seed", .range = Range{.low = 0}},
                    {.name = "--effect",
                     .into = &arguments->effects,
                     .help = "add an effect: 'name:parameter=value,wheel=2' (traction effects lists them)",
                     .value = "EFFECT",
                     .kind = Kind::effect},
                    {.name = "--hide",
                     .into = &arguments->hide,
                     .help = "hide an effect drawn by this seed",
                     .value = "SEED",
                     .range = Range{.low = 0}},
                    {.name = "--seal",
                     .into = &arguments->seal,
                     .help = "write what was hidden to this file",
                     .value = "FILE",
                     .kind = Kind::output,
                     .needs = {"--hide"}},
                    {.name = "--rover",
                     .into = &arguments->rover,
                     .help = "the rover that drives (rovers/*.toml) instead of the scenario's",
                     .value = "FILE",
                     .kind = Kind::rover},
                    {.name = "--parameters",
                     .into = &arguments->parameters,
                     .help = "the firmware's numbers (traction export --firmware) instead of those of the scenario's rover",
                     .value = "FILE",
                     .kind = Kind::input},
                    {.name = "--sensors",
                     .into = &arguments->sensors,
                     .help = "where radar, IMU and battery end: at a node of the CAN bus, or at converters of the board",
                     .shows_default = true,
                     .one_of = {"can", "iio"}},
                    {.name = "--board",
                     .into = &arguments->board,
                     .help = "folder of zImage, versatile-pb.dtb and initramfs instead of TRACTION_BOARD, which ./traction sets",
                     .value = "FOLDER",
                     .kind = Kind::folder},
                    {.name = "--flash",
                     .into = &arguments->flash,
                     .help = "the board's NOR flash: what `traction flash` put into its slots drives (emulate/flash_board.sh)",
                     .value = "FILE",
                     .kind = Kind::input,
                     .excludes = {"--parameters"}}},
        .run = [arguments](Outcome &outcome) { run_emulate(*arguments, outcome); },
        .details =
            "The program is the very file that goes onto the rover: ARMv5TE, SocketCAN, GPIO lines, IIO. QEMU counts its instructions, "
            "and while the world computes the whole board stands still, so a run repeats bit for bit on a loaded machine too.\n\n"
            "Exit codes: 1 where the run ended with a latched fault, or its trace is not that of the simulation in process."};
}

} // namespace traction::cli
