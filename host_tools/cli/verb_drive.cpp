// traction drive --host ADDR: live values of a running rover, commands with a dead-man's key, its logs and parameters.
#include "rows.h"
#include "verbs.h"

#if TRACTION_WITH_LINK
#include "progress.h"
#include "stop_signal.h"

#include "firmware/core/signals.h"
#include "host_tools/drive/drive.h"
#include "host_tools/drive/telemetry.h"
#include "host_tools/log/write_file.h"

#include <cstdlib>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <limits>
#include <map>
#endif

#include <memory>
#include <string>
#include <vector>

namespace traction::cli {

namespace {

struct DriveOptions {
    std::string host, key, new_key, out, record, live;
    std::vector<std::string> set;
    std::vector<std::string> wheels;
    int system = 1, fetch = 0;
    double speed_m_s = 0, yaw_rate_rad_s = 0, slip = 0, for_s = 5;
    bool speed = false, yaw = false, slips = false, sweep = false, lasting = false, stop = false, logs = false, fetching = false,
         parameters = false;
};

#if TRACTION_WITH_LINK

drive::Order order_of(const DriveOptions &o) {
    drive::Order order{.mode = o.slips   ? MODE_SLIP
                               : o.sweep ? MODE_SOIL_SWEEP
                                         : MODE_PLATFORM_SPEED,
                       .speed_m_s = o.speed_m_s,
                       .yaw_rate_rad_s = o.yaw_rate_rad_s,
                       .slip = o.slip};
    for (const std::string &wheel : o.wheels) {
        if (wheel.size() != 1 || wheel[0] < '0' || wheel[0] >= '0' + WHEEL_COUNT)
            throw UsageError("--wheels " + wheel + ": no wheel; give 0 to " + std::to_string(WHEEL_COUNT - 1) + ", with commas between");
        order.slip_wheels |= 1u << static_cast<unsigned>(wheel[0] - '0');
    }
    if (o.slips && o.wheels.empty()) order.slip_wheels = (1u << WHEEL_COUNT) - 1u;
    return order;
}

nlohmann::json counts_json(const drive::LinkCounts &c) {
    return {{"accepted", c.accepted},
            {"refused_unsigned", c.refused_unsigned},
            {"refused_signature", c.refused_signature},
            {"refused_replay", c.refused_replay},
            {"refused_stale", c.refused_stale},
            {"refused_other", c.refused_other},
            {"broken", c.broken},
            {"losses", c.losses}};
}

nlohmann::json status_json(const drive::Operator &link) {
    const drive::Status &s = link.status();
    nlohmann::json slip = nlohmann::json::array();
    for (const double one : s.slip) slip.push_back(one == one ? nlohmann::json(one) : nlohmann::json());
    return {{"tick", s.tick},
            {"mode", drive::mode_words(s.mode)},
            {"faults", s.faults},
            {"speed_m_s", s.speed_m_s},
            {"speed_std_m_s", s.speed_std_m_s},
            {"set_speed_m_s", s.set_speed_m_s},
            {"slip", slip},
            {"current_A", s.current_A},
            {"battery_V", s.battery_V}};
}

// One line a second.
void tell_link(drive::Operator &link, double &due_s) {
    for (const std::string &text : link.take_texts()) std::printf("rover: %s\n", text.c_str());
    if (link.now_s() < due_s) return;
    std::printf("%s\n", drive::line_of(link).c_str());
    std::fflush(stdout);
    due_s = link.now_s() + 1;
}

void drive_scripted(const DriveOptions &o, drive::Operator &link, Outcome &outcome) {
    double due_s = 0;
    const drive::Order order = order_of(o);
    const drive::Drive result = drive::drive_for(
        link, order, o.for_s, [&] { tell_link(link, due_s); }, [] { return StopSignal::asked() != 0; });
    for (const std::string &text : link.take_texts()) std::printf("rover: %s\n", text.c_str());
    std::printf("%.2f s driven, %zu statuses, mean speed of the second half %.3f m/s; %s\n", result.seconds, result.statuses,
                result.mean_speed_m_s, result.stopped ? "stopped" : "the rover did not confirm the stop: it stops by itself");
    if (!result.trouble.empty()) std::printf("%s\n", result.trouble.c_str());
    outcome.json["drive"] = {{"seconds", result.seconds},
                             {"statuses", result.statuses},
                             {"mean_speed_m_s", result.mean_speed_m_s},
                             {"first_motion_s", result.first_motion_s},
                             {"faults", result.faults},
                             {"stopped", result.stopped},
                             {"trouble", result.trouble}};
    if (!result.trouble.empty() || !result.stopped) outcome.exit_code = exit_negative;
    if (StopSignal::asked() != 0) outcome.exit_code = 128 + StopSignal::asked();
}

void list_logs(drive::Operator &link, Outcome &outcome) {
    nlohmann::json list = nlohmann::json::array();
    for (const drive::LogEntry &entry : link.logs()) {
        char when[40] = "?";
        const std::time_t time = entry.time_s;
        if (std::tm utc{}; gmtime_r(&time, &utc) != nullptr) std::strftime(when, sizeof when, "%Y-%m-%d %H:%M:%S UTC", &utc);
        std::printf("%6u  %10u bytes  %s\n", entry.id, entry.bytes, when);
        list.push_back({{"id", entry.id}, {"bytes", entry.bytes}, {"time_s", entry.time_s}});
    }
    if (list.empty()) std::printf("no logs: its tractiond has no --log folder, or it is empty\n");
    outcome.json["logs"] = list;
}

void fetch(const DriveOptions &o, drive::Operator &link, Outcome &outcome) {
    const std::vector<drive::LogEntry> all = link.logs();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const drive::LogEntry &e) { return e.id == static_cast<unsigned>(o.fetch); });
    if (found == all.end()) throw log::FileError("--fetch " + std::to_string(o.fetch), 0, 0, "is no log of the rover", "--logs lists them");
    double due_s = link.now_s() + 1;
    Progress progress("fetch log " + std::to_string(o.fetch), std::max<long>(1, found->bytes));
    long shown = 0;
    const std::string bytes = link.log(*found, [&](std::size_t got) {
        progress.step(static_cast<long>(got) - shown);
        shown = static_cast<long>(got);
        if (link.now_s() < due_s) return;
        std::fprintf(stderr, "traction: %zu of %u bytes\n", got, found->bytes);
        due_s = link.now_s() + 5;
    });
    log::write_file(bytes, o.out);
    std::printf("%s: %zu bytes\n", o.out.c_str(), bytes.size());
    outcome.json["fetched"] = {{"id", o.fetch}, {"bytes", bytes.size()}, {"out", o.out}};
}

void parameters(const DriveOptions &o, drive::Operator &link, Outcome &outcome) {
    nlohmann::json list = nlohmann::json::object();
    for (const std::string &one : o.set) {
        const std::size_t equals = one.find('=');
        char *end = nullptr;
        const double value = equals == std::string::npos ? 0 : std::strtod(one.c_str() + equals + 1, &end);
        if (end == nullptr || *end != '\0' || end == one.c_str() + equals + 1)
            throw UsageError("--set " + one + ": give NAME=NUMBER; --parameters lists the names");
        const std::string name = one.substr(0, equals);
        const double is = link.set_parameter(name, value);
        const bool done = static_cast<float>(is) == static_cast<float>(value);
        std::printf("%s = %.9g%s\n", name.c_str(), is,
                    done ? "" : ": refused, out of its range or of the rover's file (tractiond --parameters)");
        list[name] = is;
        if (!done) outcome.exit_code = exit_negative;
    }
    if (o.parameters)
        for (const auto &[name, value] : link.parameters()) {
            std::printf("%-16s %.9g\n", name.c_str(), value);
            list[name] = value;
        }
    outcome.json["parameters"] = list;
}

std::map<std::string, std::string> header_of(const drive::Operator &link) {
    std::map<std::string, std::string> header = {{"title", "telemetry of a rover over the supervision link: what its firmware believes"},
                                                 {"machine", "rover at " + link.address()},
                                                 {"quantum.battery.voltage_V", "0.001"}};
    char now[40];
    const std::time_t time = std::time(nullptr);
    if (std::tm utc{}; gmtime_r(&time, &utc) != nullptr && std::strftime(now, sizeof now, "%Y-%m-%dT%H:%M:%SZ", &utc) > 0)
        header["date"] = now;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        header["quantum.wheel" + std::to_string(i) + ".slip"] = "0.0001";
        header["quantum.wheel" + std::to_string(i) + ".current_A"] = "0.01";
    }
    return header;
}

// Nothing is sent but the heartbeat that makes the rover tell.
void record(const DriveOptions &o, Outcome &outcome) {
    const StopSignal signals("\ntraction: ending; what was received is written\n");
    drive::Operator link(o.host, o.key, o.system);
    drive::Telemetry log(o.record);
    log.begin(header_of(link));
    const auto row = [&](const std::string &line) {
        if (!o.live.empty()) log::write_file(line + '\n', "-");
    };
    row(drive::live_names());
    const double seconds = o.lasting ? o.for_s : std::numeric_limits<double>::infinity();
    const drive::Received received = drive::record(link, log, seconds, row, [] { return StopSignal::asked() != 0; });
    if (received.rows == 0) drive::must_be_heard(link, false);
    log.write(header_of(link));
    std::printf("%s: %zu statuses in %.1f s, silent %d times (longest %.1f s)\n", o.record.c_str(), received.rows, received.seconds,
                received.silences, received.longest_s);
    outcome.json = {{"schema", "traction.drive/1"},
                    {"host", o.host},
                    {"system", o.system},
                    {"recorded",
                     {{"out", o.record},
                      {"statuses", received.rows},
                      {"seconds", received.seconds},
                      {"silences", received.silences},
                      {"longest_silence_s", received.longest_s}}},
                    {"status", status_json(link)},
                    {"link", counts_json(link.counts())}};
}

void run_drive(const DriveOptions &o, Outcome &outcome) {
    const bool moves = o.speed || o.yaw || o.slips || o.sweep;
    const bool asks = o.logs || o.fetching || o.parameters || !o.set.empty();
    if (!o.new_key.empty()) {
        drive::make_key(o.new_key);
        std::printf("%s: a new key; copy it to the rover (mode 0600): tractiond --link ADDRESS --link-key FILE\n", o.new_key.c_str());
        outcome.json = {{"schema", "traction.drive/1"}, {"new_key", o.new_key}};
        return;
    }
    if (o.host.empty()) throw UsageError("no --host; give the rover's address, or --new-key FILE to begin with");
    if ((moves || o.stop || !o.set.empty()) && o.key.empty())
        throw UsageError("a command needs the rover's key; give --key FILE (--new-key makes one)");
    if (o.fetching && o.out.empty()) throw UsageError("--fetch needs a file to write: give --out FILE.ulg");
    if (!o.live.empty() && o.record.empty()) throw UsageError("--live shows what --record keeps: give --record LOG.csv too");
    if (!o.record.empty() && (moves || asks || o.stop))
        throw UsageError("--record watches and does nothing else; a second `traction drive` may drive, ask or stop meanwhile");
    if (!o.record.empty()) return record(o, outcome);
    (void)order_of(o); // its mistakes before anything is sent
    const StopSignal signals("\ntraction: stopping the rover\n");
    drive::Operator link(o.host, o.key, o.system);
    drive::meet(link, moves || o.stop || !o.set.empty());
    outcome.json = {{"schema", "traction.drive/1"}, {"host", o.host}, {"system", o.system}};
    const auto stopped = [] { return StopSignal::asked() != 0; };
    if (o.stop) {
        const bool done = drive::stop(link);
        std::printf("%s\n", done ? "the rover is in mode stop" : "the rover did not confirm the stop");
        if (!done) outcome.exit_code = exit_negative;
    }
    if (asks) {
        if (!o.set.empty() || o.parameters) parameters(o, link, outcome);
        if (o.logs) list_logs(link, outcome);
        if (o.fetching) fetch(o, link, outcome);
    }
    if (moves) {
        drive_scripted(o, link, outcome);
    } else if (!asks && !o.stop && isatty(STDIN_FILENO) != 0 && isatty(STDOUT_FILENO) != 0 && !o.lasting) {
        drive::by_hand(link, !o.key.empty(), stopped);
    } else if (!asks && !o.stop) {
        drive::watch(
            link, o.for_s, 1,
            [&] {
                double due_s = 0;
                tell_link(link, due_s);
            },
            stopped);
    }
    outcome.json["status"] = status_json(link);
    outcome.json["link"] = counts_json(link.counts());
}

#else

void run_drive(const DriveOptions &, Outcome &) {
    throw UsageError("not in this build: there was no pymavlink when it was configured; ./traction build brings it (python3-venv)");
}

#endif

std::vector<Option> question_rows(DriveOptions &o) {
    return {{.name = "--logs", .into = &o.logs, .help = "list the on-board logs"},
            {.name = "--fetch",
             .into = &o.fetch,
             .help = "bring log N here, into --out",
             .value = "N",
             .range = Range{0, 65535},
             .given = &o.fetching},
            {.name = "--out",
             .into = &o.out,
             .help = "the log's bytes (ULog: traction convert reads it)",
             .value = "FILE",
             .kind = Kind::output},
            {.name = "--record",
             .into = &o.record,
             .help = "watch, and keep what comes as a log; waits for a rover that is silent; until Ctrl-C, or --for",
             .value = "LOG",
             .kind = Kind::output},
            {.name = "--live",
             .into = &o.live,
             .help = "with --record: speed, slip, currents, battery, mode, faults, age of the link to standard output, ten rows a second",
             .value = "-",
             .kind = Kind::output,
             .one_of = {"-"}},
            {.name = "--parameters", .into = &o.parameters, .help = "list the rover's parameters as they are in force"},
            {.name = "--set",
             .into = &o.set,
             .help = "set one of the link's own parameters (LINK_...) while the rover runs; may be given again",
             .value = "NAME=VALUE",
             .at_most = 1}};
}

} // namespace

Verb verb_drive() {
    const auto options = std::make_shared<DriveOptions>();
    DriveOptions &o = *options;
    return {
        .name = "drive",
        .summary = "watch and drive a running rover over the network, with a dead-man's key; fetch its logs",
        .options = rows(
            {{.name = "--host", .into = &o.host, .help = "where its tractiond --link listens; port 14555 when left out", .value = "ADDR"},
             {.name = "--key",
              .into = &o.key,
              .help = "the rover's key, without which nothing is obeyed",
              .value = "FILE",
              .kind = Kind::input},
             {.name = "--new-key", .into = &o.new_key, .help = "make a key (64 hex digits, mode 0600), and nothing else", .value = "FILE"},
             {.name = "--speed",
              .into = &o.speed_m_s,
              .help = "drive without a terminal: forward speed",
              .value = "M_S",
              .range = Range{-20, 20},
              .given = &o.speed},
             {.name = "--yaw-rate",
              .into = &o.yaw_rate_rad_s,
              .help = "and turn to the left",
              .value = "RAD_S",
              .range = Range{-20, 20},
              .given = &o.yaw},
             {.name = "--slip", .into = &o.slip, .help = "hold this slip instead", .value = "S", .range = Range{-1, 1}, .given = &o.slips},
             {.name = "--wheels",
              .into = &o.wheels,
              .help = "that hold the slip; all when left out",
              .value = "N,N",
              .needs = {"--slip"},
              .delimiter = ',',
              .at_most = 4},
             {.name = "--sweep", .into = &o.sweep, .help = "soil sweep at --speed", .excludes = {"--slip"}},
             {.name = "--for",
              .into = &o.for_s,
              .help = "so long, then stop; without a motion: watch so long",
              .value = "S",
              .shows_default = true,
              .range = Range{0.1, 86400},
              .given = &o.lasting},
             {.name = "--stop", .into = &o.stop, .help = "stop the rover, whoever drives it"},
             {.name = "--system",
              .into = &o.system,
              .help = "the rover's MAVLink number",
              .value = "N",
              .shows_default = true,
              .range = Range{1, 250}}},
            question_rows(o)),
        .run = [options](Outcome &outcome) { run_drive(*options, outcome); },
        .details =
            "In a terminal: hold the space bar to drive, arrows set speed and yaw rate, m turns to slip, + and - set it, q leaves. "
            "80 ms after the last command the rover stops by itself, so it stops when this program ends or the network does. "
            "docs/supervision.md has messages, time-outs and what is refused. Exit code 1: the rover refused, or stopped by a fault."};
}

} // namespace traction::cli
