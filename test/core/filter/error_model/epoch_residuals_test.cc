// Residuals of an epoch's codes against least squares by QR, drawn errors and differences.
#include "core/filter/error_model/epoch_residuals.h"

#include <Eigen/Core>
#include <random>

#include "error_model/code_epoch.h"
#include "support/catch.h"
#include "support/dense/dense_algebra.h"

namespace leonav {
namespace {

using test::codes_of;
using test::known_of;
using test::sky_of;

const Eigen::Matrix4d kVague = known_of(1e6);

double sigma_of(std::size_t i) { return 1.0 + 0.3 * static_cast<double>(i % 4); }

class Normal {
 public:
  explicit Normal(std::uint64_t seed) : bits_(seed) {}
  double operator()() { return normal_(bits_); }
  Eigen::Vector3d three() {
    const double x = normal_(bits_), y = normal_(bits_), z = normal_(bits_);
    return {x, y, z};
  }

 private:
  std::mt19937_64 bits_;
  std::normal_distribution<double> normal_;
};

// Rows of position, GPS' and Galileo's clock, in sigmas; and the innovations.
struct Whitened {
  Eigen::MatrixXd rows;
  Eigen::VectorXd innovations;
};

Whitened whitened(const FilterMeasurements& codes) {
  const auto count = static_cast<Eigen::Index>(codes.size());
  Whitened result = {Eigen::MatrixXd(count, 5), Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const FilterMeasurement& code = codes[static_cast<std::size_t>(i)];
    const double weight = 1.0 / std::sqrt(code.variance);
    result.rows.row(i) << code.row.segment<3>(ekf_index::kPosition).transpose(),
        code.row.segment<2>(ekf_index::kClock).transpose();
    result.rows.row(i) *= weight;
    result.innovations(i) = weight * code.innovation;
  }
  return result;
}

TEST_CASE("residuals of codes are those of weighted least squares where no error is gross") {
  Normal normal(1);
  const MeasurementEpoch epoch = sky_of(12);
  const FilterMeasurements codes =
      codes_of(epoch, [&](std::size_t i) { return 0.4 * sigma_of(i) * normal(); }, sigma_of,
               {5.0, -80.0, 30.0});
  const Whitened system = whitened(codes);
  const dense::LeastSquares fit = dense::least_squares(system.rows, system.innovations);
  const Eigen::VectorXd expected = system.innovations - system.rows * fit.solution;
  const EpochResiduals residuals = code_residuals(codes, kVague);
  REQUIRE(residuals.size() == 12);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double redundancy =
        1.0 - system.rows.row(k) * fit.covariance * system.rows.row(k).transpose();
    CHECK(residuals[i].index == i);
    CHECK(residuals[i].residual == Approx(sigma_of(i) * expected(k)).margin(1e-5));
    CHECK(residuals[i].redundancy == Approx(redundancy).margin(1e-6));
    CHECK(residuals[i].variance == Approx(codes[i].variance * redundancy).margin(1e-5));
  }
}

TEST_CASE(
    "variance and redundancy of residuals are those of drawn errors, the position's included") {
  // Errors are a third of what they might be, so that no weight changes; everything scales.
  constexpr double kDrawn = 1.0 / 3.0;
  constexpr int kDraws = 4000;
  const MeasurementEpoch epoch = sky_of(8);
  const Eigen::Vector3d position_sigma(0.5, 1.0, 3.0);
  const Eigen::Matrix4d covariance =
      known_of(position_sigma.array().square().matrix().asDiagonal());
  Normal normal(2);
  std::array<double, 8> squares{}, products{};
  EpochResiduals residuals;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::array<double, 8> errors{};
    for (std::size_t i = 0; i < 8; ++i) errors[i] = kDrawn * sigma_of(i) * normal();
    const Eigen::Vector3d off = kDrawn * position_sigma.cwiseProduct(normal.three());
    residuals = code_residuals(codes_of(
                                   epoch, [&](std::size_t i) { return errors[i]; }, sigma_of, off),
                               covariance);
    REQUIRE(residuals.size() == 8);
    for (std::size_t i = 0; i < 8; ++i) {
      squares[i] += residuals[i].residual * residuals[i].residual / kDraws;
      products[i] += residuals[i].residual * errors[i] / kDraws;
    }
  }
  for (std::size_t i = 0; i < 8; ++i) {
    CAPTURE(i, residuals[i].variance, residuals[i].redundancy);
    const double drawn_variance = kDrawn * kDrawn * sigma_of(i) * sigma_of(i);
    CHECK(squares[i] / (kDrawn * kDrawn) == Approx(residuals[i].variance).epsilon(0.1));
    CHECK(products[i] / drawn_variance == Approx(residuals[i].redundancy).margin(0.05));
  }
}

TEST_CASE("an error of the predicted position changes innovations and leaves residuals alone") {
  const MeasurementEpoch epoch = sky_of(12);
  const Eigen::Matrix4d covariance = known_of(4.0);
  const Eigen::Vector3d off = 20.0 * Eigen::Vector3d(0.6, -0.48, 0.64);
  const auto codes_at = [&](const Eigen::Vector3d& position_off) {
    Normal normal(3);
    return codes_of(
        epoch, [&](std::size_t i) { return sigma_of(i) * normal(); }, sigma_of, position_off);
  };
  const FilterMeasurements right = codes_at(Eigen::Vector3d::Zero()), wrong = codes_at(off);
  const EpochResiduals of_right = code_residuals(right, covariance),
                       of_wrong = code_residuals(wrong, covariance);
  REQUIRE(of_right.size() == 12);
  REQUIRE(of_wrong.size() == 12);
  double innovations = 0.0, residuals = 0.0;
  for (std::size_t i = 0; i < 12; ++i) {
    innovations = std::max(innovations, std::abs(wrong[i].innovation - right[i].innovation));
    residuals = std::max(residuals, std::abs(of_wrong[i].residual - of_right[i].residual));
  }
  CHECK(innovations > 15.0);
  CHECK(residuals < 0.5);
}

TEST_CASE("the ionosphere's delay has no part in the residuals as far as it is uncertain") {
  const MeasurementEpoch epoch = sky_of(12);
  constexpr double kDelay = 3.0;
  const auto codes_with = [&](double delay) {
    Normal normal(5);
    FilterMeasurements codes = codes_of(
        epoch, [&](std::size_t i) { return 0.1 * sigma_of(i) * normal(); }, sigma_of);
    for (FilterMeasurement& code : codes) {
      const SatelliteInView& view =
          epoch.satellites[epoch.measurements[code.index].satellite_index];
      code.row(ekf_index::kIonosphere) = 1.0 / std::sin(view.elevation);
      code.innovation += delay * code.row(ekf_index::kIonosphere);
    }
    return codes;
  };
  const auto largest_change = [&](double delay_sigma) {
    Eigen::Matrix4d known = known_of(4.0);
    known(3, 3) = delay_sigma * delay_sigma;
    const EpochResiduals without = code_residuals(codes_with(0.0), known),
                         with = code_residuals(codes_with(kDelay), known);
    REQUIRE(without.size() == 12);
    REQUIRE(with.size() == 12);
    double largest = 0.0;
    for (std::size_t i = 0; i < 12; ++i)
      largest = std::max(largest, std::abs(with[i].residual - without[i].residual));
    return largest;
  };
  CHECK(largest_change(10.0) < 0.1);
  CHECK(largest_change(0.0) > 1.0);
}

TEST_CASE("a gross error of one code shows in its own residual and hardly in the others") {
  const MeasurementEpoch epoch = sky_of(12);
  for (std::size_t reflected = 0; reflected < 12; ++reflected) {
    const FilterMeasurements codes = codes_of(
        epoch, [&](std::size_t i) { return i == reflected ? 50.0 : 0.0; }, sigma_of);
    const EpochResiduals residuals = code_residuals(codes, known_of(10.0));
    REQUIRE(residuals.size() == 12);
    CAPTURE(reflected);
    for (const EpochResidual& entry : residuals) {
      if (entry.index == reflected) {
        // That much of its error shows, as least squares with its weight have it.
        CHECK(entry.residual == Approx(50.0 * entry.redundancy).epsilon(1e-3));
        CHECK(entry.redundancy > 0.9);
      } else {
        CHECK(std::abs(entry.residual) < 0.05 * 50.0);
      }
    }
  }
}

TEST_CASE("codes that determine no position with one to spare have no residuals") {
  const auto count = [](int satellites, bool two_systems) {
    const MeasurementEpoch epoch = sky_of(satellites, two_systems);
    return code_residuals(codes_of(
                              epoch, [](std::size_t) { return 0.0; }, sigma_of),
                          kVague)
        .size();
  };
  CHECK(count(0, false) == 0);
  CHECK(count(4, false) == 0);
  CHECK(count(5, false) == 5);
  CHECK(count(5, true) == 0);
  CHECK(count(6, true) == 6);
}

TEST_CASE("codes of one direction have residuals only at a position that is known") {
  MeasurementEpoch epoch = sky_of(6, false);
  for (SatelliteInView& view : epoch.satellites) view.azimuth = 1.0, view.elevation = 0.7;
  const FilterMeasurements codes = codes_of(
      epoch, [](std::size_t i) { return i == 2 ? 1.0 : 0.0; }, sigma_of);
  CHECK(code_residuals(codes, kVague).empty());
  CHECK(code_residuals(codes, known_of(1.0)).size() == 6);
}

TEST_CASE("Dopplers and carriers have no part in the residuals of codes") {
  FilterMeasurements codes = codes_of(
      sky_of(8), [](std::size_t i) { return i == 3 ? 1.0 : 0.0; }, sigma_of);
  const EpochResiduals alone = code_residuals(codes, kVague);
  for (const Observable other : {Observable::kDoppler, Observable::kCarrier}) {
    FilterMeasurement measurement = codes[0];
    measurement.observable = other;
    measurement.innovation = 1000.0;
    codes.insert(codes.begin(), measurement);
  }
  const EpochResiduals among = code_residuals(codes, kVague);
  REQUIRE(among.size() == alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    CHECK(among[i].index == alone[i].index + 2);
    CHECK(among[i].residual == alone[i].residual);
    CHECK(among[i].variance == alone[i].variance);
  }
}

TEST_CASE("a covariance of the position that is none gives no residuals") {
  const FilterMeasurements codes = codes_of(
      sky_of(8), [](std::size_t) { return 0.0; }, sigma_of);
  CHECK(code_residuals(codes, -Eigen::Matrix4d::Identity()).empty());
  CHECK(code_residuals(codes, Eigen::Matrix4d::Constant(std::nan(""))).empty());
}

}  // namespace
}  // namespace leonav
