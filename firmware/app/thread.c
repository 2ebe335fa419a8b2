#include "thread.h"

bool thread_start(pthread_t *thread, void *(*run)(void *context), void *context)
{
    pthread_attr_t small;
    if (pthread_attr_init(&small) != 0) {
        return false;
    }
    const bool started = pthread_attr_setstacksize(&small, THREAD_STACK) == 0 && pthread_create(thread, &small, run, context) == 0;
    (void)pthread_attr_destroy(&small);
    return started;
}
