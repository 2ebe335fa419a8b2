#include "parameters.h"

#include "firmware/core/fixed.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_MAX_CHARS = 512, FILE_MAX_BYTES = 65536 };

typedef enum { RADIUS, TORQUE_CONSTANT, VISCOUS, COULOMB, INERTIA, RESISTANCE, MASS, DOPPLER_SCALE, WHEEL_KP, WHEEL_KI, KNOWN } parameter_t;

typedef struct {
    const char *name;
    float low, high; // plausible for a machine of this kind; beyond is a mistake of unit
} known_t;

static const known_t known[KNOWN] = {
    [RADIUS] = {"wheel_radius_m", 0.01f, 0.5f}, [TORQUE_CONSTANT] = {"torque_constant_Nm_A", 0.001f, 20.0f},
    [VISCOUS] = {"viscous_Nms", 0.0f, 1.0f},    [COULOMB] = {"coulomb_Nm", 0.0f, 5.0f},
    [INERTIA] = {"inertia_kg_m2", 1e-5f, 1.0f}, [RESISTANCE] = {"resistance_ohm", 0.01f, 100.0f},
    [MASS] = {"mass_kg", 0.1f, 200.0f},         [DOPPLER_SCALE] = {"doppler_scale", 0.5f, 2.0f},
    [WHEEL_KP] = {"wheel_kp_s", 0.0f, 10.0f},   [WHEEL_KI] = {"wheel_ki_1", 0.0f, 200.0f},
};

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

static int find(const char *key)
{
    for (int i = 0; i < KNOWN; i++) {
        if (strcmp(known[i].name, key) == 0) {
            return i;
        }
    }
    return -1;
}

// Sets everything that follows from the numbers given; value[i] counts where given[i].
static void apply(control_config_t *config, const float *value, const bool *given)
{
    motor_config_t *motor = &config->motor;
    const float radius = given[RADIUS] ? value[RADIUS] : config->geometry.wheel_radius_m;
    const float old_resistance = motor->resistance_ohm;
    if (given[RADIUS]) {
        config->soil_sweep.ramp_1_m *= config->geometry.wheel_radius_m / radius;
        config->speed_control.kv_rad_m *= config->geometry.wheel_radius_m / radius;
        config->geometry.wheel_radius_m = radius;
        config->slip.wheel_radius_m = radius;
        config->speed_control.per_radius_1_m = 1.0f / radius;
        config->speed_control.half_track_per_radius = config->geometry.half_track_m / radius;
        motor->per_radius_1_m = 1.0f / radius;
    }
    motor->torque_constant_Nm_A = given[TORQUE_CONSTANT] ? value[TORQUE_CONSTANT] : motor->torque_constant_Nm_A;
    motor->back_emf_Vs = given[TORQUE_CONSTANT] ? value[TORQUE_CONSTANT] : motor->back_emf_Vs;
    motor->viscous_Nms = given[VISCOUS] ? value[VISCOUS] : motor->viscous_Nms;
    motor->dry_Nm = given[COULOMB] ? value[COULOMB] : motor->dry_Nm;
    motor->inertia_kg_m2 = given[INERTIA] ? value[INERTIA] : motor->inertia_kg_m2;
    motor->resistance_ohm = given[RESISTANCE] ? value[RESISTANCE] : motor->resistance_ohm;
    motor->volt_per_speed_Vs = motor->resistance_ohm * motor->viscous_Nms / motor->torque_constant_Nm_A + motor->back_emf_Vs;
    motor->volt_dry_V = motor->resistance_ohm * motor->dry_Nm / motor->torque_constant_Nm_A;
    config->safety.heating_K_A2 *= motor->resistance_ohm / old_resistance;
    config->geometry.mass_kg = given[MASS] ? value[MASS] : config->geometry.mass_kg;
    config->doppler.scale = given[DOPPLER_SCALE] ? value[DOPPLER_SCALE] : config->doppler.scale;
    config->wheel_pid.kp_s = given[WHEEL_KP] ? value[WHEEL_KP] : config->wheel_pid.kp_s;
    config->wheel_pid.ki_T_s = given[WHEEL_KI] ? value[WHEEL_KI] * config->safety.tick_s : config->wheel_pid.ki_T_s;
}

static bool read_line(const place_t *place, char *line, float *number, bool *given, bool *format_seen)
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
    char *value = trim(equals + 1);
    if (strcmp(key, "format") == 0) {
        *format_seen = strcmp(value, "\"traction.firmware/1\"") == 0;
        return *format_seen || fail(place, key, value, "not known here; this firmware reads \"traction.firmware/1\"");
    }
    const int i = find(key);
    if (i < 0) {
        return fail(place, key, value, "unknown key; firmware/app/parameters.c lists the known ones");
    }
    if (given[i]) {
        return fail(place, key, value, "given twice; keep one");
    }
    char *end = NULL;
    number[i] = strtof(value, &end);
    if (end == value || *end != '\0' || !fixed_is_finite(number[i])) {
        return fail(place, key, value, "not a finite number");
    }
    if (number[i] < known[i].low || number[i] > known[i].high) {
        char mend[80];
        (void)snprintf(mend, sizeof mend, "out of range; give a number from %g to %g", (double)known[i].low, (double)known[i].high);
        return fail(place, key, value, mend);
    }
    given[i] = true;
    return true;
}

bool parameters_parse(const char *text, size_t length, const char *name, control_config_t *config, char message[PARAMETERS_MESSAGE])
{
    place_t place = {.file = name, .line = 0, .message = message};
    float number[KNOWN] = {0.0f};
    bool given[KNOWN] = {false};
    bool format_seen = false;
    message[0] = '\0';
    for (size_t start = 0; start < length;) {
        size_t end = start;
        while (end < length && text[end] != '\n') {
            end++;
        }
        place.line++;
        char line[LINE_MAX_CHARS];
        if (end - start >= sizeof line || memchr(text + start, '\0', end - start) != NULL) {
            return fail(&place, "line", "...", "too long or not text; a line has at most 511 characters");
        }
        memcpy(line, text + start, end - start);
        line[end - start] = '\0';
        if (!read_line(&place, line, number, given, &format_seen)) {
            return false;
        }
        start = end + 1;
    }
    if (!format_seen) {
        return fail(&place, "format", "", "missing; write format = \"traction.firmware/1\"");
    }
    apply(config, number, given);
    return true;
}

bool parameters_read(const char *path, control_config_t *config, char message[PARAMETERS_MESSAGE])
{
    FILE *file = fopen(path, "rb");
    char *text = malloc(FILE_MAX_BYTES);
    bool done = false;
    if (file == NULL || text == NULL) {
        (void)snprintf(message, PARAMETERS_MESSAGE, "%.120s: cannot be read: %.80s", path, strerror(errno));
    } else {
        const size_t length = fread(text, 1, FILE_MAX_BYTES, file);
        if (ferror(file) != 0 || length == FILE_MAX_BYTES) {
            (void)snprintf(message, PARAMETERS_MESSAGE, "%.120s: cannot be read, or longer than 64 kB", path);
        } else {
            done = parameters_parse(text, length, path, config, message);
        }
    }
    free(text);
    if (file != NULL) {
        (void)fclose(file);
    }
    return done;
}
