#include "slots_parts.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { KEY_TEXT = 2 * LMS_PUBLIC, BLOCK = 4096, SPARE = 65536 };

static void step(const slots_t *slots, const char *message)
{
    if (slots->step != NULL) {
        slots->step(slots->context, message);
    }
}

static slots_result_t refuse(char message[PACKAGE_MESSAGE], const char *what, const char *is, const char *here, const char *mend)
{
    (void)snprintf(message, PACKAGE_MESSAGE, "the package is for the %s %s, this is %s; %s", what, is, here, mend);
    return SLOTS_REFUSED;
}

// Whether this package may come onto this board now. Reads only.
static slots_result_t judge(const slots_t *slots, const slots_state_t *state, const package_t *package, const char *rover,
                            char message[PACKAGE_MESSAGE])
{
    if (strcmp(package->architecture, slots->architecture) != 0) {
        return refuse(message, "architecture", package->architecture, slots->architecture, "build it for this one (docs/hardware.md)");
    }
    if (strcmp(package->rover, rover) != 0) {
        return refuse(message, "rover", package->rover, rover, "give --rover with this rover's description");
    }
    if (state->trial >= 0) {
        (void)snprintf(message, PACKAGE_MESSAGE,
                       "another version is on trial; wait until it is confirmed or returned, or give it up with "
                       "traction-slot return");
        return SLOTS_BUSY;
    }
    if (state->good >= 0 && memcmp(state->key, package->key, LMS_ID) == 0) {
        char path[STORAGE_PATH], text[PACKAGE_TEXT], folder[STORAGE_PATH];
        slots_path(slots, state->good, folder);
        slots_join(folder, "manifest", path);
        const long got = slots->storage.read(slots->storage.context, path, 0, text, sizeof text);
        if (got == (long)package->manifest_bytes && memcmp(text, package->manifest, package->manifest_bytes) == 0) {
            (void)snprintf(message, PACKAGE_MESSAGE, "number %" PRIu32 " is the version that runs already", package->number);
            return SLOTS_SAME;
        }
        if (package->number <= state->number) {
            (void)snprintf(message, PACKAGE_MESSAGE,
                           "the package's number %" PRIu32 " is not above %" PRIu32
                           ", the good version's: it is older; to go back, pack and "
                           "sign the older version anew",
                           package->number, state->number);
            return SLOTS_REFUSED;
        }
    }
    return SLOTS_DONE;
}

static int add_size(void *visitor, const char *name, uint64_t size)
{
    (void)name;
    *(uint64_t *)visitor += (size + BLOCK - 1u) / BLOCK * BLOCK;
    return 0;
}

static slots_result_t find_room(const slots_t *slots, const char *folder, const package_t *package, char message[PACKAGE_MESSAGE])
{
    uint64_t needed = SPARE, freed = 0, free_bytes = 0;
    for (uint32_t i = 0; i < package->count; i++) {
        (void)add_size(&needed, "", package->file[i].size);
    }
    (void)slots->storage.list(slots->storage.context, folder, add_size, &freed); // the old contents go first
    const int result = slots->storage.room(slots->storage.context, slots->folder, &free_bytes);
    if (result < 0) {
        return slots_broken(message, slots->folder, result);
    }
    if (free_bytes + freed < needed) {
        (void)snprintf(message, PACKAGE_MESSAGE,
                       "%.160s: %" PRIu64 " kB are needed, %" PRIu64 " kB are free; remove logs, or give "
                       "--log-budget less",
                       slots->folder, needed / 1024u, (free_bytes + freed) / 1024u);
        return SLOTS_FULL;
    }
    return SLOTS_DONE;
}

typedef struct {
    const storage_t *storage;
    const char *folder;
    int removed;
} clear_t;

static int remove_one(void *visitor, const char *name, uint64_t size)
{
    clear_t *clear = visitor;
    char path[STORAGE_PATH];
    (void)size;
    slots_join(clear->folder, name, path);
    const int result = clear->storage->unlink(clear->storage->context, path);
    clear->removed += result >= 0;
    return result < 0 ? result : 0;
}

static int clear_slot(const slots_t *slots, const char *folder)
{
    clear_t clear = {&slots->storage, folder, 1};
    int result = slots->storage.make_folder(slots->storage.context, folder);
    while (result >= 0 && clear.removed > 0) { // a listing may pass over names while others are removed
        clear.removed = 0;
        result = slots->storage.list(slots->storage.context, folder, remove_one, &clear);
    }
    return result;
}

static int fill_slot(const slots_t *slots, const char *folder, const package_t *package)
{
    char path[STORAGE_PATH];
    int result = 0;
    for (uint32_t i = 0; result >= 0 && i < package->count; i++) {
        const package_file_t *file = &package->file[i];
        slots_join(folder, file->name, path);
        result = slots_put_file(&slots->storage, path, file->mode, file->bytes, file->size);
    }
    slots_join(folder, "manifest.sig", path);
    result = result >= 0 ? slots_put_file(&slots->storage, path, 0644, package->signature, package->signature_bytes) : result;
    slots_join(folder, "manifest", path); // last: without it the slot is empty
    result = result >= 0 ? slots_put_file(&slots->storage, path, 0644, package->manifest, package->manifest_bytes) : result;
    result = result >= 0 ? slots->storage.sync_folder(slots->storage.context, folder) : result;
    return result >= 0 ? slots->storage.sync_folder(slots->storage.context, slots->folder) : result;
}

static slots_result_t write_slot(const slots_t *slots, int slot, const package_t *package, char message[PACKAGE_MESSAGE])
{
    char folder[STORAGE_PATH], why[SLOTS_NOTE] = "";
    package_t found;
    slots_path(slots, slot, folder);
    int result = clear_slot(slots, folder);
    result = result >= 0 ? fill_slot(slots, folder, package) : result;
    if (result < 0) {
        (void)clear_slot(slots, folder); // gives the room back
        return slots_broken(message, folder, result);
    }
    if (!slots_whole(slots, slot, &found)) {
        (void)snprintf(message, PACKAGE_MESSAGE, "%.200s: what was written does not read back the same; the disk is failing", folder);
        return SLOTS_BROKEN;
    }
    step(slots, "written and read back");
    if (slots->self_test(slots->context, folder, why) != 0) {
        (void)snprintf(message, PACKAGE_MESSAGE, "the new version fails its self-test on this board: %.120s", why);
        slots_drop(slots, slot);
        return SLOTS_UNFIT;
    }
    step(slots, "self-test passed");
    return SLOTS_DONE;
}

slots_result_t slots_install(const slots_t *slots, const uint8_t *bytes, size_t length, bool check_only, char message[PACKAGE_MESSAGE])
{
    uint8_t key[LMS_PUBLIC];
    char rover[PACKAGE_WORD], said[2 * PACKAGE_WORD + 60], folder[STORAGE_PATH];
    package_t package;
    slots_state_t state;
    message[0] = '\0';
    if (!slots_board(slots, key, rover, message)) {
        return SLOTS_BROKEN;
    }
    if (package_read(bytes, length, key, &package, message) != PACKAGE_GOOD) {
        return SLOTS_REFUSED;
    }
    slots_settled(slots, &state);
    const int slot = state.good == SLOT_A ? SLOT_B : SLOT_A;
    slots_path(slots, slot, folder);
    slots_result_t result = judge(slots, &state, &package, rover, message);
    result = result == SLOTS_DONE ? find_room(slots, folder, &package, message) : result;
    if (result != SLOTS_DONE) {
        return result;
    }
    (void)snprintf(said, sizeof said, "signature and checksums hold: number %" PRIu32 ", version %s, commit %s", package.number,
                   package.version, package.commit);
    step(slots, said);
    if (check_only) {
        return SLOTS_DONE;
    }
    result = write_slot(slots, slot, &package, message);
    if (result != SLOTS_DONE) {
        return result;
    }
    state.trial = slot;
    state.tries = 0;
    (void)snprintf(state.note, SLOTS_NOTE, "installed %" PRIu32, package.number);
    result = slots_write_state(slots, &state, message);
    if (result == SLOTS_DONE) {
        step(slots, "on trial from the next start on");
    }
    return result;
}

slots_result_t slots_init(const slots_t *slots, const uint8_t key[LMS_PUBLIC], const char *rover, char message[PACKAGE_MESSAGE])
{
    char text[KEY_TEXT + 2], line[PACKAGE_WORD + 1];
    const size_t length = strlen(rover);
    message[0] = '\0';
    if (length == 0 || length > PACKAGE_WORD - 2 || strchr(rover, '\n') != NULL) {
        (void)snprintf(message, PACKAGE_MESSAGE, "--rover: 1 to %d letters on one line, the name in its description", PACKAGE_WORD - 2);
        return SLOTS_REFUSED;
    }
    package_hex(key, LMS_PUBLIC, text);
    text[KEY_TEXT] = '\n';
    const int used = snprintf(line, sizeof line, "%s\n", rover);
    int result = slots->storage.make_folder(slots->storage.context, slots->folder);
    result = result >= 0 ? slots_write_file(&slots->storage, slots->folder, "rover", line, (size_t)used) : result;
    result = result >= 0 ? slots_write_file(&slots->storage, slots->folder, "key.pub", text, KEY_TEXT + 1) : result;
    return result < 0 ? slots_broken(message, slots->folder, result) : SLOTS_DONE;
}
