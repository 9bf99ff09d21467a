#include "tools/import/service_choice.h"

#include <algorithm>
#include <cmath>

namespace leonav {

// A time that has stepped ends every run of states.
bool ServiceChoice::is_live(const Times& times, GpsTime now) const {
  return times.last.is_set() && std::abs(seconds_between(now, times.last)) <= options_.fallback_s;
}

std::optional<ServiceChoice::Change> ServiceChoice::note(const ServiceId& id, GpsTime now) {
  Times& own = times_[id];
  if (!is_live(own, now)) own.since = now;
  own.last = now;
  if (in_use_ == id) return std::nullopt;
  Change change{in_use_, id, 0.0};
  if (in_use_) {
    const Times& used = times_[*in_use_];
    if (is_live(used, now)) {
      const bool has_come_back =
          id < *in_use_ && seconds_between(now, own.since) >= options_.return_s;
      if (!has_come_back) return std::nullopt;
    } else {
      const auto best = std::find_if(times_.begin(), times_.end(),
                                     [&](const auto& one) { return is_live(one.second, now); });
      change.to = best->first;  // at the least the one that has just come
    }
    change.pause_s = seconds_between(now, used.last);
  }
  in_use_ = change.to;
  return change;
}

}  // namespace leonav
