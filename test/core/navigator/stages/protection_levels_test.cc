// The levels that the stages publish: at an epoch, between epochs, and where there are none.
#include <cmath>
#include <numbers>

#include "core/integrity/protection_levels.h"
#include "core/navigator/interface/solution_conversion.h"
#include "inertial_rig.h"
#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

// The multiple of sigma that an error exceeds with the risk of one sample, found by stepping.
double multiple(const IntegrityConfig& config, double share) {
  const double risk = share * config.risk_per_hour * config.error_correlation_s / 3600.0;
  const Overbound& bound = config.overbound;
  double multiple = 0.0;
  for (double step = 1.0; step > 1e-9; step *= 0.5) {
    const auto exceeded = [&](double x) {
      return (1.0 - bound.tail_share) * std::erfc(x / std::numbers::sqrt2) +
             bound.tail_share * std::erfc(x / (bound.tail_factor * std::numbers::sqrt2));
    };
    while (exceeded(multiple + step) > risk) multiple += step;
  }
  return multiple;
}

Anchor with_levels(Anchor anchor, const IntegrityConfig& config) {
  Solution solution;
  const PvaCovariance covariance = anchor.covariance.topLeftCorner<9, 9>();
  fill_solution(anchor.state, covariance, true, &solution);
  anchor.levels = LevelGrowth(nominal_error(covariance, solution), {}, config);
  return anchor;
}

TEST_CASE("between anchors the levels grow as the sigmas do") {
  InertialRig rig;
  const IntegrityConfig config;
  rig.feed(0.0, 1.0);
  rig.issue(1, 1.0, 0.1);
  rig.mailbox.deliver(1, with_levels(rig.anchor(1, 1.0), config));
  rig.feed(1.0, 6.0);
  REQUIRE(rig.sink.solutions.size() > 900);
  double last = 0.0;
  for (const Solution& solution : rig.sink.solutions) {
    const Eigen::Vector3d& sigma = solution.sigma_p_n;
    CHECK(solution.vertical_protection_m ==
          Approx(sigma.z() * multiple(config, 1.0)).epsilon(1e-6));
    // Major and minor axis of an ellipse have the same sum of squares as north and east.
    CHECK(solution.horizontal_protection_m ==
          Approx(sigma.head<2>().norm() * multiple(config, 0.5)).epsilon(1e-3));
    CHECK(solution.heading_protection ==
          Approx(solution.sigma_rpy.z() * multiple(config, 1.0)).epsilon(1e-6));
    CHECK(solution.horizontal_protection_m >= last);
    last = solution.horizontal_protection_m;
  }
}

TEST_CASE("an anchor without levels gives solutions without levels") {
  InertialRig rig;
  rig.feed(0.0, 1.0);
  rig.issue(1, 1.0, 0.1);
  rig.mailbox.deliver(1, rig.anchor(1, 1.0));
  rig.feed(1.0, 2.0);
  REQUIRE(rig.sink.solutions.size() > 100);
  CHECK(std::isnan(rig.sink.solutions.back().horizontal_protection_m));
}

SyntheticDriveOptions noisy_drive() {
  SyntheticDriveOptions options;
  options.duration_s = 60.0;
  options.code_sigma_m = 0.5;
  options.doppler_sigma_m_s = 0.05;
  options.carrier_sigma_m = 0.003;
  return options;
}

void check_levels(const std::vector<Solution>& solutions) {
  REQUIRE_FALSE(solutions.empty());
  for (const Solution& solution : solutions) {
    const bool some = solution.source != Source::kNone;
    REQUIRE(std::isfinite(solution.horizontal_protection_m) == some);
    REQUIRE(std::isfinite(solution.vertical_protection_m) == some);
    REQUIRE(std::isfinite(solution.heading_protection) == (some && solution.has_attitude));
    if (!some) continue;
    REQUIRE(solution.horizontal_protection_m > 4.0 * solution.sigma_p_n.head<2>().norm());
    REQUIRE(solution.vertical_protection_m > 4.0 * solution.sigma_p_n.z());
  }
}

std::vector<Solution> epochs_of(const RecordingSink& sink) {
  std::vector<Solution> solutions;
  for (const EpochReport& report : sink.epochs) solutions.push_back(report.solution);
  return solutions;
}

TEST_CASE("every published solution has levels, and no other has") {
  const SyntheticDrive drive = synthetic_drive(noisy_drive());
  NavigatorConfig config = drive_navigator_config(drive.options);
  SECTION("filter with an IMU") {
    const RecordingSink sink = run(drive, config);
    check_levels(epochs_of(sink));
    check_levels(sink.solutions);
  }
  SECTION("filter without an IMU") {
    config.motion = MotionModel::kConstantVelocity;
    const RecordingSink sink = run(drive, config);
    check_levels(sink.solutions);
    CHECK_FALSE(sink.solutions.back().has_attitude);
  }
  SECTION("smoother") {
    config.estimator = Estimator::kSmoother;
    config.ekf.use_carrier = true;
    config.smoother.window = 5;
    const RecordingSink sink = run(drive, config);
    std::vector<Solution> smoothed;
    for (const SmootherReport& report : sink.smoothed) smoothed.push_back(report.solution);
    check_levels(smoothed);
    check_levels(sink.solutions);
    CHECK(sink.solutions.back().source == Source::kSmoother);
  }
}

TEST_CASE("a smaller risk raises every level and moves no solution") {
  const SyntheticDrive drive = synthetic_drive(noisy_drive());
  NavigatorConfig config = drive_navigator_config(drive.options);
  const RecordingSink usual = run(drive, config);
  config.integrity.risk_per_hour *= 1e-3;
  const RecordingSink careful = run(drive, config);
  REQUIRE(usual.solutions.size() == careful.solutions.size());
  CHECK(usual.solutions.back().p_e == careful.solutions.back().p_e);
  CHECK(careful.solutions.back().horizontal_protection_m >
        1.1 * usual.solutions.back().horizontal_protection_m);
}

}  // namespace
}  // namespace leonav::test
