// The GpsClock gives the GPS time of arrivals.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "core/base/gps_time.h"
#include "tools/connect/stamps/envelope_line.h"
#include "tools/connect/stamps/host_clock.h"

namespace leonav {

// What the host's time of arrival is tied to GPS time by.
enum class TimeReference : std::uint8_t {
  kGnss,  // the arrivals of a receiver's epochs
  kHost,  // the host's wall clock, which something else keeps at UTC (PTP, chrony with a pulse)
};

class GpsClock {
 public:
  // `latency_s`: from an epoch's time to the arrival of its last byte, at the least. `begin_ns`: as
  // of HostClock. `host_is_unsynchronised`: HostClock::is_unsynchronised; none: nobody knows.
  GpsClock(TimeReference reference, double latency_s, std::int64_t begin_ns = HostClock::wall_ns(),
           std::function<bool()> host_is_unsynchronised = {})
      : reference_(reference),
        latency_s_(latency_s),
        host_is_unsynchronised_(std::move(host_is_unsynchronised)),
        host_(begin_ns) {}

  // Takes the time of a receiver's epoch and its arrival; of use with TimeReference::kGnss.
  void on_epoch(GpsTime time, std::int64_t arrival_ns);
  // The GPS time at which the ArrivalClock shows `arrival_ns`; nullopt: not known yet.
  std::optional<GpsTime> at(std::int64_t arrival_ns) const;
  // The same by the host's clock, whatever the reference is; it may be wrong by any time.
  GpsTime by_host(std::int64_t arrival_ns) const { return host_.at(arrival_ns); }
  // As HostClock::compare().
  std::optional<double> compare_host(std::int64_t wall_ns, std::int64_t arrival_ns);
  // Takes a full time, within hours of the arrival, that does not come from the host's clock.
  void confirm_host(GpsTime time, std::int64_t arrival_ns);
  // Whether such a time has shown that by_host() is right by three days, since it was last set.
  bool host_week_is_confirmed() const { return host_week_is_confirmed_; }
  bool host_is_unsynchronised() const {
    return host_is_unsynchronised_ && host_is_unsynchronised_();
  }
  bool is_known() const { return reference_ == TimeReference::kHost || line_.is_ready(); }
  // 1 sigma, s, as far as the arrivals tell it; a wrong `latency_s` is not in it.
  double sigma_s() const { return reference_ == TimeReference::kGnss ? line_.sigma_s() : 0.0; }
  std::uint64_t steps() const { return line_.steps(); }
  bool host_is_reference() const { return reference_ == TimeReference::kHost; }
  // Of a host's clock that is the reference.
  std::uint64_t host_steps() const {
    return reference_ == TimeReference::kHost ? host_.steps() : 0;
  }
  double last_host_step_s() const { return host_.last_step_s(); }
  // With TimeReference::kHost, to be called about once a second: compares the host's clock with the
  // epochs that have come since the last call.
  void look_at_epochs();
  // How far the host's clock is ahead of a receiver's epochs, s, where no delay explains it. One
  // late epoch is none: HostClock::kComparisons looks in a row must have found it.
  std::optional<double> host_error_s() const;

 private:
  TimeReference reference_;
  double latency_s_;
  std::function<bool()> host_is_unsynchronised_;
  bool host_week_is_confirmed_ = false;
  EnvelopeLine line_;  // from GPS time to arrival
  HostClock host_;
  std::optional<double> new_delay_s_;  // the least of the epochs since the last look
  double delay_s_ = 0.0;               // the same at the last look that had epochs
  int looks_off_ = 0;                  // in a row, that no delay explains
};

}  // namespace leonav
