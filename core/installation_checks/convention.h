// Convention lists the mistakes of an installation: inputs that follow another convention than
// leonav's.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace leonav {

// Codes of EventKind::kConventionSuspect, with the meaning of the event's value. The values go over
// the wire: append only.
enum class Convention : std::uint8_t {
  kNone = 0,
  // Units of the IMU. The value is the mean specific force over gravity, where nothing else is
  // given.
  kForceInG = 1,
  kForceUnit = 2,                // another unit, or an implausible mean force
  kGravityMissing = 3,           // gravity was removed before the input
  kIncrementsTimesInterval = 4,  // increments multiplied by the interval once more
  kRatesAsIncrements = 5,        // rates never multiplied by the interval
  kGyrosInDegrees = 6,           // value: gyro turn over course turn
  kGyroUnit = 7,                 // value: gyro turn over course turn
  // Axes of the IMU.
  kForceSign = 8,               // the accelerometers' sign; value: gyro turn over course turn
  kGyroSign = 9,                // value: gyro turn over course turn
  kGyroAxes = 10,               // value: the axis (1, 2, 3) that turns with the course
  kThirdAxisUp = 11,            // value: degrees between the third axis and down
  kTilted = 12,                 // value: degrees between the third axis and down
  kForwardLeftUp = 13,          // value: degrees between the third axis and down
  kRightForwardUp = 14,         // value: degrees between the third axis and down
  kForwardRightExchanged = 15,  // value: degrees
  kMirrored = 16,               // one horizontal axis has the wrong sign; value: degrees
  kBackwards = 17,              // value: degrees that the IMU is turned about the vertical
  kTurned = 18,                 // value: degrees that the IMU is turned about the vertical
  // Between IMU and GNSS.
  kLeapSeconds = 19,   // value: s, IMU stamps minus GNSS stamps
  kStampOffset = 20,   // value: s, IMU stamps minus GNSS stamps
  kLeverArmSign = 21,  // value: m, horizontal, measured minus configured arm
  kLeverArm = 22,      // value: m, horizontal, measured minus configured arm
  // GNSS.
  kDopplerSign = 23,       // value: code rate over Doppler
  kDopplerUnit = 24,       // value: code rate over Doppler
  kSignalsExchanged = 25,  // value: code rate over Doppler; two bands carry each other's names
  kCodesExchanged = 26,    // value: m, ionospheric delay of L1 at the zenith if they are
  kGyroRange = 27,         // rates beyond any IMU's range; value: rad/s
  kOrbits = 28,            // codes contradict orbits or clocks for minutes; value: m, 1 sigma
};
inline constexpr std::size_t kConventionCount = 29;
// Mistakes that can come right by themselves are found again so often while they last.
inline constexpr double kFoundAgain_s = 60.0;
// Returns the name of the event code: "force_in_g", ...
std::string_view to_string(Convention convention);

// The finding of a check; it converts to true if there is one.
struct ConventionFinding {
  Convention convention = Convention::kNone;  // kNone: no finding (yet)
  double value = 0.0;
  explicit operator bool() const { return convention != Convention::kNone; }
};

}  // namespace leonav
