// A smoothed trajectory between epochs against the truth of a drive at the IMU's rate.
#include "tools/smooth/trajectory.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "smooth_rig.h"

namespace leonav::test {
namespace {

std::vector<Solution> samples_of(const SmoothedDrive& smoothed, Estimate estimate) {
  std::vector<Solution> samples;
  Trajectory(smoothed.graph, smoothed.result, estimate).for_each_sample([&](const Solution& one) {
    samples.push_back(one);
  });
  return samples;
}

bool is_keyframe(const LogGraph& graph, GpsTime time) {
  for (int k = 0; k < graph.size(); ++k)
    if (graph.at(k).time == time) return true;
  return false;
}

struct Rms {
  double position = 0.0, velocity = 0.0, yaw = 0.0, normalized = 0.0;
  int count = 0;
  void add(const Solution& solution, const NavState& truth) {
    const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(truth.p_e));
    const Eigen::Vector3d error = C_ne * (solution.p_e - truth.p_e);
    position += error.squaredNorm();
    velocity += (solution.v_n - C_ne * truth.v_e).squaredNorm();
    const double heading = euler_from_rotation(C_ne * truth.q_eb.toRotationMatrix()).yaw;
    yaw += square(wrap_to_pi(solution.yaw - heading));
    normalized += error.cwiseQuotient(solution.sigma_p_n).squaredNorm() / 3.0;
    ++count;
  }
  void finish() {
    for (double* sum : {&position, &velocity, &yaw, &normalized}) *sum = std::sqrt(*sum / count);
  }
};

}  // namespace

TEST_CASE("between epochs a smoothed drive is as near to the truth as at them") {
  const SmoothedDrive& smoothed = smoothed_drive();
  Rms at, between;
  for (const Solution& solution : samples_of(smoothed, Estimate::kSmoothed))
    (is_keyframe(smoothed.graph, solution.time) ? at : between)
        .add(solution, smoothed.drive.truth_at(solution.time));
  at.finish();
  between.finish();
  WARN("rms at epochs: " << at.position << " m, " << at.velocity << " m/s, " << at.yaw
                         << " rad; between: " << between.position << " m, " << between.velocity
                         << " m/s, " << between.yaw << " rad; over sigma " << at.normalized
                         << " and " << between.normalized);
  CHECK(at.count == smoothed.graph.size());
  CHECK(between.position < 1.05 * at.position);
  CHECK(between.velocity < 1.2 * at.velocity + 0.002);
  CHECK(between.yaw < 1.2 * at.yaw + 1e-4);
  CHECK(at.position < 0.3);
  CHECK(at.velocity < 0.03);
  CHECK(at.yaw < 0.01);
  CHECK(between.normalized < 1.1 * at.normalized);
}

TEST_CASE("a smoothed trajectory has every sample of the IMU once, and no steps") {
  const SmoothedDrive& smoothed = smoothed_drive();
  const std::vector<Solution> samples = samples_of(smoothed, Estimate::kSmoothed);
  const GpsTime first = samples.front().time, last = samples.back().time;
  CHECK(first == smoothed.graph.at(0).time);
  CHECK(last == smoothed.graph.at(smoothed.graph.size() - 1).time);
  std::size_t expected = 0;
  for (const ImuSample& sample : smoothed.drive.imu)
    expected += sample.time > first && sample.time < last ? 1 : 0;
  std::size_t inside = 0;
  double step = 0.0, turn = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Solution& now = samples[i];
    CHECK(now.has_attitude);
    inside += is_keyframe(smoothed.graph, now.time) ? 0 : 1;
    if (i == 0) continue;
    const Solution& before = samples[i - 1];
    const double dt = seconds_between(now.time, before.time);
    REQUIRE(dt > 0.0);
    const Eigen::Matrix3d C_en =
        rotation_ecef_to_ned({now.latitude, now.longitude, now.height}).transpose();
    const Eigen::Vector3d way = 0.5 * dt * C_en * (now.v_n + before.v_n);
    step = std::max(step, (now.p_e - before.p_e - way).norm());
    turn = std::max(turn, std::abs(wrap_to_pi(now.yaw - before.yaw)));
  }
  WARN("largest step " << step << " m, largest turn " << turn << " rad");
  // Epochs lie 0.02 ms beside a sample, by the receiver's clock.
  CHECK(inside >= expected - static_cast<std::size_t>(smoothed.graph.size()));
  CHECK(inside <= expected + static_cast<std::size_t>(smoothed.graph.size()));
  CHECK(step < 2e-3);
  CHECK(turn < 0.01);  // 0.3 rad/s at most
}

TEST_CASE("sigmas between epochs lie between those of the epochs") {
  const SmoothedDrive& smoothed = smoothed_drive();
  const Trajectory trajectory(smoothed.graph, smoothed.result, Estimate::kSmoothed);
  int k = 0;
  trajectory.for_each_sample([&](const Solution& solution) {
    while (smoothed.graph.at(k).time < solution.time) ++k;
    if (k == 0) return;
    const Solution before = trajectory.at(k - 1), after = trajectory.at(k);
    for (int axis = 0; axis < 3; ++axis) {
      const double a = before.sigma_p_n(axis), b = after.sigma_p_n(axis);
      const double slack = 1e-6 + 1e-4 * std::max(a, b);  // north turns on the way
      CHECK(solution.sigma_p_n(axis) > std::min(a, b) - slack);
      CHECK(solution.sigma_p_n(axis) < std::max(a, b) + slack);
    }
  });
}

TEST_CASE("what comes later brings a smoothed drive nearer to the truth") {
  const SmoothedDrive& smoothed = smoothed_drive();
  const Trajectory trajectory(smoothed.graph, smoothed.result, Estimate::kSmoothed);
  const Trajectory forward(smoothed.graph, smoothed.result, Estimate::kForward);
  Rms all, before;
  for (int k = 0; k < smoothed.graph.size(); ++k) {
    const Solution one = trajectory.at(k), other = forward.at(k);
    const NavState truth = smoothed.drive.truth_at(one.time);
    all.add(one, truth);
    before.add(other, truth);
    CHECK(one.source == Source::kSmoother);
    for (int axis = 0; axis < 3; ++axis)
      CHECK(one.sigma_p_n(axis) < other.sigma_p_n(axis) * (1.0 + 1e-6));
  }
  all.finish();
  before.finish();
  WARN("rms " << all.position << " m, forward " << before.position << " m");
  CHECK(all.position < 0.9 * before.position);
  CHECK(before.normalized < 2.0);
  // At the last epoch nothing comes later.
  const int last = smoothed.graph.size() - 1;
  CHECK((trajectory.at(last).p_e - forward.at(last).p_e).norm() < 1e-6);
}

TEST_CASE("the collector's keyframes are the epochs that have a state") {
  const SmoothedDrive& smoothed = smoothed_drive();
  const auto epochs = static_cast<long>(smoothed.drive.epochs.size());
  CHECK(smoothed.counts.epochs <= epochs);
  CHECK(smoothed.counts.epochs >= epochs - 1);  // the last one waits for its IMU
  CHECK(smoothed.graph.size() <= smoothed.counts.epochs);
  CHECK(smoothed.graph.size() >= smoothed.counts.epochs - 2);  // it starts from the first
  CHECK(smoothed.counts.resets == 0);
  // The filter had its attitude only from the course on.
  CHECK(smoothed.result.extension.attitudes > 10);
}

}  // namespace leonav::test
