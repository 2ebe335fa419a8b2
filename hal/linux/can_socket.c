#include "can_socket.h"

#include <errno.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/netlink.h>
#include <linux/can/raw.h>
#include <linux/if_link.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

static const int64_t restart_every_ns = 100000000;

void can_socket_adopt(can_socket_t *bus, int fd) { *bus = (can_socket_t){.fd = fd}; }

// Standard frames with data. The computer has no use for SYNC and orders, nor the nodes for anything else.
enum { FILTERS = 3 };

// The identifiers from id on, as many as wheels, or id alone.
static struct can_filter filter_of(canid_t id, bool wheels) {
    const canid_t kind = CAN_EFF_FLAG | CAN_RTR_FLAG, spare = wheels ? 0x3u : 0x0u;
    return (struct can_filter){.can_id = id, .can_mask = (CAN_SFF_MASK & ~spare) | kind};
}

static int set_up(int fd, const struct can_filter filter[FILTERS]) {
    const can_err_mask_t errors = CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_CRTL | CAN_ERR_ACK | CAN_ERR_PROT | CAN_ERR_TX_TIMEOUT;
    const int own = 0;
    return setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, filter, FILTERS * sizeof *filter) != 0 ||
                   setsockopt(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors) != 0 ||
                   setsockopt(fd, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &own, sizeof own) != 0
               ? -errno
               : 0;
}

static int open_with(can_socket_t *bus, const char *interface, const struct can_filter filter[FILTERS]) {
    const unsigned index = if_nametoindex(interface);
    const int fd = index != 0 ? socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW) : -1;
    *bus = (can_socket_t){.fd = -1};
    if (fd < 0) {
        return -errno;
    }
    struct sockaddr_can address;
    memset(&address, 0, sizeof address);
    address.can_family = AF_CAN;
    address.can_ifindex = (int)index;
    int result = set_up(fd, filter);
    if (result == 0 && bind(fd, (const struct sockaddr *)&address, sizeof address) != 0) {
        result = -errno;
    }
    if (result != 0) {
        (void)close(fd);
        return result;
    }
    can_socket_adopt(bus, fd);
    bus->interface = index;
    return 0;
}

int can_socket_open(can_socket_t *bus, const char *interface) {
    const struct can_filter answers[FILTERS] = {filter_of(CAN_WHEEL, true), filter_of(CAN_ACCEL, true), filter_of(CAN_DIAGNOSIS, true)};
    return open_with(bus, interface, answers);
}

int can_socket_open_nodes(can_socket_t *bus, const char *interface) {
    const struct can_filter orders[FILTERS] = {filter_of(CAN_SYNC, false), filter_of(CAN_ORDER, true), filter_of(CAN_ORDER, true)};
    return open_with(bus, interface, orders);
}

static void take_error(can_socket_t *bus, const struct can_frame *frame) {
    const uint32_t kind = frame->can_id & CAN_ERR_MASK;
    if ((kind & CAN_ERR_BUSOFF) != 0u) {
        bus->bus_offs++;
        bus->bus_off = true;
        bus->restart_due_ns = 0;
    }
    if ((kind & CAN_ERR_RESTARTED) != 0u) {
        bus->restarts++;
        bus->bus_off = false;
    }
    if ((kind & CAN_ERR_CRTL) != 0u) {
        const uint32_t state = frame->data[1];
        bus->overflows += (state & (CAN_ERR_CRTL_RX_OVERFLOW | CAN_ERR_CRTL_TX_OVERFLOW)) != 0u ? 1u : 0u;
        bus->passive = (state & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0u;
    }
    bus->errors += (kind & (CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_CRTL)) == 0u ? 1u : 0u;
}

can_socket_result_t can_socket_receive(can_socket_t *bus, can_frame_t *frame) {
    struct can_frame raw;
    for (;;) {
        const ssize_t got = recv(bus->fd, &raw, sizeof raw, MSG_DONTWAIT);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got < 0) {
            return errno == EAGAIN || errno == EWOULDBLOCK ? CAN_SOCKET_NOTHING : CAN_SOCKET_GONE;
        }
        if (got == 0) {
            return CAN_SOCKET_GONE;
        }
        if ((size_t)got < sizeof raw) {
            continue; // not a frame of this kind
        }
        if ((raw.can_id & CAN_ERR_FLAG) != 0u) {
            take_error(bus, &raw);
            continue;
        }
        if ((raw.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG)) != 0u || raw.can_dlc > sizeof frame->data) {
            continue;
        }
        *frame = (can_frame_t){.id = raw.can_id & CAN_SFF_MASK, .length = raw.can_dlc};
        memcpy(frame->data, raw.data, sizeof frame->data);
        return CAN_SOCKET_OK;
    }
}

static void ask_restart(can_socket_t *bus, int64_t now_ns) {
    if (now_ns < bus->restart_due_ns) {
        return;
    }
    bus->restart_due_ns = now_ns + restart_every_ns;
    const int fd = bus->interface != 0 ? socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE) : -1;
    if (fd >= 0) {
        unsigned char message[128];
        const size_t length = can_restart_message(bus->interface, message);
        (void)send(fd, message, length, MSG_DONTWAIT); // where it is refused the interface's own restart-ms remains
        (void)close(fd);
    }
}

can_socket_result_t can_socket_send(can_socket_t *bus, const can_frame_t *frame, int64_t now_ns) {
    if (bus->bus_off) {
        ask_restart(bus, now_ns);
        return CAN_SOCKET_OFF;
    }
    struct can_frame raw;
    memset(&raw, 0, sizeof raw);
    raw.can_id = frame->id & CAN_SFF_MASK;
    raw.can_dlc = frame->length <= sizeof frame->data ? frame->length : (uint8_t)sizeof frame->data;
    memcpy(raw.data, frame->data, raw.can_dlc);
    for (;;) {
        if (send(bus->fd, &raw, sizeof raw, MSG_DONTWAIT | MSG_NOSIGNAL) == (ssize_t)sizeof raw) {
            return CAN_SOCKET_OK;
        }
        if (errno != EINTR) {
            break;
        }
    }
    return errno == ENOBUFS || errno == EAGAIN || errno == EWOULDBLOCK ? CAN_SOCKET_FULL : CAN_SOCKET_GONE;
}

void can_socket_close(can_socket_t *bus) {
    if (bus->fd >= 0) {
        (void)close(bus->fd);
    }
    bus->fd = -1;
}

// One attribute of netlink at *length; returns where its payload is.
static unsigned char *attribute(unsigned char *message, size_t *length, unsigned short type, const void *payload, size_t size) {
    struct rtattr head = {.rta_len = (unsigned short)RTA_LENGTH(size), .rta_type = type};
    unsigned char *at = message + *length;
    memcpy(at, &head, sizeof head);
    if (size > 0) {
        memcpy(at + RTA_LENGTH(0), payload, size);
    }
    *length += RTA_SPACE(size);
    return at;
}

static void close_nest(const unsigned char *message, unsigned char *nest, size_t length) {
    const unsigned short size = (unsigned short)(message + length - nest);
    memcpy(nest, &size, sizeof size);
}

size_t can_restart_message(unsigned index, unsigned char message[128]) {
    memset(message, 0, 128);
    size_t length = NLMSG_SPACE(sizeof(struct ifinfomsg));
    unsigned char *info = attribute(message, &length, IFLA_LINKINFO, NULL, 0);
    (void)attribute(message, &length, IFLA_INFO_KIND, "can", 3);
    unsigned char *data = attribute(message, &length, IFLA_INFO_DATA, NULL, 0);
    const uint32_t yes = 1;
    (void)attribute(message, &length, IFLA_CAN_RESTART, &yes, sizeof yes);
    close_nest(message, data, length);
    close_nest(message, info, length);
    const struct nlmsghdr head = {.nlmsg_len = (uint32_t)length, .nlmsg_type = RTM_NEWLINK, .nlmsg_flags = NLM_F_REQUEST};
    struct ifinfomsg link;
    memset(&link, 0, sizeof link);
    link.ifi_family = AF_UNSPEC;
    link.ifi_index = (int)index;
    memcpy(message, &head, sizeof head);
    memcpy(message + NLMSG_HDRLEN, &link, sizeof link);
    return length;
}
