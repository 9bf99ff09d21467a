#include "core/filter/update/robust_update.h"

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "support/catch.h"
#include "support/dense/dense_algebra.h"
#include "synthetic.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Vector3d;

RobustConfig off() {
  RobustConfig config;
  config.enabled = false;
  return config;
}

FilterMeasurement scalar(double innovation, double sigma, const EkfVector& row) {
  FilterMeasurement measurement;
  measurement.innovation = innovation;
  measurement.variance = sigma * sigma;
  measurement.gain_variance = sigma * sigma;
  measurement.row = row;
  return measurement;
}

EkfVector row_of(double x, double y, double z) {
  EkfVector row = EkfVector::Zero();
  row.segment<3>(kPosition) << x, y, z;
  row(kClock) = 1.0;
  return row;
}

// Position and clock, one code in each of `count` directions; value 0, white noise of 1 m.
FilterMeasurements around(int count, synthetic::Generator* noise) {
  FilterMeasurements measurements;
  for (int i = 0; i < count; ++i) {
    const double azimuth = 2.0 * M_PI * i / count;
    const double elevation = 0.3 + 0.9 * (i % 3) / 2.0;
    measurements.push_back(
        scalar(noise->normal(), 1.0,
               row_of(std::cos(azimuth) * std::cos(elevation),
                      std::sin(azimuth) * std::cos(elevation), std::sin(elevation))));
  }
  return measurements;
}

EkfCovariance position_and_clock(double sigma) {
  EkfCovariance P = EkfCovariance::Zero(kSize, kSize);
  P.diagonal().segment<3>(kPosition).setConstant(sigma * sigma);
  P(kClock, kClock) = sigma * sigma;
  return P;
}

}  // namespace

TEST_CASE("ten epochs of a linear problem equal batch least squares") {
  // Constant position and clock, prior with correlations: the filter one epoch after another,
  // least squares all at once by QR of the stacked, whitened equations.
  synthetic::Generator noise(5);
  Eigen::Matrix4d root;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) root(i, j) = noise.normal();
  const Eigen::Matrix4d prior = root * root.transpose() + Eigen::Matrix4d::Identity();
  EkfCovariance P = EkfCovariance::Zero(kSize, kSize);
  P.block<3, 3>(0, 0) = prior.block<3, 3>(0, 0);
  P.block<3, 1>(0, kClock) = prior.block<3, 1>(0, 3);
  P.block<1, 3>(kClock, 0) = prior.block<1, 3>(3, 0);
  P(kClock, kClock) = prior(3, 3);

  constexpr int kEpochs = 10, kPerEpoch = 6;
  Eigen::MatrixXd A(4 + kEpochs * kPerEpoch, 4);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(A.rows());
  A.topRows<4>() = dense::whitening(prior);
  EkfVector x = EkfVector::Zero();
  for (int k = 0; k < kEpochs; ++k) {
    FilterMeasurements measurements;
    for (int i = 0; i < kPerEpoch; ++i) {
      const Eigen::Vector3d u = noise.normal3().normalized();
      const EkfVector row = row_of(u.x(), u.y(), u.z());
      const double sigma = 0.5 + noise.uniform();
      const double value = 10.0 * noise.normal();
      measurements.push_back(scalar(value - row.dot(x), sigma, row));
      const int r = 4 + k * kPerEpoch + i;
      A.row(r) << u.transpose() / sigma, 1.0 / sigma;
      b(r) = value / sigma;
    }
    x += RobustUpdate{}(off(), &measurements, &P).correction;
  }
  const dense::LeastSquares batch = dense::least_squares(A, b);
  Eigen::Vector4d filtered;
  filtered << x.head<3>(), x(kClock);
  CHECK((filtered - batch.solution).norm() < 1e-9);
  Eigen::Matrix4d got = Eigen::Matrix4d::Zero();
  got.block<3, 3>(0, 0) = P.block<3, 3>(0, 0);
  got.block<3, 1>(0, 3) = P.block<3, 1>(0, kClock);
  got.block<1, 3>(3, 0) = P.block<1, 3>(kClock, 0);
  got(3, 3) = P(kClock, kClock);
  CHECK((got - batch.covariance).norm() < 1e-9);
}

TEST_CASE("the update equals Joseph's form and the textbook innovation statistic") {
  synthetic::Generator noise(6);
  constexpr int kStates = kSize + 5;  // with five ambiguities
  Eigen::MatrixXd root(kStates, kStates);
  for (int i = 0; i < kStates; ++i)
    for (int j = 0; j < kStates; ++j) root(i, j) = noise.normal();
  const EkfCovariance prior = root * root.transpose();
  FilterMeasurements measurements;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(12, kStates);
  Eigen::VectorXd y(12);
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(12, 12);
  for (int i = 0; i < 12; ++i) {
    EkfVector row;
    for (int j = 0; j < kSize; ++j) row(j) = noise.normal();
    measurements.push_back(scalar(3.0 * noise.normal(), 0.7, row));
    H.row(i).head(kSize) = row;
    if (i % 2 == 1) {
      measurements.back().ambiguity = kSize + i / 2 % 5;
      H(i, measurements.back().ambiguity) = 1.0;
    }
    CHECK(predicted_variance(measurements.back(), prior) ==
          Approx(H.row(i) * prior * H.row(i).transpose()));
    y(i) = measurements.back().innovation;
    R(i, i) = 0.49;
  }
  EkfCovariance P = prior;
  const RobustUpdateResult result = RobustUpdate{}(off(), &measurements, &P);
  const Eigen::MatrixXd S = H * prior * H.transpose() + R;
  const Eigen::MatrixXd S_inverse = dense::inverse(S);
  const Eigen::MatrixXd K = prior * H.transpose() * S_inverse;
  const Eigen::MatrixXd IKH = Eigen::MatrixXd::Identity(kStates, kStates) - K * H;
  const Eigen::MatrixXd joseph = IKH * prior * IKH.transpose() + K * R * K.transpose();
  CHECK((P - joseph).norm() / joseph.norm() < 1e-9);
  CHECK((result.correction - K * y).norm() / (K * y).norm() < 1e-9);
  CHECK(result.nis == Approx(y.dot(S_inverse * y)).epsilon(1e-8));
  CHECK((P - P.transpose()).norm() == 0.0);
}

TEST_CASE("an outlier behind a poor prior is found by the other measurements") {
  // The innovation's own sigma is 100 m, so that 60 m pass the innovation test.
  synthetic::Generator noise(7);
  FilterMeasurements measurements = around(9, &noise);
  measurements[4].innovation += 60.0;
  EkfCovariance P = position_and_clock(100.0);
  const RobustUpdateResult robust = RobustUpdate{}(RobustConfig{}, &measurements, &P);
  CHECK(measurements[4].factor == 0.0);
  int kept = 0;
  for (const FilterMeasurement& measurement : measurements) kept += measurement.factor > 0.5;
  CHECK(kept >= 7);
  CHECK(robust.correction.head<3>().norm() < 3.0);

  FilterMeasurements plain = around(9, &noise);
  plain[4].innovation += 60.0;
  EkfCovariance P_plain = position_and_clock(100.0);
  CHECK(RobustUpdate{}(off(), &plain, &P_plain).correction.head<3>().norm() > 10.0);
}

TEST_CASE("three outliers among twelve are found") {
  synthetic::Generator noise(8);
  FilterMeasurements measurements = around(12, &noise);
  for (const std::size_t i : {1U, 5U, 8U}) measurements[i].innovation += 40.0 + 10.0 * double(i);
  EkfCovariance P = position_and_clock(20.0);
  RobustConfig config;
  config.max_iterations = 10;
  const RobustUpdateResult result = RobustUpdate{}(config, &measurements, &P);
  for (const std::size_t i : {1U, 5U, 8U}) CHECK(measurements[i].factor == 0.0);
  CHECK(result.correction.head<3>().norm() < 3.0);
}

TEST_CASE("measurements that contradict each other weigh what their residuals show") {
  synthetic::Generator noise(12);
  FilterMeasurements measurements = around(12, &noise);
  for (FilterMeasurement& measurement : measurements) measurement.innovation *= 60.0;
  // Three good ones of another kind hold their own against them.
  for (int axis = 0; axis < 3; ++axis) {
    EkfVector row = EkfVector::Zero();
    row(kPosition + axis) = 1.0;
    measurements.push_back(scalar(0.03 * (axis - 1), 0.1, row));
    measurements.back().observable = Observable::kCarrier;
  }
  EkfCovariance P = position_and_clock(100.0);
  const RobustUpdateResult result = RobustUpdate{}(RobustConfig{}, &measurements, &P);
  for (std::size_t i = 0; i < 12; ++i) CHECK(measurements[i].factor < 0.01);
  for (std::size_t i = 12; i < 15; ++i) CHECK(measurements[i].factor > 0.1);
  CHECK(result.scale[0] > 20.0);
  CHECK(result.correction.head<3>().norm() < 0.6);
  // The clock has nothing but them: it is no better known than they are.
  CHECK(std::abs(result.correction(kClock)) < 3.0 * std::sqrt(P(kClock, kClock)));
  CHECK(std::sqrt(P(kClock, kClock)) > 5.0);
}

TEST_CASE("clean measurements keep nearly all their weight") {
  synthetic::Generator noise(9);
  double sum = 0.0;
  int rejected = 0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    FilterMeasurements measurements = around(10, &noise);
    EkfCovariance P = position_and_clock(0.5);
    RobustUpdate{}(RobustConfig{}, &measurements, &P);
    for (const FilterMeasurement& measurement : measurements) {
      sum += measurement.factor;
      rejected += measurement.factor == 0.0;
    }
  }
  CHECK(sum / (10.0 * kRuns) > 0.93);
  CHECK(rejected == 0);
}

TEST_CASE("states without variance take no correction, and nothing measured changes nothing") {
  synthetic::Generator noise(10);
  FilterMeasurements measurements = around(6, &noise);
  for (FilterMeasurement& measurement : measurements) measurement.row.setOnes();
  EkfCovariance P = position_and_clock(10.0);
  const RobustUpdateResult result = RobustUpdate{}(RobustConfig{}, &measurements, &P);
  CHECK(result.correction.segment(kVelocity, kClock - kVelocity).norm() == 0.0);
  CHECK(result.correction.tail<7>().norm() == 0.0);
  FilterMeasurements none;
  const EkfCovariance before = P;
  CHECK(RobustUpdate{}(RobustConfig{}, &none, &P).correction.norm() == 0.0);
  CHECK((P - before).norm() == 0.0);
}

TEST_CASE("carriers that contradict each other do not decide beside codes") {
  // Ten codes of 1 m that agree, ten carriers of 3 mm that are metres off, each by something else:
  // all carriers or none is what the weights would go back and forth between.
  synthetic::Generator noise(3);
  const FilterMeasurements codes = around(10, &noise);
  EkfCovariance P = position_and_clock(1e4);
  FilterMeasurements measurements = codes;
  for (const FilterMeasurement& code : codes) {
    FilterMeasurement carrier = code;
    carrier.observable = Observable::kCarrier;
    carrier.innovation = 4.0 * noise.normal();
    carrier.variance = carrier.gain_variance = 9e-6;
    measurements.push_back(carrier);
  }
  RobustUpdate update;
  const auto result = update(RobustConfig(), &measurements, &P);
  double kept = 0.0;
  for (std::size_t i = codes.size(); i < measurements.size(); ++i) kept += measurements[i].factor;
  CHECK(kept == 0.0);
  CHECK(result.correction.segment<3>(kPosition).norm() < 3.0);
  // As uncertain as the codes alone leave it.
  CHECK(std::sqrt(P(kPosition, kPosition)) > 0.3);
}

TEST_CASE("two carriers that only an uncertain clock reconciles with the prediction are excluded") {
  // Each alone is within four sigmas of the prediction, for the clock is unknown to a metre; both
  // together want a movement of 40 sigmas. The weights would go back and forth between both and
  // none, and with few of them both would decide.
  EkfCovariance P = EkfCovariance::Zero(kSize, kSize);
  P.diagonal().segment<3>(kPosition).setConstant(0.01);
  P(kClock, kClock) = 2.0;
  const EkfCovariance prior = P;
  FilterMeasurements measurements = {scalar(-5.3, 0.02, row_of(0.8, 0.3, 0.5)),
                                     scalar(3.5, 0.02, row_of(-0.7, 0.1, 0.7))};
  for (FilterMeasurement& measurement : measurements) measurement.observable = Observable::kCarrier;
  const int passes = GENERATE(4, 5, 6);
  RobustConfig config;
  config.max_iterations = passes;
  RobustUpdate update;
  const auto result = update(config, &measurements, &P);
  CAPTURE(passes);
  CHECK(measurements[0].factor == 0.0);
  CHECK(measurements[1].factor == 0.0);
  CHECK(result.correction.norm() == 0.0);
  CHECK((P - prior).norm() < 1e-12);
}

// Codes that contradict each other; Dopplers of which some agree with some carriers and the others
// with nothing. Those carriers are too few to count, and without them the Dopplers contradict each
// other as well.
TEST_CASE("what carriers had outvoted is found to contradict itself once they are left out") {
  struct Sky {
    int satellites, agreeing;
    double velocity_sigma, clock_sigma, off;
  };
  const Sky sky =
      GENERATE(Sky{7, 3, 0.6, 2.0, 1.0}, Sky{8, 3, 1.0, 0.5, 2.0}, Sky{7, 5, 0.6, 0.5, 2.0});
  CAPTURE(sky.satellites, sky.agreeing);
  EkfCovariance prior = EkfCovariance::Zero(kSize, kSize);
  // A second's way of an uncertain velocity.
  const auto move = [&](int place, int rate, double sigma, double start_sigma) {
    prior(rate, rate) = sigma * sigma;
    prior(place, rate) = prior(rate, place) = 0.5 * sigma * sigma;
    prior(place, place) = start_sigma * start_sigma + 0.25 * sigma * sigma;
  };
  for (int axis = 0; axis < 3; ++axis)
    move(kPosition + axis, kVelocity + axis, sky.velocity_sigma, 0.7);
  move(kClock, kClockDrift, 0.5, sky.clock_sigma);
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    synthetic::Generator noise(seed);
    const auto normal = [&] { return noise.normal(); };
    EkfCovariance P = prior;
    const double vx = normal(), vy = normal(), vz = normal();
    const Vector3d velocity = sky.velocity_sigma * Vector3d(vx, vy, vz);
    FilterMeasurements measurements;
    for (int i = 0; i < sky.satellites; ++i) {
      const bool agrees = i < sky.agreeing;
      const double azimuth = 6.28 * i / sky.satellites + 0.3 * normal(),
                   elevation = 0.3 + 0.9 * (i % 3) / 2.0;
      const Vector3d los(std::cos(azimuth) * std::cos(elevation),
                         std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
      const EkfVector row = row_of(los.x(), los.y(), los.z());
      measurements.push_back(scalar(12.0 * normal(), 1.0, row));
      const double rate = los.dot(velocity) + (agrees ? 0.0 : sky.off * normal());
      EkfVector rate_row = EkfVector::Zero();
      rate_row.segment<3>(kVelocity) = los;
      rate_row(kClockDrift) = 1.0;
      measurements.push_back(scalar(rate + 0.05 * normal(), 0.05, rate_row));
      measurements.back().observable = Observable::kDoppler;
      if (i == sky.agreeing - 1) continue;
      measurements.push_back(scalar(0.5 * rate + (agrees ? 0.0 : 3.0), 0.01, row));
      measurements.back().observable = Observable::kCarrier;
    }
    const RobustUpdateResult result = RobustUpdate{}(RobustConfig{}, &measurements, &P);
    double carriers = 0.0, far = 0.0;
    for (const FilterMeasurement& m : measurements) {
      if (m.observable == Observable::kCarrier) carriers += m.factor;
      if (m.observable != Observable::kDoppler) continue;
      const double residual = m.innovation - m.row.dot(result.correction.head<kSize>());
      far += m.factor * residual * residual / m.variance;
    }
    if (carriers > 0.0) continue;
    ++found;
    // What is weighed in full is off by no more than the scale of all, three sigmas, lets pass.
    CHECK(far < 25.0 * sky.satellites);
  }
  CHECK(found > 150);
}

}  // namespace leonav
