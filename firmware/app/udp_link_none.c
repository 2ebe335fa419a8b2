// The link's calls in a program that was built without the generator of MAVLink's C: --link says so.
#include "udp_link.h"

#include <stdio.h>

bool udp_link_built(void) { return false; }

udp_link_t *udp_link_start(const udp_link_options_t *options, char message[UDP_LINK_MESSAGE])
{
    (void)options;
    (void)snprintf(message, UDP_LINK_MESSAGE, "--link: not in this build: there was no pymavlink; ./traction build brings it");
    return NULL;
}

void udp_link_command(udp_link_t *link, command_t *command)
{
    (void)link;
    (void)command;
}

void udp_link_tick(udp_link_t *link, const trace_t *trace, const command_t *command)
{
    (void)link;
    (void)trace;
    (void)command;
}

void udp_link_counts(udp_link_t *link, uint32_t counts[ULOG_LINK_COUNTS])
{
    (void)link;
    (void)counts;
}

void udp_link_finish(udp_link_t *link) { (void)link; }
