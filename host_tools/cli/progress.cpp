#include "progress.h"

#include <unistd.h>

#include <utility>

namespace traction::cli {

using clock = std::chrono::steady_clock;

Progress::Progress(std::string what, long total)
    : what_(std::move(what)), total_(total > 0 ? total : 1), terminal_(isatty(STDERR_FILENO) == 1), start_(clock::now()), drawn_(start_) {}

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

void Progress::draw() {
    const double spent_s = std::chrono::duration<double>(clock::now() - start_).count();
    const double fraction = static_cast<double>(done_) / static_cast<double>(total_);
    const double left_s = fraction > 0 ? spent_s * (1 - fraction) / fraction : 0;
    std::fprintf(stderr, "\r\033[K%s: %ld of %ld, about %.0f s left", what_.c_str(), done_, total_, left_s);
    std::fflush(stderr);
}

} // namespace traction::cli
