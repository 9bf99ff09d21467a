// The ImuSampler makes samples, which are increments over intervals, of stamped readings.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "core/inertial/strapdown/imu.h"
#include "tools/connect/stamps/imu_reading.h"

namespace leonav {

// What the sampler left out.
struct ImuSamplerCounters {
  std::uint64_t out_of_order = 0;  // not later than the reading before
  std::uint64_t without_interval =
      0;                         // the first of all, and those until the usual interval is known
  std::uint64_t impossible = 0;  // values or intervals that the service would refuse
  std::uint64_t gaps = 0;        // readings missing before one that was used
};

// Increments keep their own interval where the sensor gives one. Rates count as the mean over the
// time since the reading before. After a gap of more than 2.5 usual intervals a reading covers the
// usual one, the median of the last 31: what happened in the gap is not known. Increments without
// an interval of their own do so after 1.5 usual intervals: they never hold what a lost message
// held.
class ImuSampler {
 public:
  std::optional<ImuSample> sample(GpsTime time, const ImuReading& reading);
  const ImuSamplerCounters& counters() const { return counters_; }

 private:
  static constexpr std::size_t kKept = 31;
  static constexpr double kGapIntervals = 2.5, kGapIntervalsOfIncrements = 1.5;

  std::optional<std::int64_t> interval_to(GpsTime time, double gap_intervals);
  std::int64_t usual_interval_ns() const;

  GpsTime last_;
  std::array<std::int64_t, kKept> intervals_ns_{};
  std::size_t intervals_ = 0;  // ever taken
  ImuSamplerCounters counters_;
};

}  // namespace leonav
