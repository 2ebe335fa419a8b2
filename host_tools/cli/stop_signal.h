// stop_signal.h - the first SIGINT or SIGTERM asks a verb to end and keep what it has; the second one ends the program as ever.
#pragma once

namespace traction::cli {

class StopSignal {
  public:
    // One at a time in a process; a signal that is ignored (nohup) stays ignored. `words` are written as it comes, and must last.
    explicit StopSignal(const char *words = "\ntraction: stopping; what was simulated is written. Once more ends it without\n");
    ~StopSignal(); // the handlers of before
    StopSignal(const StopSignal &) = delete;
    StopSignal &operator=(const StopSignal &) = delete;

    static int asked(); // the signal's number, 0: none came. From any thread.
};

} // namespace traction::cli
