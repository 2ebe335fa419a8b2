// flash.h - a package onto a board: look what runs there, install, wait until the new version is healthy or the old one is back.
#pragma once

#include "remote.h"

#include <functional>
#include <stdexcept>
#include <string>

namespace traction::flash {

struct FlashOptions {
    Address board;
    std::string program = "traction-slot", folder = "/opt/traction"; // on the board
    bool dry_run = false;
    int wait_s = 90;                               // for the trial's end
    std::function<void(const std::string &)> step; // each step in words as it is done
    std::function<bool()> stopped;
};

enum class Outcome {
    confirmed, // the new version runs, healthy
    same,      // it ran already
    checked,   // --dry-run: it would be taken
    installed, // no version ran: the new one is tried at the board's next start
    returned,  // it did not come up; the old one runs
    unknown,   // installed, and the board gave no answer in time
    refused,   // by the board; nothing was changed
    busy,      // another installer, or a version on trial; nothing was changed
    failed,    // the board's disk, or its installer; the old version runs
};

struct Result {
    Outcome outcome = Outcome::failed;
    std::string reason;      // in words; empty where there is nothing to say
    bool old_version = true; // the board has a good one, to which it returned
};

// Throws NoConnection (before anything was installed), std::runtime_error (no installer on the board).
Result flash(const FlashOptions &options, const std::string &package);

const char *name_of(Outcome outcome); // "confirmed"

} // namespace traction::flash
