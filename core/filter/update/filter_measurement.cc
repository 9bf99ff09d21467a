#include "core/filter/update/filter_measurement.h"

namespace leonav {

using ekf_index::kSize;

double predicted_variance(const FilterMeasurement& measurement, const EkfCovariance& covariance) {
  const auto core = covariance.topLeftCorner<kSize, kSize>();
  double variance = measurement.row.dot(core * measurement.row);
  if (measurement.ambiguity >= 0) {
    variance += 2.0 * covariance.col(measurement.ambiguity).head<kSize>().dot(measurement.row) +
                covariance(measurement.ambiguity, measurement.ambiguity);
  }
  return variance;
}

}  // namespace leonav
