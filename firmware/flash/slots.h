// slots.h - two slots of software on the board, which of them runs, and the way back: install, start, confirm, return.
//
//   FOLDER/key.pub   the signer's public key, 112 hex digits            FOLDER/rover   the rover's name, one line
//   FOLDER/state     which slot is good and which on trial              FOLDER/a, b    a version each: its files, manifest, manifest.sig
//
// A package goes into the slot that is not good; nothing refers to it until one rename of `state` puts it on trial. A start counts itself
// in `state` before it runs the trial. Whoever sees it healthy confirms: it is the good one from then on. Otherwise (unhealthy, ended,
// SLOTS_TRIES starts without a word) the good one runs again. So at every instant `state` names a slot whose files were brought to the
// disk before it did, and a power cut leaves the old version or the new one, whole.
//
// A rename that is atomic, an fsync that brings to the disk: that is all that is asked of the file system (ext4, UBIFS, JFFS2; not FAT).
#ifndef TRACTION_FIRMWARE_FLASH_SLOTS_H
#define TRACTION_FIRMWARE_FLASH_SLOTS_H

#include "package.h"
#include "storage.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { SLOT_NONE = -1, SLOT_A = 0, SLOT_B = 1, SLOTS_TRIES = 3, SLOTS_NOTE = 160 };

typedef struct {
    int good, trial;       // SLOT_...
    uint32_t tries;        // starts of the trial so far
    uint32_t number;       // the good package's: an older one is refused
    uint8_t key[LMS_ID];   // that signed it; numbers of another key say nothing
    char note[SLOTS_NOTE]; // the last thing that happened, one line: "confirmed 17", "returned 18: ..."
} slots_state_t;

typedef enum {
    SLOTS_DONE,
    SLOTS_SAME,    // this package is the good one already; nothing was written
    SLOTS_REFUSED, // the package: corrupt, unsigned, foreign, other rover or architecture, older; nothing was written
    SLOTS_BUSY,    // another version is on trial
    SLOTS_FULL,    // no room
    SLOTS_BROKEN,  // the file system said no; message has its words
    SLOTS_UNFIT,   // the new version failed its self-test on this board
    SLOTS_EMPTY,   // no slot holds a whole version
} slots_result_t;

typedef struct {
    storage_t storage;
    const char *folder;
    const char *architecture; // this board's, Debian's word
    // Runs the self-test of the version in this folder: 0, or not, with a reason in `why`. Moves nothing.
    int (*self_test)(void *context, const char *folder, char why[SLOTS_NOTE]);
    void *context;                                    // self_test's and step's
    void (*step)(void *context, const char *message); // each step as it is done; may be null
} slots_t;

// The state; a missing or damaged file is rebuilt from what the slots hold: the whole version of the lower number, which was good once
// (a trial has a higher number than the good one), is good. Reads only.
void slots_state(const slots_t *slots, slots_state_t *state);

// Puts the package into the free slot, on trial from the next start on. `check_only`: everything is verified, nothing written.
slots_result_t slots_install(const slots_t *slots, const uint8_t *bytes, size_t length, bool check_only, char message[PACKAGE_MESSAGE]);

// What to start now: *slot, and whether it is on trial (then this start was counted). A slot that is not whole is never started.
slots_result_t slots_start(const slots_t *slots, int *slot, bool *on_trial, char message[PACKAGE_MESSAGE]);

// The trial is the good one now. Does nothing where there is none.
slots_result_t slots_confirm(const slots_t *slots, char message[PACKAGE_MESSAGE]);

// The trial is over, the good one runs from the next start on. `why`: one line. Does nothing where there is none.
slots_result_t slots_return(const slots_t *slots, const char *why, char message[PACKAGE_MESSAGE]);

// The slot's folder.
void slots_path(const slots_t *slots, int slot, char path[STORAGE_PATH]);

// The slot's manifest is whole, and so is each file that it names; *package has its words.
bool slots_whole(const slots_t *slots, int slot, package_t *package);

// FOLDER/key.pub and FOLDER/rover. false: message says what is wrong and the mend.
bool slots_board(const slots_t *slots, uint8_t key[LMS_PUBLIC], char rover[PACKAGE_WORD], char message[PACKAGE_MESSAGE]);

// Writes these two into an empty folder or one that has them: a board's first flash. The slots stay.
slots_result_t slots_init(const slots_t *slots, const uint8_t key[LMS_PUBLIC], const char *rover, char message[PACKAGE_MESSAGE]);

// Writes a whole file: a temporary beside it, to the disk, renamed, to the disk. 0 or a negative errno.
int slots_write_file(const storage_t *storage, const char *folder, const char *name, const void *bytes, size_t length);

#ifdef __cplusplus
}
#endif

#endif
