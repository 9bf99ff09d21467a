// FaultDirections tells where the error of one satellite moves the filter's state.
#pragma once
#include <Eigen/Cholesky>

#include "core/filter/update/filter_measurement.h"

namespace leonav {

// The changes of the state by errors of the carriers of one update. Position and clocks change as
// in a least-squares fit to all carriers,
//   x = (sum h h^T / s^2)^-1 h_k / s_k^2
// and every ambiguity by -h x, so that no carrier shows the change: only codes do. `faulty` is the
// index of a carrier in `measurements`, which must outlive this.
class FaultDirections {
 public:
  explicit FaultDirections(const FilterMeasurements& measurements);

  // Returns the change of the position by an error of one metre, ECEF.
  Eigen::Vector3d position_e(std::size_t faulty) const;
  // Returns that of the whole state, whose size is `size`.
  EkfCorrection state(std::size_t faulty, Eigen::Index size) const;

 private:
  static constexpr int kSize = 3 + static_cast<int>(kMaxSystemTimes);
  using Geometry = Eigen::Matrix<double, kSize, 1>;

  static Geometry geometry_of(const FilterMeasurement& measurement);
  Geometry fitted(std::size_t faulty) const;

  const FilterMeasurements& measurements_;
  Eigen::LDLT<Eigen::Matrix<double, kSize, kSize>> information_;
};

}  // namespace leonav
