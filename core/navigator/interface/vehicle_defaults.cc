#include "core/navigator/interface/vehicle_defaults.h"
#include "core/base/angle.h"

namespace leonav {
namespace {

constexpr double kRootHour = 60.0;  // sqrt(s) in sqrt(h)
// A bracket that settles turns by about a tenth of a degree in an hour.
constexpr double kTravelDirectionRandomWalk = 0.1 * kDegree / kRootHour;  // rad/sqrt(s)
// Tyres that get warm grow by about a tenth of a percent in an hour.
constexpr double kOdometerScaleRandomWalk = 0.1 * 0.01 / kRootHour;  // 1/sqrt(s)
// Lever arm and time offset do not move; a centimetre and a tenth of a millisecond in an hour keep
// the filter able to correct an early error.
constexpr double kLeverArmRandomWalk = 0.01 / kRootHour;          // m/sqrt(s)
constexpr double kTimeOffsetRandomWalk = 0.1 * 1e-3 / kRootHour;  // s/sqrt(s)

static_assert(kDefaultTravelDirectionSigma == 2.0 * kDegree);

}  // namespace

VehicleDefaults defaults_of(VehicleKind kind) {
  VehicleDefaults defaults;
  const bool handheld = kind == VehicleKind::kHandheld;
  const bool wheeled = kind == VehicleKind::kCar || kind == VehicleKind::kRail;
  defaults.non_holonomic = defaults.zero_velocity = defaults.odometer = wheeled;
  defaults.velocity_matching = defaults.heading_watch = !handheld;
  // A train has a cab at either end.
  if (kind == VehicleKind::kCar) defaults.max_reverse_speed_m_s = 5.0;
  if (kind == VehicleKind::kRail) defaults.max_reverse_speed_m_s = 1000.0;
  if (handheld) defaults.confirming_s = 0.0;
  if (!handheld) defaults.settling_random_walk = 0.4 * kDegree;
  return defaults;
}

NavigatorConfig default_navigator_config(VehicleKind kind) {
  const VehicleDefaults defaults = defaults_of(kind);
  NavigatorConfig config;
  config.gnss = default_gnss_config();
  config.imu = consumer_mems_errors();
  config.vehicle.kind = kind;
  MotionConstraintConfig& motion = config.vehicle.motion.constraints;
  motion.non_holonomic = defaults.non_holonomic;
  motion.zero_velocity = defaults.zero_velocity;
  motion.odometer = defaults.odometer;
  estimate_travel_direction(motion, kDefaultTravelDirectionSigma, &config.ekf.vehicle);
  if (motion.odometer) estimate_odometer_scale(kDefaultOdometerScaleSigma, &config.ekf.vehicle);
  AlignmentConfig& alignment = config.alignment;
  alignment.velocity_matching = defaults.velocity_matching;
  alignment.heading_watch = defaults.heading_watch;
  alignment.max_reverse_speed_m_s = defaults.max_reverse_speed_m_s;
  alignment.confirming_s = defaults.confirming_s;
  alignment.settling_random_walk = defaults.settling_random_walk;
  return config;
}

void estimate_travel_direction(const MotionConstraintConfig& motion, double sigma,
                               VehicleConstantsConfig* constants) {
  if (!motion.non_holonomic && !motion.odometer) return;
  if (motion.non_holonomic) constants->count = ekf_index::kTravelPitch + 1;
  for (const std::size_t i : {ekf_index::kTravelYaw, ekf_index::kTravelPitch}) {
    constants->sigma[i] = sigma;
    constants->random_walk[i] = kTravelDirectionRandomWalk;
  }
}

void estimate_odometer_scale(double sigma, VehicleConstantsConfig* constants) {
  constants->sigma[ekf_index::kOdometerScale] = sigma;
  if (sigma > 0.0) constants->random_walk[ekf_index::kOdometerScale] = kOdometerScaleRandomWalk;
}

void estimate_lever_arm(double sigma, VehicleConstantsConfig* constants) {
  constants->count = ekf_index::kMaxVehicle;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    constants->sigma[ekf_index::kLeverArm + axis] = sigma;
    constants->random_walk[ekf_index::kLeverArm + axis] = kLeverArmRandomWalk;
  }
}

void estimate_time_offset(double sigma, VehicleConstantsConfig* constants) {
  constants->count = ekf_index::kMaxVehicle;
  constants->sigma[ekf_index::kTimeOffset] = sigma;
  constants->random_walk[ekf_index::kTimeOffset] = kTimeOffsetRandomWalk;
}

}  // namespace leonav
