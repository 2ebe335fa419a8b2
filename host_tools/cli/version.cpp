#include "help.h"

#include "version_text.h" // written by cmake/version.cmake

namespace traction::cli {

std::string version_text() { return "traction " TRACTION_VERSION_TEXT "\n"; }

} // namespace traction::cli
