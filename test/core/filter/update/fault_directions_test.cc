// The direction in which a faulty carrier moves the state, against a numerical least-squares fit.
#include "core/filter/update/fault_directions.h"

#include <Eigen/Core>
#include <cmath>

#include "support/catch.h"
#include "support/dense/dense_algebra.h"

namespace leonav {
namespace {

using namespace ekf_index;

constexpr int kCarriers = 7;

FilterMeasurements carriers() {
  FilterMeasurements measurements;
  for (int i = 0; i < kCarriers; ++i) {
    FilterMeasurement m;
    m.observable = Observable::kCarrier;
    const double azimuth = 0.9 * i, elevation = 0.2 + 0.17 * i;
    m.row.segment<3>(kPosition) << std::cos(azimuth) * std::cos(elevation),
        std::sin(azimuth) * std::cos(elevation), std::sin(elevation);
    m.row(kClock + (i < 5 ? 0 : 2)) = 1.0;
    m.variance = 1e-4 * (1 + i);
    m.ambiguity = kSize + i;
    measurements.push_back(m);
  }
  return measurements;
}

// A metre more in carrier k moves a weighted fit of position and two clocks by so much.
Eigen::VectorXd fitted(const FilterMeasurements& measurements, std::size_t k) {
  Eigen::MatrixXd H(kCarriers, 5);
  Eigen::VectorXd sigma(kCarriers), z = Eigen::VectorXd::Zero(kCarriers);
  for (int i = 0; i < kCarriers; ++i) {
    const FilterMeasurement& m = measurements[static_cast<std::size_t>(i)];
    H.row(i) << m.row.segment<3>(kPosition).transpose(), m.row(kClock), m.row(kClock + 2);
    sigma(i) = std::sqrt(m.variance);
  }
  z(static_cast<Eigen::Index>(k)) = 1.0;
  const Eigen::MatrixXd weighted = sigma.cwiseInverse().asDiagonal() * H;
  return dense::least_squares(weighted, z.cwiseQuotient(sigma)).solution;
}

TEST_CASE("the direction of a faulty carrier is that of a least-squares fit") {
  const FilterMeasurements measurements = carriers();
  for (std::size_t k = 0; k < kCarriers; ++k) {
    CAPTURE(k);
    const EkfCorrection direction = FaultDirections(measurements).state(k, kSize + kCarriers);
    const Eigen::VectorXd expected = fitted(measurements, k);
    CHECK((direction.segment<3>(kPosition) - expected.head<3>()).norm() < 1e-6);
    CHECK(std::abs(direction(kClock) - expected(3)) < 1e-6);
    CHECK(std::abs(direction(kClock + 2) - expected(4)) < 1e-6);
    CHECK(std::abs(direction(kClock + 1)) < 1e-12);  // a clock that no carrier sees
    CHECK(direction.segment<6>(kVelocity).isZero());
  }
}

TEST_CASE("no carrier shows the change, because the ambiguities make up for it") {
  const FilterMeasurements measurements = carriers();
  const EkfCorrection direction = FaultDirections(measurements).state(2, kSize + kCarriers);
  for (const FilterMeasurement& m : measurements)
    CHECK(std::abs(m.row.dot(direction.head<kSize>()) + direction(m.ambiguity)) < 1e-12);
}

}  // namespace
}  // namespace leonav
