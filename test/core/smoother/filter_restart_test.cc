// A window whose filter starts over without an attitude, and what ends it.
#include <cmath>
#include <memory>

#include "core/earth/rotation.h"
#include "core/smoother/internal/divergence_test.h"
#include "core/smoother/smoother_rig.h"
#include "support/catch.h"

namespace leonav {
namespace {

using namespace synthetic;
using namespace ekf_index;
using Eigen::Vector3d;

constexpr int kRestart = 25, kAligned = 35, kEnd = 55;

DriveOptions restarted(std::uint64_t seed) {
  DriveOptions options;
  options.seed = seed;
  options.restarted_at = kRestart;
  options.aligned_again_at = kAligned;
  return options;
}

Vector3d attitude_error(const Drive& drive, const SmootherResult& result) {
  return rotation_vector_from_quaternion(drive.truth().q_eb * result.state.q_eb.conjugate());
}

}  // namespace

TEST_CASE("the window goes on where the filter starts over without an attitude") {
  constexpr int kSeeds = 20;
  double of_position = 0.0, of_attitude = 0.0, window_m = 0.0, filter_m = 0.0;
  double aligned_position = 0.0, aligned_attitude = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Drive drive(restarted(500 + seed));
    const auto smoother = smoother_of(drive, 10);
    for (int epoch = 1; epoch <= kEnd; ++epoch) {
      const SmootherResult result = solve(drive.step(), smoother.get());
      if (epoch < kRestart) continue;
      CAPTURE(seed, epoch);
      REQUIRE(result.status == SmootherStatus::kOk);
      REQUIRE(result.has_attitude);
      REQUIRE(smoother->window().size() == 10);
      CHECK(drive.filter().has_attitude() == (epoch >= kAligned));
      const Vector3d error = drive.truth().p_e - result.state.p_e;
      const double position = nees(error, result.covariance.block<3, 3>(kPosition, kPosition));
      const double attitude =
          nees(attitude_error(drive, result), result.covariance.block<3, 3>(kAttitude, kAttitude));
      if (epoch >= kAligned) {
        aligned_position += position / (kSeeds * (kEnd - kAligned + 1));
        aligned_attitude += attitude / (kSeeds * (kEnd - kAligned + 1));
        continue;
      }
      of_position += position;
      of_attitude += attitude;
      window_m += error.squaredNorm();
      filter_m += (drive.antenna().p_antenna_e - drive.filter().state().p_e).squaredNorm();
      ++count;
    }
  }
  WARN("without the filter's attitude: NEES of position "
       << of_position / count << ", of attitude " << of_attitude / count << " of 3; rms "
       << std::sqrt(window_m / count) << " m, filter " << std::sqrt(filter_m / count) << " m");
  // 20 runs, whose ten epochs are nearly one error: 60 degrees of freedom over 20, within 99.9 %.
  CHECK(of_position / count > 1.5);
  CHECK(of_position / count < 5.1);
  CHECK(of_attitude / count > 1.5);
  CHECK(of_attitude / count < 5.1);
  CHECK(window_m < 0.5 * filter_m);
  WARN("aligned again: NEES of position " << aligned_position << ", of attitude "
                                          << aligned_attitude << " of 3");
  for (const double of_aligned : {aligned_position, aligned_attitude}) {
    CHECK(of_aligned > 1.5);
    CHECK(of_aligned < 5.1);
  }
}

TEST_CASE("a filter that goes on without attitude has its clocks and carriers in the window") {
  Drive drive(restarted(7));
  const auto smoother = smoother_of(drive, 10);
  for (int epoch = 1; epoch <= kRestart + 2; ++epoch) solve(drive.step(), smoother.get());
  const Keyframe& newest = smoother->window().newest();
  const Keyframe& before = smoother->window().at(smoother->window().size() - 2);
  REQUIRE(newest.active.ambiguities > 0);
  REQUIRE(newest.active.ambiguities == before.active.ambiguities);
  const auto F = newest.process_factor.F.bottomRightCorner(newest.active.ambiguities,
                                                           before.active.ambiguities);
  CHECK(F.isIdentity(1e-12));
}

TEST_CASE("what the window has wrong too, and what comes from outside, ends it") {
  const bool from_outside = GENERATE(true, false);
  Drive drive(restarted(3));
  const auto smoother = smoother_of(drive, 10);
  KeyframeInput input;
  for (int epoch = 1; epoch <= kRestart; ++epoch) {
    input = drive.step();
    if (epoch == kRestart) (from_outside ? input.attitude_replaced : input.ends_window) = true;
    solve(input, smoother.get());
  }
  CHECK(smoother->window().size() == 1);
  CHECK_FALSE(smoother->window().newest().has_attitude);
}

TEST_CASE("an attitude found anew ends a window that it contradicts") {
  const double turned = GENERATE(0.0, 0.8);  // rad; the sigma is 0.085, all axes together
  Drive drive(restarted(3));
  const auto smoother = smoother_of(drive, 10);
  KeyframeInput input;
  for (int epoch = 1; epoch <= kAligned; ++epoch) {
    input = drive.step();
    if (epoch == kAligned)
      input.state.nav.q_eb =
          input.state.nav.q_eb * quaternion_from_rotation_vector(Vector3d(0.0, 0.0, turned));
    const SmootherResult result = solve(input, smoother.get());
    CAPTURE(epoch);
    if (epoch > 1 && epoch < kAligned) REQUIRE(result.status == SmootherStatus::kOk);
  }
  CHECK(smoother->window().size() == (turned > 0.0 ? 1 : 10));
}

TEST_CASE("solves that are late leave a window over a restart as it was") {
  Drive drive(restarted(3)), same(restarted(3));
  const auto late = smoother_of(drive, 10), in_time = smoother_of(same, 10);
  for (int epoch = 1; epoch <= kEnd; ++epoch) {
    const bool is_late = epoch % 3 == 0;
    const SmootherResult a = solve(drive.step(), late.get(), !is_late);
    const KeyframeInput& input = same.step();
    if (is_late) {
      in_time->add(input);
      continue;
    }
    const SmootherResult b = solve(input, in_time.get());
    CAPTURE(epoch);
    REQUIRE(a.status == b.status);
    CHECK(a.state.p_e == b.state.p_e);
    CHECK(a.covariance == b.covariance);
    CHECK(a.filter_is_younger == b.filter_is_younger);
  }
}

TEST_CASE("samples that do not reach back to the window's newest keyframe end it") {
  Drive drive(restarted(3));
  const auto smoother = smoother_of(drive, 10);
  KeyframeInput input;
  for (int epoch = 1; epoch <= kRestart; ++epoch) {
    input = drive.step();
    if (epoch == kRestart) input.sample_before_block.time = input.time.plus_seconds(-0.5);
    solve(input, smoother.get());
  }
  CHECK(smoother->window().size() == 1);
}

TEST_CASE("a window is given up for a filter of its age that is farther off than both sigmas") {
  DivergenceTest test;
  CHECK(test({.apart_m = 1.4, .window_sigma_m = 0.5, .filter_sigma_m = 1.0}));
  CHECK_FALSE(test({.apart_m = 1.6, .window_sigma_m = 0.5, .filter_sigma_m = 1.0}));
  CHECK_FALSE(test(
      {.apart_m = 1.6, .window_sigma_m = 0.5, .filter_sigma_m = 1.0, .codes_fit_window = true}));
  CHECK(test(
      {.apart_m = 2.5, .window_sigma_m = 0.5, .filter_sigma_m = 1.0, .filter_is_younger = true}));
  CHECK(test({.apart_m = 0.25, .window_sigma_m = 0.01, .filter_sigma_m = 0.01}));
}

TEST_CASE("against a filter that has started over the codes decide, ten times in a row") {
  DivergenceTest test;
  WindowAgainstFilter at{
      .apart_m = 29.0, .window_sigma_m = 0.5, .filter_sigma_m = 10.0, .filter_is_younger = true};
  for (int i = 0; i < 20; ++i) {
    CHECK(test(at));  // within three sigmas
    test.commit();
  }
  at.apart_m = 40.0;
  at.codes_fit_window = true;
  for (int i = 0; i < 20; ++i) {
    CHECK(test(at));
    test.commit();
  }
  at.codes_fit_window = false;
  for (int i = 0; i < 20; ++i) CHECK(test(at));  // solves that were late do not count
  for (int i = 0; i < 9; ++i) {
    CHECK(test(at));
    test.commit();
  }
  CHECK_FALSE(test(at));
  test.reset();
  CHECK(test(at));
}

}  // namespace leonav
