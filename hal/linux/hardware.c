#include "hardware.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORD, TEXT, NUMBER };
enum { FILE_MAX = 65536, LINE_CHARS = 300 };

typedef struct {
    const char *name;
    int kind;
    const char *words;
    int32_t low, high;
    const char *otherwise;
} row_t;

static const row_t rows[HARDWARE_COUNT] = {
#define HARDWARE_ROW(name, kind, words, low, high, otherwise) {#name, kind, words, low, high, otherwise},
    HARDWARE_KEYS(HARDWARE_ROW)
#undef HARDWARE_ROW
};

typedef struct {
    hardware_t *hardware;
    char *message;
    int line;         // under way
    int section_line; // of [hardware]; 0: not seen
    bool inside;
} reading_t;

static bool fail(const reading_t *reading, const char *key, const char *value, const char *mend) {
    (void)snprintf(reading->message, HARDWARE_MESSAGE, "%.160s:%d: hardware.%.40s%s%.60s: %.160s", reading->hardware->file, reading->line,
                   key, *value != '\0' ? " = " : "", value, mend);
    return false;
}

bool hardware_has(const hardware_t *hardware, hardware_key_t key) {
    return rows[key].kind == NUMBER ? hardware->key[key].number >= 0 : hardware->key[key].text[0] != '\0';
}

bool hardware_is(const hardware_t *hardware, hardware_key_t key, const char *word) { return strcmp(hardware->key[key].text, word) == 0; }

bool hardware_refuse(const hardware_t *hardware, hardware_key_t key, const char *what, char message[HARDWARE_MESSAGE]) {
    char value[HARDWARE_TEXT + 2];
    if (rows[key].kind == NUMBER) {
        (void)snprintf(value, sizeof value, "%d", (int)hardware->key[key].number);
    } else {
        (void)snprintf(value, sizeof value, "\"%.60s\"", hardware->key[key].text);
    }
    (void)snprintf(message, HARDWARE_MESSAGE, "%.160s:%d: hardware.%s = %s: %.200s", hardware->file, hardware->key[key].line,
                   rows[key].name, value, what);
    return false;
}

static char *trim(char *text) {
    text += strspn(text, " \t\r");
    size_t length = strlen(text);
    while (length > 0 && strchr(" \t\r", text[length - 1]) != NULL) {
        text[--length] = '\0';
    }
    return text;
}

// Cuts a comment that is not within quotes.
static void cut_comment(char *line) {
    bool quoted = false;
    for (char *at = line; *at != '\0'; at++) {
        quoted = *at == '"' ? !quoted : quoted;
        if (*at == '#' && !quoted) {
            *at = '\0';
            return;
        }
    }
}

static bool known_word(const char *words, const char *word) {
    const size_t length = strlen(word);
    for (const char *at = words; length > 0 && at != NULL; at = strchr(at, '|') != NULL ? strchr(at, '|') + 1 : NULL) {
        if (strncmp(at, word, length) == 0 && (at[length] == '|' || at[length] == '\0')) {
            return true;
        }
    }
    return false;
}

static bool store_number(const reading_t *reading, const row_t *row, const char *value, hardware_value_t *out) {
    char *end = NULL;
    errno = 0;
    const long number = strtol(value, &end, 10);
    if (end == value || *end != '\0' || errno != 0 || number < row->low || number > row->high) {
        char mend[80];
        (void)snprintf(mend, sizeof mend, "give a whole number from %d to %d", (int)row->low, (int)row->high);
        return fail(reading, row->name, value, mend);
    }
    out->number = (int32_t)number;
    return true;
}

static bool store_text(const reading_t *reading, const row_t *row, const char *value, hardware_value_t *out) {
    const size_t length = strlen(value);
    if (length < 3 || value[0] != '"' || value[length - 1] != '"' || memchr(value + 1, '"', length - 2) != NULL) {
        return fail(reading, row->name, value, "write a text in \"quotes\"");
    }
    if (length - 2 >= sizeof out->text || strchr(value, '\\') != NULL) {
        return fail(reading, row->name, value, "longer than 63 characters, or with a backslash");
    }
    memcpy(out->text, value + 1, length - 2);
    out->text[length - 2] = '\0';
    if (row->kind == WORD && !known_word(row->words, out->text)) {
        char mend[80];
        (void)snprintf(mend, sizeof mend, "unknown; one of %s", row->words);
        return fail(reading, row->name, value, mend);
    }
    if (row->kind == TEXT && strstr(out->text, "..") != NULL) {
        return fail(reading, row->name, value, "a device's name has no \"..\"");
    }
    return true;
}

static bool read_key(const reading_t *reading, char *line) {
    char *equals = strchr(line, '=');
    if (equals == NULL) {
        return fail(reading, line, "", "no '='; write key = value");
    }
    *equals = '\0';
    const char *key = trim(line), *value = trim(equals + 1);
    for (int i = 0; i < HARDWARE_COUNT; i++) {
        if (strcmp(rows[i].name, key) != 0) {
            continue;
        }
        hardware_value_t *out = &reading->hardware->key[i];
        if (out->line != 0) {
            return fail(reading, key, value, "given twice; keep one");
        }
        out->line = reading->line;
        return rows[i].kind == NUMBER ? store_number(reading, &rows[i], value, out) : store_text(reading, &rows[i], value, out);
    }
    return fail(reading, key, value, "unknown key; docs/hardware.md lists the known ones");
}

static bool read_line(reading_t *reading, char *line) {
    cut_comment(line);
    line = trim(line);
    if (*line == '[') {
        if (strcmp(line, "[steering]") == 0) {
            return fail(reading, "steering", line, "these devices have no steering servo: a rover that steers is simulated alone");
        }
        reading->inside = strcmp(line, "[hardware]") == 0;
        if (reading->inside && reading->section_line != 0) {
            return fail(reading, "section", line, "given twice; keep one");
        }
        reading->section_line = reading->inside ? reading->line : reading->section_line;
        return true;
    }
    return !reading->inside || *line == '\0' || read_key(reading, line);
}

static bool need(const reading_t *reading, hardware_key_t key, const char *because) {
    if (hardware_has(reading->hardware, key)) {
        return true;
    }
    char mend[120];
    (void)snprintf(mend, sizeof mend, "missing; %s needs it", because);
    return fail(reading, rows[key].name, "", mend);
}

// What the chosen backends cannot do without.
static bool complete(reading_t *reading) {
    const hardware_t *hardware = reading->hardware;
    reading->line = reading->section_line;
    if (reading->section_line == 0) {
        (void)snprintf(reading->message, HARDWARE_MESSAGE, "%.160s: no section [hardware]; docs/hardware.md has one to begin with",
                       hardware->file);
        return false;
    }
    bool good = need(reading, HARDWARE_wheels, "a rover") && need(reading, HARDWARE_sensors, "a rover") &&
                need(reading, HARDWARE_emergency_stop, "a rover");
    const bool bus = hardware_is(hardware, HARDWARE_wheels, "can") || hardware_is(hardware, HARDWARE_sensors, "can");
    good = good && (!bus || need(reading, HARDWARE_can_interface, "\"can\""));
    if (good && hardware_is(hardware, HARDWARE_emergency_stop, "can") && !hardware_is(hardware, HARDWARE_sensors, "can")) {
        return hardware_refuse(hardware, HARDWARE_emergency_stop, "the line is the sensor node's: sensors = \"can\", or \"gpio\"",
                               reading->message);
    }
    const bool line = good && hardware_is(hardware, HARDWARE_emergency_stop, "gpio");
    good = good && (!line || need(reading, HARDWARE_emergency_stop_line, "emergency_stop = \"gpio\""));
    bool lines = line;
    for (int i = HARDWARE_emergency_stop_present_line; i <= HARDWARE_led_line; i++) {
        lines = lines || hardware_has(hardware, (hardware_key_t)i);
    }
    for (int wheel = 0; good && wheel < 4 && hardware_is(hardware, HARDWARE_wheels, "pwm"); wheel++) {
        good = need(reading, (hardware_key_t)(HARDWARE_pwm_0 + wheel), "wheels = \"pwm\"") &&
               need(reading, (hardware_key_t)(HARDWARE_direction_line_0 + wheel), "wheels = \"pwm\"") &&
               need(reading, (hardware_key_t)(HARDWARE_counter_0 + wheel), "wheels = \"pwm\"") &&
               need(reading, (hardware_key_t)(HARDWARE_current_0 + wheel), "wheels = \"pwm\"");
        lines = true;
    }
    if (good && hardware_is(hardware, HARDWARE_sensors, "iio")) {
        const hardware_key_t needed[] = {HARDWARE_radar_device, HARDWARE_radar_channel, HARDWARE_battery, HARDWARE_accel_x,
                                         HARDWARE_gyro_z};
        for (size_t i = 0; good && i < sizeof needed / sizeof *needed; i++) {
            good = need(reading, needed[i], "sensors = \"iio\"");
        }
    }
    return good && (!lines || need(reading, HARDWARE_gpio_chip, "a line"));
}

// Two uses of one line, one interface or one device are a mistake of wiring.
static bool distinct(const reading_t *reading) {
    const hardware_t *hardware = reading->hardware;
    for (int i = 0; i < HARDWARE_COUNT; i++) {
        const bool line = strstr(rows[i].name, "_line") != NULL;
        const bool device = (i >= HARDWARE_battery && i <= HARDWARE_pwm_3) || (i >= HARDWARE_counter_0 && i <= HARDWARE_counter_3);
        for (int k = 0; k < i && (line || device); k++) {
            const bool both = hardware->key[i].line != 0 && hardware->key[k].line != 0 && rows[i].kind == rows[k].kind;
            const bool same = line ? strstr(rows[k].name, "_line") != NULL && hardware->key[i].number == hardware->key[k].number
                                   : strcmp(hardware->key[i].text, hardware->key[k].text) == 0;
            if (both && same) {
                char what[120];
                (void)snprintf(what, sizeof what, "is %s already (line %d); each has its own", rows[k].name, hardware->key[k].line);
                return hardware_refuse(hardware, (hardware_key_t)i, what, reading->message);
            }
        }
    }
    return true;
}

bool hardware_parse(const char *text, size_t length, const char *name, hardware_t *hardware, char message[HARDWARE_MESSAGE]) {
    memset(hardware, 0, sizeof *hardware);
    (void)snprintf(hardware->file, sizeof hardware->file, "%s", name);
    for (int i = 0; i < HARDWARE_COUNT; i++) {
        hardware->key[i].number = rows[i].kind == NUMBER ? (int32_t)strtol(rows[i].otherwise, NULL, 10) : -1;
        (void)snprintf(hardware->key[i].text, HARDWARE_TEXT, "%s", rows[i].kind == NUMBER ? "" : rows[i].otherwise);
    }
    reading_t reading = {.hardware = hardware, .message = message};
    message[0] = '\0';
    for (size_t start = 0; start < length;) {
        const char *end = memchr(text + start, '\n', length - start);
        const size_t chars = end != NULL ? (size_t)(end - (text + start)) : length - start;
        reading.line++;
        char line[LINE_CHARS];
        const bool fits = chars < sizeof line && memchr(text + start, '\0', chars) == NULL;
        if (!fits && reading.inside) {
            return fail(&reading, "line", "", "too long or not text; a line has at most 299 characters");
        }
        if (fits) {
            memcpy(line, text + start, chars);
            line[chars] = '\0';
            if (!read_line(&reading, line)) {
                return false;
            }
        }
        start += chars + 1;
    }
    return complete(&reading) && distinct(&reading);
}

bool hardware_read(const char *path, hardware_t *hardware, char message[HARDWARE_MESSAGE]) {
    FILE *file = fopen(path, "rb");
    char *text = malloc(FILE_MAX);
    bool done = false;
    if (file == NULL || text == NULL) {
        (void)snprintf(message, HARDWARE_MESSAGE, "%.200s: cannot be read: %.80s", path, strerror(errno));
    } else {
        const size_t length = fread(text, 1, FILE_MAX, file);
        if (ferror(file) != 0 || length == FILE_MAX) {
            (void)snprintf(message, HARDWARE_MESSAGE, "%.200s: cannot be read, or longer than 64 kB", path);
        } else {
            done = hardware_parse(text, length, path, hardware, message);
        }
    }
    free(text);
    if (file != NULL) {
        (void)fclose(file);
    }
    return done;
}
