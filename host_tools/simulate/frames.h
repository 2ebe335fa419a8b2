// frames.h - a run as text that any build of the firmware can replay: per tick the frame and the command, a line each.
//
// The format is that of hal/replay/frames.h; `tractiond --hal replay FILE` runs it, on the host and on the target.
#pragma once

#include "firmware/core/signals.h"
#include "host_tools/log/write_file.h"

#include <string>

namespace traction {

class FrameWriter {
  public:
    // config: "default" or "paper", the firmware configuration of the run. Throws log::FileError.
    FrameWriter(const std::string &path, const std::string &config);

    void add(const sensor_frame_t &frame, const command_t &command);
    void keep(); // gives the file its name

  private:
    log::WholeFile file_; // unless kept, leaves nothing
};

} // namespace traction
