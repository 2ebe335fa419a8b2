#include "pwm_wheels.h"

#include "sysfs.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool refuse(const hardware_t *hardware, hardware_key_t key, const char *what, int result, char *message) {
    char text[160];
    (void)snprintf(text, sizeof text, "%s: %.60s", what, strerror(-result));
    return hardware_refuse(hardware, key, text, message);
}

static int keep(int *fd, const char *root, const char *folder, const char *name, bool writable) {
    char path[SYSFS_PATH];
    *fd = sysfs_path(path, root, folder, name) ? sysfs_open(path, writable) : -ENAMETOOLONG;
    const int result = *fd;
    *fd = *fd < 0 ? -1 : *fd;
    return result < 0 ? result : 0;
}

// "pwmchip0/1" is channel 1 of pwmchip0: exported where it is not yet.
static int open_pwm(pwm_wheel_t *wheel, const char *name, const char *root, int32_t period_ns) {
    char chip[HARDWARE_TEXT], folder[HARDWARE_TEXT * 2 + 40], path[SYSFS_PATH];
    const char *slash = strchr(name, '/');
    if (slash == NULL || slash[1] == '\0') {
        return -EINVAL;
    }
    (void)snprintf(chip, sizeof chip, "%.*s", (int)(slash - name), name);
    (void)snprintf(folder, sizeof folder, "sys/class/pwm/%s/pwm%s", chip, slash + 1);
    if (!sysfs_path(path, root, folder, "enable")) {
        return -ENAMETOOLONG;
    }
    if (access(path, F_OK) != 0) {
        char parent[HARDWARE_TEXT + 40];
        (void)snprintf(parent, sizeof parent, "sys/class/pwm/%s", chip);
        const int exported = sysfs_path(path, root, parent, "export") ? sysfs_write(path, slash + 1) : -ENAMETOOLONG;
        if (exported != 0) {
            return exported;
        }
    }
    int period = -1;
    int result = keep(&wheel->duty, root, folder, "duty_cycle", true);
    result = result == 0 ? keep(&wheel->enable, root, folder, "enable", true) : result;
    result = result == 0 ? keep(&period, root, folder, "period", true) : result;
    result = result == 0 ? sysfs_put(wheel->enable, 0) : result;
    result = result == 0 ? sysfs_put(wheel->duty, 0) : result; // before the period: a duty may not be longer
    result = result == 0 ? sysfs_put(period, period_ns) : result;
    sysfs_close(&period);
    return result;
}

static bool open_wheel(pwm_wheels_t *wheels, int i, const hardware_t *hardware, const char *root, const gpio_chip_t *chip, char *message) {
    pwm_wheel_t *wheel = &wheels->wheel[i];
    const hardware_key_t pwm = (hardware_key_t)(HARDWARE_pwm_0 + i), counter = (hardware_key_t)(HARDWARE_counter_0 + i),
                         current = (hardware_key_t)(HARDWARE_current_0 + i), line = (hardware_key_t)(HARDWARE_direction_line_0 + i);
    int result = open_pwm(wheel, hardware->key[pwm].text, root, wheels->period_ns);
    if (result != 0) {
        return refuse(hardware, pwm, "no such PWM; write \"pwmchipN/CHANNEL\" of /sys/class/pwm", result, message);
    }
    char folder[HARDWARE_TEXT + 40];
    (void)snprintf(folder, sizeof folder, "sys/bus/counter/devices/%s", hardware->key[counter].text);
    result = keep(&wheel->count, root, folder, "count", false);
    if (result != 0) {
        return refuse(hardware, counter, "no such counter; write \"counterN/countM\" of /sys/bus/counter/devices", result, message);
    }
    result = keep(&wheel->current, root, "sys/bus/iio/devices", hardware->key[current].text, false);
    if (result != 0) {
        return refuse(hardware, current, "no such channel; write \"iio:deviceN/in_..._raw\" of /sys/bus/iio/devices", result, message);
    }
    result = gpio_take(chip, (uint32_t)hardware->key[line].number, true, false, &wheel->direction);
    return result == 0 || refuse(hardware, line, "cannot be taken; gpioinfo tells who has it", result, message);
}

bool pwm_wheels_open(pwm_wheels_t *wheels, const hardware_t *hardware, const char *root, const gpio_chip_t *chip,
                     char message[HARDWARE_MESSAGE]) {
    wheels->period_ns = hardware->key[HARDWARE_pwm_period_ns].number;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        wheels->wheel[i] = (pwm_wheel_t){.duty = -1, .enable = -1, .count = -1, .current = -1, .direction = {.fd = -1}};
    }
    for (int i = 0; i < WHEEL_COUNT; i++) {
        if (!open_wheel(wheels, i, hardware, root, chip, message)) {
            pwm_wheels_close(wheels);
            return false;
        }
    }
    return true;
}

void pwm_wheels_read(pwm_wheels_t *wheels, sensor_frame_t *frame) {
    for (uint32_t i = 0; i < WHEEL_COUNT; i++) {
        int64_t count = 0, current = 0;
        if (sysfs_get(wheels->wheel[i].count, &count) == 0) {
            frame->encoder_count[i] = (int32_t)(uint32_t)(uint64_t)count; // wraps
            frame->present |= (uint32_t)FRAME_ENCODER_0 << i;
        }
        if (sysfs_get(wheels->wheel[i].current, &current) == 0) {
            frame->current_count[i] = (uint16_t)(current < 0 ? 0 : current > UINT16_MAX ? UINT16_MAX : current);
            frame->present |= (uint32_t)FRAME_CURRENT_0 << i;
        }
        frame->bridge_status[i] = 0;
        const uint32_t both = ((uint32_t)FRAME_ENCODER_0 | (uint32_t)FRAME_CURRENT_0) << i;
        frame->present |= (frame->present & both) == both ? (uint32_t)FRAME_BRIDGE_0 << i : 0u;
    }
}

static bool write_wheel(pwm_wheel_t *wheel, const gpio_chip_t *chip, int32_t period_ns, drive_state_t drive, int32_t duty_q15) {
    const int32_t duty = drive == DRIVE_ON ? (duty_q15 < -INT16_MAX ? -INT16_MAX : duty_q15) : 0;
    const bool enable = drive == DRIVE_ON || drive == DRIVE_BRAKE;
    bool good = true;
    if (duty != 0 && (duty < 0) != wheel->backward) {
        good = sysfs_put(wheel->duty, 0) == 0 && gpio_set(chip, &wheel->direction, duty < 0) == 0;
        wheel->backward = good ? duty < 0 : wheel->backward;
    }
    good = good && sysfs_put(wheel->duty, (int64_t)abs(duty) * period_ns / INT16_MAX) == 0;
    if (good && enable != wheel->enabled) {
        good = sysfs_put(wheel->enable, enable ? 1 : 0) == 0;
        wheel->enabled = good ? enable : wheel->enabled;
    }
    return good;
}

bool pwm_wheels_write(pwm_wheels_t *wheels, const gpio_chip_t *chip, const actuator_frame_t *actuator) {
    bool good = true;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        good = write_wheel(&wheels->wheel[i], chip, wheels->period_ns, actuator->drive, actuator->duty_q15[i]) && good;
    }
    return good;
}

void pwm_wheels_close(pwm_wheels_t *wheels) {
    for (int i = 0; i < WHEEL_COUNT; i++) {
        pwm_wheel_t *wheel = &wheels->wheel[i];
        if (wheel->enable >= 0) {
            (void)sysfs_put(wheel->enable, 0);
        }
        sysfs_close(&wheel->duty);
        sysfs_close(&wheel->enable);
        sysfs_close(&wheel->count);
        sysfs_close(&wheel->current);
        gpio_release(&wheel->direction);
    }
}
