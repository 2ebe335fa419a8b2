// channel.h - signed MAVLink 2 packets from bytes and into bytes: the one place where a signature is made or believed. No I/O, no clock.
//
//   signature = first 48 bits of SHA-256(key, header, payload, checksum, link, time)              (1)  MAVLink 2, message signing
//   time of a sender's packets must rise; a sender unheard of may not be more than 60 s behind      (2)
//
// time: 10 us since 2015-01-01. Without a key nothing is signed and no signature can be believed: every packet counts as unsigned. A forged
// packet passes (1) with probability 2^-48.
#ifndef TRACTION_FIRMWARE_LINK_CHANNEL_H
#define TRACTION_FIRMWARE_LINK_CHANNEL_H

#include "mavlink2.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { CHANNEL_KEY = 32, CHANNEL_PACKET = MAVLINK_MAX_PACKET_LEN };

typedef enum {
    CHANNEL_NOTHING = 0,   // no packet ends with this byte
    CHANNEL_SIGNED,        // whole, by who has the key, not seen before
    CHANNEL_UNSIGNED,      // whole; anybody's
    CHANNEL_BAD_SIGNATURE, // of another key, or of too many senders (16)
    CHANNEL_REPLAYED,      // (2): came again, or is old
    CHANNEL_BROKEN,        // checksum, or a message that is not known here
} channel_verdict_t;

typedef struct {
    mavlink_status_t status; // points into this struct: do not move it
    mavlink_message_t under_way;
    mavlink_signing_t signing;
    mavlink_signing_streams_t senders;
    uint8_t system, component;
    bool keyed;
} channel_t;

// Who we are (MAVLink's numbers, 1..255), and the key; 0: none.
void channel_begin(channel_t *channel, uint8_t system, uint8_t component, const uint8_t *key);

// The time of (2) now, as this machine's clock says; it never runs backwards, whatever the clock does.
void channel_clock(channel_t *channel, uint64_t time_10us);

// Forgets a packet that a datagram cut short: call before each datagram.
void channel_next_datagram(channel_t *channel);

// The next byte. *packet is filled where the verdict is no CHANNEL_NOTHING.
channel_verdict_t channel_take(channel_t *channel, uint8_t byte, mavlink_message_t *packet);

// (2) of a signed packet, 10 us.
uint64_t channel_packet_time(const mavlink_message_t *packet);

// A packet as bytes, at most CHANNEL_PACKET; returns how many. Made by mavlink_msg_<name>_encode_status(channel->system,
// channel->component, &channel->status, packet, ...), which signs it.
size_t channel_bytes(const mavlink_message_t *packet, uint8_t out[CHANNEL_PACKET]);

// Whether the packet is for us: no target, everybody, or our numbers.
bool channel_for_us(const channel_t *channel, const mavlink_message_t *packet);

#ifdef __cplusplus
}
#endif

#endif
