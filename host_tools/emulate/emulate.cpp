#include "emulate.h"

#include "machine.h"

#include "firmware/app/parameters.h"
#include "firmware/app/store.h"
#include "firmware/app/trace_text.h"
#include "hal/forward.h"
#include "hal/replay/frames.h"
#include "hal/sim/plan_operator.h"
#include "host_tools/board/board_log.h"
#include "host_tools/log/write_file.h"
#include "host_tools/loop/loop.h"
#include "host_tools/rover/rover.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <utility>

namespace traction::emulate {

namespace {

constexpr std::int64_t silent_ns = 60000000000; // of the board's clock: whoever has sent nothing by then drives nothing; a boot takes 2 s

std::string text_of(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// By coreutils, which every Debian has.
std::string sha256_of(const std::string &path) {
    std::string quoted = "'";
    for (const char c : path) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    std::FILE *pipe = ::popen(("sha256sum <" + quoted + "'").c_str(), "r");
    char digits[65] = "";
    const bool read = pipe != nullptr && std::fscanf(pipe, "%64s", digits) == 1;
    if (pipe != nullptr) ::pclose(pipe);
    if (!read) throw std::runtime_error(path + ": sha256sum cannot read it");
    return digits;
}

// The board's own description: which devices its kernel has (emulate/board_devices.c).
std::string hardware_text(Sensors sensors, int radar_rate_Hz) {
    std::string text = "[hardware]\nwheels = \"can\"\ncan_interface = \"can0\"\nemergency_stop = \"gpio\"\ngpio_chip = \"gpiochip0\"\n";
    const auto line = [&text](const char *key, int number) { text += std::string(key) + " = " + std::to_string(number) + '\n'; };
    line("emergency_stop_line", LOCKSTEP_LINE_STOP);
    line("emergency_stop_present_line", LOCKSTEP_LINE_STOP_PRESENT);
    line("motor_enable_line", LOCKSTEP_LINE_MOTOR_ENABLE);
    line("led_line", LOCKSTEP_LINE_LED);
    line("brake_line", LOCKSTEP_LINE_BRAKE);
    text += "watchdog = \"watchdog\"\nwatchdog_s = 1\npriority = 50\n";
    if (sensors == Sensors::can) return text + "sensors = \"can\"\n";
    text += "sensors = \"iio\"\nradar_device = \"iio:device0\"\nradar_channel = \"in_voltage0\"\n";
    line("radar_rate_Hz", radar_rate_Hz);
    text += "battery = \"iio:device0/in_voltage1_raw\"\n";
    for (const char *kind : {"accel", "anglvel"})
        for (const char *axis : {"x", "y", "z"})
            text += std::string(kind[1] == 'n' ? "gyro" : kind) + '_' + axis + " = \"iio:device0/in_" + kind + '_' + axis + "_raw\"\n";
    return text;
}

std::string parameters_text(const sim::Scenario &scenario) {
    parameters_t parameters = firmware_parameters(believed(scenario));
    if (const std::int32_t i = parameters_find("doppler_scale"); scenario.firmware.doppler_scale > 0) {
        parameters.rover.value[i] = static_cast<float>(scenario.firmware.doppler_scale);
        parameters.given[i] = true;
    }
    std::string text(PARAMETERS_TEXT, '\0');
    text.resize(parameters_write(&parameters, ("the firmware's parameters for " + scenario.name).c_str(), text.data()));
    return text;
}

// The drive plan as tractiond reads it: one line a tick, of which the command counts.
std::string commands_text(const sim::Scenario &scenario) {
    hal::PlanOperator plan(scenario);
    std::string text = "# commands of " + scenario.name + "\n";
    const auto ticks = static_cast<std::uint32_t>(scenario.duration_s * 100 + 0.5);
    for (std::uint32_t tick = 0; tick < ticks; tick++) {
        sensor_frame_t frame{};
        frame.tick = tick;
        char line[FRAMES_LINE];
        const command_t command = plan.command_at(tick);
        text.append(line, frames_print(&frame, &command, line));
    }
    return text;
}

// For a version that was flashed: what belongs to the board and not to it (firmware/flash/start). The world's motors are cold at the start
// of a scenario, and the store says so; the log is kept on the flash, for whoever fetches it.
void lay_out_flashed(const sim::Scenario &scenario, const Options &options) {
    store_t cold{};
    char refused[STORE_MESSAGE];
    if (!store_write((options.folder + "/store").c_str(), &cold, refused)) throw std::runtime_error(refused);
    log::write_file("STATE=/run\nTRACTIOND_HAL=linux\nTRACTIOND_OPTIONS='--firmware " + scenario.firmware.config +
                        " --trace /run/trace.txt --log /flash/state/log --log-budget 32'\nTRACTIOND_ARGUMENTS=commands=/run/commands.txt\n"
                        "mkdir -p /flash/state\n",
                    options.folder + "/defaults");
    log::write_file("commands.txt\ndefaults\nstore\n", options.folder + "/files");
    log::write_file("\n", options.folder + "/arguments");
}

// The run's folder as the board expects it.
void lay_out(const sim::Scenario &scenario, const Options &options) {
    std::filesystem::create_directories(options.folder);
    std::filesystem::remove_all(options.folder + "/log");
    std::filesystem::remove(options.folder + "/trace.txt");
    std::filesystem::create_directories(options.folder + "/log");
    const int rate_Hz = static_cast<int>(scenario.sensors.radar.rate_Hz + 0.5);
    const auto put = [&options](const char *name, const std::string &text) { log::write_file(text, options.folder + '/' + name); };
    put("commands.txt", commands_text(scenario));
    if (!options.flash.empty()) {
        lay_out_flashed(scenario, options);
        return;
    }
    put("rover.toml", hardware_text(options.sensors, rate_Hz));
    put("parameters.txt", options.parameters.empty() ? parameters_text(scenario) : text_of(options.parameters));
    put("files", "rover.toml\nparameters.txt\ncommands.txt\n");
    put("arguments", "--hal\nlinux\n--parameters\nparameters.txt\n--firmware\n" + scenario.firmware.config +
                         "\n--trace\ntrace.txt\n--log\nlog\nrover.toml\ncommands=commands.txt\n");
}

std::uint32_t lines_of(const std::string &path) {
    const std::string text = text_of(path);
    return static_cast<std::uint32_t>(std::count(text.begin(), text.end(), '\n'));
}

// What the last line of a trace says is latched (firmware/app/trace_text.c).
std::uint32_t last_faults(const std::string &path) {
    std::ifstream file(path);
    unsigned tick = 0, faults = 0, mode = 0;
    for (std::string line; std::getline(file, line);)
        if (std::sscanf(line.c_str(), "%u %u %x", &tick, &mode, &faults) != 3)
            throw std::runtime_error(path + ": is no trace of tractiond");
    return faults;
}

// The trace of the same firmware on the same rover in this process, line beside line.
class Beside : public Link {
  public:
    Beside(const sim::Scenario &scenario, const std::string &trace) : plan_(scenario), board_(trace) {}
    bool over() override { return differs_; }
    void command(const sensor_frame_t &frame, command_t &command) override { command = plan_.command_at(frame.tick); }
    void log(const sensor_frame_t &, const command_t &, const trace_t &trace) override {
        char line[TRACE_TEXT];
        trace_text(&trace, line);
        std::string there, here(line);
        if (!std::getline(board_, there)) return;
        here.pop_back(); // its newline
        if (here == there) {
            result.ticks++;
            return;
        }
        differs_ = true;
        result.tick = result.ticks;
        result.here = here;
        result.there = there;
    }
    Difference result;
    bool differs() const { return differs_; }

  private:
    hal::PlanOperator plan_;
    std::ifstream board_;
    bool differs_ = false;
};

// The rover of the simulation with the board's clock: what it read when the encoders were latched.
struct BoardClock {
    hal_t inner{}; // first: hal/forward.h
    std::vector<std::uint32_t> time_us;
};

hal_t with_clock(BoardClock &clock) {
    hal_t hal = hal_forward(&clock);
    hal.read = [](void *context, sensor_frame_t *frame) {
        const auto *self = static_cast<const BoardClock *>(context);
        const hal_result_t result = self->inner.read(self->inner.context, frame);
        if (frame->tick < self->time_us.size()) frame->time_us = self->time_us[frame->tick];
        return result;
    };
    return hal;
}

std::vector<std::uint32_t> times_of(const std::vector<std::string> &logs) {
    std::vector<std::uint32_t> time_us;
    for (const std::string &path : logs)
        for (const board::BoardTick &tick : board::read_board_log(path).ticks) {
            time_us.resize(std::max<std::size_t>(time_us.size(), tick.frame.tick + std::size_t{1}));
            time_us[tick.frame.tick] = tick.frame.time_us;
        }
    return time_us;
}

} // namespace

Run run_on_board(const sim::Scenario &scenario, const Options &options) {
    World world(scenario, options.effects, options.seed, options.sensors);
    lay_out(scenario, options);
    Run run;
    Machine machine(options.board, options.folder, options.flash);
    std::int64_t begin_ns = 0, begin_cpu_ns = 0;
    for (std::uint32_t seconds = 0;;) {
        const BoardSays board = machine.hear();
        const WorldSays answer = world.hear(board);
        if (world.counts().ticks > 0 && begin_ns == 0) {
            begin_ns = board.head.time_ns;
            begin_cpu_ns = board.head.cpu_ns;
        }
        run.cpu_s = static_cast<double>(board.head.cpu_ns - begin_cpu_ns) * 1e-9;
        run.ran_s = begin_ns > 0 ? static_cast<double>(board.head.time_ns - begin_ns) * 1e-9 : 0;
        run.memory_kB = board.head.memory_kB;
        run.status = board.head.status;
        if (board.head.over != 0u) break;
        WorldSays said = answer;
        if (world.counts().ticks == 0 && board.head.time_ns > silent_ns) said.head.stop = 1; // its words are handed out at its end
        run.interrupted = run.interrupted || (options.stopped && options.stopped());
        if (run.interrupted) said.head.stop = 1;
        machine.say(said);
        for (; world.counts().ticks / 100 > seconds; seconds++)
            if (options.after_second) options.after_second();
    }
    machine.finish();
    run.counts = world.counts();
    run.said = text_of(options.folder + "/tractiond.txt");
    if (!std::filesystem::exists(options.folder + "/trace.txt")) throw std::runtime_error("on the board: " + run.said);
    run.ticks = lines_of(options.folder + "/trace.txt");
    run.faults = last_faults(options.folder + "/trace.txt");
    run.trace_sha = sha256_of(options.folder + "/trace.txt");
    run.records_sha = sha256_of(options.folder + "/records");
    for (const auto &entry : std::filesystem::directory_iterator(options.folder + "/log"))
        if (entry.path().extension() == ".ulg") run.logs.push_back(entry.path().string());
    std::sort(run.logs.begin(), run.logs.end());
    return run;
}

Difference compare_in_process(const sim::Scenario &scenario, const Options &options, const Run &run) {
    const hal::SimHalConfig world = hal::world_of(scenario, options.effects, options.seed);
    auto bus = hal::make_can_bus({.faults = scenario.can_faults,
                                  .latency_ms = static_cast<int>(hal::actuation_delay_ms(options.effects)),
                                  .seed = options.seed,
                                  .order_late_ms = run.counts.order_late_ms,
                                  .stop_wired = true,
                                  .sensors_wired = options.sensors == Sensors::iio});
    control_config_t config = scenario.firmware.config == "paper" ? rover_config_paper() : rover_config_default();
    const auto beam = std::make_unique<doppler_template_t>();
    char refused[PARAMETERS_MESSAGE];
    const std::string file = options.folder + "/parameters.txt"; // the very one that the board had
    if (!parameters_read(file.c_str(), &config, beam.get(), refused)) throw std::runtime_error(refused);
    if (scenario.firmware.config == "paper") control_config_make_paper(&config);
    // the bus has the whole delay of the motors' orders, so that none waits elsewhere
    hal::SimRover rover(scenario, {}, world, std::move(bus));
    Beside beside(scenario, options.folder + "/trace.txt");
    BoardClock clock{rover.hal(), times_of(run.logs)};
    (void)run_loop(with_clock(clock), config, beside);
    beside.result.equal = !beside.differs() && beside.result.ticks == lines_of(options.folder + "/trace.txt");
    return beside.result;
}

} // namespace traction::emulate
