// page.h - the report page as Vite built it from web/, held in this library (page.cpp is generated in the build folder).
#pragma once

#include <string_view>

namespace traction::report {

// HTML with the word __TRACTION_RESULT__ where the JSON goes.
std::string_view page_template();

} // namespace traction::report
