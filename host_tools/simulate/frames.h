// frames.h - a run as text that any build of the firmware can replay: per tick the frame and the command, a line each.
//
// The format is that of hal/replay/frames.h; `tractiond --hal replay FILE` runs it, on the host and on the target.
#pragma once

#include "firmware/core/signals.h"

#include <cstdio>
#include <string>

namespace traction {

class FrameWriter {
  public:
    // config: "default" or "paper", the firmware configuration of the run. Throws log::FileError.
    FrameWriter(const std::string &path, const std::string &config);
    ~FrameWriter(); // unless kept, leaves nothing
    FrameWriter(const FrameWriter &) = delete;
    FrameWriter &operator=(const FrameWriter &) = delete;

    void add(const sensor_frame_t &frame, const command_t &command);
    void keep(); // gives the file its name

  private:
    std::string path_;
    std::FILE *file_;
};

} // namespace traction
