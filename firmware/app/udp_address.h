// udp_address.h - an address and a port from text: "1.2.3.4", "1.2.3.4:14555", "[::1]:14555", "::1". Numbers alone: a rover asks no name
// server.
#ifndef TRACTION_FIRMWARE_APP_UDP_ADDRESS_H
#define TRACTION_FIRMWARE_APP_UDP_ADDRESS_H

#include <netinet/in.h>
#include <sys/socket.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef union {
    struct sockaddr any;
    struct sockaddr_in four;
    struct sockaddr_in6 six;
} udp_address_t;

// Fills *address, with port `otherwise` where the text names none. Returns its length; 0: the text is no address.
socklen_t udp_address_parse(const char *text, unsigned otherwise, udp_address_t *address);

#ifdef __cplusplus
}
#endif

#endif
