// Random bytes of the system.
#pragma once
#include <cstdint>
#include <span>

namespace leonav {

// At most 256. Throws std::system_error where the system has none. Once it has given some it always
// does (getrandom(2)).
void fill_random(std::span<std::uint8_t> bytes);

}  // namespace leonav
