#include "linux_hal.h"

#include "sysfs.h"
#include "watchdog.h"

#include <errno.h>
#include <poll.h>
#include <sched.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>

static const int64_t ns_per_s = 1000000000, tick_ns = (int64_t)TICK_US * 1000, answers_ns = 3000000;

static int64_t clock_ns(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * ns_per_s + now.tv_nsec;
}

static bool uses_can(const linux_hal_t *self) { return self->nodes.wheels || self->nodes.sensors; }

void linux_hal_begin(linux_hal_t *self, const hardware_t *hardware, const char *root) {
    memset(self, 0, sizeof *self);
    self->hardware = *hardware;
    self->root = root;
    self->nodes = (can_master_config_t){.wheels = hardware_is(hardware, HARDWARE_wheels, "can"),
                                        .sensors = hardware_is(hardware, HARDWARE_sensors, "can"),
                                        .emergency_stop = hardware_is(hardware, HARDWARE_emergency_stop, "can")};
    self->bus.fd = self->chip.chip = self->watchdog = self->radar.fd = -1;
    self->stop.fd = self->stop_present.fd = self->enable.fd = self->brake.fd = self->led.fd = -1;
    for (int i = 0; i < LINUX_RAW_CHANNELS; i++) {
        self->raw[i] = -1;
    }
    for (int i = 0; i < WHEEL_COUNT; i++) {
        self->wheels.wheel[i] = (pwm_wheel_t){.duty = -1, .enable = -1, .count = -1, .current = -1, .direction = {.fd = -1}};
    }
}

// --- opening

static bool refuse(linux_hal_t *self, hardware_key_t key, const char *what, int result) {
    char text[200];
    (void)snprintf(text, sizeof text, "%s: %.60s", what, strerror(-result));
    return hardware_refuse(&self->hardware, key, text, self->trouble);
}

static bool open_bus(linux_hal_t *self) {
    if (!uses_can(self) || self->bus.fd >= 0) {
        return true;
    }
    const int result = can_socket_open(&self->bus, self->hardware.key[HARDWARE_can_interface].text);
    return result == 0 || refuse(self, HARDWARE_can_interface, "is no CAN interface that is up; ip -details link shows them", result);
}

static bool take_line(linux_hal_t *self, hardware_key_t key, bool output, bool active_low, gpio_line_t *line) {
    if (!hardware_has(&self->hardware, key)) {
        return true;
    }
    const int result = gpio_take(&self->chip, (uint32_t)self->hardware.key[key].number, output, active_low, line);
    return result == 0 || refuse(self, key, "the line cannot be taken; gpioinfo tells who has it", result);
}

static bool open_lines(linux_hal_t *self) {
    if (!hardware_has(&self->hardware, HARDWARE_gpio_chip)) {
        return true;
    }
    char path[SYSFS_PATH];
    const int result =
        sysfs_path(path, self->root, "dev", self->hardware.key[HARDWARE_gpio_chip].text) ? gpio_open(&self->chip, path) : -ENAMETOOLONG;
    if (result != 0) {
        return refuse(self, HARDWARE_gpio_chip, "is no GPIO chip; gpiodetect lists them", result);
    }
    const bool low = hardware_is(&self->hardware, HARDWARE_emergency_stop_active, "low");
    return take_line(self, HARDWARE_emergency_stop_line, false, low, &self->stop) &&
           take_line(self, HARDWARE_emergency_stop_present_line, false, false, &self->stop_present) &&
           take_line(self, HARDWARE_motor_enable_line, true, false, &self->enable) &&
           take_line(self, HARDWARE_brake_line, true, false, &self->brake) && take_line(self, HARDWARE_led_line, true, false, &self->led);
}

static bool open_radar(linux_hal_t *self) {
    static const hardware_key_t part_key[] = {HARDWARE_radar_device, HARDWARE_radar_channel, HARDWARE_radar_trigger,
                                              HARDWARE_radar_rate_Hz};
    const hardware_t *hardware = &self->hardware;
    const iio_config_t config = {.root = self->root,
                                 .device = hardware->key[HARDWARE_radar_device].text,
                                 .channel = hardware->key[HARDWARE_radar_channel].text,
                                 .trigger = hardware->key[HARDWARE_radar_trigger].text,
                                 .rate_Hz = hardware->key[HARDWARE_radar_rate_Hz].number};
    iio_part_t part = IIO_DEVICE;
    char what[IIO_MESSAGE];
    return iio_capture_open(&self->radar, &config, &part, what) || hardware_refuse(hardware, part_key[part], what, self->trouble);
}

static bool open_sensors(linux_hal_t *self) {
    if (self->nodes.sensors) {
        return true;
    }
    for (int i = 0; i < LINUX_RAW_CHANNELS; i++) {
        const hardware_key_t key = (hardware_key_t)(HARDWARE_battery + i);
        char path[SYSFS_PATH];
        if (!hardware_has(&self->hardware, key)) {
            continue;
        }
        const int fd =
            sysfs_path(path, self->root, "sys/bus/iio/devices", self->hardware.key[key].text) ? sysfs_open(path, false) : -ENAMETOOLONG;
        if (fd < 0) {
            return refuse(self, key, "no such channel; write \"iio:deviceN/in_..._raw\" of /sys/bus/iio/devices", fd);
        }
        self->raw[i] = fd;
    }
    return open_radar(self);
}

static bool open_watchdog(linux_hal_t *self) {
    if (!hardware_has(&self->hardware, HARDWARE_watchdog)) {
        return true;
    }
    char path[SYSFS_PATH];
    const int seconds = self->hardware.key[HARDWARE_watchdog_s].number;
    const int fd =
        sysfs_path(path, self->root, "dev", self->hardware.key[HARDWARE_watchdog].text) ? watchdog_open(path, seconds) : -ENAMETOOLONG;
    self->watchdog = fd < 0 ? -1 : fd;
    return fd >= 0 || refuse(self, fd == -EINVAL ? HARDWARE_watchdog_s : HARDWARE_watchdog, "cannot be started; is its driver loaded?", fd);
}

// Where it is not permitted the rover drives all the same; ticks that come late are counted.
static void be_on_time(linux_hal_t *self) {
    const struct sched_param param = {.sched_priority = self->hardware.key[HARDWARE_priority].number};
    if (param.sched_priority <= 0) {
        return;
    }
    if (sched_setscheduler(0, SCHED_FIFO, &param) != 0 || mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
        (void)hardware_refuse(&self->hardware, HARDWARE_priority, "not permitted here (CAP_SYS_NICE, CAP_IPC_LOCK); ticks may come late",
                              self->note);
    }
}

static uint32_t expected_bits(const linux_hal_t *self) {
    static const uint32_t raw_bit[] = {FRAME_BATTERY, FRAME_ACCEL, FRAME_ACCEL_YZ, 0, FRAME_GYRO_XY, 0, FRAME_GYRO};
    uint32_t bits = FRAME_TIME | can_master_expects(&self->nodes);
    bits |= self->nodes.wheels ? 0u : 0xfu * (uint32_t)(FRAME_ENCODER_0 | FRAME_CURRENT_0 | FRAME_BRIDGE_0);
    for (int i = 0; i < LINUX_RAW_CHANNELS; i++) {
        bits |= self->raw[i] >= 0 ? raw_bit[i] : 0u;
    }
    bits |= self->radar.fd >= 0 ? (uint32_t)FRAME_RADAR : 0u;
    return bits | (self->stop.fd >= 0 ? (uint32_t)FRAME_EMERGENCY_STOP : 0u);
}

static void close_devices(void *context) {
    linux_hal_t *self = context;
    can_socket_close(&self->bus);
    pwm_wheels_close(&self->wheels);
    iio_capture_close(&self->radar);
    for (int i = 0; i < LINUX_RAW_CHANNELS; i++) {
        sysfs_close(&self->raw[i]);
    }
    gpio_release(&self->stop);
    gpio_release(&self->stop_present);
    gpio_release(&self->enable);
    gpio_release(&self->brake);
    gpio_release(&self->led);
    gpio_close(&self->chip);
    watchdog_close(&self->watchdog);
    self->open = false;
}

static hal_result_t open_devices(void *context) {
    linux_hal_t *self = context;
    const bool pwm = !self->nodes.wheels;
    const bool good = open_bus(self) && open_lines(self) && open_sensors(self) &&
                      (!pwm || pwm_wheels_open(&self->wheels, &self->hardware, self->root, &self->chip, self->trouble)) &&
                      open_watchdog(self);
    if (!good) {
        close_devices(self);
        return HAL_ERR_CONFIG;
    }
    be_on_time(self);
    self->expected = expected_bits(self);
    self->open = true;
    return HAL_OK;
}

// --- a tick

static hal_result_t lost(linux_hal_t *self, hardware_key_t key, const char *what) {
    (void)hardware_refuse(&self->hardware, key, what, self->trouble);
    return HAL_ERR_IO;
}

// Answers until all are there or their time is over.
static hal_result_t collect(linux_hal_t *self) {
    const int64_t until_ns = self->latched_ns + answers_ns;
    for (;;) {
        can_frame_t frame;
        can_socket_result_t got = can_socket_receive(&self->bus, &frame);
        while (got == CAN_SOCKET_OK) {
            (void)can_master_receive(&self->nodes, &self->master, &frame);
            got = can_socket_receive(&self->bus, &frame);
        }
        const int64_t left_ns = until_ns - clock_ns();
        if (got == CAN_SOCKET_GONE) {
            return lost(self, HARDWARE_can_interface, "the interface is down or away");
        }
        if (can_master_complete(&self->nodes, &self->master) || left_ns <= 0 || self->bus.bus_off) {
            return HAL_OK;
        }
        struct pollfd wait = {.fd = self->bus.fd, .events = POLLIN};
        const struct timespec left = {.tv_sec = 0, .tv_nsec = (long)left_ns};
        (void)ppoll(&wait, 1, &left, NULL);
    }
}

static hal_result_t exchange(linux_hal_t *self) {
    can_frame_t sync;
    can_master_sync(&self->nodes, &self->master, &sync);
    const can_socket_result_t sent = can_socket_send(&self->bus, &sync, self->latched_ns);
    if (sent == CAN_SOCKET_GONE) {
        return lost(self, HARDWARE_can_interface, "the interface is down or away");
    }
    return collect(self); // error frames too: they say when the controller is back
}

static hal_result_t wait_tick(void *context) {
    linux_hal_t *self = context;
    const int64_t now_ns = clock_ns();
    if (self->due_ns == 0) {
        self->due_ns = now_ns;
    }
    if (now_ns - self->due_ns > tick_ns) {
        const int64_t missed = (now_ns - self->due_ns) / tick_ns;
        self->overruns++;
        self->tick += (uint32_t)missed;
        self->due_ns += missed * tick_ns;
    }
    const struct timespec due = {.tv_sec = (time_t)(self->due_ns / ns_per_s), .tv_nsec = (long)(self->due_ns % ns_per_s)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL) == EINTR) { // a signal: what is left of the tick
    }
    self->due_ns += tick_ns;
    self->tick++;
    self->latched_ns = clock_ns();
    return uses_can(self) ? exchange(self) : HAL_OK;
}

static int16_t clamp16(int64_t value) {
    const int64_t high = value > INT16_MAX ? INT16_MAX : value;
    return (int16_t)(high < INT16_MIN ? INT16_MIN : high);
}

// Raw channels; a pair of axes counts when both were read.
static void read_raw(linux_hal_t *self, sensor_frame_t *frame) {
    int64_t value[LINUX_RAW_CHANNELS] = {0};
    bool have[LINUX_RAW_CHANNELS];
    for (int i = 0; i < LINUX_RAW_CHANNELS; i++) {
        have[i] = self->raw[i] >= 0 && sysfs_get(self->raw[i], &value[i]) == 0;
    }
    frame->battery_count = (uint16_t)(value[0] < 0 ? 0 : value[0] > UINT16_MAX ? UINT16_MAX : value[0]);
    frame->accel_x_count = clamp16(value[1]);
    frame->accel_y_count = clamp16(value[2]);
    frame->accel_z_count = clamp16(value[3]);
    frame->gyro_x_count = clamp16(value[4]);
    frame->gyro_y_count = clamp16(value[5]);
    frame->gyro_z_count = clamp16(value[6]);
    frame->present |= (have[0] ? (uint32_t)FRAME_BATTERY : 0u) | (have[1] ? (uint32_t)FRAME_ACCEL : 0u) |
                      (have[2] && have[3] ? (uint32_t)FRAME_ACCEL_YZ : 0u) | (have[4] && have[5] ? (uint32_t)FRAME_GYRO_XY : 0u) |
                      (have[6] ? (uint32_t)FRAME_GYRO : 0u);
}

static hal_result_t read_radar(linux_hal_t *self, sensor_frame_t *frame) {
    const int samples = iio_capture_read(&self->radar, frame->radar_count, RADAR_SAMPLES_PER_TICK_MAX, &frame->radar_sequence);
    if (samples < 0) {
        return lost(self, HARDWARE_radar_device, "the converter is gone");
    }
    frame->radar_samples = (uint8_t)samples;
    frame->present |= samples > 0 ? (uint32_t)FRAME_RADAR : 0u;
    return HAL_OK;
}

// A stop whose cable is not there, or that cannot be read, is not read: safety takes it for pressed.
static void read_stop(linux_hal_t *self, sensor_frame_t *frame) {
    const bool there = self->stop_present.fd < 0 || gpio_get(&self->chip, &self->stop_present) == 1;
    const int pressed = self->stop.fd >= 0 && there ? gpio_get(&self->chip, &self->stop) : -1;
    if (pressed >= 0) {
        frame->emergency_stop = pressed == 1;
        frame->present |= FRAME_EMERGENCY_STOP;
    }
}

static hal_result_t read_frame(void *context, sensor_frame_t *frame) {
    linux_hal_t *self = context;
    memset(frame, 0, sizeof *frame);
    if (self->tick == 0u) {
        return HAL_ERR_TIMEOUT;
    }
    frame->tick = self->tick - 1u;
    frame->elapsed_ticks = self->tick - self->read_tick;
    frame->time_us = (uint32_t)(uint64_t)(self->latched_ns / 1000);
    frame->present = FRAME_TIME;
    self->read_tick = self->tick;
    if (uses_can(self)) {
        can_master_take(&self->master, frame);
    }
    if (!self->nodes.wheels) {
        pwm_wheels_read(&self->wheels, frame);
    }
    hal_result_t result = HAL_OK;
    if (!self->nodes.sensors) {
        read_raw(self, frame);
        result = read_radar(self, frame);
    }
    if (!self->nodes.emergency_stop) {
        read_stop(self, frame);
    }
    self->present = frame->present;
    const bool silent = (self->expected & ~frame->present) != 0u;
    return result == HAL_OK && silent ? HAL_ERR_TIMEOUT : result;
}

static hal_result_t send_orders(linux_hal_t *self, const actuator_frame_t *actuator) {
    can_frame_t orders[WHEEL_COUNT];
    can_master_orders(actuator, orders);
    can_socket_result_t worst = CAN_SOCKET_OK;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        const can_socket_result_t sent = can_socket_send(&self->bus, &orders[i], clock_ns());
        worst = sent > worst ? sent : worst;
    }
    if (worst == CAN_SOCKET_GONE) {
        return lost(self, HARDWARE_can_interface, "the interface is down or away");
    }
    return worst == CAN_SOCKET_OK ? HAL_OK : HAL_ERR_TIMEOUT;
}

static bool set_line(linux_hal_t *self, const gpio_line_t *line, bool active) {
    return line->fd < 0 || gpio_set(&self->chip, line, active) == 0;
}

static hal_result_t write_frame(void *context, const actuator_frame_t *actuator) {
    linux_hal_t *self = context;
    const bool off = actuator->drive == DRIVE_OFF, brake = actuator->drive == DRIVE_BRAKE;
    bool lines = set_line(self, &self->led, actuator->status_led) && set_line(self, &self->brake, brake);
    if (off == self->enabled) { // what was enabled is to be off, or the other way
        lines = set_line(self, &self->enable, !off) && lines;
        self->enabled = !off;
    }
    hal_result_t result = self->nodes.wheels ? send_orders(self, actuator) : HAL_OK;
    if (!self->nodes.wheels && !pwm_wheels_write(&self->wheels, &self->chip, actuator)) {
        result = lost(self, HARDWARE_pwm_0, "a bridge's PWM takes no order");
    }
    self->lost_writes += result == HAL_ERR_TIMEOUT ? 1u : 0u;
    self->sequence = actuator->sequence;
    return lines ? result : lost(self, HARDWARE_gpio_chip, "a line cannot be set");
}

static void safe_stop(void *context) {
    linux_hal_t *self = context;
    if (!self->open) {
        return;
    }
    (void)set_line(self, &self->enable, false);
    self->enabled = false;
    actuator_frame_t off = {.drive = DRIVE_OFF};
    if (self->nodes.wheels) {
        for (uint32_t i = 0; i < 2u; i++) { // twice: one may be lost; and 50 ms later they let go without
            off.sequence = ++self->sequence;
            (void)send_orders(self, &off);
        }
    } else {
        (void)pwm_wheels_write(&self->wheels, &self->chip, &off);
    }
    (void)set_line(self, &self->brake, false);
    (void)set_line(self, &self->led, false);
}

// --- health

static hal_result_t status_of(void *context, hal_status_t *status) {
    const linux_hal_t *self = context;
    memset(status, 0, sizeof *status);
    status->overruns = self->overruns;
    status->lost_writes = self->lost_writes;
    for (uint32_t i = 0; i < HAL_DEVICES; i++) {
        const uint32_t bit = 1u << i;
        const bool expected = (self->expected & bit) != 0u, answers = (self->present & bit) != 0u;
        status->device[i] = (uint8_t)(!expected ? HAL_DEVICE_ABSENT : answers ? HAL_DEVICE_WORKS : HAL_DEVICE_SILENT);
    }
    return HAL_OK;
}

// Ten ticks without an order: who answers?
static hal_result_t self_test(void *context, hal_status_t *status) {
    linux_hal_t *self = context;
    uint32_t seen = 0;
    for (int i = 0; i < 10; i++) {
        sensor_frame_t frame;
        const hal_result_t result = wait_tick(self);
        if (result != HAL_OK) {
            return result;
        }
        if (read_frame(self, &frame) == HAL_ERR_IO) {
            return HAL_ERR_IO;
        }
        seen |= frame.present;
    }
    self->present = seen;
    return status_of(self, status);
}

static void kick_watchdog(void *context) {
    const linux_hal_t *self = context;
    if (self->watchdog >= 0) {
        watchdog_kick(self->watchdog);
    }
}

hal_t linux_hal(linux_hal_t *self) {
    return (hal_t){.context = self,
                   .wait_tick = wait_tick,
                   .read = read_frame,
                   .write = write_frame,
                   .safe_stop = safe_stop,
                   .open = open_devices,
                   .self_test = self_test,
                   .status = status_of,
                   .kick_watchdog = kick_watchdog,
                   .close = close_devices};
}
