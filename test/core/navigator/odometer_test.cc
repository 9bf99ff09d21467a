// An odometer in the navigator: the scale factor found, a tunnel passed, a wheel that is locked,
// and what it tells of standing.
#include <cmath>
#include <cstdio>

#include "odometer_drive.h"
#include "support/catch.h"

namespace leonav::test {
namespace {

using ekf_index::kOdometerScale;

constexpr double kTunnelBegin_s = 110.0, kTunnelEnd_s = 170.0;

SyntheticDriveOptions biased_drive() {
  SyntheticDriveOptions options;
  options.duration_s = 200.0;
  options.code_sigma_m = 1.0;
  options.doppler_sigma_m_s = 0.05;
  options.carrier_sigma_m = 0.003;
  options.angle_random_walk = 1e-4;
  options.velocity_random_walk = 1e-2;
  options.gyro_bias_b = {2e-4, -3e-4, 4e-4};
  options.accel_bias_b = {0.05, -0.08, 0.02};
  return options;
}

NavigatorConfig config_of(const SyntheticDriveOptions& options, Estimator estimator) {
  NavigatorConfig config = drive_navigator_config(options);
  config.estimator = estimator;
  config.ekf.use_carrier = true;
  config.imu.velocity_random_walk = 1e-2;
  config.imu.gyro_bias.sigma = 5e-4;
  config.imu.accel_bias.sigma = 0.08;
  MotionConstraintConfig& motion = config.vehicle.motion.constraints;
  motion.non_holonomic = motion.zero_velocity = motion.odometer = true;
  motion.odometer_resolution = 0.05;
  config.ekf.vehicle = {2, {0.03, 0.03, 0.03}, {3e-5, 3e-5, 2e-5}};
  return config;
}

SyntheticDrive darkened(SyntheticDrive drive) {
  for (RawEpoch& epoch : drive.epochs)
    if (seconds(epoch.time) > kTunnelBegin_s && seconds(epoch.time) < kTunnelEnd_s)
      epoch.observations.clear();
  return drive;
}

struct Outcome {
  RecordingSink sink;
  double scale = 0.0, sigma = 0.0;
  bool has_scale = false;
  Sequencer::Counters counters;
};

Outcome drive_with(const SyntheticDrive& drive, const std::vector<OdometerIncrement>& wheel,
                   const NavigatorConfig& config, double late_s = 0.01) {
  Outcome outcome;
  Navigator pipeline(config, &outcome.sink);
  feed_with_wheel(drive, wheel, late_s, &pipeline);
  const Ekf& ekf = pipeline.gnss().ekf();
  outcome.has_scale = ekf.filter_state().vehicle.size() > kOdometerScale;
  if (outcome.has_scale) {
    constexpr int kPlace = ekf_index::kSize + kOdometerScale;
    outcome.scale = ekf.filter_state().vehicle[kOdometerScale];
    outcome.sigma = std::sqrt(ekf.covariance()(kPlace, kPlace));
  }
  outcome.counters = pipeline.sequencer().counters();
  return outcome;
}

double worst_in_tunnel(const Outcome& outcome, const SyntheticDrive& drive) {
  return worst_error(outcome.sink, drive, kTunnelBegin_s, kTunnelEnd_s + 0.5);
}

}  // namespace

TEST_CASE("an odometer carries both estimators through a minute's tunnel, its scale factor found") {
  const Estimator estimator = GENERATE(Estimator::kEkf, Estimator::kSmoother);
  const SyntheticDriveOptions options = biased_drive();
  const SyntheticDrive drive = darkened(synthetic_drive(options));
  const NavigatorConfig config = config_of(options, estimator);
  const Outcome without = drive_with(drive, {}, config);
  CHECK_FALSE(without.has_scale);
  const double without_m = worst_in_tunnel(without, drive);
  // In phase with the instants and out of it; with and without a sign; late.
  const WheelOptions wheels[] = {{},
                                 {.phase_s = 0.037},
                                 {.phase_s = 0.037, .sign_known = false},
                                 {.rate_hz = 1.0, .phase_s = 0.31},
                                 {.rate_hz = 50.0}};
  for (const WheelOptions& wheel : wheels) {
    const double late_s = wheel.phase_s > 0.0 ? 0.15 : 0.01;
    const Outcome with = drive_with(drive, wheel_of(options, wheel), config, late_s);
    const double with_m = worst_in_tunnel(with, drive);
    std::printf(
        "%s, %2.0f Hz, phase %.3f s, sign %d: worst in a minute's tunnel %.2f m, without odometer "
        "%.2f m; scale %.3f %%, sigma %.3f\n",
        estimator == Estimator::kEkf ? "filter" : "smoother", wheel.rate_hz, wheel.phase_s,
        wheel.sign_known, with_m, without_m, 100.0 * with.scale, 100.0 * with.sigma);
    CHECK(with_m < 0.8 * without_m);
    CHECK(std::abs(with.scale - wheel.scale_error) < 3.0 * with.sigma);
    CHECK(with.sigma < 0.003);
    CHECK(with.counters.late_odometer == 0);
  }
}

TEST_CASE("without a message an odometer that is switched on changes no bit") {
  const SyntheticDriveOptions options = biased_drive();
  const SyntheticDrive drive = synthetic_drive(options);
  NavigatorConfig config = config_of(options, Estimator::kSmoother);
  const Outcome on = drive_with(drive, {}, config);
  config.vehicle.motion.constraints.odometer = false;
  const Outcome off = drive_with(drive, wheel_of(options), config);
  REQUIRE(on.sink.solutions.size() == off.sink.solutions.size());
  for (std::size_t i = 0; i < on.sink.solutions.size(); ++i) {
    REQUIRE(on.sink.solutions[i].p_e == off.sink.solutions[i].p_e);
    REQUIRE(on.sink.solutions[i].sigma_p_n == off.sink.solutions[i].sigma_p_n);
  }
}

TEST_CASE("a locked wheel is left out") {
  const SyntheticDriveOptions options = biased_drive();
  const SyntheticDrive drive = synthetic_drive(options);
  const NavigatorConfig config = config_of(options, Estimator::kEkf);
  const WheelOptions locking = {.lock_from_s = 120.0, .lock_to_s = 124.0};
  const Outcome locked = drive_with(drive, wheel_of(options, locking), config);
  const Outcome turning = drive_with(drive, wheel_of(options), config);
  CHECK(worst_error(locked.sink, drive, 115.0, 200.0) <
        worst_error(turning.sink, drive, 115.0, 200.0) + 0.05);
  CHECK(std::abs(locked.scale - 0.015) < 4.0 * locked.sigma);
}

TEST_CASE("a wheel that turns forbids standing") {
  // An IMU that feels still, a filter that may be standing: only the wheel tells.
  SyntheticDriveOptions options = biased_drive();
  options.standstill_s = 60.0;
  options.duration_s = 100.0;
  const SyntheticDrive drive = synthetic_drive(options);
  NavigatorConfig config = config_of(options, Estimator::kEkf);
  config.alignment.initial_heading =
      euler_from_rotation(rotation_ecef_to_ned(options.start) *
                          drive.truth_at(kSkyEpoch.plus_seconds(5.0)).q_eb.toRotationMatrix())
          .yaw;
  config.alignment.initial_heading_sigma = 0.05;
  std::vector<OdometerIncrement> wheel = wheel_of(options);
  const auto spread_at_55_s = [&](const std::vector<OdometerIncrement>& with) {
    const Outcome outcome = drive_with(drive, with, config);
    double sigma = 1e9;
    for (const EpochReport& report : outcome.sink.epochs)
      if (std::abs(seconds(report.time) - 55.0) < 0.1) sigma = report.solution.sigma_v_n.norm();
    return sigma;
  };
  const double standing = spread_at_55_s(wheel);
  for (OdometerIncrement& increment : wheel)
    if (seconds(increment.time) < 58.0) increment.distance_m = 0.002;
  config.vehicle.motion.constraints.odometer_sigma = 10.0;  // it tells nothing else
  const double turning = spread_at_55_s(wheel);
  std::printf("velocity sigma after 55 s: %.4f m/s standing, %.4f with a wheel that turns\n",
              standing, turning);
  CHECK(standing < 0.85 * turning);  // Dopplers hold it too
}

}  // namespace leonav::test
