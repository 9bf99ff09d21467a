// A count as printf's %llu takes it, whatever 64 bits are on this machine.
#pragma once
#include <cstdint>

namespace leonav {

inline unsigned long long number(std::uint64_t count) { return count; }

}  // namespace leonav
