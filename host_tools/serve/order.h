// order.h - what a browser may ask for, judged key by key, and the commands that do it.
//
// { "verb": "check|look|compare|diagnose|add|drop|next|simulate|game_new|game_look|game_guess|game_add|game_open|
//           watch|rover_logs|rover_fetch", and by verb:
//   "log", "model", "map", "scenario": names that Folder lists; "effect": of the catalogue; "wheel": 0 to 3, absent or -1: all;
//   "seed": 0 to 2^53; "seconds": 1 to 3600; "realtime", "hidden", "hard": true or false; "soil": sand, gravel, concrete;
//   "number": 0 to 65535, of a log on the rover }
// The rover is the command line's: no request names an address or a key, and none moves it.
// A key that the verb does not know is refused, as is a value of another kind.
#pragma once

#include "folder.h"

#include <nlohmann/json.hpp>

#include <stdexcept>
#include <string>
#include <vector>

namespace traction::serve {

// What is wrong with a request: key, value, the mend. HTTP status 400.
struct BadRequest : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The rover whose telemetry is shown.
struct Rover {
    std::string host, key; // key "": what comes unsigned is believed
    int system = 1;        // its MAVLink number
};

struct Order {
    nlohmann::json entry;                           // what the history keeps of it: verb, log, model, effect, wheel, made
    std::vector<std::vector<std::string>> commands; // run one after the other; the last one writes the result
    bool live = false;                              // rows of a drive come on standard output
    bool game = false;
};

// result: the file for --json. seal: for what a simulated drive hides. rover: nullptr where none was named. Throws BadRequest.
Order make_order(const nlohmann::json &request, const Folder &folder, const std::string &result, const std::string &seal,
                 const Rover *rover = nullptr);

} // namespace traction::serve
