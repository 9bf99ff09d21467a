#include "core/navigator/lock_out_watch.h"

#include <algorithm>

namespace leonav {
namespace {

constexpr double kLongest_s = 30.0;
constexpr double kLongestInterval_s = 10.0;  // three epochs at least, whatever their interval
constexpr double kLongestDetour_m = 100.0;
constexpr int kMinCodes = 2;

}  // namespace

bool LockOutWatch::add(const EkfUpdateResult& result, GpsTime time) {
  const double passed_s = last_.is_set() ? seconds_between(time, last_) : 0.0;
  last_ = time;
  const double interval_s = std::clamp(passed_s, 0.0, kLongestInterval_s);
  const auto most_rejected = [&](Observable observable) {
    const auto kind = static_cast<std::size_t>(observable);
    return 2 * result.rejected[kind] > result.offered[kind];
  };
  const auto code = static_cast<std::size_t>(Observable::kCode);
  if (result.offered[code] < kMinCodes) return false;
  if (!most_rejected(Observable::kCode)) {
    against_s_ = std::max(0.0, against_s_ - interval_s);
    return false;
  }
  const bool far = result.largest_rejected[code] > kLongestDetour_m;
  if (!far && !most_rejected(Observable::kDoppler)) return false;
  against_s_ += interval_s;
  if (against_s_ < kLongest_s) return false;
  reset();
  return true;
}

}  // namespace leonav
