#pragma once
// Another header may bring the type along, or not.
std::uint64_t borrowed();
