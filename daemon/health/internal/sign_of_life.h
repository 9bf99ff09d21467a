// A SignOfLife is a number that changes while a stream is alive.
#pragma once
#include <cstdint>
#include <limits>
#include <utility>

namespace leonav {

// So many intervals may pass without a sign of life, as until the answer counts as INS only.
inline constexpr double kIntervalsTolerated = 2.5;

class SignOfLife {
 public:
  explicit SignOfLife(double late_after_s,
                      double ended_after_s = std::numeric_limits<double>::infinity())
      : late_after_s_(late_after_s), ended_after_s_(ended_after_s) {}

  // `now_s`: of a clock that never goes back, 0 at construction.
  void look(std::int64_t number, double now_s) {
    if (std::exchange(number_, number) != number) changed_s_ = now_s;
    silence_s_ = now_s - changed_s_;
  }
  // At the last look.
  bool is_late() const { return silence_s_ > late_after_s_; }
  bool has_ended() const { return silence_s_ > ended_after_s_; }

 private:
  double late_after_s_, ended_after_s_;
  std::int64_t number_ = 0;
  double changed_s_ = 0.0;  // when the number was last seen to change
  double silence_s_ = 0.0;
};

}  // namespace leonav
