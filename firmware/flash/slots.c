#include "slots.h"
#include "slots_parts.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { STATE_TEXT = 512, KEY_TEXT = 2 * LMS_PUBLIC, CHUNK = 4096 };

static const char slot_letters[] = "ab";

void slots_path(const slots_t *slots, int slot, char path[STORAGE_PATH])
{
    (void)snprintf(path, STORAGE_PATH, "%.300s/%c", slots->folder, slot_letters[slot]);
}

void slots_join(const char *folder, const char *name, char path[STORAGE_PATH])
{
    (void)snprintf(path, STORAGE_PATH, "%.330s/%.60s", folder, name);
}

slots_result_t slots_broken(char message[PACKAGE_MESSAGE], const char *path, int error)
{
    (void)snprintf(message, PACKAGE_MESSAGE, "%.200s: cannot be written: %.60s", path, strerror(-error));
    return error == -ENOSPC || error == -EDQUOT ? SLOTS_FULL : SLOTS_BROKEN;
}

// --- files

// A new file of these bytes, on the disk but for its name.
int slots_put_file(const storage_t *storage, const char *path, uint32_t mode, const void *bytes, size_t length)
{
    const int file = storage->create(storage->context, path, mode);
    if (file < 0) {
        return file;
    }
    int result = 0;
    for (size_t done = 0; result >= 0 && done < length; done += CHUNK) { // in parts: a cut falls between them too
        const size_t part = length - done < CHUNK ? length - done : CHUNK;
        result = storage->write(storage->context, file, (const uint8_t *)bytes + done, part);
    }
    result = result >= 0 ? storage->sync(storage->context, file) : result;
    const int closed = storage->close(storage->context, file);
    return result >= 0 && closed < 0 ? closed : result;
}

int slots_write_file(const storage_t *storage, const char *folder, const char *name, const void *bytes, size_t length)
{
    char path[STORAGE_PATH], temporary[STORAGE_PATH];
    slots_join(folder, name, path);
    (void)snprintf(temporary, sizeof temporary, "%.390s.new", path);
    int result = slots_put_file(storage, temporary, 0644, bytes, length);
    result = result >= 0 ? storage->rename(storage->context, temporary, path) : result;
    if (result < 0) {
        (void)storage->unlink(storage->context, temporary);
        return result;
    }
    return storage->sync_folder(storage->context, folder);
}

bool slots_board(const slots_t *slots, uint8_t key[LMS_PUBLIC], char rover[PACKAGE_WORD], char message[PACKAGE_MESSAGE])
{
    char path[STORAGE_PATH], text[KEY_TEXT + 2];
    const storage_t *storage = &slots->storage;
    slots_join(slots->folder, "key.pub", path);
    long got = storage->read(storage->context, path, 0, text, sizeof text);
    if (!(got == KEY_TEXT || (got == KEY_TEXT + 1 && text[KEY_TEXT] == '\n')) || !package_unhex(text, LMS_PUBLIC, key)) {
        (void)snprintf(message, PACKAGE_MESSAGE, "%.200s: %s; traction-slot init writes it (docs/flash.md)", path,
                       got < 0 ? strerror((int)-got) : "no public key");
        return false;
    }
    slots_join(slots->folder, "rover", path);
    got = storage->read(storage->context, path, 0, rover, PACKAGE_WORD - 1);
    if (got < 2 || rover[got - 1] != '\n') {
        (void)snprintf(message, PACKAGE_MESSAGE, "%.200s: %s; traction-slot init writes it (docs/flash.md)", path,
                       got < 0 ? strerror((int)-got) : "no rover's name");
        return false;
    }
    rover[got - 1] = '\0';
    return true;
}

// --- the state

static size_t print_state(const slots_state_t *state, char text[STATE_TEXT])
{
    char hex[2 * SHA256_BYTES + 1], good[2] = "-", trial[2] = "-";
    uint8_t sha[SHA256_BYTES];
    good[0] = state->good >= 0 ? slot_letters[state->good] : '-';
    trial[0] = state->trial >= 0 ? slot_letters[state->trial] : '-';
    package_hex(state->key, LMS_ID, hex);
    const int used = snprintf(text, STATE_TEXT, "traction-slots 1\ngood %s %" PRIu32 " %s\ntrial %s %" PRIu32 "\nnote %s\n", good,
                              state->number, hex, trial, state->tries, state->note);
    sha256(text, (size_t)used, sha);
    package_hex(sha, SHA256_BYTES, hex);
    return (size_t)used + (size_t)snprintf(text + used, STATE_TEXT - (size_t)used, "check %s\n", hex);
}

static int slot_of(char letter) { return letter == 'a' ? SLOT_A : letter == 'b' ? SLOT_B : SLOT_NONE; }

static bool read_state(const slots_t *slots, slots_state_t *state)
{
    char path[STORAGE_PATH], text[STATE_TEXT], again[STATE_TEXT], good = 0, trial = 0, hex[2 * LMS_ID + 1] = "";
    slots_join(slots->folder, "state", path);
    const long got = slots->storage.read(slots->storage.context, path, 0, text, sizeof text - 1);
    if (got <= 0) {
        return false;
    }
    text[got] = '\0';
    memset(state, 0, sizeof *state);
    // NOLINTNEXTLINE(cert-err34-c): printed again below, and compared
    if (sscanf(text, "traction-slots 1\ngood %c %" SCNu32 " %32[0-9a-f]\ntrial %c %" SCNu32 "\nnote %159[^\n]", &good, &state->number, hex,
               &trial, &state->tries, state->note) != 6 ||
        strlen(hex) != sizeof hex - 1 || !package_unhex(hex, LMS_ID, state->key)) {
        return false;
    }
    state->good = slot_of(good);
    state->trial = slot_of(trial);
    return print_state(state, again) == (size_t)got && memcmp(again, text, (size_t)got) == 0;
}

slots_result_t slots_write_state(const slots_t *slots, const slots_state_t *state, char message[PACKAGE_MESSAGE])
{
    char text[STATE_TEXT], path[STORAGE_PATH];
    const int result = slots_write_file(&slots->storage, slots->folder, "state", text, print_state(state, text));
    slots_join(slots->folder, "state", path);
    return result < 0 ? slots_broken(message, path, result) : SLOTS_DONE;
}

static bool hash_file(const slots_t *slots, const char *path, uint32_t size, uint8_t sha[SHA256_BYTES])
{
    uint8_t chunk[CHUNK];
    sha256_t hash;
    sha256_begin(&hash);
    uint32_t done = 0;
    for (long got = 1; got > 0; done += (uint32_t)got) {
        got = slots->storage.read(slots->storage.context, path, (long)done, chunk, sizeof chunk);
        if (got < 0 || (uint32_t)got > size - done) {
            return false;
        }
        sha256_add(&hash, chunk, (size_t)got);
    }
    sha256_end(&hash, sha);
    return done == size;
}

bool slots_whole(const slots_t *slots, int slot, package_t *package)
{
    char folder[STORAGE_PATH], path[STORAGE_PATH], text[PACKAGE_TEXT];
    uint8_t sha[SHA256_BYTES];
    slots_path(slots, slot, folder);
    slots_join(folder, "manifest", path);
    const long got = slots->storage.read(slots->storage.context, path, 0, text, sizeof text);
    bool whole = got > 0 && package_parse_manifest(text, (size_t)got, package);
    for (uint32_t i = 0; whole && i < package->count; i++) {
        slots_join(folder, package->file[i].name, path);
        whole = hash_file(slots, path, package->file[i].size, sha) && memcmp(sha, package->file[i].sha, SHA256_BYTES) == 0;
    }
    return whole;
}

void slots_state(const slots_t *slots, slots_state_t *state)
{
    package_t package[2];
    if (read_state(slots, state)) {
        return;
    }
    const slots_state_t nothing = {.good = SLOT_NONE, .trial = SLOT_NONE, .note = "no version yet"};
    *state = nothing;
    const bool whole[2] = {slots_whole(slots, SLOT_A, &package[0]), slots_whole(slots, SLOT_B, &package[1])};
    if (whole[0] || whole[1]) {
        state->good = !whole[1] || (whole[0] && package[0].number <= package[1].number) ? SLOT_A : SLOT_B;
        state->number = package[state->good].number;
        memcpy(state->key, package[state->good].key, LMS_ID);
        (void)snprintf(state->note, SLOTS_NOTE, "the state was lost; taken from the slots");
    }
}

void slots_settled(const slots_t *slots, slots_state_t *state)
{
    package_t package;
    slots_state(slots, state);
    const int other = state->good == SLOT_A ? SLOT_B : SLOT_A;
    if (state->good >= 0 && state->trial != other && !slots_whole(slots, state->good, &package) && slots_whole(slots, other, &package)) {
        state->good = other;
        state->number = package.number;
        memcpy(state->key, package.key, LMS_ID);
    }
}

void slots_drop(const slots_t *slots, int slot)
{
    char folder[STORAGE_PATH], path[STORAGE_PATH];
    slots_path(slots, slot, folder);
    slots_join(folder, "manifest", path); // without it there is no version
    (void)slots->storage.unlink(slots->storage.context, path);
    (void)slots->storage.sync_folder(slots->storage.context, folder);
}

// --- start, confirm, return

static void end_trial(slots_state_t *state, const package_t *package, const char *why)
{
    const int used = snprintf(state->note, SLOTS_NOTE, "returned %" PRIu32 ": %.120s", package->number, why);
    for (int i = 0; i < used && i < SLOTS_NOTE - 1; i++) {
        state->note[i] = state->note[i] < ' ' ? ' ' : state->note[i]; // one line
    }
    state->trial = SLOT_NONE;
    state->tries = 0;
}

slots_result_t slots_start(const slots_t *slots, int *slot, bool *on_trial, char message[PACKAGE_MESSAGE])
{
    slots_state_t state, before;
    package_t package;
    *slot = SLOT_NONE;
    *on_trial = false;
    message[0] = '\0';
    slots_state(slots, &state);
    if (state.trial >= 0) {
        const bool whole = slots_whole(slots, state.trial, &package);
        if (!whole || state.tries >= SLOTS_TRIES) {
            (void)slots_return(slots, whole ? "started several times, never healthy" : "its files are damaged", message);
        } else {
            state.tries++;
            if (slots_write_state(slots, &state, message) == SLOTS_DONE) { // what cannot be counted is not tried
                *slot = state.trial;
                *on_trial = true;
                return SLOTS_DONE;
            }
        }
    }
    slots_state(slots, &before);
    slots_settled(slots, &state);
    if (state.good < 0 || !slots_whole(slots, state.good, &package)) {
        (void)snprintf(message, PACKAGE_MESSAGE, "%.160s: neither slot holds a whole version; install one with traction flash --host",
                       slots->folder);
        return SLOTS_EMPTY;
    }
    *slot = state.good;
    if (state.good != before.good) {
        (void)snprintf(message, PACKAGE_MESSAGE, "slot %c is damaged; slot %c runs instead", slot_letters[before.good],
                       slot_letters[state.good]);
    }
    return SLOTS_DONE;
}

slots_result_t slots_confirm(const slots_t *slots, char message[PACKAGE_MESSAGE])
{
    slots_state_t state;
    package_t package;
    message[0] = '\0';
    slots_state(slots, &state);
    if (state.trial < 0) {
        return SLOTS_DONE;
    }
    if (!slots_whole(slots, state.trial, &package)) {
        return slots_return(slots, "its files are damaged", message);
    }
    state.good = state.trial;
    state.number = package.number;
    memcpy(state.key, package.key, LMS_ID);
    state.trial = SLOT_NONE;
    state.tries = 0;
    (void)snprintf(state.note, SLOTS_NOTE, "confirmed %" PRIu32, package.number);
    return slots_write_state(slots, &state, message);
}

slots_result_t slots_return(const slots_t *slots, const char *why, char message[PACKAGE_MESSAGE])
{
    slots_state_t state;
    package_t package;
    message[0] = '\0';
    slots_state(slots, &state);
    if (state.trial < 0) {
        return SLOTS_DONE;
    }
    const int slot = state.trial;
    (void)slots_whole(slots, slot, &package);
    end_trial(&state, &package, why);
    const slots_result_t result = slots_write_state(slots, &state, message);
    slots_drop(slots, slot);
    return result;
}
