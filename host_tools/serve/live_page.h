// live_page.h - the page of `traction serve` as Vite built it from host_tools/report/web, held in this library.
#pragma once

#include <string_view>

namespace traction::serve {

// HTML with the word __TRACTION_NONCE__ in its script and style elements.
std::string_view live_page();

} // namespace traction::serve
