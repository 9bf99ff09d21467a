// This header lists the causes that end an arc of continuous carrier phase.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

namespace leonav {

// Each detector has one bit. The values are on the wire: append only.
enum class SlipCause : std::uint16_t {
  kGap = 1 << 0,                // not measured for too long
  kSignalChanged = 1 << 1,      // another signal, or a second signal came or went
  kLossOfLock = 1 << 2,         // flagged by the receiver
  kLockTime = 1 << 3,           // lock time went back, or is shorter than the interval
  kGeometryFree = 1 << 4,       // first minus second carrier left its trend
  kMelbourneWuebbena = 1 << 5,  // wide lane against the codes
  kDoppler = 1 << 6,            // carrier change against mean Doppler
  kHalfCycle = 1 << 7,          // half a cycle resolved, by an amount that cannot be determined
  kRangeChange = 1 << 8,        // carrier change against the other satellites and the motion
  kFilter = 1 << 9,             // the estimator rejected the carrier
  kClockJump = 1 << 10,         // clock jump that cannot be repaired, all satellites at once
  kUntested = 1 << 11,          // one frequency, and no test was possible here
};
inline constexpr std::array<SlipCause, 12> kSlipCauses = {
    SlipCause::kGap,      SlipCause::kSignalChanged, SlipCause::kLossOfLock,
    SlipCause::kLockTime, SlipCause::kGeometryFree,  SlipCause::kMelbourneWuebbena,
    SlipCause::kDoppler,  SlipCause::kHalfCycle,     SlipCause::kRangeChange,
    SlipCause::kFilter,   SlipCause::kClockJump,     SlipCause::kUntested,
};
std::string_view to_string(SlipCause cause);  // "gap", "signal_changed", ...

// SlipCauses is a set of causes, one bit each.
class SlipCauses {
 public:
  constexpr SlipCauses() = default;
  constexpr explicit SlipCauses(std::uint16_t bits) : bits_(bits) {}
  constexpr SlipCauses(SlipCause cause) : bits_(static_cast<std::uint16_t>(cause)) {}  // NOLINT
  constexpr bool has(SlipCause cause) const {
    return (bits_ & static_cast<std::uint16_t>(cause)) != 0;
  }
  constexpr bool any() const { return bits_ != 0; }
  constexpr std::uint16_t bits() const { return bits_; }
  constexpr SlipCauses& operator|=(SlipCauses other) {
    bits_ = static_cast<std::uint16_t>(bits_ | other.bits_);
    return *this;
  }
  friend constexpr bool operator==(SlipCauses, SlipCauses) = default;

 private:
  std::uint16_t bits_ = 0;
};

}  // namespace leonav
