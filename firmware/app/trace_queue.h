// trace_queue.h - a log that never makes a tick wait: lines go into a bounded queue, a thread of its own writes them.
//
// A disk that stalls for longer than the queue lasts (2.5 s) costs lines, which are counted and told, not ticks. A run that is not bound to
// the wall clock waits instead: there every line is kept.
#ifndef TRACTION_FIRMWARE_APP_TRACE_QUEUE_H
#define TRACTION_FIRMWARE_APP_TRACE_QUEUE_H

#include "trace_text.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { TRACE_QUEUE = 256 }; // lines

typedef struct {
    FILE *file;
    bool patient;            // a full queue is waited for, not dropped
    void (*spare)(void *at); // called by the writing thread about once a second, and at the end; may be null
    void *spare_context;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    pthread_t writer;
    char line[TRACE_QUEUE][TRACE_TEXT];
    unsigned begin, count;
    unsigned long lost; // lines that found no room
    bool over, started;
} trace_queue_t;

// Starts the thread. Set file, patient and spare before; leave the rest zero. false: no thread could be started.
bool trace_queue_start(trace_queue_t *queue);

// Puts a line in; unless `patient`, never waits for the file.
void trace_queue_put(trace_queue_t *queue, const char *line);

// Waits until all is written; returns how many lines were lost.
unsigned long trace_queue_finish(trace_queue_t *queue);

#ifdef __cplusplus
}
#endif

#endif
