// This unit puts into words why corrections of a service gave no states.
#pragma once
#include <cstdint>
#include <vector>

#include "drivers/ssr/correction_store.h"

namespace leonav {

enum class UnusedReason : std::uint8_t {
  kWithoutEphemeris,
  kWithoutBcnav1,
  kWithoutOrbit,
  kWithoutClock,
  kOfOtherIssue,
  kTooOld,
  kNotReliable,
  kInRegionalFrame
};

struct UnusedCorrections {
  UnusedReason reason = UnusedReason::kWithoutEphemeris;
  std::uint64_t count = 0;
  const char* one = "";   // what one of them is, in a list with its count
  const char* many = "";  // what follows their number in a sentence
};

// Returns all reasons, also those that did not occur, in a fixed order.
std::vector<UnusedCorrections> unused_corrections(const CorrectionCounters& counters);

}  // namespace leonav
