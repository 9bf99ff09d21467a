#include "core/filter/update/fault_direction.h"

#include <Eigen/Cholesky>

namespace leonav {
namespace {

using namespace ekf_index;

constexpr Eigen::Index kClocks = static_cast<Eigen::Index>(kMaxSystemTimes);
// Of a clock that no carrier sees, m; it keeps the matrix regular.
constexpr double kPriorSigma_m = 1e3;

using Geometry = Eigen::Matrix<double, 3 + kClocks, 1>;

Geometry geometry_of(const FilterMeasurement& measurement) {
  Geometry h;
  h << measurement.row.segment<3>(kPosition), measurement.row.segment<kClocks>(kClock);
  return h;
}

}  // namespace

EkfCorrection fault_direction(const FilterMeasurements& measurements, std::size_t faulty,
                              Eigen::Index size) {
  Eigen::Matrix<double, 3 + kClocks, 3 + kClocks> information =
      Eigen::Matrix<double, 3 + kClocks, 3 + kClocks>::Identity() / (kPriorSigma_m * kPriorSigma_m);
  for (const FilterMeasurement& m : measurements) {
    if (m.observable != Observable::kCarrier) continue;
    const Geometry h = geometry_of(m);
    information += h * h.transpose() / m.variance;
  }
  const Geometry x =
      information.ldlt().solve(geometry_of(measurements[faulty]) / measurements[faulty].variance);
  EkfCorrection direction = EkfCorrection::Zero(size);
  direction.segment<3>(kPosition) = x.head<3>();
  direction.segment<kClocks>(kClock) = x.tail<kClocks>();
  for (const FilterMeasurement& m : measurements)
    if (m.ambiguity >= 0) direction(m.ambiguity) = -geometry_of(m).dot(x);
  return direction;
}

}  // namespace leonav
