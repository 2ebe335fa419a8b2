// can_socket.h - CAN frames through a PF_CAN raw socket (or, in tests, any datagram socket that carries struct can_frame).
//
// The socket hears the identifiers of docs/can.md alone, the bus's error frames, and not itself; it never blocks. Bus-off is told by an
// error frame; until the controller says that it was restarted, sending fails. A restart is asked for over netlink at once and then every
// 100 ms (needs CAP_NET_ADMIN; an interface with `restart-ms` restarts itself, and then asking is refused and does no harm).
#ifndef TRACTION_HAL_LINUX_CAN_SOCKET_H
#define TRACTION_HAL_LINUX_CAN_SOCKET_H

#include "hal/can/can_frame.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum { CAN_SOCKET_OK = 0, CAN_SOCKET_NOTHING, CAN_SOCKET_FULL, CAN_SOCKET_OFF, CAN_SOCKET_GONE } can_socket_result_t;

typedef struct {
    int fd;             // -1: closed
    unsigned interface; // its index; 0: not a CAN interface (tests)
    bool bus_off;       // the controller has left the bus
    bool passive;       // it counts so many errors that it may leave
    int64_t restart_due_ns;
    uint32_t bus_offs, restarts, overflows, errors; // error frames of each kind, since open; errors: of any other
} can_socket_t;

// Opens and binds; -errno, or 0.
int can_socket_open(can_socket_t *bus, const char *interface);

// The same at the nodes' end of the bus: it hears SYNC and orders (traction simulate --can).
int can_socket_open_nodes(can_socket_t *bus, const char *interface);

// The same socket from a descriptor of the caller's, which is then owned.
void can_socket_adopt(can_socket_t *bus, int fd);

// NOTHING: no frame waits. GONE: the interface is away or down. Error frames are taken in and not given out.
can_socket_result_t can_socket_receive(can_socket_t *bus, can_frame_t *frame);

// FULL: the queue has no room, the frame is lost. OFF: bus-off; a restart is asked for when it is due at now_ns.
can_socket_result_t can_socket_send(can_socket_t *bus, const can_frame_t *frame, int64_t now_ns);

void can_socket_close(can_socket_t *bus);

// The netlink message that restarts interface `index`: returns its length.
size_t can_restart_message(unsigned index, unsigned char message[128]);

#ifdef __cplusplus
}
#endif

#endif
