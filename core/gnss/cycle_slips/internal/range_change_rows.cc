#include "core/gnss/cycle_slips/internal/range_change_rows.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace leonav {
namespace {

// Sigma of an unknown without a prior: far beyond any motion between two epochs, and close enough
// to the noise of a carrier for the arithmetic.
constexpr double kFree_m = 1.0e4;

Eigen::Matrix3d square_root(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

bool is_usable(const RangeChangeRow& row) {
  return row.direction.allFinite() && row.direction_change.allFinite() &&
         std::isfinite(row.residual_m) && std::isfinite(row.sigma_m) && row.sigma_m > 0.0 &&
         row.system_time >= 0 && row.system_time < static_cast<int>(kMaxSystemTimes);
}

}  // namespace

ChangeRows scaled_rows(std::span<const RangeChangeRow> rows, const RangeChangePrior& prior,
                       const CycleSlipConfig& config) {
  ChangeRows scaled;
  const bool free = prior.change_is_free || !prior.change_covariance.allFinite();
  scaled.change_root = free ? Eigen::Matrix3d(kFree_m * Eigen::Matrix3d::Identity())
                            : square_root(prior.change_covariance);
  scaled.clock_unit_m = kFree_m;
  const Eigen::Matrix3d position_root = prior.position_covariance.allFinite()
                                            ? square_root(prior.position_covariance)
                                            : Eigen::Matrix3d::Zero();
  std::array<int, kMaxSystemTimes> unknown_of_system;
  unknown_of_system.fill(-1);
  boost::container::static_vector<double, kMaxSatellites> residuals;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!is_usable(rows[i])) continue;
    int& base = unknown_of_system[static_cast<std::size_t>(rows[i].system_time)];
    if (base < 0) base = scaled.unknowns++;
    ChangeRow row;
    row.h.head<3>() = scaled.change_root.transpose() * rows[i].direction;
    row.h.segment<3>(kChangePosition) = position_root.transpose() * rows[i].direction_change;
    row.h(kChangeClock) = kFree_m;
    row.h(base) = config.inter_system_m;
    row.residual = rows[i].residual_m;
    row.sigma = rows[i].sigma_m;
    row.source = i;
    scaled.rows.push_back(row);
    residuals.push_back(row.residual);
  }
  if (scaled.rows.empty()) return scaled;
  // A clock jump is a million times a carrier's noise, so it is removed before anything is squared.
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  scaled.centre_m = *middle;
  for (ChangeRow& row : scaled.rows) row.residual -= scaled.centre_m;
  return scaled;
}

}  // namespace leonav
