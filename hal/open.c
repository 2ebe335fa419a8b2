#include "open.h"

#include "hal/replay/open_replay.h"

#include <stdio.h>
#include <string.h>

// 1: the simulator is linked.
#ifndef HAL_WITH_SIM
#define HAL_WITH_SIM 0
#endif
// 1: the rover's own devices are; their CAN bus needs cantools at build time.
#ifndef HAL_WITH_LINUX
#define HAL_WITH_LINUX 0
#endif
#if HAL_WITH_LINUX
#include "hal/linux/open_linux.h"
#endif
#if HAL_WITH_SIM
#include "hal/sim/open_sim.h"
#endif

static const hal_entry_t entries[] = {
    {"replay", "FRAMES", "recorded frames and commands (traction simulate --frames, traction replay --frames)", hal_open_replay},
#if HAL_WITH_LINUX
    {"linux", "ROVER [commands=FRAMES] [root=FOLDER]", "the rover's own devices, as [hardware] of its description names them",
     hal_open_linux},
#else
    {"linux", "ROVER", "not in this build: there was no cantools; ./traction build brings it", NULL},
#endif
#if HAL_WITH_SIM
    {"sim", "SCENARIO [seed=N] [effect=NAME:PARAMETER=VALUE,...]...", "the simulated rover on a scenario's drive, in lockstep",
     hal_open_sim},
#else
    {"sim", "SCENARIO", "not in this build: the simulator runs on the host alone", NULL},
#endif
};

const hal_entry_t *hal_list(size_t *count) {
    *count = sizeof entries / sizeof *entries;
    return entries;
}

hal_result_t hal_open(const char *name, int count, const char *const *argument, hal_opened_t *opened, char message[HAL_MESSAGE]) {
    char known[HAL_MESSAGE / 2] = "";
    message[0] = '\0';
    *opened = (hal_opened_t){.devices = false}; // what a HAL does not say is not left to chance
    for (size_t i = 0; i < sizeof entries / sizeof *entries; i++) {
        const hal_entry_t *entry = &entries[i];
        if (strcmp(entry->name, name) == 0) {
            if (entry->open != NULL) {
                return entry->open(count, argument, opened, message);
            }
            (void)snprintf(message, HAL_MESSAGE, "--hal %s: %s", entry->name, entry->about);
            return HAL_ERR_CONFIG;
        }
        if (entry->open != NULL) {
            const size_t used = strlen(known);
            (void)snprintf(known + used, sizeof known - used, "%s%s", used > 0 ? ", " : "", entry->name);
        }
    }
    (void)snprintf(message, HAL_MESSAGE, "--hal %.60s: there is no such HAL; known here: %s", name, known);
    return HAL_ERR_CONFIG;
}
