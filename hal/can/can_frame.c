#include "can_frame.h"

static uint8_t crc_byte(uint8_t crc, uint8_t byte) {
    uint32_t rest = (uint32_t)crc ^ byte;
    for (int bit = 0; bit < 8; bit++) {
        rest = (rest & 0x80u) != 0u ? (rest << 1u) ^ 0x11du : rest << 1u;
    }
    return (uint8_t)rest;
}

uint8_t can_crc8(const uint8_t *data, size_t length) {
    uint8_t crc = 0xff;
    for (size_t i = 0; i < length; i++) {
        crc = crc_byte(crc, data[i]);
    }
    return (uint8_t)(crc ^ 0xffu);
}

static uint8_t checksum(const can_frame_t *frame) {
    uint8_t bytes[2 + sizeof frame->data] = {(uint8_t)(frame->id >> 8u), (uint8_t)frame->id};
    const size_t covered = frame->length - 1u;
    for (size_t i = 0; i < covered; i++) {
        bytes[2 + i] = frame->data[i];
    }
    return can_crc8(bytes, 2 + covered);
}

void can_seal(can_frame_t *frame) {
    if (frame->length > 0 && frame->length <= sizeof frame->data) {
        frame->data[frame->length - 1u] = checksum(frame);
    }
}

bool can_sound(const can_frame_t *frame, uint8_t length) {
    return frame->length == length && length > 0 && length <= sizeof frame->data && frame->data[length - 1u] == checksum(frame);
}
