#include "tools/connect/stamps/gps_clock.h"

namespace leonav {
namespace {

// From an epoch's time to its arrival, s: a receiver across a network may take seconds.
constexpr double kLeastDelay_s = -0.1, kLargestDelay_s = 5.0;

}  // namespace

void GpsClock::on_epoch(GpsTime time, std::int64_t arrival_ns) {
  if (reference_ == TimeReference::kGnss) {
    line_.add(time.nanoseconds(), arrival_ns);
  } else {
    host_minus_epoch_s_ = seconds_between(host_.at(arrival_ns), time);
  }
}

std::optional<GpsTime> GpsClock::at(std::int64_t arrival_ns) const {
  if (reference_ == TimeReference::kHost) return host_.at(arrival_ns);
  if (!line_.is_ready()) return std::nullopt;
  return GpsTime::from_nanoseconds(line_.clock_ns(arrival_ns)).plus_seconds(latency_s_);
}

std::optional<double> GpsClock::host_error_s() const {
  if (host_minus_epoch_s_ >= kLeastDelay_s && host_minus_epoch_s_ <= kLargestDelay_s) {
    return std::nullopt;
  }
  return host_minus_epoch_s_;
}

}  // namespace leonav
