// tractiond - the rover's daemon: opens a HAL by its name and runs daemon_run over it until it ends or is asked to stop.
//
// Exit codes: 0 the run ended or was asked to stop (SIGINT, SIGTERM); 1 a device was lost or the self-test failed, the motors are stopped;
// 2 wrong command line; 3 bad input (parameters, scenario, frames); 4 the trace or the log could not be written.
#define _POSIX_C_SOURCE 200809L // sigaction, getopt_long's unistd
#include "daemon.h"
#include "log_ring.h"
#include "parameters.h"
#include "store.h"
#include "trace_queue.h"
#include "trace_text.h"
#include "udp_link.h"

#include "firmware/core/rover_config.h"
#include "hal/forward.h"
#include "hal/open.h"
#include "hal/pace/pace_hal.h"

#include <errno.h>
#include <getopt.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { EXIT_DONE = 0, EXIT_DEVICE_LOST = 1, EXIT_USAGE = 2, EXIT_INPUT = 3, EXIT_FILE = 4 };

enum { LINK_LOG_TICKS = 100 }; // once a second
enum { HEALTHY_TICKS = 1000 }; // 10 s

static volatile sig_atomic_t asked_to_stop;

static void ask_to_stop(int signal)
{
    (void)signal;
    asked_to_stop = 1;
}

typedef struct {
    const char *hal, *parameters, *firmware, *trace, *store, *log, *link, *link_key;
    unsigned long log_budget_MB, link_system, health_fd;
    bool hash, realtime, self_test, help;
} options_t;

static void print_help(void)
{
    (void)puts(
        "usage: tractiond --hal NAME [options] [ARGUMENT...]\n"
        "Runs the rover's firmware on a HAL until it ends, or SIGINT or SIGTERM asks it to stop. The motors are stopped whatever ends it.\n"
        "\n"
        "  --hal NAME          the world to drive, below; the ARGUMENTs are the HAL's\n"
        "  --parameters FILE   the rover's own numbers (traction export --firmware, calibrate, tune)\n"
        "  --firmware NAME     default, or paper: the paper's own estimator and gains\n"
        "  --trace FILE        every trace, one line a tick, floats as their bits; - is standard output\n"
        "  --hash              print the FNV-1a hash over all trace lines at the end\n"
        "  --log FOLDER        on-board log: ULog files, the oldest go when the budget is full; a state dump beside it on a fault\n"
        "  --log-budget MB     of that folder, 1 to 100000 (64)\n"
        "  --link ADDRESS      supervision by MAVLink 2 over UDP on ADDRESS[:14555] of this machine; ticks then take their time "
        "(docs/supervision.md)\n"
        "  --link-key FILE     64 hex digits, mode 0600: who has them may drive by `traction drive`; without it telemetry only\n"
        "  --link-system N     the rover's MAVLink number, 1 to 250 (1)\n"
        "  --store FILE        what must survive a restart (how warm the motors are); read first, kept while driving\n"
        "  --self-test         radar, accelerometer, battery at rest, a small pulse of every wheel, before anything drives\n"
        "  --health-fd N       tell on this open descriptor: \"healthy\" after 10 s of ticks without a fault but a pressed stop, or the "
        "fault\n"
        "  --realtime          a tick of 10 ms takes 10 ms\n"
        "  --help              this\n"
        "\nHALs:");
    size_t count = 0;
    const hal_entry_t *list = hal_list(&count);
    for (size_t i = 0; i < count; i++) {
        (void)printf("  %s %s\n      %s\n", list[i].name, list[i].arguments, list[i].about);
    }
    (void)puts("\nExit codes: 0 ended or asked to stop, 1 a device was lost or the self-test failed, 2 wrong command line, 3 bad input, 4 "
               "the trace could not be "
               "written.");
}

static bool parse_number(const char *option, const char *text, unsigned long high, const char *mend, unsigned long *number)
{
    char *end = NULL;
    *number = strtoul(text, &end, 10);
    const bool good = end != text && *end == '\0' && *number >= 1u && *number <= high && text[0] != '-';
    if (!good) {
        (void)fprintf(stderr, "tractiond: %s %s: %s from 1 to %lu\n", option, text, mend, high);
    }
    return good;
}

// Returns false after telling what is wrong.
static bool parse(int argc, char **argv, options_t *options)
{
    static const struct option known[] = {
        {"hal", required_argument, NULL, 'H'},
        {"parameters", required_argument, NULL, 'p'},
        {"firmware", required_argument, NULL, 'f'},
        {"trace", required_argument, NULL, 't'},
        {"hash", no_argument, NULL, 'x'},
        {"realtime", no_argument, NULL, 'r'},
        {"log", required_argument, NULL, 'l'},
        {"log-budget", required_argument, NULL, 'b'},
        {"store", required_argument, NULL, 's'},
        {"self-test", no_argument, NULL, 'e'},
        {"link", required_argument, NULL, 'L'},
        {"link-key", required_argument, NULL, 'K'},
        {"link-system", required_argument, NULL, 'N'},
        {"health-fd", required_argument, NULL, 'F'},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    for (int letter = 0; (letter = getopt_long(argc, argv, "h", known, NULL)) != -1;) {
        options->hal = letter == 'H' ? optarg : options->hal;
        options->parameters = letter == 'p' ? optarg : options->parameters;
        options->firmware = letter == 'f' ? optarg : options->firmware;
        options->trace = letter == 't' ? optarg : options->trace;
        options->store = letter == 's' ? optarg : options->store;
        options->log = letter == 'l' ? optarg : options->log;
        options->link = letter == 'L' ? optarg : options->link;
        options->link_key = letter == 'K' ? optarg : options->link_key;
        if (letter == 'b' && !parse_number("--log-budget", optarg, 100000u, "not a size; give whole megabytes", &options->log_budget_MB)) {
            return false;
        }
        if (letter == 'N' && !parse_number("--link-system", optarg, 250u, "not a number of a system; give one", &options->link_system)) {
            return false;
        }
        if (letter == 'F' && !parse_number("--health-fd", optarg, 1023u, "not a descriptor; give one", &options->health_fd)) {
            return false;
        }
        options->self_test = options->self_test || letter == 'e';
        options->hash = options->hash || letter == 'x';
        options->realtime = options->realtime || letter == 'r';
        options->help = options->help || letter == 'h';
        if (letter == '?') {
            return false; // getopt has named it
        }
    }
    if (strcmp(options->firmware, "default") != 0 && strcmp(options->firmware, "paper") != 0) {
        (void)fprintf(stderr, "tractiond: --firmware %s: unknown; give default or paper\n", options->firmware);
        return false;
    }
    if (options->link_key != NULL && options->link == NULL) {
        (void)fputs("tractiond: --link-key: without --link there is nobody to believe; give --link ADDRESS\n", stderr);
        return false;
    }
    if (options->hal == NULL && !options->help) {
        (void)fputs("tractiond: no --hal; tractiond --help lists them\n", stderr);
        return false;
    }
    return true;
}

// --- the loop's hooks

typedef struct {
    hal_t inner; // first: hal/forward.h
} stoppable_t;

// The run is over once a signal has asked for it; so the loop ends where it always ends, with the motors stopped.
static hal_result_t wait_unless_stopped(void *context)
{
    const hal_t *inner = &((stoppable_t *)context)->inner;
    const hal_result_t result = asked_to_stop ? HAL_END : inner->wait_tick(inner->context);
    return asked_to_stop && result >= 0 ? HAL_END : result;
}

typedef struct {
    const hal_opened_t *world;
    log_ring_t ring;
    trace_queue_t queue; // what writes the trace and the store beside the ticks
    udp_link_t *link;    // null: none
    int health;          // descriptor; 0: none, or all was said
    uint32_t healthy_ticks, faults_told;
    uint64_t hash;
    bool hashed;
    volatile float rise_K[WHEEL_COUNT];
    const char *store; // null: none
    bool store_failed;
    char message[STORE_MESSAGE];
} drive_t;

static void ask_world(void *context, const sensor_frame_t *frame, command_t *command)
{
    const drive_t *drive = context;
    drive->world->command(drive->world->hal.context, frame, command);
    if (drive->link != NULL) {
        udp_link_command(drive->link, command);
    }
}

static void tell_link(drive_t *drive, const command_t *command, const trace_t *trace)
{
    udp_link_tick(drive->link, trace, command);
    if (drive->ring.started && trace->tick % LINK_LOG_TICKS == 0u) {
        uint32_t counts[ULOG_LINK_COUNTS];
        udp_link_counts(drive->link, counts);
        log_ring_put_link(&drive->ring, trace->tick, counts);
    }
}

// Whether this version of the program may stay (docs/flash.md): said once, or the faults that keep it from being said.
static void tell_health(drive_t *drive, const trace_t *trace)
{
    const uint32_t faults = trace->faults & ~(uint32_t)(FAULT_EMERGENCY_STOP | FAULT_COMMAND_TIMEOUT);
    char line[80];
    drive->healthy_ticks = faults == 0u ? drive->healthy_ticks + 1u : 0u;
    const bool healthy = drive->healthy_ticks >= HEALTHY_TICKS;
    if (!healthy && faults == drive->faults_told) {
        return;
    }
    const int length = healthy ? snprintf(line, sizeof line, "healthy\n") : snprintf(line, sizeof line, "faults %08" PRIx32 "\n", faults);
    drive->faults_told = faults;
    (void)!write(drive->health, line, (size_t)length); // nobody may listen any more
    if (healthy) {
        (void)close(drive->health);
        drive->health = 0;
    }
}

static void log_tick(void *context, const sensor_frame_t *frame, const command_t *command, const trace_t *trace)
{
    drive_t *drive = context;
    if (drive->ring.started) {
        log_ring_put(&drive->ring, frame, command, trace);
    }
    if (drive->link != NULL) {
        tell_link(drive, command, trace);
    }
    if (drive->health != 0) {
        tell_health(drive, trace);
    }
    if (drive->queue.file == NULL && !drive->hashed) {
        return;
    }
    char line[TRACE_TEXT];
    trace_text(trace, line);
    drive->hash = drive->hashed ? trace_text_hash(drive->hash, line) : 0u;
    if (drive->queue.file != NULL) {
        trace_queue_put(&drive->queue, line);
    }
}

// Called by the writing thread, about once a second and at the end.
static void keep_store(void *context)
{
    drive_t *drive = context;
    store_t store;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        store.rise_K[i] = drive->rise_K[i];
    }
    char message[STORE_MESSAGE];
    if (drive->store != NULL && !store_write(drive->store, &store, message)) {
        drive->store_failed = true;
        (void)snprintf(drive->message, sizeof drive->message, "%s", message);
    }
}

static daemon_result_t run(const options_t *options, const control_config_t *config, const hal_opened_t *world, drive_t *drive)
{
    pace_hal_t pace;
    stoppable_t stoppable = {.inner = options->realtime ? pace_hal(&pace, &world->hal) : world->hal};
    hal_t hal = hal_forward(&stoppable);
    hal.wait_tick = wait_unless_stopped;
    const bool logged = drive->queue.file != NULL || drive->hashed || drive->ring.started || drive->link != NULL || drive->health != 0;
    const daemon_link_t link = {.context = drive, .command = ask_world, .log = logged ? log_tick : NULL};
    store_t kept;
    char message[STORE_MESSAGE];
    const bool known = options->store != NULL && store_read(options->store, &kept, message);
    if (options->store != NULL && !known) {
        (void)fprintf(stderr, "tractiond: %s; the motors are taken to be warm\n", message);
    }
    const daemon_start_t start = {
        .self_test = options->self_test, .warm = options->store != NULL, .rise_K = known ? kept.rise_K : NULL, .rise_out_K = drive->rise_K};
    return daemon_run_from(&hal, config, &link, &start);
}

// Says how it ended; returns the exit code.
static int report(const options_t *options, const hal_opened_t *world, const daemon_result_t *result)
{
    const char *trouble = world->trouble(world->hal.context);
    if (result->ended_by < 0) {
        (void)fprintf(stderr, "tractiond: %s; motors stopped after %" PRIu32 " ticks\n", *trouble != '\0' ? trouble : "a device was lost",
                      result->ticks);
        const bool input = *trouble != '\0' && (!world->devices || result->ended_by == HAL_ERR_CONFIG);
        return input ? EXIT_INPUT : EXIT_DEVICE_LOST;
    }
    if (result->self_test.failures != 0u) {
        for (int32_t i = 0; i < SELF_TEST_FAILURES; i++) {
            if ((result->self_test.failures & (1u << (uint32_t)i)) != 0u) {
                (void)fprintf(stderr, "tractiond: self-test: %s (wheels %" PRIx32 ")\n", self_test_name(i), result->self_test.wheels);
            }
        }
        return EXIT_DEVICE_LOST;
    }
    (void)fprintf(stderr, "tractiond: %s, %" PRIu32 " ticks, motors stopped; faults seen %08" PRIx32 "\n",
                  asked_to_stop ? "asked to stop" : options->hal, result->ticks, result->faults);
    return EXIT_DONE;
}

static FILE *open_trace(const char *path)
{
    FILE *file = strcmp(path, "-") == 0 ? stdout : fopen(path, "w");
    if (file == NULL) {
        (void)fprintf(stderr, "tractiond: %s: cannot be written: %s\n", path, strerror(errno));
    }
    return file;
}

// The trace's file closed; false after telling what of it is missing.
static bool close_trace(const options_t *options, FILE *file, unsigned long lost)
{
    const bool kept = file == NULL || ferror(file) == 0;
    const bool closed = file == NULL || file == stdout || fclose(file) == 0;
    const bool whole = kept && closed && fflush(stdout) == 0;
    if (!whole) {
        (void)fprintf(stderr, "tractiond: %s: the trace could not be written whole\n", options->trace != NULL ? options->trace : "-");
    }
    if (lost > 0u) {
        (void)fprintf(stderr, "tractiond: %s: %lu lines of the trace were lost, the file was too slow\n", options->trace, lost);
    }
    return whole && lost == 0u;
}

// The supervision link, where one is asked for. false: it could not be had, which was told.
static bool start_link(const options_t *options, const control_config_t *config, const rover_parameters_t *rover, drive_t *drive)
{
    if (options->link == NULL) {
        return true;
    }
    char message[UDP_LINK_MESSAGE] = "";
    const udp_link_options_t link = {.address = options->link,
                                     .key = options->link_key,
                                     .logs = options->log,
                                     .rover = rover,
                                     .speed_max_m_s = config->speed_control.speed_max_m_s,
                                     .yaw_max_rad_s = rover->value[ROVER_yaw_rate_max_rad_s],
                                     .patience_ms = config->safety.command_patience_ticks * TICK_US / 1000u,
                                     .system = (uint8_t)options->link_system};
    drive->link = udp_link_start(&link, message);
    (void)fprintf(stderr, "tractiond: %s\n", message);
    return drive->link != NULL;
}

static int drive_world(const options_t *options, const control_config_t *config, const rover_parameters_t *rover, const hal_opened_t *world)
{
    static drive_t drive; // 500 kB of queues: not on the stack
    drive.world = world;
    drive.hash = TRACE_HASH_BEGIN;
    drive.hashed = options->hash;
    drive.health = (int)options->health_fd;
    drive.store = options->store;
    drive.queue.patient = !options->realtime && !world->devices; // the world waits: every line is kept
    drive.queue.spare = keep_store;
    drive.queue.spare_context = &drive;
    if (options->trace != NULL && (drive.queue.file = open_trace(options->trace)) == NULL) {
        return EXIT_FILE;
    }
    if ((options->trace != NULL || options->store != NULL) && !trace_queue_start(&drive.queue)) {
        (void)fputs("tractiond: no thread for the trace could be started\n", stderr);
        return EXIT_FILE;
    }
    char refused[LOG_RING_MESSAGE];
    drive.ring.patient = drive.queue.patient;
    if (options->log != NULL && !log_ring_start(&drive.ring, options->log, (uint64_t)options->log_budget_MB * 1000000u, refused)) {
        (void)fprintf(stderr, "tractiond: --log %s\n", refused);
        (void)trace_queue_finish(&drive.queue);
        return EXIT_FILE;
    }
    if (!start_link(options, config, rover, &drive)) {
        (void)trace_queue_finish(&drive.queue);
        (void)log_ring_finish(&drive.ring);
        return EXIT_INPUT;
    }
    const daemon_result_t result = run(options, config, world, &drive);
    if (drive.link != NULL) {
        udp_link_finish(drive.link);
    }
    const unsigned long lines_lost = trace_queue_finish(&drive.queue);
    const uint32_t ticks_lost = log_ring_finish(&drive.ring);
    int code = report(options, world, &result);
    if (drive.ring.failed[0] != '\0' || ticks_lost > 0u) {
        (void)fprintf(stderr, "tractiond: --log: %s%s%" PRIu32 " ticks were lost, the disk was too slow\n", drive.ring.failed,
                      drive.ring.failed[0] != '\0' ? "; " : "", ticks_lost);
        code = code == EXIT_DONE ? EXIT_FILE : code;
    }
    if (options->hash && code == EXIT_DONE) {
        (void)printf("%016" PRIx64 "\n", drive.hash);
    }
    if (!close_trace(options, drive.queue.file, lines_lost)) {
        code = code == EXIT_DONE ? EXIT_FILE : code;
    }
    if (drive.store_failed) {
        (void)fprintf(stderr, "tractiond: %s\n", drive.message);
        code = code == EXIT_DONE ? EXIT_FILE : code;
    }
    return code;
}

int main(int argc, char **argv)
{
    options_t options = {.firmware = "default", .log_budget_MB = 64, .link_system = 1};
    if (!parse(argc, argv, &options)) {
        return EXIT_USAGE;
    }
    if (options.help) {
        print_help();
        return fflush(stdout) == 0 ? EXIT_DONE : EXIT_FILE;
    }
    control_config_t config = strcmp(options.firmware, "paper") == 0 ? rover_config_paper() : rover_config_default();
    static doppler_template_t beam; // of an own radar, as long as the process; 25 kB: not on the stack
    char refused[PARAMETERS_MESSAGE];
    rover_parameters_t rover;
    rover_parameters_reference(&rover);
    if (options.parameters != NULL && !parameters_read_whole(options.parameters, &config, &rover, &beam, refused)) {
        (void)fprintf(stderr, "tractiond: %s\n", refused);
        return EXIT_INPUT;
    }
    if (strcmp(options.firmware, "paper") == 0) {
        control_config_make_paper(&config); // over any rover
    }
    hal_opened_t world;
    char message[HAL_MESSAGE];
    const hal_result_t opened = hal_open(options.hal, argc - optind, (const char *const *)(argv + optind), &world, message);
    if (message[0] != '\0') {
        (void)fprintf(stderr, "tractiond: %s\n", message);
    }
    if (opened < 0) {
        return opened == HAL_ERR_CONFIG ? EXIT_USAGE : EXIT_INPUT;
    }
    const struct sigaction stop = {.sa_handler = ask_to_stop}; // no SA_RESTART: a wait ends with the signal
    const struct sigaction ignore = {.sa_handler = SIG_IGN};
    (void)sigaction(SIGINT, &stop, NULL);
    (void)sigaction(SIGTERM, &stop, NULL);
    (void)sigaction(SIGPIPE, &ignore, NULL); // a reader that went away is an error of writing, not an end without a stop
    options.realtime = options.realtime || (options.link != NULL && !world.devices); // an operator's time is the wall clock's
    const int code = drive_world(&options, &config, &rover, &world);
    world.close(world.hal.context);
    return code;
}
