#include "progress.h"

#include <unistd.h>

#include <atomic>
#include <utility>

namespace traction::cli {

using clock = std::chrono::steady_clock;

namespace {
std::atomic<bool> silent{false};
}

void Progress::silence() { silent = true; }

Progress::Progress(std::string what, long total)
    : what_(std::move(what)), total_(total > 0 ? total : 1), terminal_(!silent && isatty(STDERR_FILENO) == 1), start_(clock::now()),
      drawn_(start_) {}

Progress::~Progress() {
    if (terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::step(long count) {
    const std::lock_guard lock(mutex_);
    done_ += count;
    const auto now = clock::now();
    if (terminal_ && now - drawn_ > std::chrono::milliseconds(100)) {
        drawn_ = now;
        draw();
    }
}

std::string Progress::text(const std::string &what, long done, long total, double spent_s) {
    char line[80];
    if (done > total)
        std::snprintf(line, sizeof line, ": %ld done, %.0f s so far", done, spent_s);
    else if (done <= 0)
        std::snprintf(line, sizeof line, ": 0 of %ld", total);
    else
        std::snprintf(line, sizeof line, ": %ld of %ld, about %.0f s left", done, total,
                      spent_s * static_cast<double>(total - done) / static_cast<double>(done));
    return what + line;
}

void Progress::draw() {
    const double spent_s = std::chrono::duration<double>(clock::now() - start_).count();
    std::fprintf(stderr, "\r\033[K%s", text(what_, done_, total_, spent_s).c_str());
    std::fflush(stderr);
}

} // namespace traction::cli
