// The mistakes of a first run: what is handed in follows another convention than leonav's.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace leonav {

// Codes of EventKind::kConventionSuspect, with what the event's value is. On the wire: append only.
enum class Convention : std::uint8_t {
  kNone = 0,
  // Units of the IMU. Value: mean specific force over gravity, where not said otherwise.
  kForceInG = 1,
  kForceUnit = 2,                // another unit, or gravity's share is not what it should be
  kGravityMissing = 3,           // taken out before it got here
  kIncrementsTimesInterval = 4,  // increments multiplied by the interval once more
  kRatesAsIncrements = 5,        // rates never multiplied by the interval
  kGyrosInDegrees = 6,           // value: the gyros' turn over the course's
  kGyroUnit = 7,                 // likewise
  // Axes of the IMU.
  kForceSign = 8,        // the accelerometers' sign; value: the gyros' turn over the course's
  kGyroSign = 9,         // likewise
  kGyroAxes = 10,        // value: the axis (1, 2, 3) that turns as the course does
  kThirdAxisUp = 11,     // value: degrees between the third axis and down
  kTilted = 12,          // likewise
  kForwardLeftUp = 13,   // likewise
  kRightForwardUp = 14,  // likewise
  kForwardRightExchanged = 15,  // value: degrees
  kMirrored = 16,               // one horizontal axis has the wrong sign; value: degrees
  kBackwards = 17,              // value: degrees that the IMU is turned about the vertical
  kTurned = 18,                 // likewise
  // Between IMU and GNSS.
  kLeapSeconds = 19,   // value: s, IMU stamps less GNSS stamps
  kStampOffset = 20,   // likewise
  kLeverArmSign = 21,  // value: m, horizontal distance of the arm measured from the arm told
  kLeverArm = 22,      // likewise
  // GNSS.
  kDopplerSign = 23,       // value: the codes' rate over the Dopplers'
  kDopplerUnit = 24,       // likewise
  kSignalsExchanged = 25,  // likewise: two bands' signals have each other's names
  kCodesExchanged = 26,    // value: m at the zenith, what the ionosphere delays L1 by if they are
  kGyroRange = 27,         // rates that no IMU measures; value: rad/s
};
inline constexpr std::size_t kConventionCount = 28;
std::string_view to_string(Convention convention);  // "force_in_g", ...

// What a check has found.
struct ConventionFinding {
  Convention convention = Convention::kNone;  // none: nothing to say (yet)
  double value = 0.0;
  explicit operator bool() const { return convention != Convention::kNone; }
};

}  // namespace leonav
