#include "tools/connect/stamps/imu_sampler.h"

#include <algorithm>
#include <cmath>

namespace leonav {
namespace {

// What the service takes: docs/operations/channels.md.
constexpr double kMaxRate_rad_s = 35.0, kMaxForce_m_s2 = 500.0;
constexpr std::int64_t kMaxInterval_ns = 100'000'000;
// A clock that was set back further than this has stepped: order begins anew.
constexpr std::int64_t kStepBack_ns = 1'000'000'000;

bool is_possible(const ImuSample& sample) {
  const double interval_s = sample.interval_s();
  return sample.interval_ns > 0 && sample.interval_ns <= kMaxInterval_ns &&
         sample.delta_theta_b.cwiseAbs().maxCoeff() <= kMaxRate_rad_s * interval_s &&
         sample.delta_velocity_b.cwiseAbs().maxCoeff() <= kMaxForce_m_s2 * interval_s;
}

}  // namespace

std::optional<ImuSample> ImuSampler::sample(GpsTime time, const ImuReading& reading) {
  const std::int64_t since_last_ns = nanoseconds_between(time, last_);
  if (last_.is_set() && since_last_ns <= 0 && since_last_ns > -kStepBack_ns) {
    ++counters_.out_of_order;
    return std::nullopt;
  }
  ImuSample sample;
  sample.time = time;
  const std::optional<std::int64_t> interval_ns =
      interval_to(time, reading.are_increments ? kGapIntervalsOfIncrements : kGapIntervals);
  last_ = time;
  if (reading.interval_s) {
    if (!(*reading.interval_s > 0.0 && *reading.interval_s < 1.0)) {
      ++counters_.impossible;
      return std::nullopt;
    }
    sample.interval_ns = std::llround(*reading.interval_s * 1e9);
  } else if (interval_ns) {
    sample.interval_ns = *interval_ns;
  } else {
    ++counters_.without_interval;
    return std::nullopt;
  }
  const double scale = reading.are_increments ? 1.0 : sample.interval_s();
  sample.delta_theta_b = reading.gyro * scale;
  sample.delta_velocity_b = reading.accel * scale;
  if (!is_possible(sample)) {
    ++counters_.impossible;
    return std::nullopt;
  }
  return sample;
}

// The time since the last reading, or the usual interval after a gap.
std::optional<std::int64_t> ImuSampler::interval_to(GpsTime time, double gap_intervals) {
  if (!last_.is_set()) return std::nullopt;
  const std::int64_t interval_ns = nanoseconds_between(time, last_);
  const bool has_usual = intervals_ > 0;
  if (interval_ns <= 0 || interval_ns > kMaxInterval_ns) {
    ++counters_.gaps;
    return has_usual ? std::optional(usual_interval_ns()) : std::nullopt;
  }
  const std::int64_t usual_ns = has_usual ? usual_interval_ns() : interval_ns;
  intervals_ns_[intervals_++ % kKept] = interval_ns;
  if (static_cast<double>(interval_ns) <= gap_intervals * static_cast<double>(usual_ns)) {
    return interval_ns;
  }
  ++counters_.gaps;
  return usual_ns;
}

std::int64_t ImuSampler::usual_interval_ns() const {
  auto kept = intervals_ns_;
  const auto end = kept.begin() + static_cast<std::ptrdiff_t>(std::min(intervals_, kKept));
  const auto middle = kept.begin() + (end - kept.begin()) / 2;
  std::nth_element(kept.begin(), middle, end);
  return *middle;
}

}  // namespace leonav
