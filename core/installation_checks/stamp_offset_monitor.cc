#include "core/installation_checks/stamp_offset_monitor.h"

#include <cmath>

namespace leonav {
namespace {

constexpr double kGpsMinusUtc = 18.0;  // GPS time minus UTC, since 2017
constexpr double kLeapWithin_s = 2.5;  // latencies, and leap seconds to come
constexpr double kLatency_s = 5.0;     // longer is no latency
constexpr double kSame_s = 1.5;        // batches of samples, epochs a second apart
constexpr int kMinStampEpochs = 5;
constexpr double kMin_s = 8.0;

}  // namespace

ConventionFinding stamp_finding(double imu_less_gnss_s) {
  const bool leap = std::abs(std::abs(imu_less_gnss_s) - kGpsMinusUtc) < kLeapWithin_s;
  return {leap ? Convention::kLeapSeconds : Convention::kStampOffset, imu_less_gnss_s};
}

ConventionFinding StampOffsetMonitor::add_epoch(GpsTime stamp) {
  const bool going = imu_.is_set() && samples_ > samples_at_epoch_;
  samples_at_epoch_ = samples_;
  const double step_s = last_epoch_.is_set() ? seconds_between(stamp, last_epoch_) : 0.0;
  last_epoch_ = stamp;
  const double offset_s = going ? seconds_between(imu_, stamp) : 0.0;
  const bool same = epochs_ > 0 && std::abs(offset_s - offset_s_) < kSame_s && step_s > 0.0;
  if (!(std::abs(offset_s) > kLatency_s) || !same) {
    epochs_ = std::abs(offset_s) > kLatency_s ? 1 : 0;
    offset_s_ = offset_s;
    since_s_ = 0.0;
    due_s_ = kMin_s;
    return {};
  }
  ++epochs_;
  since_s_ += step_s;
  if (epochs_ < kMinStampEpochs || since_s_ < due_s_) return {};
  due_s_ = since_s_ + kFoundAgain_s;
  return stamp_finding(offset_s_);
}

}  // namespace leonav
