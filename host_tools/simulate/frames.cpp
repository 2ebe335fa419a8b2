#include "frames.h"

#include "hal/replay/frames.h"
#include "host_tools/log/log.h"

#include <cerrno>
#include <cstring>

namespace traction {

namespace {
[[noreturn]] void fail(const std::string &path) {
    throw log::FileError(path, 0, 0, std::string("cannot be written: ") + std::strerror(errno),
                         "check that the folder exists and has room");
}
} // namespace

FrameWriter::FrameWriter(const std::string &path, const std::string &config)
    : path_(path), file_(std::fopen((path + ".part").c_str(), "wb")) {
    if (file_ == nullptr) fail(path);
    std::fprintf(file_, "# frames of traction simulate, firmware configuration %s; tractiond --hal replay runs them\n", config.c_str());
}

FrameWriter::~FrameWriter() {
    if (file_ == nullptr) return;
    std::fclose(file_);
    std::remove((path_ + ".part").c_str());
}

void FrameWriter::keep() {
    const bool good = std::ferror(file_) == 0;
    if (std::fclose(file_) != 0 || !good || std::rename((path_ + ".part").c_str(), path_.c_str()) != 0) {
        file_ = nullptr;
        fail(path_);
    }
    file_ = nullptr;
}

void FrameWriter::add(const sensor_frame_t &frame, const command_t &command) {
    char line[FRAMES_LINE];
    std::fwrite(line, 1, frames_print(&frame, &command, line), file_);
}

} // namespace traction
