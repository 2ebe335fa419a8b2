#include "terminal.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace traction::cli {

namespace {

constexpr std::string_view bold = "\033[1m", green = "\033[1;32m", dim = "\033[2m", plain = "\033[0m";

constexpr std::pair<std::string_view, std::string_view> looks[] = {{"Is the model good enough?", bold},
                                                                   {"What is missing?", bold},
                                                                   {"How sure is that?", bold},
                                                                   {"What is left, and why?", bold},
                                                                   {"Where does it fail?", bold},
                                                                   {"What next?", bold},
                                                                   {"what was tried", bold},
                                                                   {"error, x noise", bold},
                                                                   {"found:", green},
                                                                   {"The model lacks", green},
                                                                   {"Nothing found", bold},
                                                                   {"The model misses", bold},
                                                                   {"The seal:", green},
                                                                   {"note:", dim},
                                                                   {"this log cannot show:", dim}};

} // namespace

bool terminal_has_colour() {
    const char *no_colour = std::getenv("NO_COLOR"), *kind = std::getenv("TERM");
    const bool refused = no_colour != nullptr && *no_colour != '\0';
    return !refused && isatty(STDOUT_FILENO) == 1 && kind != nullptr && std::string_view(kind) != "dumb";
}

std::string painted(const std::string &text) {
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line(text.data() + at, end - at);
        bool done = false;
        for (const auto &[begin, look] : looks) {
            if (!line.starts_with(begin)) continue;
            out.append(look).append(begin).append(plain).append(line.substr(begin.size()));
            done = true;
            break;
        }
        if (!done) out.append(line);
        if (end < text.size()) out += '\n';
        at = end + 1;
    }
    return out;
}

void print(const std::string &text) { std::fputs((terminal_has_colour() ? painted(text) : text).c_str(), stdout); }

} // namespace traction::cli
