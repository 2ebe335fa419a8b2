// traction-slot - the board's end of traction flash: takes packages into the free slot, starts the right slot, confirms or returns.
//
// Exit codes: 0 done; 1 no: self-test failed, returned to the old version, no version to run; 2 wrong command line; 3 the package is
// refused; 4 a file cannot be read or written, or no room; 5 busy: another installer, or a version on trial.
#define _POSIX_C_SOURCE 200809L // fcntl, nanosleep
#include "board_lock.h"
#include "slots.h"
#include "starter.h"

#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { EXIT_DONE = 0, EXIT_NO = 1, EXIT_USAGE = 2, EXIT_REFUSED = 3, EXIT_FILE = 4, EXIT_BUSY = 5 };

typedef struct {
    const char *folder, *key, *rover, *command, *file;
    unsigned long trial_s, wait_s;
    bool dry_run, no_restart;
} options_t;

static int usage(const char *what)
{
    if (what != NULL) {
        (void)fprintf(stderr, "traction-slot: %s; traction-slot --help tells all\n", what);
        return EXIT_USAGE;
    }
    (void)printf(
        "usage: traction-slot [--folder DIR] COMMAND\n"
        "The rover's two slots of software (docs/flash.md); traction flash --host calls this over ssh.\n\n"
        "  init --key FILE --rover NAME   make this board obey a signer's public key (traction flash --new-key), under this name\n"
        "  install [--dry-run] [--no-restart] [FILE]   take a package (- or nothing: standard input) into the free slot, on trial\n"
        "  run [--trial-seconds N]        start the right version and stay: what the board's init calls\n"
        "  status [--wait N]              which version runs; wait at most N seconds for a trial's end\n"
        "  return                         give up the version on trial\n"
        "  --folder DIR                   where the slots are (/opt/traction)\n\n"
        "Exit codes: 0 done, 1 no (self-test failed, returned, nothing to run), 2 wrong command line, 3 package refused, 4 file error or "
        "no room, 5 busy.\n");
    return fflush(stdout) == 0 ? EXIT_DONE : EXIT_FILE;
}

static bool parse_seconds(const char *option, const char *text, unsigned long *seconds)
{
    char *end = NULL;
    *seconds = strtoul(text, &end, 10);
    if (end == text || *end != '\0' || text[0] == '-' || *seconds < 1u || *seconds > 3600u) {
        (void)fprintf(stderr, "traction-slot: %s %s: not a time; give whole seconds from 1 to 3600\n", option, text);
        return false;
    }
    return true;
}

static bool parse(int argc, char **argv, options_t *options, bool *help)
{
    static const struct option known[] = {
        {"folder", required_argument, NULL, 'f'},        {"key", required_argument, NULL, 'k'},  {"rover", required_argument, NULL, 'r'},
        {"trial-seconds", required_argument, NULL, 't'}, {"wait", required_argument, NULL, 'w'}, {"dry-run", no_argument, NULL, 'd'},
        {"no-restart", no_argument, NULL, 'n'},          {"help", no_argument, NULL, 'h'},       {NULL, 0, NULL, 0},
    };
    for (int letter = 0; (letter = getopt_long(argc, argv, "h", known, NULL)) != -1;) {
        options->folder = letter == 'f' ? optarg : options->folder;
        options->key = letter == 'k' ? optarg : options->key;
        options->rover = letter == 'r' ? optarg : options->rover;
        options->dry_run = options->dry_run || letter == 'd';
        options->no_restart = options->no_restart || letter == 'n';
        *help = *help || letter == 'h';
        if ((letter == 't' && !parse_seconds("--trial-seconds", optarg, &options->trial_s)) ||
            (letter == 'w' && !parse_seconds("--wait", optarg, &options->wait_s)) || letter == '?') {
            return false;
        }
    }
    options->command = optind < argc ? argv[optind] : "";
    options->file = optind + 1 < argc ? argv[optind + 1] : "-";
    if (optind + 2 < argc || (optind + 1 < argc && strcmp(options->command, "install") != 0)) {
        (void)fprintf(stderr, "traction-slot: %s: one word too many\n", argv[argc - 1]);
        return false;
    }
    if (strlen(options->folder) > 300) {
        (void)fprintf(stderr, "traction-slot: --folder: longer than 300 letters\n");
        return false;
    }
    return true;
}

static void tell_step(void *context, const char *message)
{
    (void)context;
    (void)printf("%s\n", message);
    (void)fflush(stdout); // ssh shows it as it comes
}

static int told(slots_result_t result, const char *message)
{
    if (message[0] != '\0') {
        (void)fprintf(result == SLOTS_SAME ? stdout : stderr, "%s%s\n", result == SLOTS_SAME ? "" : "traction-slot: ", message);
    }
    switch (result) {
    case SLOTS_DONE:
    case SLOTS_SAME:
        return EXIT_DONE;
    case SLOTS_REFUSED:
        return EXIT_REFUSED;
    case SLOTS_BUSY:
        return EXIT_BUSY;
    case SLOTS_FULL:
    case SLOTS_BROKEN:
        return EXIT_FILE;
    case SLOTS_UNFIT:
    case SLOTS_EMPTY:
        break;
    }
    return EXIT_NO;
}

static int init(const slots_t *slots, const options_t *options)
{
    char text[2 * LMS_PUBLIC + 2], message[PACKAGE_MESSAGE];
    uint8_t key[LMS_PUBLIC];
    if (options->key == NULL || options->rover == NULL) {
        return usage("init: give --key FILE and --rover NAME");
    }
    const long got = slots->storage.read(slots->storage.context, options->key, 0, text, sizeof text);
    if (got < 0) {
        (void)fprintf(stderr, "traction-slot: %s: cannot be read: %s\n", options->key, strerror((int)-got));
        return EXIT_FILE;
    }
    if ((got != 2 * LMS_PUBLIC && got != 2 * LMS_PUBLIC + 1) || !package_unhex(text, LMS_PUBLIC, key) || key[3] < 5 || key[3] > 9) {
        (void)fprintf(stderr, "traction-slot: %s: no public key; traction flash --new-key FILE writes one to FILE.pub\n", options->key);
        return EXIT_REFUSED;
    }
    const int code = told(slots_init(slots, key, options->rover, message), message);
    if (code == EXIT_DONE) {
        (void)printf("%s: this is %s, and it obeys this key\n", slots->folder, options->rover);
    }
    return code;
}

// The whole package in memory, so that nothing is written before all of it is known. Null after telling why.
static uint8_t *read_package(const char *path, size_t *length)
{
    const int file = strcmp(path, "-") == 0 ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
    uint8_t *bytes = file >= 0 ? malloc(PACKAGE_BYTES + 1) : NULL;
    ssize_t part = 1;
    if (bytes == NULL) {
        (void)fprintf(stderr, "traction-slot: %s: cannot be read: %s\n", path, strerror(errno));
        return NULL;
    }
    for (*length = 0; part > 0 && *length <= PACKAGE_BYTES;) {
        part = read(file, bytes + *length, PACKAGE_BYTES + 1 - *length);
        part = part < 0 && errno == EINTR ? 1 : part;
        *length += part > 0 ? (size_t)part : 0u;
    }
    if (part < 0 || *length > PACKAGE_BYTES) {
        (void)fprintf(stderr, "traction-slot: %s: cannot be read: %s\n", path, part < 0 ? strerror(errno) : "larger than any package");
        free(bytes);
        return NULL;
    }
    return bytes;
}

static int install(const slots_t *slots, const options_t *options)
{
    char message[PACKAGE_MESSAGE];
    const int lock = board_lock_open(slots->folder, message);
    if (lock < 0) {
        return told(SLOTS_BROKEN, message);
    }
    if (!board_lock_take(lock, BOARD_INSTALLER, false)) {
        (void)snprintf(message, sizeof message, "another installer is at work (process %ld); wait for it",
                       (long)board_lock_holder(lock, BOARD_INSTALLER));
        return told(SLOTS_BUSY, message);
    }
    size_t length = 0;
    uint8_t *bytes = read_package(options->file, &length);
    if (bytes == NULL) {
        return EXIT_FILE;
    }
    // without BOARD_STATE: a starter writes the state for a trial alone, and then this is refused; its version may be started anew
    // meanwhile
    const slots_result_t result = slots_install(slots, bytes, length, options->dry_run, message);
    free(bytes);
    if (result == SLOTS_DONE && !options->dry_run && !options->no_restart) {
        const pid_t starter = board_lock_holder(lock, BOARD_STARTER);
        const bool asked = starter > 0 && kill(starter, SIGHUP) == 0;
        tell_step(NULL, asked ? "the running version is stopped and the new one started"
                              : "no version runs: the new one is tried at the next start");
    }
    return told(result, message);
}

// The last line is what happened last. With --wait: 0 confirmed, 1 returned, 5 still on trial.
static int status(const slots_t *slots, const options_t *options)
{
    char message[PACKAGE_MESSAGE];
    slots_state_t state;
    slots_state(slots, &state);
    for (unsigned long waited = 0; state.trial >= 0 && waited < options->wait_s * 5u; waited++) {
        const struct timespec fifth = {0, 200000000};
        (void)nanosleep(&fifth, NULL);
        slots_state(slots, &state);
    }
    package_t package;
    for (int slot = SLOT_A; slot <= SLOT_B; slot++) {
        if (slots_whole(slots, slot, &package)) {
            (void)printf("slot %c: number %" PRIu32 ", version %s, commit %s%s\n", slot == SLOT_A ? 'a' : 'b', package.number,
                         package.version, package.commit,
                         slot == state.good    ? ", good"
                         : slot == state.trial ? ", on trial"
                                               : "");
        }
    }
    const int lock = board_lock_open(slots->folder, message);
    const bool runs = lock >= 0 && board_lock_holder(lock, BOARD_STARTER) > 0;
    const char *now = !runs                               ? "no version runs: traction-slot run is not started"
                      : state.good < 0 && state.trial < 0 ? "traction-slot run waits for the first version"
                                                          : "a version runs";
    (void)printf("%s\n%s\n", now, state.note);
    if (options->wait_s > 0 && state.trial >= 0) {
        return EXIT_BUSY;
    }
    return options->wait_s > 0 && strncmp(state.note, "returned", 8) == 0 ? EXIT_NO : EXIT_DONE;
}

static int give_up(const slots_t *slots)
{
    char message[PACKAGE_MESSAGE];
    const int lock = board_lock_open(slots->folder, message);
    if (lock < 0) {
        return told(SLOTS_BROKEN, message);
    }
    (void)board_lock_take(lock, BOARD_STATE, true);
    const slots_result_t result = slots_return(slots, "by hand", message);
    (void)board_lock_give(lock, BOARD_STATE);
    const pid_t starter = board_lock_holder(lock, BOARD_STARTER);
    if (result == SLOTS_DONE && starter > 0) {
        (void)kill(starter, SIGHUP);
    }
    return told(result, message);
}

int main(int argc, char **argv)
{
    options_t options = {.folder = "/opt/traction", .trial_s = 60};
    bool help = false;
    if (!parse(argc, argv, &options, &help)) {
        return EXIT_USAGE;
    }
    if (help) {
        return usage(NULL);
    }
    slots_t slots = {.storage = storage_posix(),
                     .folder = options.folder,
                     .architecture = starter_architecture(),
                     .self_test = starter_self_test,
                     .step = tell_step};
    if (strcmp(options.command, "init") == 0) {
        return init(&slots, &options);
    }
    if (strcmp(options.command, "install") == 0) {
        return install(&slots, &options);
    }
    if (strcmp(options.command, "run") == 0) {
        return starter_run(&slots, (uint32_t)options.trial_s);
    }
    if (strcmp(options.command, "status") == 0) {
        return status(&slots, &options);
    }
    if (strcmp(options.command, "return") == 0) {
        return give_up(&slots);
    }
    return usage(options.command[0] == '\0' ? "no command" : "unknown command");
}
