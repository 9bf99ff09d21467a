#include "tools/connect/stamps/gps_clock.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace leonav {
namespace {

// From an epoch's time to its arrival, s: a receiver across a network may take seconds.
constexpr double kLeastDelay_s = -0.1, kLargestDelay_s = 5.0;
// A time of week is completed with the right week where the host's clock is right by half a week.
constexpr double kRightDay_s = 3.0 * 86'400.0;

}  // namespace

void GpsClock::on_epoch(GpsTime time, std::int64_t arrival_ns) {
  if (reference_ == TimeReference::kGnss) {
    line_.add(time.nanoseconds(), arrival_ns);
  } else {
    const double delay_s = seconds_between(host_.at(arrival_ns), time);
    new_delay_s_ = std::min(new_delay_s_.value_or(delay_s), delay_s);
  }
}

std::optional<GpsTime> GpsClock::at(std::int64_t arrival_ns) const {
  if (reference_ == TimeReference::kHost) return host_.at(arrival_ns);
  if (!line_.is_ready()) return std::nullopt;
  return GpsTime::from_nanoseconds(line_.clock_ns(arrival_ns)).plus_seconds(latency_s_);
}

std::optional<double> GpsClock::compare_host(std::int64_t wall_ns, std::int64_t arrival_ns) {
  const std::optional<double> step_s = host_.compare(wall_ns, arrival_ns);
  if (step_s) host_week_is_confirmed_ = false;
  return step_s;
}

void GpsClock::confirm_host(GpsTime time, std::int64_t arrival_ns) {
  if (std::abs(seconds_between(time, host_.at(arrival_ns))) < kRightDay_s)
    host_week_is_confirmed_ = true;
}

void GpsClock::look_at_epochs() {
  if (!new_delay_s_) return;
  delay_s_ = *std::exchange(new_delay_s_, std::nullopt);
  const bool is_explained = delay_s_ >= kLeastDelay_s && delay_s_ <= kLargestDelay_s;
  looks_off_ = is_explained ? 0 : looks_off_ + 1;
}

std::optional<double> GpsClock::host_error_s() const {
  if (looks_off_ < HostClock::kComparisons) return std::nullopt;
  return delay_s_;
}

}  // namespace leonav
