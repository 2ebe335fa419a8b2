// thread.h - a thread of the daemon beside its ticks, with a small stack.
//
// Where memory is locked (hal/linux, `priority`) a stack is resident whole: libc's 8 MB are an eighth of the KoreBot's memory, each.
#ifndef TRACTION_FIRMWARE_APP_THREAD_H
#define TRACTION_FIRMWARE_APP_THREAD_H

#include <pthread.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { THREAD_STACK = 256 * 1024 }; // [byte]

// false: no thread could be started.
bool thread_start(pthread_t *thread, void *(*run)(void *context), void *context);

#ifdef __cplusplus
}
#endif

#endif
