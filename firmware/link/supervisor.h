// supervisor.h - the rover's end of the supervision link: what it tells, what it answers, which commands it obeys. No I/O, no clock, no
// heap.
//
// Reading needs no key: heartbeat, telemetry, parameters, logs, the questions a ground station begins with. Acting needs one: a command is
// obeyed only if it is signed, not seen before, of this session, and answers a status that is at most STALE_MS old. A stop needs the
// signature alone, from anybody who has the key. One operator drives at a time; another is refused until the first has stopped or was
// silent for a second.
//
//   the order's age in ticks = ceil((now - received)/10 ms), 0 for a stop                                          (1)
//   more than 8 ticks latch FAULT_COMMAND_TIMEOUT (firmware/core/safety.h): braked 80 to 90 ms after the last command received.
//
// Messages, rates, bytes a second: docs/supervision.md.
#ifndef TRACTION_FIRMWARE_LINK_SUPERVISOR_H
#define TRACTION_FIRMWARE_LINK_SUPERVISOR_H

#include "channel.h"

#include "firmware/core/rover_parameters.h"
#include "firmware/core/signals.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    SUPERVISOR_COMPONENT = 1,      // MAV_COMP_ID_AUTOPILOT1
    SUPERVISOR_EVERYBODY = -1,     // for send
    SUPERVISOR_NOBODY = -2,        // for supervisor_moved: this peer is gone
    SUPERVISOR_STALE_MS = 250,     // assumed: three statuses at 20 Hz lost, and 100 ms of network
    SUPERVISOR_OPERATOR_MS = 1000, // assumed: silence after which another may drive
    SUPERVISOR_STEP_MS = 10,       // supervisor_step is called so often
    SUPERVISOR_LOGS = 256,         // of a folder's logs, the newest
    SUPERVISOR_PARAMETERS = 4,     // of the link itself, before the rover's own
    SUPERVISOR_ID = 16,            // characters of a parameter's name on the wire
};

typedef struct {
    uint32_t number, bytes, time_s; // of log_NNNNNN.ulg; when it was last written, seconds since 1970
} supervisor_log_t;

// What the link does outside: all are called from supervisor_receive and supervisor_step alone.
typedef struct {
    void *context;
    void (*send)(void *context, int peer, const uint8_t *bytes, size_t length); // to one, or to SUPERVISOR_EVERYBODY
    size_t (*list)(void *context, supervisor_log_t *logs, size_t room);         // rising numbers, the newest `room`; null: no logs
    size_t (*read)(void *context, uint32_t number, uint32_t offset, uint8_t *bytes, size_t count); // 0: the end, or gone
} supervisor_world_t;

typedef struct {
    const rover_parameters_t *rover;    // read over the link; may be null
    const uint8_t *key;                 // 32 bytes; null: nobody may command
    float speed_max_m_s, yaw_max_rad_s; // what the firmware drives at most: a command beyond is refused
    uint32_t patience_ms;               // age of a command that the firmware forgives
    uint32_t session;                   // another at every start
    uint64_t started_10us;              // channel.h's time then: what was signed before is no command
    uint32_t version[3];                // of the program
    uint8_t system;                     // MAVLink number of this rover, 1..255
} supervisor_config_t;

// Counts since the start. The sum of all refused is what an attacker, or a bad network, has tried.
typedef struct {
    uint32_t accepted, refused_unsigned, refused_signature, refused_replay, refused_stale, refused_other, broken, losses;
} supervisor_counts_t;

// What is asked for, as it was received. `number` rises with each; 0: nobody has asked for anything yet.
typedef struct {
    command_t command;
    uint32_t number;
} supervisor_order_t;

typedef struct {
    supervisor_log_t log[SUPERVISOR_LOGS];
    size_t count, next;
    int peer;
    bool listing;
    // data
    bool reading;
    int reader;
    uint32_t number, offset, end;
    uint16_t id;
} supervisor_transfer_t;

typedef struct {
    supervisor_config_t config;
    supervisor_world_t world;
    channel_t channel;
    supervisor_counts_t counts;
    supervisor_order_t order;
    trace_t trace; // the newest tick
    command_t asked;
    bool seen;
    uint32_t now_ms, heard_ms, told_ms[4]; // the operator's last command; when each rate was due last
    uint16_t operator_id;                  // system * 256 + component; 0: nobody
    int operator_peer;                     // where it is: two of one number are two
    uint32_t told_faults;
    int parameter_peer;
    uint32_t parameter_next, parameter_end;
    float setting[SUPERVISOR_PARAMETERS];
    float credit; // bytes of bulk that may go now
    supervisor_transfer_t transfer;
} supervisor_t;

// Fills *link. Keeps what config and world point to.
void supervisor_begin(supervisor_t *link, const supervisor_config_t *config, const supervisor_world_t *world);

typedef enum { SUPERVISOR_HEARD_NOTHING = 0, SUPERVISOR_HEARD_SOMEBODY, SUPERVISOR_HEARD_KEY } supervisor_heard_t;

// One datagram of `peer` (0..), whatever bytes it has. Answers through world.send. now_ms: since the start, monotonic. Says whether a whole
// packet was in it, and one that was signed.
supervisor_heard_t supervisor_receive(supervisor_t *link, int peer, const uint8_t *bytes, size_t length, uint32_t now_ms,
                                      uint64_t time_10us);

// The newest tick, for the next telemetry, and what was asked for in it.
void supervisor_tick(supervisor_t *link, const trace_t *trace, const command_t *asked);

// A peer whose datagram was answered has another number from now on: what is under way goes there, or ends where it is
// SUPERVISOR_NOBODY.
void supervisor_moved(supervisor_t *link, int from, int to);

// Sends what is due. Call every SUPERVISOR_STEP_MS.
void supervisor_step(supervisor_t *link, uint32_t now_ms, uint64_t time_10us);

// (1).
uint32_t supervisor_age_ticks(const command_t *order, uint64_t received_ns, uint64_t now_ns);

// The name of parameter `index` on the wire, SUPERVISOR_ID characters and a 0: as it is, or each word cut to as many characters as fit.
// false: there is none.
bool supervisor_parameter(const supervisor_t *link, uint32_t index, char id[SUPERVISOR_ID + 1], float *value);
uint32_t supervisor_parameter_count(const supervisor_t *link);

#ifdef __cplusplus
}
#endif

#endif
