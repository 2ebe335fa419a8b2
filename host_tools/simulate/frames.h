// frames.h - a run as text that any build of the firmware can replay: per tick the frame, the command, and the trace it must give.
//
// One line a tick, fields separated by one blank, integers in decimal, floats as the 8 hex digits of their bits:
//   frame:   tick present encoder[4] current[4] battery accel gyro stop samples radar[8]
//   command: mode speed yaw_rate wheel_speed[4] duty[4] slip slip_wheels age
//   trace:   mode faults, per wheel: speed accel set current torque traction slip duty valid saturated;
//            battery accel gyro radar fresh speed std bias standstill duty_q15[4] enable
// The first line is "# traction-frames 1 default" or "... paper": the configuration that made the traces.
#pragma once

#include "firmware/core/control.h"

#include <cstdio>
#include <string>

namespace traction {

class FrameWriter {
  public:
    FrameWriter(const std::string &path, const std::string &config); // throws log::FileError
    ~FrameWriter();                                                  // unless kept, leaves nothing
    FrameWriter(const FrameWriter &) = delete;
    FrameWriter &operator=(const FrameWriter &) = delete;

    void add(const sensor_frame_t &frame, const command_t &command, const trace_t &trace);
    void keep(); // gives the file its name

  private:
    void integer(long value);
    void real(float value);
    std::string path_, line_;
    std::FILE *file_;
};

} // namespace traction
