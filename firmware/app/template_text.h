// template_text.h - a radar's template (firmware/core/doppler.h) as lines of the parameter file, so that a rover gets any radar without
// being compiled again.
//
//   template = log_step m_s_per_Hz rate_Hz speeds first_bin bins exact spread deaf line from_peak
//   template_window = ticks tau_s tau_ticks per_s  weights, Q15
//   template_start = one grid speed per bin
//   template_speed = speed_m_s volume quiet  q/S of every bin            (one line per grid speed, rising)
//
// Written by `traction rover --firmware` for a radar that is not linked. Numbers with 9 digits: read again they are the same bits.
#ifndef TRACTION_FIRMWARE_APP_TEMPLATE_TEXT_H
#define TRACTION_FIRMWARE_APP_TEMPLATE_TEXT_H

#include "firmware/core/doppler.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { TEMPLATE_TEXT = 131072, TEMPLATE_LINE = 1024 };

typedef struct {
    doppler_template_t *into; // 0: a template is refused
    bool head, window, start; // lines seen
    int32_t speeds;           // lines of grid speeds seen
} template_reading_t;

// True where the key is one of a template's.
bool template_text_key(const char *key);

// Takes one line. Returns 0, or what is wrong with it, with the mend.
const char *template_text_read(template_reading_t *reading, const char *key, const char *value);

// Whether all lines were there and the numbers keep what doppler.c relies on: ranges of every index, rising speeds, J within 32 bits.
// Returns 0, or what is wrong.
const char *template_text_check(const template_reading_t *reading);

// Returns the length without the closing 0, at most TEMPLATE_TEXT - 1.
size_t template_text_write(const doppler_template_t *beam, char text[TEMPLATE_TEXT]);

#ifdef __cplusplus
}
#endif

#endif
