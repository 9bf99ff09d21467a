#include "daemon/config/config_groups.h"

#include "core/base/angle.h"
#include "core/base/capacity.h"
#include "core/navigator/interface/vehicle_defaults.h"
#include "daemon/config/lcm_url.h"

namespace leonav {
namespace {

constexpr double kMilligal = 1e-5;  // m/s^2
constexpr double kPpm = 1e-6;
constexpr double kHour = 3600.0;
constexpr double kRootHour = 60.0;  // sqrt(s) in sqrt(h)
constexpr double kMillisecond = 1e-3;
constexpr double kPercent = 0.01;
constexpr const char* kKind = "vehicle.kind";

// Correlation times from a second to a month.
constexpr Bounds kCorrelationTime = {1.0, 2.6e6};

void read_thread(ConfigReader& group, ThreadConfig* config) {
  group.integer("priority", 0, 99, &config->priority);
  group.integer("cpu", -1, 1023, &config->cpu);
}

// The direction of travel is estimated where a constraint or an odometer measures it.
void read_travel_direction(ConfigReader& group, const MotionConstraintConfig& motion,
                           VehicleConstantsConfig* config) {
  bool estimated = true;
  double sigma = kDefaultTravelDirectionSigma;
  group.boolean("estimate_travel_direction", &estimated);
  group.number("travel_direction_sigma_deg", {0.01, 20.0}, &sigma, kDegree);
  if (estimated) estimate_travel_direction(motion, sigma, config);
}

// Its scale factor is estimated from its first message on.
void read_odometer(ConfigReader& group, const VehicleDefaults& defaults,
                   MotionConstraintConfig* motion, VehicleConstantsConfig* constants) {
  double scale_sigma = kDefaultOdometerScaleSigma;
  group.switch_or("odometer", defaults.odometer, kKind, &motion->odometer);
  group.vector_or("odometer_point_b_m", {-100.0, 100.0}, motion->point_b,
                  "vehicle.constraint_point_b_m", &motion->odometer_point_b);
  group.number("odometer_sigma_m_s", {1e-4, 100.0}, &motion->odometer_sigma);
  group.number("odometer_scale_sigma_percent", {0.0, 50.0}, &scale_sigma, kPercent);
  group.number("odometer_resolution_m", {0.0, 10.0}, &motion->odometer_resolution);
  if (motion->odometer) estimate_odometer_scale(scale_sigma, constants);
}

// Corrections of the configured lever arm and time offset.
void read_antenna_constants(ConfigReader& group, VehicleConstantsConfig* config) {
  bool lever_arm = false, time_offset = false;
  double lever_arm_sigma = 0.1, time_offset_sigma = 10.0 * kMillisecond;
  group.boolean("estimate_lever_arm", &lever_arm);
  group.number("lever_arm_sigma_m", {1e-3, 100.0}, &lever_arm_sigma);
  group.boolean("estimate_time_offset", &time_offset);
  group.number("time_offset_sigma_ms", {1e-3, 1e3}, &time_offset_sigma, kMillisecond);
  if (lever_arm) estimate_lever_arm(lever_arm_sigma, config);
  if (time_offset) estimate_time_offset(time_offset_sigma, config);
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
  const VehicleDefaults defaults = defaults_of(config->kind);
  group.switch_or("non_holonomic", defaults.non_holonomic, kKind, &motion.non_holonomic);
  group.switch_or("zero_velocity", defaults.zero_velocity, kKind, &motion.zero_velocity);
  group.number("constraint_interval_s", {0.1, 1.0}, &motion.interval_s);
  group.vector("constraint_point_b_m", {-100.0, 100.0}, &motion.point_b);
  group.number("side_velocity_sigma_m_s", {1e-4, 100.0}, &motion.side_sigma);
  group.number("vertical_velocity_sigma_m_s", {1e-4, 100.0}, &motion.vertical_sigma);
  group.number("slip_deg_per_m_s2", {0.0, 45.0}, &motion.slip_per_acceleration, kDegree);
  group.number("standing_velocity_sigma_m_s", {1e-4, 100.0}, &motion.standing_velocity_sigma);
  group.number("standing_rate_sigma_deg_s", {1e-6, 100.0}, &motion.standing_rate_sigma, kDegree);
  group.number("constraint_gate", {1.0, 100.0}, &motion.gate);
  read_odometer(group, defaults, &motion, &navigator->ekf.vehicle);
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
  const VehicleDefaults defaults = defaults_of(vehicle.kind);
  config->lever_arm_b = vehicle.lever_arm_b;
  group.number("levelling_window_s", {0.05, 60.0}, &config->levelling_window_s);
  group.number("levelling_sigma_deg", {0.01, 45.0}, &config->levelling_sigma, kDegree);
  group.number("static_gyro_deg_per_s", {0.0, 100.0}, &config->static_gyro_rad_s, kDegree);
  group.number("static_accel_m_s2", {0.0, 10.0}, &config->static_accel_m_s2);
  group.number("max_gyrocompass_sigma_deg", {0.0, 45.0}, &config->max_gyrocompass_sigma, kDegree);
  group.number("initial_heading_deg", {-360.0, 360.0}, &config->initial_heading, kDegree);
  group.number("initial_heading_sigma_deg", {0.01, 180.0}, &config->initial_heading_sigma, kDegree);
  group.number("min_course_speed_m_s", {0.05, 100.0}, &config->min_course_speed_m_s);
  group.number("max_course_sigma_deg", {0.1, 90.0}, &config->max_course_sigma, kDegree);
  group.number("course_window_s", {0.1, 60.0}, &config->course_window_s);
  group.number("course_against_heading_deg", {0.01, 90.0}, &config->course_heading_sigma, kDegree);
  group.number("turning_arm_m", {0.0, 100.0}, &config->turning_arm_m);
  group.number_or("max_reverse_speed_m_s", {0.0, 1000.0}, defaults.max_reverse_speed_m_s, kKind,
                  &config->max_reverse_speed_m_s);
  group.switch_or("velocity_matching", defaults.velocity_matching, kKind,
                  &config->velocity_matching);
  group.number("matching_window_s", {5.0, 120.0}, &config->matching_window_s);
  group.number("max_matching_sigma_deg", {0.1, 20.0}, &config->max_matching_sigma, kDegree);
  group.number_or("confirming_s", {0.0, 60.0}, defaults.confirming_s, kKind, &config->confirming_s);
  group.number_or("settling_wander_deg_per_sqrt_s", {0.0, 10.0}, defaults.settling_random_walk,
                  kKind, &config->settling_random_walk, kDegree);
  group.number("settling_s", {0.0, 600.0}, &config->settling_s);
  group.switch_or("heading_watch", defaults.heading_watch, kKind, &config->heading_watch);
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
  group.boolean("join_arcs", &ekf.join_arcs);
  group.number("wrong_join_probability", {1e-12, 0.1}, &ekf.wrong_join_probability);
  group.number("wet_delay_sigma_m", {0.0, 1.0}, &ekf.wet_delay_sigma_m);
  group.number("wet_delay_noise_m_per_sqrt_h", {0.0, 1.0}, &ekf.wet_delay_noise, 1.0 / kRootHour);
  group.number("clock_offset_noise_m_per_sqrt_s", kNoise, &ekf.clock.offset_noise);
  group.number("clock_drift_noise_m_s_per_sqrt_s", kNoise, &ekf.clock.drift_noise);
  group.number("inter_system_noise_m_per_sqrt_s", kNoise, &ekf.clock.inter_system_noise);
  group.number("inter_system_drift_noise_m_s_per_sqrt_s", kNoise,
               &ekf.clock.inter_system_drift_noise);
  group.number("code_correlation_time_s", {0.0, 1e4}, &ekf.code_correlation_time_s);
  group.number("doppler_correlation_time_s", {0.0, 1e4}, &ekf.doppler_correlation_time_s);
  group.boolean("learn_errors", &ekf.learn_errors);
  group.number("hole_attitude_noise_rad_per_sqrt_s", {0.0, 10.0}, &ekf.gap_attitude_noise);
  group.number("prediction_suspect_ratio", {1.0, 100.0}, &ekf.prediction_suspect_ratio);
  group.number("reset_ratio", {0.1, 1.0}, &ekf.reset_ratio);
  group.integer("reset_epochs", 1, 1000, &ekf.reset_epochs);
}

void read_smoother(ConfigReader& group, SmootherConfig* config) {
  group.choice<SmootherSolver>(
      "solver", {{"chain", SmootherSolver::kChain}, {"ceres", SmootherSolver::kCeres}},
      &config->solver);
  group.choice<CeresLoss>(
      "ceres_loss",
      {{"igg3", CeresLoss::kIgg3}, {"huber", CeresLoss::kHuber}, {"cauchy", CeresLoss::kCauchy}},
      &config->ceres_loss);
  group.integer("window", 1, static_cast<int>(kMaxWindow), &config->window);
  group.number("keyframe_interval_s", {0.0, 10.0}, &config->keyframe_interval_s);
  group.integer("max_iterations", 1, 20, &config->max_iterations);
  group.boolean("reweigh", &config->reweigh);
  group.number("reweigh_s", {0.0, 1e4}, &config->reweigh_s);
  group.number("code_alike_s", {0.0, 1e4}, &config->code_alike_s);
  group.number("time_limit_ms", {0.0, 1e4}, &config->time_limit_s, kMillisecond);
  group.number("converged_sigmas", {1e-9, 1.0}, &config->converged_sigmas);
  group.boolean("fixed_lag", &config->fixed_lag);
  group.integer("drill_failure_every", 0, 1000000, &config->drill_failure_every);
  group.choice<DrilledFailure>(
      "drill_failure",
      {{"singular", DrilledFailure::kSingular}, {"diverged", DrilledFailure::kDiverged}},
      &config->drill_failure);
}

void read_robust(ConfigReader& group, RobustConfig* config) {
  group.boolean("enabled", &config->enabled);
  group.number("k0", {0.1, 100.0}, &config->k0);
  group.number("k1", {0.1, 1000.0}, &config->k1);
  group.integer("max_iterations", 1, 100, &config->max_iterations);
  if (config->k1 <= config->k0) group.report("k1", "must be greater than k0");
}

void read_integrity(ConfigReader& group, IntegrityConfig* config) {
  constexpr Bounds kAlertLimit = {0.0, 1e6}, kFaultRate = {0.0, 1e-3};
  group.number("risk_per_hour", {1e-12, 0.1}, &config->risk_per_hour);
  group.number("error_correlation_s", {0.01, 3600.0}, &config->error_correlation_s);
  group.number("sigma_factor", {0.1, 100.0}, &config->overbound.sigma_factor);
  group.number("tail_share", {0.0, 0.5}, &config->overbound.tail_share);
  group.number("tail_factor", {1.0, 100.0}, &config->overbound.tail_factor);
  group.number("satellite_faults_per_hour", kFaultRate, &config->satellite_faults_per_hour);
  group.number("system_faults_per_hour", kFaultRate, &config->system_faults_per_hour);
  group.number("leo_faults_per_hour", {0.0, 0.1}, &config->leo_faults_per_hour);
  group.number("missed_slips_per_hour", {0.0, 1.0}, &config->missed_slips_per_hour);
  group.number("fault_exposure_s", {1.0, 3600.0}, &config->fault_exposure_s);
  group.number("horizontal_alert_limit_m", kAlertLimit, &config->horizontal_alert_limit_m);
  group.number("vertical_alert_limit_m", kAlertLimit, &config->vertical_alert_limit_m);
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
  // liblcm allows 63 characters in a channel's name; the longest of ours has 16.
  if (config->prefix.size() > 47) group.report("prefix", "longer than 47 characters");
  if (config->url.starts_with("tcpq:")) {
    group.report("url", "tcpq:// ends the process when its server is away; use udpm:// or memq://");
  }
  if (config->url.empty()) group.report("url", "must not be empty");
  if (const auto to = udpm_address(config->url); to && !is_multicast(to->group)) {
    group.report("url",
                 "'" + to->group + "' is not a multicast address (224.0.0.0 to 239.255.255.255)");
  }
}

void read_commands(ConfigReader& group, CommandsConfig* config) {
  group.text("key_file", &config->key_file);
}

void read_journal(ConfigReader& group, JournalConfig* config) {
  group.text("path", &config->path);
  group.choice<JournalOutputs>("outputs",
                               {{"all", JournalOutputs::kAll},
                                {"thinned", JournalOutputs::kThinned},
                                {"none", JournalOutputs::kNone}},
                               &config->outputs);
  group.number("flush_interval_s", {0.01, 3600.0}, &config->flush_interval_s);
  group.number("buffer_mb", {0.2, 1000.0}, &config->buffer_mb);
  group.number("piece_mb", {0.1, 1e6}, &config->piece_mb);
  group.number("piece_s", {0.0, 1e7}, &config->piece_s);
  group.number("total_mb", {0.0, 1e9}, &config->total_mb);
  group.number("kept_mb", {0.0, 1e9}, &config->kept_mb);
  // A limit must leave room for the piece that is written and one before it.
  if (config->total_mb > 0.0 && config->total_mb < 2.0 * config->piece_mb)
    group.report("total_mb", "must be at least twice piece_mb, or 0");
  if (config->kept_mb > 0.0 && config->kept_mb < 2.0 * config->piece_mb)
    group.report("kept_mb", "must be at least twice piece_mb, or 0");
}

void read_log(ConfigReader& group, LogConfig* config) {
  group.choice<LogLevel>(
      "level",
      {{"info", LogLevel::kInfo}, {"warning", LogLevel::kWarning}, {"error", LogLevel::kError}},
      &config->level);
}

void read_checkpoint(ConfigReader& group, CheckpointConfig* config, NavigatorConfig* navigator) {
  group.text("path", &config->path);
  group.number("interval_s", {1.0, 3600.0}, &config->interval_s);
  group.number("max_age_s", {1.0, 1e9}, &navigator->checkpoint_max_age_s);
}

}  // namespace leonav
