// board_init - the first and only program that the emulated board's kernel starts: makes the devices, brings the run's files, starts the
// rover's own tractiond, and is the other end of its devices in lockstep with the world outside (lockstep.h).
//
// Files of the run lie in the folder that QEMU was started in: `files` (names to bring, one a line), `arguments` (tractiond's, one a
// line). Taken out at the end: trace.txt, tractiond.txt (what it said) and log/*.
//
// Where a file `defaults` is among them, the program is not this image's but the version that the slots on the NOR flash hold, started as
// on a rover: by traction-slot, its `start`, and `defaults` in place of /etc/default/tractiond. Its log lies on the flash then; of it the
// files of this run are taken out, and the version's own parameters, as parameters.txt.
#include "board_devices.h"
#include "semihosting.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { CHUNK = 65536, ARGUMENTS = 40, TEXT = 8192, EXIT_BROKEN = 70, IDLE_MS = 10, PRIORITY = 60 };

static char chunk[CHUNK]; // what semihosting reads and writes; locked
static bool flashed;      // the version in the slots runs, not this image's
static const char flash_log[] = "/flash/state/log";
static char version[PATH_MAX];    // folder of the version that runs
static char newest[NAME_MAX + 1]; // of the logs that were there before

static _Noreturn void give_up(const char *what) {
    (void)printf("board: %s: %s\n", what, strerror(errno));
    (void)fflush(stdout);
    semihosting_exit(EXIT_BROKEN);
    for (;;) {
        (void)pause();
    }
}

static void make_tree(void) {
    static const char *const mounts[][3] = {{"proc", "/proc", "proc"},
                                            {"sysfs", "/sys", "sysfs"},
                                            {"devtmpfs", "/dev", "devtmpfs"},
                                            {"configfs", "/sys/kernel/config", "configfs"},
                                            {"tmpfs", "/run", "tmpfs"}};
    for (size_t i = 0; i < sizeof mounts / sizeof *mounts; i++) {
        if (mount(mounts[i][0], mounts[i][1], mounts[i][2], 0, "") != 0) {
            give_up(mounts[i][1]);
        }
    }
    const int alignment = open("/proc/cpu/alignment", O_WRONLY | O_CLOEXEC);
    if (alignment < 0 || write(alignment, "4", 1) != 1) { // an unaligned word, which the PXA255 reads wrongly, is a SIGBUS here
        give_up("/proc/cpu/alignment");
    }
    (void)close(alignment);
    if (chdir("/run") != 0 || mkdir("log", 0755) != 0) {
        give_up("/run/log");
    }
}

// --- files in and out

static void bring(const char *name) {
    const int32_t from = semihosting_open(name, SEMIHOSTING_READ);
    const int to = open(name, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (from < 0 || to < 0) {
        give_up(name);
    }
    for (size_t got = 0; (got = semihosting_read_some(from, chunk, CHUNK)) > 0;) {
        if (write(to, chunk, got) != (ssize_t)got) {
            give_up(name);
        }
    }
    semihosting_close(from);
    (void)close(to);
}

static void take_out_as(const char *path, const char *name) {
    const int from = open(path, O_RDONLY | O_CLOEXEC);
    if (from < 0) {
        return; // this run makes none
    }
    const int32_t to = semihosting_open(name, SEMIHOSTING_WRITE);
    for (ssize_t got = 0; to >= 0 && (got = read(from, chunk, CHUNK)) > 0;) {
        if (!semihosting_write(to, chunk, (size_t)got)) {
            give_up(name);
        }
    }
    if (to < 0) {
        give_up(name);
    }
    semihosting_close(to);
    (void)close(from);
}

static void take_out(const char *name) { take_out_as(name, name); }

// The newest of the on-board logs, by their numbers; those of this run are newer.
static void remember_newest(void) {
    DIR *folder = opendir(flash_log);
    for (const struct dirent *entry = folder != NULL ? readdir(folder) : NULL; entry != NULL; entry = readdir(folder)) {
        if (strstr(entry->d_name, ".ulg") != NULL && strcmp(entry->d_name, newest) > 0) {
            (void)snprintf(newest, sizeof newest, "%s", entry->d_name);
        }
    }
    if (folder != NULL) {
        (void)closedir(folder);
    }
}

static void take_out_log(void) {
    const char *from = flashed ? flash_log : "log";
    DIR *folder = opendir(from);
    for (const struct dirent *entry = folder != NULL ? readdir(folder) : NULL; entry != NULL; entry = readdir(folder)) {
        char path[300], name[300];
        const bool ours = !flashed || (strstr(entry->d_name, ".ulg") != NULL && strcmp(entry->d_name, newest) > 0);
        if (entry->d_name[0] != '.' && ours && snprintf(path, sizeof path, "%s/%s", from, entry->d_name) < (int)sizeof path &&
            snprintf(name, sizeof name, "log/%s", entry->d_name) < (int)sizeof name) {
            take_out_as(path, name);
        }
    }
    if (folder != NULL) {
        (void)closedir(folder);
    }
}

// The lines of a file that was brought, at most `room`; returns how many.
static int lines_of(const char *name, char text[TEXT], char **line, int room) {
    const int fd = open(name, O_RDONLY | O_CLOEXEC);
    const ssize_t got = fd >= 0 ? read(fd, text, TEXT - 1) : -1;
    if (got < 0) {
        give_up(name);
    }
    (void)close(fd);
    text[got] = '\0';
    int count = 0;
    for (char *at = strtok(text, "\n"); at != NULL && count < room; at = strtok(NULL, "\n")) {
        line[count++] = at;
    }
    return count;
}

// --- the firmware

static pid_t start_firmware(void) {
    static char text[TEXT];
    static char name[] = "tractiond";
    static char slot[] = "traction-slot", option[] = "--folder", slots[] = "/flash/traction", run[] = "run";
    static char defaults[] = "TRACTIOND_DEFAULTS=/run/defaults", path[] = "PATH=/bin";
    char *argument[ARGUMENTS] = {name};
    const int count = lines_of("arguments", text, argument + 1, ARGUMENTS - 2);
    argument[count + 1] = NULL;
    char *const starter[] = {slot, option, slots, run, NULL};
    const pid_t pid = fork();
    if (pid == 0) {
        const int out = open("tractiond.txt", O_WRONLY | O_CREAT | O_TRUNC, 0644), in = open("/dev/null", O_RDONLY);
        char *const environment[] = {flashed ? defaults : NULL, path, NULL};
        if (out >= 0 && in >= 0 && dup2(in, 0) == 0 && dup2(out, 1) == 1 && dup2(out, 2) == 2) {
            (void)close(out);
            (void)close(in);
            (void)execve(flashed ? "/usr/sbin/traction-slot" : "/sbin/tractiond", flashed ? starter : argument, environment);
        }
        _exit(127);
    }
    if (pid < 0) {
        give_up("fork");
    }
    return pid;
}

// The daemon itself, once it talks: of a flashed version a child of its starter. Its parameters are put aside.
static pid_t program_of(pid_t starter) {
    pid_t found = starter;
    DIR *processes = flashed ? opendir("/proc") : NULL;
    for (const struct dirent *entry = processes != NULL ? readdir(processes) : NULL; entry != NULL; entry = readdir(processes)) {
        char path[300], link[PATH_MAX];
        (void)snprintf(path, sizeof path, "/proc/%.20s/exe", entry->d_name);
        const ssize_t length = entry->d_name[0] >= '1' && entry->d_name[0] <= '9' ? readlink(path, link, sizeof link - 1) : -1;
        link[length > 0 ? length : 0] = '\0';
        if (strstr(link, "/tractiond") != NULL) {
            found = (pid_t)strtol(entry->d_name, NULL, 10);
            (void)snprintf(version, sizeof version, "%.*s", (int)(strrchr(link, '/') - link), link);
        }
    }
    if (processes != NULL) {
        (void)closedir(processes);
    }
    return found;
}

static uint32_t memory_kB(pid_t pid) {
    char path[40], line[120];
    unsigned long size = 0;
    (void)snprintf(path, sizeof path, "/proc/%d/status", (int)pid);
    FILE *status = fopen(path, "r");
    while (status != NULL && fgets(line, sizeof line, status) != NULL) {
        (void)sscanf(line, "VmHWM: %lu", &size);
    }
    if (status != NULL) {
        (void)fclose(status);
    }
    return (uint32_t)size;
}

static int64_t now_ns(clockid_t clock) {
    struct timespec now = {0, 0};
    (void)clock_gettime(clock, &now);
    return now.tv_sec * (int64_t)1000000000 + now.tv_nsec;
}

// --- lockstep

typedef struct {
    int32_t out, in;
    board_devices_t devices;
    struct {
        lockstep_board_t head;
        lockstep_frame_t frame[LOCKSTEP_FRAMES];
    } said;
    lockstep_world_t world;
    lockstep_frame_t frame[LOCKSTEP_FRAMES];
    int32_t sample[LOCKSTEP_SAMPLES];
} lockstep_t;

static lockstep_t lockstep; // locked with everything else

static void say(void) {
    const size_t length = sizeof lockstep.said.head + lockstep.said.head.frames * sizeof *lockstep.frame;
    if (!semihosting_write(lockstep.out, &lockstep.said, length)) {
        give_up("the world is gone");
    }
}

static void hear(void) {
    lockstep_world_t *world = &lockstep.world;
    if (!semihosting_read(lockstep.in, world, sizeof *world) || world->frames > LOCKSTEP_FRAMES || world->samples > LOCKSTEP_SAMPLES ||
        !semihosting_read(lockstep.in, lockstep.frame, world->frames * sizeof *lockstep.frame) ||
        !semihosting_read(lockstep.in, lockstep.sample, world->samples * sizeof *lockstep.sample)) {
        give_up("the world is gone");
    }
    const char *failed = board_devices_give(&lockstep.devices, world, lockstep.frame, lockstep.sample, lockstep.said.head.time_ns);
    if (failed != NULL) {
        give_up(failed);
    }
}

static void serve(pid_t firmware) {
    clockid_t cpu;
    lockstep_board_t *head = &lockstep.said.head;
    bool stopped = false;
    pid_t program = 0;
    for (*head = (lockstep_board_t){.version = LOCKSTEP_VERSION}; head->over == 0u;) {
        struct pollfd wait_for = {.fd = lockstep.devices.can, .events = POLLIN};
        (void)poll(&wait_for, 1, IDLE_MS);
        int status = 0;
        head->frames = board_devices_take(&lockstep.devices, lockstep.said.frame);
        head->time_ns = now_ns(CLOCK_MONOTONIC);
        head->lines = board_devices_lines(&lockstep.devices);
        if (program == 0 && head->frames > 0) { // it talks
            program = program_of(firmware);
            if (clock_getcpuclockid(program, &cpu) != 0) {
                give_up("the firmware's clock");
            }
        }
        if (waitpid(firmware, &status, WNOHANG) == firmware) {
            head->over = 1;
            head->status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        } else if (!stopped && program != 0) {
            head->cpu_ns = now_ns(cpu);
        }
        say();
        if (head->over == 0u) {
            hear();
        }
        if (lockstep.world.stop != 0u && !stopped) {
            stopped = true;
            head->memory_kB = memory_kB(program);
            (void)kill(firmware, SIGTERM);
        }
    }
}

int main(void) {
    static char text[TEXT];
    char *file[ARGUMENTS];
    make_tree();
    const char *failed = board_devices_make(&lockstep.devices);
    if (failed != NULL) {
        give_up(failed);
    }
    const struct sched_param priority = {.sched_priority = PRIORITY}; // above the firmware's, as devices are
    if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0 || sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &priority) != 0) {
        give_up("priority");
    }
    bring("files");
    bring("arguments");
    for (int i = 0, count = lines_of("files", text, file, ARGUMENTS); i < count; i++) {
        bring(file[i]);
    }
    flashed = access("defaults", R_OK) == 0;
    if (flashed) {
        if (mount("mtd0", "/flash", "jffs2", 0, "") != 0) {
            give_up("/flash");
        }
        remember_newest();
    }
    lockstep.out = semihosting_open("to_world", SEMIHOSTING_WRITE);
    lockstep.in = semihosting_open("to_board", SEMIHOSTING_READ);
    if (lockstep.out < 0 || lockstep.in < 0) {
        give_up("to_world, to_board");
    }
    serve(start_firmware());
    take_out("trace.txt");
    take_out("tractiond.txt");
    take_out_log();
    if (flashed) {
        char path[PATH_MAX + 20];
        (void)snprintf(path, sizeof path, "%s/parameters", version);
        take_out_as(path, "parameters.txt");
        (void)umount("/flash");
    }
    semihosting_exit(0);
    return EXIT_BROKEN;
}
