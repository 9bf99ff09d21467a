#include "daemon/text/alignment_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace leonav {
namespace {

constexpr std::int64_t kKinds = 16;
constexpr double kMostSeconds = 1e6;

// As people write it: 2, 0.5.
std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string whole(double seconds) { return number(std::ceil(std::max(0.0, seconds))); }

// In steps of a factor of about two, so that the text is not another one every second.
std::string at_most(double seconds) {
  for (const double step : {2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0}) {
    if (seconds <= step) return "up to " + number(step) + " s more";
  }
  return "more than 600 s more";
}

}  // namespace

std::string to_text(const AlignmentNeed& need, const AlignmentConfig& config) {
  const std::string more = at_most(need.seconds);
  switch (need.lacking) {
    case Lacking::kNothing:
      return "";
    case Lacking::kPosition:
      return "no position";
    case Lacking::kLevelling:
      return "no level yet: " + more + " of specific force";
    case Lacking::kGravity:
      return "no level yet: the IMU is shaken, or its specific force is not of gravity's length";
    case Lacking::kNorth:
      return "standing: the gyros need " + more + " to find north";
    case Lacking::kDriving:
      return "no heading: drive faster than " + number(config.min_course_speed_m_s) + " m/s for " +
             whole(config.course_window_s + config.confirming_s) + " s, or set_heading";
    case Lacking::kCourse:
      return "no heading yet: drive on for " + more;
    case Lacking::kGear:
      return "no heading: forward or in reverse? speed up, turn, or drive faster than " +
             number(config.max_reverse_speed_m_s) + " m/s";
    case Lacking::kAgreement:
      return "no heading: course and IMU do not agree, drive on straight";
  }
  return "";
}

std::int64_t pack_alignment_need(const AlignmentNeed& need) {
  const double seconds = std::ceil(std::clamp(need.seconds, 0.0, kMostSeconds));
  return static_cast<std::int64_t>(need.lacking) + kKinds * static_cast<std::int64_t>(seconds);
}

AlignmentNeed unpack_alignment_need(std::int64_t number) {
  return {static_cast<Lacking>(number % kKinds), static_cast<double>(number / kKinds)};
}

}  // namespace leonav
