#define _POSIX_C_SOURCE 200809L // inet_pton
#include "udp_address.h"

#include <arpa/inet.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

socklen_t udp_address_parse(const char *text, unsigned otherwise, udp_address_t *address)
{
    char host[64] = "";
    const bool bracketed = text[0] == '[';
    const char *end = bracketed ? strchr(text, ']') : strchr(text, ':');
    const char *port = end;
    if (!bracketed && end != NULL && strchr(end + 1, ':') != NULL) { // several colons: the whole is a host of version 6
        end = port = NULL;
    }
    const size_t length = end == NULL ? strlen(text) : (size_t)(end - text) - (bracketed ? 1u : 0u);
    if ((bracketed && end == NULL) || length >= sizeof host) {
        return 0;
    }
    memcpy(host, text + (bracketed ? 1 : 0), length); // host is all 0, and longer
    host[length] = '\0';
    port = bracketed && port != NULL ? port + 1 : port;
    unsigned long number = otherwise;
    if (port != NULL && *port != '\0') {
        char *rest = NULL;
        number = port[0] == ':' && port[1] >= '0' && port[1] <= '9' ? strtoul(port + 1, &rest, 10) : 65536u;
        if (number > 65535u || *rest != '\0') {
            return 0;
        }
    }
    memset(address, 0, sizeof *address);
    if (inet_pton(AF_INET, host, &address->four.sin_addr) == 1) {
        address->four.sin_family = AF_INET;
        address->four.sin_port = htons((uint16_t)number);
        return sizeof address->four;
    }
    if (inet_pton(AF_INET6, host, &address->six.sin6_addr) == 1) {
        address->six.sin6_family = AF_INET6;
        address->six.sin6_port = htons((uint16_t)number);
        return sizeof address->six;
    }
    return 0;
}
