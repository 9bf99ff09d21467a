// AlignmentNeed gives the reason why there is no attitude yet, for status messages to the user.
#pragma once
#include <cstdint>

namespace leonav {

// Reason why the attitude is missing.
enum class Lacking : std::uint8_t {
  kNothing = 0,
  kPosition,   // there is no filter yet
  kLevelling,  // the specific force has not been averaged long enough
  kGravity,    // the mean specific force has not gravity's length: shaken, or not in m/s^2
  kNorth,      // at rest: the gyros need this many more seconds to find north
  kDriving,    // no heading: the vehicle does not drive, and no heading was given
  kCourse,     // in motion: this many more seconds are needed
  kGear,       // in steady motion: only a change of speed distinguishes forward from reverse
  kAgreement,  // in motion: courses, gyros and accelerometers do not agree well enough
};

// A reason with its duration.
struct AlignmentNeed {
  Lacking lacking = Lacking::kNothing;
  double seconds = 0.0;  // remaining time, for the reasons that have one
};

}  // namespace leonav
