#include "template_text.h"

#include "firmware/core/fixed.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Numbers of a line, read one after the other.
typedef struct {
    const char *at;
    bool bad; // one was missing or no number
} numbers_t;

static double next_number(numbers_t *numbers, double low, double high)
{
    char *end = NULL;
    const double value = strtod(numbers->at, &end);
    if (end == numbers->at || !(value >= low && value <= high)) {
        numbers->bad = true;
        return low;
    }
    numbers->at = end;
    return value;
}

static float next_float(numbers_t *numbers, double low, double high) { return (float)next_number(numbers, low, high); }

static int32_t next_whole(numbers_t *numbers, double low, double high)
{
    const double value = next_number(numbers, low, high);
    const int32_t whole = (int32_t)value;
    numbers->bad = numbers->bad || (double)whole != value;
    return whole;
}

static const char *ended(const numbers_t *numbers)
{
    const char *at = numbers->at;
    while (*at == ' ') {
        at++;
    }
    return numbers->bad || *at != '\0' ? "not the numbers of a template; write the file again with `traction rover --firmware`" : NULL;
}

static const char *read_head(template_reading_t *reading, numbers_t *numbers)
{
    doppler_template_t *t = reading->into;
    const doppler_template_t empty = {0};
    *t = empty;
    t->log_step = next_float(numbers, 1e-6, 2);
    t->paper_m_s_per_Hz = next_float(numbers, 1e-6, 10);
    t->sample_rate_Hz = next_float(numbers, 202, 6400);
    t->speeds = next_whole(numbers, 2, DOPPLER_SPEEDS_MAX);
    t->first_bin = next_whole(numbers, 1, 1);
    t->bins = next_whole(numbers, 8, DOPPLER_BINS_MAX);
    t->exact = next_whole(numbers, 1, INT32_MAX);
    t->spread = next_float(numbers, 1e-3, 100);
    t->deaf = next_float(numbers, 1, 100);
    t->line = next_whole(numbers, 0, 1) != 0;
    t->from_peak = next_whole(numbers, 0, 1) != 0;
    reading->head = true;
    return t->bins % 8 != 0 ? "bins must be a multiple of 8" : ended(numbers);
}

static const char *read_window(template_reading_t *reading, numbers_t *numbers)
{
    doppler_window_t *window = &reading->into->window;
    int32_t sum = 0;
    window->ticks = next_whole(numbers, 1, DOPPLER_WINDOW_TICKS_MAX);
    window->tau_s = next_float(numbers, 1e-3, 2);
    window->tau_ticks = next_float(numbers, 0.1, 200);
    window->per_s = next_float(numbers, 0.5, 50);
    for (int32_t j = 0; j < window->ticks; j++) {
        window->weight_q15[j] = (int16_t)next_whole(numbers, 0, 32767);
        sum += window->weight_q15[j];
    }
    reading->window = true;
    return sum != 32768 ? "the weights do not sum to 32768" : ended(numbers);
}

static const char *read_start(template_reading_t *reading, numbers_t *numbers)
{
    for (int32_t k = 0; k < reading->into->bins; k++) {
        reading->into->start[k] = (int8_t)next_whole(numbers, 0, reading->into->speeds - 1);
    }
    reading->start = true;
    return ended(numbers);
}

static const char *read_speed(template_reading_t *reading, numbers_t *numbers)
{
    doppler_template_t *t = reading->into;
    const int32_t i = reading->speeds;
    if (i >= t->speeds) {
        return "more speeds than the first line says";
    }
    t->speed_m_s[i] = next_float(numbers, 1e-4, 1000);
    t->volume[i] = next_whole(numbers, INT32_MIN, INT32_MAX);
    t->quiet[i] = next_whole(numbers, INT32_MIN, INT32_MAX);
    for (int32_t k = 0; k < t->bins; k++) {
        t->inverse[i * t->bins + k] = (int16_t)next_whole(numbers, 0, 32767);
    }
    reading->speeds++;
    return i > 0 && t->speed_m_s[i] <= t->speed_m_s[i - 1] ? "the speeds must rise" : ended(numbers);
}

bool template_text_key(const char *key) { return strncmp(key, "template", 8) == 0; }

const char *template_text_read(template_reading_t *reading, const char *key, const char *value)
{
    numbers_t numbers = {.at = value, .bad = false};
    if (reading->into == NULL) {
        return "no template can be taken here";
    }
    if (strcmp(key, "template") == 0) {
        return reading->head ? "given twice; keep one" : read_head(reading, &numbers);
    }
    if (!reading->head) {
        return "stands before the line `template = ...`; keep the order of the written file";
    }
    if (strcmp(key, "template_window") == 0) {
        return reading->window ? "given twice; keep one" : read_window(reading, &numbers);
    }
    if (strcmp(key, "template_start") == 0) {
        return reading->start ? "given twice; keep one" : read_start(reading, &numbers);
    }
    if (strcmp(key, "template_speed") == 0) {
        return read_speed(reading, &numbers);
    }
    return "unknown key; docs/rover_format.md lists the known ones";
}

const char *template_text_check(const template_reading_t *reading)
{
    const doppler_template_t *t = reading->into;
    const int64_t most = 128 * 256 + DOPPLER_BINS_MAX * 256; // sum of the powers that doppler.c reduces to
    if (t == NULL || !reading->head || !reading->window || !reading->start || reading->speeds != t->speeds) {
        return "lines of the template are missing; write the file again with `traction rover --firmware`";
    }
    for (int32_t i = 0; i < t->speeds; i++) {
        for (int32_t k = 0; k < t->bins; k++) {
            const int64_t J = most * (t->volume[i] + (int64_t)t->inverse[i * t->bins + k]);
            const int64_t alone = most * t->volume[i], quiet = most * t->quiet[i];
            if (J > INT32_MAX || J < INT32_MIN || alone < INT32_MIN || alone > INT32_MAX || quiet > INT32_MAX || quiet < INT32_MIN) {
                return "the template's numbers leave 32 bits; write the file again with `traction rover --firmware`";
            }
        }
    }
    return NULL;
}

// --- write

typedef struct {
    char *text;
    size_t length;
} out_t;

static void put(out_t *out, const char *text)
{
    const size_t n = strlen(text);
    if (n < TEMPLATE_TEXT - out->length) {
        memcpy(out->text + out->length, text, n + 1);
        out->length += n;
    }
}

// 10 digits: any float, and any whole number of 32 bits, comes back as it was.
static void put_number(out_t *out, double value)
{
    char text[32];
    (void)snprintf(text, sizeof text, " %.10g", value);
    put(out, text);
}

size_t template_text_write(const doppler_template_t *t, char text[TEMPLATE_TEXT])
{
    out_t out = {.text = text, .length = 0};
    const double head[] = {(double)t->log_step,
                           (double)t->paper_m_s_per_Hz,
                           (double)t->sample_rate_Hz,
                           t->speeds,
                           t->first_bin,
                           t->bins,
                           t->exact,
                           (double)t->spread,
                           (double)t->deaf,
                           t->line ? 1 : 0,
                           t->from_peak ? 1 : 0};
    const double window[] = {t->window.ticks, (double)t->window.tau_s, (double)t->window.tau_ticks, (double)t->window.per_s};
    put(&out, "template =");
    for (size_t i = 0; i < sizeof head / sizeof *head; i++) {
        put_number(&out, head[i]);
    }
    put(&out, "\ntemplate_window =");
    for (size_t i = 0; i < sizeof window / sizeof *window; i++) {
        put_number(&out, window[i]);
    }
    for (int32_t j = 0; j < t->window.ticks; j++) {
        put_number(&out, t->window.weight_q15[j]);
    }
    put(&out, "\ntemplate_start =");
    for (int32_t k = 0; k < t->bins; k++) {
        put_number(&out, t->start[k]);
    }
    for (int32_t i = 0; i < t->speeds; i++) {
        put(&out, "\ntemplate_speed =");
        put_number(&out, (double)t->speed_m_s[i]);
        put_number(&out, t->volume[i]);
        put_number(&out, t->quiet[i]);
        for (int32_t k = 0; k < t->bins; k++) {
            put_number(&out, t->inverse[i * t->bins + k]);
        }
    }
    put(&out, "\n");
    return out.length;
}
