// udp_link.h - the supervision link of the running rover: firmware/link over UDP, in a thread of its own beside the ticks.
//
// The tick hands over its trace and takes the newest command through a mailbox that it never waits for: where the thread holds it, the tick
// keeps what it has, which grows older and so stops the rover if that should last. The thread reads and writes the socket, reads the log
// folder, and makes and believes signatures.
//
// Until the first command is obeyed, whoever the HAL names commands (a scenario's plan, recorded commands); from then on the link alone
// does.
#ifndef TRACTION_FIRMWARE_APP_UDP_LINK_H
#define TRACTION_FIRMWARE_APP_UDP_LINK_H

#include "ulog.h"

#include "firmware/core/rover_parameters.h"
#include "firmware/core/signals.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { UDP_LINK_MESSAGE = 400, UDP_LINK_PORT = 14555, UDP_LINK_PEERS = 4 };

typedef struct {
    const char *address;             // "127.0.0.1", "0.0.0.0:14555", "[::1]:14555"; port 0: any that is free, which is said
    const char *key;                 // file (firmware/link/key.h); null: telemetry only
    const char *logs;                // folder of the on-board log; null: none
    const rover_parameters_t *rover; // told over the link; outlives it
    float speed_max_m_s, yaw_max_rad_s;
    uint32_t patience_ms; // age of a command that the firmware forgives
    uint8_t system;       // 1..255
} udp_link_options_t;

typedef struct udp_link udp_link_t;

// false where this program was built without the generator of MAVLink's C.
bool udp_link_built(void);

// Opens the socket and starts the thread; null with one line in message: what is wrong and the mend. Else message says where it listens,
// and whether commands are possible.
udp_link_t *udp_link_start(const udp_link_options_t *options, char message[UDP_LINK_MESSAGE]);

// Called by the tick. The command in force, with its age; *command is left alone as long as nobody has commanded. Never waits.
void udp_link_command(udp_link_t *link, command_t *command);

// Called by the tick, after it. Never waits.
void udp_link_tick(udp_link_t *link, const trace_t *trace, const command_t *command);

// What ulog_link writes. Never waits.
void udp_link_counts(udp_link_t *link, uint32_t counts[ULOG_LINK_COUNTS]);

// Ends the thread and closes the socket. The link is gone then.
void udp_link_finish(udp_link_t *link);

#ifdef __cplusplus
}
#endif

#endif
