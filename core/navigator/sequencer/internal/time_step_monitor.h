// TimeStepMonitor distinguishes a stray time stamp from a clock that has been set.
#pragma once
#include <cstdint>

#include "core/base/gps_time.h"

namespace leonav {

// TimeStepMonitor follows the rejected stamps of one stream. A single wrong stamp changes nothing.
// A run of them, each a little later than the one before and with no accepted stamp between, is a
// new time. Messages may be repeated or swapped: a stamp that is not later, by up to
// kMaxDisorderNs, neither continues a run nor ends it.
class TimeStepMonitor {
 public:
  static constexpr std::int64_t kMaxDisorderNs = 1'000'000'000;

  // `run_to_accept` is the length of a run that is accepted, `max_step_ns` the longest step within
  // it.
  TimeStepMonitor(int run_to_accept, std::int64_t max_step_ns)
      : run_to_accept_(run_to_accept), max_step_ns_(max_step_ns) {}

  // Ends the run, because a stamp was accepted.
  void clear() { run_ = 0; }

  // Returns the number of stamps of the run so far, and the time from the first to the last of
  // them.
  int run() const { return run_; }
  std::int64_t run_ns() const { return run_ > 0 ? nanoseconds_between(last_, first_) : 0; }

  // Adds a stamp that does not fit. Returns true if it completes a run and is to be accepted.
  bool reject(GpsTime stamp) {
    const std::int64_t step = nanoseconds_between(stamp, last_);
    if (run_ > 0 && step <= 0 && step >= -kMaxDisorderNs) return run_ >= run_to_accept_;
    run_ = run_ > 0 && step > 0 && step <= max_step_ns_ ? run_ + 1 : 1;
    if (run_ == 1) first_ = stamp;
    last_ = stamp;
    return run_ >= run_to_accept_;
  }

 private:
  int run_to_accept_;
  std::int64_t max_step_ns_;
  int run_ = 0;
  GpsTime first_, last_;  // of the run
};

}  // namespace leonav
