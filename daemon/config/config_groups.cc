#include "daemon/config/config_groups.h"

#include <numbers>

#include "core/capacity.h"

namespace leonav {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMilligal = 1e-5;  // m/s^2
constexpr double kPpm = 1e-6;
constexpr double kHour = 3600.0;
constexpr double kRootHour = 60.0;  // sqrt(s) in sqrt(h)
constexpr double kMillisecond = 1e-3;
// A bracket that settles: a tenth of a degree in an hour.
constexpr double kTravelDirectionWander = 0.1 * kDegree / kRootHour;  // rad/sqrt(s)
constexpr double kConfirming_s = 3.0;
constexpr double kSettlingWander = 0.4 * kDegree;  // rad/sqrt(s)
constexpr double kPercent = 0.01;
// Tyres that get warm: a tenth of a percent in an hour.
constexpr double kOdometerScaleWander = 0.1 * kPercent / kRootHour;  // 1/sqrt(s)
// They do not move; so much, a centimetre and a tenth of a millisecond in an hour, that what was
// found early is found again.
constexpr double kLeverArmWander = 0.01 / kRootHour;                  // m/sqrt(s)
constexpr double kTimeOffsetWander = 0.1 * kMillisecond / kRootHour;  // s/sqrt(s)

// Correlation times from a second to a month.
constexpr Bounds kCorrelationTime = {1.0, 2.6e6};

void read_thread(ConfigReader& group, ThreadConfig* config) {
  group.integer("priority", 0, 99, &config->priority);
  group.integer("cpu", -1, 1023, &config->cpu);
}

// On, off, or as the kind of vehicle has it.
void read_switch(ConfigReader& group, const char* key, bool by_kind, bool* value) {
  int choice = -1;
  group.choice<int>(key, {{"by_kind", -1}, {"true", 1}, {"false", 0}}, &choice);
  *value = choice < 0 ? by_kind : choice == 1;
}

// The direction of travel, where something tells of it.
void read_travel_direction(ConfigReader& group, const MotionConstraintConfig& motion,
                           VehicleConstantsConfig* config) {
  bool estimated = true;
  double sigma = 2.0 * kDegree;
  group.boolean("estimate_travel_direction", &estimated);
  group.number("travel_direction_sigma_deg", {0.01, 20.0}, &sigma, kDegree);
  if (!estimated || !(motion.non_holonomic || motion.odometer)) return;
  if (motion.non_holonomic) config->count = ekf_index::kTravelPitch + 1;
  for (const auto i : {ekf_index::kTravelYaw, ekf_index::kTravelPitch}) {
    config->sigma[static_cast<std::size_t>(i)] = sigma;
    config->wander[static_cast<std::size_t>(i)] = kTravelDirectionWander;
  }
}

// Its scale factor is estimated from its first message on.
void read_odometer(ConfigReader& group, bool wheeled, MotionConstraintConfig* motion,
                   VehicleConstantsConfig* constants) {
  double scale_sigma = 3.0 * kPercent;
  read_switch(group, "odometer", wheeled, &motion->odometer);
  motion->odometer_point_b = motion->point_b;
  group.vector("odometer_point_b_m", {-100.0, 100.0}, &motion->odometer_point_b);
  group.number("odometer_sigma_m_s", {1e-4, 100.0}, &motion->odometer_sigma);
  group.number("odometer_scale_sigma_percent", {0.0, 50.0}, &scale_sigma, kPercent);
  group.number("odometer_resolution_m", {0.0, 10.0}, &motion->odometer_resolution);
  if (!motion->odometer) return;
  constants->sigma[ekf_index::kOdometerScale] = scale_sigma;
  if (scale_sigma > 0.0) constants->wander[ekf_index::kOdometerScale] = kOdometerScaleWander;
}

// A train has a cab at either end.
double reverse_speed(VehicleKind kind) {
  return kind == VehicleKind::kCar ? 5.0 : kind == VehicleKind::kRail ? 1000.0 : 0.0;
}

// Lever arm and time offset: beyond what is configured of them.
void read_antenna_constants(ConfigReader& group, VehicleConstantsConfig* config) {
  bool lever_arm = false, time_offset = false;
  double lever_arm_sigma = 0.1, time_offset_sigma = 10.0 * kMillisecond;
  group.boolean("estimate_lever_arm", &lever_arm);
  group.number("lever_arm_sigma_m", {1e-3, 100.0}, &lever_arm_sigma);
  group.boolean("estimate_time_offset", &time_offset);
  group.number("time_offset_sigma_ms", {1e-3, 1e3}, &time_offset_sigma, kMillisecond);
  if (!lever_arm && !time_offset) return;
  config->count = ekf_index::kMaxVehicle;
  for (std::size_t axis = 0; axis < 3 && lever_arm; ++axis) {
    config->sigma[ekf_index::kLeverArm + axis] = lever_arm_sigma;
    config->wander[ekf_index::kLeverArm + axis] = kLeverArmWander;
  }
  if (!time_offset) return;
  config->sigma[ekf_index::kTimeOffset] = time_offset_sigma;
  config->wander[ekf_index::kTimeOffset] = kTimeOffsetWander;
}

}  // namespace

void read_vehicle(ConfigReader& group, NavigatorConfig* navigator) {
  VehicleConfig* config = &navigator->vehicle;
  group.vector("lever_arm_b_m", {-100.0, 100.0}, &config->lever_arm_b);
  group.vector("mounting_rpy_deg", {-360.0, 360.0}, &config->mounting_rpy, kDegree);
  group.choice<VehicleKind>("kind",
                            {{"car", VehicleKind::kCar},
                             {"rail", VehicleKind::kRail},
                             {"boat", VehicleKind::kBoat},
                             {"uav", VehicleKind::kUav},
                             {"handheld", VehicleKind::kHandheld}},
                            &config->kind);
  MotionConstraintConfig& motion = config->motion.constraints;
  const bool wheeled = config->kind == VehicleKind::kCar || config->kind == VehicleKind::kRail;
  read_switch(group, "non_holonomic", wheeled, &motion.non_holonomic);
  read_switch(group, "zero_velocity", wheeled, &motion.zero_velocity);
  group.number("constraint_interval_s", {0.1, 1.0}, &motion.interval_s);
  group.vector("constraint_point_b_m", {-100.0, 100.0}, &motion.point_b);
  group.number("side_velocity_sigma_m_s", {1e-4, 100.0}, &motion.side_sigma);
  group.number("vertical_velocity_sigma_m_s", {1e-4, 100.0}, &motion.vertical_sigma);
  group.number("slip_deg_per_m_s2", {0.0, 45.0}, &motion.slip_per_acceleration, kDegree);
  group.number("standing_velocity_sigma_m_s", {1e-4, 100.0}, &motion.standing_velocity_sigma);
  group.number("standing_rate_sigma_deg_s", {1e-6, 100.0}, &motion.standing_rate_sigma, kDegree);
  group.number("constraint_gate", {1.0, 100.0}, &motion.gate);
  read_odometer(group, wheeled, &motion, &navigator->ekf.vehicle);
  read_travel_direction(group, motion, &navigator->ekf.vehicle);
  read_antenna_constants(group, &navigator->ekf.vehicle);
}

void read_imu_stamps(ConfigReader& group, double* time_offset_s) {
  group.number("time_offset_ms", {-1e3, 1e3}, time_offset_s, kMillisecond);
}

void read_imu(ConfigReader& group, ImuErrorModel* config) {
  group.number("angle_random_walk_deg_per_sqrt_h", {1e-6, 100.0}, &config->angle_random_walk,
               kDegree / kRootHour);
  group.number("velocity_random_walk_m_s_per_sqrt_h", {1e-6, 100.0}, &config->velocity_random_walk,
               1.0 / kRootHour);
  group.number("gyro_bias_deg_per_h", {0.0, 1e6}, &config->gyro_bias.sigma, kDegree / kHour);
  group.number("gyro_bias_time_s", kCorrelationTime, &config->gyro_bias.correlation_time_s);
  group.number("accel_bias_mgal", {0.0, 1e6}, &config->accel_bias.sigma, kMilligal);
  group.number("accel_bias_time_s", kCorrelationTime, &config->accel_bias.correlation_time_s);
  group.number("gyro_scale_ppm", {0.0, 1e5}, &config->gyro_scale.sigma, kPpm);
  group.number("gyro_scale_time_s", kCorrelationTime, &config->gyro_scale.correlation_time_s);
  group.number("accel_scale_ppm", {0.0, 1e5}, &config->accel_scale.sigma, kPpm);
  group.number("accel_scale_time_s", kCorrelationTime, &config->accel_scale.correlation_time_s);
}

void read_alignment(ConfigReader& group, const VehicleConfig& vehicle, AlignmentConfig* config) {
  const bool handheld = vehicle.kind == VehicleKind::kHandheld;
  read_switch(group, "velocity_matching", !handheld, &config->velocity_matching);
  group.number("matching_window_s", {5.0, 120.0}, &config->matching_window_s);
  group.number("max_matching_sigma_deg", {0.1, 20.0}, &config->max_matching_sigma, kDegree);
  config->lever_arm_b = vehicle.lever_arm_b;
  read_switch(group, "heading_watch", !handheld, &config->heading_watch);
  std::optional<double> reverse, wander, confirming;
  group.number("max_reverse_speed_m_s", {0.0, 1000.0}, &reverse);
  config->max_reverse_speed_m_s = reverse.value_or(reverse_speed(vehicle.kind));
  group.number("confirming_s", {0.0, 60.0}, &confirming);
  config->confirming_s = confirming.value_or(handheld ? 0.0 : kConfirming_s);
  group.number("settling_wander_deg_per_sqrt_s", {0.0, 10.0}, &wander, kDegree);
  config->settling_wander = wander.value_or(handheld ? 0.0 : kSettlingWander);
  group.number("settling_s", {0.0, 600.0}, &config->settling_s);
  group.number("levelling_window_s", {0.05, 60.0}, &config->levelling_window_s);
  group.number("levelling_sigma_deg", {0.01, 45.0}, &config->levelling_sigma, kDegree);
  group.number("min_course_speed_m_s", {0.05, 100.0}, &config->min_course_speed_m_s);
  group.number("max_course_sigma_deg", {0.1, 90.0}, &config->max_course_sigma, kDegree);
  group.number("course_window_s", {0.1, 60.0}, &config->course_window_s);
  group.number("course_against_heading_deg", {0.01, 90.0}, &config->course_against_heading,
               kDegree);
  group.number("turning_arm_m", {0.0, 100.0}, &config->turning_arm_m);
  group.number("initial_heading_deg", {-360.0, 360.0}, &config->initial_heading, kDegree);
  group.number("initial_heading_sigma_deg", {0.01, 180.0}, &config->initial_heading_sigma, kDegree);
  group.number("static_gyro_deg_per_s", {0.0, 100.0}, &config->static_gyro_rad_s, kDegree);
  group.number("max_gyrocompass_sigma_deg", {0.0, 45.0}, &config->max_gyrocompass_sigma, kDegree);
  group.number("static_accel_m_s2", {0.0, 10.0}, &config->static_accel_m_s2);
}

void read_ekf(ConfigReader& group, NavigatorConfig* config) {
  group.choice<MotionModel>("motion",
                            {{"inertial", MotionModel::kInertial},
                             {"constant_velocity", MotionModel::kConstantVelocity},
                             {"static", MotionModel::kStatic}},
                            &config->motion);
  EkfConfig& ekf = config->ekf;
  constexpr Bounds kNoise = {0.0, 1e4};
  group.number("acceleration_noise_horizontal_m_s2_per_sqrt_hz", {1e-6, 1e3},
               &ekf.acceleration_noise_horizontal);
  group.number("acceleration_noise_vertical_m_s2_per_sqrt_hz", {1e-6, 1e3},
               &ekf.acceleration_noise_vertical);
  ekf.static_point = config->motion == MotionModel::kStatic;
  ekf.vertical_arm = config->motion != MotionModel::kInertial;
  group.boolean("carrier", &ekf.use_carrier);
  group.number("carrier_clock_noise_m_per_sqrt_s", {0.0, 1e6}, &ekf.carrier_clock_noise);
  group.number("max_arc_gap_s", {0.1, 600.0}, &ekf.max_arc_gap_s);
  group.number("wet_delay_sigma_m", {0.0, 1.0}, &ekf.wet_delay_sigma_m);
  group.number("wet_delay_noise_m_per_sqrt_h", {0.0, 1.0}, &ekf.wet_delay_noise, 1.0 / kRootHour);
  group.number("clock_offset_noise_m_per_sqrt_s", kNoise, &ekf.clock.offset_noise);
  group.number("clock_drift_noise_m_s_per_sqrt_s", kNoise, &ekf.clock.drift_noise);
  group.number("inter_system_noise_m_per_sqrt_s", kNoise, &ekf.clock.inter_system_noise);
  group.number("inter_system_drift_noise_m_s_per_sqrt_s", kNoise,
               &ekf.clock.inter_system_drift_noise);
  group.number("code_correlation_time_s", {0.0, 1e4}, &ekf.code_correlation_time_s);
  group.number("doppler_correlation_time_s", {0.0, 1e4}, &ekf.doppler_correlation_time_s);
  group.number("hole_attitude_noise_rad_per_sqrt_s", {0.0, 10.0}, &ekf.hole_attitude_noise);
  group.number("prediction_suspect_ratio", {1.0, 100.0}, &ekf.prediction_suspect_ratio);
  group.number("reset_ratio", {0.1, 1.0}, &ekf.reset_ratio);
  group.integer("reset_epochs", 1, 1000, &ekf.reset_epochs);
}

void read_smoother(ConfigReader& group, SmootherConfig* config) {
  group.integer("window", 1, static_cast<int>(kMaxWindow), &config->window);
  group.number("keyframe_interval_s", {0.0, 10.0}, &config->keyframe_interval_s);
  group.integer("max_iterations", 1, 20, &config->max_iterations);
  group.boolean("reweigh", &config->reweigh);
  group.number("code_alike_s", {0.0, 1e4}, &config->code_alike_s);
  group.number("time_limit_ms", {0.0, 1e4}, &config->time_limit_s, kMillisecond);
  group.number("converged_sigmas", {1e-9, 1.0}, &config->converged_sigmas);
}

void read_robust(ConfigReader& group, RobustConfig* config) {
  group.boolean("enabled", &config->enabled);
  group.number("k0", {0.1, 100.0}, &config->k0);
  group.number("k1", {0.1, 1000.0}, &config->k1);
  group.integer("max_iterations", 1, 100, &config->max_iterations);
  if (config->k1 <= config->k0) group.fail("k1", "must be greater than k0");
}

void read_realtime(ConfigReader& group, NavigatorConfig* navigator, ThreadsConfig* threads) {
  RealtimeConfig& realtime = navigator->realtime;
  group.number("deadline_ekf_ms", {1.0, 1e4}, &realtime.deadline_ekf_s, kMillisecond);
  group.number("deadline_smoother_ms", {1.0, 1e4}, &realtime.deadline_smoother_s, kMillisecond);
  group.number("epoch_interval_s", {0.05, 120.0}, &realtime.epoch_interval_s);
  group.number("gnss_latency_allowance_ms", {0.0, 2000.0}, &realtime.gnss_latency_allowance_s,
               kMillisecond);
  group.number("solution_rate_hz", {0.01, 1000.0}, &navigator->solution_rate_hz);
  group.boolean("lock_memory", &threads->lock_memory);
  group.group("io", [&](ConfigReader& thread) { read_thread(thread, &threads->io); });
  group.group("ins", [&](ConfigReader& thread) { read_thread(thread, &threads->ins); });
  group.group("gnss", [&](ConfigReader& thread) { read_thread(thread, &threads->gnss); });
  group.group("smoother", [&](ConfigReader& thread) { read_thread(thread, &threads->smoother); });
  group.group("out", [&](ConfigReader& thread) { read_thread(thread, &threads->out); });
}

void read_drill(ConfigReader& group, DrillConfig* config) {
  group.integer("late_solve_every", 0, 1000000, &config->late_solve_every);
  group.number("late_solve_ms", {0.0, 1e4}, &config->late_solve_s, kMillisecond);
}

void read_lcm(ConfigReader& group, LcmConfig* config) {
  group.text("url", &config->url);
  group.text("prefix", &config->prefix);
  group.integer("receive_queue", 1, 1000000, &config->receive_queue);
  // liblcm allows 63 characters in a channel's name; the longest of ours has 10.
  if (config->prefix.size() > 50) group.fail("prefix", "longer than 50 characters");
  if (config->url.starts_with("tcpq:")) {
    group.fail("url", "tcpq:// ends the process when its server is away; use udpm:// or memq://");
  }
  if (config->url.empty()) group.fail("url", "must not be empty");
}

void read_journal(ConfigReader& group, JournalConfig* config) {
  group.text("path", &config->path);
  group.number("flush_interval_s", {0.01, 3600.0}, &config->flush_interval_s);
}

void read_checkpoint(ConfigReader& group, CheckpointConfig* config, NavigatorConfig* navigator) {
  group.text("path", &config->path);
  group.number("interval_s", {1.0, 3600.0}, &config->interval_s);
  group.number("max_age_s", {1.0, 1e9}, &navigator->checkpoint_max_age_s);
}

}  // namespace leonav
