// page.h - the report page as Vite built it from web/, held in this library (its C++ is generated in the build folder).
#pragma once

#include <string_view>

namespace traction::report {

// HTML with the word __TRACTION_RESULT__ where the JSON goes, and behind it __TRACTION_SCENE__ for the code below.
std::string_view page_template();

// JavaScript that draws the drive in three dimensions, with three.js in it: text that may stand in a <script> element.
std::string_view scene_code();

} // namespace traction::report
