// The PulseLine ties a sensor's clock to GPS time by pulses whose samples are known.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>

#include "core/base/gps_time.h"

namespace leonav {

// A sample whose clock shows c was taken at the GPS time T of its pulse, T = c + a + b c + e, with
// an error e of the receiver's measurement and of the clock's resolution. The line is that of least
// squares through the pulses of the last minute, one a second at the most:
//
//   sigma^2(c) = r^2 (1 + 1/n + (c - mean c)^2 / sum (c - mean c)^2) + s^2
//
// with r^2 the sum of squared residuals over n - 2 and s the root mean square of the receiver's own
// sigmas, which all pulses may have in common.
//
// A pulse that is off the line by more than five sigmas and 0.3 ms is odd. Five of them in a row in
// the same sense are a step of the sensor's clock: the line begins anew with them, and the step is
// counted.
class PulseLine {
 public:
  static constexpr std::size_t kWindow = 60;                // pulses
  static constexpr std::size_t kReadyAfter = 3;             // pulses
  static constexpr std::size_t kStepAfter = 5;              // pulses
  static constexpr double kMaxDrift = 500e-6;               // as of EnvelopeLine
  static constexpr std::int64_t kHold_ns = 60'000'000'000;  // without a pulse
  static constexpr std::int64_t kApart_ns = 900'000'000;    // pulses that count

  // Takes a pulse at `time` whose sample has `clock_ns`. One that is nearer than kApart_ns to the
  // one before, or not later, is left out.
  void add(std::int64_t clock_ns, GpsTime time, double sigma_s);
  // Forgets all pulses, but not the number of steps.
  void clear();

  bool is_ready() const { return points_.size() >= kReadyAfter; }
  // Whether the line holds at `clock_ns`: it is ready, and the last pulse was at most kHold_ns ago.
  bool holds_at(std::int64_t clock_ns) const;
  // Precondition of these: is_ready().
  GpsTime gps_time(std::int64_t clock_ns) const;
  double sigma_s(std::int64_t clock_ns) const;

  std::size_t pulses() const { return points_.size(); }
  double drift() const { return slope_; }  // of GPS time against the sensor's clock
  std::uint64_t steps() const { return steps_; }
  double last_step_s() const { return last_step_s_; }  // GPS time of a sample later by so much

 private:
  struct Point {
    double x_ns;     // the sensor's clock since the origin
    double y_ns;     // GPS time since the origin - x
    double sigma_s;  // of the receiver
  };
  void fit();
  double offset_at(double x_ns) const { return mean_y_ + slope_ * (x_ns - mean_x_); }
  void follow_step();

  bool has_origin_ = false;
  std::int64_t clock_origin_ns_ = 0;
  GpsTime gps_origin_;
  GpsTime last_;              // of the last pulse that counted
  std::deque<Point> points_;  // of the window, in order of time
  std::deque<Point> odd_;     // the last ones, which contradict the line
  double mean_x_ = 0.0, mean_y_ = 0.0, slope_ = 0.0;
  double spread_ = 0.0;  // sum of squared x - mean x
  double residual_s_ = 0.0, receiver_s_ = 0.0;
  std::uint64_t steps_ = 0;
  double last_step_s_ = 0.0;
};

}  // namespace leonav
