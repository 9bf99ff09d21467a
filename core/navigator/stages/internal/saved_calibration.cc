#include "core/navigator/stages/internal/saved_calibration.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"

namespace leonav {

using namespace ekf_index;
using Eigen::Vector3d;

namespace {

constexpr double kErrorSizes_s = 3600.0;  // other satellites are reflected at other walls then
constexpr double kFutureTolerated_s = 1.0;
// The sigmas of a filter are those of its model, which no sensor follows to the letter.
constexpr double kSigmaFactor = 2.0;
constexpr double kLeastShare = 0.2;  // of the configured sigma
constexpr double kSameMounting = 1e-6;
constexpr double kSamePlaceSigmas = 3.0, kSameImuSigmas = 4.0;

struct Estimate {
  double value = 0.0;
  double variance = 0.0;
};

// Returns the variance of an estimate whose own one has become `variance`.
double believed(double variance, double configured_sigma) {
  return std::clamp(variance, square(kLeastShare * configured_sigma), square(configured_sigma));
}

// By how many configured sigmas the largest of three values differs from zero.
double largest(const Vector3d& values, const GaussMarkov& process) {
  return process.sigma > 0.0 ? values.cwiseAbs().maxCoeff() / process.sigma : 0.0;
}

// Moves a state on by its process. One without a sigma is not known.
Estimate moved_on(double value, double sigma, const GaussMarkov& process, double age_s) {
  if (!(sigma > 0.0) || !(process.sigma > 0.0)) return {0.0, square(process.sigma)};
  const double share =
      process.correlation_time_s > 0.0 ? std::exp(-age_s / process.correlation_time_s) : 0.0;
  const double variance =
      square(share * kSigmaFactor * sigma) + (1.0 - square(share)) * square(process.sigma);
  return {share * value, believed(variance, process.sigma)};
}

// The same of three axes from `first` on.
void move_on(const Vector3d& values, const Vector3d& sigmas, const GaussMarkov& process,
             double age_s, int first, Vector3d* moved, ImuErrorCovariance* covariance) {
  for (int i = 0; i < 3; ++i) {
    const Estimate one = moved_on(values[i], sigmas[i], process, age_s);
    (*moved)[i] = one.value;
    (*covariance)(first + i, first + i) = one.variance;
  }
}

}  // namespace

SavedCalibration::SavedCalibration(const NavigatorConfig& config)
    : imu_(config.imu),
      vehicle_constants_(config.ekf.vehicle),
      mounting_rpy_(config.vehicle.mounting_rpy),
      max_age_s_(config.checkpoint_max_age_s) {
  for (int i = 0; i < 3; ++i)
    configured_[static_cast<std::size_t>(kLeverArm + i)] = config.vehicle.lever_arm_b[i];
  configured_[kTimeOffset] = config.imu_time_offset_s;
}

std::optional<SavedCalibration::Verdict> SavedCalibration::start(GpsTime time, Ekf* filter) {
  if (!checkpoint_ || started_) return std::nullopt;
  started_ = true;
  const double age_s = seconds_between(time, checkpoint_->time);
  if (age_s > max_age_s_ || age_s < -kFutureTolerated_s) {
    const bool calibrated = checkpoint_->calibration.has_value();
    checkpoint_.reset();
    if (!calibrated) return std::nullopt;
    return Verdict{CheckpointUse::kCalibrationOld, age_s};
  }
  if (checkpoint_->code_sigma_factor > 0.0 && checkpoint_->doppler_sigma_factor > 0.0)
    filter->start_errors(checkpoint_->code_sigma_factor, checkpoint_->doppler_sigma_factor,
                         std::exp(-std::max(age_s, 0.0) / kErrorSizes_s));
  if (!checkpoint_->calibration) return std::nullopt;
  if (!is_of_this_vehicle(*checkpoint_->calibration)) {
    checkpoint_.reset();
    return Verdict{CheckpointUse::kCalibrationMounted, 0.0};
  }
  const double worst = worst_imu_error(*checkpoint_->calibration);
  if (!(worst <= kSameImuSigmas)) {
    checkpoint_.reset();
    return Verdict{CheckpointUse::kCalibrationImu, worst};
  }
  start_constants(*checkpoint_->calibration, std::max(age_s, 0.0), filter);
  return std::nullopt;
}

bool SavedCalibration::is_of_this_vehicle(const Calibration& calibration) const {
  const Vector3d turned = calibration.mounting_rpy - mounting_rpy_;
  if (!(turned.cwiseAbs().maxCoeff() <= kSameMounting)) return false;
  for (std::size_t i = 0; i < kMaxVehicle; ++i) {
    const double limit = kSamePlaceSigmas * vehicle_constants_.sigma[i];
    if (calibration.constant_sigmas[i] > 0.0 && limit > 0.0 &&
        !(std::abs(calibration.constants[i] - configured_[i]) <= limit))
      return false;
  }
  return true;
}

// Returns by how many configured sigmas an error of the IMU differs from zero at most. What is far
// from its configuration is of another IMU, or was damaged.
double SavedCalibration::worst_imu_error(const Calibration& calibration) const {
  return std::max({largest(checkpoint_->gyro_bias_b, imu_.gyro_bias),
                   largest(calibration.accel_bias_b, imu_.accel_bias),
                   largest(calibration.gyro_scale, imu_.gyro_scale),
                   largest(calibration.accel_scale, imu_.accel_scale)});
}

void SavedCalibration::start_constants(const Calibration& calibration, double age_s,
                                       Ekf* filter) const {
  const VehicleConstantsConfig& config = vehicle_constants_;
  // The odometer's scale may join those that are estimated from the start.
  const int most = std::max(config.count, kOdometerScale + 1);
  VehicleConstants values, variances;
  int known = 0;
  for (int i = 0; i < most; ++i) {
    const auto at = static_cast<std::size_t>(i);
    Estimate one = {0.0, square(config.sigma[at])};
    if (calibration.constant_sigmas[at] > 0.0 && config.sigma[at] > 0.0) {
      const double variance = square(kSigmaFactor * calibration.constant_sigmas[at]) +
                              square(config.random_walk[at]) * age_s;
      one = {calibration.constants[at] - configured_[at], believed(variance, config.sigma[at])};
      known = i + 1;
    }
    values.push_back(one.value);
    variances.push_back(one.variance);
  }
  if (known == 0) return;
  const auto count = static_cast<std::size_t>(std::max(known, config.count));
  values.resize(count);
  variances.resize(count);
  filter->start_constants(values, variances);
}

std::optional<SavedCalibration::Verdict> SavedCalibration::set_attitude(
    const AlignedAttitude& aligned, GpsTime time, Ekf* filter) {
  const auto without = [&] {
    filter->set_attitude(aligned.q_eb, aligned.sigma_rpy, aligned.gyro_bias_b,
                         aligned.gyro_bias_sigma);
    checkpoint_.reset();
  };
  if (!checkpoint_ || !checkpoint_->calibration) {
    without();
    return std::nullopt;
  }
  const double age_s = seconds_between(time, checkpoint_->time);
  if (age_s > max_age_s_ || age_s < -kFutureTolerated_s) {
    without();
    return Verdict{CheckpointUse::kCalibrationOld, age_s};
  }
  const double passed_s = std::max(age_s, 0.0);
  const Calibration& saved = *checkpoint_->calibration;
  ImuErrors errors;
  ImuErrorCovariance covariance = ImuErrorCovariance::Zero();
  move_on(checkpoint_->gyro_bias_b, Vector3d::Constant(checkpoint_->gyro_bias_sigma),
          imu_.gyro_bias, passed_s, 0, &errors.gyro_bias_b, &covariance);
  covariance.diagonal().segment<3>(3).setConstant(square(imu_.accel_bias.sigma));
  move_on(saved.gyro_scale, saved.gyro_scale_sigma, imu_.gyro_scale, passed_s, 6,
          &errors.gyro_scale, &covariance);
  move_on(saved.accel_scale, saved.accel_scale_sigma, imu_.accel_scale, passed_s, 9,
          &errors.accel_scale, &covariance);
  double worst = 0.0;  // the gyros at rest from their saved bias, sigmas
  if (aligned.gyro_bias_known) {
    for (int i = 0; i < 3; ++i) {
      const double saved_variance = covariance(i, i);
      const double measured_variance = square(aligned.gyro_bias_sigma);
      const double sum = saved_variance + measured_variance;
      if (!(sum > 0.0)) continue;
      const double difference = aligned.gyro_bias_b[i] - errors.gyro_bias_b[i];
      worst = std::max(worst, std::abs(difference) / std::sqrt(sum));
      errors.gyro_bias_b[i] += saved_variance / sum * difference;
      covariance(i, i) = saved_variance * measured_variance / sum;
    }
  }
  if (!(worst <= kSameImuSigmas)) {
    without();
    return Verdict{CheckpointUse::kCalibrationImu, worst};
  }
  filter->set_attitude(aligned.q_eb, aligned.sigma_rpy, errors, covariance);
  checkpoint_.reset();
  return Verdict{CheckpointUse::kCalibrationUsed, age_s};
}

}  // namespace leonav
