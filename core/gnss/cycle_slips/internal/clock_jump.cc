#include "core/gnss/cycle_slips/internal/clock_jump.h"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>

#include "core/base/capacity.h"

namespace leonav {
namespace {

// Bound on the multipath of a code, far below the 300 km of a millisecond.
constexpr double kCodeTolerance_m = 60.0;
// Bound on the range acceleration that the mean of two Dopplers misses: LEO overhead, or a car.
constexpr double kAccelerationTolerance_m_s2 = 2.0;
constexpr double kMinJump_m = 1000.0;
constexpr std::size_t kMinSatellites = 2;

using Values = boost::container::static_vector<double, kMaxSatellites>;

double median(Values values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median_absolute_deviation(Values values) {
  const double centre = median(values);
  for (double& value : values) value = std::abs(value - centre);
  return median(values);
}

struct Common {
  double value_m = 0.0;
  bool shared = false;  // by two thirds of the satellites
};

Common common_part(const Values& values, double tolerance_m) {
  Common common;
  if (values.size() < kMinSatellites) return common;
  common.value_m = median(values);
  std::size_t near = 0;
  for (const double value : values) {
    if (std::abs(value - common.value_m) <= tolerance_m) ++near;
  }
  common.shared = near >= kMinSatellites && 3 * near >= 2 * values.size();
  return common;
}

// Returns the whole milliseconds in `common`, or 0 where it is not near to a multiple.
int milliseconds(const Common& common, double tolerance_m) {
  if (!common.shared || std::abs(common.value_m) > 1.0e6 * kMillisecond_m) return 0;
  const double count = std::round(common.value_m / kMillisecond_m);
  return std::abs(common.value_m - count * kMillisecond_m) <= tolerance_m ? static_cast<int>(count)
                                                                          : 0;
}

Values carrier_minus_doppler(std::span<const ClockJumpSample> samples, double interval_s) {
  Values values;
  for (const ClockJumpSample& sample : samples) {
    const double value = sample.carrier_change_m - sample.mean_rate_m_s * interval_s;
    if (std::isfinite(value) && values.size() < values.capacity()) values.push_back(value);
  }
  return values;
}

// A jump of the tag alone appears as a range rate times a millisecond, different for each
// satellite.
int tag_jump_ms(std::span<const ClockJumpSample> samples, double interval_s, double nominal_s) {
  if (!(nominal_s > 0.0)) return 0;
  const double steps = std::max(1.0, std::round(interval_s / nominal_s));
  const double excess_ms = (interval_s - steps * nominal_s) * 1e3;
  const double count = std::round(excess_ms);
  constexpr double kTagTolerance_ms = 0.05;
  if (count == 0.0 || std::abs(excess_ms - count) > kTagTolerance_ms) return 0;
  const Values as_tagged = carrier_minus_doppler(samples, interval_s);
  if (as_tagged.size() < 4) return 0;
  const Values without = carrier_minus_doppler(samples, interval_s - count * 1e-3);
  return median_absolute_deviation(without) < 0.5 * median_absolute_deviation(as_tagged)
             ? static_cast<int>(count)
             : 0;
}

}  // namespace

ClockJump find_clock_jump(std::span<const ClockJumpSample> samples, double interval_s,
                          double nominal_interval_s) {
  ClockJump jump;
  if (!(interval_s > 0.0 && interval_s <= kMaxJumpInterval_s)) return jump;
  Values code_minus_carrier;
  for (const ClockJumpSample& sample : samples) {
    const double value = sample.code_change_m - sample.carrier_change_m;
    if (std::isfinite(value) && code_minus_carrier.size() < code_minus_carrier.capacity())
      code_minus_carrier.push_back(value);
  }
  const Common code = common_part(code_minus_carrier, kCodeTolerance_m);
  const int code_against_carrier = milliseconds(code, kCodeTolerance_m);
  jump.unrepairable =
      code.shared && code_against_carrier == 0 && std::abs(code.value_m) > kMinJump_m;

  const double tolerance_m =
      kCodeTolerance_m + kAccelerationTolerance_m_s2 * interval_s * interval_s;
  const Common carrier = common_part(carrier_minus_doppler(samples, interval_s), tolerance_m);
  jump.carrier_ms = milliseconds(carrier, tolerance_m);
  jump.code_ms = jump.carrier_ms + code_against_carrier;
  jump.tag_ms = tag_jump_ms(samples, interval_s - jump.code_ms * 1e-3, nominal_interval_s);
  return jump;
}

double true_interval_s(const ClockJump& jump, double interval_s) {
  return interval_s - 1e-3 * (jump.code_ms + jump.tag_ms);
}

}  // namespace leonav
