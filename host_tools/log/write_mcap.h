// write_mcap.h - a log as MCAP with ros2msg schemas, which Foxglove, PlotJuggler and ROS 2's rosbag2 read.
//
// Written from the format's specification (mcap.dev/spec, version 0): header, schemas, channels, chunks without compression, each with its
// message index, then the summary (schemas, channels, statistics, chunk and metadata indexes). CRC-32 over every chunk and the summary.
//
// The signals of one object that share their times are one topic: /wheel0 with speed_rad_s, current_a, ... An object with several clocks
// has a topic for each, named after its first signal: /radar/adc_count. Fields are float64 in CDR, little endian, without a header: a
// message's time is its log_time, nanoseconds of the log's clock. ROS wants small letters in fields; the name as it was stands in the
// schema's comment. The log's header is the metadata record "traction-log".
#pragma once

#include "log.h"

#include <string>

namespace traction::log {

// Whole or not at all (write_file.h). Throws LogError; FileError when it cannot be written. A log that begins before 0 is moved to 0,
// which stands in the metadata as moved_s.
void write_mcap(const Log &log, const std::string &path);

} // namespace traction::log
