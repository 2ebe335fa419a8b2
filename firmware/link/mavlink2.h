// mavlink2.h - MAVLink's generated C as this project uses it: nothing but what is called with a buffer of the caller's.
//
// Made at build time from traction.xml by pymavlink (requirements.txt). Fields are copied byte by byte: the packet is packed, and ARMv5TE
// has no unaligned loads.
#ifndef TRACTION_FIRMWARE_LINK_MAVLINK2_H
#define TRACTION_FIRMWARE_LINK_MAVLINK2_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define MAVLINK_ALIGNED_FIELDS 0
#define MAVLINK_COMM_NUM_BUFFERS 1

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Waddress-of-packed-member" // the generator's own, read byte by byte
#include <traction/mavlink.h>
#pragma GCC diagnostic pop

#endif
