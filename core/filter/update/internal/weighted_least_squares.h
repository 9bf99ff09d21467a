// WeightedLeastSquares solves one epoch's measurements and the prior as a weighted least-squares
// problem.
#pragma once
#include <Eigen/Cholesky>
#include <boost/container/static_vector.hpp>
#include <memory>

#include "core/filter/state/ekf_state.h"
#include "core/filter/update/filter_measurement.h"

namespace leonav {

// It works in the coordinates z = L^-1 x with P = L L^T, where the prior is the identity. The
// solution's covariance is P+ = L (I + L^T H^T R^-1 H L)^-1 L^T: like Joseph's form symmetric and
// positive semidefinite whatever the rounding, and states with zero variance stay untouched.
// (Bierman, Factorization Methods for Discrete Sequential Estimation, 1977, ch. 5.)
class WeightedLeastSquares {
 public:
  using Ratios = boost::container::static_vector<double, kMaxMeasurements>;

  void begin(const FilterMeasurements& measurements, const EkfCovariance& covariance);
  // Solves with the measurements' factors as they are now.
  void solve(const FilterMeasurements& measurements);
  // Writes |residual against all others| over its standard deviation, per measurement.
  void standardize(const FilterMeasurements& measurements, Ratios* ratios);
  // Returns the normalized innovation squared of all measurements together.
  double nis(const FilterMeasurements& measurements) const;
  void finish(EkfCorrection* correction, EkfCovariance* covariance) const;

 private:
  static constexpr int kTable = ekf_index::kMaxSize * static_cast<int>(kMaxMeasurements);
  using Rows =
      Eigen::Map<Eigen::Matrix<double, ekf_index::kMaxSize, static_cast<int>(kMaxMeasurements)>>;

  EkfCovariance L_;
  EkfCovariance information_;
  Eigen::LLT<EkfCovariance, Eigen::Lower> root_;
  EkfCorrection solution_, gradient_;
  // A column per measurement: its row times L, the same weighted, the same solved by the root.
  // Views, not members: a view's assignment would copy what it shows.
  Rows rows() const { return Rows(storage_.get()); }
  Rows weighted() const { return Rows(storage_.get() + kTable); }
  std::unique_ptr<double[]> storage_ = std::make_unique<double[]>(2 * kTable);
  Eigen::Index states_ = 0, count_ = 0;
};

}  // namespace leonav
