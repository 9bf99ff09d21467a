#include "core/gnss/measurement/dop.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "core/earth/ellipsoid.h"
#include "core/gnss/measurement/range_model.h"

namespace leonav {
namespace {

constexpr int kUnknowns = 3 + static_cast<int>(kMaxSystemTimes);
using Row = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;

// Above this value the geometry determines no position, and rounding determines the digits.
constexpr double kMaxDop = 1.0e4;

Normal normal_matrix(const MeasurementEpoch& epoch, const std::bitset<kMaxSatellites>& used,
                     const Eigen::Vector3d& p_a_e) {
  Normal normal = Normal::Zero();
  for (std::size_t i = 0; i < epoch.satellites.size(); ++i) {
    if (!used[i]) continue;
    const SatelliteInView& satellite = epoch.satellites[i];
    Row row = Row::Zero();
    row.head<3>() = predict_range(satellite, p_a_e).d_range_d_p.transpose();
    row(3 + static_cast<int>(index_of(satellite.satellite.system))) = 1.0;
    normal += row * row.transpose();
  }
  return normal;
}

// Sums the clocks that a satellite uses; the others have a unit row of their own.
double trace_of_clocks(const Normal& normal, const Normal& covariance) {
  double sum = 0.0;
  for (int i = 3; i < kUnknowns; ++i) sum += normal(i, i) > 0.0 ? covariance(i, i) : 0.0;
  return sum;
}

}  // namespace

Dop dilution_of_precision(const MeasurementEpoch& epoch, const Eigen::Vector3d& p_a_e) {
  std::bitset<kMaxSatellites> used;
  for (const Measurement& measurement : epoch.measurements) {
    if (measurement.observable != Observable::kCode || !is_used(measurement.reason)) continue;
    used.set(measurement.satellite_index);
  }
  return dilution_of_precision(epoch, used, p_a_e);
}

Dop dilution_of_precision(const MeasurementEpoch& epoch, const std::bitset<kMaxSatellites>& used,
                          const Eigen::Vector3d& p_a_e) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const Normal normal = normal_matrix(epoch, used, p_a_e);
  Normal regular = normal;
  for (int i = 3; i < kUnknowns; ++i) {
    if (normal(i, i) == 0.0) regular(i, i) = 1.0;  // a system that no satellite uses
  }
  const Eigen::LDLT<Normal> factor(regular);
  const Normal covariance = factor.solve(Normal::Identity());
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(p_a_e));
  const Eigen::Matrix3d q = C_ne * covariance.topLeftCorner<3, 3>() * C_ne.transpose();
  const Dop dop{std::sqrt(q.trace()), std::sqrt(q(0, 0) + q(1, 1)), std::sqrt(q(2, 2)),
                std::sqrt(q.trace() + trace_of_clocks(normal, covariance))};
  const bool positive = factor.info() == Eigen::Success && factor.vectorD().minCoeff() > 0.0;
  if (!positive || !(dop.pdop < kMaxDop)) return {kNaN, kNaN, kNaN, kNaN};
  return dop;
}

}  // namespace leonav
