// progress.h - shows how far long work is: one line redrawn on a terminal, nothing in a pipe.
//
// A program that runs a verb and wants to know opens a descriptor for it and names its number in TRACTION_PROGRESS_FD: it gets a line
// "DONE TOTAL WORDS" at the beginning and ten times a second at most (host_tools/serve).
#pragma once

#include <chrono>
#include <cstdio>
#include <mutex>
#include <string>

namespace traction::cli {

// Counts steps of known total. Thread-safe: workers may call step() side by side.
class Progress {
  public:
    // what: a few words for people ("simulate sand"). total: number of steps, > 0.
    Progress(std::string what, long total);
    ~Progress(); // wipes the line
    Progress(const Progress &) = delete;
    Progress &operator=(const Progress &) = delete;

    void step(long count = 1);

    // How far, in words: "drive: 3 of 10, about 4 s left". When more is done than was announced the total is not believed any more:
    // "drive: 12 done, 5 s so far".
    static std::string text(const std::string &what, long done, long total, double spent_s);

    static void silence(); // from now on nothing is shown (--quiet)

  private:
    void draw();
    void tell();
    std::string what_;
    long total_;
    long done_ = 0;
    bool terminal_;
    int reader_; // -1: none
    std::mutex mutex_;
    std::chrono::steady_clock::time_point start_;
    std::chrono::steady_clock::time_point drawn_;
};

} // namespace traction::cli
