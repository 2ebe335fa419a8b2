#include "channel.h"

#include <string.h>

void channel_begin(channel_t *channel, uint8_t system, uint8_t component, const uint8_t *key)
{
    memset(channel, 0, sizeof *channel);
    channel->system = system;
    channel->component = component;
    channel->keyed = key != NULL;
    if (key != NULL) {
        memcpy(channel->signing.secret_key, key, CHANNEL_KEY);
        channel->signing.flags = MAVLINK_SIGNING_FLAG_SIGN_OUTGOING;
        channel->status.signing = &channel->signing;
        channel->status.signing_streams = &channel->senders;
    }
}

void channel_clock(channel_t *channel, uint64_t time_10us)
{
    if (time_10us > channel->signing.timestamp) {
        channel->signing.timestamp = time_10us;
    }
}

void channel_next_datagram(channel_t *channel) { channel->status.parse_state = MAVLINK_PARSE_STATE_IDLE; }

static channel_verdict_t unbelieved(const channel_t *channel, const mavlink_message_t *packet)
{
    if ((packet->incompat_flags & MAVLINK_IFLAG_SIGNED) == 0u) {
        return CHANNEL_UNSIGNED;
    }
    const mavlink_signing_status_t why = channel->signing.last_status;
    return why == MAVLINK_SIGNING_STATUS_REPLAY || why == MAVLINK_SIGNING_STATUS_OLD_TIMESTAMP ? CHANNEL_REPLAYED : CHANNEL_BAD_SIGNATURE;
}

channel_verdict_t channel_take(channel_t *channel, uint8_t byte, mavlink_message_t *packet)
{
    switch (mavlink_frame_char_buffer(&channel->under_way, &channel->status, byte, packet, NULL)) {
    case MAVLINK_FRAMING_OK: // without a key that is any whole packet
        return channel->keyed && (packet->incompat_flags & MAVLINK_IFLAG_SIGNED) != 0u ? CHANNEL_SIGNED : CHANNEL_UNSIGNED;
    case MAVLINK_FRAMING_BAD_SIGNATURE:
        return unbelieved(channel, packet);
    case MAVLINK_FRAMING_BAD_CRC:
        channel->status.parse_state = MAVLINK_PARSE_STATE_IDLE;
        return CHANNEL_BROKEN;
    default:
        return CHANNEL_NOTHING;
    }
}

uint64_t channel_packet_time(const mavlink_message_t *packet)
{
    uint64_t time = 0;
    for (int i = 6; i >= 1; i--) { // after the link's number
        time = time << 8u | packet->signature[i];
    }
    return time;
}

size_t channel_bytes(const mavlink_message_t *packet, uint8_t out[CHANNEL_PACKET]) { return mavlink_msg_to_send_buffer(out, packet); }

bool channel_for_us(const channel_t *channel, const mavlink_message_t *packet)
{
    const mavlink_msg_entry_t *about = mavlink_get_msg_entry(packet->msgid);
    const uint8_t *payload = (const uint8_t *)_MAV_PAYLOAD(packet);
    if (about == NULL) {
        return false;
    }
    if ((about->flags & MAV_MSG_ENTRY_FLAG_HAVE_TARGET_SYSTEM) != 0) {
        const uint8_t system = payload[about->target_system_ofs];
        if (system != 0u && system != channel->system) {
            return false;
        }
    }
    if ((about->flags & MAV_MSG_ENTRY_FLAG_HAVE_TARGET_COMPONENT) != 0) {
        const uint8_t component = payload[about->target_component_ofs];
        return component == 0u || component == channel->component;
    }
    return true;
}
