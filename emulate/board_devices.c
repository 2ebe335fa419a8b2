#include "board_devices.h"

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <linux/if_link.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

static const uint32_t input_line[2] = {LOCKSTEP_LINE_STOP, LOCKSTEP_LINE_STOP_PRESENT};
static const uint32_t output_line[3] = {LOCKSTEP_LINE_MOTOR_ENABLE, LOCKSTEP_LINE_LED, LOCKSTEP_LINE_BRAKE};
static const char gpio_config[] = "/sys/kernel/config/gpio-sim/board";

// --- can0

typedef struct {
    struct nlmsghdr head;
    struct ifinfomsg link;
    char attributes[64];
} link_request_t;

static void add(link_request_t *request, unsigned short type, const void *data, unsigned short length) {
    const struct rtattr attribute = {.rta_len = (unsigned short)RTA_LENGTH(length), .rta_type = type};
    char *at = (char *)request + NLMSG_ALIGN(request->head.nlmsg_len);
    memcpy(at, &attribute, sizeof attribute);
    if (length > 0) {
        memcpy(at + RTA_LENGTH(0), data, length);
    }
    request->head.nlmsg_len = NLMSG_ALIGN(request->head.nlmsg_len) + RTA_SPACE(length);
}

// `ip link add can0 up type vcan`
static bool make_link(void) {
    link_request_t request;
    memset(&request, 0, sizeof request);
    request.head.nlmsg_len = NLMSG_LENGTH(sizeof request.link);
    request.head.nlmsg_type = RTM_NEWLINK;
    request.head.nlmsg_flags = NLM_F_REQUEST | NLM_F_CREATE | NLM_F_EXCL | NLM_F_ACK;
    request.link.ifi_flags = request.link.ifi_change = IFF_UP;
    add(&request, IFLA_IFNAME, "can0", 5);
    const uint32_t nest = request.head.nlmsg_len;
    add(&request, IFLA_LINKINFO, NULL, 0);
    add(&request, IFLA_INFO_KIND, "vcan", 4);
    const unsigned short nested = (unsigned short)(request.head.nlmsg_len - nest);
    memcpy((char *)&request + nest, &nested, sizeof nested);
    const int fd = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
    struct {
        struct nlmsghdr head;
        struct nlmsgerr error;
        char rest[256];
    } answer;
    const bool said = fd >= 0 && send(fd, &request, request.head.nlmsg_len, 0) > 0 && recv(fd, &answer, sizeof answer, 0) > 0 &&
                      answer.head.nlmsg_type == NLMSG_ERROR && answer.error.error == 0;
    if (fd >= 0) {
        (void)close(fd);
    }
    return said;
}

static int open_can(void) {
    struct sockaddr_can address;
    memset(&address, 0, sizeof address);
    address.can_family = AF_CAN;
    address.can_ifindex = (int)if_nametoindex("can0");
    const int fd = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
    return fd >= 0 && bind(fd, (const struct sockaddr *)&address, sizeof address) == 0 ? fd : -1;
}

// --- lines

static bool write_text(const char *path, const char *text) {
    const int fd = open(path, O_WRONLY | O_CLOEXEC);
    const bool written = fd >= 0 && write(fd, text, strlen(text)) == (ssize_t)strlen(text);
    if (fd >= 0) {
        (void)close(fd);
    }
    return written;
}

static bool read_text(const char *path, char *text, size_t room) {
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    const ssize_t got = fd >= 0 ? read(fd, text, room - 1) : -1;
    if (fd >= 0) {
        (void)close(fd);
    }
    text[got > 0 ? got : 0] = '\0';
    text[strcspn(text, "\n")] = '\0';
    return got > 0;
}

static bool make_chip(char *folder, size_t room) {
    char path[120], device[40], chip[40];
    (void)snprintf(path, sizeof path, "%s/bank0", gpio_config);
    if (mkdir(gpio_config, 0755) != 0 || mkdir(path, 0755) != 0) {
        return false;
    }
    (void)snprintf(path, sizeof path, "%s/bank0/num_lines", gpio_config);
    bool good = write_text(path, "16");
    (void)snprintf(path, sizeof path, "%s/live", gpio_config);
    good = good && write_text(path, "1");
    (void)snprintf(path, sizeof path, "%s/dev_name", gpio_config);
    good = good && read_text(path, device, sizeof device);
    (void)snprintf(path, sizeof path, "%s/bank0/chip_name", gpio_config);
    good = good && read_text(path, chip, sizeof chip) && strcmp(chip, "gpiochip0") == 0; // as the board's description has it
    return good && snprintf(folder, room, "/sys/devices/platform/%s/%s", device, chip) < (int)room;
}

static int open_line(const char *folder, uint32_t line, const char *file, int flags) {
    char path[160];
    (void)snprintf(path, sizeof path, "%s/sim_gpio%u/%s", folder, (unsigned)line, file);
    return open(path, flags | O_CLOEXEC);
}

static bool pull(const board_devices_t *devices, unsigned which, bool up) {
    const char *text = up ? "pull-up" : "pull-down";
    return pwrite(devices->pull[which], text, strlen(text), 0) == (ssize_t)strlen(text);
}

static bool make_lines(board_devices_t *devices) {
    char folder[120];
    bool good = make_chip(folder, sizeof folder);
    for (unsigned i = 0; i < 2 && good; i++) {
        devices->pull[i] = open_line(folder, input_line[i], "pull", O_RDWR);
        good = devices->pull[i] >= 0;
    }
    for (unsigned i = 0; i < 3 && good; i++) {
        devices->value[i] = open_line(folder, output_line[i], "value", O_RDONLY);
        good = devices->value[i] >= 0;
    }
    devices->pulled = 1u << LOCKSTEP_LINE_STOP_PRESENT;
    return good && pull(devices, 0, false) && pull(devices, 1, true);
}

// --- all of it

const char *board_devices_make(board_devices_t *devices) {
    memset(devices, 0, sizeof *devices);
    if (!make_link()) {
        return "can0 (vcan)";
    }
    devices->can = open_can();
    devices->adc = open("/dev/traction-adc", O_WRONLY | O_CLOEXEC);
    if (devices->can < 0 || devices->adc < 0) {
        return devices->can < 0 ? "a socket on can0" : "/dev/traction-adc";
    }
    return make_lines(devices) ? NULL : "gpio-sim";
}

uint32_t board_devices_take(const board_devices_t *devices, lockstep_frame_t frame[LOCKSTEP_FRAMES]) {
    uint32_t count = 0;
    while (count < LOCKSTEP_FRAMES && recv(devices->can, &frame[count], sizeof *frame, MSG_DONTWAIT) == (ssize_t)sizeof *frame) {
        count++;
    }
    return count;
}

uint32_t board_devices_lines(const board_devices_t *devices) {
    uint32_t lines = 0;
    for (unsigned i = 0; i < 3; i++) {
        char text[4] = "";
        if (pread(devices->value[i], text, sizeof text, 0) > 0 && text[0] == '1') {
            lines |= 1u << output_line[i];
        }
    }
    return lines;
}

// struct traction_adc_value of kernel/traction_adc.c
typedef struct {
    uint32_t channel;
    int32_t value;
    int64_t stamp_ns;
} adc_value_t;

static bool feed(board_devices_t *devices, const lockstep_world_t *world, const int32_t *sample, int64_t now_ns) {
    adc_value_t value[LOCKSTEP_RAW + LOCKSTEP_SAMPLES];
    size_t count = 0;
    for (uint32_t i = 0; i < LOCKSTEP_RAW; i++) {
        if ((world->raw_given >> i & 1u) != 0u) {
            value[count++] = (adc_value_t){.channel = i + 1u, .value = world->raw[i]};
        }
    }
    const int64_t period_ns = world->radar_rate_Hz > 0 ? 1000000000 / (int64_t)world->radar_rate_Hz : 0;
    if (world->samples > 0 && !devices->radar_seen) {
        devices->radar_begin_ns = now_ns - period_ns * (int64_t)(world->first_sample + world->samples);
        devices->radar_seen = 1;
    }
    for (uint32_t i = 0; i < world->samples; i++) {
        const int64_t stamp_ns = devices->radar_begin_ns + period_ns * (int64_t)(world->first_sample + i);
        value[count++] = (adc_value_t){.channel = 0, .value = sample[i], .stamp_ns = stamp_ns};
    }
    return count == 0 || write(devices->adc, value, count * sizeof *value) == (ssize_t)(count * sizeof *value);
}

const char *board_devices_give(board_devices_t *devices, const lockstep_world_t *world, const lockstep_frame_t *frame,
                               const int32_t *sample, int64_t now_ns) {
    for (unsigned i = 0; i < 2; i++) {
        const uint32_t bit = 1u << input_line[i];
        if (((world->lines ^ devices->pulled) & bit) != 0u && !pull(devices, i, (world->lines & bit) != 0u)) {
            return "a line's pull";
        }
    }
    devices->pulled = world->lines;
    if (!feed(devices, world, sample, now_ns)) {
        return "/dev/traction-adc";
    }
    for (uint32_t i = 0; i < world->frames; i++) {
        if (send(devices->can, &frame[i], sizeof *frame, MSG_DONTWAIT) != (ssize_t)sizeof *frame) {
            return "a frame on can0";
        }
    }
    return NULL;
}
