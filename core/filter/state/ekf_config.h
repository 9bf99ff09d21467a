// Tuning of the extended Kalman filter. SI units.
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
  // Random walks of the receiver oscillator, common to all time bases, and of each base against it.
  double offset_noise = 1.0;                // m/sqrt(s)
  double drift_noise = 0.5;                 // m/s/sqrt(s)
  double inter_system_noise = 0.01;         // m/sqrt(s)
  double inter_system_drift_noise = 0.001;  // m/s/sqrt(s)

  bool operator==(const ClockModel&) const = default;
};

// The vehicle's constants that the filter estimates, in the order of ekf_index. Without an IMU's
// attitude nothing is known of them.
struct VehicleConstantsConfig {
  // The first so many; each starts from zero. Others join when something tells of them.
  int count = 0;
  std::array<double, ekf_index::kMaxVehicle> sigma{};        // at the start; 0: not estimated
  std::array<double, ekf_index::kMaxVehicle> random_walk{};  // random walk, per sqrt(s)

  // Known no more, but where they are, whenever the attitude's sigma (tilt or heading) has fallen
  // to this share of what it was at their start: an attitude that is corrected looks like a body
  // that tilts, and so tells of a lever arm what is not so. 0: never.
  double restart_share = 0.0;

  // Whether any of those that move the antenna is among them.
  bool moves_antenna() const { return count > ekf_index::kLeverArm; }

  bool operator==(const VehicleConstantsConfig&) const = default;
};

struct EkfConfig {
  // Constant-velocity model: white acceleration, 1 sigma spectral density in (m/s^2)/sqrt(Hz).
  double acceleration_noise_horizontal = 1.0;
  double acceleration_noise_vertical = 0.3;
  // Over a hole in the IMU data the inertial model moves by the same, its attitude turning by a
  // random walk of this much, rad/sqrt(s).
  double gap_attitude_noise = 0.1;
  bool static_point = false;  // MotionModel::kStatic: neither velocity nor acceleration
  // Without attitude the antenna is this lever arm's vertical part above the point in question;
  // else (a vehicle waiting for its alignment) the state is the antenna's.
  bool vertical_arm = false;
  // Zenith wet delay beyond the modelled one: 1 sigma at the start (0: not estimated), and random
  // walk in m/sqrt(s): a centimetre in an hour.
  double wet_delay_sigma_m = 0.0;
  double wet_delay_noise = 0.01 * (1.0 / 60.0);
  // Carriers beside code and Doppler, with an ambiguity per arc.
  bool use_carrier = false;
  // Receivers that count carriers by another clock than codes (phones): random walk of one against
  // the other, m/sqrt(s), steps included; 0: one clock.
  double carrier_clock_noise = 0.0;
  double max_arc_gap_s = 120.0;  // an ambiguity not observed for longer is dropped
  ClockModel clock;
  VehicleConstantsConfig vehicle;
  RobustConfig robust;
  // Code errors (multipath, atmosphere) stay alike over about this long, s; 0: independent from
  // epoch to epoch. A filter that takes them as independent averages what does not average and
  // becomes overconfident: their variance in the gain (not in the outlier test) is multiplied by
  // (1 + r) / (1 - r), r = exp(-dt / this), which gives a long mean the variance it really has.
  double code_correlation_time_s = 0.0;
  double doppler_correlation_time_s = 0.0;
  // Median standardized innovation of code, carrier or Doppler, clocks taken out (0.67 when all is
  // well), from which on the prediction is taken to be wrong, not the measurements, if these agree:
  // the filter widens its covariance (for ranges, or Dopplers alone against an IMU, at the second
  // such epoch) instead of rejecting them all.
  double prediction_suspect_ratio = 3.0;
  double reset_ratio =
      0.7;  // share of code measurements rejected in one epoch that counts as suspect
  // Whether Ekf::process() is kept, for the smoother.
  bool keep_process = false;
  int reset_epochs = 3;  // suspect epochs in a row before the filter restarts from a point solution

  bool operator==(const EkfConfig&) const = default;
};

}  // namespace leonav
