// report.h - turns a result of the lab, or a set of figures, into one HTML file that works from disk without a network.
//
// The page is chosen by result["schema"]:
//   "traction.lab/1"      what compare, diagnose, add and fit put out (docs/json_schema.md)
//   "traction.check/1"    what check puts out
//   "traction.compared/1" several of the lab's side by side: { "schema", "title": str, "results": [{ "name": str, ...traction.lab/1 }] }
//   "traction.look/1"   the drive of a log: { "schema", "title": str, "log": { "file", "duration_s" }, "replay": replay_of (replay.h) }
//   "traction.figures/1"  a set of figures with what a source says beside what we measured:
//     { "schema": "traction.figures/1", "title": str, "intro": str,
//       "figures": [ { "id": str, "title": str, "paper": str, "ours": str, "verdict": "agrees|differs|<words>",
//                      "svg": str (to_svg of svg.h), "notes": str } ],
//       "tables":  [ { "title": str, "columns": [str], "rows": [[str|number|null]], "notes": str } ] }
// Any result may hold "replay": the page then shows the drive, and carries the code that draws it (three.js); else it does not.
// Any absent key is an absent part of the page; nothing but "schema" is required.
#pragma once

#include <nlohmann/json.hpp>

#include <stdexcept>
#include <string>

namespace traction::report {

// A result that no page knows how to show. The message is complete.
struct ReportError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The page as text. Throws ReportError when the schema is unknown.
std::string to_html(const nlohmann::json &result);

// Writes the page to `path`, whole or not at all (host_tools/log/write_file.h). Throws ReportError, log::FileError.
void write_html(const nlohmann::json &result, const std::string &path);

// Writes any text the same way (SVG, for one). Throws log::FileError.
void write_text(const std::string &text, const std::string &path);

} // namespace traction::report
