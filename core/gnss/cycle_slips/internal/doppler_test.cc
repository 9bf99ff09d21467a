#include "core/gnss/cycle_slips/internal/doppler_test.h"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>

#include "core/base/capacity.h"
#include "core/base/median.h"
#include "core/gnss/measurement/weighting.h"

namespace leonav {
namespace {

using Values = boost::container::static_vector<double, kMaxSatellites>;
constexpr std::size_t kMinForMedian = 4;

double difference_m(const DopplerRow& row, std::size_t signal, double interval_s) {
  return row.carrier_change_m[signal] - row.mean_rate_m_s[signal] * interval_s;
}

}  // namespace

void test_doppler(const CycleSlipConfig& config, double interval_s, std::span<DopplerRow> rows) {
  Values values;
  for (const DopplerRow& row : rows) {
    const double value = difference_m(row, 0, interval_s);
    if (std::isfinite(value) && values.size() < values.capacity()) values.push_back(value);
  }
  double common = 0.0, scatter = 0.0;
  if (values.size() >= kMinForMedian) {
    common = median(values);
    for (double& value : values) value = std::abs(value - common);
    scatter = 1.4826 * median(values);
  }
  // The noise is that of the mean of two Dopplers; the trapezoidal rule misses a jerk times T^3 /
  // 12.
  const double noise = config.doppler_sigma_m_s * interval_s / std::sqrt(2.0);
  const double jerk = config.jerk_m_s3 * interval_s * interval_s * interval_s / 12.0;
  for (DopplerRow& row : rows) {
    const double model =
        std::hypot(noise * elevation_factor(row.elevation), jerk, config.carrier_sigma_m);
    const double limit = config.doppler_limit * std::max(model, scatter);
    for (std::size_t signal = 0; signal < 2; ++signal) {
      const double off = std::abs(difference_m(row, signal, interval_s) - common);
      if (off > limit && off > config.doppler_min_cycles * row.wavelength_m[signal]) {
        row.exceeds_limit = true;
      }
    }
  }
}

}  // namespace leonav
