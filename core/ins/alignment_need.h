// What an alignment still lacks.
#pragma once
#include <cstdint>

namespace leonav {

enum class Lacking : std::uint8_t {
  kNothing = 0,
  kPosition,   // there is no filter yet
  kLevelling,  // seconds of specific force
  kGravity,    // the specific force's mean is not of gravity's length: shaken, or not in m/s^2
  kNorth,      // stands: the gyros need so many more seconds to find north
  kDriving,    // no heading: it does not drive, and has not been told
  kCourse,     // drives: so many more seconds of it
  kGear,       // drives steadily: whether forward or in reverse, only a change of speed tells
  kAgreement,  // drives: courses, gyros and accelerometers do not agree well enough
};

struct AlignmentNeed {
  Lacking lacking = Lacking::kNothing;
  double seconds = 0.0;  // where a duration belongs to it
};

}  // namespace leonav
