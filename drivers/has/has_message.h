// This unit decodes HAS messages of type 1 to corrections.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/gps_time.h"
#include "drivers/has/has_mask.h"
#include "drivers/ssr/ssr_correction.h"

namespace leonav {

// Outcome of one message.
enum class HasStatus : std::uint8_t {
  kOk = 0,
  kBadLength,    // shorter than its masks require
  kBadTime,      // beyond the hour
  kBadMask,      // of a system that is not defined, or of one twice
  kWithoutMask,  // its mask has not come within kLongestMaskLife_s
  kBadSubset,    // clocks of a system that the mask lacks
  kBadValidity,  // reserved index of the validity interval
};

// Counts of what messages hold and cannot be used.
struct HasLeftOut {
  std::uint64_t unavailable = 0;       // corrections and biases marked as not available
  std::uint64_t do_not_use = 0;        // clocks marked so
  std::uint64_t reserved_signals = 0;  // biases of signals without a name
  std::uint64_t other_navigation = 0;  // orbits and clocks for a reserved broadcast message
};

// A number names another mask some day. Masks are sent every minute or so.
inline constexpr double kLongestMaskLife_s = 3600.0;

// HasMessages remembers the masks that messages refer to.
class HasMessages {
 public:
  // Decodes the octets of a message received at `received`, which must be set. On kOk `result` gets
  // a message for each block and system, orbits before clocks; otherwise it stays as it is and
  // nothing is remembered. Its time is the instant with its time of hour that is nearest to
  // `received`. Orbits have the opposite sign of those sent, which are to be added; phase biases,
  // sent in cycles, are in metres. Source: Galileo HAS SIS ICD 1.0, 5 and 7.
  HasStatus decode(std::span<const std::uint8_t> octets, GpsTime received,
                   std::vector<SsrMessage>* result, HasLeftOut* left_out);

 private:
  struct Known {
    GpsTime received;  // unset: not known
    HasMask mask;
  };
  std::array<Known, 32> masks_;
};

}  // namespace leonav
