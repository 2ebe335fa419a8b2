// hardware.h - which devices a rover has: the section [hardware] of its description (rovers/*.toml, docs/hardware.md), read on the rover.
//
// Of the file only [hardware] is read, in the part of TOML that it needs: `key = "text"` or `key = number`, comments, one a line. Every key
// is known, given once, of its kind and in its range, and what the chosen backends need is there; or one line says file, line, key, value,
// mend.
#ifndef TRACTION_HAL_LINUX_HARDWARE_H
#define TRACTION_HAL_LINUX_HARDWARE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { HARDWARE_TEXT = 64, HARDWARE_FILE = 200, HARDWARE_MESSAGE = 500 };

// name, kind (word: one of; text; whole number), words or what for, lowest, highest, what holds when it is left out ("" or -1: nothing)
#define HARDWARE_KEYS(X)                                                                                                                   \
    X(wheels, WORD, "can|pwm", 0, 0, "")                                                                                                   \
    X(sensors, WORD, "can|iio", 0, 0, "")                                                                                                  \
    X(emergency_stop, WORD, "gpio|can", 0, 0, "")                                                                                          \
    X(can_interface, TEXT, "", 0, 0, "")                                                                                                   \
    X(gpio_chip, TEXT, "", 0, 0, "")                                                                                                       \
    X(emergency_stop_line, NUMBER, "", 0, 511, "-1")                                                                                       \
    X(emergency_stop_active, WORD, "high|low", 0, 0, "high")                                                                               \
    X(emergency_stop_present_line, NUMBER, "", 0, 511, "-1")                                                                               \
    X(motor_enable_line, NUMBER, "", 0, 511, "-1")                                                                                         \
    X(brake_line, NUMBER, "", 0, 511, "-1")                                                                                                \
    X(led_line, NUMBER, "", 0, 511, "-1")                                                                                                  \
    X(radar_device, TEXT, "", 0, 0, "")                                                                                                    \
    X(radar_channel, TEXT, "", 0, 0, "")                                                                                                   \
    X(radar_trigger, TEXT, "", 0, 0, "")                                                                                                   \
    X(radar_rate_Hz, NUMBER, "", 100, 2000, "512")                                                                                         \
    X(battery, TEXT, "", 0, 0, "")                                                                                                         \
    X(accel_x, TEXT, "", 0, 0, "")                                                                                                         \
    X(accel_y, TEXT, "", 0, 0, "")                                                                                                         \
    X(accel_z, TEXT, "", 0, 0, "")                                                                                                         \
    X(gyro_x, TEXT, "", 0, 0, "")                                                                                                          \
    X(gyro_y, TEXT, "", 0, 0, "")                                                                                                          \
    X(gyro_z, TEXT, "", 0, 0, "")                                                                                                          \
    X(current_0, TEXT, "", 0, 0, "")                                                                                                       \
    X(current_1, TEXT, "", 0, 0, "")                                                                                                       \
    X(current_2, TEXT, "", 0, 0, "")                                                                                                       \
    X(current_3, TEXT, "", 0, 0, "")                                                                                                       \
    X(pwm_0, TEXT, "", 0, 0, "")                                                                                                           \
    X(pwm_1, TEXT, "", 0, 0, "")                                                                                                           \
    X(pwm_2, TEXT, "", 0, 0, "")                                                                                                           \
    X(pwm_3, TEXT, "", 0, 0, "")                                                                                                           \
    X(pwm_period_ns, NUMBER, "", 1000, 1000000, "50000")                                                                                   \
    X(direction_line_0, NUMBER, "", 0, 511, "-1")                                                                                          \
    X(direction_line_1, NUMBER, "", 0, 511, "-1")                                                                                          \
    X(direction_line_2, NUMBER, "", 0, 511, "-1")                                                                                          \
    X(direction_line_3, NUMBER, "", 0, 511, "-1")                                                                                          \
    X(counter_0, TEXT, "", 0, 0, "")                                                                                                       \
    X(counter_1, TEXT, "", 0, 0, "")                                                                                                       \
    X(counter_2, TEXT, "", 0, 0, "")                                                                                                       \
    X(counter_3, TEXT, "", 0, 0, "")                                                                                                       \
    X(watchdog, TEXT, "", 0, 0, "")                                                                                                        \
    X(watchdog_s, NUMBER, "", 1, 60, "1")                                                                                                  \
    X(priority, NUMBER, "", 0, 99, "0")

typedef enum {
#define HARDWARE_ENUM(name, kind, words, low, high, otherwise) HARDWARE_##name,
    HARDWARE_KEYS(HARDWARE_ENUM)
#undef HARDWARE_ENUM
        HARDWARE_COUNT
} hardware_key_t;

typedef struct {
    int line; // 0: left out
    char text[HARDWARE_TEXT];
    int32_t number; // -1: none
} hardware_value_t;

typedef struct {
    char file[HARDWARE_FILE];
    hardware_value_t key[HARDWARE_COUNT];
} hardware_t;

// Reads the file; or from text of `length` bytes, where `name` is for messages. false, with one line in message.
bool hardware_read(const char *path, hardware_t *hardware, char message[HARDWARE_MESSAGE]);
bool hardware_parse(const char *text, size_t length, const char *name, hardware_t *hardware, char message[HARDWARE_MESSAGE]);

// Whether the key was given or has a value that holds when it is left out.
bool hardware_has(const hardware_t *hardware, hardware_key_t key);
bool hardware_is(const hardware_t *hardware, hardware_key_t key, const char *word);

// "file:line: hardware.key = value: what is wrong; mend" for a device that does not do. Returns false.
bool hardware_refuse(const hardware_t *hardware, hardware_key_t key, const char *what, char message[HARDWARE_MESSAGE]);

#ifdef __cplusplus
}
#endif

#endif
