#include "parameters.h"

#include "firmware/core/fixed.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_MAX_CHARS = TEMPLATE_LINE, FILE_MAX_BYTES = 262144 };

typedef struct {
    const char *file;
    int line;
    char *message;
} place_t;

static bool fail(const place_t *place, const char *key, const char *value, const char *mend)
{
    (void)snprintf(place->message, PARAMETERS_MESSAGE, "%.80s:%d: %.40s = %.40s: %.80s", place->file, place->line, key, value, mend);
    return false;
}

// Cuts blanks at both ends, in place.
static char *trim(char *text)
{
    while (*text == ' ' || *text == '\t' || *text == '\r') {
        text++;
    }
    size_t length = strlen(text);
    while (length > 0 && (text[length - 1] == ' ' || text[length - 1] == '\t' || text[length - 1] == '\r')) {
        text[--length] = '\0';
    }
    return text;
}

int32_t parameters_find(const char *key)
{
    for (int32_t i = 0; i < ROVER_PARAMETER_COUNT; i++) {
        if (strcmp(rover_parameter_name(i), key) == 0) {
            return i;
        }
    }
    return -1;
}

// What a file says, and where.
typedef struct {
    parameters_t read;
    int line[ROVER_PARAMETER_COUNT];
    int radar_line;
    bool format_seen;
    template_reading_t beam;
} reading_t;

static bool read_radar(const place_t *place, const char *value, reading_t *reading)
{
    if (reading->radar_line != 0) {
        return fail(place, "radar", value, "given twice; keep one");
    }
    for (int32_t i = 0; i < ROVER_RADAR_COUNT; i++) {
        const char *name = rover_radar_name(i);
        const size_t length = strlen(name);
        if (strlen(value) == length + 2 && value[0] == '"' && value[length + 1] == '"' && memcmp(value + 1, name, length) == 0) {
            reading->read.rover.radar = i;
            reading->read.radar_given = true;
            reading->radar_line = place->line;
            return true;
        }
    }
    return fail(place, "radar", value, "no template; use \"MDU1130\", \"DJ Radar II\", \"DJ Radar III\", \"DRS1000\", \"own\"");
}

static bool read_number(const place_t *place, const char *key, const char *value, reading_t *reading)
{
    const int32_t i = parameters_find(key);
    if (i < 0) {
        return fail(place, key, value, "unknown key; docs/rover_format.md lists the known ones");
    }
    if (reading->read.given[i]) {
        return fail(place, key, value, "given twice; keep one");
    }
    char *end = NULL;
    const float number = strtof(value, &end);
    if (end == value || *end != '\0' || !fixed_is_finite(number)) {
        return fail(place, key, value, "not a finite number");
    }
    if (number < rover_parameter_low(i) || number > rover_parameter_high(i)) {
        char mend[80];
        (void)snprintf(mend, sizeof mend, "out of range; give a number from %g to %g", (double)rover_parameter_low(i),
                       (double)rover_parameter_high(i));
        return fail(place, key, value, mend);
    }
    reading->read.rover.value[i] = number;
    reading->read.given[i] = true;
    reading->line[i] = place->line;
    return true;
}

static bool read_line(const place_t *place, char *line, reading_t *reading)
{
    char *comment = strchr(line, '#');
    if (comment != NULL) {
        *comment = '\0';
    }
    char *key = trim(line);
    if (*key == '\0') {
        return true;
    }
    char *equals = strchr(key, '=');
    if (equals == NULL) {
        return fail(place, key, "", "no '='; write key = value");
    }
    *equals = '\0';
    key = trim(key);
    const char *value = trim(equals + 1);
    if (strcmp(key, "format") == 0) {
        reading->format_seen = strcmp(value, "\"traction.firmware/1\"") == 0;
        return reading->format_seen || fail(place, key, value, "not known here; this firmware reads \"traction.firmware/1\"");
    }
    if (template_text_key(key)) {
        const char *wrong = template_text_read(&reading->beam, key, value);
        return wrong == NULL || fail(place, key, value, wrong);
    }
    return strcmp(key, "radar") == 0 ? read_radar(place, value, reading) : read_number(place, key, value, reading);
}

// An own radar needs its template, and nobody else takes one.
static bool take_template(place_t *place, reading_t *reading)
{
    const bool own = reading->read.rover.radar == ROVER_RADAR_OWN;
    if (!own && !reading->beam.head) {
        return true;
    }
    place->line = reading->radar_line;
    const char *wrong = own ? template_text_check(&reading->beam) : "is linked, but a template is given; write \"own\"";
    if (wrong != NULL) {
        return fail(place, "radar", rover_radar_name(reading->read.rover.radar), wrong);
    }
    reading->read.rover.beam = reading->beam.into;
    return true;
}

static bool read_text(const char *text, size_t length, place_t *place, doppler_template_t *beam, reading_t *reading)
{
    const reading_t nothing = {.radar_line = 0, .beam = {.into = beam}};
    *reading = nothing;
    rover_parameters_reference(&reading->read.rover);
    place->message[0] = '\0';
    for (size_t start = 0; start < length;) {
        size_t end = start;
        while (end < length && text[end] != '\n') {
            end++;
        }
        place->line++;
        char line[LINE_MAX_CHARS];
        if (end - start >= sizeof line || memchr(text + start, '\0', end - start) != NULL) {
            return fail(place, "line", "...", "too long or not text; a line has at most 1023 characters");
        }
        memcpy(line, text + start, end - start);
        line[end - start] = '\0';
        if (!read_line(place, line, reading)) {
            return false;
        }
        start = end + 1;
    }
    if (!reading->format_seen) {
        return fail(place, "format", "", "missing; write format = \"traction.firmware/1\"");
    }
    if (!take_template(place, reading)) {
        return false;
    }
    rover_parameters_scale(&reading->read.rover, reading->read.given);
    return true;
}

bool parameters_parse_rover(const char *text, size_t length, const char *name, parameters_t *out, doppler_template_t *beam,
                            char message[PARAMETERS_MESSAGE])
{
    place_t place = {.file = name, .line = 0, .message = message};
    reading_t reading;
    const bool read = read_text(text, length, &place, beam, &reading);
    if (read) {
        *out = reading.read;
    }
    return read;
}

// Tells a refusal with the line of its key, or that the number was made from the others.
static bool tell(const place_t *place, const reading_t *reading, const control_refusal_t *refusal)
{
    const int32_t i = parameters_find(refusal->key);
    if (i < 0) {
        (void)snprintf(place->message, PARAMETERS_MESSAGE, "%.80s:%d: %s = \"%s\": %s", place->file, reading->radar_line, refusal->key,
                       rover_radar_name(reading->read.rover.radar), refusal->reason);
    } else if (reading->read.given[i]) {
        (void)snprintf(place->message, PARAMETERS_MESSAGE, "%.80s:%d: %s = %g: %s", place->file, reading->line[i], refusal->key,
                       (double)reading->read.rover.value[i], refusal->reason);
    } else {
        (void)snprintf(place->message, PARAMETERS_MESSAGE, "%.80s: %s = %g (not given: %s): %s", place->file, refusal->key,
                       (double)reading->read.rover.value[i],
                       rover_parameter_scaled(i) ? "from the rover's own numbers" : "the reference rover's", refusal->reason);
    }
    return false;
}

static bool parse_whole(const char *text, size_t length, const char *name, control_config_t *config, rover_parameters_t *rover,
                        doppler_template_t *beam, char message[PARAMETERS_MESSAGE])
{
    place_t place = {.file = name, .line = 0, .message = message};
    reading_t reading;
    if (!read_text(text, length, &place, beam, &reading)) {
        return false;
    }
    control_config_t built;
    control_config_build(&reading.read.rover, &built);
    const control_refusal_t refusal = control_config_check(&reading.read.rover, &built);
    if (refusal.key != NULL) {
        return tell(&place, &reading, &refusal);
    }
    *config = built;
    if (rover != NULL) {
        *rover = reading.read.rover;
    }
    return true;
}

bool parameters_parse(const char *text, size_t length, const char *name, control_config_t *config, doppler_template_t *beam,
                      char message[PARAMETERS_MESSAGE])
{
    return parse_whole(text, length, name, config, NULL, beam, message);
}

size_t parameters_write(const parameters_t *parameters, const char *about, char text[PARAMETERS_TEXT])
{
    int length = snprintf(text, PARAMETERS_TEXT, "# %.200s\nformat = \"traction.firmware/1\"\nradar = \"%s\"\n", about,
                          rover_radar_name(parameters->rover.beam != NULL ? ROVER_RADAR_OWN : parameters->rover.radar));
    for (int32_t i = 0; i < ROVER_PARAMETER_COUNT && length < PARAMETERS_TEXT; i++) {
        const bool follows = rover_parameter_scaled(i) && !parameters->given[i];
        length += snprintf(text + length, (size_t)(PARAMETERS_TEXT - length), "%s%s = %.9g%s\n", follows ? "# " : "",
                           rover_parameter_name(i), (double)parameters->rover.value[i], follows ? " (from the rover's own numbers)" : "");
    }
    if (parameters->rover.beam != NULL && PARAMETERS_TEXT - length >= TEMPLATE_TEXT) {
        length += (int)template_text_write(parameters->rover.beam, text + length);
    }
    return (size_t)length;
}

bool parameters_read(const char *path, control_config_t *config, doppler_template_t *beam, char message[PARAMETERS_MESSAGE])
{
    return parameters_read_whole(path, config, NULL, beam, message);
}

bool parameters_read_whole(const char *path, control_config_t *config, rover_parameters_t *rover, doppler_template_t *beam,
                           char message[PARAMETERS_MESSAGE])
{
    FILE *file = fopen(path, "rb");
    char *text = malloc(FILE_MAX_BYTES);
    bool done = false;
    if (file == NULL || text == NULL) {
        (void)snprintf(message, PARAMETERS_MESSAGE, "%.120s: cannot be read: %.80s", path, strerror(errno));
    } else {
        const size_t length = fread(text, 1, FILE_MAX_BYTES, file);
        if (ferror(file) != 0 || length == FILE_MAX_BYTES) {
            (void)snprintf(message, PARAMETERS_MESSAGE, "%.120s: cannot be read, or longer than 256 kB", path);
        } else {
            done = parse_whole(text, length, path, config, rover, beam, message);
        }
    }
    free(text);
    if (file != NULL) {
        (void)fclose(file);
    }
    return done;
}
