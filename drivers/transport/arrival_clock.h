// The ArrivalClock tells when bytes arrived: it never steps, and is comparable between streams.
#pragma once
#include <chrono>
#include <cstdint>

namespace leonav {

// It shows the host's wall clock as it was when the object was made, and goes on from there by the
// steady clock. A step of the wall clock therefore changes nothing.
class ArrivalClock {
 public:
  using Steady = std::chrono::steady_clock;

  std::int64_t now_ns() const { return at_ns(Steady::now()); }  // since 1970, UTC
  std::int64_t at_ns(Steady::time_point time) const {
    return wall_ns_ + std::chrono::nanoseconds(time - steady_).count();
  }

 private:
  Steady::time_point steady_ = Steady::now();
  std::int64_t wall_ns_ =
      std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
};

}  // namespace leonav
