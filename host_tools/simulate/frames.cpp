#include "frames.h"

#include "hal/replay/frames.h"

namespace traction {

FrameWriter::FrameWriter(const std::string &path, const std::string &config) : file_(path) {
    file_.write("# frames of traction simulate, firmware configuration " + config + "; tractiond --hal replay runs them\n");
}

void FrameWriter::keep() { file_.keep(); }

void FrameWriter::add(const sensor_frame_t &frame, const command_t &command) {
    char line[FRAMES_LINE];
    file_.write({line, frames_print(&frame, &command, line)});
}

} // namespace traction
