// log_ring.h - the on-board log: a folder of ULog files with a budget of bytes, written by a thread of its own.
//
//   log_000001.ulg, log_000002.ulg, ...   a new one at each start and when one is an eighth of the budget; the oldest go            (1)
//   fault_000002.txt                      state dump: the frames from 2 s before the run's first fault to 0.5 s after it, as hal/replay
//   reads
//                                         them (tractiond --hal replay); its number is that of the log under way
//
// A tick never waits for the disk: what finds no room in 256 kB of queue (6 s) is lost, counted, and told in the file (ULog's dropout).
// Files are brought to the disk once a second, so that a power cut costs at most the last second, and at a cut anywhere only whole messages
// count.
#ifndef TRACTION_FIRMWARE_APP_LOG_RING_H
#define TRACTION_FIRMWARE_APP_LOG_RING_H

#include "ulog.h"

#include "firmware/core/signals.h"

#include <pthread.h>
#include <stddef.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { LOG_RING_QUEUE = 256 * 1024, LOG_RING_PATH = 512, LOG_RING_MESSAGE = 300, LOG_RING_PAST = 256 };

typedef struct {
    sensor_frame_t frame;
    command_t command;
} log_ring_past_t;

typedef struct {
    char folder[LOG_RING_PATH - 40];
    uint64_t budget_bytes;
    bool patient; // a full queue is waited for: where the world waits too
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    pthread_t writer;
    bool started, over;
    uint8_t queue[LOG_RING_QUEUE];
    size_t begin, count;
    uint32_t lost_now, lost; // ticks that found no room: since the last that did; in all
    uint32_t faults;         // seen in this run
    // state dump: what was, and when it is to be written
    log_ring_past_t past[LOG_RING_PAST];
    uint32_t past_ticks, dump_in;
    bool dumped, dump_due;
    // of the writing thread
    FILE *file;
    uint32_t number, first_tick;
    uint64_t file_bytes;
    char failed[LOG_RING_MESSAGE]; // the first thing that could not be written; one line
} log_ring_t;

// Starts a file and the thread. Zero *ring and set `patient` before. budget_bytes: at least 1 MB. false: message says why, in one line.
bool log_ring_start(log_ring_t *ring, const char *folder, uint64_t budget_bytes, char message[LOG_RING_MESSAGE]);

// One tick, with a line where a fault is new.
void log_ring_put(log_ring_t *ring, const sensor_frame_t *frame, const command_t *command, const trace_t *trace);

// What came over the supervision link, as ulog_link has it; lost without a word where the queue is full.
void log_ring_put_link(log_ring_t *ring, uint32_t tick, const uint32_t counts[ULOG_LINK_COUNTS]);

// The logs of such a folder, the newest `room` of them by rising number; returns how many.
typedef struct {
    uint32_t number, bytes, time_s; // bytes: at most 4 GB are told; last written, seconds since 1970
} log_ring_file_t;
size_t log_ring_list(const char *folder, log_ring_file_t *files, size_t room);
void log_ring_path(const char *folder, uint32_t number, char path[LOG_RING_PATH]);

// Waits until all is written; returns how many ticks were lost. What failed stands in `failed`, "" if nothing.
uint32_t log_ring_finish(log_ring_t *ring);

#ifdef __cplusplus
}
#endif

#endif
