#define _POSIX_C_SOURCE 200809L // clock_gettime
#include "trace_queue.h"

#include "thread.h"

#include <string.h>
#include <time.h>

static void wait_a_second(trace_queue_t *queue)
{
    struct timespec until;
    (void)clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec += 1;
    (void)pthread_cond_timedwait(&queue->changed, &queue->mutex, &until);
}

static void *write_lines(void *context)
{
    trace_queue_t *queue = context;
    char line[TRACE_TEXT];
    time_t spared = 0;
    (void)pthread_mutex_lock(&queue->mutex);
    while (queue->count > 0u || !queue->over) {
        if (queue->count == 0u) {
            wait_a_second(queue);
        }
        const bool have = queue->count > 0u;
        if (have) {
            memcpy(line, queue->line[queue->begin], sizeof line);
            queue->begin = (queue->begin + 1u) % TRACE_QUEUE;
            queue->count--;
            (void)pthread_cond_broadcast(&queue->changed);
        }
        (void)pthread_mutex_unlock(&queue->mutex); // the tick may go on while the file is slow
        if (have && queue->file != NULL) {
            (void)fputs(line, queue->file); // a log that cannot be written does not stop the rover: told at the end
        }
        struct timespec now;
        (void)clock_gettime(CLOCK_MONOTONIC, &now);
        if (queue->spare != NULL && now.tv_sec != spared) {
            spared = now.tv_sec;
            queue->spare(queue->spare_context);
        }
        (void)pthread_mutex_lock(&queue->mutex);
    }
    (void)pthread_mutex_unlock(&queue->mutex);
    if (queue->spare != NULL) {
        queue->spare(queue->spare_context);
    }
    return NULL;
}

bool trace_queue_start(trace_queue_t *queue)
{
    queue->started = pthread_mutex_init(&queue->mutex, NULL) == 0 && pthread_cond_init(&queue->changed, NULL) == 0 &&
                     thread_start(&queue->writer, write_lines, queue);
    return queue->started;
}

void trace_queue_put(trace_queue_t *queue, const char *line)
{
    (void)pthread_mutex_lock(&queue->mutex);
    while (queue->patient && queue->count == TRACE_QUEUE) {
        (void)pthread_cond_wait(&queue->changed, &queue->mutex);
    }
    if (queue->count == TRACE_QUEUE) {
        queue->lost++;
    } else {
        char *at = queue->line[(queue->begin + queue->count) % TRACE_QUEUE];
        (void)strncpy(at, line, TRACE_TEXT - 1);
        at[TRACE_TEXT - 1] = '\0';
        queue->count++;
        (void)pthread_cond_broadcast(&queue->changed);
    }
    (void)pthread_mutex_unlock(&queue->mutex);
}

unsigned long trace_queue_finish(trace_queue_t *queue)
{
    if (!queue->started) {
        return queue->lost;
    }
    (void)pthread_mutex_lock(&queue->mutex);
    queue->over = true;
    (void)pthread_cond_broadcast(&queue->changed);
    (void)pthread_mutex_unlock(&queue->mutex);
    (void)pthread_join(queue->writer, NULL);
    return queue->lost;
}
