#include "core/filter/update/fault_directions.h"

namespace leonav {
namespace {

// Of a clock that no carrier sees, m; it keeps the matrix regular.
constexpr double kPriorSigma_m = 1e3;

}  // namespace

FaultDirections::FaultDirections(const FilterMeasurements& measurements)
    : measurements_(measurements) {
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  Matrix information = Matrix::Identity() / (kPriorSigma_m * kPriorSigma_m);
  for (const FilterMeasurement& m : measurements) {
    if (m.observable != Observable::kCarrier) continue;
    const Geometry h = geometry_of(m);
    information += h * h.transpose() / m.variance;
  }
  information_.compute(information);
}

FaultDirections::Geometry FaultDirections::geometry_of(const FilterMeasurement& measurement) {
  Geometry h;
  h << measurement.row.segment<3>(ekf_index::kPosition),
      measurement.row.segment<kSize - 3>(ekf_index::kClock);
  return h;
}

FaultDirections::Geometry FaultDirections::fitted(std::size_t faulty) const {
  return information_.solve(geometry_of(measurements_[faulty]) / measurements_[faulty].variance);
}

Eigen::Vector3d FaultDirections::position_e(std::size_t faulty) const {
  return fitted(faulty).head<3>();
}

EkfCorrection FaultDirections::state(std::size_t faulty, Eigen::Index size) const {
  const Geometry x = fitted(faulty);
  EkfCorrection direction = EkfCorrection::Zero(size);
  direction.segment<3>(ekf_index::kPosition) = x.head<3>();
  direction.segment<kSize - 3>(ekf_index::kClock) = x.tail<kSize - 3>();
  for (const FilterMeasurement& m : measurements_)
    if (m.ambiguity >= 0) direction(m.ambiguity) = -geometry_of(m).dot(x);
  return direction;
}

}  // namespace leonav
