// token.h - the secret that the printed address carries: who has it may use the page, nobody else may.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace traction::serve {

// 43 letters that carry 256 bits of the kernel's randomness. Throws std::runtime_error where the kernel gives none.
std::string make_token();

// The token in this file, so that a page that is open finds the server again after it was started anew; a fresh one where there is none,
// or where the file is not ours alone (another owner, a link, readable by others). Where it cannot be kept it lasts for one run.
std::string keep_token(const std::string &path);

// Takes the same time wherever the two differ.
bool same_token(std::string_view secret, std::string_view given);

} // namespace traction::serve
