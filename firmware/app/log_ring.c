#define _POSIX_C_SOURCE 200809L // fileno, fdatasync, clock_gettime
#include "log_ring.h"

#include "thread.h"

#include "hal/replay/frames.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

// Of the build (cmake/version.cmake where there is a commit).
#ifndef TRACTION_VERSION
#define TRACTION_VERSION "unknown"
#endif

enum { FILES = 8, DUMP_AFTER_TICKS = 50, CHUNK = 4096 };

static const uint64_t least_budget = 1000000;

static void fail(log_ring_t *ring, const char *path)
{
    if (ring->failed[0] == '\0') {
        (void)snprintf(ring->failed, sizeof ring->failed, "%.200s: cannot be written: %.60s", path, strerror(errno));
    }
}

static const char log_name[] = "log", dump_name[] = "fault";

static void path_in(const char *folder, const char *kind, uint32_t number, char path[LOG_RING_PATH])
{
    (void)snprintf(path, LOG_RING_PATH, "%s/%s_%06" PRIu32 ".%s", folder, kind, number, strcmp(kind, log_name) == 0 ? "ulg" : "txt");
}

static void path_of(const log_ring_t *ring, const char *kind, uint32_t number, char path[LOG_RING_PATH])
{
    path_in(ring->folder, kind, number, path);
}

void log_ring_path(const char *folder, uint32_t number, char path[LOG_RING_PATH]) { path_in(folder, log_name, number, path); }

// The number of a file that is one of ours; 0: it is none.
static uint32_t number_of(const char *name)
{
    const char *digits = strncmp(name, "log_", 4) == 0 ? name + 4 : NULL;
    char *rest = NULL;
    const unsigned long number = digits != NULL ? strtoul(digits, &rest, 10) : 0;
    return rest != NULL && rest - digits >= 6 && strcmp(rest, ".ulg") == 0 && number < UINT32_MAX ? (uint32_t)number : 0u;
}

typedef struct {
    uint32_t oldest, newest; // 0: none
    uint64_t bytes;
} holdings_t;

static bool look(const log_ring_t *ring, holdings_t *held)
{
    *held = (holdings_t){.bytes = 0};
    DIR *folder = opendir(ring->folder);
    if (folder == NULL) {
        return false;
    }
    for (const struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        const uint32_t number = number_of(entry->d_name);
        char path[LOG_RING_PATH];
        struct stat about;
        if (number == 0u) {
            continue;
        }
        path_of(ring, log_name, number, path);
        held->bytes += stat(path, &about) == 0 ? (uint64_t)about.st_size : 0u;
        held->oldest = held->oldest == 0u || number < held->oldest ? number : held->oldest;
        held->newest = number > held->newest ? number : held->newest;
    }
    (void)closedir(folder);
    return true;
}

size_t log_ring_list(const char *folder, log_ring_file_t *files, size_t room)
{
    size_t count = 0;
    DIR *all = opendir(folder);
    for (const struct dirent *entry = all != NULL ? readdir(all) : NULL; entry != NULL; entry = readdir(all)) {
        const uint32_t number = number_of(entry->d_name);
        char path[LOG_RING_PATH];
        struct stat about;
        log_ring_path(folder, number, path);
        if (number == 0u || stat(path, &about) != 0 || (count == room && number < files[0].number)) {
            continue;
        }
        if (count == room) { // the oldest gives way
            memmove(files, files + 1, --count * sizeof *files);
        }
        size_t at = count++;
        for (; at > 0u && files[at - 1u].number > number; at--) {
            files[at] = files[at - 1u];
        }
        files[at] = (log_ring_file_t){.number = number,
                                      .bytes = about.st_size < (off_t)UINT32_MAX ? (uint32_t)about.st_size : UINT32_MAX,
                                      .time_s = (uint32_t)about.st_mtime};
    }
    if (all != NULL) {
        (void)closedir(all);
    }
    return count;
}

// Room for one more file within the budget; the newest is never taken away.
static void make_room(const log_ring_t *ring)
{
    holdings_t held;
    char path[LOG_RING_PATH];
    while (look(ring, &held) && held.bytes + ring->budget_bytes / FILES > ring->budget_bytes && held.oldest < held.newest) {
        path_of(ring, dump_name, held.oldest, path);
        (void)remove(path);
        path_of(ring, log_name, held.oldest, path);
        if (remove(path) != 0) {
            return;
        }
    }
}

static bool write_bytes(log_ring_t *ring, const uint8_t *bytes, size_t length)
{
    char path[LOG_RING_PATH];
    if (ring->file != NULL && fwrite(bytes, 1, length, ring->file) == length) {
        ring->file_bytes += length;
        return true;
    }
    path_of(ring, log_name, ring->number, path);
    fail(ring, path);
    return false;
}

static bool next_file(log_ring_t *ring)
{
    char path[LOG_RING_PATH];
    uint8_t head[ULOG_HEAD];
    if (ring->file != NULL && fclose(ring->file) != 0) {
        path_of(ring, log_name, ring->number, path);
        fail(ring, path);
    }
    make_room(ring);
    ring->number++;
    ring->file_bytes = 0;
    path_of(ring, log_name, ring->number, path);
    ring->file = fopen(path, "wb");
    if (ring->file == NULL) {
        fail(ring, path);
        return false;
    }
    return write_bytes(ring, head, ulog_head(ring->first_tick, TRACTION_VERSION, head)) && fflush(ring->file) == 0;
}

// --- the queue: two bytes of length, then that many, of whole ULog messages of one tick

static void queue_bytes(log_ring_t *ring, const uint8_t *bytes, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        ring->queue[(ring->begin + ring->count + i) % LOG_RING_QUEUE] = bytes[i];
    }
    ring->count += length;
}

// Under the mutex. false: no room.
static bool queue_block(log_ring_t *ring, const uint8_t *bytes, size_t length)
{
    const uint8_t size[2] = {(uint8_t)length, (uint8_t)(length >> 8u)};
    while (ring->patient && ring->count + length + sizeof size > LOG_RING_QUEUE) {
        (void)pthread_cond_wait(&ring->changed, &ring->mutex);
    }
    if (ring->count + length + sizeof size > LOG_RING_QUEUE) {
        return false;
    }
    queue_bytes(ring, size, sizeof size);
    queue_bytes(ring, bytes, length);
    (void)pthread_cond_broadcast(&ring->changed);
    return true;
}

static size_t take_block(log_ring_t *ring, uint8_t out[CHUNK])
{
    const size_t length = ring->queue[ring->begin] | (size_t)ring->queue[(ring->begin + 1u) % LOG_RING_QUEUE] << 8u;
    for (size_t i = 0; i < length && i < CHUNK; i++) {
        out[i] = ring->queue[(ring->begin + 2u + i) % LOG_RING_QUEUE];
    }
    ring->begin = (ring->begin + 2u + length) % LOG_RING_QUEUE;
    ring->count -= length + 2u;
    (void)pthread_cond_broadcast(&ring->changed);
    return length;
}

// --- the writing thread

static void bring_to_disk(log_ring_t *ring)
{
    char path[LOG_RING_PATH];
    if (ring->file != NULL && (fflush(ring->file) != 0 || fdatasync(fileno(ring->file)) != 0)) {
        path_of(ring, log_name, ring->number, path);
        fail(ring, path);
    }
}

// Whole or not at all, as store.h.
static void write_dump(log_ring_t *ring)
{
    char path[LOG_RING_PATH], temporary[LOG_RING_PATH + 8], line[FRAMES_LINE];
    path_of(ring, dump_name, ring->number, path);
    (void)snprintf(temporary, sizeof temporary, "%s.new", path);
    FILE *file = fopen(temporary, "w");
    bool good = file != NULL;
    const uint32_t held = ring->past_ticks < LOG_RING_PAST ? ring->past_ticks : LOG_RING_PAST;
    for (uint32_t i = 0; i < held && good; i++) {
        const log_ring_past_t *past = &ring->past[(ring->past_ticks - held + i) % LOG_RING_PAST];
        (void)frames_print(&past->frame, &past->command, line);
        good = fputs(line, file) >= 0;
    }
    good = good && fflush(file) == 0 && fsync(fileno(file)) == 0;
    if (file != NULL) {
        good = fclose(file) == 0 && good && rename(temporary, path) == 0;
    }
    if (!good) {
        fail(ring, path);
    }
}

static void wait_a_second(log_ring_t *ring)
{
    struct timespec until;
    (void)clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec += 1;
    (void)pthread_cond_timedwait(&ring->changed, &ring->mutex, &until);
}

static void *write_files(void *context)
{
    log_ring_t *ring = context;
    uint8_t block[CHUNK];
    time_t synced = 0;
    (void)pthread_mutex_lock(&ring->mutex);
    while (ring->count > 0u || !ring->over || ring->dump_due) {
        if (ring->count == 0u && !ring->over && !ring->dump_due) {
            wait_a_second(ring);
        }
        const size_t length = ring->count > 0u ? take_block(ring, block) : 0u;
        const bool dump = ring->dump_due;
        (void)pthread_mutex_unlock(&ring->mutex); // the ticks go on while the disk is slow
        if (dump) {
            write_dump(ring); // the past stands still until dump_due is false again
        }
        if (length > 0u && ring->file_bytes > ring->budget_bytes / FILES - CHUNK) {
            (void)next_file(ring);
        }
        if (length > 0u) {
            (void)write_bytes(ring, block, length);
        }
        struct timespec now;
        (void)clock_gettime(CLOCK_MONOTONIC, &now);
        if (now.tv_sec != synced) {
            synced = now.tv_sec;
            bring_to_disk(ring);
        }
        (void)pthread_mutex_lock(&ring->mutex);
        ring->dump_due = ring->dump_due && !dump;
    }
    (void)pthread_mutex_unlock(&ring->mutex);
    bring_to_disk(ring);
    return NULL;
}

bool log_ring_start(log_ring_t *ring, const char *folder, uint64_t budget_bytes, char message[LOG_RING_MESSAGE])
{
    holdings_t held = {.bytes = 0};
    message[0] = '\0';
    if (budget_bytes < least_budget || strlen(folder) >= sizeof ring->folder) {
        (void)snprintf(message, LOG_RING_MESSAGE, "%.160s: a budget below 1 MB, or too long a name", folder);
        return false;
    }
    (void)snprintf(ring->folder, sizeof ring->folder, "%s", folder);
    ring->budget_bytes = budget_bytes;
    const bool there = mkdir(folder, 0755) == 0 || errno == EEXIST;
    if (!there || !look(ring, &held)) {
        (void)snprintf(message, LOG_RING_MESSAGE, "%.160s: is no folder to write in: %.60s", folder, strerror(errno));
        return false;
    }
    ring->number = held.newest;
    if (!next_file(ring)) {
        (void)snprintf(message, LOG_RING_MESSAGE, "%s", ring->failed);
        return false;
    }
    ring->started = pthread_mutex_init(&ring->mutex, NULL) == 0 && pthread_cond_init(&ring->changed, NULL) == 0 &&
                    thread_start(&ring->writer, write_files, ring);
    if (!ring->started) {
        (void)snprintf(message, LOG_RING_MESSAGE, "%.160s: no thread for the log could be started", folder);
    }
    return ring->started;
}

// What is new in this tick in words, and when the dump of it is due.
static size_t note_faults(log_ring_t *ring, const trace_t *trace, uint8_t *out)
{
    const uint32_t fresh = trace->faults & ~ring->faults;
    ring->faults = trace->faults; // one that was cleared and comes again is new again
    if (fresh == 0u) {
        return 0;
    }
    if (!ring->dumped && ring->dump_in == 0u) {
        ring->dump_in = DUMP_AFTER_TICKS;
    }
    char text[80];
    (void)snprintf(text, sizeof text, "fault %08" PRIx32 ", wheels %" PRIx32 " (docs/firmware.md, faults)", fresh, trace->fault_wheels);
    return ulog_text(trace->tick, 3, text, out);
}

void log_ring_put(log_ring_t *ring, const sensor_frame_t *frame, const command_t *command, const trace_t *trace)
{
    uint8_t block[ULOG_TICK + 2 * ULOG_TEXT];
    (void)pthread_mutex_lock(&ring->mutex);
    if (!ring->dump_due) {
        log_ring_past_t *past = &ring->past[ring->past_ticks++ % LOG_RING_PAST];
        past->frame = *frame;
        past->command = *command;
    }
    if (ring->dump_in > 0u && --ring->dump_in == 0u) {
        ring->dumped = ring->dump_due = true;
    }
    size_t length = ring->lost_now > 0u ? ulog_dropout(ring->lost_now, block) : 0u;
    length += note_faults(ring, trace, block + length);
    length += ulog_tick(frame, command, trace, block + length);
    const bool kept = queue_block(ring, block, length);
    ring->lost_now = kept ? 0u : ring->lost_now + 1u;
    ring->lost += kept ? 0u : 1u;
    (void)pthread_mutex_unlock(&ring->mutex);
}

void log_ring_put_link(log_ring_t *ring, uint32_t tick, const uint32_t counts[ULOG_LINK_COUNTS])
{
    uint8_t block[ULOG_TEXT];
    const size_t length = ulog_link(tick, counts, block);
    (void)pthread_mutex_lock(&ring->mutex);
    (void)queue_block(ring, block, length);
    (void)pthread_mutex_unlock(&ring->mutex);
}

uint32_t log_ring_finish(log_ring_t *ring)
{
    char path[LOG_RING_PATH];
    if (!ring->started) {
        return ring->lost;
    }
    (void)pthread_mutex_lock(&ring->mutex);
    ring->dump_due = ring->dump_due || ring->dump_in > 0u; // the run ended within half a second of its fault
    ring->over = true;
    (void)pthread_cond_broadcast(&ring->changed);
    (void)pthread_mutex_unlock(&ring->mutex);
    (void)pthread_join(ring->writer, NULL);
    ring->started = false;
    if (ring->file != NULL && fclose(ring->file) != 0) {
        path_of(ring, log_name, ring->number, path);
        fail(ring, path);
    }
    ring->file = NULL;
    return ring->lost;
}
