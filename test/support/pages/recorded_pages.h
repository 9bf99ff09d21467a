// Recorded pages of corrections, in the shared data.
#pragma once

namespace leonav::test {

// The same hour of both services, and the broadcast ephemerides that they correct.
inline constexpr const char* kHasPages = "wire/has_gale6_189e.txt";
inline constexpr const char* kB2bPages = "wire/b2b_189e.txt";
inline constexpr const char* kBroadcast = "wire/broadcast_189.23P";

}  // namespace leonav::test
