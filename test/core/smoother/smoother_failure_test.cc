// Input that is none: a status says so, and the smoother starts over.
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "smoother_rig.h"
#include "support/catch.h"

namespace leonav {
namespace {

using namespace synthetic;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Fault {
  const char* name;
  void (*make)(KeyframeInput*);
  SmootherStatus expected;
};

const Fault kFaults[] = {
    {"a measurement is not a number",
     [](KeyframeInput* input) { input->measurements[2].measurement.value = kNan; },
     SmootherStatus::kSingular},
    {"a weight is infinite",
     [](KeyframeInput* input) { input->measurements[2].gain_variance = 0.0; },
     SmootherStatus::kSingular},
    {"noise of less than nothing",
     [](KeyframeInput* input) { input->process.noise.diagonal().array() -= 1e12; },
     SmootherStatus::kSingular},
    {"a process that is not finite",
     [](KeyframeInput* input) { input->process.transition(0, 3) = kNan; },
     SmootherStatus::kSingular},
    {"a process from other states",
     [](KeyframeInput* input) { input->process.transition.conservativeResize(39, 38); },
     SmootherStatus::kSingular},
    {"far from the filter", [](KeyframeInput* input) { input->state.nav.p_e.x() += 1e5; },
     SmootherStatus::kDiverged},
    {"the filter has started over without an attitude",
     [](KeyframeInput* input) { input->follows_previous = input->has_attitude = false; },
     SmootherStatus::kOk},
    {"the filter has started over, because of what the window has wrong too",
     [](KeyframeInput* input) {
       input->follows_previous = false;
       input->ends_window = true;
     },
     SmootherStatus::kStarted},
    {"an attitude from outside has replaced the filter's",
     [](KeyframeInput* input) {
       input->follows_previous = false;
       input->attitude_replaced = true;
     },
     SmootherStatus::kStarted},
    {"the filter has started over", [](KeyframeInput* input) { input->follows_previous = false; },
     SmootherStatus::kOk},
    {"there is no filter", [](KeyframeInput* input) { input->valid = false; },
     SmootherStatus::kNoFilter},
};

}  // namespace

TEST_CASE("what cannot be solved is reported, and the smoother starts over") {
  const Fault& fault = kFaults[GENERATE(range(0, 11))];
  CAPTURE(fault.name);
  const bool full = GENERATE(false, true);
  Drive drive{DriveOptions{}};
  const auto smoother = smoother_of(drive, full ? 5 : 20);
  for (int epoch = 1; epoch <= 8; ++epoch) solve(drive.step(), smoother.get());
  KeyframeInput input = drive.step();
  fault.make(&input);
  CHECK(solve(input, smoother.get()).status == fault.expected);
  // The next one follows the one that failed or starts anew; then all is well.
  const SmootherStatus next = solve(drive.step(), smoother.get()).status;
  CHECK((next == SmootherStatus::kStarted || next == SmootherStatus::kOk));
  for (int more = 0; more < 3; ++more) {
    const SmootherResult result = solve(drive.step(), smoother.get());
    CHECK(result.status == SmootherStatus::kOk);
    CHECK((result.state.p_e - drive.truth().p_e).norm() < 10.0);
    CHECK(result.covariance.allFinite());
  }
}

TEST_CASE("a drilled failure is found as a true one is, and the smoother starts over") {
  SmootherConfig config;
  config.drill_failure_every = 10;
  config.drill_failure = GENERATE(DrilledFailure::kSingular, DrilledFailure::kDiverged);
  const bool singular = config.drill_failure == DrilledFailure::kSingular;
  Drive drive{DriveOptions{}};
  const auto smoother = smoother_of(drive, config);
  for (int epoch = 1; epoch <= 40; ++epoch) {
    const KeyframeInput& input = drive.step();
    CAPTURE(input.index);
    const SmootherResult result = solve(input, smoother.get());
    if (input.index % 10 == 0) {
      CHECK(result.status == (singular ? SmootherStatus::kSingular : SmootherStatus::kDiverged));
    } else if (epoch > 1) {
      CHECK(result.status ==
            (input.index % 10 == 1 ? SmootherStatus::kStarted : SmootherStatus::kOk));
      CHECK((result.state.p_e - drive.truth().p_e).norm() < 10.0);
    }
  }
}

TEST_CASE("a drilled failure that came too late leaves no trace") {
  SmootherConfig config;
  config.drill_failure_every = 10;
  config.drill_failure = GENERATE(DrilledFailure::kSingular, DrilledFailure::kDiverged);
  Drive drive{DriveOptions{}};
  const auto with = smoother_of(drive, config), without = smoother_of(drive, SmootherConfig());
  for (int epoch = 1; epoch <= 40; ++epoch) {
    const KeyframeInput& input = drive.step();
    const bool in_time = input.index % 10 != 0;
    const SmootherResult failed = solve(input, with.get(), in_time);
    const SmootherResult other = solve(input, without.get(), in_time);
    if (in_time) CHECK((failed.state.p_e - other.state.p_e).norm() == 0.0);
  }
}

TEST_CASE("a covariance that is none starts nothing") {
  Drive drive{DriveOptions{}};
  const auto smoother = smoother_of(drive, 5);
  KeyframeInput input = drive.step();
  input.covariance(0, 0) = kNan;
  CHECK(solve(input, smoother.get()).status != SmootherStatus::kOk);
  const SmootherResult result = solve(drive.step(), smoother.get());
  CHECK((result.status == SmootherStatus::kOk || result.status == SmootherStatus::kStarted));
  CHECK(result.covariance.allFinite());
}

// The ninth keyframe of a drive, with the filter's position moved away from the window's until they
// are `apart_m`; and the sigmas of both together.
struct Ninth {
  SmootherResult result;
  double sigmas_m = 0.0;
};

Ninth ninth(const DriveOptions& options, double apart_m) {
  const auto moved = [&](const Eigen::Vector3d& move_e) {
    Drive drive{options};
    const auto smoother = smoother_of(drive, 20);
    for (int epoch = 1; epoch <= 8; ++epoch) solve(drive.step(), smoother.get());
    auto input = std::make_unique<KeyframeInput>(drive.step());
    input->state.nav.p_e += move_e;
    SmootherResult result = solve(*input, smoother.get());
    return std::pair(std::move(input), std::move(result));
  };
  const auto [input, result] = moved(Eigen::Vector3d::Zero());
  const Eigen::Vector3d away_e = input->state.nav.p_e - result.state.p_e;
  const double sigmas_m = std::sqrt(input->covariance.topLeftCorner<3, 3>().trace()) +
                          std::sqrt(result.covariance.topLeftCorner<3, 3>().trace());
  return {moved((apart_m - away_e.norm()) * away_e.normalized()).second, sigmas_m};
}

TEST_CASE("a window farther from the filter than the sigmas of both together has diverged") {
  const DriveOptions options;
  const double sigmas_m = ninth(options, 0.0).sigmas_m;
  REQUIRE(sigmas_m > 0.6);
  CHECK(ninth(options, 0.98 * sigmas_m).result.status == SmootherStatus::kOk);
  CHECK(ninth(options, 1.02 * sigmas_m).result.status == SmootherStatus::kDiverged);
}

TEST_CASE("a window within 0.3 m of the filter has not diverged, however certain both are") {
  DriveOptions options;
  options.code_sigma = 0.05;
  options.doppler_sigma = 0.02;
  REQUIRE(ninth(options, 0.0).sigmas_m < 0.25);
  CHECK(ninth(options, 0.29).result.status == SmootherStatus::kOk);
  CHECK(ninth(options, 0.31).result.status == SmootherStatus::kDiverged);
}

}  // namespace leonav
