// EkfConfig holds the settings of the extended Kalman filter, in SI units and radians.
#pragma once
#include <array>

#include "core/filter/state/ekf_state.h"
#include "core/inertial/strapdown/imu_error_model.h"
#include "core/robust/igg3.h"

namespace leonav {

enum class MotionModel : unsigned char {
  kInertial,          // 21 INS error states, driven by the IMU
  kConstantVelocity,  // position and velocity, driven by acceleration noise (GNSS only)
  kStatic,            // a fixed point (GNSS only)
};

struct ClockModel {
  // Random walks of the receiver oscillator, common to all systems, and of each system against it.
  double offset_noise = 1.0;                // m/sqrt(s)
  double drift_noise = 0.5;                 // m/s/sqrt(s)
  double inter_system_noise = 0.01;         // m/sqrt(s)
  double inter_system_drift_noise = 0.001;  // m/s/sqrt(s)

  bool operator==(const ClockModel&) const = default;
};

// The vehicle constants that the filter estimates, in the order of ekf_index. They are observable
// only with an attitude.
struct VehicleConstantsConfig {
  // The first `count` constants, each from zero. Others join with their first measurement.
  int count = 0;
  std::array<double, ekf_index::kMaxVehicle> sigma{};        // at the start; 0: not estimated
  std::array<double, ekf_index::kMaxVehicle> random_walk{};  // per sqrt(s)

  // The constants keep their values but get their start variances again, whenever the attitude's
  // sigma (tilt or heading) has fallen to this share of what it was (AttitudeConvergence). While an
  // attitude is being corrected the body seems to tilt, which looks like a wrong lever arm. 0:
  // never.
  double restart_share = 0.0;

  // True if a constant that moves the antenna is among them.
  bool moves_antenna() const { return count > ekf_index::kLeverArm; }

  bool operator==(const VehicleConstantsConfig&) const = default;
};

struct EkfConfig {
  // Constant-velocity model: white acceleration, 1 sigma spectral density in (m/s^2)/sqrt(Hz).
  double acceleration_noise_horizontal = 1.0;
  double acceleration_noise_vertical = 0.3;
  // Over a gap in the IMU data the inertial model moves in the same way, and its attitude by a
  // random walk of this much, rad/sqrt(s).
  double gap_attitude_noise = 0.1;
  bool static_point = false;  // MotionModel::kStatic: neither velocity nor acceleration
  // Without attitude the antenna is the lever arm's vertical part above the estimated point.
  // Otherwise (a vehicle waiting for its alignment) the estimated point is the antenna.
  bool vertical_arm = false;
  // Zenith wet delay beyond the modelled one: 1 sigma at the start (0: not estimated), and random
  // walk in m/sqrt(s): a centimetre in an hour.
  double wet_delay_sigma_m = 0.0;
  double wet_delay_noise = 0.01 * (1.0 / 60.0);
  // Use of carrier phases beside code and Doppler, with an ambiguity per arc.
  bool use_carrier = false;
  // Phones measure carriers by another clock than codes: random walk of one against the other,
  // m/sqrt(s), steps included; 0: one clock.
  double carrier_clock_noise = 0.0;
  double max_arc_gap_s = 120.0;  // an ambiguity not observed for longer is dropped
  // Joins a new arc of a carrier to the one before by whole cycles (ArcJoiner), where the
  // probability that they are the wrong ones, or not whole, is below this.
  bool join_arcs = true;
  double wrong_join_probability = 0.05;
  ClockModel clock;
  VehicleConstantsConfig vehicle;
  RobustConfig robust;
  // Correlation time of code errors (multipath, atmosphere), s; 0: independent from epoch to epoch.
  // A filter that takes correlated errors as independent becomes overconfident. Their variance in
  // the gain (not in the outlier test) is therefore multiplied by (1 + r) / (1 - r),
  // r = exp(-dt / correlation time), which gives a long mean the variance that it really has. With
  // learn_errors the time is the least one, and share and time are learned (variance_inflation()).
  double code_correlation_time_s = 0.0;
  double doppler_correlation_time_s = 0.0;
  // Errors of codes and Dopplers that are larger than configured, or last longer, are learned on
  // the way (core/filter/error_model); times that are 0 are then 4 s and 1 s.
  bool learn_errors = true;
  // Median standardized innovation of code, carrier or Doppler, clocks removed (0.67 when all is
  // well). Above it, and if the measurements agree with each other, the prediction is taken to be
  // wrong: the filter inflates its covariance instead of rejecting them all (PredictionTest).
  double prediction_suspect_ratio = 3.0;
  // Share of the codes, or of the Dopplers, rejected in one epoch that makes the epoch suspect.
  double reset_ratio = 0.7;
  // Keeps the recorded process (FilterProcess) for the smoother.
  bool keep_process = false;
  // Suspect epochs in a row before the filter restarts from a point solution.
  int reset_epochs = 3;

  bool operator==(const EkfConfig&) const = default;
};

}  // namespace leonav
