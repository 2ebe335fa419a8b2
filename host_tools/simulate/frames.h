// frames.h - a run as text that any build of the firmware can replay: per tick the frame and the command.
//
// The format is that of tests/replay/replay.c: one line a tick, fields separated by one blank,
//   tick present enc[4] cur[4] battery accel gyro estop n radar[n] mode v yaw w[4] duty[4] slip slip_wheels age
// counts in decimal, `present` in hexadecimal, floats as the 8 hex digits of their bits.
#pragma once

#include "firmware/core/signals.h"
#include "host_tools/log/write_file.h"

#include <cstdint>
#include <string>

namespace traction {

class FrameWriter {
  public:
    // config: "default" or "paper", the firmware configuration of the run. Throws log::FileError.
    FrameWriter(const std::string &path, const std::string &config);

    void add(const sensor_frame_t &frame, const command_t &command);
    void keep(); // gives the file its name

  private:
    void integer(long value);
    void hexadecimal(std::uint32_t value, int digits);
    void real(float value);
    std::string line_;
    log::WholeFile file_; // unless kept, leaves nothing
};

} // namespace traction
