#include "progress.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <utility>

namespace traction::cli {

using clock = std::chrono::steady_clock;

namespace {
std::atomic<bool> silent{false};

// TRACTION_PROGRESS_FD: a descriptor, 3 or above, that whoever started this program reads; -1: none.
int reader() {
    const char *const text = std::getenv("TRACTION_PROGRESS_FD");
    if (text == nullptr) return -1;
    char *end = nullptr;
    const long fd = std::strtol(text, &end, 10);
    if (end == text || *end != '\0' || fd < 3 || fd > 1023 || fcntl(static_cast<int>(fd), F_GETFD) < 0) return -1;
    return static_cast<int>(fd);
}

} // namespace

void Progress::silence() { silent = true; }

Progress::Progress(std::string what, long total)
    : what_(std::move(what)), total_(total > 0 ? total : 1), terminal_(!silent && isatty(STDERR_FILENO) == 1), reader_(reader()),
      start_(clock::now()), drawn_(start_) {
    tell();
}

Progress::~Progress() {
    if (terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::step(long count) {
    const std::lock_guard lock(mutex_);
    done_ += count;
    const auto now = clock::now();
    if ((terminal_ || reader_ >= 0) && now - drawn_ > std::chrono::milliseconds(100)) {
        drawn_ = now;
        if (terminal_) draw();
        tell();
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

void Progress::tell() {
    if (reader_ < 0) return;
    const double spent_s = std::chrono::duration<double>(clock::now() - start_).count();
    const std::string line = std::to_string(done_) + ' ' + std::to_string(total_) + ' ' + text(what_, done_, total_, spent_s) + '\n';
    if (write(reader_, line.data(), line.size()) < 0) reader_ = -1; // nobody reads it any more
}

void Progress::draw() {
    const double spent_s = std::chrono::duration<double>(clock::now() - start_).count();
    std::fprintf(stderr, "\r\033[K%s", text(what_, done_, total_, spent_s).c_str());
    std::fflush(stderr);
}

} // namespace traction::cli
