#include "tools/connect/formats/outputs/product_pace.h"

namespace leonav {
namespace {

bool continues(GpsTime before, GpsTime shown) {
  const double step_s = seconds_between(shown, before);
  return step_s >= -ProductPace::kLate_s && step_s <= ProductPace::kGap_s;
}

}  // namespace

std::optional<double> ProductPace::advance(GpsTime shown) {
  if (!time_.is_set()) {
    time_ = shown;
    return kStep_s;
  }
  if (!continues(time_, shown)) {
    if (!is_set_to(shown)) return std::nullopt;
    time_ = shown;
    return kStep_s;
  }
  strange_calls_ = 0;
  const double step_s = seconds_between(shown, time_);
  if (step_s < kStep_s) return std::nullopt;
  time_ = shown;
  return step_s;
}

// Whether a time that is far away has gone on for long enough.
bool ProductPace::is_set_to(GpsTime shown) {
  if (strange_calls_ == 0 || !continues(strange_last_, shown)) {
    strange_begin_ = shown;
    strange_calls_ = 0;
  }
  strange_last_ = shown;
  ++strange_calls_;
  if (strange_calls_ < kStrangeCalls || seconds_between(shown, strange_begin_) < kStrange_s) {
    return false;
  }
  strange_calls_ = 0;
  return true;
}

}  // namespace leonav
