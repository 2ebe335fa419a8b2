#define _POSIX_C_SOURCE 200809L // clock_gettime, strnlen
#include "udp_link.h"

#include "log_ring.h"
#include "thread.h"
#include "udp_address.h"

#include "firmware/link/key.h"
#include "firmware/link/supervisor.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

// Of the build.
#ifndef TRACTION_VERSION
#define TRACTION_VERSION "0.0.0"
#endif

enum { DATAGRAM = 2048, AT_ONCE = 64, PEER_MS = 5000, PEER_KEY_MS = 30000, PEER_SILENT_MS = 2500 };

static const uint64_t ns_per_ms = 1000000;

typedef struct {
    struct sockaddr_storage address;
    socklen_t length;
    uint64_t heard_ns; // 0: free
    bool key;          // has signed: is kept before others
} peer_t;

struct udp_link {
    int socket;
    pthread_t thread;
    pthread_mutex_t mutex; // of the mailbox
    struct {
        trace_t trace;
        command_t asked;
        bool fresh, over;
        supervisor_order_t order;
        uint64_t order_ns;
        uint32_t counts[ULOG_LINK_COUNTS];
    } mailbox;
    // of the tick
    supervisor_order_t order;
    uint64_t order_ns;
    uint32_t counts[ULOG_LINK_COUNTS];
    // of the thread
    supervisor_t supervisor;
    peer_t peer[UDP_LINK_PEERS + 1]; // the last: whoever is being listened to and has no place yet
    uint64_t start_ns;
    const char *logs;
    int log_file; // -1: none is open
    uint32_t log_number;
};

// A key leaves no copy behind; the compiler may not know better.
static void wipe(void *bytes, size_t count)
{
    volatile uint8_t *at = bytes;
    while (count-- > 0u) {
        *at++ = 0;
    }
}

static uint64_t clock_ns(clockid_t which)
{
    struct timespec now;
    (void)clock_gettime(which, &now);
    return (uint64_t)now.tv_sec * 1000u * ns_per_ms + (uint64_t)now.tv_nsec;
}

// MAVLink's time: 10 us since 2015-01-01; 0 before that.
static uint64_t signing_time(void)
{
    const uint64_t since_1970 = clock_ns(CLOCK_REALTIME) / 10000u, epoch = (uint64_t)1420070400u * 100000u;
    return since_1970 > epoch ? since_1970 - epoch : 0u;
}

static uint32_t now_ms(const udp_link_t *link) { return (uint32_t)((clock_ns(CLOCK_MONOTONIC) - link->start_ns) / ns_per_ms); }

bool udp_link_built(void) { return true; }

// --- what the supervisor does outside

static void send_to(const udp_link_t *link, const peer_t *peer, const uint8_t *bytes, size_t length)
{
    if (peer->heard_ns != 0u) { // what the network does not take is lost, as on any network
        (void)sendto(link->socket, bytes, length, MSG_DONTWAIT | MSG_NOSIGNAL, (const struct sockaddr *)&peer->address, peer->length);
    }
}

static void send_bytes(void *context, int peer, const uint8_t *bytes, size_t length)
{
    const udp_link_t *link = context;
    if (peer != SUPERVISOR_EVERYBODY) {
        send_to(link, &link->peer[peer], bytes, length);
        return;
    }
    for (int i = 0; i < UDP_LINK_PEERS; i++) {
        send_to(link, &link->peer[i], bytes, length);
    }
}

static size_t list_logs(void *context, supervisor_log_t *logs, size_t room)
{
    const udp_link_t *link = context;
    log_ring_file_t files[SUPERVISOR_LOGS];
    const size_t count = log_ring_list(link->logs, files, room < SUPERVISOR_LOGS ? room : SUPERVISOR_LOGS);
    for (size_t i = 0; i < count; i++) {
        logs[i] = (supervisor_log_t){.number = files[i].number, .bytes = files[i].bytes, .time_s = files[i].time_s};
    }
    return count;
}

static size_t read_log(void *context, uint32_t number, uint32_t offset, uint8_t *bytes, size_t count)
{
    udp_link_t *link = context;
    if (link->log_file < 0 || link->log_number != number) {
        char path[LOG_RING_PATH];
        if (link->log_file >= 0) {
            (void)close(link->log_file);
        }
        log_ring_path(link->logs, number, path);
        link->log_file = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
        link->log_number = number;
    }
    const ssize_t got = link->log_file >= 0 ? pread(link->log_file, bytes, count, (off_t)offset) : -1;
    return got > 0 ? (size_t)got : 0u;
}

// --- peers

static bool same_address(const peer_t *peer, const struct sockaddr_storage *address, socklen_t length)
{
    return peer->heard_ns != 0u && peer->length == length && memcmp(&peer->address, address, length) == 0;
}

// The place of this address, or the spare one.
static int place_of(const udp_link_t *link, const struct sockaddr_storage *address, socklen_t length)
{
    int place = 0;
    while (place < UDP_LINK_PEERS && !same_address(&link->peer[place], address, length)) {
        place++;
    }
    return place;
}

// A place for who is at the spare one: a free one, or that of who was not heard for longest among those who missed two heartbeats and,
// where the newcomer has the key, those who have not. UDP_LINK_PEERS: there is none.
static int give_place(const udp_link_t *link, bool key)
{
    const uint64_t now_ns = clock_ns(CLOCK_MONOTONIC);
    int best = UDP_LINK_PEERS;
    for (int i = 0; i < UDP_LINK_PEERS; i++) {
        const peer_t *peer = &link->peer[i];
        if (peer->heard_ns == 0u) {
            return i;
        }
        const bool gives_way = (key && !peer->key) || now_ns - peer->heard_ns > PEER_SILENT_MS * ns_per_ms;
        if (gives_way && (best == UDP_LINK_PEERS || peer->heard_ns < link->peer[best].heard_ns)) {
            best = i;
        }
    }
    return best;
}

static void forget_silent(udp_link_t *link)
{
    const uint64_t now_ns = clock_ns(CLOCK_MONOTONIC);
    for (int i = 0; i < UDP_LINK_PEERS; i++) {
        peer_t *peer = &link->peer[i];
        const uint64_t patience_ns = (peer->key ? PEER_KEY_MS : PEER_MS) * ns_per_ms;
        if (peer->heard_ns != 0u && now_ns - peer->heard_ns > patience_ns) {
            peer->heard_ns = 0;
            supervisor_moved(&link->supervisor, i, SUPERVISOR_NOBODY);
        }
    }
}

// --- the thread

static void publish(udp_link_t *link, uint64_t received_ns)
{
    const supervisor_counts_t *counts = &link->supervisor.counts;
    const uint32_t list[ULOG_LINK_COUNTS] = {counts->accepted,
                                             counts->refused_unsigned,
                                             counts->refused_signature,
                                             counts->refused_replay,
                                             counts->refused_stale,
                                             counts->refused_other,
                                             counts->broken,
                                             counts->losses};
    (void)pthread_mutex_lock(&link->mutex);
    if (link->mailbox.order.number != link->supervisor.order.number) {
        link->mailbox.order = link->supervisor.order;
        link->mailbox.order_ns = received_ns;
    }
    memcpy(link->mailbox.counts, list, sizeof list);
    if (link->mailbox.fresh) {
        supervisor_tick(&link->supervisor, &link->mailbox.trace, &link->mailbox.asked);
        link->mailbox.fresh = false;
    }
    (void)pthread_mutex_unlock(&link->mutex);
}

// One datagram; false: there is none.
static bool receive(udp_link_t *link)
{
    uint8_t bytes[DATAGRAM];
    struct sockaddr_storage address = {0};
    socklen_t length = sizeof address;
    const ssize_t got = recvfrom(link->socket, bytes, sizeof bytes, MSG_DONTWAIT, (struct sockaddr *)&address, &length);
    if (got < 0) {
        return errno == ECONNREFUSED || errno == EINTR; // a peer that has gone says so; the next may be there
    }
    const uint64_t received_ns = clock_ns(CLOCK_MONOTONIC);
    const int place = place_of(link, &address, length);
    peer_t *peer = &link->peer[place];
    if (place == UDP_LINK_PEERS) {
        *peer = (peer_t){.address = address, .length = length, .heard_ns = received_ns, .key = false};
    }
    const uint32_t at_ms = (uint32_t)((received_ns - link->start_ns) / ns_per_ms);
    const supervisor_heard_t heard = supervisor_receive(&link->supervisor, place, bytes, (size_t)got, at_ms, signing_time());
    publish(link, received_ns);
    if (heard != SUPERVISOR_HEARD_NOTHING) {
        peer->heard_ns = received_ns;
        peer->key = peer->key || heard == SUPERVISOR_HEARD_KEY;
        const int better = place == UDP_LINK_PEERS ? give_place(link, peer->key) : place;
        if (better != place) {
            link->peer[better] = *peer;
            supervisor_moved(&link->supervisor, better, SUPERVISOR_NOBODY); // who had the place
            supervisor_moved(&link->supervisor, place, better);
        } else if (place == UDP_LINK_PEERS) { // was answered; what takes longer is for those who have a place
            supervisor_moved(&link->supervisor, place, SUPERVISOR_NOBODY);
        }
    }
    return true;
}

static void *serve(void *context)
{
    udp_link_t *link = context;
    uint64_t due_ns = clock_ns(CLOCK_MONOTONIC);
    for (bool over = false; !over;) {
        const uint64_t now_ns = clock_ns(CLOCK_MONOTONIC);
        struct pollfd ready = {.fd = link->socket, .events = POLLIN};
        const int wait_ms = now_ns < due_ns ? (int)((due_ns - now_ns + ns_per_ms - 1u) / ns_per_ms) : 0;
        if (poll(&ready, 1, wait_ms) > 0) {
            for (int i = 0; i < AT_ONCE && receive(link); i++) { // a flood does not keep the telemetry from going
            }
        }
        if (clock_ns(CLOCK_MONOTONIC) < due_ns) {
            continue;
        }
        due_ns += SUPERVISOR_STEP_MS * ns_per_ms;
        due_ns = due_ns < now_ns ? now_ns : due_ns; // late: no catching up
        forget_silent(link);
        publish(link, now_ns);
        supervisor_step(&link->supervisor, now_ms(link), signing_time());
        (void)pthread_mutex_lock(&link->mutex);
        over = link->mailbox.over;
        (void)pthread_mutex_unlock(&link->mutex);
    }
    return NULL;
}

// --- the tick

void udp_link_command(udp_link_t *link, command_t *command)
{
    if (pthread_mutex_trylock(&link->mutex) == 0) {
        link->order = link->mailbox.order;
        link->order_ns = link->mailbox.order_ns;
        memcpy(link->counts, link->mailbox.counts, sizeof link->counts);
        (void)pthread_mutex_unlock(&link->mutex);
    }
    if (link->order.number > 0u) {
        *command = link->order.command;
        command->age_ticks = supervisor_age_ticks(command, link->order_ns, clock_ns(CLOCK_MONOTONIC));
    }
}

void udp_link_tick(udp_link_t *link, const trace_t *trace, const command_t *command)
{
    if (pthread_mutex_trylock(&link->mutex) == 0) {
        link->mailbox.trace = *trace;
        link->mailbox.asked = *command;
        link->mailbox.fresh = true;
        (void)pthread_mutex_unlock(&link->mutex);
    }
}

void udp_link_counts(udp_link_t *link, uint32_t counts[ULOG_LINK_COUNTS]) { memcpy(counts, link->counts, sizeof link->counts); }

// --- start and end

static bool open_socket(udp_link_t *link, const char *text, char message[UDP_LINK_MESSAGE])
{
    udp_address_t address;
    socklen_t length = udp_address_parse(text, UDP_LINK_PORT, &address);
    if (length == 0u) {
        (void)snprintf(message, UDP_LINK_MESSAGE, "--link %.80s: no address of this machine; give 127.0.0.1, 0.0.0.0:14555 or [::1]:14555",
                       text);
        return false;
    }
    link->socket = socket(address.any.sa_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (link->socket < 0 || bind(link->socket, &address.any, length) != 0 || getsockname(link->socket, &address.any, &length) != 0) {
        (void)snprintf(message, UDP_LINK_MESSAGE, "--link %.80s: cannot be listened on: %.60s", text, strerror(errno));
        return false;
    }
    char host[INET6_ADDRSTRLEN] = "";
    const bool four = address.any.sa_family == AF_INET;
    (void)inet_ntop(address.any.sa_family, four ? (const void *)&address.four.sin_addr : (const void *)&address.six.sin6_addr, host,
                    sizeof host);
    (void)snprintf(message, UDP_LINK_MESSAGE, "link: listens on %s%s%s:%u (UDP, MAVLink 2)", four ? "" : "[", host, four ? "" : "]",
                   (unsigned)ntohs(four ? address.four.sin_port : address.six.sin6_port));
    return true;
}

static supervisor_config_t config_of(const udp_link_options_t *options, const uint8_t *key)
{
    supervisor_config_t config = {.rover = options->rover,
                                  .key = key,
                                  .speed_max_m_s = options->speed_max_m_s,
                                  .yaw_max_rad_s = options->yaw_max_rad_s,
                                  .patience_ms = options->patience_ms,
                                  .started_10us = signing_time(),
                                  .system = options->system};
    if (getrandom(&config.session, sizeof config.session, GRND_NONBLOCK) != (ssize_t)sizeof config.session) { // too early after power-up
        config.session = (uint32_t)(clock_ns(CLOCK_REALTIME) ^ clock_ns(CLOCK_MONOTONIC) << 7u ^ (uint64_t)getpid() << 16u);
    }
    const char *at = TRACTION_VERSION;
    for (size_t i = 0; i < sizeof config.version / sizeof *config.version; i++) {
        char *end = NULL;
        config.version[i] = (uint32_t)strtoul(at, &end, 10);
        at = *end == '.' ? end + 1 : end;
    }
    return config;
}

udp_link_t *udp_link_start(const udp_link_options_t *options, char message[UDP_LINK_MESSAGE])
{
    static udp_link_t only; // one a program; no heap
    udp_link_t *link = &only;
    uint8_t key[KEY_BYTES];
    memset(link, 0, sizeof *link);
    link->socket = link->log_file = -1;
    link->logs = options->logs;
    link->start_ns = clock_ns(CLOCK_MONOTONIC);
    if (options->key != NULL) {
        char why[KEY_MESSAGE];
        if (!key_read(options->key, key, why)) {
            (void)snprintf(message, UDP_LINK_MESSAGE, "--link-key %s", why);
            return NULL;
        }
    }
    const supervisor_config_t config = config_of(options, options->key != NULL ? key : NULL);
    const supervisor_world_t world = {.context = link,
                                      .send = send_bytes,
                                      .list = options->logs != NULL ? list_logs : NULL,
                                      .read = options->logs != NULL ? read_log : NULL};
    supervisor_begin(&link->supervisor, &config, &world);
    link->supervisor.config.key = NULL; // it was copied
    wipe(key, sizeof key);
    if (!open_socket(link, options->address, message) || pthread_mutex_init(&link->mutex, NULL) != 0) {
        if (link->socket >= 0) {
            (void)close(link->socket);
        }
        return NULL;
    }
    if (options->key == NULL) {
        const size_t used = strlen(message);
        (void)snprintf(message + used, UDP_LINK_MESSAGE - used, "; no --link-key: telemetry only, no command is accepted");
    }
    if (!thread_start(&link->thread, serve, link)) {
        (void)close(link->socket);
        (void)snprintf(message, UDP_LINK_MESSAGE, "--link: no thread could be started");
        return NULL;
    }
    return link;
}

void udp_link_finish(udp_link_t *link)
{
    (void)pthread_mutex_lock(&link->mutex);
    link->mailbox.over = true;
    (void)pthread_mutex_unlock(&link->mutex);
    (void)pthread_join(link->thread, NULL);
    if (link->log_file >= 0) {
        (void)close(link->log_file);
    }
    (void)close(link->socket);
    wipe(&link->supervisor, sizeof link->supervisor); // the key
}
