// A PulseMark is the GPS time at which a receiver saw a pulse of an inertial sensor, and the
// PulseQueue hands marks from the receiver's stream to the sensor's.
#pragma once
#include <cstddef>
#include <deque>
#include <optional>

#include "core/base/gps_time.h"

namespace leonav {

struct PulseMark {
  GpsTime time;          // of the sample that the pulse belongs to
  double sigma_s = 0.0;  // 1 sigma, as the receiver estimates it
};

// Marks that nobody takes are dropped, the oldest first.
class PulseQueue {
 public:
  static constexpr std::size_t kCapacity = 256;

  void push(const PulseMark& mark) {
    if (marks_.size() == kCapacity) marks_.pop_front();
    marks_.push_back(mark);
  }
  std::optional<PulseMark> pop() {
    if (marks_.empty()) return std::nullopt;
    const PulseMark mark = marks_.front();
    marks_.pop_front();
    return mark;
  }

 private:
  std::deque<PulseMark> marks_;
};

}  // namespace leonav
