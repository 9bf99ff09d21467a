// RetryWait tells how long to wait before a connection is tried again.
#pragma once
#include <algorithm>

namespace leonav {

// Bounds of one wait, s.
struct RetryBounds {
  double least_s = 0.0, most_s = 30.0;
};

// The wait doubles from half a second to half a minute, until reset() says that the connection
// works.
class RetryWait {
 public:
  static constexpr double kFirst_s = 0.5, kLongest_s = 30.0;

  double next_s(const RetryBounds& bounds = {}) {
    const double wait_s = std::clamp(wait_s_, bounds.least_s, bounds.most_s);
    wait_s_ = std::min(2.0 * wait_s_, kLongest_s);
    return wait_s;
  }
  void reset() { wait_s_ = kFirst_s; }

 private:
  double wait_s_ = kFirst_s;
};

}  // namespace leonav
