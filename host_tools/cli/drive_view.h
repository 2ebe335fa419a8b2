// drive_view.h - the drive of a log as the report page replays it: which rover is drawn, and where its pose comes from.
#pragma once

#include "host_tools/report/replay.h"
#include "sim/scenario/rover.h"

namespace traction::lab {
struct Model;
struct Session;
} // namespace traction::lab

namespace traction::cli {

report::RoverShape shape_of(const sim::RoverDescription &rover);

// A lab's model says where its wheels are and how large; the body between them is drawn as large as they allow.
report::RoverShape shape_of(const lab::Model &model);

// `result` with the replay of the session's drive, where it is one and its log has a pose: what the page shows, not what --json writes.
nlohmann::json with_replay(nlohmann::json result, const lab::Session &session);

} // namespace traction::cli
