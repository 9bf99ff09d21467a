// The EnvelopeLine ties a sender's clock to the host's clock by the arrivals of its messages.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

namespace leonav {

// A message that was sent when the sender's clock showed x arrives at y = x + offset + drift x +
// delay. The delay is never below the least one of the way, while the host, an adapter's buffer or
// the network may add any amount. So the earliest arrivals carry the information, and the line is
// the highest one below all of them: of all lines with no arrival before them, the one with the
// least sum of distances. It is an edge of the lower convex hull of the points, the one over their
// mean time.
//
// Source: Moon, Skelly, Towsley: Estimation and removal of clock skew from network delay
// measurements, INFOCOM 1999.
//
// Only the earliest arrival of each second is kept, for a minute. Where five seconds in a row (two,
// if they are earlier by 50 ms or later by two seconds, which no queue does) contradict the line in
// the same sense, one of the two clocks has stepped: the line begins anew with them, and the step
// is counted. So it does where the sender's clock leaps by years and stays there, as when a sensor
// learns the date. A second whose clock is not later than the last one's, as from two sensors on
// one wire, is left out; before there is a line, the points begin anew with it.
class EnvelopeLine {
 public:
  static constexpr std::size_t kWindow = 60;      // seconds
  static constexpr std::size_t kSlopeAfter = 10;  // seconds from which on the drift is estimated
  static constexpr std::size_t kReadyAfter = 5;   // seconds; before, one of them decides too much
  static constexpr double kMaxDrift = 500e-6;     // a sensor without a crystal drifts more
  static constexpr std::int64_t kEarly_ns = 50'000'000;    // no arrival is so far before the line
  static constexpr std::int64_t kLate_ns = 2'000'000'000;  // nor so far behind it

  // Takes a message sent at `clock_ns` of the sender's clock that arrived at `arrival_ns`.
  // Precondition: both are within +-4.7e18 ns (149 years), so that differences do not overflow.
  void add(std::int64_t clock_ns, std::int64_t arrival_ns);

  bool is_ready() const { return is_ready_; }
  // Precondition of these: is_ready().
  std::int64_t arrival_ns(std::int64_t clock_ns) const;  // the earliest one possible
  std::int64_t clock_ns(std::int64_t arrival_ns) const;  // the inverse
  // Whether a message with these times can belong to the clock that the line describes.
  bool agrees(std::int64_t clock_ns, std::int64_t arrival_ns) const;

  // Root mean square of the distances of the seconds' earliest arrivals from the line, s. By so
  // much a clock may differ that follows the line; the least delay of the way is not in it.
  double sigma_s() const { return sigma_s_; }
  double drift() const { return slope_; }  // of the host's clock against the sender's
  std::uint64_t steps() const { return steps_; }
  double last_step_s() const { return last_step_s_; }  // arrivals later by so much than before
  // Seconds whose clock was not later than the last one's.
  std::uint64_t setbacks() const { return setbacks_; }

 private:
  struct Point {
    double x_ns;      // the sender's clock since the origin
    double delay_ns;  // arrival since the origin - x
  };
  bool is_far(std::int64_t clock_ns) const;
  void close_second();
  void follow_step();
  void fit();
  double delay_at(double x_ns) const { return offset_ns_ + slope_ * x_ns; }

  std::int64_t clock_origin_ns_ = 0, arrival_origin_ns_ = 0;
  bool has_origin_ = false, is_ready_ = false;
  std::int64_t second_ = 0;        // the one that is open
  std::optional<Point> earliest_;  // of that second
  std::deque<Point> points_;       // of the window, in order of x
  std::deque<Point> odd_;          // of the last seconds, which contradict the line
  int far_ = 0;                    // messages in a row whose clock is years away
  double offset_ns_ = 0.0, slope_ = 0.0, sigma_s_ = 0.0;
  std::uint64_t steps_ = 0;
  double last_step_s_ = 0.0;
  std::uint64_t setbacks_ = 0;
};

}  // namespace leonav
