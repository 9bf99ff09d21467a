#include "tools/connect/formats/outputs/ephemeris_repeater.h"

#include <cmath>

namespace leonav {

void EphemerisRepeater::remember(const Ephemeris& ephemeris, GpsTime now) {
  if (interval_s_ <= 0.0) return;
  sent_[{ephemeris.satellite, ephemeris.message}] = {ephemeris, now};
}

int EphemerisRepeater::repeat(GpsTime now) {
  int count = 0;
  for (auto one = sent_.begin(); one != sent_.end() && count < kMostAtOnce;) {
    Sent& sent = one->second;
    if (std::abs(seconds_between(now, sent.ephemeris.toe)) > kMaxAge_s) {
      one = sent_.erase(one);
      continue;
    }
    // A receiver whose time was set back must not silence what it sent before.
    if (std::abs(seconds_between(now, sent.last)) >= interval_s_) {
      sent.last = now;
      output_->send(sent.ephemeris);
      ++count;
    }
    ++one;
  }
  return count;
}

}  // namespace leonav
