// Constraints on the motion in the navigator: what carries a car through a tunnel, and what must
// not be taken for standing.
#include "core/vehicle/motion_aiding.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

constexpr double kTunnelBegin_s = 110.0, kTunnelEnd_s = 170.0, kDuration_s = 200.0;

SyntheticDriveOptions noisy_drive() {
  SyntheticDriveOptions options;
  options.duration_s = kDuration_s;
  options.code_sigma_m = 1.0;
  options.doppler_sigma_m_s = 0.05;
  options.carrier_sigma_m = 0.003;
  options.angle_random_walk = 1e-4;
  options.velocity_random_walk = 1e-3;
  options.gyro_bias_b = {2e-4, -3e-4, 4e-4};
  options.accel_bias_b = {0.02, -0.03, 0.02};
  return options;
}

NavigatorConfig config_of(const SyntheticDriveOptions& options, bool constrained,
                          Estimator estimator) {
  NavigatorConfig config = drive_navigator_config(options);
  config.estimator = estimator;
  config.ekf.use_carrier = true;
  config.imu.gyro_bias.sigma = 5e-4;
  config.imu.accel_bias.sigma = 0.03;
  MotionConstraintConfig& motion = config.vehicle.motion.constraints;
  motion.non_holonomic = motion.zero_velocity = constrained;
  if (constrained) config.ekf.vehicle = {2, {0.03, 0.03}, {3e-5, 3e-5}};
  return config;
}

double worst_in_tunnel(const SyntheticDrive& drive, const NavigatorConfig& config) {
  RecordingSink sink;
  Navigator pipeline(config, &sink);
  SyntheticDrive darkened = drive;
  for (RawEpoch& epoch : darkened.epochs)
    if (seconds(epoch.time) > kTunnelBegin_s && seconds(epoch.time) < kTunnelEnd_s)
      epoch.observations.clear();
  feed(darkened, &pipeline);
  return worst_error(sink, drive, kTunnelBegin_s, kTunnelEnd_s + 0.5);
}

}  // namespace

TEST_CASE("a car's constraints carry both estimators through a minute without satellites") {
  const Estimator estimator = GENERATE(Estimator::kEkf, Estimator::kSmoother);
  const SyntheticDriveOptions options = noisy_drive();
  const SyntheticDrive drive = synthetic_drive(options);
  const double free_m = worst_in_tunnel(drive, config_of(options, false, estimator));
  const double held_m = worst_in_tunnel(drive, config_of(options, true, estimator));
  std::printf("%s: worst in a minute's tunnel %.2f m without constraints, %.2f m with\n",
              estimator == Estimator::kEkf ? "filter" : "smoother", free_m, held_m);
  CHECK(held_m < 0.5 * free_m);
  CHECK(held_m < 3.0);
}

TEST_CASE("constraints that do not hold are left out, and that is told") {
  const SyntheticDriveOptions options = noisy_drive();
  NavigatorConfig config = config_of(options, true, Estimator::kEkf);
  const SyntheticDrive drive = synthetic_drive(options);
  const auto events_of = [&](const NavigatorConfig& with) {
    int told = 0;
    for (const Event& event : run(drive, with).events)
      told += event.kind == EventKind::kConstraintsLeftOut ? 1 : 0;
    return told;
  };
  CHECK(events_of(config) == 0);
  // Each component of each instant is reported; the gate's word is the report's.
  int reported = 0, instants = 0;
  for (const EpochReport& report : run(drive, config).epochs) {
    instants += static_cast<int>(report.constraints.size());
    for (const ConstraintReport& one : report.constraint_reports) {
      ++reported;
      CHECK(one.used == (one.test_ratio < config.vehicle.motion.constraints.gate));
      CHECK(one.test_ratio ==
            Approx(std::abs(one.innovation) / std::sqrt(one.innovation_variance)));
      if (one.component <= 1) CHECK(one.observation == 0.0);
    }
  }
  CHECK(instants > 500);
  CHECK(reported >= 2 * instants);
  // A point forty metres ahead sways with every turn.
  config.ekf.vehicle = {};
  config.vehicle.motion.constraints.point_b = {40.0, 0.0, 0.0};
  config.vehicle.motion.constraints.slip_per_acceleration = 0.0;
  CHECK(events_of(config) >= 1);
}

TEST_CASE("after both streams have gone back in time the constraints are there again") {
  const SyntheticDriveOptions options = noisy_drive();
  const SyntheticDrive drive = synthetic_drive(options);
  RecordingSink sink;
  Navigator pipeline(config_of(options, true, Estimator::kEkf), &sink);
  feed(drive, &pipeline);
  const auto constrained = [&] {
    return std::count_if(sink.epochs.begin(), sink.epochs.end(),
                         [](const EpochReport& report) { return !report.constraints.empty(); });
  };
  const auto once = constrained();
  feed(drive, &pipeline);
  std::printf("epochs with constraints: %td, and %td the second time\n", once,
              constrained() - once);
  CHECK(once > 150);
  CHECK(constrained() - once > once - 15);
}

TEST_CASE("an IMU that cannot feel a gentle start needs the carriers to stand") {
  SyntheticDriveOptions options = noisy_drive();
  options.duration_s = 90.0;
  options.standstill_s = 60.0;
  options.acceleration_s = 900.0;  // 0.01 m/s^2
  const SyntheticDrive drive = synthetic_drive(options);
  NavigatorConfig config = config_of(options, true, Estimator::kEkf);
  config.alignment.initial_heading = 0.0;
  config.imu.accel_bias = {0.2, 1000.0};
  int standing = 0, moving = 0;
  double fastest = 0.0;
  for (const EpochReport& report : run(drive, config).epochs) {
    for (const ConstraintInstant& instant : report.constraints) {
      if (!instant.standing) continue;
      const double speed = SyntheticPath(options).state(seconds(instant.time)).v_e.norm();
      speed < 0.01 ? ++standing : ++moving;
      fastest = std::max(fastest, speed);
    }
  }
  std::printf("taken to stand: %d instants below 1 cm/s, %d above, fastest %.3f m/s\n", standing,
              moving, fastest);
  CHECK(standing > 100);
  CHECK(fastest < 0.06);
}

}  // namespace leonav::test
