// supervisor_parts.h - what supervisor.c (who may do what) and supervisor_tell.c (what is told) share.
#ifndef TRACTION_FIRMWARE_LINK_SUPERVISOR_PARTS_H
#define TRACTION_FIRMWARE_LINK_SUPERVISOR_PARTS_H

#include "supervisor.h"

// Of the link itself, settable with the key; in this order before the rover's own.
enum { SETTING_STATUS_HZ = 0, SETTING_BULK_KB_S, SETTING_SPEED_MAX, SETTING_YAW_MAX };

// A packet made by one of the generator's ..._encode_status functions, sent. Returns its bytes.
size_t supervisor_send(supervisor_t *link, int peer, const mavlink_message_t *packet);

void supervisor_tell_heartbeat(supervisor_t *link, int peer);
void supervisor_tell_version(supervisor_t *link, int peer);
void supervisor_tell_link(supervisor_t *link, int peer);
size_t supervisor_tell_parameter(supervisor_t *link, int peer, uint32_t index);
void supervisor_tell_text(supervisor_t *link, int severity, const char *text);

// The link's own parameter: within its limits? Set.
bool supervisor_set(supervisor_t *link, uint32_t index, float value);

#endif
