#include "stop_signal.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

namespace traction::cli {

namespace {

constexpr std::array<int, 2> signals{SIGINT, SIGTERM};
std::array<struct sigaction, signals.size()> before{};
std::atomic<int> number{0};
std::atomic<const char *> words{""};
static_assert(std::atomic<int>::is_always_lock_free, "a signal's handler may use it");

void put_back() {
    for (std::size_t i = 0; i < signals.size(); ++i)
        if (before[i].sa_handler != SIG_IGN) sigaction(signals[i], &before[i], nullptr);
}

void ask(int signal) {
    number = signal;
    put_back();
    const char *const text = words;
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) return; // nobody reads it
}

} // namespace

StopSignal::StopSignal(const char *said) {
    number = 0;
    words = said;
    struct sigaction fresh {};
    fresh.sa_handler = ask;
    fresh.sa_flags = SA_RESTART;
    for (std::size_t i = 0; i < signals.size(); ++i) {
        sigaction(signals[i], nullptr, &before[i]);
        if (before[i].sa_handler != SIG_IGN) sigaction(signals[i], &fresh, nullptr);
    }
}

StopSignal::~StopSignal() { put_back(); }

int StopSignal::asked() { return number; }

} // namespace traction::cli
