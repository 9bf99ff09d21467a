// What an earlier run has found is believed the less the older it is, and not at all where it is of
// another vehicle or IMU.
#include "core/navigator/stages/internal/saved_calibration.h"

#include <cmath>

#include "core/earth/ellipsoid.h"
#include "support/catch.h"
#include "support/programs/parked_checkpoint.h"

namespace leonav::test {
namespace {

using namespace ekf_index;

NavigatorConfig config_of_parked() {
  NavigatorConfig config;
  config.imu = consumer_mems_errors();
  config.vehicle.mounting_rpy = parked().calibration->mounting_rpy;
  config.vehicle.lever_arm_b = {0.5, 0.0, -1.0};
  config.imu_time_offset_s = 0.002;
  config.ekf.vehicle.count = kMaxVehicle;
  config.ekf.vehicle.sigma = {0.05, 0.05, 0.02, 0.2, 0.2, 0.2, 0.01};
  config.ekf.vehicle.random_walk = {1e-5, 1e-5, 1e-6, 1e-5, 1e-5, 1e-5, 1e-6};
  return config;
}

Ekf filter_of(const NavigatorConfig& config) {
  return {config.ekf, config.imu, config.vehicle.lever_arm_b};
}

PointSolution parked_point() {
  PointSolution point;
  point.p_e = parked().antenna_p_e;
  point.covariance_p_e = Eigen::Matrix3d::Identity();
  return point;
}

AlignedAttitude aligned_in_motion(const NavigatorConfig& config) {
  AlignedAttitude aligned;
  aligned.sigma_rpy.setConstant(0.02);
  aligned.gyro_bias_sigma = config.imu.gyro_bias.sigma;
  return aligned;
}

double variance(const Ekf& filter, int state) { return filter.covariance()(state, state); }

TEST_CASE(
    "learned sizes of errors count the less the older they are, and not at all when too old") {
  const NavigatorConfig config = config_of_parked();
  const double unknown = filter_of(config).learned_errors().mean_scale(Observable::kCode);
  const double saved = parked().code_sigma_factor;
  const auto scale_after = [&](double age_s) {
    Ekf filter = filter_of(config);
    SavedCalibration calibration(config);
    calibration.take(parked());
    calibration.start(parked().time.plus_seconds(age_s), &filter);
    return filter.learned_errors().mean_scale(Observable::kCode);
  };
  CHECK(scale_after(0.0) == Approx(saved));
  CHECK(scale_after(3600.0) == Approx(unknown * std::pow(saved / unknown, std::exp(-1.0))));
  CHECK(scale_after(86400.0) == Approx(unknown));
  CHECK(scale_after(config.checkpoint_max_age_s + 1.0) == unknown);
  CHECK(scale_after(-10.0) == unknown);
}

TEST_CASE("vehicle constants start from those of before, beyond what is configured") {
  const NavigatorConfig config = config_of_parked();
  const Calibration saved = *parked().calibration;
  Ekf filter = filter_of(config);
  SavedCalibration calibration(config);
  calibration.take(parked());
  constexpr double kAge_s = 600.0;
  const GpsTime time = parked().time.plus_seconds(kAge_s);
  CHECK_FALSE(calibration.start(time, &filter));
  filter.initialize(time, parked_point());
  const VehicleConstants& constants = filter.filter_state().vehicle;
  REQUIRE(constants.size() == kMaxVehicle);
  CHECK(constants[kTravelYaw] == saved.constants[kTravelYaw]);
  CHECK(constants[kOdometerScale] == saved.constants[kOdometerScale]);
  CHECK(constants[kLeverArm] == Approx(saved.constants[kLeverArm] - 0.5));
  CHECK(constants[kTimeOffset] == Approx(saved.constants[kTimeOffset] - 0.002));
  for (int i = 0; i < kMaxVehicle; ++i) {
    CAPTURE(i);
    const auto at = static_cast<std::size_t>(i);
    const double sigma = std::sqrt(variance(filter, kSize + i));
    CHECK(sigma >= 0.2 * config.ekf.vehicle.sigma[at] * (1.0 - 1e-12));
    CHECK(sigma <= config.ekf.vehicle.sigma[at] * (1.0 + 1e-12));
    if (saved.constant_sigmas[at] > 0.0) {
      CHECK(sigma < config.ekf.vehicle.sigma[at]);
      CHECK(sigma > 2.0 * saved.constant_sigmas[at]);  // doubled, and older
    } else {
      CHECK(sigma == config.ekf.vehicle.sigma[at]);
      CHECK(constants[at] == 0.0);
    }
  }
  // A filter that starts over because it was wrong starts from nothing.
  filter.reset();
  CHECK_FALSE(calibration.start(time, &filter));
  filter.initialize(time, parked_point());
  CHECK(filter.filter_state().vehicle[kLeverArm] == 0.0);
}

TEST_CASE("what is not estimated now does not start, whatever was found") {
  NavigatorConfig config = config_of_parked();
  config.ekf.vehicle = {};
  Ekf filter = filter_of(config);
  SavedCalibration calibration(config);
  calibration.take(parked());
  CHECK_FALSE(calibration.start(parked().time, &filter));
  filter.initialize(parked().time, parked_point());
  CHECK(filter.filter_state().vehicle.empty());
}

TEST_CASE("errors of the IMU are moved on to the start, until they are as configured") {
  const NavigatorConfig config = config_of_parked();
  const Checkpoint checkpoint = parked();
  const Calibration saved = *checkpoint.calibration;
  for (const double age_s : {5.0, 3600.0, 86400.0}) {
    CAPTURE(age_s);
    Ekf filter = filter_of(config);
    SavedCalibration calibration(config);
    calibration.take(checkpoint);
    const GpsTime time = checkpoint.time.plus_seconds(age_s);
    calibration.start(time, &filter);
    filter.initialize(time, parked_point());
    const auto verdict = calibration.set_attitude(aligned_in_motion(config), time, &filter);
    REQUIRE(verdict);
    CHECK(verdict->use == CheckpointUse::kCalibrationUsed);
    CHECK(verdict->value == Approx(age_s));
    const ImuErrors& errors = filter.state().errors;
    const auto share = [&](const GaussMarkov& process) {
      return std::exp(-age_s / process.correlation_time_s);
    };
    const auto same = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return (a - b).norm() <= 1e-9 * b.norm();
    };
    CHECK(same(errors.gyro_bias_b, share(config.imu.gyro_bias) * checkpoint.gyro_bias_b));
    CHECK(same(errors.gyro_scale, share(config.imu.gyro_scale) * saved.gyro_scale));
    CHECK(same(errors.accel_scale, share(config.imu.accel_scale) * saved.accel_scale));
    const auto is_between = [&](int state, double saved_sigma, const GaussMarkov& process) {
      const double sigma = std::sqrt(variance(filter, state));
      CHECK(sigma <= process.sigma * (1.0 + 1e-9));
      CHECK(sigma >= 0.2 * process.sigma * (1.0 - 1e-9));
      const double grown = process.sigma * std::sqrt(1.0 - std::pow(share(process), 2));
      CHECK(sigma >= std::min(process.sigma, grown) * (1.0 - 1e-9));
      CHECK(sigma >= std::min(process.sigma, 2.0 * share(process) * saved_sigma) * (1.0 - 1e-9));
    };
    is_between(kGyroBias, checkpoint.gyro_bias_sigma, config.imu.gyro_bias);
    // The level contains the accelerometers' bias.
    CHECK(errors.accel_bias_b.isZero());
    CHECK(variance(filter, kAccelBias) == Approx(std::pow(config.imu.accel_bias.sigma, 2)));
    is_between(kGyroScale, saved.gyro_scale_sigma.x(), config.imu.gyro_scale);
    is_between(kAccelScale, saved.accel_scale_sigma.x(), config.imu.accel_scale);
    if (age_s == 5.0)
      CHECK(variance(filter, kAccelScale) < std::pow(config.imu.accel_scale.sigma, 2));
  }
}

TEST_CASE("a gyro bias that was measured at rest is combined with that of before, or denies it") {
  const NavigatorConfig config = config_of_parked();
  const Checkpoint checkpoint = parked();
  AlignedAttitude aligned = aligned_in_motion(config);
  aligned.gyro_bias_known = true;
  aligned.gyro_bias_sigma = 2e-4;
  const auto start = [&](Ekf* filter) {
    SavedCalibration calibration(config);
    calibration.take(checkpoint);
    calibration.start(checkpoint.time, filter);
    filter->initialize(checkpoint.time, parked_point());
    return calibration.set_attitude(aligned, checkpoint.time, filter);
  };
  aligned.gyro_bias_b = checkpoint.gyro_bias_b + Eigen::Vector3d(1e-4, 0.0, 0.0);
  Ekf near = filter_of(config);
  auto verdict = start(&near);
  REQUIRE(verdict);
  CHECK(verdict->use == CheckpointUse::kCalibrationUsed);
  const double combined = near.state().errors.gyro_bias_b.x();
  CHECK(combined > checkpoint.gyro_bias_b.x());
  CHECK(combined < aligned.gyro_bias_b.x());
  CHECK(variance(near, kGyroBias) < std::pow(aligned.gyro_bias_sigma, 2));

  aligned.gyro_bias_b.y() += 20.0 * config.imu.gyro_bias.sigma;
  Ekf far = filter_of(config);
  verdict = start(&far);
  REQUIRE(verdict);
  CHECK(verdict->use == CheckpointUse::kCalibrationImu);
  CHECK(verdict->value > 4.0);
  CHECK(far.state().errors.gyro_bias_b == aligned.gyro_bias_b);
  CHECK(far.state().errors.accel_bias_b.isZero());
  CHECK(far.state().errors.accel_scale.isZero());
  CHECK(variance(far, kAccelScale) == Approx(std::pow(config.imu.accel_scale.sigma, 2)));
  // The gyros at rest come after the filter's start; what it began with is the vehicle's.
  CHECK(far.filter_state().vehicle[kTravelYaw] == checkpoint.calibration->constants[kTravelYaw]);
}

TEST_CASE("errors that no such IMU has are not taken, nor the constants found with them") {
  const NavigatorConfig config = config_of_parked();
  using Vector = Eigen::Vector3d Calibration::*;
  const Vector none = nullptr;  // the gyros' bias, which is the checkpoint's own
  for (const Vector of :
       {&Calibration::accel_bias_b, &Calibration::gyro_scale, &Calibration::accel_scale, none}) {
    Checkpoint checkpoint = parked();
    if (of == none)
      checkpoint.gyro_bias_b.z() = 0.9;
    else
      ((*checkpoint.calibration).*of).z() = -0.45;  // passes check() of all three
    if (of == &Calibration::accel_bias_b) checkpoint.calibration->accel_bias_b.z() = 50.0;
    Ekf filter = filter_of(config);
    SavedCalibration calibration(config);
    calibration.take(checkpoint);
    const auto verdict = calibration.start(checkpoint.time, &filter);
    filter.initialize(checkpoint.time, parked_point());
    REQUIRE(verdict);
    CHECK(verdict->use == CheckpointUse::kCalibrationImu);
    CHECK(verdict->value > 4.0);
    CHECK(filter.filter_state().vehicle[kLeverArm] == 0.0);
    CHECK_FALSE(calibration.set_attitude(aligned_in_motion(config), checkpoint.time, &filter));
    CHECK(filter.state().errors.gyro_bias_b.isZero());
    CHECK(filter.state().errors.accel_bias_b.isZero());
    CHECK(filter.state().errors.gyro_scale.isZero());
    CHECK(filter.state().errors.accel_scale.isZero());
  }
}

TEST_CASE("a code that nobody has given a meaning is none of the calibration's") {
  CHECK_FALSE(is_of_calibration(CheckpointUse::kNotNeeded));
  CHECK(is_of_calibration(CheckpointUse::kCalibrationUsed));
  CHECK(is_of_calibration(CheckpointUse::kCalibrationImu));
  CHECK_FALSE(is_of_calibration(static_cast<CheckpointUse>(11)));
}

TEST_CASE("of another mounting, antenna or time, or without calibration, nothing is taken") {
  const NavigatorConfig original = config_of_parked();
  const auto verdict_of = [](const NavigatorConfig& config, const Checkpoint& checkpoint,
                             double age_s) {
    Ekf filter = filter_of(config);
    SavedCalibration calibration(config);
    calibration.take(checkpoint);
    const GpsTime time = checkpoint.time.plus_seconds(age_s);
    auto verdict = calibration.start(time, &filter);
    filter.initialize(time, parked_point());
    CHECK(filter.filter_state().vehicle[kLeverArm] == 0.0);
    const auto later = calibration.set_attitude(aligned_in_motion(config), time, &filter);
    CHECK_FALSE(later);
    CHECK(filter.state().errors.accel_bias_b.isZero());
    CHECK(variance(filter, kAccelBias) == Approx(std::pow(config.imu.accel_bias.sigma, 2)));
    return verdict;
  };
  NavigatorConfig config = original;
  config.vehicle.mounting_rpy.z() += 0.01;
  auto verdict = verdict_of(config, parked(), 1.0);
  REQUIRE(verdict);
  CHECK(verdict->use == CheckpointUse::kCalibrationMounted);
  config = original;
  config.vehicle.lever_arm_b.x() += 2.0;
  verdict = verdict_of(config, parked(), 1.0);
  REQUIRE(verdict);
  CHECK(verdict->use == CheckpointUse::kCalibrationMounted);
  config = original;
  config.imu_time_offset_s += 0.1;
  verdict = verdict_of(config, parked(), 1.0);
  REQUIRE(verdict);
  CHECK(verdict->use == CheckpointUse::kCalibrationMounted);
  for (std::size_t i = 0; i < kMaxVehicle; ++i) {
    if (parked().calibration->constant_sigmas[i] == 0.0) continue;
    CAPTURE(i);
    Checkpoint damaged = parked();
    damaged.calibration->constants[i] += 4.0 * original.ekf.vehicle.sigma[i];
    verdict = verdict_of(original, damaged, 1.0);
    REQUIRE(verdict);
    CHECK(verdict->use == CheckpointUse::kCalibrationMounted);
  }
  for (const double age_s : {original.checkpoint_max_age_s + 1.0, -10.0}) {
    verdict = verdict_of(original, parked(), age_s);
    REQUIRE(verdict);
    CHECK(verdict->use == CheckpointUse::kCalibrationOld);
    CHECK(verdict->value == Approx(age_s));
  }
  Checkpoint older_version = parked();
  older_version.calibration.reset();
  CHECK_FALSE(verdict_of(original, older_version, 1.0));
}

}  // namespace
}  // namespace leonav::test
