// remote.h - a board over the system's ssh: one command at a time, its words line by line, and what a failure means.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace traction::flash {

struct Address {
    std::string host, user = "root", identity; // identity: a private key's file; empty: what ssh takes by itself
    std::string known_hosts;                   // empty: the user's
    std::string program = "ssh";               // found on PATH
    int port = 22;
    int patience_s = 10; // for the connection
};

struct Answer {
    int status = 0;                 // of the command; 127: there is none of this name
    std::vector<std::string> lines; // its standard output
    std::string error;              // its standard error, or ssh's
};

// The connection could not be made, or was lost.
struct NoConnection : std::runtime_error {
    NoConnection(const std::string &to, const std::string &what_happened, const std::string &how_to_mend)
        : std::runtime_error(to + ": " + what_happened + "; " + how_to_mend), board(to), happened(what_happened), mend(how_to_mend) {}
    std::string board, happened, mend;
};

// Words that may stand in the remote shell's line unquoted. Throws std::runtime_error for any other.
std::string plain_word(const std::string &option, const std::string &word);

// Runs `words` on the board, `input` on its standard input. `each` is called with every line as it comes. Throws NoConnection; an
// interrupted program (SIGINT) leaves the board's command to end by itself.
Answer run_on(const Address &board, const std::vector<std::string> &words, const std::string &input,
              const std::function<void(const std::string &)> &each = {});

} // namespace traction::flash
