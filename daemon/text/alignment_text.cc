#include "daemon/text/alignment_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace leonav {
namespace {

constexpr std::int64_t kKinds = 16;
constexpr double kMostSeconds = 1e6;

// As people write it: 2, 0.5.
void append(double value, AlignmentText* text) {
  char number[32];
  std::snprintf(number, sizeof number, "%.3g", value);
  text->append(number);
}

// In steps of a factor of about two, so that the text is not another one every second.
void append_at_most(double seconds, AlignmentText* text) {
  for (const double step : {2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0}) {
    if (seconds > step) continue;
    text->append("up to ");
    append(step, text);
    text->append(" s more");
    return;
  }
  text->append("more than 600 s more");
}

}  // namespace

AlignmentText to_text(const AlignmentNeed& need, const AlignmentConfig& config) {
  AlignmentText text;
  switch (need.lacking) {
    case Lacking::kNothing:
      break;
    case Lacking::kPosition:
      text = "no position";
      break;
    case Lacking::kLevelling:
      text = "no level yet: ";
      append_at_most(need.seconds, &text);
      text.append(" of specific force");
      break;
    case Lacking::kGravity:
      text = "no level yet: the IMU is shaken, or its specific force is not of gravity's length";
      break;
    case Lacking::kNorth:
      text = "standing: the gyros need ";
      append_at_most(need.seconds, &text);
      text.append(" to find north");
      break;
    case Lacking::kDriving:
      text = "no heading: drive faster than ";
      append(config.min_course_speed_m_s, &text);
      text.append(" m/s for ");
      append(std::ceil(std::max(0.0, config.course_window_s + config.confirming_s)), &text);
      text.append(" s, or set_heading");
      break;
    case Lacking::kCourse:
      text = "no heading yet: drive on for ";
      append_at_most(need.seconds, &text);
      break;
    case Lacking::kGear:
      text = "no heading: forward or in reverse? speed up, turn, or drive faster than ";
      append(config.max_reverse_speed_m_s, &text);
      text.append(" m/s");
      break;
    case Lacking::kAgreement:
      text = "no heading: course and IMU do not agree, drive on straight";
      break;
  }
  return text;
}

std::int64_t pack_alignment_need(const AlignmentNeed& need) {
  const double seconds = std::ceil(std::clamp(need.seconds, 0.0, kMostSeconds));
  return static_cast<std::int64_t>(need.lacking) + kKinds * static_cast<std::int64_t>(seconds);
}

AlignmentNeed unpack_alignment_need(std::int64_t number) {
  return {static_cast<Lacking>(number % kKinds), static_cast<double>(number / kKinds)};
}

}  // namespace leonav
