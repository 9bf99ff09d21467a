#include "core/filter/update/internal/weighted_least_squares.h"

#include <algorithm>
#include <cmath>

namespace leonav {
namespace {

using ekf_index::kSize;

// Lower L with P = L L^T for a positive semidefinite P; a state without variance gets a zero
// column.
void semidefinite_cholesky(const EkfCovariance& P, EkfCovariance* root) {
  const Eigen::Index n = P.rows();
  EkfCovariance& L = *root;
  L.setZero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    if (P(j, j) <= 0.0) continue;
    const Eigen::Index below = n - j;
    auto column = L.col(j).tail(below);
    column = P.col(j).tail(below);
    column.noalias() -= L.block(j, 0, below, j) * L.row(j).head(j).transpose();
    // Rounding may eat a pivot of a nearly perfect correlation: it keeps a trace of its variance.
    const double pivot = std::sqrt(std::max(column(0), 1e-14 * P(j, j)));
    column(0) = pivot;
    column.tail(below - 1) /= pivot;
  }
}

}  // namespace

void WeightedLeastSquares::begin(const FilterMeasurements& measurements,
                                 const EkfCovariance& covariance) {
  states_ = covariance.rows();
  count_ = static_cast<Eigen::Index>(measurements.size());
  semidefinite_cholesky(covariance, &L_);
  for (Eigen::Index i = 0; i < count_; ++i) {
    const FilterMeasurement& measurement = measurements[static_cast<std::size_t>(i)];
    auto g = rows().col(i).head(states_);
    g.noalias() = L_.topRows<kSize>().transpose() * measurement.row;
    if (measurement.signal_state >= 0) g += L_.row(measurement.signal_state).transpose();
  }
}

void WeightedLeastSquares::solve(const FilterMeasurements& measurements) {
  information_.setIdentity(states_, states_);
  gradient_.setZero(states_);
  Eigen::Index used = 0;
  for (Eigen::Index i = 0; i < count_; ++i) {
    const FilterMeasurement& measurement = measurements[static_cast<std::size_t>(i)];
    if (measurement.factor <= 0.0) continue;
    const double weight = measurement.factor / measurement.gain_variance;
    const auto g = rows().col(i).head(states_);
    weighted().col(used++).head(states_) = std::sqrt(weight) * g;
    gradient_ += weight * measurement.innovation * g;
  }
  if (used > 0)
    information_.selfadjointView<Eigen::Lower>().rankUpdate(
        weighted().topLeftCorner(states_, used));
  root_.compute(information_);
  solution_ = gradient_;
  root_.solveInPlace(solution_);
}

void WeightedLeastSquares::standardize(const FilterMeasurements& measurements, Ratios* ratios) {
  auto solved = weighted().topLeftCorner(states_, count_);
  solved = rows().topLeftCorner(states_, count_);
  root_.matrixL().solveInPlace(solved);
  ratios->clear();
  for (Eigen::Index i = 0; i < count_; ++i) {
    const FilterMeasurement& measurement = measurements[static_cast<std::size_t>(i)];
    const double residual = measurement.innovation - rows().col(i).head(states_).dot(solution_);
    const double variance = solved.col(i).squaredNorm();  // of the prediction, this one included
    const double weight = measurement.factor / measurement.gain_variance;
    const double freedom = std::max(1.0 - weight * variance, 1e-12);
    const double sigma = std::sqrt(measurement.variance + variance / freedom);
    ratios->push_back(std::abs(residual) / freedom / sigma);
  }
}

double WeightedLeastSquares::nis(const FilterMeasurements& measurements) const {
  double nis = 0.0;
  for (const FilterMeasurement& measurement : measurements)
    nis += measurement.factor / measurement.gain_variance * measurement.innovation *
           measurement.innovation;
  return nis - gradient_.dot(solution_);
}

void WeightedLeastSquares::finish(EkfCorrection* correction, EkfCovariance* covariance) const {
  correction->noalias() = L_ * solution_;
  // W = L U^-T with U U^T the information; P+ = W W^T.
  EkfCovariance W_transposed = L_.transpose();
  root_.matrixL().solveInPlace(W_transposed);
  covariance->setZero();
  covariance->selfadjointView<Eigen::Lower>().rankUpdate(W_transposed.transpose());
  covariance->triangularView<Eigen::StrictlyUpper>() = covariance->transpose();
}

}  // namespace leonav
