// dbc.h - which signals lie where in a CAN frame, as a DBC file says it: messages, signals, multiplexing of one level, floats.
//
// Intel (@1): bit i of the signal is bit start + i, bits counted from the lowest of byte 0. Motorola (@0): start is the highest bit, and
// the next lower one is one further down, or bit 7 of the next byte. value = raw * factor + offset. Read: BO_, SG_, SIG_VALTYPE_; every
// other line says nothing about bits.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace traction::board {

struct DbcSignal {
    std::string name;
    int start = 0, length = 0;
    bool intel = true, is_signed = false;
    int floating = 0; // bits of an IEEE number, 32 or 64; 0: an integer
    double factor = 1, offset = 0;
    int multiplex = -1;       // is there only where the message's multiplexor has this value; -1: always
    bool multiplexor = false; // its raw value chooses
};

struct DbcMessage {
    std::string name;
    int bytes = 0;
    std::vector<DbcSignal> signals;
};

constexpr std::uint32_t dbc_extended = 0x80000000u; // of an id: it has 29 bits

using Dbc = std::map<std::uint32_t, DbcMessage>; // by id

// Throws log::FileError, or log::LogError with the line of what is wrong.
Dbc read_dbc(const std::string &path);

// Whether the signal's bits are within `data`.
bool dbc_fits(const DbcSignal &signal, std::string_view data);

// Its raw bits, not yet signed. Call only where dbc_fits.
std::uint64_t dbc_raw(const DbcSignal &signal, std::string_view data);

// Its value in its unit. NaN where a float is.
double dbc_value(const DbcSignal &signal, std::string_view data);

} // namespace traction::board
