// slots_parts.h - what slots.c and slots_install.c share.
#ifndef TRACTION_FIRMWARE_FLASH_SLOTS_PARTS_H
#define TRACTION_FIRMWARE_FLASH_SLOTS_PARTS_H

#include "slots.h"

// folder/name.
void slots_join(const char *folder, const char *name, char path[STORAGE_PATH]);

// SLOTS_FULL or SLOTS_BROKEN with the system's words for a negative errno.
slots_result_t slots_broken(char message[PACKAGE_MESSAGE], const char *path, int error);

// A new file of these bytes, on the disk but for its name. 0 or a negative errno.
int slots_put_file(const storage_t *storage, const char *path, uint32_t mode, const void *bytes, size_t length);

slots_result_t slots_write_state(const slots_t *slots, const slots_state_t *state, char message[PACKAGE_MESSAGE]);

// slots_state, and where the good slot is damaged but the other (no trial) is whole, that one is good.
void slots_settled(const slots_t *slots, slots_state_t *state);

// The version in this slot is not to be started any more.
void slots_drop(const slots_t *slots, int slot);

#endif
