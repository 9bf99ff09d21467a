// Constraints on the motion, in Ekf.
#include <cmath>

#include "core/filter/ekf.h"

namespace leonav {

MotionComponents Ekf::constrain(MotionMeasurements* measurements, double gate) {
  if (!initialized_ || !has_attitude_) return 0;
  EkfCorrection correction = EkfCorrection::Zero(covariance_.rows());
  const Eigen::Index known = state_.first_ambiguity();
  MotionComponents used = 0;
  for (MotionMeasurement& measurement : *measurements) {
    const auto h = measurement.row.head(known);
    const EkfCorrection spread = covariance_.leftCols(known) * h;
    const double variance = h.dot(spread.head(known)) + measurement.variance;
    const double innovation = measurement.residual - h.dot(correction.head(known));
    measurement.innovation = innovation;
    measurement.innovation_variance = variance;
    measurement.used = std::abs(innovation) < gate * std::sqrt(variance);
    if (!measurement.used) continue;
    used = static_cast<MotionComponents>(used | 1u << measurement.component);
    if (process_.continuous) {
      EkfCorrection row = EkfCorrection::Zero(covariance_.rows());
      row.head(known) = h;
      process_.condition(row, measurement.residual, measurement.variance);
    }
    const EkfCorrection gain = spread / variance;
    correction += innovation * gain;
    joseph_update(gain, spread, variance, &covariance_);
  }
  for (MotionMeasurement& measurement : *measurements)
    measurement.left =
        measurement.residual - measurement.row.head(known).dot(correction.head(known));
  if (used == 0) return 0;
  if (process_.continuous) process_.transition.rightCols<1>() -= correction;
  add(correction, true, &state_);
  return used;
}

}  // namespace leonav
