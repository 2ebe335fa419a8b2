// can_frame.h - a classic CAN frame, and the checksum that every frame of this bus carries in its last byte.
//
//   CRC-8 SAE J1850: polynomial x^8 + x^4 + x^3 + x^2 + 1 (0x1d), begins with 0xff, inverted at the end; of "123456789" it is 0x4b.  (1)
//
// Taken over the identifier (two bytes, high byte first) and the data before it, so that a frame under another node's identifier is refused
// too. The bus has a CRC of 15 bits of its own, between the controllers; this one goes from program to program. Any one or two bits that
// flip in a frame, and any burst of up to 8, change it (`can_test` tries them all).
#ifndef TRACTION_HAL_CAN_CAN_FRAME_H
#define TRACTION_HAL_CAN_CAN_FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    uint32_t id;    // 11 bits
    uint8_t length; // of data, 0..8
    uint8_t data[8];
} can_frame_t;

// Identifiers (hal/can/traction.dbc); a wheel's is the first of its kind plus the wheel.
enum {
    CAN_SYNC = 0x080,
    CAN_ORDER = 0x100,
    CAN_WHEEL = 0x180,
    CAN_ACCEL = 0x190,
    CAN_RATES = 0x191,
    CAN_SUPPLY = 0x192,
    CAN_RADAR = 0x193,
    CAN_DIAGNOSIS = 0x280,
    CAN_PROTOCOL = 1, // the version of all this
};

// (1) over `length` bytes.
uint8_t can_crc8(const uint8_t *data, size_t length);

// Puts the checksum into the last byte; a frame without data is left alone.
void can_seal(can_frame_t *frame);

// Whether the frame has this many bytes of data, and the checksum is right.
bool can_sound(const can_frame_t *frame, uint8_t length);

#ifdef __cplusplus
}
#endif

#endif
