// trace_text.h - a trace as one line of text, every bit of it, and the hash over such lines: what machines are compared by.
//
// Counts in decimal, floats as the 8 hex digits of their bits, so no rounding hides a difference. Order of the fields: trace_text.c.
#ifndef TRACTION_FIRMWARE_APP_TRACE_TEXT_H
#define TRACTION_FIRMWARE_APP_TRACE_TEXT_H

#include "firmware/core/signals.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { TRACE_TEXT = 640 }; // [byte] the longest line has 494

// Writes the line with its newline and a final 0.
void trace_text(const trace_t *trace, char line[TRACE_TEXT]);

// FNV-1a, 64 bit: begin with TRACE_HASH_BEGIN and feed line after line.
#define TRACE_HASH_BEGIN 14695981039346656037u
uint64_t trace_text_hash(uint64_t hash, const char *line);

#ifdef __cplusplus
}
#endif

#endif
