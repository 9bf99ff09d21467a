// VehicleDefaults holds the defaults of the configuration that depend on the kind of vehicle.
#pragma once
#include "core/navigator/interface/navigator_config.h"

namespace leonav {

// The defaults of one kind of vehicle.
struct VehicleDefaults {
  // Motion constraints. Wheels neither slide sideways nor leave the ground, and a wheeled vehicle
  // sometimes stands.
  bool non_holonomic = false, zero_velocity = false, odometer = false;
  bool velocity_matching = true, heading_watch = true;  // see AlignmentConfig
  double max_reverse_speed_m_s = 0.0;
  double confirming_s = 3.0;
  double settling_random_walk = 0.0;  // rad/sqrt(s)
};

VehicleDefaults defaults_of(VehicleKind kind);

// Returns the whole default configuration of a vehicle with a consumer MEMS IMU.
NavigatorConfig default_navigator_config(VehicleKind kind);

// 1 sigma at the start of the vehicle constants that are estimated by default.
inline constexpr double kDefaultTravelDirectionSigma = 0.034906585039886591;  // rad, 2 degrees
inline constexpr double kDefaultOdometerScaleSigma = 0.03;                    // 1

// The functions below let the filter estimate one vehicle constant each, as a correction of the
// configured value. `sigma` is its 1 sigma at the start. Each also sets a random walk that keeps
// the estimate open.

// Estimates yaw and pitch (rad) of the direction of travel in body axes, as far as `motion`
// measures them.
void estimate_travel_direction(const MotionConstraintConfig& motion, double sigma,
                               VehicleConstantsConfig* constants);
// Estimates the odometer's scale factor, from its first message on; `sigma` 0: not estimated.
void estimate_odometer_scale(double sigma, VehicleConstantsConfig* constants);
// Estimates the lever arm, m; `sigma` holds for each axis.
void estimate_lever_arm(double sigma, VehicleConstantsConfig* constants);
// Estimates the time offset of the IMU's stamps, s.
void estimate_time_offset(double sigma, VehicleConstantsConfig* constants);

}  // namespace leonav
