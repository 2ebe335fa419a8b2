// loop.h - daemon_run for C++: the operator and the log as an object, exceptions carried over the C between.
//
// What a hook or a HAL throws ends the loop: nothing more is written, the motors are stopped, and it is thrown again.
#pragma once

#include "firmware/app/daemon.h"

namespace traction {

class Link {
  public:
    Link() = default;
    Link(const Link &) = delete;
    Link &operator=(const Link &) = delete;
    virtual ~Link() = default;

    // Asked before every tick; true ends the loop as the HAL's end does.
    virtual bool over() { return false; }
    // What is asked for in the tick that `frame` was read in; `command` comes as MODE_STOP.
    virtual void command(const sensor_frame_t &frame, command_t &command) = 0;
    // One tick as it was.
    virtual void log(const sensor_frame_t &frame, const command_t &command, const trace_t &trace) = 0;
};

daemon_result_t run_loop(const hal_t &hal, const control_config_t &config, Link &link, const daemon_start_t &start = {});

} // namespace traction
