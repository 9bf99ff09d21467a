#include "tools/connect/stamps/gps_clock.h"

#include "core/base/calendar.h"

namespace leonav {
namespace {

constexpr std::int64_t kGpsEpochSince1970_s = 315'964'800;

}  // namespace

void GpsClock::on_epoch(GpsTime time, std::int64_t arrival_ns) {
  if (reference_ == TimeReference::kGnss) line_.add(time.nanoseconds(), arrival_ns);
}

std::optional<GpsTime> GpsClock::at(std::int64_t arrival_ns) const {
  if (reference_ == TimeReference::kHost) {
    const GpsTime utc =
        GpsTime::from_nanoseconds(arrival_ns - kGpsEpochSince1970_s * kNanosecondsPerSecond);
    if (!gps_minus_utc_s_) {
      gps_minus_utc_s_ = leap_seconds(gps_from_utc(utc));
    }
    return utc.plus_seconds(*gps_minus_utc_s_);
  }
  if (!line_.is_ready()) return std::nullopt;
  return GpsTime::from_nanoseconds(line_.clock_ns(arrival_ns)).plus_seconds(latency_s_);
}

}  // namespace leonav
