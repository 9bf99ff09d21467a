// Lever arm and time offset estimated while driving, by both estimators, and the configured time
// offset.
#include <cmath>
#include <cstdio>

#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

using namespace ekf_index;

constexpr double kArmError_m = 0.4;
constexpr double kLate_s = 0.03;

SyntheticDrive minutes_of_noise() {
  SyntheticDriveOptions options;
  options.duration_s = 200.0;
  options.code_sigma_m = 0.5;
  options.doppler_sigma_m_s = 0.03;
  options.carrier_sigma_m = 0.002;
  options.angle_random_walk = 2e-5;
  options.velocity_random_walk = 1e-3;
  return synthetic_drive(options);
}

// The same with an IMU that measures later than it stamps.
SyntheticDrive late_drive() {
  SyntheticDrive drive = minutes_of_noise();
  for (ImuSample& sample : drive.imu) sample.time = sample.time.plus_seconds(-kLate_s);
  return drive;
}

void estimate(NavigatorConfig* config) {
  VehicleConstantsConfig& constants = config->ekf.vehicle;
  constants.count = kMaxVehicle;
  for (std::size_t axis = 0; axis < 3; ++axis) constants.sigma[kLeverArm + axis] = 1.0;
  constants.sigma[kTimeOffset] = 0.05;
}

// The last minute's worst error of the answers at the epochs.
double worst_at_end(const SyntheticDrive& drive, const RecordingSink& sink) {
  return worst_error(sink, drive, 140.0, 200.0);
}

double worst_of_smoother(const SyntheticDrive& drive, const RecordingSink& sink) {
  const SyntheticPath path(drive.options);
  double worst = 0.0;
  for (const SmootherReport& report : sink.smoothed) {
    const double t = seconds(report.solution.time);
    if (t < 140.0 || !report.solution.has_attitude) continue;
    worst = std::max(worst, (report.solution.p_e - path.state(t).p_e).norm());
  }
  return worst;
}

}  // namespace

TEST_CASE("a filter told a wrong lever arm and stamped late finds both") {
  const SyntheticDrive drive = late_drive();
  NavigatorConfig config = config_with_carriers(drive);
  config.vehicle.lever_arm_b.x() += kArmError_m;
  config.vehicle.lever_arm_b.y() -= kArmError_m;
  estimate(&config);
  RecordingSink sink;
  Navigator pipeline(config, &sink);
  feed(drive, &pipeline);
  const Ekf& ekf = pipeline.gnss().ekf();
  const VehicleConstants& found = ekf.filter_state().vehicle;
  const auto sigma = [&](int state) {
    return std::sqrt(ekf.covariance()(kSize + state, kSize + state));
  };
  const auto place = [](int state) { return static_cast<std::size_t>(state); };
  std::printf("arm %.3f %.3f %.3f (sigma %.3f %.3f %.3f) m, offset %.2f (%.2f) ms\n",
              found[place(kLeverArm)], found[place(kLeverArm + 1)], found[place(kLeverArm + 2)],
              sigma(kLeverArm), sigma(kLeverArm + 1), sigma(kLeverArm + 2),
              1e3 * found[place(kTimeOffset)], 1e3 * sigma(kTimeOffset));
  CHECK(std::abs(found[place(kLeverArm)] + kArmError_m) < 4.0 * sigma(kLeverArm));
  CHECK(std::abs(found[place(kLeverArm + 1)] - kArmError_m) < 4.0 * sigma(kLeverArm + 1));
  CHECK(std::abs(found[place(kTimeOffset)] - kLate_s) < 4.0 * sigma(kTimeOffset));
  CHECK(sigma(kLeverArm) < 0.1);
  CHECK(sigma(kLeverArm + 1) < 0.1);
  CHECK(sigma(kTimeOffset) < 8e-3);
  // It never tilts: little but the filter's own corrections of the attitude tells how high the
  // antenna is.
  CHECK(std::abs(found[place(kLeverArm + 2)]) < 4.0 * sigma(kLeverArm + 2));
  CHECK(sigma(kLeverArm + 2) > 10.0 * sigma(kLeverArm));
  // What is not estimated has not moved.
  CHECK(found[place(kTravelYaw)] == 0.0);
  CHECK(found[place(kOdometerScale)] == 0.0);
  CHECK(sigma(kTravelPitch) == 0.0);
}

TEST_CASE("answers of both estimators are those of the stamp and of the true lever arm") {
  const SyntheticDrive drive = late_drive();
  NavigatorConfig config = config_with_carriers(drive);
  config.estimator = Estimator::kSmoother;
  config.vehicle.lever_arm_b.x() += kArmError_m;
  const RecordingSink wrong = run(drive, config);
  estimate(&config);
  config.ekf.vehicle.sigma[kLeverArm + 2] = 0.01;
  const RecordingSink found = run(drive, config);
  std::printf("worst: filter %.3f -> %.3f m, smoother %.3f -> %.3f m\n", worst_at_end(drive, wrong),
              worst_at_end(drive, found), worst_of_smoother(drive, wrong),
              worst_of_smoother(drive, found));
  CHECK(worst_at_end(drive, found) < 0.4);
  CHECK(worst_of_smoother(drive, found) < 0.4);
  CHECK(worst_at_end(drive, wrong) > 1.5 * worst_at_end(drive, found));
}

TEST_CASE("a configured time offset moves the IMU's stamps before anything looks at them") {
  const SyntheticDrive drive = late_drive(), right = minutes_of_noise();
  NavigatorConfig config = config_with_carriers(drive);
  const RecordingSink expected = run(right, config);
  config.imu_time_offset_s = kLate_s;
  const RecordingSink moved = run(drive, config);
  REQUIRE(moved.epochs.size() >= expected.epochs.size() - 2);
  CHECK(worst_at_end(drive, moved) == Approx(worst_at_end(right, expected)).margin(1e-6));
}

}  // namespace leonav::test
