// ulog.h - ticks as PX4 ULog, version 1: what pyulog, PlotJuggler and Flight Review read. Bytes into the caller's memory, no file.
//
// Four topics each tick, time stamp (tick + 1) 10 ms in us: `frame` (raw counts, all of sensor_frame_t but the radar's samples), `radar`
// (up to 8 samples and the number of the first; as many messages as it takes), `command`, `trace`; with a supervision link `link` once a
// second. Floats are their bits, so a log replays bit for bit. A message is its size (2 bytes), its kind (1) and its payload; a file that
// was cut anywhere is readable to its last whole one.
#ifndef TRACTION_FIRMWARE_APP_ULOG_H
#define TRACTION_FIRMWARE_APP_ULOG_H

#include "firmware/core/signals.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    ULOG_HEAD = 4096, // [byte] room for what a file begins with; it takes 1.7 kB
    ULOG_TICK = 1024, // [byte] room for one tick: 364 to 694
    ULOG_TEXT = 256,  // [byte] room for one line of text
    ULOG_LINK_COUNTS = 8,
};

// What every file begins with: header, definitions, and which topics follow. `version` of the program, at most 60 characters.
size_t ulog_head(uint32_t first_tick, const char *version, uint8_t out[ULOG_HEAD]);

size_t ulog_tick(const sensor_frame_t *frame, const command_t *command, const trace_t *trace, uint8_t out[ULOG_TICK]);

// A line for the reader; level as syslog's: 3 error, 4 warning, 6 information. Cut at 200 characters.
size_t ulog_text(uint32_t tick, int level, const char *text, uint8_t out[ULOG_TEXT]);

// What came over the link since the start: accepted, refused as unsigned, by signature, as replayed, as stale, for another reason; broken;
// times the operator fell silent while the rover drove (firmware/link/supervisor.h).
size_t ulog_link(uint32_t tick, const uint32_t counts[ULOG_LINK_COUNTS], uint8_t out[ULOG_TEXT]);

// So many ticks were lost here.
size_t ulog_dropout(uint32_t ticks, uint8_t out[ULOG_TEXT]);

#ifdef __cplusplus
}
#endif

#endif
