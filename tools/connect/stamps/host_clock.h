// The HostClock gives the GPS time of arrivals by the host's wall clock, and follows its steps.
#pragma once
#include <cstdint>
#include <optional>

#include "core/base/gps_time.h"

struct timex;

namespace leonav {

// The ArrivalClock goes on from the wall clock of its beginning. What sets the wall clock later
// (chrony or PTP after a start of the machine) is seen by comparing both. Leap seconds change
// nothing: the ArrivalClock counts on over them, as GPS time does.
class HostClock {
 public:
  // Differences up to this are those of reading two clocks, s.
  static constexpr double kTolerance_s = 0.002;
  // So many comparisons in a row with the same difference are a step: more than there can be in an
  // inserted second and in the one behind, which UTC does not tell apart.
  static constexpr int kComparisons = 3;

  // `begin_ns`: a time of the ArrivalClock. Of it are the leap seconds that are counted.
  explicit HostClock(std::int64_t begin_ns);
  // The wall clock, since 1970, UTC.
  static std::int64_t wall_ns();
  // Whether the kernel knows no bound of the wall clock's error: no time service has set the clock,
  // or the last one is gone for some nine hours. False where the kernel does not say. `ask` is
  // adjtimex(2).
  static bool is_unsynchronised(int (*ask)(timex*));
  static bool is_unsynchronised();

  // The GPS time at which the ArrivalClock shows `arrival_ns`.
  GpsTime at(std::int64_t arrival_ns) const {
    return GpsTime::from_nanoseconds(arrival_ns + gps_minus_arrival_ns_);
  }

  // To be called about once a second. `wall_ns`: the wall clock (since 1970, UTC) when the
  // ArrivalClock showed `arrival_ns`. Returns by how much at() has stepped, s, where it has.
  std::optional<double> compare(std::int64_t wall_ns, std::int64_t arrival_ns);

  std::uint64_t steps() const { return steps_; }
  double last_step_s() const { return last_step_s_; }

 private:
  std::int64_t gps_minus_arrival_ns_;
  int leap_seconds_ahead_ = 0;  // that the wall clock has had and the table of core does not know
  double difference_s_ = 0.0;   // at the last comparison
  int comparisons_ = 0;         // in a row with that difference
  std::uint64_t steps_ = 0;
  double last_step_s_ = 0.0;
};

}  // namespace leonav
