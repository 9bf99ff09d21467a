#include "core/vehicle/internal/odometer_aiding.h"

#include <cmath>

namespace leonav {
namespace {

constexpr double kStillAfter_s = 1.0;  // the IMU must be static for as long
constexpr double kSignSigmas = 4.0;

// Sum of all increments that are taken at one instant.
struct Sum {
  double counted_m = 0.0, way_m = 0.0, seconds = 0.0;  // by the odometer, by the filter
  bool sign_known = true;
  int pieces = 0;  // where one piece ends as the next begins, they share the pulse's edge
  GpsTime end;

  void add(const OdometerIncrement& increment, double filter_way_m) {
    const auto apart_ns = increment.start().nanoseconds() - end.nanoseconds();
    if (pieces == 0 || std::abs(apart_ns) > increment.interval_ns / 4) ++pieces;
    end = increment.time;
    counted_m += increment.distance_m;
    way_m += filter_way_m;
    seconds += increment.interval_s();
    sign_known = sign_known && increment.sign_known;
  }
};

}  // namespace

void OdometerAiding::add(std::span<const OdometerIncrement> increments) {
  for (const OdometerIncrement& increment : increments) waiting_.push_back(increment);
  received_ = received_ || !increments.empty();
}

void OdometerAiding::reset() {
  speeds_.clear();
  waiting_.clear();
  last_moved_ = GpsTime();
}

SpeedHistory* OdometerAiding::follow(const Ekf& ekf) {
  if (!received_) return nullptr;
  if (!ekf.initialized() || !ekf.has_attitude()) {
    speeds_.clear();
    return nullptr;
  }
  speeds_.correct(ekf.filter_state(), ekf.body().measured_rate_b);
  return &speeds_;
}

OdometerSpeed OdometerAiding::take(GpsTime now, double speed_sigma) {
  Sum sum;
  for (; !waiting_.empty() && waiting_.front().time <= now; waiting_.pop_front()) {
    const OdometerIncrement& increment = waiting_.front();
    if (increment.distance_m != 0.0) last_moved_ = increment.time;
    const auto way_m = speeds_.distance(increment.start(), increment.time);
    if (way_m) sum.add(increment, *way_m);
  }
  OdometerSpeed speed;
  if (!(sum.seconds > 0.0)) return speed;
  const double mean = sum.way_m / sum.seconds;
  if (!sum.sign_known && sum.counted_m != 0.0) {
    if (!(std::abs(mean) > kSignSigmas * speed_sigma)) return speed;
    sum.counted_m = std::copysign(sum.counted_m, mean);
  }
  speed.known = true;
  speed.mean_m_s = sum.counted_m / sum.seconds;
  speed.change_m_s = speeds_.last() - mean;
  // Each end of a piece has an error that is uniform over one pulse: variance pulse^2 / 12 per end.
  const double pulse = config_.odometer_resolution / sum.seconds;
  speed.variance = sum.pieces * pulse * pulse / 6.0;
  return speed;
}

bool OdometerAiding::moved(GpsTime now) const {
  return last_moved_.is_set() && seconds_between(now, last_moved_) < kStillAfter_s;
}

}  // namespace leonav
