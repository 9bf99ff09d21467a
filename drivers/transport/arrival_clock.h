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

  ArrivalClock() : begin_(read_clocks()) {}

  std::int64_t now_ns() const { return at_ns(Steady::now()); }  // since 1970, UTC
  std::int64_t at_ns(Steady::time_point time) const {
    return begin_.wall_ns + std::chrono::nanoseconds(time - begin_.steady).count();
  }
  // How far the wall clock is ahead of this clock now: by how much it was set since the beginning.
  std::int64_t wall_lead_ns() const {
    const TwoClocks now = read_clocks();
    return now.wall_ns - at_ns(now.steady);
  }

 private:
  struct TwoClocks {
    Steady::time_point steady;
    std::int64_t wall_ns = 0;  // at that time
  };

  // Of some readings it is the one that no other process has interrupted for long.
  static TwoClocks read_clocks() {
    TwoClocks best;
    Steady::duration shortest = Steady::duration::max();
    for (int k = 0; k < 3; ++k) {
      const Steady::time_point before = Steady::now();
      const std::chrono::nanoseconds wall = std::chrono::system_clock::now().time_since_epoch();
      const Steady::duration took = Steady::now() - before;
      if (took >= shortest) continue;
      shortest = took;
      best = {before + took / 2, wall.count()};
    }
    return best;
  }

  TwoClocks begin_;
};

}  // namespace leonav
