#define _POSIX_C_SOURCE 200809L // sigaction, poll, dup2
#include "starter.h"

#include "board_lock.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { EXIT_DONE = 0, EXIT_FILE = 4, EXIT_BUSY = 5, LINE = 120, POLL_MS = 100 };

static volatile sig_atomic_t asked_to_stop, asked_to_choose;

static void hear(int signal)
{
    if (signal == SIGHUP) {
        asked_to_choose = 1;
    } else {
        asked_to_stop = 1;
    }
}

const char *starter_architecture(void)
{
#if defined(__arm__) && !defined(__ARM_PCS_VFP)
    return "armel";
#elif defined(__arm__)
    return "armhf";
#elif defined(__aarch64__)
    return "arm64";
#elif defined(__x86_64__)
    return "amd64";
#else
    return "unknown";
#endif
}

static int64_t now_ms(void)
{
    struct timespec now = {0, 0};
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * (int64_t)1000 + now.tv_nsec / 1000000;
}

// `start word` in its folder, with `health` as descriptor 3 (negative: none). Negative: no process.
static pid_t launch(const char *folder, const char *word, int health)
{
    char path[STORAGE_PATH + 8];
    (void)snprintf(path, sizeof path, "%s/start", folder);
    (void)fflush(stdout);
    const pid_t pid = fork();
    if (pid != 0) {
        return pid;
    }
    const int in = open("/dev/null", O_RDONLY);
    const bool ready = chdir(folder) == 0 && in >= 0 && dup2(in, STDIN_FILENO) >= 0 &&
                       (health < 0 || health == STARTER_HEALTH_FD || dup2(health, STARTER_HEALTH_FD) >= 0);
    if (ready && health == STARTER_HEALTH_FD) {
        (void)fcntl(health, F_SETFD, 0); // dup2 would have cleared it
    }
    if (ready) {
        (void)execl(path, "start", word, (char *)NULL);
    }
    _exit(127);
}

// In words how a process ended.
static void tell_end(int status, char why[SLOTS_NOTE])
{
    if (WIFSIGNALED(status)) {
        (void)snprintf(why, SLOTS_NOTE, "ended by signal %d", WTERMSIG(status));
    } else {
        (void)snprintf(why, SLOTS_NOTE, "ended with exit code %d%s", WEXITSTATUS(status),
                       WEXITSTATUS(status) == 127 ? ": start cannot be run" : "");
    }
}

// Waits until `deadline` for its end; then, or when `stop`, ends it: SIGTERM, and SIGKILL after STARTER_STOP_S.
static int end_process(pid_t pid, bool stop, int64_t deadline)
{
    int status = 0;
    if (stop) {
        (void)kill(pid, SIGTERM);
    }
    while (waitpid(pid, &status, WNOHANG) != pid) {
        const struct timespec moment = {0, 20000000};
        (void)nanosleep(&moment, NULL);
        if (now_ms() >= deadline) {
            (void)kill(pid, SIGKILL);
        }
    }
    return status;
}

int starter_self_test(void *context, const char *folder, char why[SLOTS_NOTE])
{
    (void)context;
    const pid_t pid = launch(folder, "check", -1);
    if (pid < 0) {
        (void)snprintf(why, SLOTS_NOTE, "no process: %s", strerror(errno));
        return -1;
    }
    const int status = end_process(pid, false, now_ms() + STARTER_CHECK_S * 1000);
    tell_end(status, why);
    return status == 0 ? 0 : 1;
}

// --- run

typedef struct {
    const slots_t *slots;
    int lock;
    char word[LINE]; // the last line on the health descriptor
    char line[LINE];
    size_t used;
} starter_t;

// Reads what there is; true once a line says "healthy".
static bool hear_health(starter_t *starter, int health)
{
    char c = 0;
    while (read(health, &c, 1) == 1) {
        if (c != '\n' && starter->used < LINE - 1) {
            starter->line[starter->used++] = c;
            continue;
        }
        starter->line[starter->used] = '\0';
        starter->used = 0;
        (void)snprintf(starter->word, LINE, "%s", starter->line);
        if (strcmp(starter->line, "healthy") == 0) {
            return true;
        }
    }
    return false;
}

static void settle(starter_t *starter, bool healthy, const char *why)
{
    char message[PACKAGE_MESSAGE];
    (void)board_lock_take(starter->lock, BOARD_STATE, true);
    const slots_result_t result = healthy ? slots_confirm(starter->slots, message) : slots_return(starter->slots, why, message);
    (void)board_lock_give(starter->lock, BOARD_STATE);
    (void)printf("traction-slot: %s%s%s\n",
                 healthy ? "the new version is healthy, and the good one from now on" : "the new version is given up: ", healthy ? "" : why,
                 result == SLOTS_DONE ? "" : " (this could not be written)");
    if (result != SLOTS_DONE) {
        (void)printf("traction-slot: %s\n", message);
    }
    (void)fflush(stdout);
}

// Runs the version in this slot until it ends, is to end, or its trial is over. Returns its wait status.
static int run_version(starter_t *starter, int slot, bool on_trial, uint32_t trial_s)
{
    char folder[STORAGE_PATH], why[SLOTS_NOTE] = "";
    int health[2], status = 0;
    slots_path(starter->slots, slot, folder);
    starter->word[0] = '\0';
    starter->used = 0;
    if (pipe(health) != 0 || fcntl(health[0], F_SETFL, O_NONBLOCK) != 0 || fcntl(health[0], F_SETFD, FD_CLOEXEC) != 0 ||
        fcntl(health[1], F_SETFD, FD_CLOEXEC) != 0) {
        return 127 << 8;
    }
    (void)printf("traction-slot: starts slot %c%s\n", slot == SLOT_A ? 'a' : 'b', on_trial ? ", on trial" : "");
    const pid_t pid = launch(folder, "run", health[1]);
    (void)close(health[1]);
    const int64_t deadline = now_ms() + (int64_t)trial_s * 1000;
    bool ended = pid < 0;
    status = pid < 0 ? 127 << 8 : 0;
    while (!ended && asked_to_stop == 0 && asked_to_choose == 0 && !(on_trial && now_ms() >= deadline)) {
        struct pollfd wait_for = {.fd = health[0], .events = POLLIN};
        const int heard = poll(&wait_for, 1, POLL_MS);
        if (heard > 0 && (wait_for.revents & POLLIN) == 0) { // it closed the descriptor
            const struct timespec moment = {0, POLL_MS * 1000000};
            (void)nanosleep(&moment, NULL);
        }
        if (hear_health(starter, health[0]) && on_trial) {
            settle(starter, true, "");
            on_trial = false;
        }
        ended = waitpid(pid, &status, WNOHANG) == pid;
    }
    if (!ended) {
        (void)snprintf(why, sizeof why, "not healthy within %u s: %s", (unsigned)trial_s,
                       starter->word[0] != '\0' ? starter->word : "it said nothing");
        status = end_process(pid, true, now_ms() + STARTER_STOP_S * 1000);
    } else {
        tell_end(status, why);
        (void)printf("traction-slot: the version %s\n", why);
    }
    // asked to stop or to choose anew, the trial was not heard out: it stands, and its starts are counted
    if (on_trial && asked_to_stop == 0 && asked_to_choose == 0) {
        settle(starter, false, why);
    }
    (void)close(health[0]);
    (void)fflush(stdout);
    return ended ? status : 0;
}

// So many tenths of a second, negative: without end; less when a signal asks.
static void sleep_unless_asked(int tenths)
{
    for (int i = 0; asked_to_stop == 0 && asked_to_choose == 0 && (tenths < 0 || i < tenths); i++) {
        const struct timespec tenth = {0, 100000000};
        (void)nanosleep(&tenth, NULL);
    }
}

int starter_run(const slots_t *slots, uint32_t trial_s)
{
    starter_t starter = {.slots = slots};
    char message[PACKAGE_MESSAGE];
    const struct sigaction handle = {.sa_handler = hear}; // no SA_RESTART: a wait ends with the signal
    starter.lock = board_lock_open(slots->folder, message);
    if (starter.lock < 0) {
        (void)fprintf(stderr, "traction-slot: %s\n", message);
        return EXIT_FILE;
    }
    if (!board_lock_take(starter.lock, BOARD_STARTER, false)) {
        (void)fprintf(stderr, "traction-slot: runs already (process %ld)\n", (long)board_lock_holder(starter.lock, BOARD_STARTER));
        return EXIT_BUSY;
    }
    (void)sigaction(SIGTERM, &handle, NULL);
    (void)sigaction(SIGINT, &handle, NULL);
    (void)sigaction(SIGHUP, &handle, NULL);
    while (asked_to_stop == 0) {
        int slot = SLOT_NONE;
        bool on_trial = false;
        asked_to_choose = 0;
        (void)board_lock_take(starter.lock, BOARD_STATE, true);
        const slots_result_t result = slots_start(slots, &slot, &on_trial, message);
        (void)board_lock_give(starter.lock, BOARD_STATE);
        if (message[0] != '\0') {
            (void)fprintf(stderr, "traction-slot: %s\n", message);
        }
        if (result != SLOTS_DONE) { // an empty board waits for its first package
            sleep_unless_asked(-1);
            continue;
        }
        const int status = run_version(&starter, slot, on_trial, trial_s);
        const bool useless = WIFEXITED(status) && (WEXITSTATUS(status) == 2 || WEXITSTATUS(status) == 3);
        if (!on_trial) {
            sleep_unless_asked(useless ? -1 : 10);
        }
    }
    return EXIT_DONE;
}
