#include "core/filter/update/filter_measurement.h"

namespace leonav {

using ekf_index::kSize;

double error_variance(const FilterMeasurement& measurement, const EkfCovariance& covariance) {
  if (measurement.signal_state < 0 || measurement.observable == Observable::kCarrier)
    return measurement.variance;
  return measurement.variance + covariance(measurement.signal_state, measurement.signal_state);
}

double predicted_variance(const FilterMeasurement& measurement, const EkfCovariance& covariance) {
  const auto core = covariance.topLeftCorner<kSize, kSize>();
  double variance = measurement.row.dot(core * measurement.row);
  if (measurement.signal_state >= 0) {
    variance += 2.0 * covariance.col(measurement.signal_state).head<kSize>().dot(measurement.row) +
                covariance(measurement.signal_state, measurement.signal_state);
  }
  return variance;
}

}  // namespace leonav
