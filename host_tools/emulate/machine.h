// machine.h - the emulated board as a process: QEMU in a run's folder, and the two FIFOs by which it and its world talk
// (emulate/lockstep.h).
//
// Virtual time is counted in instructions (-icount), the board's clock is virtual time, and while the board waits for its world the whole
// machine stands still: what the board does depends on nothing but its files and what the world says.
#pragma once

#include "world.h"

#include <stdexcept>
#include <sys/types.h>

#include <functional>
#include <string>

namespace traction::emulate {

// Instructions take 2^shift ns: 4 ns stand for an instruction of the PXA255 at 400 MHz (1.6 cycles), assumed.
constexpr int icount_shift = 2;

class Machine {
  public:
    // board: the folder with zImage, versatile-pb.dtb and initramfs; folder: the run's, with the files that the board brings itself
    // (emulate/board_init.c); flash: what its NOR flash holds, a file that is written as the board writes; empty: an erased one that is
    // forgotten. Throws std::runtime_error where QEMU or a file is missing, or the flash is of another size.
    Machine(const std::string &board, const std::string &folder, const std::string &flash = {});
    Machine(const Machine &) = delete;
    Machine &operator=(const Machine &) = delete;
    ~Machine(); // QEMU is ended

    // The board's next record; records are kept in the folder, both ways. Throws std::runtime_error, with the board's last words, when
    // it ends or says nothing for patience_s of the wall clock.
    BoardSays hear();
    void say(const WorldSays &world);
    void finish(); // after the last record: waits until the board has handed out its files

  private:
    void read(void *data, std::size_t length);
    void write(const void *data, std::size_t length);
    void record(const void *data, std::size_t length);
    [[noreturn]] void fail(const std::string &what) const;
    bool ended();

    static constexpr double patience_s = 300; // a machine that does much else besides
    std::string folder_;
    pid_t qemu_ = -1;
    int in_ = -1, out_ = -1, records_ = -1;
    int status_ = 0;
};

} // namespace traction::emulate
