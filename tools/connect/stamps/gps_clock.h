// The GpsClock gives the GPS time of arrivals.
#pragma once
#include <cstdint>
#include <optional>

#include "core/base/gps_time.h"
#include "tools/connect/stamps/envelope_line.h"

namespace leonav {

// What the host's time of arrival is tied to GPS time by.
enum class TimeReference : std::uint8_t {
  kGnss,  // the arrivals of a receiver's epochs
  kHost,  // the host's wall clock, which something else keeps at UTC (PTP, chrony with a pulse)
};

class GpsClock {
 public:
  // `latency_s`: from an epoch's time to the arrival of its last byte, at the least.
  GpsClock(TimeReference reference, double latency_s)
      : reference_(reference), latency_s_(latency_s) {}

  // Takes the time of a receiver's epoch and its arrival; of use with TimeReference::kGnss.
  void on_epoch(GpsTime time, std::int64_t arrival_ns);
  // The GPS time at which the ArrivalClock shows `arrival_ns`; nullopt: not known yet. By the
  // host's clock, UTC is taken as it was at the first arrival asked for: the ArrivalClock counts on
  // over a leap second, so the seconds between both times stay what they were.
  std::optional<GpsTime> at(std::int64_t arrival_ns) const;
  bool is_known() const { return reference_ == TimeReference::kHost || line_.is_ready(); }
  // 1 sigma, s, as far as the arrivals tell it; a wrong `latency_s` is not in it.
  double sigma_s() const { return reference_ == TimeReference::kGnss ? line_.sigma_s() : 0.0; }
  std::uint64_t steps() const { return line_.steps(); }

 private:
  TimeReference reference_;
  double latency_s_;
  EnvelopeLine line_;                           // from GPS time to arrival
  mutable std::optional<int> gps_minus_utc_s_;  // of the host's clock, once it was asked for
};

}  // namespace leonav
